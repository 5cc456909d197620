"""Steady response to a harmonic load about a state."""

from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from os import PathLike
from typing import TYPE_CHECKING, Any

import numpy as np
from scipy.linalg import LinAlgError
from scipy.sparse import csc_array

from beamfem.equations.system import system_of
from beamfem.errors import ConvergenceError, InputError, UnstableWarning, warn
from beamfem.linalg.lapack import superlu
from beamfem.model.load_base import Load
from beamfem.model.model import Model
from beamfem.results.solution import Solution, State
from beamfem.solve.linear.linear_model import LinearModel, Quantity, require_digits
from beamfem.solve.linear.linearise import linearise
from beamfem.solve.modes.modes import meshed_for_modes
from beamfem.validation import items, not_negative, squared

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_SLOWEST, _GROWTH = 12, 1e-6  # vibrations that are looked at, and growth per radian that is none


@dataclass(frozen=True, eq=False)
class FrequencyResponse:
    """Steady response to a harmonic load: y = Re(value exp(2 pi i f t)) for the load times cos(2 pi f t).

    Parameters
    ----------
    model : Model
        The model.
    load : Load
        The load.
    quantity : (str, Point)
        What responds, such as ("uy", beam.end).
    frequencies : array, [Hz], (m,)
        Frequencies f.
    values : array, (m,)
        Complex responses [m] or [rad].

    Examples
    --------
    >>> response = bf.frequency_response(model, model.loads[0], ("uy", beam.end), [0.0, 10.0])
    >>> response.amplitude.round(4)
    array([0.0305, 0.0394])
    """

    model: Model
    load: Load
    quantity: Quantity
    frequencies: np.ndarray
    values: np.ndarray

    def __len__(self) -> int:
        return len(self.frequencies)

    @property
    def amplitude(self) -> np.ndarray:
        """Amplitudes abs(value) [m] or [rad], (m,)."""
        return np.abs(self.values)

    @property
    def phase(self) -> np.ndarray:
        """Phases of the response [rad], (m,), from -pi to pi; negative where it lags behind the load."""
        return np.angle(self.values)

    def plot(self, path: str | PathLike[str] | None = None, *, ax: Any = None) -> "Figure":
        """Draw amplitude and phase against frequency and return the figure.

        path: file to write (PNG, SVG, PDF); ax: two axes to draw in, see `Solution.plot`. Raises InputError for another
        number of axes, MissingPackageError without matplotlib.

        Examples
        --------
        >>> sweep = np.linspace(1.0, 200.0, 400)
        >>> response = bf.frequency_response(model, model.loads[0], ("uy", beam.end), sweep)
        >>> figure = response.plot("response.png")
        """
        from beamfem.view.quantity_curve import plot_response

        return plot_response(self, path, ax)


def frequency_response(
    model: Model,
    load: Load,
    quantity: Quantity,
    frequencies: Sequence[float] | np.ndarray,
    about: State | Solution | None = None,
) -> FrequencyResponse:
    """Find the steady response to a harmonic load, y = c (K + i w C - w^2 M)^-1 b with w = 2 pi f.

    M, C, K, b and c are those of `linearise`: for small vibrations about the state. Beams with default elements are
    refined until all frequencies up to those of the load, and the 10 lowest ones, are accurate to 1e-4.

    Parameters
    ----------
    model : Model
        Beams, supports, loads, joints and connectors.
    load : Load
        The load that vibrates with its whole size as amplitude: one of the model's loads, or another one at a node.
    quantity : (str, Point)
        What responds: "ux", "uy" [m] or "rotation" [rad], and a point.
    frequencies : sequence of float, [Hz]
        Frequencies f >= 0.
    about : State or Solution, optional
        State to vibrate about, see `linearise`; by default the reference.

    Returns
    -------
    FrequencyResponse
        The complex response at each frequency.

    Raises
    ------
    InputError
        For an invalid argument, see `linearise`, if the response is infinite, and for frequencies above too many modes
        of beams with default elements.
    UnknownPointError
        For a point on a beam that is not in the model.
    ConvergenceError
        If stiffnesses or inertias differ so much that round-off leaves a response no three digits.

    Warns
    -----
    UnstableWarning
        If small motions about the state grow.

    Examples
    --------
    >>> push = bf.PointForce(beam.end, (0.0, 1.0))
    >>> response = bf.frequency_response(model, push, ("uy", beam.end), [0.0, 10.0], about=solution)
    >>> response.values.shape
    (2,)
    """
    valid = squared(not_negative)
    at = np.array([valid("each of the frequencies", f) for f in items("frequencies", frequencies)], dtype=float)
    if system_of(model, static=True).model.automatic:
        model, about = meshed_for_modes(model, about, float(at.max(initial=0.0)))
    linear = linearise(model, about, [load])
    if about is not None and linear.static and _grows(linear):
        warn("small motions about the state grow, so that it has no steady response", UnstableWarning)
    row = linear.output(quantity)
    values = np.array([row @ _moved(linear, frequency) for frequency in at.tolist()], dtype=complex)
    return FrequencyResponse(model, load, quantity, at, values)


def _grows(linear: LinearModel) -> bool:
    """Return whether one of the slowest vibrations grows by more than round-off."""
    with suppress(ConvergenceError):
        return bool(np.any(linear.modes(min(_SLOWEST, len(linear))).ratios < -_GROWTH))
    return False


def _moved(linear: LinearModel, frequency: float) -> np.ndarray:
    """Return the response (m,) of all coordinates to the only load. Raises InputError where it is infinite."""
    rate, force = 2.0 * np.pi * frequency, linear.input_matrix[:, 0]
    dynamic = csc_array(linear.stiffness + 1j * rate * linear.damping - rate**2 * linear.mass)
    try:
        moved = superlu(dynamic).solve(force.astype(complex))
        # where the matrix is singular up to round-off, that of its product is as large as the load
        lost = np.finfo(float).eps * (linear.scale @ (abs(dynamic) @ np.abs(moved)))
        if lost <= linear.scale @ np.abs(force):
            what = f"the response at {frequency:g} {linear.model.unit('Hz')}"
            require_digits(linear, 1j * rate, moved, np.vdot(moved, force), what)
            return np.asarray(moved)
    except LinAlgError:
        pass
    raise InputError(
        f"the response at {frequency:g} {linear.model.unit('Hz')} is infinite: a mode of this frequency has no "
        "damping, or is hidden by the round-off of much larger stiffnesses"
    )
