"""Loads of a model at a time, and the stations of elements where they act."""

from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any, cast

import numpy as np

from beamfem.cached_properties import cached_property
from beamfem.element.fields import d_slots, length_rule, r_slots
from beamfem.kernels.block import Stations
from beamfem.kernels.model_record import CONSTANTS
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import jacobians, length_points, reference_axis, scales
from beamfem.model.beam import Beam, Point
from beamfem.model.imposed_strains import ImposedStrain
from beamfem.model.load_base import MovingLoad, PointLoad, factor, forces_of
from beamfem.model.model import Model
from beamfem.physics.stations import DEAD, FOLLOWING, GROUNDED, STRETCHING
from beamfem.quadrature import interpolation_weights

_KEPT = 2  # load factors whose loads are cached


@dataclass(frozen=True, eq=False)
class LoadsAt:
    """Loads of a model with certain factors.

    body (beams, 4): acceleration [m/s^2] and load per length [N/m]; points (nl, 3) of each block: forces [N] and
    moments [N m] at points; imposing (k,): factors of the loads that impose strains.
    """

    body: np.ndarray
    points: tuple[np.ndarray, ...]
    imposing: np.ndarray

    @property
    def gravity(self) -> np.ndarray:
        """Acceleration (2,) [m/s^2] of all mass."""
        return self.body[0, :2]

    @property
    def arrays(self) -> tuple[np.ndarray, ...]:
        """All arrays of loads."""
        return (self.body, *self.points, self.imposing)

    @cached_property
    def largest(self) -> tuple[float, float]:
        """Largest component of a force [N] and largest moment [N m] at points."""
        maxima = [(0.0, 0.0, 0.0)]
        maxima += [np.abs(forces.reshape(-1, 3)).max(axis=0).tolist() for forces in self.points if forces.size]
        x, y, moment = (max(values) for values in zip(*maxima, strict=True))
        return max(x, y), moment

    @property
    def any(self) -> bool:
        """Whether any load is not zero."""
        return any(bool(array.any()) for array in self.arrays)


_START, _COLUMNS = np.zeros(1), {"acceleration": slice(2), "line_force": slice(2, 4)}


def pressures_have_potential(model: Model, prescribed: set[int]) -> bool:
    """Return whether the work of all pressures depends on the configuration only.

    prescribed: numbers of the prescribed coordinates. Besides p times the change of area, a pressure p does the work
    p (x dy - y dx) / 2 at the end of its beam, and minus that at its start. This part is zero where x or y is
    prescribed, and cancels where a ring closes or another beam continues under the same pressure. If p varies along the
    beam, it remains at every point.
    """
    amplitudes = [load.amplitude for load in model.line_loads]  # kept alive, so that their ids stay different
    ends: defaultdict[tuple[int, bool, int], float] = defaultdict(float)
    for load, amplitude in zip(model.line_loads, amplitudes, strict=True):
        if load.axes != "axis":
            continue
        along, across = forces_of(load, np.zeros(1))[0].tolist()
        if not load.uniform or along != 0.0:
            return False
        mesh = model.mesh_of(load.beam.start)
        first, last = mesh.kinematics.dof[mesh.node[0, 0], 0], mesh.kinematics.dof[mesh.node[-1, -1], 0]
        for dof, sign in ((int(first), -1.0), (int(last), 1.0)):
            ends[id(amplitude), load.scale, dof] += sign * across
    return all(left == 0.0 or dof in prescribed or dof + 1 in prescribed for (_, _, dof), left in ends.items())


@dataclass(frozen=True)
class Actions:
    """Stations of a block and the values of their loads at a time.

    unit (nl, 3): force [N] and moment [N m] of each, without its factor; source (nl,): index in `model.acting`, -1 for
    springs; xi (nl,): position in the element; rule (nl,): number of Gauss points per element over which a load or
    foundation along a beam is distributed, 0 at a point.
    """

    stations: Stations
    unit: np.ndarray
    source: np.ndarray
    xi: np.ndarray
    rule: np.ndarray
    moving: tuple["_Moving", ...]

    @cached_property
    def _distributed(self) -> tuple[np.ndarray, np.ndarray]:
        """Distributed loads and foundations (m,), ordered by element, and their elements (m,)."""
        distributed = np.flatnonzero(self.rule > 0)
        order = distributed[np.argsort(self.stations.element[distributed], kind="stable")]
        return order, self.stations.element[order]

    def distributed_on(self, elements: np.ndarray) -> np.ndarray:
        """Return the numbers (k,) of the distributed loads and foundations on elements of the block, ascending."""
        order, owner = self._distributed
        first, last = (np.searchsorted(owner, elements, side=side) for side in ("left", "right"))
        count = last - first
        return np.sort(order[np.repeat(first - np.cumsum(count) + count, count) + np.arange(count.sum())])

    def of(self, model: Model) -> "Actions":
        """Return the actions on a model whose loads differ from the own ones only in their size."""
        unit = self.unit.copy()
        for row in np.flatnonzero(self.rule == 0).tolist():
            unit[row] = cast("PointLoad", model.acting[self.source[row]]).value
        return replace(self, unit=unit)

    def values(self, times: float | Sequence[float] | np.ndarray, factors: np.ndarray) -> np.ndarray:
        """Return forces and moments (..., nl, 3) at times (...), with the factors (..., k) of `model.acting`."""
        sizes = np.ones((*factors.shape[:-1], factors.shape[-1] + 1))
        sizes[..., :-1] = factors
        result = np.asarray(self.unit * sizes[..., self.source, None])
        for moving in self.moving:
            rows = result.reshape(-1, *self.unit.shape)
            row, stations, shares = moving.at(np.ravel(times))
            sizes = np.ravel(factors[..., moving.number])[row]
            rows[row[:, None], stations, :2] = (sizes[:, None] * shares)[..., None] * np.array(moving.load.vector)
        return result


@dataclass(frozen=True, eq=False)
class Loads:
    """The loads of a model at any time, in statics at any load factor.

    tables: see `System`; known: loads at recent load factors.
    """

    model: Model
    static: bool
    tables: dict[Any, Any]
    known: dict[float, LoadsAt] = field(default_factory=dict)

    @cached_property
    def unloaded(self) -> tuple[Actions, ...]:
        """Stations of each block, where sizes of loads may be those of another model."""
        if "actions" not in self.tables:
            built = tuple(build_actions(self.model, number) for number in range(len(self.model.groups)))
            self.tables.setdefault("actions", built)
        found: tuple[Actions, ...] = self.tables["actions"]
        return found

    @cached_property
    def actions(self) -> tuple[Actions, ...]:
        """Stations of each block, with the values of loads."""
        return tuple(actions.of(self.model) for actions in self.unloaded)

    def at(self, time: float) -> LoadsAt:
        """Return the loads at a time, in statics at a load factor."""
        if self.varying:
            return self.of(time, self.factors(time))
        key = time if self.static else 0.0
        found = self.known.get(key)
        if found is None:
            if len(self.known) >= _KEPT:
                self.known.clear()
            found = self.known[key] = self.of(key, self.factors(key))
        return found

    def factors(self, time: float) -> np.ndarray:
        """Return the factors (k,) of `model.acting` at a time."""
        named = ((load, self.model.name_of(load)) for load in self.model.acting)
        return np.array([factor(load, time, self.static, name) for load, name in named], dtype=float)

    def of(self, time: float, factors: np.ndarray) -> LoadsAt:
        """Return the loads at a time with given factors (k,) of `model.acting`."""
        points = tuple(actions.values(time, factors) for actions in self.actions)
        return LoadsAt(self.even(factors), points, factors[self.imposes])

    def of_rows(self, times: Sequence[float] | np.ndarray) -> LoadsAt:
        """Return the loads at times, which are the first axis of its arrays."""
        factors = np.array([self.factors(time) for time in times]).reshape(len(times), -1)
        points = tuple(actions.values(times, factors) for actions in self.actions)
        return LoadsAt(self.even(factors), points, factors[:, self.imposes])

    def even(self, factors: np.ndarray) -> np.ndarray:
        """Return acceleration [m/s^2] and load per length [N/m] of each beam (..., beams, 4) by loads that are even.

        factors (..., k): of `model.acting`.
        """
        result = np.zeros((*factors.shape[:-1], len(self.model.beams), 4))
        for number, beams, columns, vector in self._even:
            result[..., beams, columns] += factors[..., number, None, None] * vector
        return result

    @cached_property
    def _even(self) -> list[tuple[int, slice, slice, np.ndarray]]:
        """Number in `model.acting` of each load that is even, its beams, columns of `LoadsAt.body`, and vector (2,)."""
        found = []
        for number, load in enumerate(self.model.acting):
            if load.even:
                ((name, vectors),) = load.acting(_START).items()
                beams = slice(None)
                if isinstance(load.place, Beam):
                    own = self.model.number_of(load.place)
                    beams = slice(own, own + 1)
                found.append((number, beams, _COLUMNS[name], vectors[0]))
        return found

    @cached_property
    def turning(self) -> list[tuple[int, Point, float]]:
        """Number in `model.acting` of each load that is a moment, its point, and the moment [N m]."""
        at_points = [(n, each.place, each) for n, each in enumerate(self.model.acting) if isinstance(each.place, Point)]
        moments = [(number, place, float(each.acting(_START)["moment"][0, 0])) for number, place, each in at_points]
        return [found for found in moments if found[2]]

    @cached_property
    def imposes(self) -> np.ndarray:
        """Mask (k,) of the loads of `model.acting` that impose strains."""
        return np.array([isinstance(load, ImposedStrain) for load in self.model.acting], dtype=bool)

    @cached_property
    def conserves(self) -> np.ndarray:
        """Mask (k,) of the loads of `model.acting` that belong to loads with a potential while factors are constant."""
        own = {id(part) for load in self.model.loads if load.conservative for part in load.parts}
        return np.array([id(load) in own for load in self.model.acting], dtype=bool)

    def imposing(self, time: float) -> np.ndarray:
        """Return the factors (k,) of the loads that impose strains at a time."""
        return self.factors(time)[self.imposes] if self.imposes.any() else np.empty(0)

    @cached_property
    def varying(self) -> bool:
        """Whether a load has an amplitude, a function of time, or moves."""
        return any(load.moves or load.amplitude is not None for load in self.model.loads)

    @cached_property
    def proportional(self) -> bool:
        """Whether all loads are proportional to the load factor of statics."""
        return self.static and not self.varying and all(load.scale for load in self.model.loads)


@dataclass(frozen=True, eq=False)
class _Moving:
    """A moving load of a block, its number in `model.acting`, and the first of its rows, one for each Gauss point.

    going: end at which it leaves for another beam, where the load beside, the same one there, takes its place.

    A polynomial of the degree of the field is determined by its values at the Gauss points of an element, so that
    forces there, in the shares of Lagrange's polynomials, have the nodal forces of one between them.
    """

    load: MovingLoad
    number: int
    mesh: BeamMesh
    first: int
    going: tuple[tuple[float, MovingLoad, float], ...]

    def at(self, times: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return the numbers (n,) of the times (m,) when it is on the beam, and its stations and shares (n, k)."""
        place = _fractions(self.load, times)
        acts = (place >= 0.0) & (place <= 1.0)
        for end, other, begin in self.going:
            leaves = np.flatnonzero(place == end)
            acts[leaves[_fractions(other, times[leaves]) == begin]] = False
        row = np.flatnonzero(acts)
        element, xi = self.mesh.locate(place[row])
        points = length_rule(self.mesh.beam.element.field)[0]
        stations = self.first + element[:, None] * len(points) + np.arange(len(points))
        return row, stations, interpolation_weights(points, xi)


def _fractions(load: MovingLoad, times: np.ndarray) -> np.ndarray:
    """Return where a load is at times (n,) or load factors, in lengths of its beam."""
    return np.array([load.place_at(time) for time in times.tolist()]) / load.beam.curve.length


def _going(model: Model, number: int, load: MovingLoad) -> tuple[tuple[float, MovingLoad, float], ...]:
    """Return the joints at which the load of a number goes over to a later one that is the same: see `_Moving`."""
    later = [other for other in model.acting[number + 1 :] if isinstance(other, MovingLoad)]
    later = [each for each in later if each.vector == load.vector and each.amplitude is load.amplitude]
    sides = [pair for joint in model.shared_joints for pair in ((joint.a, joint.b), (joint.b, joint.a))]
    return tuple(
        (own.fraction, other, beside.fraction)
        for own, beside in sides
        for other in later
        if own.beam is load.beam and beside.beam is other.beam
    )


def build_actions(model: Model, block: int) -> Actions:
    """Return the stations of a block; those of loads and foundations along beams are Gauss points."""
    size = len(model.groups[block].field.nodes) * len(model.groups[block].field.vectors)
    table, whole = np.zeros((0, size)), np.zeros(0, dtype=np.int64)
    none = whole, table, table, whole, np.zeros((0, CONSTANTS)), np.zeros((0, 3)), whole, np.zeros(0), whole
    parts, moving = list[tuple[np.ndarray, ...]]([none]), list[_Moving]()
    for number, load in enumerate(model.acting):
        place = load.place
        mesh = None if load.even else _mesh(model, place, block)
        if mesh is None:
            continue
        if isinstance(load, PointLoad):
            where, xi = mesh.locate(np.array([load.point.fraction]))
            parts.append(_part(mesh, where, xi, _KINDS[load.axes], np.array([load.value], dtype=float), number, rule=0))
            continue
        where, xi, weight = length_points(mesh)
        if isinstance(load, MovingLoad):
            first = sum(len(part[0]) for part in parts)
            moving.append(_Moving(load, number, mesh, first, _going(model, number, load)))
            parts.append(_part(mesh, where, xi, DEAD))
        elif along := load.acting(mesh.arc_length(where, xi)):
            unit = np.column_stack([weight[:, None] * along["line_force"], np.zeros(len(xi))])
            parts.append(_part(mesh, where, xi, _KINDS[load.axes], unit, number))
    for foundation in model.line_supports:
        if mesh := _mesh(model, foundation.beam, block):
            where, xi, weight = length_points(mesh)
            place = mesh.position[mesh.node[where, 0]] + reference_axis(mesh, where, xi).r
            constants = np.hstack([np.outer(weight, foundation.stiffness), place])
            parts.append(_part(mesh, where, xi, GROUNDED, constants=constants))
    joined = [np.concatenate(values) for values in zip(*parts, strict=True)]
    unit, source, xi, rule = joined[5:]
    return Actions(Stations(*joined[:5]), unit, source, xi, rule, tuple(moving))


_KINDS = {"plane": DEAD, "section": FOLLOWING, "axis": STRETCHING}  # by the axes of a load


def _mesh(model: Model, place: Beam | Point | None, block: int) -> BeamMesh | None:
    """Return the mesh of the beam of a load or support if it is in a block."""
    beam = place.beam if isinstance(place, Point) else place
    mesh = None if beam is None else model.meshes[model.number_of(beam)]
    return mesh if mesh is not None and mesh.block == block else None


def _slope(mesh: BeamMesh, element: np.ndarray, xi: np.ndarray) -> np.ndarray:
    """Return the table (n, nv) that gives r0' at points from the scaled nodal vectors."""
    field = mesh.beam.element.field
    table = np.zeros((len(xi), len(field.nodes) * len(field.vectors)))
    table[:, r_slots(field)] = field.centreline(xi, 1) / jacobians(mesh, element, xi)[0][:, None]
    return table


def _part(
    mesh: BeamMesh,
    element: np.ndarray,
    xi: np.ndarray,
    kind: int,
    unit: np.ndarray | None = None,
    source: int = -1,
    constants: np.ndarray | None = None,
    rule: int | None = None,
) -> tuple[np.ndarray, ...]:
    """Return the fields of `Stations` and then of `Actions` for points (element, xi) of a beam; rule: all Gauss points.

    A force in the axes of the centreline is along and normal to r0', which replaces the director.
    """
    element_type, count = mesh.beam.element, len(element)
    position, direction = shape_tables(mesh, element, xi)
    if element_type.forces.turns_with == "r_x" or kind == STRETCHING:
        direction = _slope(mesh, element, xi) * scales(element_type, mesh.lengths[element])
    if constants is None:
        constants = np.zeros((count, CONSTANTS))
        constants[:, 0] = kind == STRETCHING
    if kind == FOLLOWING:
        # from the interpolated reference, not the curve: on a curved beam they differ by the interpolation error
        reference = reference_axis(mesh, element, xi)
        along = reference.r_s if element_type.forces.turns_with == "r_x" else reference.d
        constants[:, :2] = along / np.linalg.norm(along, axis=1, keepdims=True)
    stations = mesh.first_element + element, position, direction, np.full(count, kind), constants
    rule = len(xi) // mesh.elements if rule is None else rule
    unit = np.zeros((count, 3)) if unit is None else unit
    return *stations, unit, np.full(count, source), xi, np.full(count, rule)


def shape_tables(mesh: BeamMesh, element: np.ndarray, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the tables (m, nv) that give r0 and d at points (element, xi) of a beam from its nodal vectors."""
    field, scale = mesh.beam.element.field, scales(mesh.beam.element, mesh.lengths[element])
    position, director = np.zeros_like(scale), np.zeros_like(scale)
    position[:, r_slots(field)], director[:, d_slots(field)] = field.centreline(xi), field.director(xi)
    return position * scale, director * scale
