"""From the Python that kernels are written in to machine code, by LLVM: `translation` says which Python that is."""
