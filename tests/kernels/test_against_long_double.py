"""Solutions with a static tangent, and its count of negative pivots, against elimination in long double.

Tangents of a cantilever of L/h 1e2 to 1e5 and 10 to 1000 elements: straight, bent by a force 2 E I / L^2 across its
tip, compressed by 50 E I / L^2; for each kind of nodal coordinates. The compiled routines are those that statics uses
and the two that motions use, from both ends and in halves. Errors are relative, in the scale of the coordinates.

Measured at L/h 1e5: errors are 1e-7 to 3e-3 with 10 elements, 3e-6 to 0.2 with 100, 1e-4 and more with 1000; they grow
in proportion to (L/h)^2. The median of their ratio to those of LAPACK is 0.83. An error of one matrix is chance and may
be 100 times smaller than that of the next one, so the largest of a few slendernesses are compared. Bilinear elements in
compression are the one kind of case in which LAPACK is more than 5 times better on average: 7 to 32 times with 100
elements or more (5e-5 against 1.6e-6), but only if it begins at the free end, as the package does; if it begins at the
clamp its error is 8e-5. The other way round shear-rigid elements have errors up to 100 times smaller in the package. It
is compared with the worse of both orders. Residuals are 1e-16 of their terms, 2e-15 at most; those of LAPACK are 1e-16
to 1e-14.

Long double has 3e-3 of the errors of double, or less: it is a reference even where double has one digit left. Double
has none for orders 2 and above with 1000 elements at L/h 1e5: errors of 0.1 to 280, and for orders 3, 5 and 8 counts
that are those of round-off. Solvers do not rely on the band there, because `lost_digits` tells.
"""

from decimal import Decimal, localcontext

import numpy as np
import pytest
from numpy.lib.stride_tricks import as_strided
from scipy.linalg import solve_banded

import beamfem as bf
from beamfem.equations.equations import STATICS, linearise, linearise_after
from beamfem.equations.system import Proven, system_of
from beamfem.kernels.band import band
from beamfem.kernels.bidirectional_lu import SHORT, bidirectional_lu
from beamfem.precision.roundoff import LOSES, lost_digits

ELEMENTS = (
    bf.ANCF(),
    bf.ANCFCRBF(),
    bf.BilinearANCF(integration="reduced"),
    bf.BilinearCRBF(integration="reduced"),
    *(bf.CRBF(order) for order in (2, 3, 5, 8)),
    bf.ShearRigid(),
    bf.ShearRigid(stretchable=False),
)
STATES = {"straight": 0, "bent": 0, "compressed": 2}  # negative pivots: Euler's loads below 50 E I / L^2 are 2.5 and 22
FACTOR = 10.0  # above the largest ratio of errors, which are chance in part
ROUND_OFF = 2.0**-52
NO_DIGITS = 0.1  # error of LAPACK from which on there is nothing left to compare

pytestmark = pytest.mark.skipif(
    np.finfo(np.longdouble).eps > 2.0**-60, reason="long double is no more precise than double here"
)


def tangent_of(element, slenderness, elements, state):
    """Return a system, a state p (n,) and the band tangent of this state; a compressed one has predicted resultants."""
    axis, shape = bf.Line((0.0, 0.0), (1.0, 0.0)), bf.Rectangle(width=1.0, height=1.0 / slenderness)
    beam = bf.Beam(axis, elements, element, shape, bf.Material(12.0, 0.3, 1.0))
    stiffness = shape.second_moment * 12.0
    force = (-50.0 * stiffness, 0.0) if state == "compressed" else (0.0, 2.0 * stiffness)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, force)])
    system = system_of(model, static=True)
    p, zeros = system.reference, np.zeros(model.size)
    if state == "bent":
        p = bf.solve_static(model).p[-1]
    unbalanced, tangent = linearise(system, p, zeros, zeros, 1.0, STATICS)
    if state == "compressed":
        step = zeros.copy()
        step[system.free_dofs] = -tangent.solve(unbalanced[system.free_dofs], system.rotated)
        tangent = linearise_after(system, p, step, 1.0)
    # where the solver has found the tangent without digits, it keeps it as `plain` only
    return system, p, getattr(tangent, "plain", tangent)


def right_sides(system):
    """Return a force across the tip and three random vectors (n, 4), each coordinate by its scale."""
    scale = system.scale[system.free_dofs]
    result = np.random.default_rng(20160101).standard_normal((len(scale), 4)) / scale[:, None]
    zeros = np.zeros(len(system.reference))
    result[:, 0] = linearise(system, system.reference, zeros, zeros, 1.0, STATICS)[0][system.free_dofs]
    return result


def eliminated(rows, right, exact):
    """Return the solutions (n, k) in the numbers that `exact` makes of floats, and the count of negative pivots.

    Gauss without exchange of rows; a band of w more rows of zeros spares the end its own case.
    """
    n, w = len(rows), rows.shape[1] // 2
    matrix = exact(np.vstack([rows, np.zeros((w, 2 * w + 1))]))
    x = exact(np.vstack([right, np.zeros((w, right.shape[1]))]))
    down, across = matrix.strides
    negative = 0
    for k in range(n):
        pivot, after = matrix[k, w], matrix[k, w + 1 :]
        negative += int(pivot < 0)
        below = as_strided(matrix[k + 1 :, w - 1 :], (w, w + 1), (down - across, across))  # column k and those after it
        factors = below[:, :1] / pivot
        below[:, 1:] -= factors * after
        x[k + 1 : k + 1 + w] -= factors * x[k]
    for k in range(n - 1, -1, -1):
        x[k] = (x[k] - matrix[k, w + 1 :] @ x[k + 1 : k + 1 + w]) / matrix[k, w]
    return x[:n], negative


def long_double(values):
    return values.astype(np.longdouble)


def in_statics(tangent, right):
    """Return the solutions and the count of negative pivots as `kernels.newton.iterate` gets them."""
    n, w, solutions, counts = len(right), tangent.rows.shape[1] // 2, [], set()
    own = band(w)
    for x in right.T.copy():
        rows, pivots = tangent.rows.copy(), np.empty(n)
        assert own.factor(n, n, w, 1, tangent.reach, rows, x, pivots) > 0.0
        own.solve_upper(n, n, w, rows, x)
        solutions.append(x)
        counts.add(int((pivots < 0.0).sum()))
    assert len(counts) == 1
    return np.array(solutions).T, counts.pop()


def in_motions(system, tangent, right):
    """Return the solutions with factors from both ends."""
    n, w, rows, solutions = len(right), tangent.rows.shape[1] // 2, tangent.rows.copy(), right.T.copy()
    own = bidirectional_lu(w, n < SHORT)
    assert own.factor(n, w, system.unknowns.reach, rows, np.empty(n)) > 0.0
    for x in solutions:
        own.solve(n, w, rows, x)
    return solutions.T


def by_lapack(rows, right):
    """Return the solutions of LAPACK, with the equations in their order and from the last one to the first."""
    w = rows.shape[1] // 2
    there = solve_banded((w, w), diagonals(rows), right)
    return there, solve_banded((w, w), diagonals(rows[::-1, ::-1]), right[::-1])[::-1]


def diagonals(rows):
    """Return a band as SciPy stores it: entry (w + i - j, j) is A[i, j]."""
    n, w = len(rows), rows.shape[1] // 2
    result = np.zeros((2 * w + 1, n))
    for k in range(-w, w + 1):
        i = np.arange(max(0, -k), min(n, n - k))
        result[w - k, i + k] = rows[i, w + k]
    return result


def relative_residual(rows, x, right, scale):
    """Return the largest residual over the largest sum of its terms, in the scale of coordinates, in long double."""
    n, w = len(rows), rows.shape[1] // 2
    beside = long_double(np.vstack([np.zeros((w, x.shape[1])), x, np.zeros((w, x.shape[1]))]))
    terms = np.array([rows[:, k, None] * beside[k : k + n] for k in range(2 * w + 1)] + [-long_double(right)])
    sizes = scale[:, None] * np.abs(terms).sum(axis=0)
    return float((np.abs(scale[:, None] * terms.sum(axis=0)).max(axis=0) / sizes.max(axis=0)).max())


def compared(element, slenderness, elements, state):
    """Return the errors of LAPACK and of each routine; check residuals, and counts where digits are left."""
    system, p, tangent = tangent_of(element, slenderness, elements, state)
    rows, right, scale = tangent.rows, right_sides(system), system.scale[system.free_dofs]
    reference, negative = eliminated(rows, right, long_double)
    size = (np.abs(reference) / scale[:, None]).max(axis=0)

    def error(x):
        return float(((np.abs(x - reference) / scale[:, None]).max(axis=0) / size).max())

    found, count = in_statics(tangent, right)
    solutions = {"statics": found, "motions": in_motions(system, tangent, right)}
    for name, x in solutions.items():
        assert relative_residual(rows, x, right, scale) < 16.0 * ROUND_OFF, name
    lapack = max(map(error, by_lapack(rows, right)))
    errors = {name: error(x) for name, x in solutions.items()}
    lost = lost_digits(system, p, 1.0, STATICS)
    if errors["statics"] < NO_DIGITS:
        assert count == negative
        # the rounded matrix itself may have another count than the exact one
        assert lost > NO_DIGITS or count == STATES[state]
    else:
        assert Proven.LOSES_DIGITS in system.proven or lost > LOSES
    return lapack, errors


def compare(element, slenderness, elements, state, samples):
    parts = [compared(element, slenderness * (1.0 + 0.01 * k), elements, state) for k in range(samples)]
    lapack = max(each for each, _ in parts)
    if lapack < NO_DIGITS:
        for name in parts[0][1]:
            assert max(errors[name] for _, errors in parts) < FACTOR * lapack + 2.0 * ROUND_OFF, name


each_element = pytest.mark.parametrize("element", ELEMENTS, ids=[element.name for element in ELEMENTS])
each_state = pytest.mark.parametrize("state", STATES)


@each_element
@each_state
@pytest.mark.parametrize(("slenderness", "elements"), [(1e2, 10), (1e5, 10), (1e4, 100)])
def test_solutions_and_counts_are_as_good_as_those_of_lapack(element, state, slenderness, elements):
    compare(element, slenderness, elements, state, samples=4)


@pytest.mark.slow
@each_element
@each_state
@pytest.mark.parametrize("slenderness", [1e2, 1e3, 1e4, 1e5])
@pytest.mark.parametrize("elements", [10, 100, 1000])
def test_any_slenderness_and_number_of_elements(element, state, slenderness, elements):
    compare(element, slenderness, elements, state, samples=4 if elements < 1000 else 2)


@each_element
@pytest.mark.parametrize(("slenderness", "elements"), [(1e5, 10), pytest.param(1e5, 1000, marks=pytest.mark.slow)])
def test_long_double_has_digits_where_double_has_few(element, slenderness, elements):
    """Against decimals of sixty digits: its errors are 1e-9 to 1e-6 with 10 elements, up to 1e-3 with 1000."""
    system, _, tangent = tangent_of(element, slenderness, elements, "straight")
    right, scale = right_sides(system), system.scale[system.free_dofs]
    with localcontext(prec=60):
        exact, negative = eliminated(tangent.rows, right, np.vectorize(Decimal, otypes=[object]))
        leading = exact.astype(float)
        rest = (exact - np.vectorize(Decimal, otypes=[object])(leading)).astype(float)
    found, count = eliminated(tangent.rows, right, long_double)
    errors = np.abs(found - leading - rest) / scale[:, None]
    relative = (errors.max(axis=0) / (np.abs(leading) / scale[:, None]).max(axis=0)).max()
    assert relative < (1e-6 if elements == 10 else 1e-3)
    assert count == negative
