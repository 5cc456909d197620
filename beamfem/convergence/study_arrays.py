"""A convergence study as labelled arrays: curves times refinement."""

from numbers import Real
from typing import Any

import numpy as np

from beamfem.convergence.convergence_result import Convergence
from beamfem.extras import needed_for


def as_grid(study: Convergence) -> Any:
    """Return the xarray.Dataset of a study, see `Convergence.to_xarray`."""
    with needed_for("to_xarray"):
        import xarray
    sizes = {value: size for curve in study.curves for value, size in zip(curve.refinement, curve.size, strict=True)}
    refinement = sorted(sizes, key=lambda value: -sizes[value])  # from coarse to fine
    header, rows = study.points()
    shape = len(study.curves), len(refinement)
    places = [
        (number, refinement.index(value)) for number, curve in enumerate(study.curves) for value in curve.refinement
    ]
    data: dict[str, Any] = {
        "fitted_order": ("curve", [curve.fit.order if curve.fit else np.nan for curve in study.curves]),
        "limit": ("curve", [curve.limit for curve in study.curves]),
        "estimated_error": ("curve", [curve.estimated_error for curve in study.curves]),
    }
    for name, column in zip(header, zip(*rows, strict=True), strict=True):
        if name != study.refine and all(value is None or isinstance(value, Real) for value in column):
            grid = np.full(shape, np.nan)
            for index, value in zip(places, column, strict=True):
                grid[index] = np.nan if value is None else value
            title = f"{name} (result)" if name in data or name == "curve" else name
            data[title] = ("curve", study.refine), grid
    coordinates = {"curve": [curve.label for curve in study.curves], study.refine: refinement}
    return xarray.Dataset(data, coordinates, {"function": study.function, "quantity": study.quantity})
