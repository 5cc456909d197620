"""Compiler from a subset of Python, defined in `translation`, to machine code by means of LLVM."""
