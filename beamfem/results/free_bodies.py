"""Elements as free bodies in rows of a solution: the section forces at their two ends and at cuts between them.

The nodal forces of an element, internal and inertia forces less its loads, are those that its neighbours exert on it.
Its interpolation contains rigid-body motions, so these forces balance its loads exactly on any mesh.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.sparse import coo_array, csr_array

from beamfem.element.fields import cross, dot
from beamfem.equations.blocks import classes_of
from beamfem.equations.stress_resultants import elastic_forces
from beamfem.kernels.block import Block
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.mesh.reference import interpolate
from beamfem.results.axis_points import AxisPoints
from beamfem.results.element_loads import Acting, Rows, acting_on, at_more_points, fractions_before
from beamfem.results.postprocess import direction


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
        element = np.searchsorted(self.elements, cuts.element)
        now = interpolate(self.mesh, self.vectors[:, element], cuts.element, cuts.xi)
        if not len(self.acting.rule):
            force, moment = (_between(ends, cuts.xi, element) for ends in (self.force, self.moment))
        else:
            fraction = self._before(cuts, element)
            turn = self.acting.moments(self.vectors, self._origin)
            force = self._carried(self.force, self.acting.force, fraction, cuts.xi, element)
            moment = self._carried(self.moment, turn, fraction, cuts.xi, element)
        moment = moment - cross(now.r - self._origin[:, element], force)
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

    @property
    def _origin(self) -> np.ndarray:
        return self.vectors[:, :, 0]

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
    nodes, history = block.node[elements], block.history_of(elements)
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
