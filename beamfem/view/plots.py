"""Figures and axes of matplotlib, and how they are saved; see `quantity_curve` and `drawing` for plots."""

from os import PathLike
from threading import current_thread, main_thread
from typing import Any

import numpy as np

from beamfem.atomic_write import path_of, whole
from beamfem.equations.callbacks import uninterrupted
from beamfem.errors import InputError
from beamfem.extras import needed_for
from beamfem.progress import in_notebook
from beamfem.validation import shown
from beamfem.view.rendering import has_display

# Paul Tol's bright palette: told apart by the colour-blind and in grey print
COLOURS = ("#4477AA", "#EE6677", "#228833", "#CCBB44", "#66CCEE", "#AA3377", "#BBBBBB")
MARKERS = "osD^vP*X<>"  # in grey print, and where there are more curves than colours
_DOTS_PER_INCH = 160


def empty_figure(width: float, height: float, layout: Any = "constrained", pyplot: bool = False) -> Any:
    """Return a figure [inch], by default one that lays itself out. Raises MissingPackageError without matplotlib.

    pyplot: whether `plt.show()` opens it where there is a display, and a notebook displays it after the cell.
    """
    with needed_for("a picture"):
        from matplotlib.backends.backend_agg import FigureCanvasAgg

        from beamfem.view.notebook_figure import ShownFigure
    options = {"figsize": (width, height), "layout": layout, "dpi": 100}
    if pyplot and (in_notebook() or has_display()) and current_thread() is main_thread():  # as windows demand
        from matplotlib import pyplot as plt

        return plt.figure(FigureClass=ShownFigure, **options)
    figure = ShownFigure(**options)
    FigureCanvasAgg(figure)
    return figure


def new_figure(width: float = 6.4, height: float = 4.2, ax: Any = None, pyplot: bool = False) -> tuple[Any, Any]:
    """Return a figure [inch] and its axes with quiet spines and a light grid; those of the user where `ax` is given."""
    axes = empty_figure(width, height, pyplot=pyplot).subplots() if ax is None else given_axes(ax)[0]
    quiet(axes)
    return axes.figure.figure, axes


def given_axes(ax: Any, number: int = 1) -> list[Any]:
    """Return the axes that a user gave. Raises InputError if they are not as many as needed."""
    with needed_for("a picture"):
        from matplotlib.axes import Axes

    found = np.ravel(np.asarray(ax, dtype=object)).tolist()
    if len(found) != number or not all(isinstance(axes, Axes) for axes in found):
        needed = "one axes, such as plt.gca()" if number == 1 else f"{number} axes, such as plt.subplots({number})[1]"
        got = f"{len(found)} axes" if all(isinstance(axes, Axes) for axes in found) else shown(ax)
        raise InputError(f"ax: this picture needs {needed}, got {got}")
    return found


def legend_over(axes: Any, columns: int) -> None:
    """Write a legend without a frame above the axes."""
    axes.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=columns, frameon=False)


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
