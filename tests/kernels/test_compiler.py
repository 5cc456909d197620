"""The Python that kernels are written in: compiled, it does what Python does; what it does not know is named."""

import math

import numpy as np
import pytest

from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.pointers import at, room
from beamfem.kernels.records import Reals, Record, Wholes, calls


@routine("iin")
def whole_numbers(a, b, result):
    result[0], result[1], result[2] = a + b, a - b, a * b
    result[3], result[4] = a // b, a % b
    result[5], result[6], result[7] = min(a, b), max(a, b, 3), abs(a)
    result[8], result[9] = -a, int(a / b)


@pytest.mark.parametrize(("a", "b"), [(7, 3), (-7, 3), (7, -3), (-7, -3), (6, 3), (-6, 3), (0, 5), (2**40, 7)])
def test_whole_numbers_are_those_of_python(a, b):
    found, wanted = np.zeros(10, dtype=np.int64), np.zeros(10, dtype=np.int64)
    whole_numbers(a, b, found)
    whole_numbers.function(a, b, wanted)
    assert np.array_equal(found, wanted)


@routine("ddr")
def numbers(a, b, result):
    result[0], result[1], result[2], result[3] = a + b, a - b, a * b, a / b
    result[4], result[5], result[6] = abs(a) ** 0.8, math.sqrt(abs(a)), math.atan2(a, b)
    result[7], result[8], result[9] = min(a, b), max(a, 1), np.floor(a)
    result[10], result[11], result[12] = 2 * a, 1 / b, int(a)
    result[13] = a if a > b else 0


@pytest.mark.parametrize(("a", "b"), [(1.5, 0.3), (-1.5, 0.3), (1e-300, -1e300), (-0.0, 1.0), (3.0, 3.0)])
def test_numbers_are_those_of_python(a, b):
    found, wanted = np.zeros(14), np.zeros(14)
    numbers(a, b, found)
    numbers.function(a, b, wanted)
    assert np.all(np.abs(found - wanted) <= np.spacing(np.abs(wanted)))
    assert np.array_equal(np.delete(found, [4, 6]), np.delete(wanted, [4, 6]))  # all but those of the C library


@routine("ddn")
def conditions(a, b, result):
    result[0], result[1], result[2] = a < b, a <= b, a == b
    result[3], result[4], result[5] = a > b, a >= b, a != b
    result[6], result[7] = not a < b, 0.0 < a <= b
    result[8] = 1 if a > 0.0 and b > 0.0 else 0
    result[9] = 1 if a > 0.0 or b > 0.0 else 0
    flag = a > 0.0 and b > 0.0 and a < b
    result[10], result[11] = flag, (int(a) if abs(a) < 9.0 else 0) in (1, 2, 5)
    result[12] += a < b


@pytest.mark.parametrize("a", [-1.0, 0.0, 1.0, 2.5, 5.0, math.nan, math.inf])
@pytest.mark.parametrize("b", [-1.0, 1.0, math.nan])
def test_conditions_are_those_of_python(a, b):
    """Of numbers that are none as well: residuals become such, and what follows must see it."""
    if not math.isfinite(a):
        conditions_of = [(a < b), (a <= b), (a == b), (a > b), (a >= b), (a != b), (not a < b), (0.0 < a <= b)]
    else:
        wanted = np.zeros(13, dtype=np.int64)
        conditions.function(a, b, wanted)
        conditions_of = wanted
    found = np.zeros(13, dtype=np.int64)
    conditions(a, b, found)
    assert np.array_equal(found[: len(conditions_of)], conditions_of)


@routine("in", "i")
def loops(n, result):
    """Loops that end early, go down, count in steps and are nested."""
    total = count = 0
    for i in range(n):
        if i % 2 == 0:
            continue
        for j in range(i, 0, -2):
            if j == 5:
                break
            total += j
        if total > 60:
            result[0] = i
            return total
    while True:
        count += 1
        if count * count > n:
            break
    for i in range(3, n, 4):
        total -= i
        n -= 1
    result[0], result[1] = count, n
    if n < 4:
        return -1
    elif n < 6:
        total = 0
    else:
        pass
    return total


@pytest.mark.parametrize("n", range(24))
def test_loops_are_those_of_python(n):
    found, wanted = np.zeros(2, dtype=np.int64), np.zeros(2, dtype=np.int64)
    assert loops(n, found) == loops.function(n, wanted)
    assert np.array_equal(found, wanted)


@inlined
def swapped(a, b):
    if a > b:
        return b, a
    return a, b


@inlined
def set_all(values, count, value):
    for i in range(count):
        values[i] = value


FACTOR = 2.5


@routine("ir", "d")
def added(n, values):
    total = 0.0
    for i in range(n):
        total += values[i]
    return total


class Sum(Record):
    add = calls(added)
    count: Wholes
    numbers: Reals


@routine()
def called(table: Sum, values: Reals, x: float) -> float:
    """Calls by address and in place, memory of its own, names that begin anew with another kind."""
    a, b = swapped(values[0], values[1])
    set_all(values, 2, x)
    values[2], values[3] = a, b
    own = room(3)
    for i in range(3):
        own[i] = FACTOR * i
    values, first = at(values, 4), values
    values[0] = own[1] + own[2] + first[2]
    x = table.count
    x[0] += 4
    return table.add(x[0], table.numbers)


def test_arguments_that_are_fixed_are_not_asked_for():
    numbers = np.array([1.0, 10.0, 100.0])
    two = added.fixed(n=2, others=5)
    assert two is added.fixed(n=2)
    assert (two(3, numbers), added(3, numbers)) == (11.0, 111.0)
    assert added.fixed(others=5) is added


def test_calls_by_address_and_in_place():
    count, numbers, values = np.array([-1]), np.array([1.0, 10.0, 100.0]), np.array([7.0, 3.0, 0.0, 0.0, 0.0])
    assert called(Sum(add=added, count=count, numbers=numbers), values, 9.0) == 111.0
    assert count[0] == 3
    assert np.array_equal(values, [9.0, 9.0, 3.0, 7.0, 2.5 + 5.0 + 3.0])


@inlined
def set_to_ten(x):
    x[0] = 10.0
    return 1.0


@routine("r")
def read_before_it_is_called(x):
    x[0] += set_to_ten(x)


@routine("i", "i")
def all_ways(n):
    """Values that every way here gives; ways that end do not count."""
    while True:
        if n > 100:
            found = 1
            break
        n += 60
        found = 2
        if n > 90:
            break
    if n % 2 == 0:
        other = 3
    else:
        if n > 150:
            return -1
        other = 4
    return 10 * found + other


def test_the_order_of_python_is_kept():
    x = np.array([1.0])
    read_before_it_is_called(x)
    assert x[0] == 2.0
    assert [all_ways(n) for n in (0, 31, 33, 45, 101, 102, 151)] == [
        all_ways.function(n) for n in (0, 31, 33, 45, 101, 102, 151)
    ]
