"""How kernels are compiled: one decorator.

A pass over rows of numbers is compiled once, on its own, and called by its address: drivers that call it neither wait
for it nor compile it again.
"""

import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from ctypes import CFUNCTYPE, c_double, c_int64, c_void_p
from functools import cached_property
from threading import RLock, local
from time import perf_counter, process_time
from typing import Any, ClassVar

from numpy import dtype, float64, int32, int64, ndarray

from beamfem.kernels import cache
from beamfem.kernels.compiler import machine
from beamfem.kernels.compiler.callables import Inlined
from beamfem.kernels.compiler.translation import translate
from beamfem.kernels.pointers import address_of

# of arrays by kind of argument; a table of whole numbers may stand for its address
_TYPES = {"r": dtype(float64), "v": dtype(float64), "n": dtype(int64), "s": dtype(int32), "i": dtype(int64)}
_PLAIN: dict[str, Any] = {"": None, "i": c_int64, "d": c_double}
_compiling = RLock()  # two threads may need a kernel at once, and LLVM works for one of them
if hasattr(os, "register_at_fork"):  # a process that is forked meanwhile would wait for the lock without end
    os.register_at_fork(
        before=_compiling.acquire, after_in_parent=_compiling.release, after_in_child=_compiling.release
    )


class _Waiting(local):
    """How long this thread has waited for machine code, and whether it does now."""

    seconds, now = 0.0, False

    @contextmanager
    def counted(self) -> Iterator[None]:
        """Count the time of a block once, also where it asks for further kernels."""
        if self.now:
            yield
            return
        begun, self.now = perf_counter(), True
        try:
            yield
        finally:
            self.seconds, self.now = self.seconds + perf_counter() - begun, False


_waiting = _Waiting()


def seconds_waited() -> float:
    """Return how long this thread has waited for kernels to be compiled or loaded so far [s]."""
    return _waiting.seconds


class Routine:
    """A compiled function of plain memory, called by its address; compiled, or loaded, when that is first asked for.

    Machine code is kept on disk where a folder can be written; where none can, or the disk is full, it is compiled for
    each process. kinds: one letter an argument, see `compiler.kinds.KINDS`; returns: "i" a whole number, "d" a number;
    seconds: CPU time of compiling or loading it; compiled_here: whether this process had to compile it, and did not
    find it on disk; made: all there are in this process; fixed: arguments that the compiler knows, whatever is passed.
    """

    made: ClassVar[list["Routine"]] = []

    def __init__(
        self,
        function: Callable[..., Any],
        kinds: str,
        returns: str,
        fastmath: Iterable[str],
        fixed: tuple[tuple[str, int], ...] = (),
    ) -> None:
        self.function, self.kinds, self.returns, self.fastmath = function, kinds, returns, tuple(sorted(fastmath))
        self._fixed, self._others = fixed, dict[tuple[tuple[str, int], ...], Routine]()
        self.__doc__, self.__module__ = function.__doc__, function.__module__
        self.seconds, self.compiled_here = 0.0, False
        self.made.append(self)

    @property
    def name(self) -> str:
        return "_".join([f"{self.__module__}.{self.function.__name__}", *(f"{n}_{v}" for n, v in self._fixed)])

    def fixed(self, **values: int) -> "Routine":
        """Return the routine whose arguments of these names, if it has such, are known to the compiler."""
        code = self.function.__code__
        own = tuple((name, values[name]) for name in code.co_varnames[: code.co_argcount] if name in values)
        if not own:
            return self
        if own not in self._others:
            self._others[own] = Routine(self.function, self.kinds, self.returns, self.fastmath, own)
        return self._others[own]

    @property
    def loaded(self) -> bool:
        """Whether its machine code is in this process already."""
        return "address" in vars(self)

    @cached_property
    def address(self) -> int:
        """Where compiled code, C and Python call it."""
        with _waiting.counted(), _compiling:
            if self.loaded:  # by another thread, while this one waited
                return vars(self)["address"]
            begun = process_time()
            of_this_package = str(self.__module__).startswith(f"{__package__}.")  # what names the folder
            code = cache.found(self.name) if of_this_package else None
            if code is None:
                code, self.compiled_here = machine.object_code(self.module()), True
                if of_this_package:
                    cache.keep(self.name, code)
            place = machine.linked(code)
            self.seconds = process_time() - begun
            vars(self)["address"] = place
            return place

    def module(self) -> Any:
        """Return the instructions that LLVM makes machine code of."""
        return translate(self.function, self.kinds, self.returns, self.fastmath, dict(self._fixed), machine.SYMBOL)

    @cached_property
    def _callable(self) -> Callable[..., Any]:
        return CFUNCTYPE(_PLAIN[self.returns], *(_PLAIN.get(kind, c_void_p) for kind in self.kinds))(self.address)

    def __call__(self, *arguments: Any) -> Any:
        """Call it from Python, with arrays of the right type or addresses for pointers; other threads run meanwhile."""
        both = zip(self.kinds, arguments, strict=True)
        return self._callable(*[_address(kind, each) if isinstance(each, ndarray) else each for kind, each in both])


def _address(kind: str, array: ndarray) -> int:
    """Return where an array begins; compiled code reads whatever is there, so that its type is looked at here."""
    if array.dtype != _TYPES.get(kind) or not array.flags.c_contiguous:
        raise TypeError(
            f"compiled code takes contiguous {_TYPES.get(kind, 'numbers')}, got {array.dtype} {array.strides}"
        )
    return address_of(array)


def routine(
    kinds: str, returns: str = "", case: str = "", fastmath: Iterable[str] = ()
) -> Callable[[Callable[..., Any]], Routine]:
    """Return a decorator that makes a `Routine` of a function.

    case: tells functions of one definition apart, since machine code is found by name; fastmath: liberties with sums
    and products of numbers, by the names that LLVM has for them.
    """

    def made(function: Callable[..., Any]) -> Routine:
        if case:
            function.__name__ += f"_{case}"
            function.__qualname__ += f"_{case}"
        return Routine(function, kinds, returns, fastmath)

    return made


def inlined(function: Callable[..., Any] | Routine) -> Inlined:
    """Return a function as what other compiled code does in place, where it is a small part of it."""
    if isinstance(function, Routine):
        return Inlined(function.function, function.fastmath)
    return Inlined(function)
