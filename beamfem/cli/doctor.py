"""`beamfem doctor`: check of the installation."""

import platform
import re
from importlib.metadata import distributions, requires
from timeit import repeat
from typing import Any

import typer

import beamfem as bf
from beamfem.cli.report import FAILED, AsJson, reported, writable
from beamfem.errors import MissingPackageError

_TIP = 0.71385896416  # tip deflection over the length of the geometrically exact beam, P L^2 / (E I) = 5, L / h = 100
_NO_EXTRAS = {"", "all", "test", "bench", "docs"}


def doctor(as_json: AsJson = False) -> None:
    """Check the installation: versions, compiled kernels, a first solve, pictures of bodies and missing extras."""
    with reported(as_json) as show:
        from beamfem.kernels.cache import cache_folder, kept
        from beamfem.view.rendering import ADVICE, can_render

        folder, needed = cache_folder(), "\n".join(requires("beamfem") or ())
        required = re.findall(r"^([\w.-]+)(?:.*extra\s*==\s*['\"](\w+))?", needed, re.MULTILINE)
        missing: dict[str, list[str]] = {extra: [] for extra in sorted({of for _, of in required} - _NO_EXTRAS)}
        for name, extra in required:
            if extra in missing and _version(name) is None:
                missing[extra].append(name)
        try:
            rendering = "" if can_render() else f"VTK cannot render here; {ADVICE}"
        except MissingPackageError as error:
            rendering = str(error)
        versions: dict[str, str | None] = {"python": platform.python_version(), "system": platform.platform()}
        versions |= {name: _version(name) for name in ("beamfem", *(name for name, extra in required if not extra))}
        kernels, writes, solve = kept(), folder is not None and writable(folder), _first_solve()
        where = folder or "nowhere: set BEAMFEM_CACHE_DIR to a folder that can be written to"
        wrong = f"WRONG: tip deflection {solve['deflection']:.8f} instead of {_TIP:.8f}"
        first, again = solve["seconds"]
        lines = ["versions", *(f"  {name:14s} {version}" for name, version in versions.items())]
        lines += [f"\n{kernels} kernels in {where}{'' if writes else ', which cannot be written to'}"]
        lines += [f"first solve {first:.2f} s, again {1e3 * again:.1f} ms: {'right' if solve['right'] else wrong}"]
        lines += [f"pictures of bodies: {rendering or 'work'}\n\nextras"]
        for extra, packages in missing.items():
            need = f'missing {", ".join(packages)}: pip install "beamfem[{extra}]"'
            lines.append(f"  {extra:14s} {need if packages else 'installed'}")
        found = {"versions": versions, "cache": {"folder": folder, "writable": writes, "compiled_kernels": kernels}}
        show({**found, "first_solve": solve, "rendering": rendering, "missing": missing}, "\n".join(lines))
        if not solve["right"]:
            raise typer.Exit(FAILED)


def _first_solve() -> dict[str, Any]:
    """Solve a cantilever twice: seconds of each solve, and whether the result is right."""
    section, material = bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(4), section, material)
    force = 5.0 * material.youngs_modulus * section.second_moment
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, force))])

    def deflection() -> float:
        return float(bf.solve_static(model).displacement(beam.end)[-1, 1])

    seconds = repeat(deflection, number=1, repeat=2)
    tip = deflection()
    return {"seconds": seconds, "deflection": tip, "right": abs(tip - _TIP) < 1e-6}


def _version(name: str) -> str | None:
    return next((found.version for found in distributions(name=name)), None)
