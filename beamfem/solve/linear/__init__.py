"""Linear models of small motions about a state: matrices, damped modes, frequency responses."""
