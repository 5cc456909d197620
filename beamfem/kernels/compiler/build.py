"""Emission of LLVM instructions: memory access, calls, and conversions between kinds of values."""

from collections.abc import Sequence
from dataclasses import dataclass

from llvmlite import ir

from beamfem.kernels.compiler.bounds_checks import CHECKED
from beamfem.kernels.compiler.value_types import (
    FLAG,
    LANES,
    NOTHING,
    NUMBER,
    PAIR,
    PAIRS,
    REALS,
    ROWS,
    SLOTS,
    WHOLE,
    WIDTH,
    Extent,
    Kind,
    Signature,
    Value,
)

_TO_NUMBERS = (REALS, ROWS, PAIRS)


@dataclass
class Build:
    """The position at which instructions are emitted.

    flags: fast-math flags of floating-point instructions; where: the function and line that they belong to.
    """

    builder: ir.IRBuilder
    flags: tuple[str, ...] = ()
    where: str = ""

    def space(self, llvm: ir.Type) -> ir.Value:
        """Allocate a value on the stack of the function, and return its address."""
        with self.builder.goto_entry_block():
            return self.builder.alloca(llvm)

    def variable(self, value: Value, name: str = "") -> Value:
        """Allocate a variable for values like this one; it has their kind, its address and that of their extent."""
        extent = Extent(self.space(WHOLE.llvm), self.space(WHOLE.llvm), name) if _has_extent(value) else None
        return Value(value.kind, self.space(value.kind.llvm), extent)

    def get(self, variable: Value) -> Value:
        """Return the value of a variable."""
        value = Value(variable.kind, self.builder.load(variable.llvm))
        if variable.extent is None:
            return value
        start, end = (self.builder.load(address) for address in variable.extent[:2])
        return value._replace(extent=Extent(start, end, variable.extent.name))

    def set(self, variable: Value, value: Value) -> None:
        """Set a variable; raise TypeError if it has another kind and a conversion would lose information."""
        self.builder.store(self.converted(value, variable.kind), variable.llvm)
        if variable.extent is not None:
            for address, limit in zip(variable.extent[:2], self.extent(value)[:2], strict=True):
                self.builder.store(limit, address)

    def call(self, name: str, value: Value, *others: Value) -> Value:
        """Call a function of LLVM or of the C library whose arguments and result are of one kind."""
        types = [each.kind.llvm for each in (value, *others)]
        callee = self.declared(name, ir.FunctionType(types[0], types))
        arguments = [each.llvm for each in (value, *others)]
        return Value(value.kind, self.builder.call(callee, arguments, fastmath=self.flags))

    def call_at(self, address: ir.Value, signature: Signature, arguments: Sequence[Value]) -> Value | None:
        """Call a function in C convention by its address, an integer."""
        for each in arguments:
            self.pass_on(each)
        kinds, result = signature
        values = [self.converted(value, kind) for value, kind in zip(arguments, kinds, strict=True)]
        outer = ir.VoidType() if result is None else result.llvm
        function = ir.FunctionType(outer, [kind.llvm for kind in kinds]).as_pointer()
        returned = self.builder.call(self.builder.inttoptr(address, function), values)
        self.end_if_ended()
        return None if result is None else Value(result, returned)

    def declared(self, name: str, kind: ir.FunctionType) -> ir.Function:
        """Return a function of LLVM or of the C library."""
        module = self.builder.module
        return module.globals.get(name) or ir.Function(module, kind, name)

    def _checking(self, name: str, *arguments: ir.Value, returns: ir.Type | None = None) -> ir.Value:
        """Call a function of `checks`."""
        kind = ir.FunctionType(returns or ir.VoidType(), [each.type for each in arguments])
        return self.builder.call(self.declared(f"beamfem_{name}", kind), arguments)

    def _address(self, pointer: Value) -> ir.Value:
        return self.builder.ptrtoint(pointer.llvm, WHOLE.llvm)

    def extent(self, pointer: Value) -> Extent:
        """Return the extent of a pointer, looked up by its address if it is not known."""
        if pointer.extent is not None:
            return pointer.extent
        both = self.space(ir.ArrayType(WHOLE.llvm, 2))
        first = self.builder.bitcast(both, WHOLE.llvm.as_pointer())
        self._checking("find", self._address(pointer), first)
        return Extent(self.builder.load(first), self.builder.load(self.builder.gep(first, [WHOLE.llvm(1)])))

    def whole_array(self, pointer: Value, count: int) -> Value:
        """Return a pointer to the first of `count` numbers, with its extent."""
        if not CHECKED:
            return pointer
        start = self._address(pointer)
        return pointer._replace(extent=Extent(start, self.builder.add(start, WHOLE.llvm(8 * count))))

    def pass_on(self, pointer: Value) -> None:
        """Tell the extent of a pointer to the kernel that is called with it."""
        if _has_extent(pointer):
            start, end, _ = self.extent(pointer)
            self._checking("pass_on", self._address(pointer), start, end)

    def end_if_ended(self) -> None:
        """End the function if a check has ended one that it has called."""
        if CHECKED:
            ended = self._checking("is_ended", returns=WHOLE.llvm)
            with self.builder.if_then(self.builder.icmp_signed("!=", ended, WHOLE.llvm(0)), likely=False):
                self._end()

    def _end(self) -> None:
        result = self.builder.function.function_type.return_type
        if isinstance(result, ir.VoidType):
            self.builder.ret_void()
        else:
            self.builder.ret(ir.Constant(result, 0))

    def require(self, holds: ir.Value, text: str, *numbers: ir.Value) -> None:
        """End the function if a condition does not hold; numbers: see `checks`, none if the text says all."""
        content = bytearray(f"{self.where}: {text}".encode() + b"\0")
        module = self.builder.module
        with self.builder.if_then(self.builder.not_(holds), likely=False):
            kept = ir.GlobalVariable(module, ir.ArrayType(ir.IntType(8), len(content)), module.get_unique_name("text"))
            kept.global_constant, kept.linkage = True, "private"
            kept.initializer = ir.Constant(kept.value_type, content)
            address = self.builder.bitcast(kept, ir.IntType(8).as_pointer())
            self._checking("violate", address, *(numbers or [WHOLE.llvm(0)] * 5))
            self._end()

    def check(self, pointer: Value, index: ir.Value, count: ir.Value) -> None:
        """With checks, end the function if `count` entries from an index on are not in the array of a pointer."""
        if not CHECKED:
            return
        builder, (start, end, name) = self.builder, self.extent(pointer)
        address, item = self._address(pointer), WHOLE.llvm(4 if pointer.kind is SLOTS else 8)
        # counted in entries, because the offset of a wild index in bytes may overflow
        first, behind = (builder.sdiv(builder.sub(limit, address), item) for limit in (start, end))
        holds = builder.icmp_signed(">=", index, first)
        holds = builder.and_(holds, builder.icmp_signed("<=", index, builder.sub(behind, count)))
        aligned = builder.icmp_signed("==", builder.srem(address, item), WHOLE.llvm(0))
        self.require(builder.and_(holds, aligned), name or "array", address, index, start, end, item)

    def same(self, number: ir.Value, lanes: int = WIDTH) -> ir.Value:
        """Return a vector whose lanes all hold one number or integer."""
        undefined = ir.Constant(ir.VectorType(number.type, lanes), ir.Undefined)
        first = ir.Constant(ir.VectorType(ir.IntType(32), lanes), None)
        inserted = self.builder.insert_element(undefined, number, ir.IntType(32)(0))
        return self.builder.shuffle_vector(inserted, undefined, first)

    def converted(self, value: Value, kind: Kind) -> ir.Value:
        """Convert a value to another kind; raise TypeError if that would lose information."""
        if value.kind is kind or (value.kind in _TO_NUMBERS and kind in _TO_NUMBERS):
            return value.llvm
        if value.kind.fields and kind.fields and kind.fields.items() <= value.kind.fields.items():
            return value.llvm  # it has all fields of that record, at the same places
        if value.kind is NOTHING and kind.points:
            return ir.Constant(kind.llvm, None)
        if value.kind is FLAG and kind is WHOLE:
            return self.builder.zext(value.llvm, WHOLE.llvm)
        if value.kind in (FLAG, WHOLE) and kind in (NUMBER, LANES):
            number = self.builder.sitofp(self.converted(value, WHOLE), NUMBER.llvm)
            return number if kind is NUMBER else self.same(number)
        if value.kind is NUMBER and kind in (LANES, PAIR):
            return self.same(value.llvm, kind.llvm.count)
        raise TypeError(f"a {value.kind.name} is no {kind.name}")

    def truth(self, value: Value) -> ir.Value:
        """Return whether a value is not zero."""
        if value.kind is FLAG:
            return value.llvm
        if value.kind is WHOLE:
            return self.builder.icmp_signed("!=", value.llvm, WHOLE.llvm(0))
        raise TypeError(f"a {value.kind.name} is neither true nor false")

    def _whole(self, index: Value) -> ir.Value:
        if index.kind is not WHOLE:
            raise TypeError(f"a {index.kind.name} is no place in memory")
        return index.llvm

    def _field(self, record: Value, name: str) -> tuple[Kind, ir.Value]:
        """Return the kind of a field of a record and the address of its slot."""
        fields = record.kind.fields
        if fields is None or name not in fields:
            raise TypeError(f"a {record.kind.name} has no {name}")
        place, kind = fields[name]
        self.check(record, WHOLE.llvm(place), WHOLE.llvm(1))
        return kind, self.builder.gep(record.llvm, [WHOLE.llvm(place)], inbounds=True)

    def _in_slot(self, kind: Kind, slot: ir.Value) -> Value:
        if kind is NUMBER:
            return Value(kind, self.builder.load(self.builder.bitcast(slot, kind.llvm.as_pointer())))
        content = self.builder.load(slot)
        if not kind.points:
            return Value(kind, content)
        pointer = Value(kind, self.builder.inttoptr(content, kind.llvm))
        return pointer._replace(extent=self.extent(pointer)) if CHECKED else pointer

    def get_field(self, record: Value, name: str) -> Value:
        """Return a field of a record."""
        return self._in_slot(*self._field(record, name))

    def set_field(self, record: Value, name: str, value: Value) -> None:
        """Set a field of a record."""
        kind, slot = self._field(record, name)
        content = self.converted(value, kind)
        if kind is NUMBER:
            slot = self.builder.bitcast(slot, kind.llvm.as_pointer())
        self.builder.store(self.builder.ptrtoint(content, WHOLE.llvm) if kind.points else content, slot)

    def place(self, pointer: Value, index: Value) -> ir.Value:
        """Return the address of an entry of a pointer."""
        self._whole(index)
        self.check(pointer, index.llvm, WHOLE.llvm(getattr(_entry(pointer).llvm, "count", 1)))
        address = self.builder.gep(pointer.llvm, [index.llvm], inbounds=True)
        several = pointer.kind.entry if pointer.kind.entry in (LANES, PAIR) else None
        return address if several is None else self.builder.bitcast(address, several.llvm.as_pointer())

    def read(self, pointer: Value, index: Value) -> Value:
        """Return an entry of a pointer."""
        kind = _entry(pointer)
        if pointer.kind.stored is None:
            first = self.builder.mul(self._whole(index), WHOLE.llvm(len(kind.fields or ())), flags=("nsw",))
            return pointer._replace(kind=kind, llvm=self.builder.gep(pointer.llvm, [first], inbounds=True))
        if kind.points:
            return self._in_slot(kind, self.place(pointer, index))
        align = 8 if kind in (LANES, PAIR) else None
        entry = self.builder.load(self.place(pointer, index), align=align)
        return Value(kind, self.builder.sext(entry, WHOLE.llvm) if pointer.kind.stored != kind.llvm else entry)

    def write(self, pointer: Value, index: Value, value: Value) -> None:
        """Set an entry of a pointer."""
        kind = _entry(pointer)
        if pointer.kind.stored != kind.llvm:  # slots of fewer bits, records and addresses of records
            raise TypeError(f"a {pointer.kind.name} is only read")
        align = 8 if kind in (LANES, PAIR) else None
        self.builder.store(self.converted(value, kind), self.place(pointer, index), align=align)


def _has_extent(value: Value) -> bool:
    return CHECKED and value.kind.points


def _entry(pointer: Value) -> Kind:
    if pointer.kind.entry is None:
        raise TypeError(f"a {pointer.kind.name} has no entries")
    return pointer.kind.entry
