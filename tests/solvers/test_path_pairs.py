"""Paths of loads that follow: pivots that change in pairs, which the sign of the determinant does not show."""

import numpy as np
import pytest
from random_models import random_recipe
from slow_values import mostly_slow

import beamfem as bf

RUBBER = bf.Material(1e9, 0.3, 1000.0)


@pytest.mark.parametrize("step", [None, 0.2, 0.1, 0.05, 0.02])
@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_strut_that_a_follower_force_pushes_aside_does_not_stay_straight(step, sign):
    """Its end is led past two buckling loads: a step over both once left it straight, with two negative eigenvalues."""
    strut = bf.Beam(bf.Line((0, 0), (-0.75, 7e-4 * sign)), 2, bf.CRBF(3), bf.Rectangle(0.02, 0.078125), RUBBER)
    middle = strut.at(0.5)
    supports = [bf.Clamp(strut.start), bf.Prescribed(strut.end, ux=0.0625, uy=0.0, rotation=0.0)]
    model = bf.Model([strut], supports, [bf.PointForce(middle, (800.0, 0.0), follower=True)])
    path, solution = bf.trace_equilibrium(model, 1.0, step=step), bf.solve_static(model, 10)
    assert path.stable.all()
    assert path.displacement(middle)[-1, 1] * sign == pytest.approx(0.1037, abs=1e-3)
    np.testing.assert_allclose(path.p[-1], solution.p[-1], atol=1e-8)


@pytest.mark.parametrize("solve", [bf.solve_static, bf.trace_equilibrium, bf.solve_buckling])
def test_standing_loads_beyond_a_limit_point_say_so(solve):
    """A shallow toggle that stands under twice what it can carry."""
    left = bf.Beam(bf.Line((0.0, 0.0), (0.5, 0.05)), 4, bf.CRBF(2), bf.Rectangle(0.01, 0.01), RUBBER)
    right = bf.Beam(bf.Line((0.5, 0.05), (1.0, 0.0)), 4, bf.CRBF(2), bf.Rectangle(0.01, 0.01), RUBBER)
    supports, joints = [bf.Clamp(left.start), bf.Clamp(right.end)], [bf.Rigid(left.end, right.start)]
    pushed = bf.Model([left, right], supports, [bf.PointForce(left.end, (0.0, -52.0))], joints)
    with pytest.raises(bf.LimitPointError) as limit:
        bf.solve_static(pushed)
    assert limit.value.load_factor == pytest.approx(0.5, abs=0.01)
    loads = [bf.PointForce(left.end, (0.0, -52.0), scale=False), bf.PointForce(left.end, (0.01, 0.0))]
    with pytest.raises(bf.ConvergenceError, match="do not scale: as they grow from zero, they reach a limit point"):
        solve(bf.Model([left, right], supports, loads, joints))


@pytest.mark.slow
@mostly_slow("steps", [1, 3, 10, 100], quick=(1,))
@pytest.mark.parametrize("beyond", [1.0001, 1.002, 1.02, 1.1])
def test_a_limit_point_just_beyond_the_load_is_not_in_its_way(beyond, steps):
    """A step along the path that rose over the load and came down again was taken for one that turned below it."""
    strut = bf.Beam(bf.Line((0.0, 0.0), (0.5, 0.018)), 4, bf.CRBF(2), bf.Rectangle(0.01, 0.01), RUBBER)
    supports = [bf.Clamp(strut.start), bf.Prescribed(strut.end, ux=0.0, rotation=0.0)]

    def pushed(force):
        return bf.Model([strut], supports, [bf.PointForce(strut.end, (0.0, -force))])

    limit = bf.trace_equilibrium(pushed(20.0)).limit_points[0].at * 20.0
    model = pushed(limit / beyond)
    path, solution = bf.trace_equilibrium(model, 1.0), bf.solve_static(model, steps)
    assert solution.at[-1] == 1.0
    assert solution.stable.all()
    np.testing.assert_allclose(solution.p[-1], path.p[-1], atol=1e-7)


def test_a_strut_that_turns_back_just_beyond_its_load_reaches_it():
    """Seed 1158 of the random models."""
    model = random_recipe(1158).build().model
    path = bf.trace_equilibrium(model, 1.0)
    for steps in (1, 3, 100):
        np.testing.assert_allclose(bf.solve_static(model, steps).p[-1], path.p[-1], atol=1e-9)


def test_a_model_that_cannot_move_at_all_has_no_path():
    bar = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), 1, bf.CRBF(1), bf.Rectangle(0.05, 0.05), RUBBER)
    model = bf.Model([bar], [bf.Clamp(bar.start), bf.Clamp(bar.end)], [bf.Gravity((0.0, -9.81))])
    with pytest.raises(bf.InputError, match="prescribe all of its coordinates"):
        bf.trace_equilibrium(model, 1.0)
