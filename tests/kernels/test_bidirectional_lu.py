"""Factors of a band from both ends: solutions, pivots and refusals as those from one end, against NumPy."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.equations.equations import STATICS, linearise
from beamfem.equations.system import system_of
from beamfem.kernels.band import KNOWN, band
from beamfem.kernels.bidirectional_lu import bidirectional_lu


def matrix(n, w, rng, sign=1.0):
    """Return an unsymmetric band matrix (n, n) with strong diagonals and its rows (n, 2 w + 1)."""
    whole = np.zeros((n, n))
    for i in range(n):
        for j in range(max(0, i - w), min(n, i + w + 1)):
            whole[i, j] = rng.standard_normal()
        whole[i, i] = sign * (3.0 * w + rng.uniform())
    rows = np.zeros((n, 2 * w + 1))
    for i in range(n):
        for j in range(max(0, i - w), min(n, i + w + 1)):
            rows[i, w + j - i] = whole[i, j]
    return whole, rows


def whole_band(n, w):
    """Return the envelope of a band without zeros in it, see `equations.layout.reaches`."""
    down = np.minimum(np.arange(n) + w + 1, n).astype(np.int32)
    return np.array([down, down[::-1]])


@pytest.mark.parametrize("w", [1, 3, *KNOWN])
@pytest.mark.parametrize("short", [False, True])
def test_solutions_are_those_of_dense_matrices(w, short, rng):
    """Whatever is left between both ends: w or w + 1 rows, or all where there are fewer."""
    own = bidirectional_lu(w, short)
    for n in (1, 2, w, w + 1, w + 2, w + 3, 2 * w + 1, 3 * w, 3 * w + 1, 4 * w + 7, 101):
        whole, rows = matrix(n, w, rng)
        right = rng.standard_normal(n)
        x = right.copy()
        ratio = own.factor(n, w, whole_band(n, w), rows, np.empty(n))
        own.solve(n, w, rows, x)
        np.testing.assert_allclose(x, np.linalg.solve(whole, right), rtol=1e-12, atol=1e-14)
        assert 0.2 < ratio <= 1.0


@pytest.mark.parametrize("w", KNOWN)
def test_a_pivot_that_is_zero_is_seen_wherever_it_is(w, rng):
    n = 5 * w + 4
    for where in (2, n // 2, n - 3):
        _, rows = matrix(n, w, rng)
        pieces = [band(w).factor(n, n, w, 0, whole_band(n, w)[0].copy(), rows.copy(), np.empty(n), np.empty(n))]
        pieces.append(bidirectional_lu(w, False).factor(n, w, whole_band(n, w), rows.copy(), np.empty(n)))
        assert min(pieces) > 0.2
        rows[where] = 0.0
        assert bidirectional_lu(w, False).factor(n, w, whole_band(n, w), rows, np.empty(n)) == 0.0


@pytest.mark.parametrize("w", KNOWN)
def test_negative_definite_and_mixed_matrices_are_solved_too(w, rng):
    n = 6 * w + 1
    for signs in (-np.ones(n), np.where(np.arange(n) % 3 == 0, -1.0, 1.0)):
        whole, rows = matrix(n, w, rng)
        whole, rows = signs[:, None] * whole, signs[:, None] * rows
        right = rng.standard_normal(n)
        x = right.copy()
        assert bidirectional_lu(w, False).factor(n, w, whole_band(n, w), rows, np.empty(n)) > 0.1
        bidirectional_lu(w, False).solve(n, w, rows, x)
        np.testing.assert_allclose(x, np.linalg.solve(whole, right), rtol=1e-11, atol=1e-13)


CHAINS = [
    (bf.BilinearCRBF(), ()),
    (bf.ANCF(), ()),
    (bf.CRBF(2), ()),
    (bf.CRBF(3), ("middle",)),
    (bf.CRBF(4), ("middle",)),
    (bf.CRBF(6), ()),
    (bf.ShearRigid(), ("middle",)),
]


@pytest.mark.parametrize(("element", "extra"), CHAINS, ids=[element.name for element, _ in CHAINS])
def test_rows_that_a_chain_does_not_couple_stay_as_they_are(element, extra, rng):
    """Factors within the envelope are, to the last bit, those of the whole band, from either end and from both."""
    beam = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.4)), 9, element, bf.Rectangle(0.01, 0.02), bf.Material(1e7, 0.3, 1000.0))
    supports = [bf.Clamp(beam.start), bf.Pin(beam.end)]
    supports += [bf.Prescribed(beam.at(1.0 / 3.0), uy=0.0) for _ in extra]
    system = system_of(bf.Model([beam], supports, []), static=True)
    pushed = system.reference + 1e-4 * rng.standard_normal(system.model.size)
    zeros = np.zeros_like(pushed)
    rows = linearise(system, pushed, zeros, zeros, 0.0, STATICS)[1].rows
    n, w, reach = len(rows), rows.shape[1] // 2, system.unknowns.reach
    assert reach[0].sum() < whole_band(n, w)[0].sum()
    routines = [lambda lu, own: band(w).factor(n, n, w, 0, own[0].copy(), lu, np.empty(n), np.empty(n))]
    routines.append(lambda lu, own: bidirectional_lu(w, False).factor(n, w, own, lu, np.empty(n)))
    for factored in routines:
        within, whole = rows.copy(), rows.copy()
        assert factored(within, reach) == factored(whole, whole_band(n, w))
        np.testing.assert_array_equal(within, whole)


def from_one_end(w, n, rows):
    return band(w).factor(n, n, w, 0, whole_band(n, w)[0].copy(), rows, np.empty(n), np.empty(n))


def from_both_ends(w, n, rows):
    return bidirectional_lu(w, False).factor(n, w, whole_band(n, w), rows, np.empty(n))


def inverse_pivots(factor, w, n):
    """Return where the factors have the inverse pivots; from both ends, rows of both ends are kept in pairs."""
    columns = np.full(n, w)
    if factor is from_both_ends:
        m = max(0, (n - w) // 2)
        columns[:m] = columns[n - m :] = 2 * w
    return np.arange(n), columns


@pytest.mark.parametrize("unit", [1e-280, 1e-160, 1e160, 1e280])
@pytest.mark.parametrize("factor", [from_one_end, from_both_ends])
@pytest.mark.parametrize("w", KNOWN)
def test_a_matrix_has_the_same_factors_in_any_unit(w, factor, unit, rng):
    """Pivots were found by products of two entries: beyond 1e154 or below 1e-162 these were no numbers, or zero."""
    n = 6 * w + 1
    _, rows = matrix(n, w, rng)
    rows[::3, w] *= -1.0
    scaled = unit * rows
    ratio = factor(w, n, rows)
    assert ratio > 0.1
    assert factor(w, n, scaled) == pytest.approx(ratio, rel=1e-9)
    scaled[inverse_pivots(factor, w, n)] *= unit
    np.testing.assert_allclose(scaled, rows, rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize("factor", [from_one_end, from_both_ends])
@pytest.mark.parametrize("w", KNOWN)
def test_entries_too_large_for_the_unit_of_the_others_are_refused(w, factor, rng):
    """The inverse of a determinant that was infinite was zero, and the unknown too, whatever its right-hand side."""
    n = 6 * w + 1
    for where in (0, 1, n - 2, n - 1):
        _, rows = matrix(n, w, rng)
        rows[where, w] = 1e308
        assert factor(w, n, rows) == 0.0 or rows[inverse_pivots(factor, w, n)].all()


@pytest.mark.parametrize("factor", [from_one_end, from_both_ends])
@pytest.mark.parametrize("w", KNOWN)
def test_nothing_beside_the_matrix_is_read_or_changed(w, factor, rng):
    """Rows are changed in whole lanes, which may reach over the end of a row but not over that of the matrix."""
    for n in (1, 2, 3, w, w + 1, w + 2, 3 * w, 3 * w + 1):
        _, rows = matrix(n, w, rng)
        memory = np.full(rows.size + 32, np.nan)
        inside = memory[16:-16].reshape(rows.shape)
        inside[:] = rows
        assert factor(w, n, inside) > 0.2
        assert np.isnan(memory[:16]).all()
        assert np.isnan(memory[-16:]).all()
        assert np.isfinite(inside).all()
