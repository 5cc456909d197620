"""Rows of a quadrature point of a batch, which strain measures and constitutive laws read and write."""

AXIS = 0  # q (6): r0', d and the third vector
STRAIN = 6  # eps (6)
RESULTANT = 12  # s (6), times the weight of the point
STIFFNESS = 18  # (21): ds/deps, upper triangle row by row, times the weight
FORCE = 39  # (6): forces conjugate to q
HESSIAN = 45  # (21): second derivative of the energy with respect to q, see `stiffness`
RATE = 66  # (6): rate or change of q, then that of eps
VELOCITY = FORCE  # q' (6), and
RATE_CHANGE = HESSIAN  # (6) the change of eps' at constant q', in `rate_tangent`
POINT_ROWS = 72
