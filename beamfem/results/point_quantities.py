"""What a solution says of points: fields, positions, velocities, reactions, forces of connectors."""

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar, cast

import numpy as np

from beamfem.model.beam import Point
from beamfem.model.contribution import Contribution
from beamfem.model.model import Model
from beamfem.once import cached_property
from beamfem.results import postprocess
from beamfem.results.connected import connector_force, multipliers
from beamfem.results.nodal import rate_at
from beamfem.results.postprocess import Fields
from beamfem.results.reactions import reaction
from beamfem.results.section_forces import Cuts, at_points
from beamfem.results.self_stress import self_stress
from beamfem.results.turns import rotations, turned_of

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

_Value = TypeVar("_Value")


class PointQuantities:
    """Quantities of a `Solution`, which derives from this class, at points."""

    model: Model
    p: np.ndarray
    v: np.ndarray

    @property
    def _whole(self) -> "Solution":
        return cast("Solution", self)

    def __getstate__(self) -> dict[str, object]:
        """Return all but what `computed` keeps, which copies compute anew."""
        return {name: value for name, value in vars(self).items() if name != "_computed"}

    @cached_property
    def _computed(self) -> dict[Any, Any]:
        return {}

    def computed(self, build: "Callable[[Solution], _Value]") -> _Value:
        """Return a function of the solution, whose value is kept with it.

        Parameters
        ----------
        build : callable
            Function of the solution, called once.

        Returns
        -------
        object
            Its value.

        Examples
        --------
        >>> solution.computed(len) == len(solution)
        True
        """
        if build not in self._computed:
            self._computed[build] = build(self._whole)
        value: _Value = self._computed[build]
        return value

    def fields(self, point: Point) -> Fields:
        """Return position, gradients, rotation, shear angle, strain and stress at a point.

        Where two elements meet or a load acts, strain and stress are those on the side towards the beam's end.

        Parameters
        ----------
        point : Point
            A point of a beam, such as `beam.end` or `beam.at(0.5)`.

        Returns
        -------
        Fields
            The fields over the steps.

        Examples
        --------
        >>> fields = solution.fields(beam.at(0.5))
        >>> fields.position[-1].round(4)
        array([ 0.9999, -0.0096])
        """
        mesh = self.model.mesh_of(point)
        element, xi = (np.array([value]) for value in mesh.locate(point.fraction))
        forces = at_points(self._whole, mesh, Cuts(element, xi))
        eigenstress = self_stress(self._whole, mesh, element, xi, None, np.zeros((1, 1)))
        result = postprocess.fields(mesh, self.p, element, xi, forces, eigenstress, turned_of(self._whole, mesh))
        return Fields(*(postprocess.at_single_point(getattr(result, name)) for name in Fields.__dataclass_fields__))

    def position(self, point: Point) -> np.ndarray:
        """Return the position of a point.

        Parameters
        ----------
        point : Point
            A point of a beam.

        Returns
        -------
        array, [m], (steps, 2)
            Position (x, y).

        Examples
        --------
        >>> solution.position(beam.end)[-1].round(4)
        array([ 1.9997, -0.0305])
        """
        return postprocess.position(self.model.mesh_of(point), self.p, point.fraction)

    def displacement(self, point: Point) -> np.ndarray:
        """Return the displacement of a point from the reference configuration.

        Parameters
        ----------
        point : Point
            A point of a beam.

        Returns
        -------
        array, [m], (steps, 2)
            Displacement (ux, uy).

        Examples
        --------
        >>> solution.displacement(beam.end)[-1].round(4)
        array([-0.0003, -0.0305])
        """
        mesh = self.model.mesh_of(point)
        return self.position(point) - postprocess.start(mesh, point.fraction)

    def velocity(self, point: Point) -> np.ndarray:
        """Return the velocity of a point.

        Parameters
        ----------
        point : Point
            A point of a beam.

        Returns
        -------
        array, [m/s], (steps, 2)
            Velocity (vx, vy).

        Examples
        --------
        >>> motion = bf.simulate(model, duration=0.02, step=0.001)
        >>> motion.velocity(beam.end)[-1].round(2)
        array([-0.09, -2.44])
        """
        mesh = self.model.mesh_of(point)
        element, xi = (np.array([place]) for place in mesh.locate(point.fraction))
        return rate_at(mesh, self.p, self.v, element, xi).r[:, 0]

    def rotation(self, point: Point) -> np.ndarray:
        """Return the rotation of the section, counter-clockwise positive, full turns included.

        Parameters
        ----------
        point : Point
            A point of a beam.

        Returns
        -------
        array, [rad], (steps,)
            Rotation from the reference.

        Examples
        --------
        >>> round(float(solution.rotation(beam.end)[-1]), 4)
        -0.0229
        """
        self.model.mesh_of(point)  # refuses what is no point of this model
        return rotations(self._whole, [point])[:, 0]

    def reaction(self, point: Point) -> np.ndarray:
        """Return the reaction of supports and springs on the beam at a point.

        Supports at joined points of other beams are not included.

        Parameters
        ----------
        point : Point
            A supported point.

        Returns
        -------
        array, (steps, 3)
            fx, fy [N], m [N m].

        Raises
        ------
        InputError
            If the point has no support.

        Examples
        --------
        >>> solution.reaction(beam.start)[-1, 1:].round()  # fy, m
        array([10000., 19997.])
        """
        return reaction(self._whole, point)

    def connector_force(self, connector: Contribution) -> np.ndarray:
        """Return the forces of a connector on its points.

        Parameters
        ----------
        connector : Contribution
            One of `model.connectors`.

        Returns
        -------
        array, (steps, m, 3)
            fx, fy [N], m [N m] at each of its m points.

        Raises
        ------
        InputError
            For a connector that is not in the model.

        Examples
        --------
        >>> forces = solution.connector_force(model.connectors[0])  # doctest: +SKIP
        """
        return connector_force(self._whole, connector)

    def multipliers(self, connector: Contribution) -> np.ndarray:
        """Return the additional unknowns of a connector, such as multipliers.

        Parameters
        ----------
        connector : Contribution
            One of `model.connectors`.

        Returns
        -------
        array, (steps, k)
            Its unknowns.

        Raises
        ------
        InputError
            For a connector that is not in the model.

        Examples
        --------
        >>> tension = solution.multipliers(model.connectors[0])[:, 0]  # doctest: +SKIP
        """
        return multipliers(self._whole, connector)
