"""Records: fields that compiled code and Python share by name."""

import gc
from typing import Annotated
from weakref import ref

import numpy as np
import pytest

from beamfem.kernels.compiling import routine
from beamfem.kernels.pointers import at, given
from beamfem.kernels.records import Reals, Record, Several, Slots, Table, Wholes, aligned, calls


class Pair(Record):
    first: int
    second: float


@routine()
def weighted(pair: Pair, values: Reals) -> float:
    return pair.first * values[0] + pair.second * values[1]


class Part(Record):
    count: int
    width: int = 2
    factor: float = 0.5
    values: Annotated[Reals, "count", "width"]
    numbers: Wholes
    short: Slots
    pairs: Annotated[Several, Pair]
    sum = calls(weighted)


class Whole(Record):
    size: int
    total: float
    parts: Table[Part]
    pair: Pair
    rest: Reals


class More(Whole):
    extra: int


def part(**others):
    return Part(count=3, values=np.arange(6.0).reshape(3, 2), sum=weighted, **others)


@routine()
def read(whole: Whole) -> float:
    """Fields of several kinds, also of records in records, side by side and in a table."""
    own, total = whole.parts[1], 0.0
    for i in range(own.count * own.width):
        total += own.factor * own.values[i]
    for i in range(own.count):
        total += 100.0 * own.numbers[i] + 1000.0 * own.short[i]
    pair = own.pairs[1]
    return total + 1e5 * pair.first + 1e6 * pair.second + 1e7 * whole.pair.first


def test_fields_are_read_by_name():
    own = part(numbers=np.array([1, 2, 3]), short=np.array([4, 5, 6], dtype=np.int32))
    own.pairs = np.array([[0, 0], [7, np.array([2.0]).view(np.int64)[0]]])
    whole = Whole(size=2, parts=[part(), own], pair=Pair(first=3))
    assert read(whole) == 7.5 + 600.0 + 15e3 + 7e5 + 2e6 + 3e7


@routine()
def change(whole: Whole) -> None:
    own = whole.parts[0]
    whole.size += 1
    whole.total = own.factor
    own.values[1] = 9.0
    whole.pair.second *= 3.0
    whole.rest = at(own.values, 2)
    own.numbers = None


def test_fields_are_set_by_name():
    own, whole = part(numbers=np.array([1])), Whole(size=2, pair=Pair(second=2.0))
    whole.parts = (own,)
    change(whole)
    assert (whole.size, whole.total, whole.pair.second, own.values[0, 1]) == (3, 0.5, 6.0, 9.0)
    seen = Whole.at(whole.address)
    assert (seen.size, seen.pair.second) == (3, 6.0)
    assert np.array_equal(Part.at(own.address).values, own.values)
    assert whole.memory[4] == own.values.ctypes.data + 16
    assert own.memory[4] == 0


@routine()
def called(own: Part, pair: Pair) -> float:
    return own.sum(pair, own.values) if given(own.numbers) else own.sum(pair, at(own.values, 1))


def test_functions_are_called_by_their_fields():
    assert called(part(), Pair(first=2, second=10.0)) == 2.0 + 20.0
    assert called(part(numbers=np.zeros(1, dtype=np.int64)), Pair(first=2, second=10.0)) == 10.0


def test_a_record_of_more_fields_may_stand_for_one_of_fewer():
    more = More(size=1, extra=5, parts=[part(), part()], pair=Pair())
    assert list(More.fields)[:5] == list(Whole.fields)

    @routine()
    def size_of(whole: Whole) -> int:
        return whole.size

    class Sized(Record):
        size = calls(size_of)

    @routine()
    def size_of_more(sized: Sized, more: More) -> int:
        return sized.size(more)

    assert size_of_more(Sized(size=size_of), more) == 1
    with pytest.raises(TypeError, match="takes a Whole, got a Pair"):
        size_of(Pair())


def test_a_record_keeps_what_it_refers_to_alive():
    array = np.zeros(3)
    whole, seen = Whole(rest=array, pair=Pair(first=1)), ref(array)
    copy = whole.copy()
    del array, whole
    gc.collect()
    assert seen() is copy.rest
    assert copy.pair.first == 1
    copy.rest = None
    assert seen() is None


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"values": np.zeros((2, 2))}, r"values has the shape \(3, 2\), got \(2, 2\)"),
        ({"values": np.zeros((3, 2), dtype=np.float32)}, "values takes contiguous float64, got float32"),
        ({"values": np.zeros((2, 3)).T}, "values takes contiguous float64"),
        ({"numbers": np.zeros(3)}, "numbers takes contiguous int64"),
        ({"short": np.zeros(3, dtype=np.int64)}, "short takes contiguous int32"),
        ({"valuse": np.zeros(3)}, "Part has no valuse"),
    ],
)
def test_arrays_are_checked_when_they_are_given(values, message):
    with pytest.raises((TypeError, ValueError), match=message):
        Part(count=3, **values)


def test_room_is_made_by_the_shapes_that_are_declared():
    own = Part(count=5)
    own.fill(**aligned(own.shapes("values")))
    assert own.values.shape == (5, 2)
    assert own.values.ctypes.data % 64 == 0
    assert not own.values.any()


def missing(own: Part) -> int:
    return own.missing


def field_of_an_array(own: Part) -> int:
    return own.values.count


def called_number(own: Part) -> int:
    return own.count(1)


def other_record(own: Part) -> float:
    return own.sum(own, own.values)


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (missing, "a Part has no missing"),
        (field_of_an_array, "a pointer to numbers has no count"),
        (called_number, "a whole number cannot be called"),
        (other_record, "a Part is no Pair"),
    ],
)
def test_what_a_record_has_not_is_refused(function, message):
    with pytest.raises(TypeError, match=message):
        routine()(function).module()
