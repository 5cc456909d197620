"""The tangent with the stress resultants as further unknowns, for models that lose the digits of the plain one.

    [ G      B^T W ] [ x ]   [ f ]        K = G + B^T W C B,   G: geometric part, loads, springs, inertia
    [ W B  -W / C  ] [ s ] = [ 0 ]

Elimination of K forgets eps C next to what is soft. Here a stiffness enters by its inverse, and none is too large: what
is lost is eps^2 C. Zienkiewicz and Taylor, The Finite Element Method, mixed formulations.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import LinAlgError, ldl
from scipy.sparse import block_array, coo_array, csc_array, csr_array, dia_array
from scipy.sparse.linalg import SuperLU, splu

from beamfem.analysis.tangent import Tangent, Turned, turning
from beamfem.kernels.block import Block
from beamfem.kernels.form import Form
from beamfem.kernels.stress import predict_stress
from beamfem.model.blocks import workspace
from beamfem.model.system import System

_COUNTED = 3000  # unknowns and stress resultants; of more, the pivots of the plain tangent are counted


@dataclass(frozen=True, eq=False)
class MixedFactors:
    """Factors of the tangent with stress resultants: of x, scaled by `scale` (n + m,), the first n are coordinates."""

    lu: SuperLU
    scale: np.ndarray
    matrix: csc_array
    kept: np.ndarray
    plain: Tangent
    turned: Turned

    @property
    def negative_pivots(self) -> int:
        """How many eigenvalues of a symmetric tangent are negative: stress resultants have one each (Sylvester)."""
        if self.matrix.shape[0] > _COUNTED:
            return self.plain.factorised(self.turned).negative_pivots
        _, blocks, _ = ldl(self.matrix.toarray())
        lowest = int((np.linalg.eigvalsh(blocks) < 0.0).sum())
        return lowest - (self.matrix.shape[0] - int(self.kept.sum()))

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Return x (n,) with A x = right and no change along the normals of inclined rollers. Raises LinAlgError."""
        turn = turning(len(right), self.turned)
        n = int(self.kept.sum())
        known = np.zeros(len(self.scale))
        known[:n] = self.scale[:n] * (turn @ right)[self.kept]
        found = self.scale * self.lu.solve(known)
        if not np.isfinite(found).all():
            raise LinAlgError("the tangent is singular")
        x = np.zeros(len(right))
        x[self.kept] = found[:n]
        return np.asarray(turn.T @ x)


@dataclass(frozen=True, eq=False)
class MixedTangent:
    """A tangent whose elastic part is in factors.

    rest (n, n): all but the elastic part; slopes (m, n): strains by coordinates; flexibility (m, m): weights times
    inverse stiffness; weight (m,); plain: the same tangent as one matrix.
    """

    rest: csr_array
    slopes: csr_array
    flexibility: csr_array
    weight: np.ndarray
    plain: Tangent

    def factorised(self, turned: Turned) -> MixedFactors:
        """Return the factors. Raises LinAlgError."""
        n = self.rest.shape[0]
        turn, kept = turning(n, turned), np.ones(n, dtype=bool)
        kept[turned[0]] = False
        rest = (turn @ self.rest @ turn.T)[kept][:, kept]
        couples = dia_array((self.weight[None], [0]), shape=(len(self.weight),) * 2) @ self.slopes @ turn.T
        couples = csr_array(couples)[:, kept]
        matrix = csc_array(block_array([[rest, couples.T], [couples, -self.flexibility]]))
        scale = np.ones(matrix.shape[0])
        for _ in range(3):
            scaled = dia_array((scale[None], [0]), shape=matrix.shape) @ abs(matrix)
            largest = (scaled @ dia_array((scale[None], [0]), shape=matrix.shape)).max(axis=1).toarray().ravel()
            # powers of two round nothing
            scale /= 2.0 ** np.round(0.5 * np.log2(np.where(largest > 0.0, largest, 1.0)))
        diagonal = dia_array((scale[None], [0]), shape=matrix.shape)
        matrix = csc_array(diagonal @ matrix @ diagonal)
        try:
            return MixedFactors(splu(matrix), scale, matrix, kept, self.plain, turned)
        except RuntimeError as error:
            raise LinAlgError("the tangent is singular") from error

    def solve(self, right: np.ndarray, turned: Turned) -> np.ndarray:
        """Return x with A x = right. Raises LinAlgError."""
        return self.factorised(turned).solve(right)

    def sparse(self, turned: Turned) -> csr_array:
        """Return the matrix (n, n) with the normals of inclined rollers turned to x and held there."""
        return self.plain.sparse(turned)


def without_stiffness(blocks: tuple[Block, ...]) -> tuple[Block, ...]:
    """Return blocks that resist nothing."""
    return tuple(block._replace(stiffness=np.zeros_like(block.stiffness)) for block in blocks)


def mixed(system: System, p: np.ndarray, factor: float, rest: Tangent, plain: Tangent) -> MixedTangent:
    """Return the tangent of a state p (n,); factor: of the elastic part; rest: all but that; plain: everything."""
    none = np.empty(0, dtype=np.int64), np.empty((0, 2))
    parts = [_elastic(system, *own, p) for own in zip(system.forms, system.blocks, strict=True)]
    slopes, flexibility, weight = zip(*parts, strict=True)
    sizes = [len(own) for own in weight]
    placed = block_array([[own if i == j else None for j in range(len(sizes))] for i, own in enumerate(flexibility)])
    stacked = block_array([[own] for own in slopes])
    return MixedTangent(rest.sparse(none), csr_array(stacked), csr_array(placed) / factor, np.concatenate(weight), plain)


def _elastic(system: System, form: Form, block: Block, p: np.ndarray) -> tuple[csr_array, csr_array, np.ndarray]:
    """Return strains by unknown coordinates (m, n), weights times inverse stiffness (m, m) and weights (m,)."""
    (elements, nodes), width = block.node.shape, block.dof.shape[1]
    points, strains = block.reference.shape[1:]
    own = block.node.ravel()
    dof = block.dof[own]
    # each element gets coordinates of its own, so that one step moves one coordinate of every element
    apart = np.where(dof >= 0, np.arange(dof.size).reshape(dof.shape), -1)
    part = block._replace(
        node=np.arange(len(own)).reshape(elements, nodes),
        dof=apart,
        carrier=block.carrier[own],
        frame=block.frame[own],
        stiffness=np.ascontiguousarray(np.broadcast_to(np.eye(strains), block.stiffness.shape)),
    )
    work, at = workspace(part), np.where(dof >= 0, p[dof], 0.0).ravel()

    def measured(step: np.ndarray) -> np.ndarray:
        result = np.empty((elements, points, strains))
        predict_stress(form, part, work, at, step, result)
        return result

    loose = np.abs(block.stiffness).max(axis=3) == 0.0
    resists = np.flatnonzero(~loose.all(axis=(0, 1)))
    loose = loose[:, :, resists]
    rest = measured(np.zeros(len(at)))
    number = np.arange(elements * points * len(resists)).reshape(elements, points, len(resists))
    entries: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    for place in range(nodes * width):
        step = np.zeros((elements, nodes * width))
        step[:, place] = 1.0
        column = system.unknowns.free[dof.reshape(elements, -1)[:, place]]
        known = (dof.reshape(elements, -1)[:, place] >= 0) & (column >= 0)
        values = np.where(loose[block.kind], 0.0, (measured(step.ravel()) - rest)[:, :, resists])[known]
        columns = np.broadcast_to(column[known][:, None, None], values.shape)
        entries.append((values.ravel(), number[known].ravel(), columns.ravel()))
    values, row, column = (np.concatenate(part) for part in zip(*entries, strict=True))
    slopes = csr_array(coo_array((values, (row, column)), shape=(number.size, len(system.free_dofs))))
    weight = block.weight[block.kind][:, :, None] * np.ones(len(resists))
    # where a point resists a strain less than others do, its stress is zero
    inverse = np.linalg.inv(block.stiffness[:, :, resists[:, None], resists] + loose[..., None] * np.eye(len(resists)))
    inverse = inverse[block.kind]
    i = np.broadcast_to(number[..., :, None], inverse.shape).ravel()
    j = np.broadcast_to(number[..., None, :], inverse.shape).ravel()
    flexible = coo_array(((weight[..., None] * inverse).ravel(), (i, j)), shape=(number.size, number.size))
    return slopes, csr_array(flexible), weight.ravel()
