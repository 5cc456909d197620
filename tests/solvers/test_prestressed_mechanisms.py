"""Mechanisms that prestress or weight make stiff, against rigid bars by hand; true mechanisms are refused."""

from itertools import pairwise

import numpy as np
import pytest

import beamfem as bf

STIFF = bf.Material(youngs_modulus=2.1e14, poisson_ratio=0.3, density=7850.0)
SQUARE = bf.Rectangle(0.01, 0.01)
WEIGHT = 7850.0 * 1e-4 * 9.81  # [N/m]


def chain(ends, elements=2):
    """Return bars from point to point, and the hinges between them."""
    bars = [bf.Beam(bf.Line(*pair), elements, bf.CRBF(order=3), SQUARE, STIFF) for pair in pairwise(ends)]
    return bars, [bf.Hinge(one.end, other.start) for one, other in pairwise(bars)]


def string(tension, scale=False):
    """Two bars of 1 m in a line, pulled at a roller, with 1 N across them at the hinge."""
    (left, right), hinges = chain([(0, 0), (1, 0), (2, 0)])
    loads = [bf.PointForce(right.end, (tension, 0), scale=scale), bf.PointForce(left.end, (0, -1.0))]
    return left.end, bf.Model([left, right], [bf.Pin(left.start), bf.Roller(right.end)], loads, hinges)


def hanging(number, angle=-np.pi / 2, scale=False):
    """Bars of 1 m below a pin, with 1 N to the right at the lower end."""
    along = np.array([np.cos(angle), np.sin(angle)])
    bars, hinges = chain([tuple(i * along) for i in range(number + 1)])
    loads = [bf.Gravity((0, -9.81), scale=scale), bf.PointForce(bars[-1].end, (1.0, 0))]
    return bars[-1].end, bf.Model(bars, [bf.Pin(bars[0].start)], loads, hinges)


def test_a_string_sags_by_its_tension():
    middle, model = string(100.0)
    solution = bf.solve_static(model)
    assert solution.displacement(middle)[-1, 1] == pytest.approx(-np.sin(np.arctan(1 / 200)), rel=1e-6)
    assert solution.stable.all()
    path = bf.trace_equilibrium(model, until=1.0)
    assert path.displacement(middle)[-1, 1] == pytest.approx(-np.sin(np.arctan(1 / 200)), rel=1e-6)


@pytest.mark.parametrize("number", [1, 2, 5])
def test_bars_hang_by_their_weight(number):
    tip, model = hanging(number)
    solution = bf.solve_static(model)
    # each bar turns until the force aside balances the weight below its middle
    by_hand = sum(np.sin(np.arctan(1.0 / (WEIGHT * (below + 0.5)))) for below in range(number))
    assert solution.displacement(tip)[-1, 0] == pytest.approx(by_hand, rel=1e-5)


def test_a_bar_that_is_drawn_aside_hangs_down():
    tip, model = hanging(1, angle=-np.pi / 3)
    position = np.array(tip.reference) + bf.solve_static(model).displacement(tip)
    assert position[0] == pytest.approx([0.0, -1.0], abs=1e-5)
    turn = np.arctan(1.0 / (WEIGHT / 2))
    assert position[-1] == pytest.approx([np.sin(turn), -np.cos(turn)], rel=1e-5)


@pytest.mark.parametrize(
    "model",
    [
        string(-1.0)[1],
        string(0.0)[1],
        string(100.0, scale=True)[1],
        hanging(1, angle=0.0)[1],
        hanging(1, angle=np.pi / 2)[1],
        hanging(1, scale=True)[1],
    ],
    ids=["pressed", "slack", "scaled", "horizontal", "upright", "scaled weight"],
)
def test_true_mechanisms_are_refused(model):
    for solve in (bf.solve_static, bf.trace_equilibrium):
        with pytest.raises(bf.FreeMotionError, match=r"beam 0 can move freely: it turns about \(0, 0\)"):
            solve(model)


def test_tension_does_not_hold_what_it_does_not_reach():
    """A pendulum without weight beside a string."""
    (left, right), hinges = chain([(0, 0), (1, 0), (2, 0)])
    loose = bf.Beam(bf.Line((0, 1), (1, 1)), 2, bf.CRBF(order=3), SQUARE, STIFF)
    supports = [bf.Pin(left.start), bf.Roller(right.end), bf.Pin(loose.start)]
    loads = [bf.PointForce(right.end, (100.0, 0), scale=False), bf.PointForce(left.end, (0, -1.0))]
    with pytest.raises(bf.FreeMotionError, match="can move freely"):
        bf.solve_static(bf.Model([left, right, loose], supports, loads, hinges))
