"""The tangent with the stress resultants as further unknowns, for models that lose the digits of the plain one.

    [ G      B^T W ] [ x ]   [ f ]        K = G + B^T W C B,   G: geometric part, loads, springs, inertia
    [ W B  -W / C  ] [ s ] = [ 0 ]

Elimination of K forgets eps C next to what is soft. Here a stiffness enters by its inverse, and none is too large: what
is lost is eps^2 C. Zienkiewicz and Taylor, The Finite Element Method, mixed formulations.
"""

from dataclasses import dataclass

import numpy as np
from scipy.sparse import block_array, coo_array, csc_array, csr_array, dia_array
from scipy.sparse.linalg import SuperLU, splu

from beamfem.assembly.points import free_sheet, resultants
from beamfem.assembly.system import System
from beamfem.kernels.block import Block
from beamfem.linalg.inertia import negative_eigenvalues
from beamfem.linalg.lapack import LinAlgError
from beamfem.linalg.tangent import Rotated, Stresses, Tangent, turning

_REFINEMENTS = 2  # each equation then holds to the digits of its own terms, however large others are (Skeel 1980)


@dataclass(frozen=True, eq=False)
class MixedFactors:
    """Factors of the tangent with stress resultants.

    scale (n + m,): of coordinates, which come first, and resultants; kept (n,): coordinates without normals of rollers.
    """

    lu: SuperLU
    scale: np.ndarray
    matrix: csc_array
    kept: np.ndarray
    tangent: "MixedTangent"
    rotated: Rotated

    @property
    def negative_pivots(self) -> int:
        """How many eigenvalues of a symmetric tangent are negative: stress resultants have one each (Sylvester)."""
        found = negative_eigenvalues(csr_array(self.matrix))
        if found is None:
            return self.tangent.plain.factorised(self.rotated).negative_pivots
        return found - (self.matrix.shape[0] - int(self.kept.sum()))

    def solve(self, right: np.ndarray) -> np.ndarray:
        """Return x (n,) with A x = right and no change along the normals of inclined rollers. Raises LinAlgError."""
        return self._solve(right, np.zeros(len(self.scale) - int(self.kept.sum())))[0]

    def correction(self, unbalanced: np.ndarray) -> tuple[np.ndarray, Stresses | None]:
        """Return Newton's step (n,) from the strains and what loads leave, and the stresses. Raises LinAlgError."""
        tangent = self.tangent
        x, found = self._solve(-tangent.loads, -tangent.weight * tangent.strain)
        stresses, first = [], 0
        for shape, resists in tangent.places:
            table = np.zeros(shape)
            last = first + table[..., resists].size
            table[..., resists] = found[first:last].reshape(*shape[:2], -1)
            stresses.append(table)
            first = last
        return x, tuple(stresses)

    def _solve(self, right: np.ndarray, strain: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        turn = turning(len(right), self.rotated) if len(self.rotated[0]) else None
        n = int(self.kept.sum())
        known = np.concatenate([(right if turn is None else turn @ right)[self.kept], strain])
        known = self.scale * known
        found = self.lu.solve(known)
        for _ in range(_REFINEMENTS):
            found += self.lu.solve(known - self.matrix @ found)
        found *= self.scale
        if not np.isfinite(found).all():
            raise LinAlgError("the tangent is singular")
        x = np.zeros(len(right))
        x[self.kept] = found[:n]
        return x if turn is None else np.asarray(turn.T @ x), found[n:]


@dataclass(frozen=True, eq=False)
class MixedTangent:
    """A tangent whose elastic part is in factors.

    rest (n, n): all but the elastic part; slopes (m, n): strains by coordinates; flexibility (m, m): weights times
    inverse stiffness; weight (m,); loads (n,): residual but for elastic forces; strain (m,); places: shape (ne, nq, ns)
    of each block's stress resultants and which of them resist; plain: the same tangent as one matrix.
    """

    zeros: csr_array
    slopes: csr_array
    flexibility: csr_array
    weight: np.ndarray
    loads: np.ndarray
    strain: np.ndarray
    places: tuple[tuple[tuple[int, ...], np.ndarray], ...]
    plain: Tangent

    def factorised(self, rotated: Rotated) -> MixedFactors:
        """Return the factors. Raises LinAlgError."""
        n = self.zeros.shape[0]
        turn, kept = turning(n, rotated), np.ones(n, dtype=bool)
        kept[rotated[0]] = False
        zeros = (turn @ self.zeros @ turn.T)[kept][:, kept]
        couples = dia_array((self.weight[None], [0]), shape=(len(self.weight),) * 2) @ self.slopes @ turn.T
        couples = csr_array(couples)[:, kept]
        placed = coo_array(block_array([[zeros, couples.T], [couples, -self.flexibility]]))
        (row, column), sizes = placed.coords, np.abs(placed.data)
        scale = np.ones(placed.shape[0])
        for _ in range(3):
            largest = np.zeros(len(scale))
            np.maximum.at(largest, row, scale[row] * sizes * scale[column])
            # powers of two round nothing
            scale /= 2.0 ** np.round(0.5 * np.log2(np.where(largest > 0.0, largest, 1.0)))
        matrix = csc_array(coo_array((scale[row] * placed.data * scale[column], (row, column)), shape=placed.shape))
        try:
            return MixedFactors(splu(matrix), scale, matrix, kept, self, rotated)
        except RuntimeError as error:
            raise LinAlgError("the tangent is singular") from error

    def solve(self, right: np.ndarray, rotated: Rotated) -> np.ndarray:
        """Return x with A x = right. Raises LinAlgError."""
        return self.factorised(rotated).solve(right)

    def lost(self, rotated: Rotated) -> float:
        """Return the relative error of a solution by the plain tangent, measured by the elements one by one.

        Forces act on all coordinates; what they move strains the elements, whose stresses ought to balance them. This
        depends neither on the order of elimination nor on that of the beams. Raises LinAlgError.
        """
        force = np.random.default_rng(0).standard_normal(self.zeros.shape[0])
        plain, exact = self.plain.factorised(rotated), self.factorised(rotated).solve(force)
        return float(np.max(np.abs(plain.solve(force) - exact)) / np.max(np.abs(exact)))

    def sparse(self, rotated: Rotated) -> csr_array:
        """Return the matrix (n, n) with the normals of inclined rollers rotated to x and held there."""
        return self.plain.sparse(rotated)


def without_stiffness(blocks: tuple[Block, ...]) -> tuple[Block, ...]:
    """Return blocks that resist nothing."""
    return tuple(block._replace(stiffness=np.zeros_like(block.stiffness)) for block in blocks)


def mixed(
    system: System, p: np.ndarray, factor: float, loads: np.ndarray, zeros: Tangent, plain: Tangent
) -> MixedTangent:
    """Return the tangent of a state p (n,).

    factor: of the elastic part; loads (n,): residual of all but the elastic forces, rest: tangent of that; plain: of
    everything.
    """
    none = np.empty(0, dtype=np.int64), np.empty((0, 2))
    parts = [_elastic(system, block, p) for block in system.blocks]
    slopes, flexibility, weight, strain = zip(*parts, strict=True)
    sizes = [len(own) for own in weight]
    placed = block_array([[own if i == j else None for j in range(len(sizes))] for i, own in enumerate(flexibility)])
    stacked = csr_array(block_array([[own] for own in slopes]))
    elastic = stacked, csr_array(placed) / factor, np.concatenate(weight)
    shapes = tuple(((len(own.node), *own.reference.shape[1:]), resisting(own)) for own in system.blocks)
    return MixedTangent(zeros.sparse(none), *elastic, loads[system.free_dofs], np.concatenate(strain), shapes, plain)


def resisting(block: Block) -> np.ndarray:
    """Return which strain measures of a block are resisted at some point."""
    return np.flatnonzero(np.abs(block.stiffness).max(axis=(0, 1, 3)) > 0.0)


def _elastic(system: System, block: Block, p: np.ndarray) -> tuple[csr_array, csr_array, np.ndarray, np.ndarray]:
    """Return strains by coordinates (m, n), weights times inverse stiffness (m, m), weights and strains (m,)."""
    (elements, nodes), width = block.node.shape, block.dof.shape[1]
    points, strains = block.reference.shape[1:]
    own = block.node.ravel()
    dof = block.dof[own]
    # each element gets coordinates of its own, so that one step moves one coordinate of every element
    apart = np.where(dof >= 0, np.arange(dof.size).reshape(dof.shape), -1)
    part = block._replace(
        node=np.arange(len(own)).reshape(elements, nodes),
        dof=apart,
        node_kind=block.node_kind[own],
        frame=block.frame[own],
        stiffness=np.ascontiguousarray(np.broadcast_to(np.eye(strains), block.stiffness.shape)),
    )
    at = np.where(dof >= 0, p[dof], 0.0).ravel()
    sheet = free_sheet(part, len(at))
    places = np.arange(len(at)) % (nodes * width)
    *measured, zeros = resultants(sheet, at, (1.0 * (places == place) for place in range(nodes * width + 1)))
    loose = np.abs(block.stiffness).max(axis=3) == 0.0
    resists = resisting(block)
    loose = loose[:, :, resists]
    number = np.arange(elements * points * len(resists)).reshape(elements, points, len(resists))
    entries: list[tuple[np.ndarray, np.ndarray, np.ndarray]] = []
    for place in range(nodes * width):
        column = system.unknowns.free[dof.reshape(elements, -1)[:, place]]
        known = (dof.reshape(elements, -1)[:, place] >= 0) & (column >= 0)
        values = np.where(loose[block.kind], 0.0, (measured[place] - zeros)[:, :, resists])[known]
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
    strain = np.where(loose[block.kind], 0.0, zeros[:, :, resists])
    return slopes, csr_array(flexible), weight.ravel(), strain.ravel()
