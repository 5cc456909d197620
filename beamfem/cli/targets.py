"""Files that a command is to write, checked before the solve rather than after."""

import tempfile
from pathlib import Path

from beamfem.errors import InputError
from beamfem.extras import require_package

_NEEDED: dict[str, tuple[str, ...]] = {
    "out": ("h5py",),
    "plot": ("matplotlib",),
    "curve": ("matplotlib",),
    "vtk": ("vtkmodules",),
    "table": (),
    "film": ("matplotlib",),
    "page": (),
    "body": ("matplotlib",),
}
_OTHERWISE: dict[str, tuple[str, ...]] = {".html": (), ".mp4": ("matplotlib", "imageio_ffmpeg")}
_SUFFIXES = {
    "out": (".h5", ".hdf5"),
    "plot": (".png", ".svg", ".pdf", ".html", ".gif", ".mp4"),
    "curve": (".png", ".svg", ".pdf"),
    "vtk": (".pvd", ".vtkhdf"),
    "table": (".csv",),
    "film": (".gif", ".mp4"),
    "page": (".html",),
    "body": (".png",),
}


def below(folder: Path, name: str) -> Path:
    """Return a file below a folder. Raises InputError for one elsewhere, since a model file may come from anybody."""
    if not (folder / name).resolve().is_relative_to(folder.resolve()):
        raise InputError(
            f"{name} is not below the folder of the model file, {folder.resolve()}, and could replace any file; name "
            "one below it, or let the command write it with --out, --vtk or --plot"
        )
    return folder / name


def require_target(option: str, path: Path | None) -> None:
    """Raise InputError if a file of this kind cannot be written: wrong suffix, a folder of that name, missing package.

    option: "out", "plot", "vtk"; "curve" or "table" of a sweep; "film", "page" or "body" of a model file.
    """
    if path is None:
        return
    suffixes = _SUFFIXES[option]
    if path.suffix.lower() not in suffixes:
        right = f"{path.with_suffix(suffixes[0])} would be right" if path.name else ""
        allowed = " or ".join(", ".join(suffixes).rsplit(", ", 1))
        raise InputError(f"{path} must end in {allowed}; {right}")
    if path.is_dir():
        raise InputError(f"{path} is a folder; give the name of a file")
    if not writable(path.parent):
        raise InputError(f"{path} cannot be written: no files can be created in {path.parent}")
    for package in _OTHERWISE.get(path.suffix.lower(), _NEEDED[option]):
        require_package(package, f"writing {path}")


def writable(folder: Path) -> bool:
    """Return whether a file can be created in a folder, or in its nearest existing parent."""
    while not folder.exists():
        folder = folder.parent
    try:
        with tempfile.NamedTemporaryFile(dir=folder):
            return True
    except OSError:
        return False
