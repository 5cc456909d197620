"""Critical points within a step of a path: columns whose buckling loads are known."""

from types import SimpleNamespace

import numpy as np
import pytest
from independent_balance import balance
from numpy.linalg import LinAlgError
from test_path import cantilever

import beamfem as bf
from beamfem.equations.equations import STATICS, linearise
from beamfem.equations.system import System
from beamfem.results.status import Statistics
from beamfem.solve.continuation import bifurcations as found_by
from beamfem.solve.continuation.continuation import begin
from beamfem.solve.continuation.critical_points import Segment
from beamfem.solve.newton.newton import Newton


def test_softness_of_a_change_is_its_product_with_the_inverse_of_the_tangent():
    """w . K^-1 w by a dense solution, w the change by the weights that its length is measured with."""
    _, model = cantilever(10, (0.0, -1.0), elements=2)
    system = System(model, static=True)
    line, start = begin(system, system.reference, 0.0, Newton())
    rest = np.zeros(system.model.size)
    tangent = linearise(system, start.y[:-1], rest, rest, 0.0, STATICS)[1].sparse(system.rotated).toarray()
    change = np.random.default_rng(3).standard_normal(len(start.y))
    right = (line.weights * change)[system.free_dofs]
    assert line.softness(start.factors, change) == pytest.approx(right @ np.linalg.solve(tangent, right), rel=1e-9)


def test_a_part_of_a_step_whose_tangent_is_singular_at_an_end_is_halved(monkeypatch):
    """Buckling loads (pi / 2)^2 (1, 9, 25) of a thin column; only parts shorter than 0.3 of the step can be solved."""
    _, model = cantilever(1000, (0.0, -1.0))
    system = System(model, static=True)
    line, start = begin(system, system.reference, 0.0, Newton())
    far = start.y + 70.0 * start.tangent / start.tangent[-1]
    far = line.correct(far, line.stresses(start.y, far - start.y), start.tangent).y
    segment = Segment(line, start, line.linearised(far, start.tangent))
    together, parts = found_by._together, []

    def singular(segment, start, end, change, distance):
        parts.append((start, end))
        if end - start > 0.3:
            raise LinAlgError
        return together(segment, start, end, change, distance)

    monkeypatch.setattr(found_by, "_together", singular)
    loads = [found.y[-1] for found in found_by.bifurcations(segment, [])]
    assert loads == pytest.approx(np.pi**2 / 4 * np.array([1.0, 9.0, 25.0]), rel=3e-5)
    assert parts[:3] == [(0.0, 1.0), (0.0, 0.5), (0.0, 0.25)]


def test_what_lies_before_and_behind_a_turning_point_is_listed_in_the_order_of_the_path(monkeypatch):
    """Where the load turns because a path crosses, at 0.6 of a step, and half-way along the parts beside it."""

    def crossing(x):
        return found_by.Crossing(x, np.zeros(1), np.zeros(1), np.zeros(1))

    monkeypatch.setattr(found_by, "turning_point", lambda segment, x: crossing(x))
    monkeypatch.setattr(found_by, "_search", lambda _, start, end, distance: iter([crossing(0.5 * (start + end))]))
    line = SimpleNamespace(dot=np.dot, length=np.linalg.norm)
    ends = {
        "symmetric": True,
        "before": SimpleNamespace(negative_pivots=0),
        "after": SimpleNamespace(negative_pivots=0),
    }
    segment = SimpleNamespace(line=line, turned=[0.6], change=lambda start, end: 0, **ends)
    shares = [found.fraction for found in found_by.bifurcations(segment, [])]
    low, high = 0.6 - found_by._BESIDE, 0.6 + found_by._BESIDE
    assert shares == pytest.approx([0.5 * low, 0.6, 0.5 * (high + 1.0)])


def test_bifurcations_are_in_balance_though_no_equilibrium_is_solved_for_there():
    """A stiff bar under pressure, hinged to one a million times as soft: interpolated states left 7 times as much."""
    stiff, soft = bf.Material(4.5e11, 0.3, 1.0), bf.Material(2e5, -0.3, 1.0)
    bar = bf.Beam(bf.Line((5.44, -4.02), (4.27, -7.79)), 3, bf.CRBF(2), bf.Rectangle(0.042, 0.0925), stiff)
    line, shares = bf.Line((4.27, -7.79), (1.59, -8.35)), (0, 0.226, 0.338, 1)
    other = bf.Beam(line, shares, bf.CRBF(2), bf.Rectangle(0.0075, 0.0639), soft)
    pins, joint = [bf.Pin(bar.start), bf.Pin(other.end)], bf.Hinge(bar.end, other.start)
    model = bf.Model([bar, other], pins, [bf.Pressure(bar, 1.2e5)], joints=[joint])
    path = bf.trace_equilibrium(model, until=-1.0, points=30)
    assert len(path.bifurcations) == 5
    for state in path.bifurcations:
        rest, statistics = np.zeros((1, len(state.p))), Statistics(0, 0, 0, "one state")
        alone = bf.Solution(model, True, np.array([state.at]), state.p[None], rest, rest, statistics)
        found = balance(alone)
        assert found.holds, found


@pytest.mark.parametrize(("symmetric", "expected"), [(True, -2), (False, 0)])
def test_pivots_of_an_unsymmetric_tangent_are_counted_by_the_sign_of_its_determinant(symmetric, expected):
    pivots = lambda x: SimpleNamespace(negative_pivots=3 if x == 0.0 else 1)  # noqa: E731
    assert Segment.change(SimpleNamespace(at=pivots, symmetric=symmetric), 0.0, 1.0) == expected
