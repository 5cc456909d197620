"""Kinds of values in compiled code."""

from dataclasses import dataclass
from typing import NamedTuple

from llvmlite import ir

WIDTH = 8  # lanes: a cache line of doubles, one or two registers of today's processors
_DOUBLE, _INTEGER = ir.DoubleType(), ir.IntType(64)


@dataclass(frozen=True, eq=False)
class Kind:
    """A kind of values.

    llvm: their type in LLVM; rank: a number becomes one of a kind of higher rank where two meet, -1 for pointers;
    entry: what an entry of a pointer is, which lies in memory as `stored`.
    """

    name: str
    llvm: ir.Type
    rank: int = -1
    entry: "Kind | None" = None
    stored: ir.Type | None = None


class Value(NamedTuple):
    """A value that compiled code works on."""

    kind: Kind
    llvm: ir.Value


FLAG = Kind("flag", ir.IntType(1), 0)
WHOLE = Kind("whole number", _INTEGER, 1)
NUMBER = Kind("number", _DOUBLE, 2)
LANES = Kind("lanes", ir.VectorType(_DOUBLE, WIDTH), 3)
REALS = Kind("pointer to numbers", _DOUBLE.as_pointer(), entry=NUMBER, stored=_DOUBLE)
ROWS = Kind("pointer to lanes", _DOUBLE.as_pointer(), entry=LANES, stored=LANES.llvm)
WHOLES = Kind("pointer to whole numbers", _INTEGER.as_pointer(), entry=WHOLE, stored=_INTEGER)
SLOTS = Kind("pointer to 32-bit whole numbers", ir.IntType(32).as_pointer(), entry=WHOLE, stored=ir.IntType(32))

# One letter an argument.
KINDS = {"r": REALS, "v": ROWS, "n": WHOLES, "s": SLOTS, "i": WHOLE, "d": NUMBER}
