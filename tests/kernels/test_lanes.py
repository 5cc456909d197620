"""Lanes against NumPy: what compiled passes do with several numbers at once, and with those beyond the last."""

import math

import numpy as np
import pytest

from beamfem.kernels import nodes
from beamfem.kernels.compiling import routine
from beamfem.kernels.model_record import ROW
from beamfem.kernels.records import address_of
from beamfem.kernels.simd import WIDTH, as_rows, larger, largest, merged, power_of_two, zeros

COUNTS = (1, 2, WIDTH - 1, WIDTH, WIDTH + 1, 3 * WIDTH, 3 * WIDTH + 5)


@routine("ivvv")
def arithmetic(count, x, y, result):
    """Fill rows with what operators give."""
    for i in range(0, count, WIDTH):
        a, b = x[i], y[i]
        result[i], result[ROW + i], result[2 * ROW + i], result[3 * ROW + i] = a + b, a - b, a * b, a / b
        result[4 * ROW + i], result[5 * ROW + i] = -a, math.sqrt(b)
        result[6 * ROW + i], result[7 * ROW + i] = 2.0 * a, a - 0.5
        result[8 * ROW + i], result[9 * ROW + i] = 1.0 / b, np.floor(a)
        total = zeros()
        total += a
        total -= b
        total *= a
        result[10 * ROW + i], result[11 * ROW + i] = total, 7.0


@routine("irr")
def keep(count, source, to):
    """Copy the first numbers, and leave what follows them."""
    own, its = as_rows(source), as_rows(to)
    for i in range(0, count, WIDTH):
        its[i] = merged(own[i], its[i], count - i)


def rows(count):
    return np.full((count, ROW), np.nan)


@pytest.mark.parametrize("count", COUNTS)
def test_operators_are_those_of_numpy(count, rng):
    x, y, result = rows(1), rows(1), rows(12)
    x[0, :count], y[0, :count] = rng.uniform(-3.0, 3.0, count), rng.uniform(0.1, 3.0, count)
    arithmetic(count, x, y, result)
    a, b = x[0, :count], y[0, :count]
    expected = [a + b, a - b, a * b, a / b, -a, np.sqrt(b), 2.0 * a, a - 0.5, 1.0 / b, np.floor(a), (a - b) * a, 7.0]
    for found, wanted in zip(result, expected, strict=True):
        assert np.all(found[:count] == wanted)


@pytest.mark.parametrize("count", COUNTS)
def test_lanes_of_others_stay_as_they_are(count, rng):
    source, to = rng.standard_normal(ROW), rng.standard_normal(ROW)
    before = to.copy()
    keep(count, source, to)
    assert np.array_equal(to[:count], source[:count])
    assert np.array_equal(to[count:], before[count:])


@routine("iv", "d")
def size(count, x):
    """Return the largest size of numbers."""
    found = zeros()
    for i in range(0, count, WIDTH):
        found = larger(x[i], found)
    return largest(found)


@pytest.mark.parametrize("count", [WIDTH, 3 * WIDTH])
def test_the_largest_size_is_that_of_numpy_and_what_is_no_number_is_larger(count, rng):
    x = rows(1)[0]
    x[:count] = rng.standard_normal(count)
    assert size(count, x) == np.abs(x[:count]).max()
    for place in range(count):
        for special in (np.inf, -np.inf, np.nan, -np.nan):
            y = x.copy()
            y[place] = special
            assert np.isnan(size(count, y)) if np.isnan(special) else size(count, y) == np.inf
    assert size(WIDTH, np.zeros(ROW)) == 0.0


@routine("d", "d")
def unit_of(x):
    """Return the power of two below a number."""
    return power_of_two(x)


def test_powers_of_two_are_those_below_numbers():
    for x in (1.0, 1.999, 2.0, 3.0, 1e200, 7e-200, 0.1, 1.7e308, 2.3e-308):
        assert unit_of(x) == unit_of(-x) == 2.0 ** math.floor(math.log2(x))
    assert unit_of(0.0) == unit_of(5e-324) == 0.0


@pytest.mark.parametrize("most", [1.0, 10.0, 1e3, 1e6])
def test_sections_turn_by_any_angle(most, rng):
    """Cosine and sine in all quarters, of multiples of a right angle and of angles beside them, to the last digits."""
    near = 0.5 * np.pi * np.arange(-4, 5)
    angle, frame, result = rows(1), rows(3), rows(3)
    given = np.concatenate([near, near + 1e-9, near - 1e-9, rng.uniform(-most, most, 29)])
    angle[0, : given.size], frame[:, : given.size] = given, [[1.0], [0.0], [2.5]]
    nodes.rotate_frame(given.size, frame.shape[1], angle, frame, result)
    for found, wanted in zip(result, (np.cos(given), np.sin(given), 2.5), strict=True):
        assert np.abs(found[: given.size] - wanted).max() <= 3e-16


def test_addresses_of_all_arrays():
    whole = np.arange(12.0).reshape(3, 4)
    locked = whole.copy()
    locked.flags.writeable = False
    for array in (whole, whole[1:], whole.T, whole[:, 1], locked, np.empty(0), np.arange(3)):
        assert address_of(array) == array.__array_interface__["data"][0]
