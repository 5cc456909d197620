"""Floating-point operations of the kernels as they are written: the kernels run uncompiled on numbers that count.

Run as a script with NUMBA_DISABLE_JIT=1 it prints JSON: form -> kernel -> [operations, slow ones among them] of one
element inside a long chain. An addition or a multiplication is one operation, a fused multiply-add two; a division,
root, sine or cosine is one as well, and slow. A compiler may share some of what is written twice.
"""

import json
import operator
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from roofline_cases import FACTOR, FORMS, KERNELS, RESIDUAL, SOLVE, TANGENT, Case, case

from beamfem.kernels.balance import balance
from beamfem.kernels.band import factor, solve

_CHAINS = (5, 9)  # elements; their difference leaves the ends out


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
        self.tally.operations += 1
        self.tally.slow += slow
        return Counted(operation(other, self.value), self.tally)

    return forward, reflected


for _name in ("add", "sub", "mul", "truediv"):
    _both = _counting(getattr(operator, _name), _name == "truediv")
    setattr(Counted, f"__{_name}__", _both[0])
    setattr(Counted, f"__r{_name}__", _both[1])


def counted(data: Any, tally: Tally) -> Any:
    """Return nested tuples of arrays with every floating-point number replaced by one that counts."""
    if isinstance(data, np.ndarray):
        if data.dtype.kind != "f":
            return data
        numbers = [Counted(float(x), tally) for x in data.ravel()]
        result = np.empty(len(numbers), dtype=object)
        result[:] = numbers
        return result.reshape(data.shape)
    if isinstance(data, tuple):
        parts = [counted(part, tally) for part in data]
        return type(data)(*parts) if hasattr(data, "_fields") else tuple(parts)
    return data


def count(form: str) -> dict[str, tuple[float, float]]:
    """Return operations, and slow ones, of each kernel, for an element."""
    less, more = (_count_chain(form, elements) for elements in _CHAINS)
    span = _CHAINS[1] - _CHAINS[0]
    return {name: tuple((b - a) / span for a, b in zip(less[name], more[name], strict=True)) for name in KERNELS}


def _count_chain(form: str, elements: int) -> dict[str, tuple[int, int]]:
    tally = Tally()
    one: Case = counted(case(form, elements)[1], tally)
    nothing = one.band.reshape(-1)[:0]
    tasks = {
        RESIDUAL: lambda: balance(*one.balance, one.residual, nothing),
        TANGENT: lambda: balance(*one.balance, one.residual, one.band.reshape(-1)),
        FACTOR: lambda: factor(one.band, one.right[:0], np.empty_like(one.right), one.window),
        SOLVE: lambda: solve(one.band, one.right, one.window),
    }
    found = {}
    for name, task in tasks.items():
        tally.operations = tally.slow = 0
        task()
        found[name] = tally.operations, tally.slow
    return found


def count_all() -> dict[str, dict[str, tuple[float, float]]]:
    """Return the counts of all forms, from a process in which nothing is compiled."""
    done = subprocess.run(
        [sys.executable, str(Path(__file__))],
        env=os.environ | {"NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
        check=True,
    )
    result: dict[str, dict[str, tuple[float, float]]] = json.loads(done.stdout)
    return result


if __name__ == "__main__":
    print(json.dumps({form: count(form) for form in FORMS}))
