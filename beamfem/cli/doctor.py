"""`beamfem doctor`: check of the installation."""

import re
import subprocess
import sys
import time
from typing import Any

import typer

from beamfem.cli.report import FAILED, AsJson, print_json, reported, writable

_RENDER = """
import pyvista
plotter = pyvista.Plotter(off_screen=True, window_size=(64, 48))
plotter.add_mesh(pyvista.Sphere())
picture = plotter.screenshot(None, return_img=True)
assert picture.min() < picture.max()
"""
_NOT_SHOWN = ("all", "test", "bench", "docs")


def doctor(as_json: AsJson = False) -> None:
    """Check the installation: versions, compiled kernels, a first solve, pictures of bodies and missing extras."""
    with reported(as_json):
        start = time.perf_counter()
        from beamfem.kernels.cache import cache_folder, kept

        cache = cache_folder()
        report: dict[str, Any] = {
            "versions": versions(),
            "cache": {
                "folder": cache,
                "writable": cache is not None and writable(cache),
                "compiled_kernels": kept(),
                "import_seconds": time.perf_counter() - start,
            },
            "first_solve": first_solve(),
            "rendering": rendering(),
            "extras": extras(),
        }
        print_json(report) if as_json else _print(report)
        if not report["first_solve"]["right"]:
            raise typer.Exit(FAILED)


def versions() -> dict[str, str]:
    """Return the versions of Python, of beamfem and of the packages that it needs."""
    import platform
    from importlib.metadata import version

    names = [name for name, extra in _requirements() if not extra]
    return {
        "python": platform.python_version(),
        "system": platform.platform(),
        "beamfem": version("beamfem"),
        **{name: version(name) for name in names if _installed(name)},
    }


def first_solve() -> dict[str, Any]:
    """Solve a cantilever twice: seconds of each solve, kernels compiled for it, and whether the result is right.

    P L^2 / (E I) = 5 of the geometrically exact beam with L / h = 100: tip deflection 0.71385896416 L.
    """
    from beamfem.assembly.compiled import compiled_here
    from beamfem.curves import Line
    from beamfem.element.presets import CRBF
    from beamfem.material import Material
    from beamfem.model.beam import Beam
    from beamfem.model.loads import PointForce
    from beamfem.model.model import Model
    from beamfem.model.supports import Clamp
    from beamfem.section import Rectangle
    from beamfem.solve.statics.statics import solve_static

    section, material = Rectangle(0.01, 0.01), Material(2e11, 0.3, 7800.0)
    beam = Beam(Line((0, 0), (1, 0)), 4, CRBF(4), section, material)
    force = 5.0 * material.youngs_modulus * section.second_moment
    model = Model([beam], [Clamp(beam.start)], [PointForce(beam.end, (0.0, force))])
    before = len(compiled_here())
    seconds = []
    for _ in range(2):
        start = time.perf_counter()
        deflection = float(solve_static(model).displacement(beam.end)[-1, 1])
        seconds.append(time.perf_counter() - start)
    return {
        "seconds": seconds[0],
        "again_seconds": seconds[1],
        "kernels_compiled_now": len(compiled_here()) - before,
        "deflection": deflection,
        "right": abs(deflection - 0.71385896416) < 1e-6,
    }


def rendering() -> dict[str, Any]:
    """Return whether VTK can draw, tested in a separate process because a missing library may crash it."""
    try:
        process = subprocess.run(
            [sys.executable, "-c", _RENDER], capture_output=True, text=True, timeout=120, check=False
        )
    except subprocess.TimeoutExpired:
        return {"possible": False, "reason": "no picture within 120 s"}
    if process.returncode == 0:
        return {"possible": True, "reason": ""}
    if process.returncode < 0:
        reason = f"VTK was killed by signal {-process.returncode}; on Debian: apt-get install libegl1 libgl1-mesa-dri"
    else:
        reason = (process.stderr.strip().splitlines() or ["no reason given"])[-1]
    return {"possible": False, "reason": reason}


def extras() -> list[dict[str, Any]]:
    """Return for each optional extra its missing packages and how to install them."""
    packages: dict[str, list[str]] = {}
    for name, extra in _requirements():
        if extra and extra not in _NOT_SHOWN:
            packages.setdefault(extra, []).append(name)
    return [
        {
            "extra": extra,
            "packages": names,
            "missing": [name for name in names if not _installed(name)],
            "install": f'pip install "beamfem[{extra}]"',
        }
        for extra, names in sorted(packages.items())
    ]


def _requirements() -> list[tuple[str, str]]:
    """Return the requirements of beamfem, each with the extra it belongs to, or ""."""
    from importlib.metadata import requires

    requirements = []
    for line in requires("beamfem") or ():
        name = re.match(r"[A-Za-z0-9._-]+", line)
        extra = re.search(r"extra\s*==\s*['\"]([^'\"]+)['\"]", line)
        requirements.append((name[0] if name else line, extra[1] if extra else ""))
    return requirements


def _installed(name: str) -> bool:
    from importlib.metadata import PackageNotFoundError, version

    try:
        version(name)
    except PackageNotFoundError:
        return False
    return True


def _print(found: dict[str, Any]) -> None:
    cache, solve, drawing = found["cache"], found["first_solve"], found["rendering"]
    print("versions")
    for name, version in found["versions"].items():
        print(f"  {name:14s} {version}")
    where = cache["folder"] or "nowhere: set BEAMFEM_CACHE_DIR to a folder that can be written to"
    print(f"\nkernels kept in {where}{'' if cache['writable'] else ', which cannot be written to'}")
    print(f"  {cache['compiled_kernels']} were compiled before, {solve['kernels_compiled_now']} just now")
    verdict = "right" if solve["right"] else f"WRONG: tip deflection {solve['deflection']:.8f} instead of 0.71385896"
    print(f"\nfirst solve {solve['seconds']:.2f} s, again {1e3 * solve['again_seconds']:.1f} ms: {verdict}")
    print(f"\npictures of bodies: {'work' if drawing['possible'] else 'do not work, ' + drawing['reason']}")
    print("\nextras")
    for item in found["extras"]:
        state = f"missing {', '.join(item['missing'])}: {item['install']}" if item["missing"] else "installed"
        print(f"  {item['extra']:14s} {state}")
