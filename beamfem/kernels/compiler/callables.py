"""What compiled code can call besides functions of Python: operations, and functions that stand in place."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from beamfem.kernels.compiler.kinds import NUMBER, WHOLE, Kind, Value

# What a function gives back that is called by its address: nothing, a whole number or a number.
RESULTS: dict[str, Kind | None] = {"": None, "i": WHOLE, "d": NUMBER}


@dataclass(frozen=True)
class Operation:
    """What compiled code does where a function is called; emit(build, *values) returns its value, if it has one."""

    emit: Callable[..., Value | None]


@dataclass(frozen=True)
class Inlined:
    """A function whose instructions stand where it is called; flags: see `build.Build`, None: those of its caller."""

    function: Callable[..., Any]
    flags: tuple[str, ...] | None = None

    def __call__(self, *arguments: Any) -> Any:
        """Call the function as the Python that it is."""
        return self.function(*arguments)


def operation(emit: Callable[..., Value | None]) -> Any:
    """Return the operation that a function of a build and of values writes."""
    made = Operation(emit)
    object.__setattr__(made, "__doc__", emit.__doc__)
    return made
