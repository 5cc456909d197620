"""Drawings of a model before any solve: geometry, supports and loads."""

from os import PathLike
from typing import Any

import numpy as np

from beamfem.assembly.system import system_of
from beamfem.model.model import Model
from beamfem.results.solution import Solution
from beamfem.results.status import Statistics
from beamfem.view.drawing import plot_shapes
from beamfem.view.plots import save_figure


def plot_model(model: Model, path: str | PathLike[str] | None = None) -> Any:
    """Draw the undeformed bodies of a model with supports, joints and full loads; return the figure.

    path: file to write (PNG, SVG, PDF; folders are created). Nothing is solved, so models that are mechanisms or are
    loaded beyond their strength can be drawn too. Raises MissingPackageError without matplotlib.
    """
    p = system_of(model, static=True).reference[None]
    rates = np.zeros_like(p)
    at_rest = Solution(model, True, np.ones(1), p, rates, rates, Statistics(0, 0, 0, "the model without stress"))
    figure = plot_shapes(at_rest, undeformed=False)
    figure.axes[0].set_title("reference shape, full loads", fontsize=10)
    if path is not None:
        save_figure(figure, path)
    return figure
