"""Kinds of values in compiled code."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

from llvmlite import ir

WIDTH = 8  # lanes: a cache line of doubles, which fills one or two vector registers of current processors
_DOUBLE, _INTEGER = ir.DoubleType(), ir.IntType(64)


@dataclass(frozen=True, eq=False)
class Kind:
    """A kind of values.

    name: used in error messages; llvm: type in LLVM; rank: in an operation with a value of higher rank, values are
    converted to that kind, -1 for pointers; entry: kind of the entries of a pointer, whose type in memory is `stored`,
    or None if the entries are records side by side; fields: place, in slots of 8 bytes, and kind by name, of a pointer
    to a record; signature: of the address of a function, asked for when it is called.
    """

    name: str
    llvm: ir.Type
    rank: int = -1
    entry: "Kind | None" = None
    stored: ir.Type | None = None
    fields: "dict[str, tuple[int, Kind]] | None" = None
    signature: "Callable[[], Signature] | None" = None

    @property
    def points(self) -> bool:
        """Whether values are pointers."""
        return isinstance(self.llvm, ir.PointerType)


class Signature(NamedTuple):
    """Kinds of the arguments of a function and of its result, if it has one."""

    arguments: Sequence[Kind]
    result: Kind | None


class Extent(NamedTuple):
    """Start and end of the array of a pointer, as integers, and its name; known only with checks."""

    start: ir.Value
    end: ir.Value
    name: str = ""


class Value(NamedTuple):
    """An LLVM value and its kind, and the extent of a pointer (see `checks`)."""

    kind: Kind
    llvm: ir.Value
    extent: Extent | None = None


FLAG = Kind("flag", ir.IntType(1), 0)
WHOLE = Kind("whole number", _INTEGER, 1)
NUMBER = Kind("number", _DOUBLE, 2)
LANES = Kind("lanes", ir.VectorType(_DOUBLE, WIDTH), 3)
PAIR = Kind("pair", ir.VectorType(_DOUBLE, 2), 3)
REALS = Kind("pointer to numbers", _DOUBLE.as_pointer(), entry=NUMBER, stored=_DOUBLE)
ROWS = Kind("pointer to lanes", _DOUBLE.as_pointer(), entry=LANES, stored=LANES.llvm)
PAIRS = Kind("pointer to pairs", _DOUBLE.as_pointer(), entry=PAIR, stored=PAIR.llvm)
WHOLES = Kind("pointer to whole numbers", _INTEGER.as_pointer(), entry=WHOLE, stored=_INTEGER)
SLOTS = Kind("pointer to 32-bit whole numbers", ir.IntType(32).as_pointer(), entry=WHOLE, stored=ir.IntType(32))

NOTHING = Kind("None", _INTEGER.as_pointer())


@cache
def addresses_of(entry: Kind) -> Kind:
    """Return the kind of pointers to a table of addresses."""
    return Kind(f"table of addresses of {entry.name}", _INTEGER.as_pointer(), entry=entry, stored=_INTEGER)


@cache
def side_by_side(entry: Kind) -> Kind:
    """Return the kind of pointers to records side by side."""
    return Kind(f"pointer to several {entry.name}", _INTEGER.as_pointer(), entry=entry)


# Kinds of arguments by letter.
KINDS = {"r": REALS, "v": ROWS, "n": WHOLES, "s": SLOTS, "i": WHOLE, "d": NUMBER}


def signature_of(arguments: str, result: str = "") -> Signature:
    """Return a signature from letters."""
    return Signature([KINDS[kind] for kind in arguments], KINDS[result] if result else None)
