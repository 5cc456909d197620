"""One function for many combinations of parameters: sweeps, their workers, and results that are found again."""
