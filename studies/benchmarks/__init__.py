"""How fast and how large: another code, the machine's ceilings, long chains, lattices, the compiler."""
