"""Static solves that meet a limit point: they name it, or jump to where the structure comes to rest."""

from dataclasses import replace

import numpy as np
import pytest
from slow_values import mostly_slow

import beamfem as bf
from beamfem.equations.system import System, system_of
from beamfem.solve.continuation.continuation import begin
from beamfem.solve.continuation.critical_points import Segment, SegmentLostError
from beamfem.solve.continuation.steps import take_step
from beamfem.solve.newton.newton import NewtonResult, Termination
from beamfem.solve.statics import load_path as snap


def toggle(load, element=None, turn=0.0):
    """Shallow frame of two bars, ends clamped 2 m apart, 0.02 m rise; a load down (or along the turned axis)."""
    c, s = np.cos(turn), np.sin(turn)

    def place(x, y):
        return c * x - s * y, s * x + c * y

    section = bf.Section(area=1e-4, second_moment=1e-9)
    common = (6, element or bf.CRBF(3), section, bf.Material(7e10, 0.3, 2700.0))
    left = bf.Beam(bf.Line(place(-1, 0), place(0, 0.02)), *common)
    right = bf.Beam(bf.Line(place(0, 0.02), place(1, 0)), *common)
    return left, bf.Model(
        [left, right],
        [bf.Clamp(left.start), bf.Clamp(right.end)],
        [bf.PointForce(left.end, place(0.0, -load))],
        [bf.Rigid(left.end, right.start)],
    )


@pytest.fixture(scope="module")
def traced():
    top, model = toggle(1.0)
    return top, bf.trace_equilibrium(model, until=lambda state: state.displacement(top.end)[1] < -0.05)


@pytest.mark.parametrize("steps", [1, 10, 100])
def test_a_limit_point_is_named_with_its_load_and_the_rows_before_it(traced, steps):
    limit = traced[1].limit_points[0].load_factor
    _, model = toggle(3.0 * limit)
    with pytest.raises(bf.LimitPointError, match=r"limit point at load factor 0\.333333") as caught:
        bf.solve_static(model, steps)
    assert caught.value.load_factor == pytest.approx(1.0 / 3.0, rel=1e-6)
    before = caught.value.solution
    assert before.stable.all()
    assert before.load_factor[-1] < 1.0 / 3.0
    assert before.status is bf.Status.STOPPED


@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_a_jump_ends_on_the_far_stable_part_of_the_path(traced, turn):
    top, path = traced
    limit = path.limit_points[0].load_factor
    beam, model = toggle(3.0 * limit, turn=turn)
    solution = bf.solve_static(model, snap="jump")
    assert solution.stable.all()
    row = int(np.flatnonzero(np.isclose(solution.load_factor, 1.0 / 3.0, rtol=1e-6))[-1])
    down = np.array([-np.sin(turn), np.cos(turn)])
    moved = solution.displacement(beam.end) @ down
    # the top led to where it came to rest needs the same load, and is behind both limit points
    led = bf.Model(
        path.model.beams, [*path.model.supports, bf.Prescribed(top.end, uy=moved[row])], (), path.model.joints
    )
    assert -bf.solve_static(led).reaction(top.end)[-1, 1] == pytest.approx(limit, rel=1e-6)
    assert moved[row] < path.limit_points[-1].displacement(top.end)[1]
    assert np.all(np.diff(solution.load_factor) >= 0.0)
    straight = bf.solve_static(bf.Model(model.beams, model.supports, model.loads, model.joints), snap="jump", steps=40)
    assert moved[-1] == pytest.approx(straight.displacement(beam.end)[-1] @ down, rel=1e-8)


def test_a_column_beyond_its_critical_load_goes_on_straight_and_says_that_it_is_unstable():
    section = bf.Rectangle(0.01, 0.01)
    steel = bf.Material(2e11, 0.3, 7800.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 6, bf.CRBF(3), section, steel)
    critical = np.pi**2 / 4.0 * 2e11 * section.second_moment
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-2.0 * critical, 0.0))])
    with pytest.warns(bf.UnstableWarning, match="rows are unstable equilibria, from load factor"):
        solution = bf.solve_static(model)
    assert np.abs(solution.displacement(beam.end)[-1, 1]) < 1e-9
    # Reissner's column loses its stability a little below Euler's load: it is shortened, and shears
    assert np.array_equal(solution.stable, solution.load_factor < 0.5 * (1.0 - 1e-4))
    assert solution.status is bf.Status.UNSTABLE
    assert "unstable" in repr(solution)
    assert "eigenvalues of its tangent are negative" in solution.statistics.ended


def test_a_follower_load_that_loses_its_path_is_refused_with_a_limit_point():
    """The load turns with the section at the top of a toggle; its determinant changes sign at the limit point."""
    top, model = toggle(1.0)
    follower = bf.Model(model.beams, model.supports, [bf.PointForce(top.end, (0.0, -1.0), follower=True)], model.joints)
    path = bf.trace_equilibrium(follower, until=lambda state: state.displacement(top.end)[1] < -0.05)
    limit = path.limit_points[0].load_factor
    load = bf.PointForce(top.end, (0.0, -2.0 * limit), follower=True)
    with pytest.raises(bf.LimitPointError) as caught:
        bf.solve_static(bf.Model(model.beams, model.supports, [load], model.joints))
    assert caught.value.load_factor == pytest.approx(0.5, rel=1e-6)


def test_large_standing_loads_grow_first_where_one_step_would_leave_the_path():
    """The wavy cantilever whose one-step solve once ended in another equilibrium, its load standing from the start."""
    steel, section = bf.Material(2e11, 0.3, 7800.0), bf.Rectangle(0.01, 0.01)
    beam = bf.Beam(bf.Parametric(lambda u: (u, 0.3 * np.sin(3 * u)), 0, 1.5), 40, bf.ShearRigid(), section, steel)
    force = 2e11 * section.second_moment * np.array([-2.0, 3.0])
    tips = []
    for scale in (True, False):
        model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, force, scale=scale)])
        tips.append(bf.solve_static(model).position(beam.end)[-1])
    assert tips[0] == pytest.approx([-0.00684, 1.71669], abs=2e-5)
    assert tips[1] == pytest.approx(tips[0], abs=1e-9)


def test_a_rotation_that_jumps_by_more_than_a_radian_is_refused_with_its_load_factor():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 6, bf.CRBF(3), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    turned = bf.Prescribed(beam.end, rotation=lambda t: 1.5 if t > 0.3 else 0.0)
    with pytest.raises(bf.ConvergenceError, match=r"jumps by more than 1 rad just after load factor 0\.3"):
        bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start), turned]))


def test_snap_takes_two_words_only():
    _, model = toggle(1.0)
    with pytest.raises(bf.InputError, match='snap must be "error" or "jump"'):
        bf.solve_static(model, snap="yes")


def test_a_structure_that_comes_to_rest_nowhere_says_so():
    """A bar of St. Venant-Kirchhoff material carries at most E A / (3 sqrt 3) and is crushed beyond."""
    material = bf.Material(2e11, 0.0, 7800.0)
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.ANCF(), bf.Rectangle(0.1, 0.1), material)
    supports = [bf.Clamp(bar.start), bf.Prescribed(bar.end, uy=0.0, rotation=0.0)]
    push = bf.PointForce(bar.end, (-1.25 * 2e11 * 0.01 / (3.0 * np.sqrt(3.0)), 0.0))
    with pytest.raises(bf.LimitPointError, match="no state of rest was found beyond it") as caught:
        bf.solve_static(bf.Model([bar], supports, [push]), snap="jump")
    assert caught.value.load_factor == pytest.approx(0.8, rel=1e-6)


def test_standing_loads_that_had_to_grow_leave_the_state_as_unstable_as_it_is():
    """A wavy cantilever that one step does not reach, and beside it a column under twice its buckling load."""
    steel, section = bf.Material(2e11, 0.3, 7800.0), bf.Rectangle(0.01, 0.01)
    stiffness = 2e11 * section.second_moment
    wavy = bf.Beam(bf.Parametric(lambda u: (u, 0.3 * np.sin(3 * u)), 0, 1.5), 40, bf.ShearRigid(), section, steel)
    column = bf.Beam(bf.Line((5, 0), (6, 0)), 4, bf.ShearRigid(), section, steel)
    loads = [
        bf.PointForce(wavy.end, tuple(stiffness * np.array([-2.0, 3.0])), scale=False),
        bf.PointForce(column.end, (-0.5 * np.pi**2 * stiffness, 0.0), scale=False),
    ]
    model = bf.Model([wavy, column], [bf.Clamp(wavy.start), bf.Clamp(column.start)], loads)
    with pytest.warns(bf.UnstableWarning):
        solution = bf.solve_static(model)
    assert solution.position(wavy.end)[0] == pytest.approx([-0.00684, 1.71669], abs=2e-5)
    assert not solution.stable.any()


def test_a_structure_does_not_come_to_rest_where_it_is_unstable():
    """Beside a frame that snaps at a third of its load, a column is past its buckling load by then, and bent."""
    _, frame = toggle(95.2)
    column = bf.Beam(bf.Line((3, 0), (4, 0)), 4, bf.CRBF(3), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    critical = np.pi**2 / 4.0 * 2e11 * 0.01**4 / 12.0
    model = bf.Model(
        [*frame.beams, column],
        [*frame.supports, bf.Clamp(column.start)],
        [*frame.loads, bf.PointForce(column.end, (-5.0 * critical, 0.0))],
        frame.joints,
    )
    solution = bf.solve_static(model, 10, snap="jump")
    assert solution.stable.all()
    bent = np.abs(solution.displacement(column.end)[:, 1]) > 1e-3
    straight = int(np.argmax(bent))
    assert solution.at[straight - 1] == pytest.approx(0.2, rel=1e-4)
    assert bent[straight:].all()


def test_rest_is_an_equilibrium_that_is_found_stable_and_close_to_where_the_motion_ends(monkeypatch):
    """Solves that fail, end in an unstable state or far away are not taken; the motion goes on, longer each time."""
    _, model = toggle(1.0)
    system = System(model, static=True)
    limit = np.append(system.reference, 0.3)
    beyond = limit.copy()
    beyond[system.free_dofs] += 1e-4 * system.scale[system.free_dofs]
    far = system.reference + 0.5 * system.scale
    ends = iter([(Termination.EXHAUSTED, 0, None), (Termination.CONVERGED, 1, None), (Termination.CONVERGED, 0, far)])
    found = NewtonResult(system.reference, 3, Termination.CONVERGED)

    def solved(system, p, *given, **named):
        end = next(ends, None)
        return found if end is None else NewtonResult(p if end[2] is None else end[2], 3, end[0], end[1])

    monkeypatch.setattr(snap, "_step", lambda system, p, load_factor, time: (p + 1e-5 * system.scale, 1))
    monkeypatch.setattr(snap, "solve_equilibrium", solved)
    rest = snap.rest_state(system, limit, beyond, bf.Newton())
    assert rest.ended is Termination.CONVERGED
    assert rest.state is found.state
    tries, steps = 4, 1 + 2 + 4 + 8
    assert rest.iterations == 3 * tries + steps


def test_a_motion_whose_steps_lead_nowhere_ends(monkeypatch):
    """Where no step is taken they are halved until they are a billionth of the first, not 2000 times."""
    _, model = toggle(1.0)
    system, steps = System(model, static=True), []
    limit = np.append(system.reference, 0.3)
    beyond = limit.copy()
    beyond[system.free_dofs] += 1e-4 * system.scale[system.free_dofs]
    monkeypatch.setattr(snap, "_step", lambda system, p, load_factor, time: (steps.append(time), (None, 1))[1])
    assert snap.rest_state(system, limit, beyond, bf.Newton()).ended is Termination.EXHAUSTED
    assert len(steps) == 30
    assert steps[0] / steps[-1] == pytest.approx(2.0**29)


@pytest.mark.parametrize(("load", "steps"), [(100.0, 10), (900.0, 1), (900.0, 2), (3e3, 1), (1e4, 1)])
def test_a_load_step_over_a_limit_point_is_refused_whatever_its_length(load, steps):
    """The toggle gives way at 31.74 N; a long step from below would converge in its other valley."""
    _, model = toggle(load)
    with pytest.raises(bf.LimitPointError) as caught:
        bf.solve_static(model, steps=steps)
    assert caught.value.load_factor * load == pytest.approx(31.7407, rel=1e-4)


@pytest.mark.parametrize("load", [11.0, 1e2, 1e4])
def test_the_limit_point_of_a_deep_arch_is_found_from_any_load(load):
    """A clamped half ring under a force at its crown, in multiples of E I / R^2; single steps go over it."""
    section, steel = bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0)
    ring = bf.Beam(bf.Arc((0, 0), 1.0, 0, np.pi), 20, bf.CRBF(3), section, steel)
    crown = ring.at(0.5)
    force = -load * 2e11 * section.second_moment
    model = bf.Model([ring], [bf.Clamp(ring.start), bf.Clamp(ring.end)], [bf.PointForce(crown, (0.0, force))])
    traced = bf.trace_equilibrium(model, until=lambda state: state.displacement(crown)[1] < -0.6)
    with pytest.raises(bf.LimitPointError) as caught:
        bf.solve_static(model)
    assert caught.value.load_factor == pytest.approx(traced.limit_points[0].load_factor, rel=1e-6)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:1 of:beamfem.UnstableWarning")  # a row within 1e-9 of the point where paths meet
@pytest.mark.parametrize("side", [1.0, -1.0])
@mostly_slow("steps", [1, 2, 5, 10, 50], quick=(1,))
def test_a_buckled_column_straightens_when_it_is_unloaded(steps, side):
    """The load factor has its largest value on the buckled branch where the straight column takes over."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 16, bf.CRBF(3), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    euler = np.pi**2 * 2e11 * 1e-8 / 12 / 4
    push = bf.PointForce(beam.end, (-1.3 * euler, 0.0), amplitude=lambda factor: 1.0 - factor)
    aside = bf.PointForce(beam.end, (0.0, 0.2 * side * euler), amplitude=lambda factor: max(0.0, 0.5 - 10.0 * factor))
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [push, aside]), steps=steps)
    lateral = side * solution.displacement(beam.end)[:, 1]
    straight = solution.at > 1.0 - 1.0 / 1.3 + 1e-4
    assert lateral[solution.at < 0.2].min() > 0.1
    assert straight.any()
    assert np.abs(lateral[straight]).max() < 1e-9
    assert solution.stability[straight].all()


def test_a_load_factor_that_goes_against_both_tangents_is_no_path():
    """Seed 2981 of the random models: round-off of a stiff frame on soft springs led the path backwards."""
    _, model = toggle(1.0)
    system = system_of(model, static=True)
    line, start = begin(system, system.reference, 0.0, bf.Newton())
    end = take_step(line, start, 1e-3).segment.after
    assert not Segment(line, start, end).limit_points()
    lower = replace(end, y=np.append(end.y[:-1], start.y[-1] - 0.1 * (end.y[-1] - start.y[-1])))
    with pytest.raises(SegmentLostError, match="another way than the tangents"):
        Segment(line, start, lower).limit_points()


@mostly_slow("elements", [1, 2, 3, 4, 5, 8], quick=(0, 4))
def test_a_bar_that_softens_everywhere_at_once_has_a_limit_point(elements):
    """E A / (3 sqrt 3), where every part may go on or back, so that no step leads over it but by round-off."""
    beam = bf.Beam(
        bf.Line((0, 0), (1, 0)), elements, bf.ANCF(), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.0, 7800.0)
    )
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-5e6, 0.0))])
    with pytest.raises(bf.LimitPointError, match=r"a limit point at load factor 0\.7698") as caught:
        bf.solve_static(model)
    assert caught.value.load_factor * 5e6 == pytest.approx(2e7 / (3.0 * np.sqrt(3.0)), rel=1e-7)
