"""Functions that compiled code can call, besides a few of Python: operations and inlined functions."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from beamfem.kernels.compiler.value_types import Value


@dataclass(frozen=True)
class Operation:
    """A call that is replaced by instructions: emit(build, *values) writes them, and returns their value if any."""

    emit: Callable[..., Value | None]


@dataclass(frozen=True)
class Inlined:
    """A function that is inlined where it is called; flags: see `build.Build`, None for those of the caller."""

    function: Callable[..., Any]
    flags: tuple[str, ...] | None = None

    def __call__(self, *arguments: Any) -> Any:
        """Call the function as ordinary Python."""
        return self.function(*arguments)


def operation(emit: Callable[..., Value | None]) -> Any:
    """Return the operation whose instructions are written by emit(build, *values); usable as a decorator."""
    result = Operation(emit)
    object.__setattr__(result, "__doc__", emit.__doc__)
    return result
