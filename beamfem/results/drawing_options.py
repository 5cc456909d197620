"""Options of plots, animations and HTML pages of results, for editors and type checkers."""

from typing import TypedDict


class ShapeOptions(TypedDict, total=False):
    """Options of `solution.plot`, see `beamfem.view.drawing.plot_shapes`."""

    colour: str | None
    shapes: int | None
    undeformed: bool
    supports: bool
    loads: bool


class FilmOptions(TypedDict, total=False):
    """Options of `solution.animate`, see `beamfem.view.animation.animate`."""

    fps: float
    seconds: float
    colour: str | None
    undeformed: bool
    supports: bool
    loads: bool
    dpi: int


class PageOptions(TypedDict, total=False):
    """Options of `solution.to_html`, see `beamfem.view.player.write_player`."""

    title: str | None
    frames: int


class WindowOptions(TypedDict, total=False):
    """Options of `solution.show`, see `beamfem.view.body.show`."""

    colour: str | None
    size: tuple[int, int]


class PictureOptions(WindowOptions, total=False):
    """Options of `solution.picture`, see `beamfem.view.body.picture`."""

    row: int


class ModeOptions(TypedDict, total=False):
    """Options of `modes.plot` and `buckling.plot`, see `beamfem.view.mode_shapes`."""

    most: int
