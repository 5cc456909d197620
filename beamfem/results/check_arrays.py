"""Checks that the arrays of states fit their model, made on construction because users can build states themselves."""

from typing import Any

import numpy as np

from beamfem.errors import InputError
from beamfem.model.model import Model
from beamfem.results.path import Bifurcation
from beamfem.results.solution import Solution, State
from beamfem.validation import finite, flag, shown

_REAL = "fiu"  # dtype kinds
_TYPES = {_REAL: np.dtype(float), "b": np.dtype(bool)}


def require_state(state: State) -> None:
    """Raise InputError unless the arrays of a state have one number for each coordinate of its model."""
    _require_arrays(state, (), ("p", "v", "a"))
    object.__setattr__(state, "at", finite(f"at of {type(state).__name__}", state.at))


def require_crossing(state: Bifurcation) -> None:
    """Raise InputError if the directions of a bifurcation do not fit its model or are not finite."""
    _require_array(state, "mode", (state.model.size,))
    _require_array(state, "tangent", (state.model.size + 1,))
    for name in ("mode", "tangent"):
        _require_finite(f"{name} of {type(state).__name__}", getattr(state, name))


def require_rows(solution: Solution) -> None:
    """Raise InputError unless the arrays of a solution have a row of its model's coordinates for each `at`.

    Only `at` and p are checked for finite values: reading v and a of static solutions would allocate their memory. What
    is computed from the arrays is kept, so that they become read-only.
    """
    kind = type(solution).__name__
    flag(f"static of {kind}", solution.static)
    if np.ndim(solution.at) != 1:
        raise InputError(f"at of {kind} must be a list of load factors or times, got {shown(solution.at)}")
    rows = (len(solution.at),)
    _require_arrays(solution, rows, ("p", "v", "a"))
    _require_array(solution, "at", rows)
    for name, kinds in (("stability", "b"), ("loaded", _REAL)):
        if getattr(solution, name) is not None:
            _require_array(solution, name, rows, kinds)
    if solution.exchanged is not None:
        _require_array(solution, "exchanged", (*rows, 2))
    for name in ("at", "p"):
        _require_finite(f"{name} of {kind}", getattr(solution, name))
    for name in ("at", "p", "v", "a"):
        values = getattr(solution, name)
        if values.flags.writeable:  # whoever made it may go on writing to it
            values = values.view()
            values.setflags(write=False)
            object.__setattr__(solution, name, values)


def require_finite(name: str, state: State) -> None:
    """Raise InputError if a state passed as argument `name` has numbers that are not finite."""
    for part in ("p", "v", "a"):
        _require_finite(f"{part} of {name}", getattr(state, part))


def _require_arrays(item: Any, rows: tuple[int, ...], names: tuple[str, ...]) -> None:
    """Raise InputError unless arrays have a number for each coordinate of the model, and `turned` one for each beam."""
    if not isinstance(item.model, Model):
        raise InputError(f"model of {type(item).__name__} must be the Model of its states, got {shown(item.model)}")
    for name in names:
        _require_array(item, name, (*rows, item.model.size))
    if item.turned is not None:
        _require_array(item, "turned", (*rows, len(item.model.numbered.uncounted)))


def _require_array(item: Any, name: str, shape: tuple[int, ...], kinds: str = _REAL) -> None:
    """Convert an attribute to a double precision or boolean array; raise InputError if its shape is wrong."""
    given = getattr(item, name)
    if type(given) is np.ndarray and given.shape == shape and given.dtype == _TYPES[kinds]:
        return
    try:
        values = np.asarray(given)
    except ValueError:  # rows of different lengths
        values = np.empty(0, dtype=object)
    what = f"{name} of {type(item).__name__} must be"
    if values.dtype.kind not in kinds or values.shape != shape:
        got = f"shape {values.shape} of {values.dtype}" if isinstance(given, np.ndarray) else shown(given)
        raise InputError(
            f"{what} an array {shape} of {'truth values' if kinds == 'b' else 'numbers'}, as its model has "
            f"{item.model.size} coordinates, got {got}"
        )
    if values.dtype.kind == "f" and values.dtype.itemsize < 8:
        raise InputError(f"{what} in double precision, got {values.dtype}, in which the digits of strains are lost")
    object.__setattr__(item, name, values if kinds == "b" else values.astype(float))


def _require_finite(name: str, values: np.ndarray) -> None:
    if np.count_nonzero(np.isfinite(values)) < values.size:
        raise InputError(f"{name} must be finite, but contains nan or infinity; use a state found by a solver")
