"""Records: data that compiled code and Python share by the names of their fields.

A field is a number, an array, a function or another record, each in a slot of 8 bytes. Arrays, functions and records
are held by their addresses. Compiled code reads and sets `record.field` as Python does.
"""

from collections.abc import Mapping, Sequence
from ctypes import addressof, c_char
from inspect import get_annotations
from math import prod
from pkgutil import resolve_name
from typing import Annotated, Any, ClassVar, Self, TypeVar, get_args, get_origin

import numpy as np

from beamfem.kernels.compiler.bounds_checks import CHECKED, register
from beamfem.kernels.compiler.value_types import (
    NUMBER,
    REALS,
    ROWS,
    SLOTS,
    WHOLE,
    WHOLES,
    WIDTH,
    Kind,
    Signature,
    addresses_of,
    side_by_side,
)

_Item = TypeVar("_Item", bound="Record")
Reals = Annotated[np.ndarray, REALS]
Rows = Annotated[np.ndarray, ROWS]  # numbers that compiled code takes several at a time
Wholes = Annotated[np.ndarray, WHOLES]
Slots = Annotated[np.ndarray, SLOTS]  # integers of 32 bits
Table = Annotated[Sequence[_Item], addresses_of]  # records anywhere, by their addresses
Several = Annotated[np.ndarray, side_by_side]  # records side by side: Annotated[Several, Kind of record]

_memory_of: Any = (c_char * 0).from_buffer  # an array may be empty


def address_of(values: np.ndarray) -> int:
    """Return the address of the first number of an array."""
    if CHECKED:
        register(values)
    try:
        return addressof(_memory_of(values))
    except TypeError:  # an array that is only read or not contiguous, which takes longer
        return int(values.__array_interface__["data"][0])


def _type(kind: Kind) -> np.dtype[Any]:
    """Return the type of the numbers of an array."""
    return np.dtype(np.float64 if kind in (REALS, ROWS) else np.int32 if kind is SLOTS else np.int64)


def checked(kind: Kind, array: np.ndarray) -> int:
    """Return the address of an array after a check of its type and layout, which compiled code does not make."""
    wanted = _type(kind)
    if array.dtype != wanted or not array.flags.c_contiguous:
        raise TypeError(f"compiled code takes contiguous {wanted}, got {array.dtype} {array.strides}")
    return address_of(array)


def kind_of(annotation: Any) -> tuple[Kind, tuple[str | int, ...]]:
    """Return the kind of values that an annotation stands for, and the shape of an array, where it is declared."""
    if annotation is int:
        return WHOLE, ()
    if annotation is float:
        return NUMBER, ()
    if isinstance(annotation, type) and issubclass(annotation, Record):
        return annotation.kind, ()
    if get_origin(annotation) is Annotated:
        base, kind, *others = get_args(annotation)
        if kind is addresses_of:
            return addresses_of(get_args(base)[0].kind), ()
        if kind is side_by_side:
            return side_by_side(others[0].kind), ()
        return kind, tuple(others)
    raise TypeError(f"compiled code knows no {annotation!r}")


class _Number:
    """An integer in a slot of a record."""

    def __init__(self, name: str, place: int, kind: Kind) -> None:
        self.name, self.place, self.kind = name, place, kind

    def __get__(self, record: Any, owner: type) -> Any:
        return self if record is None else record._wholes[self.place]

    def __set__(self, record: Any, value: Any) -> None:
        record._wholes[self.place] = int(value)


class _Real(_Number):
    """A floating-point number."""

    def __get__(self, record: Any, owner: type) -> Any:
        return self if record is None else record._reals[self.place]

    def __set__(self, record: Any, value: Any) -> None:
        record._reals[self.place] = value


class _Address(_Number):
    """The address of an array, a function or a record, which the record keeps alive; declared: shape of the array."""

    def __init__(self, name: str, place: int, kind: Kind, declared: Sequence[str | int] = (), own: Any = None) -> None:
        super().__init__(name, place, kind)
        self.declared, self._own, self._dtype = declared, own, _type(kind)

    def __get__(self, record: Any, owner: type) -> Any:
        if record is None:
            return self
        address = record._wholes[self.place]
        if self.name in record.kept or not address:
            return record.kept.get(self.name)
        return self._own.at(address) if self._own else memory_at(address, self.kind, *self.shape(record))

    def __set__(self, record: Any, value: Any) -> None:
        if isinstance(value, np.ndarray):
            if self._sizes and value.shape != self.shape(record):
                raise ValueError(f"{self.name} has the shape {self.shape(record)}, got {value.shape}")
            if value.dtype != self._dtype or not value.flags.c_contiguous:
                raise TypeError(f"{self.name} takes contiguous {self._dtype}, got {value.dtype} {value.strides}")
            record._wholes[self.place] = address_of(value)
        else:
            record._wholes[self.place] = self._address(record, value)
        record.kept[self.name] = value

    def _address(self, record: Any, value: Any) -> int:
        if isinstance(value, list | tuple):
            addresses = np.array([each.address for each in value], dtype=np.int64)
            record.kept[self.name, "addresses"] = addresses
            return address_of(addresses)
        return 0 if value is None else value if isinstance(value, int) else int(value.address)

    def link(self, fields: "Mapping[str, _Number]") -> None:
        """Look up the fields that are sizes of the array."""
        self._sizes = [fields[each].place if isinstance(each, str) else -each for each in self.declared]

    def shape(self, record: Any) -> tuple[int, ...]:
        """Return the shape that is declared for the array of a record."""
        wholes = record._wholes
        return tuple([wholes[size] if size >= 0 else -size for size in self._sizes])  # a fixed size is negative


class _Function:
    """The routine or signature of a function whose address is in a field."""

    def __init__(self, like: Any, tasks: tuple[str, ...]) -> None:
        self._like, self.tasks = like, tasks

    @property
    def routine(self) -> Any:
        """The routine itself, which need not be imported before."""
        return resolve_name(f"{__package__}.{self._like}") if isinstance(self._like, str) else self._like

    def signature(self) -> Signature:
        """Return the kinds of arguments and result."""
        signature: Signature = self._like if isinstance(self._like, Signature) else self.routine.signature
        return signature


def calls(like: Any, *tasks: str) -> Any:
    """Return a field for the address of a function like a given routine, which may be named: "field:interpolate".

    like: may also be a signature; tasks: what the function is needed for, if not always.
    """
    return _Function(like, tasks)


class Record:
    """Data that compiled code and Python share; a subclass declares fields by annotations, and functions by `calls`.

    An array is checked for its type, layout and declared shape when it is set, and the record keeps it alive.
    address: of the slots; kept: what the fields of addresses were set to; fields: by name, in the order of the slots.
    """

    fields: ClassVar[dict[str, _Number]] = {}
    called: ClassVar[dict[str, _Function]]
    kind: ClassVar[Kind]
    _defaults: ClassVar[dict[str, Any]] = {}

    def __init_subclass__(cls) -> None:
        fields, cls._defaults = dict(cls.fields), dict(cls._defaults)
        for name, annotation in get_annotations(cls).items():
            kind, shape = kind_of(annotation)
            own = annotation if kind.fields is not None else None
            if kind.points:
                fields[name] = _Address(name, len(fields), kind, shape, own)
            else:
                fields[name] = (_Real if kind is NUMBER else _Number)(name, len(fields), kind)
            if name in vars(cls):
                cls._defaults[name] = vars(cls)[name]
        for name, given in vars(cls).items():
            if isinstance(given, _Function):
                fields[name] = _Address(name, len(fields), Kind("function", WHOLE.llvm, signature=given.signature))
        if taken := [name for name in fields if hasattr(Record, name)]:
            raise TypeError(f"a record has its own {', '.join(taken)}")
        cls.called = {name: each for name, each in vars(cls).items() if isinstance(each, _Function)}
        for name, field in fields.items():
            setattr(cls, name, field)
            if isinstance(field, _Address):
                field.link(fields)
        cls.fields = fields
        cls.kind = Kind(
            cls.__name__, WHOLES.llvm, fields={name: (each.place, each.kind) for name, each in fields.items()}
        )

    def __init__(self, **values: Any) -> None:
        self._hold(np.zeros(len(self.fields), dtype=np.int64))
        self.fill(**self._defaults | values)

    @classmethod
    def usual(cls, **others: Any) -> Self:
        """Return the record of the routines that give the signatures of its functions, but for some others."""
        return cls(**{name: each.routine for name, each in cls.called.items()} | others)

    def _hold(self, memory: np.ndarray) -> None:
        self.memory, self.address, self.kept = memory, address_of(memory), dict[Any, Any]()
        self._wholes, self._reals = memory.data, memory.view(np.float64).data

    @classmethod
    def at(cls, address: int) -> Self:
        """Return the record at an address, which must stay alive; its arrays have the shapes that are declared."""
        result = cls.__new__(cls)
        result._hold(memory_at(address, WHOLES, len(cls.fields)))
        return result

    def copy(self) -> Self:
        """Return a copy that refers to the same arrays."""
        result = type(self).__new__(type(self))
        result._hold(self.memory.copy())
        result.kept.update(self.kept)
        return result

    def fill(self, **values: Any) -> None:
        """Set fields by name, numbers first because they may be sizes of arrays."""
        fields, addresses = self.fields, list[tuple[_Number, Any]]()
        for name, value in values.items():
            if name not in fields:
                raise TypeError(f"{type(self).__name__} has no {name}")
            if isinstance(fields[name], _Address):
                addresses.append((fields[name], value))
            else:
                fields[name].__set__(self, value)
        for field, value in addresses:
            field.__set__(self, value)

    def forget(self, *names: str) -> None:
        """Let go of what some fields refer to."""
        for name in names:
            self._wholes[self.fields[name].place] = 0
            self.kept.pop(name, None)

    def shapes(self, *names: str) -> dict[str, tuple[int, ...]]:
        """Return the shapes that are declared for arrays."""
        return {name: field.shape(self) for name in names if isinstance(field := self.fields[name], _Address)}


def aligned(shapes: Mapping[Any, Sequence[int]]) -> dict[Any, np.ndarray]:
    """Return new arrays of zeros by name, in one block of memory.

    Each begins at a cache line, so that vectors of lanes do not straddle two lines.
    """
    sizes = [prod(shape) for shape in shapes.values()]
    memory: np.ndarray = np.zeros(sum(sizes) + WIDTH * (len(sizes) + 1))
    arrays, first, start = dict[Any, np.ndarray](), 0, address_of(memory) // memory.itemsize
    for (name, shape), size in zip(shapes.items(), sizes, strict=True):
        first += -(start + first) % WIDTH
        arrays[name] = memory[first : first + size].reshape(shape)
        first += size
    return arrays


def memory_at(address: int, kind: Kind, *shape: int) -> np.ndarray:
    """Return the array of a kind at an address, which must stay alive."""
    dtype = _type(kind)
    memory: Any = (c_char * (prod(shape) * dtype.itemsize)).from_address(address)
    return np.frombuffer(memory, dtype=dtype).reshape(shape)
