"""Options of plots, animations and HTML pages of results, for editors, type checkers and help, with their defaults."""

from typing import Annotated, TypedDict


class ShapeOptions(TypedDict, total=False):
    """Options of `solution.plot`, see `beamfem.view.drawing.plot_shapes`."""

    colour: Annotated[str | None, None]
    shapes: Annotated[int | None, None]
    undeformed: Annotated[bool, True]
    supports: Annotated[bool, True]
    loads: Annotated[bool, True]


class FilmOptions(TypedDict, total=False):
    """Options of `solution.animate`, see `beamfem.view.animation.animate`."""

    fps: Annotated[float, 15.0]
    seconds: Annotated[float, 4.0]
    colour: Annotated[str | None, None]
    undeformed: Annotated[bool, True]
    supports: Annotated[bool, True]
    loads: Annotated[bool, True]
    dpi: Annotated[int, 100]


class PageOptions(TypedDict, total=False):
    """Options of `solution.to_html`, see `beamfem.view.player.write_player`."""

    title: Annotated[str | None, None]
    frames: Annotated[int, 60]


class WindowOptions(TypedDict, total=False):
    """Options of `solution.show`, see `beamfem.view.body.show`."""

    colour: Annotated[str | None, None]
    size: Annotated[tuple[int, int], (1400, 900)]


class PictureOptions(WindowOptions, total=False):
    """Options of `solution.picture`, see `beamfem.view.body.picture`."""

    row: Annotated[int, -1]


class ModeOptions(TypedDict, total=False):
    """Options of `modes.plot` and `buckling.plot`, see `beamfem.view.mode_shapes`."""

    most: Annotated[int, 6]
