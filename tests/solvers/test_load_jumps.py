"""Statics across jumps of loads and prescribed motions, against the states before and behind them."""

import numpy as np
import pytest

import beamfem as bf

BAR = bf.Beam(bf.Line((0, 0), (100, 0)), 6, bf.CRBF(2), bf.Rectangle(5, 5), bf.Material(2e5, 0.3, 1e-9))
CLAMP = bf.Clamp(BAR.start)
FORCE = 2e4  # turns the end by more than a radian: no single load step from rest


def model(function, force=FORCE):
    return bf.Model([BAR], [CLAMP], [bf.PointForce(BAR.end, (0.0, force), amplitude=function)])


def alone(factor):
    """Tip under a constant force that grows from zero."""
    return bf.solve_static(bf.Model([BAR], [CLAMP], [bf.PointForce(BAR.end, (0.0, factor * FORCE))]), 8).displacement(
        BAR.end
    )[-1]


# jumps: load factor, factors before and behind it
JUMPS = {
    "from rest": (lambda at: float(at >= 0.5), [(0.5, 0.0, 10.0)]),
    "from rest, value at 0.5 before": (lambda at: float(at > 0.5), [(0.5, 0.0, 10.0)]),
    "while it grows": (lambda at: 0.03 * at + float(at >= 0.3), [(0.3, 0.09, 10.09)]),
    "away": (lambda at: float(at < 0.7), [(0.7, 10.0, 0.0)]),
    "to and fro": (lambda at: float(0.2 < at < 0.6), [(0.2, 0.0, 10.0), (0.6, 10.0, 0.0)]),
    "at the start": (lambda at: float(at > 0.0), [(0.0, 0.0, 10.0)]),
    "at the end": (lambda at: float(at >= 1.0), [(1.0, 0.0, 10.0)]),
}
each_jump = pytest.mark.parametrize(("function", "jumps"), JUMPS.values(), ids=JUMPS)


@pytest.mark.filterwarnings("ignore::beamfem.errors.LargeStrainWarning")
@pytest.mark.parametrize("declared", [True, False], ids=["declared", "found"])
@pytest.mark.parametrize("steps", [1, 4])
@each_jump
def test_statics_cross_a_jump_with_a_row_on_either_side(function, jumps, steps, declared):
    """A force that came at once ended in "the path could not be followed"."""
    kinks = [at for at, *_ in jumps]
    found = bf.solve_static(model(bf.Piecewise(function, kinks) if declared else function, 10.0 * FORCE), steps)
    tip = found.displacement(BAR.end)
    for at, before, behind in jumps:
        first, second = np.flatnonzero(np.abs(found.at - at) < 1e-9)
        np.testing.assert_allclose(tip[first], alone(before), atol=1e-6)
        np.testing.assert_allclose(tip[second], alone(behind), atol=1e-6)
        assert [10.0 * function(x) for x in found.at[[first, second]].tolist()] == pytest.approx([before, behind])
    for k in range(1, steps + 1):
        assert np.abs(found.at - k / steps).min() == 0.0
    np.testing.assert_allclose(tip[-1], alone(10.0 * function(1.0)), atol=1e-6)


def test_a_state_asked_for_at_a_jump_is_under_the_load_there():
    for function, factor in ((lambda at: float(at >= 0.5), 1.0), (lambda at: float(at > 0.5), 0.0)):
        found = bf.solve_static(model(function), at=[0.25, 0.5])
        np.testing.assert_allclose(found.displacement(BAR.end), [alone(0.0), alone(factor)], atol=1e-6)


def test_supports_loads_and_connected_stiffness_jump_together():
    """A rolled end that is led aside at once under a moment that goes away, with a spring; against a slow change."""
    spring, roller = bf.Spring(BAR.at(0.5), (0.0, 50.0)), (lambda at: 30.0 * (at >= 0.4), lambda at: 1.0 - (at > 0.4))
    quick = bf.Model(
        [BAR],
        [CLAMP, spring, bf.Prescribed(BAR.end, uy=roller[0])],
        [bf.PointMoment(BAR.end, 2e5, amplitude=roller[1]), bf.PointForce(BAR.end, (-500.0, 0.0))],
    )
    slow = bf.Model([BAR], [CLAMP, spring, bf.Prescribed(BAR.end, uy=30.0)], [bf.PointForce(BAR.end, (-500.0, 0.0))])
    found, expected = bf.solve_static(quick), bf.solve_static(slow)
    np.testing.assert_allclose(found.p[-1], expected.p[-1], atol=1e-8)
    np.testing.assert_allclose(found.reaction(BAR.start)[-1], expected.reaction(BAR.start)[-1], rtol=1e-6)


def test_a_jump_past_a_limit_point_ends_in_its_error_or_snaps():
    """Von Mises truss: the load that comes at once exceeds what the arch bears."""
    section, material = bf.Rectangle(0.01, 0.01), bf.Material(1e7, 0.3, 1000.0)
    left, right = (bf.Beam(bf.Line((x, 0), (0, 0.1)), 3, bf.CRBF(2), section, material) for x in (-1, 1))
    supports = [bf.Pin(left.start), bf.Pin(right.start), bf.Roller(left.end, (1, 0))]
    load = {"amplitude": lambda at: 2.0 * (at >= 0.5)}
    arch = bf.Model(
        [left, right], supports, [bf.PointForce(left.end, (0.0, -1.0), **load)], [bf.Hinge(left.end, right.end)]
    )
    with pytest.raises(bf.LimitPointError, match=r"at load factor 0\.5; as the jump grows from 0 to 1: a limit"):
        bf.solve_static(arch)
    assert bf.solve_static(arch, snap="jump").displacement(left.end)[-1, 1] < -0.2


@pytest.mark.parametrize("declared", [True, False], ids=["declared", "found"])
@each_jump
def test_a_path_ends_before_a_jump_and_names_it(function, jumps, declared):
    at, before, behind = jumps[0]
    function = bf.Piecewise(function, [jump[0] for jump in jumps]) if declared else function
    with pytest.raises(bf.ConvergenceError, match="jumps from") as caught:
        bf.trace_equilibrium(model(function, 10.0 * FORCE), 1.0)
    sentence = f"ends at load factor {at:g}, where amplitude of PointForce at (100, 0)"
    assert sentence in str(caught.value)
    assert f"jumps from {before / 10.0:.6g} to {behind / 10.0:.6g}" in str(caught.value)
    path = caught.value.solution
    np.testing.assert_allclose(path.displacement(BAR.end)[-1], alone(before), atol=1e-6)


def test_turns_within_a_jump_are_counted():
    """Gradients know a rotation up to full turns only: a moment that rolls a strip up by a turn and a half at once."""
    section = bf.Rectangle(0.01, 0.01)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 16, bf.ANCF(bf.Structural()), section, bf.Material(1e9, 0.3, 1.0))
    stub = bf.Beam(bf.Line((1, 0), (1.1, 0)), 1, beam.element, section, beam.material)
    moment = 3.0 * np.pi * 1e9 * section.second_moment
    load = bf.PointMoment(beam.end, moment, amplitude=lambda at: float(at >= 0.5))
    model = bf.Model([beam, stub], [bf.Clamp(beam.start)], [load], [bf.Rigid(beam.end, stub.start)])
    for at in (None, [0.25, 1.0]):
        turned = bf.solve_static(model, at=at).rotation(stub.end)
        assert turned[-1] == pytest.approx(3.0 * np.pi, abs=0.05)  # 16 elements; without counting 2 pi less
