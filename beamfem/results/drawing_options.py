"""What the pictures, films and pages of results may be asked for, by name and type, for editors and type checkers."""

from typing import TypedDict


class ShapeOptions(TypedDict, total=False):
    """Of `solution.plot`, see `beamfem.view.drawing.plot_shapes`."""

    colour: str | None
    shapes: int
    undeformed: bool
    supports: bool
    loads: bool


class FilmOptions(TypedDict, total=False):
    """Of `solution.animate`, see `beamfem.view.animation.animate`."""

    fps: float
    seconds: float
    colour: str | None
    undeformed: bool
    supports: bool
    loads: bool
    dpi: int


class PageOptions(TypedDict, total=False):
    """Of `solution.to_html`, see `beamfem.view.player.write_player`."""

    title: str | None
    frames: int


class WindowOptions(TypedDict, total=False):
    """Of `solution.show`, see `beamfem.view.body.show`."""

    colour: str | None
    size: tuple[int, int]


class PictureOptions(WindowOptions, total=False):
    """Of `solution.picture`, see `beamfem.view.body.picture`."""

    row: int


class ModeOptions(TypedDict, total=False):
    """Of `modes.plot` and `buckling.plot`, see `beamfem.view.mode_shapes`."""

    most: int
