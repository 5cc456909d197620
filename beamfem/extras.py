"""Packages that only some tasks need, each with the extra of beamfem that installs it."""

from collections.abc import Iterator
from contextlib import contextmanager
from importlib.util import find_spec

from beamfem.errors import MissingPackageError

_EXTRAS = {
    "ezdxf": "cad",
    "h5py": "store",
    "imageio-ffmpeg": "video",
    "matplotlib": "plot",
    "pandas": "pandas",
    "meshio": "mesh",
    "pillow": "plot",
    "pyvista": "vtk",
    "vtk": "vtk",
    "xarray": "xarray",
}
_INSTALLED_AS = {"PIL": "pillow", "imageio_ffmpeg": "imageio-ffmpeg", "vtkmodules": "vtk"}


@contextmanager
def needed_for(task: str, otherwise: str = "") -> Iterator[None]:
    """Import packages inside. Raises MissingPackageError that names the task and the extra where one is missing.

    otherwise: what would do without.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        imported = (error.name or "").partition(".")[0]
        package = _INSTALLED_AS.get(imported, imported)
        if package not in _EXTRAS:
            raise
        remedy = f'pip install "beamfem[{_EXTRAS[package]}]"' + (f"; {otherwise}" if otherwise else "")
        raise MissingPackageError(f"{task} needs {package}, which is not installed: {remedy}") from None


def require_package(name: str, task: str) -> None:
    """Look for a package without importing it. Raises MissingPackageError as `needed_for` does."""
    with needed_for(task):
        if find_spec(name) is None:
            raise ModuleNotFoundError(name=name)
