"""The linear equations of small motions about a state."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.linalg import LinAlgError
from scipy.sparse import csc_array, csr_array, dia_array

from beamfem.element.fields import cross, dot
from beamfem.equations.system import system_of
from beamfem.errors import ConvergenceError, InputError
from beamfem.linalg.eigenpairs import digits_for, orthonormal
from beamfem.linalg.lapack import superlu
from beamfem.model.beam import Point
from beamfem.model.load_base import Load
from beamfem.model.model import Model
from beamfem.parts.floating_body import FloatingBody
from beamfem.precision.roundoff import LOSES
from beamfem.results.axis_points import axis_at
from beamfem.results.solution import State
from beamfem.solve.linear.quadratic_modes import slowest_rates
from beamfem.solve.modes.mode_stiffness import refuse_lost_digits, upright
from beamfem.solve.modes.modes import Modes
from beamfem.solve.modes.pencil import Pencil
from beamfem.solve.modes.rigid_modes import sort_rigid, unresisted
from beamfem.validation import count as whole_number
from beamfem.validation import items, require_known, shown

Quantity = tuple[str, Point]
QUANTITIES = {"ux": ("displacement ux", "m"), "uy": ("displacement uy", "m"), "rotation": ("rotation", "rad")}
_REAL = 1e-9  # of shapes: imaginary parts below this fraction are round-off


def scale_of(model: Model, transformation: csr_array) -> np.ndarray:
    """Return the changes (m,) of coordinates z that move a model by its size or turn sections by 1 rad."""
    sizes = dia_array((1.0 / system_of(model, static=True).scale[None], [0]), shape=(model.size, model.size))
    return np.asarray(1.0 / abs(sizes @ transformation).max(axis=0).toarray().ravel())


@dataclass(frozen=True, eq=False)
class LinearModel:
    """M z'' + C z' + K z = B f, for small motions p(t) = p + T z(t) about a state.

    The coordinates z are those of the model that are neither prescribed nor determined by conditions of connectors and
    inclined rollers.

    Parameters
    ----------
    model : Model
        The model.
    state : State
        The state p.
    mass, damping, stiffness : csr_array, (m, m)
        M, C and K, such that z'' M z'' / 2 is [J/s^2] and so on; entries of positions are [kg], [N s/m] and [N/m].
    input_matrix : array, [N, N m], (m, loads)
        B: generalized forces per unit factor f of each load.
    loads : tuple of Load
        The loads.
    transformation : csr_array, (n, m)
        T: change of all coordinates of the model; zero for prescribed ones, multipliers and history variables.
    coordinates : array of int, (m,)
        Numbers of the coordinates z among those of the model, -1 for amplitudes of modes.
    names : tuple of str, (m,)
        Names of the coordinates z, such as "beam 0, node 3, theta".
    round_off : (float, float), [1/s^2], [1/s]
        Stiffness and damping of a rigid motion of unit mass that are round-off.
    interfaces : tuple of Point
        Points that it was reduced to, see `reduce`.
    static : bool
        Whether the state is an equilibrium, and not a state of a motion.

    Examples
    --------
    >>> linear = bf.linearise(model)
    >>> linear.mass.shape, linear.names[-1]
    ((36, 36), 'beam 0, node 12, theta')
    """

    model: Model
    state: State
    mass: csr_array
    damping: csr_array
    stiffness: csr_array
    input_matrix: np.ndarray
    loads: tuple[Load, ...]
    transformation: csr_array
    coordinates: np.ndarray
    names: tuple[str, ...]
    round_off: tuple[float, float]
    interfaces: tuple[Point, ...] = ()
    static: bool = False

    def __len__(self) -> int:
        return len(self.names)

    def __repr__(self) -> str:
        return f"LinearModel({len(self)} coordinates, {len(self.loads)} loads)"

    @property
    def scale(self) -> np.ndarray:
        """Changes (m,) of single coordinates that move the model by its size or turn sections by 1 rad."""
        return scale_of(self.model, self.transformation)

    def output(self, quantity: Quantity) -> np.ndarray:
        """Return the row c of a quantity y = c z.

        Parameters
        ----------
        quantity : (str, Point)
            "ux", "uy" [m] or "rotation" [rad], and a point.

        Returns
        -------
        array, (m,)
            The row.

        Raises
        ------
        InputError
            For anything else.
        UnknownPointError
            For a point on a beam that is not in the model.

        Examples
        --------
        >>> row = bf.linearise(model).output(("uy", beam.end))
        """
        return (output_row(self.model, self.state.p, quantity) @ self.transformation).toarray()[0]

    def modes(self, count: int = 10) -> Modes:
        """Find the slowest modes of vibration with damping, (s^2 M + s C + K) phi = 0.

        Parameters
        ----------
        count : int, default 10
            Number of modes with Im s >= 0, in the order of abs(s); a motion without vibration has two, with real s.

        Returns
        -------
        Modes
            Frequencies Im s / 2 pi, growth rates Re s, negative where damped, damping ratios and complex shapes.

        Raises
        ------
        InputError
            For an invalid count.
        ConvergenceError
            If modes were missed, or if round-off leaves one no three digits: stiffnesses or inertias differ too much.

        Examples
        --------
        >>> damper = bf.SpringDamper(beam.end, (2.0, 1.0), stiffness=0.0, damping=500.0)
        >>> damped = bf.linearise(model.with_(connectors=[damper])).modes(2)
        >>> damped.frequencies.round(2), damped.ratios.round(3)
        (array([ 20.76, 129.06]), array([0.097, 0.015]))
        """
        mass = self.mass
        if whole_number("count", count) > len(self):
            raise InputError(f"count is {count}, but this model has only {len(self)} modes")
        pencil = Pencil(system_of(self.model, static=True), self.state.p, self.state.at)
        with digits_for("modes"):
            known = len(unresisted(pencil)[0]) if self.static else None
            matrices = mass, self.damping, self.stiffness
            rates, vectors = slowest_rates(*matrices, self.scale, self.round_off, known, count)
            rigid = np.count_nonzero(rates == 0.0)
            shapes, words = np.empty((0, self.model.size)), tuple[str, ...]()
            if rigid:
                still = orthonormal(vectors[:, :rigid].real, mass).T @ self.transformation.T
                shapes, words = sort_rigid(pencil, still)
        rates, vectors = rates[rigid:], vectors[:, rigid:]
        order = np.lexsort((-rates.real, rates.imag))
        rates, vectors = rates[order], vectors[:, order]
        vectors = vectors / np.sqrt(np.real((np.conj(vectors) * (mass @ vectors)).sum(axis=0)))
        if len(rates):  # a motion of the whole model, as a mode may be that is missing
            whole = self.scale / np.sqrt(self.scale @ (mass @ self.scale))
            fastest = rates[np.abs(rates).argmax()]
            _refuse(self, whole, np.sqrt(LOSES) * _magnitude(self, fastest, whole), "a mode")
        for rate, x in zip(rates, vectors.T, strict=True):
            require_digits(self, rate, x, 0.0, f"the mode of {rate.imag / (2.0 * np.pi):g} {self.model.unit('Hz')}")
        elastic = upright(self.model, vectors.T @ self.transformation.T)
        if np.abs(elastic.imag).max(initial=0.0) <= _REAL * np.abs(elastic).max(initial=0.0):
            elastic = elastic.real
        shapes, rates = np.concatenate([upright(self.model, shapes), elastic]), np.append(np.zeros(rigid), rates)
        return Modes(self.model, self.state, rates.imag / (2.0 * np.pi), rates.real, shapes, words)

    def floating_body(self) -> FloatingBody:
        """Return a reduced model as an elastic body of a mechanism, with large rigid motion and small deformation.

        Its points are r = r1 + R(theta1) (X + Phi q) in the frame of its first interface, with the deformation q of the
        reduced model. Its energies are exact for this field; stresses do not change its stiffness, as in all linear
        models. Raises InputError if the model was not reduced to two interfaces or more, if it is not free or not in
        its reference, if loads act on it, or if its interfaces have no rotations.

        Returns
        -------
        FloatingBody
            A part for `masses` of a Model. Its `points` are the interfaces, to which any other part is attached; its
            beams, without stiffness and mass, need not be listed.

        References
        ----------
        Shabana 2013, Dynamics of Multibody Systems, 4th ed., chapter 5.

        Examples
        --------
        >>> arm = bf.reduce(bf.Model([beam]), [beam.start, beam.end], modes=2).floating_body()
        >>> pendulum = bf.Model([], [bf.Pin(arm.points[0])], [bf.Gravity((0, -9.81))], masses=[arm])
        """
        from beamfem.solve.linear.floating_reduction import floating_body

        return floating_body(self)

    def state_space(
        self, outputs: Sequence[Quantity] | None = None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """Return the first-order form x' = A x + B f, y = C x + D f, with x = (z, z').

        Raises InputError for an invalid output, and if the mass matrix is singular.

        Parameters
        ----------
        outputs : sequence of (str, Point), optional
            Quantities y, see `output`; by default all coordinates z.

        Returns
        -------
        (array, array, array, array), (2 m, 2 m), (2 m, loads), (outputs, 2 m), (outputs, loads)
            A, B, C and D, for example for `control.ss`.

        Examples
        --------
        >>> a, b, c, d = bf.linearise(model).state_space([("uy", beam.end)])
        >>> steady = -c @ np.linalg.solve(a, b)
        >>> round(float(steady[0, 0]), 4)
        -0.0305
        """
        m = len(self)
        try:
            mass = superlu(csc_array(self.mass))
        except LinAlgError as error:
            raise InputError("the mass matrix is singular: a coordinate has no inertia") from error
        right = np.hstack([-self.stiffness.toarray(), -self.damping.toarray(), self.input_matrix])
        solved = mass.solve(right)
        a = np.vstack([np.eye(m, 2 * m, m), solved[:, : 2 * m]])
        b = np.vstack([np.zeros((m, len(self.loads))), solved[:, 2 * m :]])
        rows = np.eye(m) if outputs is None else [self.output(own) for own in items("outputs", outputs)]
        c = np.hstack([np.reshape(rows, (-1, m)), np.zeros((len(rows), m))])
        return a, b, c, np.zeros((len(rows), len(self.loads)))


def require_digits(linear: LinearModel, rate: complex, x: np.ndarray, work: complex, what: str) -> None:
    """Raise ConvergenceError if round-off leaves a motion x exp(rate t) of a linear model no three digits.

    work: x^H times its force; what: what is found, in words.
    """
    most = LOSES * max(_magnitude(linear, rate, x), abs(work))
    _refuse(linear, x, most, what)
    dynamic = rate**2 * linear.mass + rate * linear.damping + linear.stiffness
    if abs(np.vdot(x, dynamic @ x) - work) > most:
        raise ConvergenceError(f"round-off leaves {what} no three digits: inertias or stiffnesses differ too much")


def _magnitude(linear: LinearModel, rate: complex, x: np.ndarray) -> float:
    """Return the larger one of abs(s^2 x^H M x) and abs(s x^H C x) for a motion x exp(s t)."""
    return float(max(abs(rate**2 * np.vdot(x, linear.mass @ x)), abs(rate * np.vdot(x, linear.damping @ x))))


def _refuse(linear: LinearModel, x: np.ndarray, most: float, what: str) -> None:
    refuse_lost_digits(system_of(linear.model, static=True), linear.coordinates, linear.stiffness, x, most, what)


def output_row(model: Model, p: np.ndarray, quantity: Any) -> csr_array:
    """Return the derivative (1, n) of a quantity such as ("uy", beam.end) by the coordinates in a state p (n,).

    Raises InputError for anything else, UnknownPointError for a point of another model.
    """
    if not (isinstance(quantity, tuple) and len(quantity) == 2 and isinstance(quantity[1], Point)):
        raise InputError(f'a quantity is a pair of a name and a point, such as ("uy", beam.end), got {shown(quantity)}')
    name, point = quantity
    require_known(f"{shown(name)} is no quantity of a linear model", name, QUANTITIES)
    mesh = model.mesh_of(point)
    element, xi = mesh.locate(np.array([point.fraction]))
    dofs = np.unique(mesh.kinematics.dof[mesh.node[element[0]]])
    dofs = dofs[dofs >= 0]
    rates = np.zeros((len(dofs), len(p)))
    rates[np.arange(len(dofs)), dofs] = 1.0
    rate = axis_at(mesh, np.broadcast_to(p, rates.shape), element, xi, rates)
    if name == "rotation":
        now = axis_at(mesh, p[None], element, xi)
        by_slope = mesh.beam.element.forces.turns_with == "r_x"
        direction, turning = (now.r_s, rate.r_s) if by_slope else (now.d, rate.d)
        values = (cross(direction, turning) / dot(direction, direction))[:, 0]
    else:
        values = rate.r[:, 0, "xy".index(name[1])]
    return csr_array((values, (np.zeros(len(dofs), dtype=np.int64), dofs)), shape=(1, len(p)))
