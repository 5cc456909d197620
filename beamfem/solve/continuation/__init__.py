"""Points along an equilibrium path, the load factor among the unknowns, and the critical points between them."""
