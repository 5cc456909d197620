"""Compilation of kernels by a decorator, `routine`.

Each kernel is compiled separately, on first use, and called by its address, so kernels that call it need not be
compiled with it.
"""

import linecache
import math
import os
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from ctypes import CFUNCTYPE, c_double, c_int64, c_void_p
from functools import cached_property
from inspect import get_annotations
from threading import RLock, local
from time import perf_counter, process_time
from typing import Any, ClassVar, TypeVar

from numpy import ndarray

from beamfem.kernels import cache
from beamfem.kernels.compiler import machine
from beamfem.kernels.compiler.bounds_checks import CHECKED, raise_violation
from beamfem.kernels.compiler.callables import Inlined
from beamfem.kernels.compiler.translation import translate
from beamfem.kernels.compiler.value_types import NUMBER, WHOLE, WIDTH, Kind, Signature, signature_of
from beamfem.kernels.pointers import at
from beamfem.kernels.records import Record, checked, kind_of

FAST = frozenset({"contract", "reassoc", "nsz"})  # fast-math flags that keep nan and infinity
_Value = TypeVar("_Value", covariant=True)
_PLAIN: dict[Kind | None, Any] = {None: None, WHOLE: c_int64, NUMBER: c_double}
_compiling = RLock()  # two threads may need a kernel at the same time, but LLVM is not thread-safe
if hasattr(os, "register_at_fork"):  # a child forked while the lock is held would wait for it forever
    os.register_at_fork(
        before=_compiling.acquire, after_in_parent=_compiling.release, after_in_child=_compiling.release
    )


class _lockless_property(cached_property[_Value]):
    """`cached_property` without the lock of Python 3.11: a child forked while it is held would wait for it forever."""

    def __get__(self, instance: object | None, owner: type[Any] | None = None) -> Any:
        if instance is None:
            return self
        return vars(instance).setdefault(str(self.attrname), self.func(instance))


class _Waiting(local):
    """Time that this thread has waited for machine code [s], and whether it is waiting now."""

    seconds, now = 0.0, False

    @contextmanager
    def counted(self) -> Iterator[None]:
        """Add the time of a block, only once if the block needs further kernels."""
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
    """Return the time that this thread has waited for kernels to be compiled or loaded so far [s]."""
    return _waiting.seconds


class Routine:
    """A compiled function of numbers and pointers, compiled or loaded when its address is first needed.

    Machine code is cached on disk; if no folder is writable, or the disk is full, each process compiles it again.
    signature: kinds of arguments and result; seconds: CPU time of compiling or loading it [s]; compiled_here: whether
    this process compiled it instead of loading it; made: all routines of this process; fixed: values of arguments known
    at compile time, which replace those passed.
    """

    made: ClassVar[list["Routine"]] = []
    _fixed: tuple[tuple[str, int], ...] = ()

    def __init__(
        self,
        function: Callable[..., Any],
        signature: Signature,
        fastmath: Iterable[str],
        fixed: tuple[tuple[str, int], ...] = (),
    ) -> None:
        self.function, self._fixed, self._others = function, fixed, dict[tuple[tuple[str, int], ...], Routine]()
        self.__doc__, self.__module__ = function.__doc__, function.__module__
        name = "_".join([f"{self.__module__}.{function.__name__}", *(f"{n}_{v}" for n, v in fixed)])
        # the folder's hash covers these only
        self._prepare(name, signature, fastmath, str(self.__module__).startswith(f"{__package__}."))

    def _prepare(self, name: str, signature: Signature, fastmath: Iterable[str], on_disk: bool) -> None:
        self.name, self.signature, self.fastmath, self._on_disk = name, signature, tuple(sorted(fastmath)), on_disk
        self.seconds, self.compiled_here = 0.0, False
        self.made.append(self)

    def fixed(self, **values: int) -> "Routine":
        """Return a routine with some arguments fixed at compile time; names that are not arguments are ignored."""
        code = self.function.__code__
        constants = tuple((name, values[name]) for name in code.co_varnames[: code.co_argcount] if name in values)
        if not constants:
            return self
        if constants not in self._others:
            self._others[constants] = Routine(self.function, self.signature, self.fastmath, constants)
        return self._others[constants]

    @property
    def loaded(self) -> bool:
        """Whether its machine code is loaded in this process."""
        return "address" in vars(self)

    @_lockless_property
    def address(self) -> int:
        """Address at which compiled code, C or Python can call it; compiles or loads it on first use."""
        with _waiting.counted(), _compiling:
            if self.loaded:  # another thread has loaded it meanwhile
                return vars(self)["address"]
            begun = process_time()
            code = cache.found(self.name) if self._on_disk else None
            if code is None:
                code, self.compiled_here = machine.object_code(self.module()), True
                if self._on_disk:
                    cache.keep(self.name, code)
            address = machine.linked(code)
            self.seconds = process_time() - begun
            vars(self)["address"] = address
            return address

    def module(self) -> Any:
        """Return the routine as an LLVM module, before optimisation."""
        return translate(self.function, self.signature, self.fastmath, dict(self._fixed), machine.SYMBOL)

    @_lockless_property
    def compiled(self) -> Callable[..., Any]:
        """The compiled function, called without the GIL with numbers and addresses that nobody checks."""
        kinds = [_PLAIN.get(kind, c_void_p) for kind in self.signature.arguments]
        function = CFUNCTYPE(_PLAIN[self.signature.result], *kinds)(self.address)
        if CHECKED:
            function.errcheck = raise_violation
        return function

    def __call__(self, *arguments: Any) -> Any:
        """Call it from Python, without the GIL; pointers are given as arrays or records, or as addresses."""
        return self.compiled(*map(_plain, self.signature.arguments, arguments))


class Derived(Routine):
    """A routine whose definition, as source, is derived when it must be compiled or is called in Python.

    on_disk: whether machine code with its name is kept, as of what the hash of the folder covers.
    """

    def __init__(
        self,
        name: str,
        signature: Signature,
        source: Callable[[], str],
        fastmath: Iterable[str] = (),
        on_disk: bool = True,
    ) -> None:
        self._source = source
        self._prepare(name, signature, fastmath, on_disk)

    @_lockless_property
    def function(self) -> Callable[..., Any]:
        """The definition, the only function of its source."""
        text, file = self._source(), f"<{self.name}>"
        names: dict[str, Any] = {"__name__": self.name, "math": math, "at": at, "WIDTH": WIDTH}
        linecache.cache[file] = (len(text), None, text.splitlines(keepends=True), file)
        exec(compile(text, file, "exec"), names)
        return next(reversed(names.values()))

    def fixed(self, **values: int) -> Routine:
        """Return this routine, whose arguments are never fixed."""
        return self


def _plain(kind: Kind, argument: Any) -> Any:
    """Return a number, or the address of an array or a record."""
    if isinstance(argument, Record):
        if argument.kind is not kind:
            raise TypeError(f"compiled code takes a {kind.name}, got a {argument.kind.name}")
        return argument.address
    return checked(kind, argument) if isinstance(argument, ndarray) else argument


def _declared(function: Callable[..., Any]) -> Signature:
    """Return the signature that the annotations of a function declare."""
    annotations = get_annotations(function)
    result = annotations.pop("return")
    return Signature(
        [kind_of(each)[0] for each in annotations.values()], None if result is None else kind_of(result)[0]
    )


def routine(
    kinds: str | None = None, returns: str = "", case: str = "", fastmath: Iterable[str] = ()
) -> Callable[[Callable[..., Any]], Routine]:
    """Return a decorator that turns a function into a `Routine`.

    kinds, returns: letters of `compiler.value_types.KINDS` for arguments and result, if they are not annotated; case:
    distinguishes functions made from one definition, since machine code is found by name; fastmath: LLVM's names of the
    fast-math flags for its arithmetic.
    """

    def made(function: Callable[..., Any]) -> Routine:
        if case:
            function.__name__ += f"_{case}"
            function.__qualname__ += f"_{case}"
        signature = _declared(function) if kinds is None else signature_of(kinds, returns)
        return Routine(function, signature, fastmath)

    return made


def inlined(function: Callable[..., Any] | Routine) -> Inlined:
    """Return a function that compiled code inlines where it is called; also usable as a decorator."""
    if isinstance(function, Routine):
        return Inlined(function.function, function.fastmath)
    return Inlined(function)
