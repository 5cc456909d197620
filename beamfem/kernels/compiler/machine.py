"""Generation of machine code for this computer by LLVM, and its linking into the process."""

import os
from contextlib import suppress
from ctypes import CDLL, c_void_p, cast
from functools import cache

from llvmlite import binding as llvm
from llvmlite import ir

from beamfem.kernels.compiler.bounds_checks import CHECKED, SYMBOLS

SYMBOL = "kernel"  # name of the only function of each module
# functions of the C library that LLVM calls if the processor has no instruction, and for loops that copy or clear
_OF_C = ("atan2", "pow", "floor", "sqrt", "memcpy", "memmove", "memset")
_engines: list[llvm.ExecutionEngine] = []  # kept, because machine code lives as long as the engine that linked it


@cache
def _target() -> llvm.Target:
    with suppress(RuntimeError):  # newer versions of llvmlite do it automatically, and raise this error
        llvm.initialize()
    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    library = CDLL("ucrtbase" if os.name == "nt" else None)
    for name in _OF_C:
        with suppress(AttributeError):
            llvm.add_symbol(name, cast(getattr(library, name), c_void_p).value)
    for name, address in SYMBOLS.items() if CHECKED else ():
        llvm.add_symbol(name, address)
    return llvm.Target.from_triple(llvm.get_process_triple())


@cache
def processor() -> tuple[str, str]:
    """Return the name and the features of the processor."""
    return llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten()


def description() -> str:
    """Return a description of machine code: system, processor, version of LLVM, and checks if there are any."""
    _target()
    checks = ("checked",) if CHECKED else ()
    return repr((llvm.get_process_triple(), *processor(), llvm.llvm_version_info, *checks))


def _new_machine() -> llvm.TargetMachine:
    name, features = processor()
    return _target().create_target_machine(name, features, opt=3, jit=True)


_machine = cache(_new_machine)


def object_code(module: ir.Module) -> bytes:
    """Return the object file of a module."""
    return _machine().emit_object(_optimised(module))


def assembly_code(module: ir.Module) -> str:
    """Return the assembly code of a module."""
    return _machine().emit_assembly(_optimised(module))


def _optimised(module: ir.Module) -> llvm.ModuleRef:
    machine = _machine()
    module.triple, module.data_layout = llvm.get_process_triple(), str(machine.target_data)
    parsed = llvm.parse_assembly(str(module))
    parsed.verify()
    builder = llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options(speed_level=3))
    builder.getModulePassManager().run(parsed, builder)
    return parsed


def linked(code: bytes) -> int:
    """Link an object file into the process; return the address of its function."""
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _new_machine())
    engine.add_object_file(llvm.ObjectFileRef.from_data(code))
    engine.finalize_object()
    _engines.append(engine)
    return engine.get_function_address(SYMBOL)
