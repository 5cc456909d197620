"""Dynamics against the converged continuum pendulum, conservation laws, the order of the integrator."""

import numpy as np
import pytest
from conftest import beam

import beamfem as bf

SECTION = bf.Section(area=1.6e-3, second_moment=8.533e-6)
RUBBER = bf.Material(0.7e6, 0.3, 5540.0)


def pendulum(element, elements, step, duration, rho_inf=0.9):
    one = bf.Beam(bf.Line((0, 0), (1.2, 0)), elements, element, SECTION, RUBBER)
    model = bf.Model([one], [bf.Pin(one.start)], [bf.Gravity((0, -9.81))])
    return one, bf.simulate(model, duration, step, bf.GeneralizedAlpha(rho_inf))


def test_ancf_pendulum_converges_to_the_continuum():
    """Case 11.vi, section as printed: spectral elements 64 x 6, tip over the first second to 1e-4 m."""
    times = np.arange(1, 11) * 0.1
    tip = np.array(
        [
            [1.199997545, -0.049061737],
            [1.191018909, -0.192738897],
            [1.115561318, -0.518803837],
            [0.827965381, -0.986624762],
            [0.323869899, -1.287022964],
            [-0.172301648, -1.295736050],
            [-0.614265571, -1.133844042],
            [-1.032867760, -0.765407117],
            [-1.184816935, -0.324208523],
            [-1.151251076, -0.026265715],
        ]
    )
    step = 5e-4
    one, solution = pendulum(bf.ANCF(), 48, step, 1.0, rho_inf=1.0)
    found = solution.position(one.end)[np.round(times / step).astype(int)]
    assert np.abs(found - tip).max() < 1e-4


def test_crbf_pendulums_agree_with_each_other_and_not_with_ancf():
    """Rotations forbid the thickness to breathe: physics, not error."""
    tips = []
    for element in (bf.ANCFCRBF(), bf.BilinearCRBF()):
        one, solution = pendulum(element, 100, 1e-3, 0.5)
        tips.append(solution.position(one.end)[-1])
    assert np.abs(tips[0] - tips[1]).max() < 1e-4
    assert tips[0] == pytest.approx([0.3013, -1.2747], abs=1e-4)


@pytest.mark.parametrize("rho_inf", [0.5, 0.9, 1.0])
@pytest.mark.parametrize("make", [bf.ANCF, bf.ANCFCRBF, bf.BilinearCRBF])
def test_generalized_alpha_is_of_second_order(make, rho_inf):
    results = []
    for step in (1e-3, 5e-4, 2.5e-4, 1.25e-4):
        one, solution = pendulum(make(), 4, step, 0.2, rho_inf)
        results.append(solution.position(one.end)[-1])
    differences = np.linalg.norm(np.diff(results, axis=0), axis=1)
    orders = np.log2(differences[:-1] / differences[1:])
    assert np.all((orders > 1.8) & (orders < 2.2)), orders


def test_free_flight_keeps_linear_momentum_and_angular_with_the_step(element):
    one = beam(element)
    drift = []
    for step in (2e-3, 1e-3):
        velocity = bf.RigidVelocity((1.0, 2.0), angular=3.0, about=(0.2, 0.1))
        solution = bf.simulate(bf.Model([one]), 0.2, step, velocity=velocity)
        momentum = solution.linear_momentum()
        assert np.abs(momentum - momentum[0]).max() <= 1e-12 * np.linalg.norm(momentum[0])
        angular = solution.angular_momentum()
        drift.append(np.abs(angular - angular[0]).max() / abs(angular[0]))
    assert drift[0] < 1e-4
    assert 1.7 < np.log2(drift[0] / drift[1]) < 2.5 or drift[1] < 1e-12


@pytest.mark.slow
@pytest.mark.parametrize("rho_inf", [0.9, 1.0])
def test_free_flight_keeps_linear_momentum_over_a_hundred_thousand_steps(element, rho_inf):
    model, velocity = bf.Model([beam(element)]), bf.RigidVelocity((1.0, 2.0), angular=3.0, about=(0.2, 0.1))
    motion = bf.simulate(model, 100.0, 1e-3, bf.GeneralizedAlpha(rho_inf), velocity=velocity, save_every=100)
    momentum = motion.linear_momentum()
    assert np.abs(momentum - momentum[0]).max() <= 1e-9 * np.linalg.norm(momentum[0])


def test_energy_of_the_pendulum_is_kept(element):
    _, solution = pendulum(element, 6, 1e-3, 0.3)
    energy = solution.energy()
    assert np.ptp(energy.total) < 5e-5 * energy.kinetic.max()


def test_a_static_state_stays_at_rest(element):
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 4, element, bf.Rectangle(0.1, 0.1), bf.Material(2e8, 0.3, 1000.0))
    model = bf.Model([one], [bf.Clamp(one.start)], [bf.Gravity((0, -9.81))])
    static = bf.solve_static(model)
    solution = bf.simulate(model, 0.1, 1e-3, start=static[-1])
    assert np.abs(solution.position(one.end) - static.position(one.end)[-1]).max() < 1e-9


def test_prescribed_motion_is_followed(element):
    one = beam(element, end=(1.0, 0.0))
    supports = [bf.Prescribed(one.start, ux=0.0, uy=lambda t: 0.01 * np.sin(20 * t), rotation=0.0)]
    solution = bf.simulate(bf.Model([one], supports), 0.1, 1e-3)
    assert solution.displacement(one.start)[:, 1] == pytest.approx(0.01 * np.sin(20 * solution.time), abs=1e-14)
    assert solution.velocity(one.start)[:, 1] == pytest.approx(0.2 * np.cos(20 * solution.time), abs=1e-8)


def test_saving_every_tenth_step_keeps_the_same_states(element):
    one = beam(element)
    model = bf.Model([one], [bf.Pin(one.start)], [bf.Gravity((0, -9.81))])
    every, tenth = bf.simulate(model, 0.1, 1e-3), bf.simulate(model, 0.1, 1e-3, save_every=10)
    assert len(tenth) == 11
    assert np.array_equal(every.p[::10], tenth.p)


def test_a_step_that_fails_hands_back_the_states_before():
    one = beam(bf.ANCF())
    model = bf.Model([one], loads=[bf.PointForce(one.end, (1e10, 0.0), amplitude=lambda t: float(t > 0.05))])
    with pytest.raises(bf.ConvergenceError, match="did not converge") as caught:
        bf.simulate(model, 0.1, 1e-2)
    assert caught.value.solution.time[-1] == pytest.approx(0.05)


def test_an_inclined_roller_holds_the_initial_velocity_too(element):
    """Found in review: the point left its plane with the velocity it was given."""
    one = beam(element)
    model = bf.Model([one], [bf.Roller(one.start, (1, 1))])
    solution = bf.simulate(model, 0.05, 1e-3, velocity=bf.RigidVelocity((1.0, 0.0)))
    assert np.abs(solution.displacement(one.start) @ [1.0, 1.0]).max() < 1e-13


def test_the_last_state_is_kept_whatever_save_every_is():
    """Found in review: the end was lost where save_every did not divide the steps."""
    model = bf.Model([beam(bf.ANCF())], loads=[bf.Gravity((0, -9.81))])
    assert bf.simulate(model, 0.1, 0.01, save_every=4).time == pytest.approx([0.0, 0.04, 0.08, 0.1])
    whole = bf.simulate(model, 0.1, 0.01)
    for every in (3, 4, 100):
        assert np.array_equal(bf.simulate(model, 0.1, 0.01, save_every=every).p[-1], whole.p[-1])


def test_a_bent_beam_is_released_from_its_clamp(element):
    """A clamp may carry its node by an angle; without it the same state is carried by gradients."""
    one = beam(element, 3, (0.0, 0.0), (1.0, 0.5))
    bent = bf.solve_static(bf.Model([one], [bf.Clamp(one.start)], [bf.PointForce(one.end, (0.0, 0.5))]))
    free = bf.Model([one], [bf.Pin(one.start)])
    released = bf.simulate(free, 2e-5, 1e-5, start=bent[-1])
    for fraction in (0.0, 0.3, 0.5, 1.0):
        point = one.at(fraction)
        assert released.position(point)[0] == pytest.approx(bent.position(point)[-1], abs=1e-12)
        assert released.rotation(point)[0] == pytest.approx(bent.rotation(point)[-1], abs=1e-12)
    assert released.energy().strain[0] == pytest.approx(bent.energy().strain[-1], rel=1e-9)


@pytest.mark.parametrize("element", [bf.ShearRigid(), bf.ShearRigid(stretchable=False), bf.CRBF(2), bf.ANCF()])
def test_the_drift_of_a_spinning_beam_falls_with_the_square_of_small_steps(element):
    """An iteration that keeps its tangent must not leave an error behind that adds up over many small steps."""
    drifts = []
    for step in (1e-4, 1e-5):
        one = beam(element, 2, (-0.5, 0.0), (0.5, 0.0))
        spin = bf.RigidVelocity((0.0, 0.0), angular=10.0)
        flight = bf.simulate(bf.Model([one]), 0.02, step, velocity=spin, save_every=round(1e-3 / step))
        energy = flight.energy().total
        drifts.append(np.ptp(energy) / energy[0])
    assert drifts[1] / drifts[0] == pytest.approx(0.01, rel=2e-4)  # what is of fourth order


@pytest.mark.parametrize("kind", ["band", "sparse"])
def test_parts_that_ring_within_a_step_do_not_end_it(kind, widest_band):
    """A sudden tip moment, 0.05 E I / L, on few elements of high order turns the tip by 0.04: a tenth of it, a tenth.

    The accelerations of before, far above those of bending, put a step far off its end; not those of a tenth. What
    is not linear in the moment is of the size of the rotation squared.
    """
    if kind == "sparse":
        widest_band(-1)
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(4), bf.Rectangle(0.02, 0.0625), bf.Material(1e9, 0.3, 1000.0))
    tips = []
    for moment in (-20.345, -2.0345):
        motion = bf.simulate(bf.Model([bar], [bf.Clamp(bar.start)], [bf.PointMoment(bar.end, moment)]), 0.02, 1e-3)
        tips.append(motion.displacement(bar.end)[-1, 1] / moment)
    assert tips[0] == pytest.approx(tips[1], rel=3e-4)
