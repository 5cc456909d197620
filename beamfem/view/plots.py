"""Figures of matplotlib without a window, and how they are saved; see `quantity_curve` and `drawing` for plots."""

from os import PathLike
from typing import Any

from beamfem.atomic_write import path_of, whole
from beamfem.equations.callbacks import uninterrupted
from beamfem.errors import InputError
from beamfem.extras import needed_for

# Paul Tol's bright palette: told apart by the colour-blind and in grey print
COLOURS = ("#4477AA", "#EE6677", "#228833", "#CCBB44", "#66CCEE", "#AA3377", "#BBBBBB")
MARKERS = "osD^vP*X<>"  # in grey print, and where there are more curves than colours
_DOTS_PER_INCH = 160


def empty_figure(width: float, height: float, layout: Any = "constrained") -> Any:
    """Return a figure [inch], by default one that lays itself out. Raises MissingPackageError without matplotlib."""
    with needed_for("a picture"):
        from matplotlib.backends.backend_agg import FigureCanvasAgg

        from beamfem.view.notebook_figure import ShownFigure
    figure = ShownFigure(figsize=(width, height), layout=layout, dpi=100)
    FigureCanvasAgg(figure)
    return figure


def new_figure(width: float = 6.4, height: float = 4.2) -> tuple[Any, Any]:
    """Return a figure [inch] and its axes with quiet spines and a light grid."""
    figure = empty_figure(width, height)
    axes = figure.subplots()
    quiet(axes)
    return figure, axes


def quiet(axes: Any) -> None:
    """Remove the parts of the frame without numbers and add a light grid."""
    axes.grid(True, color="0.9", linewidth=0.6)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


# compiled code of matplotlib takes an interrupt for a wrong argument, or ignores it
@uninterrupted
def save_figure(figure: Any, path: str | PathLike[str] | None) -> Any:
    """Write a figure, if a path is given, to PNG, SVG or PDF according to its suffix; return the figure."""
    if path is None:
        return figure
    kinds = figure.canvas.get_supported_filetypes()
    kind = path_of(path).suffix.lower().removeprefix(".")
    if kind not in kinds:
        raise InputError(f'a picture is a .png, .svg or .pdf file, or one of {", ".join(sorted(kinds))}; got "{path}"')
    with whole(path) as partial:
        figure.savefig(partial, dpi=_DOTS_PER_INCH, format=kind)
    return figure
