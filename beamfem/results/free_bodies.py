"""Elements as free bodies in rows of a solution: what acts on them, the section forces at their ends and at cuts.

The nodal forces of an element, internal and inertia forces less its loads, are those that its neighbours exert on it.
Its interpolation contains rigid-body motions, so these forces balance its loads exactly on any mesh.
"""

from dataclasses import dataclass
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array, csr_array

from beamfem.element.fields import cross, dot
from beamfem.equations.applied_loads import shape_tables
from beamfem.equations.blocks import classes_of
from beamfem.equations.frame_inertia import seen_from_rest
from beamfem.equations.stress_resultants import elastic_forces
from beamfem.equations.system import System
from beamfem.kernels.block import Block
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import inertia_at, interpolate, length_points
from beamfem.physics.compiled_connections import in_python
from beamfem.physics.stations import STATIONS
from beamfem.quadrature import gauss, interpolation_weights
from beamfem.results.axis_points import AxisPoints
from beamfem.results.postprocess import direction
from beamfem.results.solution import Solution
from beamfem.results.solution_system import loading


@dataclass(frozen=True, eq=False)
class Rows:
    """Rows of a solution and the forces that act in them.

    p, v, a (steps, n): seen from rest, see `equations.frame_inertia`; body (steps, beams, 4): see `LoadsAt`;
    values: for each block (steps, nl, 3), see `Actions`; imposing (steps, k): factors of the loads that impose strains.
    """

    system: System
    p: np.ndarray
    v: np.ndarray
    a: np.ndarray
    body: np.ndarray
    values: tuple[np.ndarray, ...]
    imposing: np.ndarray


def rows_of(solution: Solution, rows: slice | np.ndarray) -> Rows:
    """Return some rows of a solution with the forces that act in them, kept until other rows are asked for.

    The beams of a model ask for the same rows one after another.
    """
    key = rows if isinstance(rows, slice) else np.asarray(rows).tobytes()
    latest = solution.computed(_latest)
    kept = latest.get("rows")
    if kept is None or kept[0] != key:
        system, at = loading(solution)
        p, rates = solution.p[rows], (solution.v[rows], solution.a[rows])
        loads = system.loads.of_rows(at[rows].tolist())
        moving = seen_from_rest(system, p, *rates, at[rows])
        kept = latest["rows"] = key, Rows(system, p, *moving, loads.body, loads.points, loads.imposing)
    return kept[1]


def _latest(solution: Solution) -> dict[str, tuple[slice | bytes, Rows]]:
    """Return the latest rows of a solution, none at first."""
    return {}


@dataclass(frozen=True, eq=False)
class Acting:
    """Forces at points of elements; virtual work f . delta r + h . delta g, where g is a vector that turns with them.

    element (m,): index among the elements cut free; xi (m,); rule (m,): number of Gauss points over which the
    distributed force is lumped; position, direction (m, nv): r = sum position_i e_i, likewise g;
    force f (steps, m, 2) [N], couple h (steps, m, 2) [N m over the unit of g].
    """

    element: np.ndarray
    xi: np.ndarray
    rule: np.ndarray
    position: np.ndarray
    direction: np.ndarray
    force: np.ndarray
    couple: np.ndarray

    def moments(self, e: np.ndarray, origin: np.ndarray) -> np.ndarray:
        """Return the moments (steps, m) [N m] about an origin (steps, elements, 2) of each element; e: `vectors`."""
        arm = _at(self.position, e, self.element) - origin[:, self.element]
        return cross(arm, self.force) + cross(_at(self.direction, e, self.element), self.couple)

    def nodal(self, elements: int) -> np.ndarray:
        """Return the forces (steps, elements, nv, 2) on the nodal vectors of each element."""
        result = np.zeros((elements, len(self.force), self.position.shape[1], 2))
        parts = np.einsum("smc,mi->msic", self.force, self.position)
        parts += np.einsum("smc,mi->msic", self.couple, self.direction)
        np.add.at(result, self.element, parts)
        return np.moveaxis(result, 0, 1)


def acting_on(rows: Rows, mesh: BeamMesh, elements: np.ndarray, e: np.ndarray, acceleration: np.ndarray) -> Acting:
    """Return the forces on elements (ne,) of a beam with nodal vectors e and accelerations e'' (steps, ne, nv, 2).

    Point loads are excluded: they act at nodes, that is between elements.
    """
    parts = [_of_mass(rows, mesh, elements, e, acceleration), _distributed(rows, mesh, elements, e)]
    joined = {
        name: np.concatenate([getattr(part, name) for part in parts], axis=1 if name in ("force", "couple") else 0)
        for name in Acting.__dataclass_fields__
    }
    return Acting(**joined)


def at_more_points(acting: Acting, mesh: BeamMesh, elements: np.ndarray) -> Acting:
    """Return the same forces, distributed ones at as many Gauss points of elements (ne,) as their moments need.

    The moment of an interpolated density is a polynomial whose degree is higher by that of the field.
    """
    if not len(acting.rule):
        return acting
    field = mesh.beam.element.field
    extra = max(field.degree, field.director_degree)
    parts = []
    for rule in np.unique(acting.rule).tolist():
        mask = acting.rule == rule
        index = acting.element[mask], nearest(gauss(rule)[0], acting.xi[mask])
        finer = to_more_points(rule, rule + extra)
        distributed = []
        for values in (acting.force[:, mask], acting.couple[:, mask]):
            summed = np.zeros((len(elements), rule, len(values), 2))
            np.add.at(summed, index, np.moveaxis(values, 1, 0))
            distributed.append(np.einsum("jn,ensc->sejc", finer, summed).reshape(len(values), -1, 2))
        element, xi = np.repeat(np.arange(len(elements)), len(finer)), np.tile(gauss(len(finer))[0], len(elements))
        # distributed moments come from inertia alone, which turns with d
        tables = shape_tables(mesh, elements[element], xi)
        parts.append((element, xi, np.full(len(xi), len(finer)), *tables, *distributed))
    joined = zip(*parts, strict=True)
    return Acting(*(np.concatenate(values, axis=1 if values[0].ndim == 3 else 0) for values in joined))


def _of_mass(rows: Rows, mesh: BeamMesh, elements: np.ndarray, e: np.ndarray, acceleration: np.ndarray) -> Acting:
    """Return weight less mass times acceleration of the body r0 + y d, and loads per length of fixed direction."""
    body = rows.body[:, rows.system.blocks[mesh.block].beam[mesh.in_block(elements)]]
    if not body.any() and not acceleration.any():
        return _nothing(e)
    where, xi, weight = length_points(mesh, elements)
    element, tables = np.searchsorted(elements, where), shape_tables(mesh, where, xi)
    mass, first, rotary = inertia_at(mesh, where, xi, weight).T[:, None, :, None]
    pull, load = body[:, element, :2], body[:, element, 2:] * weight[:, None]
    free, turn = pull - _at(tables[0], acceleration, element), _at(tables[1], acceleration, element)
    rule = np.full(len(xi), len(xi) // len(elements))
    return Acting(element, xi, rule, *tables, mass * free - first * turn + load, first * free - rotary * turn)


def _distributed(rows: Rows, mesh: BeamMesh, elements: np.ndarray, e: np.ndarray) -> Acting:
    """Return follower and varying loads along beams, and foundation springs, as evaluated by the kernels."""
    actions = rows.system.loads.actions[mesh.block]
    stations, own = actions.stations, mesh.in_block(elements)
    order = np.argsort(own)
    chosen = actions.distributed_on(own[order])
    if not len(chosen):
        return _nothing(e)
    element = order[np.searchsorted(own, stations.element[chosen], sorter=order)]
    position, direction = stations.position[chosen], stations.direction[chosen]
    values, forces = rows.values[mesh.block][:, chosen], np.empty((len(e), len(chosen), 4))
    q = np.concatenate([_at(position, e, element), _at(direction, e, element)], axis=2)
    for kind in np.unique(stations.kind[chosen]).tolist():
        some = np.flatnonzero(stations.kind[chosen] == kind)
        data = [*np.moveaxis(values[:, some], -1, 0), *stations.constants[chosen[some]].T]
        out, at = np.empty((4, len(e), len(some))), np.moveaxis(q[:, some], -1, 0)
        in_python(STATIONS[kind])(at, (), (), (), (), data, (), out)
        forces[:, some] = -np.moveaxis(out, 0, -1)
    return Acting(
        element, actions.xi[chosen], actions.rule[chosen], position, direction, forces[..., :2], forces[..., 2:]
    )


def _nothing(e: np.ndarray) -> Acting:
    none, table = np.zeros(0, dtype=np.int64), np.zeros((0, e.shape[2]))
    return Acting(none, np.zeros(0), none, table, table, *np.zeros((2, len(e), 0, 2)))


def _at(table: np.ndarray, vectors: np.ndarray, element: np.ndarray) -> np.ndarray:
    """Return the interpolation (steps, m, 2) of nodal vectors (steps, ne, nv, 2) at points."""
    return np.einsum("mi,smic->smc", table, vectors[:, element])


def fractions_before(points: int, at: np.ndarray, cut: np.ndarray) -> np.ndarray:
    """Return the fraction (m,) before a cut (m,) of the amount lumped at a Gauss point `at` (m,), density interpolated.

    It is the integral from 0 to the cut of the Lagrange polynomial of that point, over its integral from 0 to 1.
    """
    xi, integral = _integrals(points)
    return np.einsum("mk,mk->m", integral[nearest(xi, at)], np.polynomial.legendre.legvander(2.0 * cut - 1.0, points))


def to_more_points(points: int, more: int) -> np.ndarray:
    """Return the matrix (more, points) that transfers lumped values from `points` to `more` Gauss points.

    It keeps the polynomial density through the fewer points.
    """
    (xi, old), (fine, weights) = gauss(points), gauss(more)
    return np.asarray(weights[:, None] * interpolation_weights(xi, fine) / old)


def nearest(xi: np.ndarray, at: np.ndarray) -> np.ndarray:
    """Return the indices (m,) of the points xi (n,) nearest to `at` (m,)."""
    return np.asarray(np.abs(xi - at[:, None]).argmin(axis=1))


@lru_cache(maxsize=32)
def _integrals(points: int) -> tuple[np.ndarray, np.ndarray]:
    """Return Gauss points on [0, 1] and the integrals of their Lagrange polynomials as Legendre series."""
    xi, weights = gauss(points)
    degree = np.arange(points)
    legendre = np.polynomial.legendre.legvander(2.0 * xi - 1.0, points - 1)
    coefficients = legendre * weights[:, None] * (2 * degree + 1)
    return xi, np.polynomial.legendre.legint(coefficients, lbnd=-1.0, axis=1) / (2.0 * weights[:, None])


@dataclass(frozen=True, eq=False)
class FreeBodies:
    """Elements (ne,) of a beam as free bodies.

    vectors (steps, ne, nv, 2): e; acting: forces on them; force (2, steps, ne, 2) [N] and moment (2, steps, ne) [N m]
    about their first node: those exerted by the part towards the beam's end on cuts at their start and at their end.
    """

    mesh: BeamMesh
    elements: np.ndarray
    vectors: np.ndarray
    acting: Acting
    force: np.ndarray
    moment: np.ndarray

    def at(self, cuts: AxisPoints) -> np.ndarray:
        """Return normal and shear force [N] and moment [N m] (steps, 3, points) at cuts.

        They balance the part before a cut and the part after it. If the two differ by round-off of the equilibrium of
        inner nodes, they are weighted by the distance from the ends.
        """
        element, origin = np.searchsorted(self.elements, cuts.element), self.vectors[:, :, 0]
        now = interpolate(self.mesh, self.vectors[:, element], cuts.element, cuts.xi)
        if not len(self.acting.rule):
            force, moment = (_between(ends, cuts.xi, element) for ends in (self.force, self.moment))
        else:
            fraction = self._before(cuts, element)
            turn = self.acting.moments(self.vectors, origin)
            force = self._carried(self.force, self.acting.force, fraction, cuts.xi, element)
            moment = self._carried(self.moment, turn, fraction, cuts.xi, element)
        moment = moment - cross(now.r - origin[:, element], force)
        along = direction(self.mesh, now)
        return np.stack([dot(along, force), cross(along, force), moment], axis=1)

    def _carried(
        self, ends: np.ndarray, acts: np.ndarray, fraction: csr_array, xi: np.ndarray, element: np.ndarray
    ) -> np.ndarray:
        """Return resultants at cuts (steps, points, ...) from those of both ends (2, steps, ne, ...) and the loads."""
        total = np.zeros((len(self.elements), len(acts), *acts.shape[2:]))
        np.add.at(total, self.acting.element, np.moveaxis(acts, 1, 0))
        balanced = np.stack([ends[0], ends[1] + np.moveaxis(total, 0, 1)])
        flat = np.moveaxis(acts, 1, 0).reshape(acts.shape[1], -1)
        before = (fraction @ flat).reshape(len(xi), len(acts), *acts.shape[2:])
        return np.asarray(_between(balanced, xi, element) - np.moveaxis(before, 0, 1))

    def _before(self, cuts: AxisPoints, element: np.ndarray) -> csr_array:
        """Return the fraction (points, m) of each force that acts between the start of its element and a cut."""
        acting = self.acting
        order = np.argsort(acting.element, kind="stable")
        starts = np.searchsorted(acting.element[order], np.arange(len(self.elements) + 1))
        count = np.diff(starts)[element]
        row = np.repeat(np.arange(len(element)), count)
        within = np.arange(len(row)) - np.repeat(np.cumsum(count) - count, count)
        column = order[np.repeat(starts[element], count) + within]
        fraction = np.empty(len(row))
        for rule in np.unique(acting.rule):
            entries = np.flatnonzero(acting.rule[column] == rule)
            fraction[entries] = fractions_before(int(rule), acting.xi[column[entries]], cuts.xi[row[entries]])
        return coo_array((fraction, (row, column)), shape=(len(element), len(acting.xi))).tocsr()


class Parted(NamedTuple):
    """Elements of a block without shared nodes, and the numbers (k,) of their coordinates in the model.

    In the block they are numbered from 0, so that the forces of a beam take no arrays of the size of the model.
    """

    block: Block
    used: np.ndarray


def cut_free(rows: Rows, mesh: BeamMesh, elements: np.ndarray, parted: Parted, p: np.ndarray) -> FreeBodies:
    """Return elements (ne,), in ascending order, as free bodies in rows; p (steps, k): their coordinates there."""
    q, v, a = (np.ascontiguousarray(values) for values in (p, rows.v[:, parted.used], rows.a[:, parted.used]))
    arrays = elastic_forces(parted.block, q, v, a, rows.imposing)
    e, acceleration, force = (values.reshape(len(p), len(elements), -1, 2) for values in arrays)
    acting = acting_on(rows, mesh, elements, e, acceleration)
    force -= acting.nodal(len(elements))
    per_node = len(mesh.vectors)
    first, last = slice(0, per_node), slice(-per_node, None)
    # all nodal vectors after r turn with the node
    turns = [cross(e[:, :, end], force[:, :, end])[:, :, 1:].sum(axis=2) for end in (first, last)]
    pulls = [force[:, :, end][:, :, 0] for end in (first, last)]
    arm = e[:, :, last][:, :, 0] - e[:, :, 0]
    ends = np.stack([-pulls[0], pulls[1]])
    moments = np.stack([-turns[0], turns[1] + cross(arm, pulls[1])])
    return FreeBodies(mesh, elements, e, at_more_points(acting, mesh, elements), ends, moments)


def parted(block: Block, elements: np.ndarray) -> Parted:
    """Return elements of a block without shared nodes."""
    nodes, history = block.node[elements], block.history[elements] if block.history.size else block.history
    flat = nodes.ravel()
    dof = block.dof[flat]
    used = np.unique(np.concatenate([dof[dof >= 0], history.ravel()]))
    part = block._replace(
        **classes_of(block, elements),
        imposed=None if block.imposed is None else block.imposed._replace(chosen=elements),
        history=np.searchsorted(used, history) if history.size else history,
        node=np.arange(len(flat)).reshape(nodes.shape),
        dof=np.where(dof >= 0, np.searchsorted(used, dof), -1),
        beam=block.beam[elements],
        home=np.indices(nodes.shape).reshape(2, -1).T,
        **{name: getattr(block, name)[flat] for name in ("node_kind", "frame")},
    )
    return Parted(part, used)


def _between(ends: np.ndarray, xi: np.ndarray, element: np.ndarray) -> np.ndarray:
    """Return values (steps, points, ...) at points (element, xi) between those at both ends (2, steps, ne, ...)."""
    weight = xi.reshape(-1, *(1,) * (ends.ndim - 3))
    return np.asarray((1.0 - weight) * ends[0][:, element] + weight * ends[1][:, element])
