"""A load step lies along the tangents of its path, or has gone over limit points."""

from itertools import pairwise

import numpy as np
import pytest
from judged import outcome, reference
from random_models import random_recipe
from slow_values import mostly_slow

import beamfem as bf
from beamfem.equations.system import system_of
from beamfem.solve.statics.load_steps import leaves_path


def arch(angle=0.0, unit=1.0, sign=1.0):
    """A clamped shallow arch pushed down in the middle, which snaps."""
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    ends = [unit * turn @ point for point in ((0.0, 0.0), (0.5, 0.05 * sign), (1.0, 0.0))]
    section, material = bf.Rectangle(0.01 * unit, 0.01 * unit), bf.Material(1e9 / unit**2, 0.3, 1.0)
    sides = [bf.Beam(bf.Line(*pair), 6, bf.CRBF(3), section, material) for pair in (ends[:2], ends[1:])]
    force = turn @ (0.0, -sign * 300.0)
    supports = [bf.Clamp(sides[0].start), bf.Clamp(sides[1].end)]
    joints = [bf.Rigid(sides[0].end, sides[1].start)]
    return bf.Model(sides, supports, [bf.PointForce(sides[0].end, tuple(force))], joints)


@pytest.mark.parametrize("view", [{}, {"angle": 0.7}, {"unit": 1e3}, {"sign": -1.0}])
def test_states_on_both_sides_of_a_snap_are_no_load_step_in_any_view(view):
    model = arch(**view)
    path = bf.trace_equilibrium(model, 1.0, points=200)
    limit = path.limit_points[0].load_factor
    system, rows = system_of(model, static=True), list(zip(path.p, path.load_factor, strict=True))
    assert limit < 0.9
    assert path.load_factor[-1] == 1.0
    last = next(number for number, (_, at) in enumerate(rows) if at > 0.9 * limit)
    assert leaves_path(system, rows[last], rows[-1])
    for one, other in pairwise(rows[: last + 1]):
        assert not leaves_path(system, one, other)


@pytest.mark.parametrize("turns", [0.02, 0.25])
def test_a_step_of_a_cantilever_that_rolls_up_is_on_its_path(turns):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(3), bf.Section.from_stiffness(1e5, 1e5, 1.0, 1.0, 1.0))
    moment = bf.PointMoment(beam.end, 2.0 * np.pi * turns)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [moment])
    solution = bf.solve_static(model, at=[0.5])
    system = system_of(model, static=True)
    rows = list(zip(solution.p, solution.load_factor, strict=True))
    for one, other in pairwise(rows):
        assert not leaves_path(system, one, other)


@mostly_slow("steps", [5, 10, 20], quick=(1,))
def test_a_wave_under_a_prescribed_motion_does_not_pass_its_limit_point_in_silence(steps):
    """Seed 469: from 0.55 to 0.75 over 0.6624 in nine iterations, with one count of negative pivots everywhere."""
    recipe = random_recipe(469)
    expected = reference(recipe)
    assert expected.limit == pytest.approx(0.66236, abs=1e-5)
    found = outcome(recipe.build(), expected, steps)
    assert found.right, found.said


@pytest.mark.parametrize("steps", [1, 3, 10])
def test_a_beam_that_bends_by_itself_between_its_supports_does_not_skip_its_limit_point(steps):
    """One step from rest took nine iterations, fewer than were looked at, and ended on another path."""
    ends = (0.0, 0.0), (-0.99, -0.141)
    beam = bf.Beam(bf.Line(*ends), 2, bf.ANCFCRBF(), bf.Rectangle(0.02, 0.0625), bf.Material(1e9, 0.3, 1000.0))
    supports = [bf.Clamp(beam.start), bf.Roller(beam.end, (1.0, 0.0))]
    model = bf.Model([beam], supports, [bf.Actuation(beam, curvature=-1.0, stretch=-0.01)])
    path = bf.trace_equilibrium(model, points=60)
    with pytest.raises(bf.LimitPointError) as caught:
        bf.solve_static(model, steps)
    assert caught.value.load_factor == pytest.approx(path.limit_points[0].at, rel=1e-6)
    assert caught.value.load_factor == pytest.approx(0.393, abs=2e-3)
