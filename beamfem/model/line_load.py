"""The base class of forces along beams."""

from abc import abstractmethod
from collections.abc import Mapping
from contextlib import suppress
from typing import Any, get_args

import numpy as np

from beamfem.errors import InputError
from beamfem.model.along_beam import AlongBeam, check_along, ends_and_middle
from beamfem.model.beam import Beam, require_beam
from beamfem.model.load_arrays import forces_of
from beamfem.model.load_base import Load
from beamfem.model.load_shapes import ForcesAlong, LoadShape
from beamfem.model.state_protocols import Axes, Displaced, Placed, in_plane
from beamfem.validation import called, flag, one_of, shown

_ARROWS = 11  # along a beam


class LineLoad(AlongBeam, Load):
    """Forces per length along a beam.

    The axes of the forces are "plane": x and y, per reference length; "section": x and y, rotated with the section from
    the reference, per reference length; or "axis": along r0' and normal to it, to the left, per deformed length.

    Attributes
    ----------
    uniform : bool
        Whether the forces are the same at every arc length.
    """

    uniform: bool = False

    def __post_init__(self) -> None:
        require_beam(type(self).__name__, getattr(self, "beam", None))
        check_along(self)
        super().__post_init__()

    @property
    @abstractmethod
    def axes(self) -> Axes:
        """Axes of the forces: "plane", "section" or "axis"."""

    @abstractmethod
    def forces(self, arc_length: np.ndarray) -> np.ndarray:
        """Return the forces per length, along `axes`.

        Parameters
        ----------
        arc_length : array, [m], (n,)
            Arc lengths of the reference from the start.

        Returns
        -------
        array, [N/m], (n, 2)
            Forces per length.
        """

    def values_of(self, name: str, arc_length: np.ndarray) -> np.ndarray:
        """Return the values of a function named in `along`.

        Parameters
        ----------
        name : str
            Name of the field.
        arc_length : array, [m], (n,)
            Arc lengths of the reference from the start.

        Returns
        -------
        array, (n, ...)
            Values, in the unit of the field.

        Raises
        ------
        InputError
            If the function does not return finite numbers, as many at every arc length.
        """
        function, what = getattr(self, name), f"{name} of {type(self).__name__}"
        results = [called(what, function, s) for s in arc_length.tolist()]
        with suppress(ValueError):  # of different shapes
            if (values := np.array(results)).dtype.kind in "iuf" and np.isfinite(values).all():
                return values
        raise InputError(f"{what} must give finite numbers, as many at every arc length, got {shown(results)}")

    @property
    def place(self) -> Beam:
        """The loaded beam."""
        return self.beam

    @property
    def even(self) -> bool:
        """Whether the forces are one vector of x and y on the whole beam."""
        return self.uniform and self.axes == "plane"

    @property
    def layout(self) -> Any:
        """None for forces that are one vector, or else the load; see `Load.layout`."""
        return None if self.even else self

    @property
    def conservative(self) -> bool:
        """Whether the load has a potential, as those with the axes "plane" have."""
        return self.axes == "plane"

    def shapes(self, weight: float, placed: Placed) -> tuple[LoadShape, ...]:
        """Return the forces along the beam to draw, see `Load.shapes`."""
        at = _arrows(self, placed)
        vectors = in_plane(weight * forces_of(self, at)[None], self.axes, placed.along(self.beam, at))
        return (ForcesAlong(self.beam, at, vectors[0], self.even),)

    def acting(self, arc_length: np.ndarray) -> Mapping[str, np.ndarray]:
        """Return the forces per length, see `Load.acting`."""
        return {"line_force": forces_of(self, arc_length)}

    def work(self, displaced: Displaced) -> np.ndarray:
        """Return the work along the beam, see `Load.work`."""
        moved, weight, arc_length = displaced.along(self.beam)
        return np.asarray(np.einsum("sqc,qc,q->s", moved, forces_of(self, arc_length), weight))

    def require_valid(self) -> None:
        """Raise InputError for invalid members of a user-defined load."""
        super().require_valid()
        kind = type(self).__name__
        require_beam(kind, getattr(self, "beam", None))
        check_along(self)
        one_of(f"axes of {kind}", self.axes, get_args(Axes))
        forces = forces_of(self, ends_and_middle(self.beam))
        if flag(f"uniform of {kind}", self.uniform) and np.any(forces != forces[:1]):
            raise InputError(f"uniform of {kind} is True, but its forces change on the beam: {shown(forces.tolist())}")


def _arrows(load: LineLoad, placed: Placed) -> np.ndarray:
    """Return the arc lengths [m] at which a load along a beam is drawn: equally spaced, and at its largest value."""
    even = np.linspace(0.0, load.beam.curve.length, _ARROWS)
    if load.uniform:
        return even
    at = placed.stations(load.beam)
    sizes = [np.abs(forces_of(load, arc_length)).max(axis=1) for arc_length in (at, even)]
    return np.union1d(even, at[sizes[0].argmax()]) if sizes[0].max() > sizes[1].max() else even
