"""Motions that are seen while they run: in a window, or in a picture of a notebook that renews itself."""

import time as clock
from collections.abc import Callable
from typing import Any

import numpy as np

from beamfem.equations.callbacks import uninterrupted
from beamfem.extras import needed_for
from beamfem.model.model import Model
from beamfem.progress import in_notebook
from beamfem.results.solution import Solution
from beamfem.results.status import Statistics
from beamfem.view.deformed_shapes import Shapes, draw_undeformed
from beamfem.view.frames import moment_of
from beamfem.view.plots import empty_figure, quiet
from beamfem.view.rendering import has_display
from beamfem.view.support_symbols import draw_joints, supports_of

_SHARE = 0.05  # of the time, which drawing takes at most
_POINTS = 600  # of all beams
_MARGIN = 0.1  # of the size of the picture
_SIZE = (7.0, 5.0)  # [inch]


def live_view(model: Model) -> Callable[[float, np.ndarray], None]:
    """Return what shows states (3, n) at times [s], as often as it may; nothing without a window and a notebook."""
    if in_notebook():
        return LiveView(model, empty_figure(*_SIZE, layout=None), _in_cell()).show
    figure = _window() if has_display() else None
    return (lambda time, state: None) if figure is None else LiveView(model, figure, _in_window).show


class LiveView:
    """Draws the last state of a motion into a figure; present: brings it to the screen, returns whether it is seen."""

    def __init__(self, model: Model, figure: Any, present: Callable[[Any], bool]) -> None:
        self._model, self._figure, self._present = model, figure, present
        self._axes: Any = None
        self._box, self._artists, self._next = np.empty((0, 2)), list[Any](), 0.0

    # compiled code of matplotlib takes an interrupt for a wrong argument, or ignores it
    @uninterrupted
    def show(self, time: float, state: np.ndarray) -> None:
        """Draw a state (3, n) at a time [s], unless that would take too large a share of the time."""
        begin = clock.perf_counter()
        if begin < self._next:
            return
        p, v, a = state[:3, None].copy()
        now = Solution(self._model, False, np.array([time]), p, v, a, Statistics(0, 0, 0, ""))
        shapes = Shapes(now, np.array([0]), total=_POINTS)
        if self._axes is None:
            self._begin(shapes)
            begin = clock.perf_counter()  # a window opens once
        boxes = np.concatenate([self._box, shapes.box])
        self._box = np.stack([boxes.min(axis=0), boxes.max(axis=0)])
        for artist in self._artists:
            artist.remove()
        self._artists = shapes.draw(self._axes, 0)
        self._artists += supports_of(now, 0, shapes.centre).draw(self._axes) + draw_joints(self._axes, now, 0)
        margin = _MARGIN * float(np.max(self._box[1] - self._box[0]))
        self._axes.set_xlim(self._box[0, 0] - margin, self._box[1, 0] + margin)
        self._axes.set_ylim(self._box[0, 1] - margin, self._box[1, 1] + margin)
        self._axes.set_title(moment_of(now, 0), fontsize=10)
        seen = self._present(self._figure)
        self._next = begin + (clock.perf_counter() - begin) / _SHARE if seen else np.inf

    def _begin(self, shapes: Shapes) -> None:
        self._axes = self._figure.subplots()
        quiet(self._axes)
        self._axes.set_aspect("equal")
        for name, label in (("x", self._axes.set_xlabel), ("y", self._axes.set_ylabel)):
            label(f"{name} [{self._model.unit('m')}]")
        draw_undeformed(self._axes, shapes.points)
        self._present(self._figure)


def _in_cell() -> Callable[[Any], bool]:
    """Return what shows a figure below the cell of a notebook, in the place of the one before."""
    from IPython.display import display

    handles: list[Any] = []

    def present(figure: Any) -> bool:
        # as data: a figure that displays itself would be shown anew below the one before
        picture = {"image/png": figure._repr_png_(), "text/plain": figure.axes[0].get_title()}
        if handles:
            handles[0].update(picture, raw=True)
        else:
            handles.append(display(picture, raw=True, display_id=True))
        return True

    return present


def _window() -> Any:
    """Return a figure in a window of matplotlib; None if its backend has none."""
    with needed_for("a live view"):
        from matplotlib import pyplot
    figure = pyplot.figure(figsize=_SIZE)
    if figure.canvas.required_interactive_framework is None:
        pyplot.close(figure)
        return None
    pyplot.show(block=False)
    return figure


def _in_window(figure: Any) -> bool:
    """Draw a figure in its window; return whether that is still open."""
    from matplotlib import pyplot

    if not pyplot.fignum_exists(figure.number):
        return False
    figure.canvas.draw_idle()
    figure.canvas.flush_events()
    return True
