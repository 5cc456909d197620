"""The tables of numbers that Newton's iteration for an equilibrium shares with Python: limits, and what it found."""

# ------------------------------------------------------------------ `LIMITS`
TOLERANCE = 0  # of a correction
STAGNANT = 1  # correction below which it may be stagnant
DIVERGENT = 2  # correction above which the iteration diverges
PIVOT_RATIO = 3  # the smallest of a pivot to the row's original diagonal entry
MOST_ITERATIONS = 4
PREDICTED_RESULTANTS = 5  # 1 to take them for the geometric tangent, else 0
# where the third tangent or a later one has another number, the iteration stops; -1: any number will do
REQUIRED_NEGATIVE_PIVOTS = 6
LIMIT_FIELDS = 7

# ------------------------------------------------------------------ `FOUND`
ITERATIONS = 0  # so far
CORRECTION, CORRECTION_BEFORE = 1, 2  # sizes of the last correction and the one before
# in the state reached: largest residual of the unknown and of all coordinates, times their scales, smallest r0' x d
UNBALANCED, FORCE, JACOBIAN = 3, 4, 5
NEGATIVE_PIVOTS = 6  # of the last tangent
FIRST_CORRECTION = 7  # its size
NEGATIVE_PIVOTS_AFTER_FIRST = 8  # those of the second tangent, which has the resultants of a linear step
FOUND_FIELDS = 9
