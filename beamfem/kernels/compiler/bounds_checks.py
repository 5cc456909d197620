"""Checks compiled into kernels if the environment variable `BEAMFEM_CHECK` is 1 when the package is imported.

Each access to an array must be inside it and aligned, an integer is not divided by zero, and `int` takes a number that
fits into 64 bits. The first violation ends the call, and all compiled calls around it, with a `CheckError`. Pointers
have no size of their own. That of an array is registered when its address is taken (`pointers.address_of`) and looked
up when a kernel makes a pointer of an address; pointers derived from it, and passed to other kernels, keep it.

Not covered: parts of one array, such as of the scratch memory of a batch, are not told apart; arrays whose address is
taken in another way, of C code or by ctypes, have no known size; code that is called but not compiled here, such as a
section law in C, is not checked.
"""

import os
from bisect import bisect_right, insort
from ctypes import CFUNCTYPE, POINTER, c_char_p, c_int64, c_void_p, cast
from threading import Lock, local
from typing import Any
from weakref import ref

import numpy as np

CHECKED = os.environ.get("BEAMFEM_CHECK") == "1"
UNLIMITED = (0, 2**63 - 1)
_NULL = 4096  # no memory is below [bytes]


class CheckError(IndexError):
    """Compiled code has left an array, or done what has no result; raised only with BEAMFEM_CHECK=1."""


class _Thread(local):
    """The violation that ends the calls of this thread, and the extents of pointers passed from kernel to kernel."""

    def __init__(self) -> None:
        self.violation, self.passed = "", dict[int, tuple[int, int]]()


_thread, _lock = _Thread(), Lock()
_starts: list[int] = []  # addresses of the arrays, sorted
_arrays: dict[int, tuple[Any, int]] = {}  # reference to the array, and where it ends, by address


def register(values: np.ndarray) -> None:
    """Register the extent of the array that owns the memory of `values`."""
    while isinstance(values.base, np.ndarray):
        values = values.base
    start = int(values.__array_interface__["data"][0])
    with _lock:
        if start not in _arrays:
            insort(_starts, start)
        _arrays[start] = ref(values), start + values.nbytes


def _extent(address: int) -> tuple[int, int]:
    """Return the extent of the registered array that contains an address."""
    if address < _NULL:
        return address, address
    with _lock:
        while place := bisect_right(_starts, address):
            start = _starts[place - 1]
            array, end = _arrays[start]
            if array() is not None:
                return (start, end) if address < end or address == start else UNLIMITED
            del _starts[place - 1], _arrays[start]  # it no longer exists
    return UNLIMITED


def _find(address: int, extent: Any) -> None:
    extent[0], extent[1] = _thread.passed.get(address) or _extent(address)


def _pass_on(address: int, start: int, end: int) -> None:
    _thread.passed[address] = start, end


def _is_ended() -> int:
    _thread.passed.clear()
    return bool(_thread.violation)


def _violate(text: bytes, address: int, index: int, start: int, end: int, item: int) -> None:
    message = text.decode()
    if item and address % item:
        message += f", address {address:#x} is not a multiple of {item} bytes"
    elif item:
        first, size = (start - address) // item, (end - start) // item
        message += f", index {index}, of an array of size {size}" + f", first index {first}" * (first != 0)
    _thread.violation = _thread.violation or message


def raise_violation(result: Any, *_: Any) -> Any:
    """Return the result of a compiled function; raise CheckError if a check has ended it."""
    if _thread.violation:
        message, _thread.violation = _thread.violation, ""
        raise CheckError(message)
    return result


_FUNCTIONS = {
    "beamfem_find": CFUNCTYPE(None, c_int64, POINTER(c_int64))(_find),
    "beamfem_pass_on": CFUNCTYPE(None, c_int64, c_int64, c_int64)(_pass_on),
    "beamfem_is_ended": CFUNCTYPE(c_int64)(_is_ended),
    "beamfem_violate": CFUNCTYPE(None, c_char_p, *[c_int64] * 5)(_violate),
}
SYMBOLS = {name: int(cast(function, c_void_p).value or 0) for name, function in _FUNCTIONS.items()}
