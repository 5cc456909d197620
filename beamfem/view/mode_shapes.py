"""Pictures of modes: vibration modes with their frequencies, buckling modes with their load factors."""

from collections.abc import Callable
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.errors import InputError
from beamfem.results.solution import Solution
from beamfem.validation import count
from beamfem.view.deformed_shapes import Shapes, draw_undeformed
from beamfem.view.drawing import entry, frame
from beamfem.view.plots import empty_figure, given_axes, save_figure
from beamfem.view.support_symbols import draw_joints, supports_of

if TYPE_CHECKING:
    from beamfem.solve.modes.modes import Modes
    from beamfem.solve.stability.buckling import Buckling

_MOST = 6
_WIDTH, _LEAST_HEIGHT = 3.6, 0.9  # of one picture [inch]


def plot_modes(modes: "Modes", path: str | PathLike[str] | None = None, most: int = _MOST, ax: Any = None) -> Any:
    """Draw the first `most` vibration modes, each with its frequency [Hz]; return the figure. See `Modes.plot`."""

    def title(mode: int) -> str:
        if mode < len(modes.rigid):
            return f"{mode + 1}: {modes.rigid[mode]}"
        growth = modes.growth[mode]
        changes = f", grows {growth:.3g}/{modes.model.unit('s')}" if growth > 0.0 else ""
        if growth < 0.0:
            changes = f", damping ratio {modes.ratios[mode]:.3g}"
        return f"{mode + 1}: {modes.frequencies[mode]:.4g} {modes.model.unit('Hz')}{changes}"

    def rows(mode: int, solution: Solution) -> np.ndarray:
        return np.array([len(solution) - 1] if mode < len(modes.rigid) else [len(solution) // 2, 0])

    return _plot(modes, title, rows, ("half a period later", "at its largest"), path, most, ax)


def plot_buckling(
    buckling: "Buckling", path: str | PathLike[str] | None = None, most: int = _MOST, ax: Any = None
) -> Any:
    """Draw the first `most` buckling modes, each with its critical load factor; return the figure: `Buckling.plot`."""

    def title(mode: int) -> str:
        ends = " (limit point)" if buckling.kinds[mode] == "limit point" else ""
        return f"{mode + 1}: load factor {buckling.load_factors[mode]:.5g}{ends}"

    def rows(mode: int, solution: Solution) -> np.ndarray:
        return np.array([0, 1])

    return _plot(buckling, title, rows, ("critical state", "with the mode"), path, most, ax)


def _plot(
    modes: "Modes | Buckling",
    title: Callable[[int], str],
    rows: Callable[[int, Solution], np.ndarray],
    names: tuple[str, str],
    path: str | PathLike[str] | None,
    most: int,
    ax: Any,
) -> Any:
    number = min(len(modes), count("most", most))
    if number == 0:
        raise InputError("there are no modes to draw")
    solutions = [modes.solution(mode) for mode in range(number)]
    shapes = [Shapes(item, rows(mode, item), total=1000) for mode, item in enumerate(solutions)]
    box = np.stack([np.min([item.box[0] for item in shapes], axis=0), np.max([item.box[1] for item in shapes], axis=0)])
    size, unit = box[1] - box[0], modes.model.unit("m")
    columns = min(number, 2 if size[0] > 1.5 * size[1] else 3)
    lines = -(-number // columns)
    height = np.clip(_WIDTH * size[1] / size[0] if size[0] > 0.0 else np.inf, _LEAST_HEIGHT, 1.4 * _WIDTH) + 0.7
    width = np.clip((height - 0.7) * size[0] / max(size[1], 1e-12), 2.2, _WIDTH)
    if ax is None:
        legend = 0.7 if columns > 1 else 1.1  # in a line, or below one another [inch]
        figure = empty_figure(columns * width + 0.6, lines * height + legend, pyplot=path is None)
        grid = figure.subplots(lines, columns, squeeze=False, sharex=True, sharey=True).ravel().tolist()
    else:
        grid = given_axes(ax, number)
    for mode, (axes, item) in enumerate(zip(grid, shapes, strict=False)):
        original = draw_undeformed(axes, item.points)
        for order in range(len(item.rows)):
            item.draw(axes, order, (order + 1) / len(item.rows))
        supports_of(item.solution, int(item.rows[-1]), item.centre).draw(axes)
        draw_joints(axes, item.solution, int(item.rows[-1]))
        frame(axes, box.mean(axis=0), size * 1.06 + 0.08 * size.max(), np.array([width, height - 0.7]), unit)
        axes.set_title(title(mode), fontsize=10)
        if ax is None:
            axes.label_outer()
    for axes in grid[number:]:
        axes.set_visible(False)
    if ax is None:
        entries = [original, *(entry(0.5 * (order + 1), name) for order, name in enumerate(names))]
        options = {"ncols": 3 if columns > 1 else 1, "frameon": False, "fontsize": 9}
        figure.legend(handles=entries, loc="outside lower center", **options)
    return save_figure(grid[0].figure.figure, path)
