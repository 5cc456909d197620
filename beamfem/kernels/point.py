"""Rows of a quadrature point of a batch: what strain measures and constitutive laws read and write, by row number."""

AXIS = 0  # q (6): r0', d and the third vector
STRAIN = 6  # eps (6)
RESULTANT = 12  # s (6), times the weight of the point
STIFFNESS = 18  # (21): ds/deps, upper triangle row by row, times the weight
FORCE = 39  # (6): vectors on q
HESSIAN = 45  # (21): second derivative of the energy by q, see `stiffness`
RATE = 66  # (6): change of q; then of eps
POINT_ROWS = 72
