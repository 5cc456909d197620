"""Modes of vibration and of buckling as labelled arrays."""

from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.io.table import Variables, as_dataset, groups_of, named, side_by_side, stations
from beamfem.model.beam import Beam
from beamfem.model.model import Model

if TYPE_CHECKING:
    from beamfem.solve.modes.modes import Modes
    from beamfem.solve.stability.buckling import Buckling

_OVER = ("mode",)


def modes_to_xarray(modes: "Modes", beam: Beam | None = None) -> Any:
    """Return an xarray.Dataset over the modes: frequency [Hz], growth [1/s], rigid motion, shapes ux, uy along beams.

    Shapes are scaled as `modes.modes`; of complex ones the real part. Stations as in `solution.to_xarray`.
    """
    about = partial(named, modes.model)
    rigid = np.array([*modes.rigid, *[""] * (len(modes) - len(modes.rigid))], dtype=object)
    data: Variables = {
        "frequency": (_OVER, modes.frequencies, about("frequency", "Hz")),
        "growth": (_OVER, modes.growth, about("growth", "1/s")),
        "rigid": (_OVER, rigid, {"long_name": "what a rigid mode moves"}),
    }
    states = np.broadcast_to(modes.state.p, modes.modes.shape)
    return _with_shapes(modes.model, states, np.real(modes.modes), beam, data)


def buckling_to_xarray(buckling: "Buckling", beam: Beam | None = None) -> Any:
    """Return an xarray.Dataset over the critical points: load_factor, kind, uncertainty, shapes ux, uy.

    Shapes are scaled as `buckling.modes`. Stations as in `solution.to_xarray`.
    """
    about = partial(named, buckling.model)
    data: Variables = {
        "load_factor": (_OVER, buckling.load_factors, about("load factor", "1")),
        "kind": (_OVER, np.array(buckling.kinds, dtype=object), {"long_name": "kind of critical point"}),
        "uncertainty": (_OVER, buckling.uncertainty, about("relative error of the load factor", "1")),
    }
    dataset = _with_shapes(buckling.model, buckling.states, buckling.modes, beam, data)
    return dataset.assign_attrs(ended=buckling.ended, status=buckling.status.name)


def _with_shapes(model: Model, p: np.ndarray, shapes: np.ndarray, beam: Beam | None, data: Variables) -> Any:
    """Return the data with ux, uy of shapes (modes, n) about states p (modes, n) along one beam or all."""
    parts = []
    for group in groups_of(model, beam, len(shapes)):
        rates = group.points.velocities(p, shapes)
        about = [{"long_name": f"shape {axis}"} for axis in "xy"]
        both: Variables = {f"u{name}": ((*_OVER, "station"), rates[..., i], about[i]) for i, name in enumerate("xy")}
        parts.append((both, stations(model, group)))
    moved, places = side_by_side(parts)
    number: Variables = {"mode": (_OVER, np.arange(len(shapes)), {"long_name": "number of the mode"})}
    return as_dataset(data | moved, number | places, {}, single=beam is not None)
