"""Amplitude and phase of a frequency response."""

from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.solve.linear.linear_outputs import QUANTITIES
from beamfem.view.labels import place
from beamfem.view.plots import COLOURS, empty_figure, quiet, save_figure

if TYPE_CHECKING:
    from beamfem.solve.linear.frequency_response import FrequencyResponse


def plot_response(response: "FrequencyResponse", path: str | PathLike[str] | None = None) -> Any:
    """Draw amplitude, on a logarithmic axis, and phase [deg] against frequency [Hz]; return the matplotlib figure.

    Raises MissingPackageError without matplotlib.
    """
    figure = empty_figure(6.4, 5.4)
    amplitude, phase = figure.subplots(2, 1, sharex=True, height_ratios=(2, 1))
    model, (name, point) = response.model, response.quantity
    label, unit = QUANTITIES[name]
    order = np.argsort(response.frequencies, kind="stable")
    for axes, values in ((amplitude, response.amplitude), (phase, np.degrees(response.phase))):
        quiet(axes)
        axes.plot(response.frequencies[order], values[order], color=COLOURS[0], linewidth=1.5)
    if response.amplitude.any():
        amplitude.set_yscale("log")
    amplitude.set_ylabel(f"{label} at {place(model, point.reference)} [{model.unit(unit)}]")
    phase.set_ylabel("phase [deg]")
    phase.set_yticks([-180, -90, 0, 90, 180])
    phase.set_xlabel(f"frequency [{model.unit('Hz')}]")
    phase.margins(x=0.02)
    if path is not None:
        save_figure(figure, path)
    return figure
