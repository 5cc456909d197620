"""Floating-point operations of the kernels as they are written: the kernels run uncompiled on numbers that count.

Of one element inside a long chain. An addition or a multiplication is one operation, a fused multiply-add two; a
division, root, sine or cosine is one as well, and slow. A compiler may share some of what is written twice.
"""

import operator
from collections.abc import Callable
from typing import Any

import numpy as np

from beamfem.kernels.bidirectional_lu import SHORT, bidirectional_lu
from beamfem.kernels.model_passes import balance
from studies.benchmarks.roofline_cases import FACTOR, FORMS, KERNELS, RESIDUAL, SOLVE, TANGENT, case, place
from studies.benchmarks.uncompiled import Fields, Memory, arrays_of, uncompiled

_NOTHING = 0  # a whole number, which no sum of floating-point numbers is
_CHAINS = (17, 21)  # elements, so many that bands are factorised from both ends; their difference leaves the ends out


class Tally:
    """How many operations there were, and how many of them were slow."""

    def __init__(self) -> None:
        self.operations = self.slow = 0


class Counted:
    """A number that counts what is done with it."""

    __slots__ = ("tally", "value")

    def __init__(self, value: float, tally: Tally) -> None:
        self.value, self.tally = value, tally

    def __float__(self) -> float:
        """Only functions of `math` ask for this."""
        self.tally.operations += 1
        self.tally.slow += 1
        return self.value

    def __neg__(self) -> "Counted":
        return Counted(-self.value, self.tally)

    def __abs__(self) -> "Counted":
        return Counted(abs(self.value), self.tally)

    def __lt__(self, other: Any) -> bool:
        return self.value < plain(other)

    def __gt__(self, other: Any) -> bool:
        return self.value > plain(other)

    def __eq__(self, other: object) -> bool:
        return self.value == plain(other)

    __hash__ = None  # type: ignore[assignment]


def plain(number: Any) -> Any:
    """Return the number itself."""
    return number.value if isinstance(number, Counted) else number


def _counting(
    operation: Callable[[Any, Any], Any], slow: bool
) -> tuple[Callable[..., Counted], Callable[..., Counted]]:
    def forward(self: Counted, other: Any) -> Counted:
        self.tally.operations += 1
        self.tally.slow += slow
        return Counted(operation(self.value, plain(other)), self.tally)

    def reflected(self: Counted, other: Any) -> Counted:
        if other is _NOTHING and operation is operator.add:  # the begin of a sum
            return self
        self.tally.operations += 1
        self.tally.slow += slow
        return Counted(operation(other, self.value), self.tally)

    return forward, reflected


for _name in ("add", "sub", "mul", "truediv"):
    _both = _counting(getattr(operator, _name), _name == "truediv")
    setattr(Counted, f"__{_name}__", _both[0])
    setattr(Counted, f"__r{_name}__", _both[1])


def count(form: str) -> dict[str, tuple[float, float]]:
    """Return operations, and slow ones, of each kernel, for an element."""
    less, more = (_count_chain(form, elements) for elements in _CHAINS)
    span = _CHAINS[1] - _CHAINS[0]
    return {name: tuple((b - a) / span for a, b in zip(less[name], more[name], strict=True)) for name in KERNELS}


def _count_chain(form: str, elements: int) -> dict[str, tuple[int, int]]:
    tally = Tally()
    _, one = case(form, elements)
    half, n = one.half_width, len(one.right)
    # of a known half width, rows are changed in whole lanes, also beside the band
    own, needed = bidirectional_lu(half, n < SHORT), bidirectional_lu(0, True)
    equations, space = one.equations, np.empty(n)
    arrays = [*arrays_of(equations.record), one.state, one.residual, one.band, one.right, one.reach, space]
    addresses = [each.ctypes.data for each in (one.band, one.right, one.reach, space)]
    routines = balance, needed.factor, own.solve
    for routine in routines:
        assert routine.address
    memory = Memory(arrays, lambda value: Counted(value, tally))
    rows, right, reach, pivots = (memory.at(address) for address in addresses)
    record = Fields(equations.record, memory)

    def balanced(tangent: bool) -> None:
        place(one, tangent)
        balance.function(record)

    def solved() -> None:
        own.solve.function(n, half, rows, right)

    tasks = {
        RESIDUAL: lambda: balanced(False),
        TANGENT: lambda: balanced(True),
        FACTOR: lambda: needed.factor.function(n, half, reach, rows, pivots),
        SOLVE: solved,
    }
    found = {}
    with uncompiled():
        for name, task in tasks.items():
            tally.operations = tally.slow = 0
            task()
            found[name] = tally.operations, tally.slow
    return found


def count_all() -> dict[str, dict[str, tuple[float, float]]]:
    """Return the counts of all forms."""
    return {form: count(form) for form in FORMS}
