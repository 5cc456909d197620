"""`beamfem doctor`: check of the installation."""

import platform
import re
import time
from importlib.metadata import PackageNotFoundError, requires, version
from typing import Any

import typer

from beamfem.cli.report import FAILED, AsJson, print_json, reported, writable

_TIP = 0.71385896416  # tip deflection over the length of the geometrically exact beam, P L^2 / (E I) = 5, L / h = 100
_NO_EXTRAS = ("all", "test", "bench", "docs")


def doctor(as_json: AsJson = False) -> None:
    """Check the installation: versions, compiled kernels, a first solve, pictures of bodies and missing extras."""
    with reported(as_json):
        from beamfem.kernels.cache import cache_folder, kept

        folder = cache_folder()
        needed = [re.match(r"([\w.-]+)(?:.*extra\s*==\s*['\"](\w+))?", line) for line in requires("beamfem") or ()]
        packages = [(match[1], match[2]) for match in needed if match]
        extras = sorted({extra for _, extra in packages if extra and extra not in _NO_EXTRAS})
        report: dict[str, Any] = {
            "versions": {
                "python": platform.python_version(),
                "system": platform.platform(),
                **{name: _version(name) for name in ("beamfem", *(name for name, extra in packages if not extra))},
            },
            "cache": {
                "folder": folder,
                "writable": folder is not None and writable(folder),
                "compiled_kernels": kept(),
            },
            "first_solve": _first_solve(),
            "rendering": _rendering(),
            "missing": {
                extra: [name for name, of in packages if of == extra and _version(name) is None] for extra in extras
            },
        }
        print_json(report) if as_json else _print(report)
        if not report["first_solve"]["right"]:
            raise typer.Exit(FAILED)


def _first_solve() -> dict[str, Any]:
    """Solve a cantilever twice: seconds of each solve, and whether the result is right."""
    import beamfem as bf

    section, material = bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(4), section, material)
    force = 5.0 * material.youngs_modulus * section.second_moment
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, force))])
    seconds = []
    for _ in range(2):
        start = time.perf_counter()
        deflection = float(bf.solve_static(model).displacement(beam.end)[-1, 1])
        seconds.append(time.perf_counter() - start)
    return {"seconds": seconds, "deflection": deflection, "right": abs(deflection - _TIP) < 1e-6}


def _rendering() -> str:
    """Return why VTK cannot draw, empty if it can."""
    from beamfem.errors import MissingPackageError
    from beamfem.view.rendering import ADVICE, can_render

    try:
        return "" if can_render() else f"VTK cannot render here; {ADVICE}"
    except MissingPackageError as error:
        return str(error)


def _version(name: str) -> str | None:
    try:
        return version(name)
    except PackageNotFoundError:
        return None


def _print(found: dict[str, Any]) -> None:
    cache, solve = found["cache"], found["first_solve"]
    print("versions\n" + "\n".join(f"  {name:14s} {version}" for name, version in found["versions"].items()))
    folder = cache["folder"] or "nowhere: set BEAMFEM_CACHE_DIR to a folder that can be written to"
    writes = "" if cache["writable"] else ", which cannot be written to"
    print(f"\n{cache['compiled_kernels']} kernels in {folder}{writes}")
    verdict = "right" if solve["right"] else f"WRONG: tip deflection {solve['deflection']:.8f} instead of {_TIP:.8f}"
    first, again = solve["seconds"]
    print(f"first solve {first:.2f} s, again {1e3 * again:.1f} ms: {verdict}")
    print(f"pictures of bodies: {found['rendering'] or 'work'}\n\nextras")
    for extra, missing in found["missing"].items():
        need = f'missing {", ".join(missing)}: pip install "beamfem[{extra}]"'
        print(f"  {extra:14s} {need if missing else 'installed'}")
