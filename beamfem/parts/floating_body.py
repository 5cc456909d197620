"""An elastic body that moves with a floating frame of reference."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam import Beam, Point
from beamfem.model.part_units import UNIT
from beamfem.parts.at_points import PartAtPoints
from beamfem.parts.rigid import Rigid
from beamfem.physics.connections import Connection
from beamfem.physics.floating_frame import floating_frame


@dataclass(frozen=True)
class FloatingBody(PartAtPoints):
    """A reduced model as an elastic body: large rigid motion with small deformation, see `LinearModel.floating_body`.

    Its frame is that of its first interface, in which mass and stiffness matrix are constant; the kinetic energy has
    all terms of the rotation. Its interfaces are points of any other part; its weight acts under `Gravity`.

    Parameters
    ----------
    points : tuple of Point, (m,)
        Its interfaces, m >= 2.
    mass : float, [kg]
        Its mass.
    modes : int
        Number of its modes with fixed interfaces. Their amplitudes are coordinates [m], the root mean square of the
        displacement.
    numbers : tuple of float
        Its constants, see `physics.floating_frame`.
    damped : bool
        Whether they have a damping matrix.
    """

    points: tuple[Point, ...]
    mass: float = field(metadata={UNIT: "kg"})
    modes: int
    numbers: tuple[float, ...]
    damped: bool = False

    @property
    def connection(self) -> Connection:
        """A body in a floating frame."""
        return floating_frame(len(self.points), self.modes, self.damped)

    def data(self, reference: np.ndarray) -> tuple[float, ...]:
        """Return its constants."""
        return self.numbers


@dataclass(frozen=True, eq=False)
class Carrier(Beam):
    """A beam with negligible stiffness and mass between the first and another interface of a floating body."""

    first: Beam | None = field(default=None, kw_only=True)

    @property
    def holding(self) -> tuple[Rigid, ...]:
        """The joint with the beam that begins at the first interface, too."""
        return () if self.first is None else (Rigid(self.first.start, self.start),)

    def require_place(self, fraction: float, parts: Sequence[Any]) -> None:
        """Raise InputError for a place between interfaces, and if the body is not among the parts."""
        if 0.0 < fraction < 1.0:
            raise InputError("a part acts between interfaces of a floating body; reduce with an interface there")
        bodies = (part for part in parts if isinstance(part, FloatingBody))
        if not any(point.beam is self for body in bodies for point in body.points):
            raise InputError("a part acts on a floating body that is not in the model; add it to masses")
