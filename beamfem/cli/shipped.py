"""Studies, examples and meshes: in the wheel they are in a folder of the package, in the sources beside it."""

from pathlib import Path

_PACKAGE = Path(__file__).parents[1]


def shipped(name: str) -> Path | None:
    """Return the folder "studies", "examples" or "meshes" that comes with beamfem, None if it came without."""
    places = (_PACKAGE / "shipped" / name, _PACKAGE.parent / name)
    return next((folder for folder in places if folder.is_dir()), None)
