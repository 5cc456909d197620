"""Whether VTK can render on this machine, tried in a child process: a failure kills the process without an error."""

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import lru_cache

from beamfem.extras import require_package

_SECONDS = 60
_PROBE = """
import pyvista
plotter = pyvista.Plotter(off_screen=True, window_size=(16, 16))
plotter.add_mesh(pyvista.Triangle())
plotter.screenshot(None, return_img=True)
print("rendered")
os._exit(0)
"""
ADVICE = "on Debian and Ubuntu `apt-get install --no-install-recommends libegl1 libgl1-mesa-dri` helps"


@lru_cache(maxsize=1)
def can_render() -> bool:
    """Return whether VTK renders a triangle without a window; tried once per process.

    Raises MissingPackageError if it is not installed.
    """
    require_package("pyvista", "a picture of the body")
    command = [sys.executable, "-c", f"import os{_PROBE}"]
    try:
        process = subprocess.run(command, capture_output=True, timeout=_SECONDS, check=False)
    except (OSError, subprocess.TimeoutExpired):
        return False
    return process.returncode == 0 and b"rendered" in process.stdout


def has_display() -> bool:
    """Return whether a window can be opened."""
    if sys.platform in ("win32", "darwin"):
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


@contextmanager
def no_display_needed() -> Iterator[None]:
    """Keep VTK from warning on stderr that it found no display, where none is looked for; errors are still shown."""
    if has_display():
        yield
        return
    from vtkmodules.vtkCommonCore import vtkLogger

    before = vtkLogger.GetCurrentVerbosityCutoff()
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    try:
        yield
    finally:
        vtkLogger.SetStderrVerbosity(before)
