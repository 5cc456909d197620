"""Bands with a border of coupled unknowns and multipliers: solutions, and counts on the null space of conditions."""

import numpy as np
import pytest

from beamfem.linalg.bordered import Border, BorderedTangent, CondensedFactors
from beamfem.linalg.tangent import UNROTATED, BandTangent


def random_tangent(seed, symmetric, definite):
    rng = np.random.default_rng(seed)
    size, half = int(rng.integers(8, 40)), int(rng.choice([3, 5, 7]))
    i, j = np.indices((size, size))
    band = np.where(np.abs(i - j) <= half, rng.standard_normal((size, size)), 0.0)
    band = (0.5 * (band + band.T) if symmetric else band) + np.eye(size) * (half if definite else 0.2)
    rows = np.array(
        [[band[i, j] if 0 <= j < size else 0.0 for j in range(i - half, i + half + 1)] for i in range(size)]
    )
    edge = int(rng.integers(1, 8))
    conditions = int(rng.integers(0, min(edge, 3)))
    entries = rng.standard_normal((edge + conditions,) * 2)
    entries = entries + entries.T if symmetric else entries
    entries[edge:, edge:] = 0.0
    entries[edge:, :edge] = entries[:edge, edge:].T
    numbers = np.sort(rng.choice(size, edge, replace=False))
    reach = np.minimum(np.arange(size) + half + 1, size).astype(np.int32)
    return BorderedTangent(BandTangent(rows, reach), Border(numbers, conditions, entries))


@pytest.mark.parametrize("symmetric", [True, False])
@pytest.mark.parametrize("definite", [True, False])
@pytest.mark.parametrize("seed", range(40))
def test_solutions_and_counts_are_those_of_the_whole_matrix(seed, definite, symmetric, rng):
    tangent = random_tangent(seed, symmetric, definite)
    whole, factors = tangent.sparse(UNROTATED).toarray(), tangent.factorised(UNROTATED)
    assert isinstance(factors, CondensedFactors)
    right = rng.standard_normal(len(whole))
    assert whole @ factors.solve(right) == pytest.approx(right, abs=1e-9 * np.linalg.cond(whole))
    conditions = tangent.border.multipliers
    if symmetric:
        assert factors.negative_pivots == np.count_nonzero(np.linalg.eigvalsh(whole) < 0.0) - conditions
    else:
        assert (-1.0) ** (factors.negative_pivots + conditions) == np.sign(np.linalg.det(whole))


def test_what_conditions_alone_hold_keeps_its_digits():
    """A band without stiffness in one direction, which a condition holds: the sum of its ends is zero."""
    size = 12
    rows = np.tile([-1e9, 2e9, -1e9], (size, 1))
    rows[0, :2] = 0.0, 1e9
    rows[-1, 1:] = 1e9, 0.0
    reach = np.minimum(np.arange(size) + 2, size).astype(np.int32)
    entries = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.0]])
    tangent = BorderedTangent(BandTangent(rows, reach), Border(np.array([0, size - 1]), 1, entries))
    factors, right = tangent.factorised(UNROTATED), np.arange(size + 1.0) * (np.arange(size + 1) < size)
    assert isinstance(factors, CondensedFactors)
    assert factors.negative_pivots == 0
    x = factors.solve(right)
    assert x[0] + x[-2] == pytest.approx(0.0, abs=1e-15 * np.abs(x[:-1]).max())
    assert x[-1] == pytest.approx(right.sum() / 2.0, rel=1e-9)
    assert tangent.sparse(UNROTATED) @ x == pytest.approx(right, abs=1e-6)
