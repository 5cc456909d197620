"""Emission of LLVM instructions: memory access, calls, and conversions between kinds of values."""

from dataclasses import dataclass

from llvmlite import ir

from beamfem.kernels.compiler.kinds import FLAG, LANES, NUMBER, PAIR, PAIRS, REALS, ROWS, WHOLE, WIDTH, Kind, Value

_TO_NUMBERS = (REALS, ROWS, PAIRS)


@dataclass
class Build:
    """The position at which instructions are emitted; flags: fast-math flags of floating-point instructions."""

    builder: ir.IRBuilder
    flags: tuple[str, ...] = ()

    def space(self, llvm: ir.Type) -> ir.Value:
        """Allocate a value on the stack of the function, and return its address."""
        with self.builder.goto_entry_block():
            return self.builder.alloca(llvm)

    def call(self, name: str, value: Value, *others: Value) -> Value:
        """Call a function of LLVM or of the C library whose arguments and result are of one kind."""
        types = [each.kind.llvm for each in (value, *others)]
        callee = self.declared(name, ir.FunctionType(types[0], types))
        arguments = [each.llvm for each in (value, *others)]
        return Value(value.kind, self.builder.call(callee, arguments, fastmath=self.flags))

    def declared(self, name: str, kind: ir.FunctionType) -> ir.Function:
        """Return a function of LLVM or of the C library."""
        module = self.builder.module
        return module.globals.get(name) or ir.Function(module, kind, name)

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

    def place(self, pointer: Value, index: Value) -> ir.Value:
        """Return the address of an entry of a pointer."""
        if index.kind is not WHOLE:
            raise TypeError(f"a {index.kind.name} is no place in memory")
        address = self.builder.gep(pointer.llvm, [index.llvm], inbounds=True)
        several = pointer.kind.entry if pointer.kind.entry in (LANES, PAIR) else None
        return address if several is None else self.builder.bitcast(address, several.llvm.as_pointer())

    def read(self, pointer: Value, index: Value) -> Value:
        """Return an entry of a pointer."""
        kind = _entry(pointer)
        align = 8 if kind in (LANES, PAIR) else None
        entry = self.builder.load(self.place(pointer, index), align=align)
        return Value(kind, self.builder.sext(entry, WHOLE.llvm) if pointer.kind.stored != kind.llvm else entry)

    def write(self, pointer: Value, index: Value, value: Value) -> None:
        """Set an entry of a pointer."""
        kind = _entry(pointer)
        if pointer.kind.stored != kind.llvm:
            raise TypeError(f"a {pointer.kind.name} is only read")
        align = 8 if kind in (LANES, PAIR) else None
        self.builder.store(self.converted(value, kind), self.place(pointer, index), align=align)


def _entry(pointer: Value) -> Kind:
    if pointer.kind.entry is None:
        raise TypeError(f"a {pointer.kind.name} has no entries")
    return pointer.kind.entry
