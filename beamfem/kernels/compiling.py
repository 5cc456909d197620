"""How kernels are compiled: one decorator.

A pass over rows of numbers is compiled once, on its own, and called by its address: drivers that call it neither wait
for it nor compile it again.
"""

from collections.abc import Callable
from ctypes import CFUNCTYPE, c_double, c_int64, c_void_p
from functools import cached_property
from time import process_time
from typing import Any, ClassVar

from numba import njit, types
from numba.core.ccallback import CFunc
from numpy import dtype, float64, int32, int64, ndarray

from beamfem.kernels.cache import KernelCache, cache_folder
from beamfem.kernels.pointers import KINDS, address_of

# of arrays by kind of argument; a table of whole numbers may stand for its address
_TYPES = {"r": dtype(float64), "v": dtype(float64), "n": dtype(int64), "s": dtype(int32), "i": dtype(int64)}


class Routine:
    """A compiled function of plain memory, called by its address; compiled, or loaded, when that is first asked for.

    Machine code is kept on disk where a folder can be written; where none can, or the disk is full, it is compiled for
    each process. kinds: one letter an argument, see `pointers.KINDS`; seconds: CPU time of compiling or loading it;
    made: all there are in this process.
    """

    made: ClassVar[list["Routine"]] = []

    def __init__(self, function: Callable[..., Any], kinds: str, returns: types.Type, options: dict[str, Any]) -> None:
        self.function, self.kinds, self.returns, self.options = function, kinds, returns, options
        self.__doc__, self.__module__, self.seconds = function.__doc__, function.__module__, 0.0
        self.made.append(self)

    @cached_property
    def compiled(self) -> Any:
        begun, arguments = process_time(), tuple(KINDS[kind] for kind in self.kinds)
        pointer: Any = CFunc(self.function, (arguments, self.returns), {}, {"error_model": "numpy", **self.options})
        if cache_folder() is not None:
            pointer._cache = KernelCache(self.function)
        pointer.compile()
        self.seconds = process_time() - begun
        return pointer

    @property
    def name(self) -> str:
        return f"{self.__module__}.{self.function.__name__}"

    @property
    def compiled_here(self) -> bool:
        """Whether this process had to compile it, and did not find it on disk."""
        return "compiled" in vars(self) and self.compiled.cache_hits == 0

    @property
    def address(self) -> int:
        """Where it is called as C calls functions."""
        return self.compiled.address

    @property
    def entry(self) -> int:
        """Where other compiled code calls it, without the function that lets C call it."""
        name = self.compiled._wrapper_name.removeprefix("cfunc.")
        return self.compiled._library.get_pointer_to_function(name)

    @cached_property
    def _callable(self) -> Callable[..., Any]:
        plain: dict[str, Any] = {"i": c_int64, "d": c_double}
        returns = {types.void: None, types.int64: c_int64, types.float64: c_double}[self.returns]
        return CFUNCTYPE(returns, *(plain.get(kind, c_void_p) for kind in self.kinds))(self.address)

    def __call__(self, *arguments: Any) -> Any:
        """Call it from Python, with arrays of the right type or addresses for pointers; other threads run meanwhile."""
        both = zip(self.kinds, arguments, strict=True)
        return self._callable(*[_address(kind, each) if isinstance(each, ndarray) else each for kind, each in both])


def _address(kind: str, array: ndarray) -> int:
    """Return where an array begins; compiled code reads whatever is there, so that its type is looked at here."""
    if array.dtype != _TYPES[kind] or not array.flags.c_contiguous:
        raise TypeError(f"compiled code takes contiguous {_TYPES[kind]}, got {array.dtype} {array.strides}")
    return address_of(array)


def routine(
    kinds: str, returns: types.Type = types.void, case: str = "", **options: Any
) -> Callable[[Callable[..., Any]], Routine]:
    """Return a decorator that makes a `Routine` of a function; `options` are those of `numba.cfunc`.

    case: tells functions of one definition apart. Machine code is found by name, so that two of a name that come from
    the disk, each compiled by another process, may be taken for one another.
    """

    def made(function: Callable[..., Any]) -> Routine:
        if case:
            function.__name__ += f"_{case}"
            function.__qualname__ += f"_{case}"
        return Routine(function, kinds, returns, {"_nrt": False, **options})

    return made


def inlined(function: Routine) -> Callable[..., Any]:
    """Return what other compiled code calls without going through an address, where a routine is a small part of it."""
    return njit(error_model="numpy", forceinline=True, **function.options)(function.function)
