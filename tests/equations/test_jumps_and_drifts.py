"""Loads far beyond what bears them: cycles of jumps, drifts on soft springs, windings without end, valleys."""

import numpy as np
import pytest
from scipy.linalg import eigh
from test_snap import toggle

import beamfem as bf
from beamfem.equations.equations import INERTIA, STATICS, linearise
from beamfem.equations.system import system_of
from beamfem.solve.modes.pencil import UNROTATED
from beamfem.solve.statics import load_path as snap

SECTION, STEEL = bf.Rectangle(0.05, 0.05), bf.Material(2e11, 0.3, 7800.0)
BENDING = 2e11 * SECTION.second_moment


@pytest.mark.parametrize("element", [bf.CRBF(2), bf.ANCF()], ids=lambda element: element.name)
def test_a_pendulum_that_its_follower_force_turns_for_ever_has_no_state_of_rest(element):
    """F L = W L sin(angle) has a solution up to F = W; beyond it the bar turns and turns, slowest at 90 degrees."""
    weight = 1e-4 * BENDING
    bar = bf.Beam(bf.Line((0, 0), (0, -1)), 2, element, SECTION, STEEL)
    hanging = bf.PointForce(bar.end, (0.0, -weight), scale=False)
    turning = bf.PointForce(bar.end, (2.0 * weight, 0.0), follower=True)
    faint = bf.Spring(bar.start, rotational=1e-9 * weight)  # statics want a bar that is held
    model = bf.Model([bar], [bf.Pin(bar.start), faint], [hanging, turning])
    with pytest.raises(bf.LimitPointError, match="comes back to it each time") as caught:
        bf.solve_static(model, snap="jump")
    assert caught.value.load_factor == pytest.approx(0.5, rel=1e-3)


def test_a_beam_that_drifts_on_soft_springs_goes_as_far_as_its_load_grows():
    """u = F / k, ten thousand lengths away; steps of half a length would be 20,000."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), SECTION, STEEL)
    stiffness = 1e-6 * BENDING
    supports = [bf.Spring(beam.at(0.5), (stiffness, stiffness)), bf.Prescribed(beam.at(0.5), rotation=0.0)]
    force = 1e4 * stiffness * np.array([0.6, 0.8])
    model = bf.Model([beam], supports, [bf.PointForce(beam.at(0.5), tuple(force))])
    path = bf.trace_equilibrium(model, until=1.0)
    assert len(path) < 40
    assert path.displacement(beam.at(0.5))[-1] == pytest.approx(force / stiffness, rel=1e-9)


def test_a_moment_that_would_wind_a_beam_150_000_times_is_said_to_be_out_of_reach():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, bf.CRBF(3), SECTION, STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, 1e6 * BENDING)])
    with pytest.raises(bf.ConvergenceError, match="at that pace load factor 1 is out of reach"):
        bf.solve_static(model, snap="jump")


def test_a_step_of_a_jump_so_long_that_it_could_end_in_another_valley_is_refused():
    """K + M / dt is positive up to dt = 1 / |lambda|, with the only negative lambda of K phi = lambda M phi."""
    top, model = toggle(1.0)
    path = bf.trace_equilibrium(model, until=lambda state: state.displacement(top.end)[1] < -0.05)
    unstable = [number for number in range(len(path)) if not path.stable[number]]
    row = unstable[len(unstable) // 2]
    system = system_of(model, static=True)
    p, rest, at = path.p[row], np.zeros(model.size), float(path.at[row])
    stiffness, mass = (
        linearise(system, p, rest, rest, at, of)[1].sparse(UNROTATED).toarray() for of in (STATICS, INERTIA)
    )
    lowest = float(eigh(stiffness, mass, eigvals_only=True)[0])
    assert lowest < 0.0
    assert snap._step(system, p, at, 2.0 / abs(lowest))[0] is None
    assert snap._step(system, p, at, 0.5 / abs(lowest))[0] is not None


def test_a_standing_load_that_hides_in_the_round_off_of_stiff_rows_is_no_reference_to_vibrate_about():
    """P L^3 / (3 E I) is a fifth of the length, each row leaves less than the last digits of E A do."""
    section = bf.Rectangle(1e-7, 1e-7)
    beam = bf.Beam(bf.Line((0, 0), (1, 0.3)), 4, bf.CRBF(2), section, STEEL)
    force = 0.6 * 2e11 * section.second_moment
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -force), scale=False)])
    with pytest.raises(bf.InputError, match="is not in equilibrium"):
        bf.solve_modes(model, 2)
