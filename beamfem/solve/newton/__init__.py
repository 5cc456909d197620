"""Newton's method for one equilibrium."""
