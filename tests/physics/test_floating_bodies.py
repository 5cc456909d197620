"""Reduced models as bodies in a floating frame, beside rigid-body equations, closed forms and the full models."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import beamfem as bf
from beamfem.testing import check_connector

SQUARE, G = bf.Rectangle(0.02, 0.02), 9.81
GRAVITY = bf.Gravity((0, -G))


def rod(modulus, end=(1.0, 0.0), start=(0.0, 0.0), damping=None):
    return bf.Beam(bf.Line(start, end), 8, bf.CRBF(3), SQUARE, bf.Material(modulus, 0.3, 7850.0), damping=damping)


def floating(beam, modes=2):
    return bf.reduce(bf.Model([beam]), [beam.start, beam.end], modes).floating_body()


def swings(modulus, duration=1.0, step=1e-3):
    """Return the tip of the reduced and of the full pendulum."""
    beam = rod(modulus)
    body = floating(beam)
    small = bf.Model([], [bf.Pin(body.points[0])], [GRAVITY], masses=[body])
    full = bf.Model([beam], [bf.Pin(beam.start)], [GRAVITY])
    motions = [bf.simulate(model, duration, step=step) for model in (small, full)]
    return motions[0].position(body.points[1]), motions[1].position(beam.end)


@pytest.mark.slow
def test_energies_and_forces_belong_together():
    check_connector(floating(rod(2.1e11), 2))
    check_connector(floating(rod(2.1e11, damping=bf.Rayleigh(stiffness=1e-3)), 2))


def test_a_stiff_pendulum_meets_the_rigid_body_equation():
    body = floating(rod(2.1e15), 2)
    model = bf.Model([], [bf.Pin(body.points[0])], [GRAVITY], masses=[body])
    motion = bf.simulate(model, 1.0, step=1e-3)
    rate = 1.5 * G / (1.0 + SQUARE.height**2 / 4.0)  # J = m (L^2 / 3 + h^2 / 12)
    settings = {"t_eval": motion.time, "rtol": 1e-12, "atol": 1e-12}
    exact = solve_ivp(lambda t, y: (y[1], -rate * np.cos(y[0])), (0.0, 1.0), [0.0, 0.0], **settings)
    assert motion.rotation(body.points[0]) == pytest.approx(exact.y[0], abs=2e-5)
    fine = bf.simulate(model, 1.0, step=2.5e-4, save_every=4)
    assert fine.rotation(body.points[0]) == pytest.approx(exact.y[0], abs=2e-6)


def test_pendulums_agree_with_the_full_model_if_they_are_stiff_and_fail_if_they_are_soft():
    far = [np.abs(np.subtract(*swings(modulus))).max() for modulus in (2.1e13, 2.1e11, 2.1e9)]
    assert far[0] < 1e-6
    assert far[1] < 2e-5
    assert 1e-3 < far[2] < 2e-2
    soft, full = swings(2.1e8)
    assert np.abs(soft - full).max() > 0.5  # no stress stiffens it against the bending of its rotation


def test_free_flight_keeps_energy_and_momenta():
    """Vibrating, turning and flying; the impulse is that of the push, to the error of its steps."""
    body = floating(rod(2.1e10, (0.8, 0.6)), 2)
    start, end = body.points
    push = bf.PointForce(end, (-300.0, 900.0), amplitude=lambda time: 1.0 if time < 0.01 else 0.0)
    thrown = bf.simulate(bf.Model([], [], [push], masses=[body]), 0.01, step=2.5e-4)
    motion = bf.simulate(bf.Model([], masses=[body]), 0.03, step=2.5e-5, start=thrown, integrator=bf.Gauss(stages=4))
    energy, total = motion.energy(), motion.energy().total
    assert np.ptp(energy.potential) > 0.1 * total[0]
    assert np.ptp(motion.rotation(start)) > 0.5
    assert np.ptp(total) < 1e-9 * total[0]
    linear, angular = motion.linear_momentum(), motion.angular_momentum()
    assert np.ptp(linear, axis=0) == pytest.approx([0.0, 0.0], abs=1e-9 * np.hypot(*linear[0]))
    assert np.ptp(angular) < 1e-9 * abs(angular[0])
    assert linear[0] == pytest.approx([-3.0, 9.0], rel=3e-2)


def test_frequencies_of_a_spinning_cantilever_are_those_without_stress():
    """Its rotation softens it, w^2 = w0^2 - speed^2; with the stress of its rotation it is 3.7435 at 3."""
    beam = rod(2.1e11)
    root, _ = (body := floating(beam)).points
    unit = np.sqrt(SQUARE.rigidity(beam.material).bending / SQUARE.inertia(beam.material).mass)
    rates = []
    for speed in (0.0, 1.0, 2.0, 3.0):
        model = bf.Model([], [bf.Clamp(root)], masses=[body], frame=bf.RotatingFrame(speed * unit))
        rates.append(2.0 * np.pi * bf.solve_modes(model, 1, about=bf.solve_static(model)).frequencies[0] / unit)
    assert rates == pytest.approx(np.sqrt(rates[0] ** 2 - np.arange(4) ** 2), rel=1e-4)
    assert rates[0] == pytest.approx(3.516, rel=1e-3)


def test_rotation_stretches_it_as_the_full_model():
    beam = rod(2.1e11)
    body = floating(beam)
    frame = bf.RotatingFrame(50.0)
    small = bf.Model([], [bf.Clamp(body.points[0])], masses=[body], frame=frame)
    tip = bf.solve_static(small).displacement(body.points[1])[-1, 0]
    assert tip == pytest.approx(7850.0 * 50.0**2 / (3.0 * 2.1e11), rel=2e-3)


def test_a_slider_crank_has_the_torque_of_the_full_model():
    crank, beam = rod(2.1e11, (0.15, 0.0)), rod(2.1e11, (0.55, 0.0), start=(0.15, 0.0))
    body = floating(beam)
    torques = []
    for beams, start, end, masses in (
        ([crank], *body.points, [body]),
        ([crank, beam], beam.start, beam.end, []),
    ):
        motor = bf.Motor(crank.start, speed=lambda time: 40.0 * np.sin(np.pi * min(time, 0.1) / 0.2) ** 2)
        supports, slider = [bf.Pin(crank.start), bf.Roller(end)], bf.PointMass(end, 0.5)
        hinge = bf.Hinge(crank.end, start)
        model = bf.Model(beams, supports, [motor], [hinge], masses=[*masses, slider])
        motion = bf.simulate(model, 0.3, step=1e-3)
        torques.append(motion.joint_force(motor)[:, 2])
    small, full = torques
    assert np.abs(small - full).max() < 2e-3 * np.abs(full).max()


@pytest.mark.slow
def test_three_interfaces_masses_and_offsets_are_reduced_with_it():
    """A bent frame with a mass and an eccentric body, held at its first or at its last interface."""
    steel = bf.Material(2.1e11, 0.3, 7850.0)
    low, high = (
        bf.Beam(bf.Line(*ends), 4, bf.CRBF(3), SQUARE, steel) for ends in (((0, 0), (1, 0)), ((1, 0), (1.2, 0.7)))
    )
    joints, masses = (
        [bf.Rigid(low.end, high.start)],
        [bf.PointMass(low.at(0.5), 1.0), bf.RigidBody(high.at(0.5), 2.0, 0.1, (0.1, 0.2))],
    )
    whole = bf.Model([low, high], [], joints=joints, masses=masses)
    body = bf.reduce(whole, [low.start, high.end, low.end], 4).floating_body()
    assert body.mass == pytest.approx(whole.mass, rel=1e-12)
    for place, end in ((low.start, body.points[0]), (high.end, body.points[1])):
        full = bf.Model([low, high], [bf.Clamp(place)], joints=joints, masses=masses)
        small = bf.Model([], [bf.Clamp(end)], masses=[body])
        assert bf.solve_modes(small, 3).frequencies == pytest.approx(bf.solve_modes(full, 3).frequencies, rel=2e-3)
        hung, by_hand = (bf.solve_static(model.with_loads([GRAVITY])) for model in (small, full))
        assert hung.reaction(end)[-1] == pytest.approx(by_hand.reaction(place)[-1], rel=1e-4, abs=1e-6)
        moved = by_hand.displacement(low.end)[-1]  # 4e-5 m of it are of second order
        assert hung.displacement(body.points[2])[-1] == pytest.approx(moved, rel=5e-3, abs=5e-5)


def test_a_spinning_eccentric_body_bends_its_arm_outwards():
    """Half a turn a frame: the centrifugal force of the body acts at its centre of mass."""
    beam = rod(2.1e11)
    part = bf.RigidBody(beam.end, 2.0, 0.1, (0.1, 0.2))
    body = bf.reduce(bf.Model([beam], masses=[part]), [beam.start, beam.end], 2).floating_body()
    frame = bf.RotatingFrame(2.0)
    small = bf.Model([], [bf.Clamp(body.points[0])], masses=[body], frame=frame)
    full = bf.Model([beam], [bf.Clamp(beam.start)], masses=[part], frame=frame)
    moved = bf.solve_static(full).displacement(beam.end)[-1]
    assert bf.solve_static(small).displacement(body.points[1])[-1, 1] == pytest.approx(moved[1], rel=2e-2)
    assert abs(moved[1]) > 1e-6


@pytest.mark.slow
def test_damping_of_the_beam_is_that_of_its_vibrations_alone():
    damped = floating(rod(2.1e11, damping=bf.Rayleigh(stiffness=1e-3)))
    beam = rod(2.1e11, damping=bf.Rayleigh(stiffness=1e-3))
    small = bf.linearise(bf.Model([], [bf.Clamp(damped.points[0])], masses=[damped])).modes(2)
    full = bf.linearise(bf.Model([beam], [bf.Clamp(beam.start)])).modes(2)
    assert small.ratios == pytest.approx(full.ratios, rel=2e-3)
    spin = bf.RigidVelocity(angular=3.0)
    turning = bf.simulate(bf.Model([], [bf.Pin(damped.points[0])], masses=[damped]), 0.2, step=1e-3, velocity=spin)
    assert turning.energy().dissipated[-1] < 1e-4 * turning.energy().total[0]


def test_it_is_saved_loaded_and_drawn(tmp_path):
    body = floating(rod(2.1e11))
    model = bf.Model([], [bf.Clamp(body.points[0])], [GRAVITY], masses=[body])
    solution = bf.solve_static(model)
    solution.save(tmp_path / "hung.h5")
    loaded = bf.load(tmp_path / "hung.h5")
    again = bf.solve_static(loaded.model)
    assert np.array_equal(loaded.p, solution.p)
    assert again.p == pytest.approx(solution.p, rel=1e-12, abs=1e-15)
    solution.plot(tmp_path / "hung.png")
    assert bf.linearise(model).names[-1] == "FloatingBody, mode 1"


def test_what_is_no_free_body_is_refused():
    beam = rod(2.1e11)
    with pytest.raises(bf.InputError, match="two interfaces or more"):
        bf.linearise(bf.Model([beam])).floating_body()
    with pytest.raises(bf.InputError, match="must be free"):
        bf.reduce(bf.Model([beam], [bf.Pin(beam.start)]), [beam.start, beam.end], 2).floating_body()
    spring = bf.SpringDamper(beam.end, (1.0, 1.0), 1e3)
    with pytest.raises(bf.InputError, match="must be free"):
        bf.reduce(bf.Model([beam], connectors=[spring]), [beam.start, beam.end], 2).floating_body()
    with pytest.raises(bf.InputError, match="loads do not act"):
        bf.reduce(bf.Model([beam], loads=[GRAVITY]), [beam.start, beam.end], 2).floating_body()
    gradients = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.ANCF(), SQUARE, bf.Material(2.1e11, 0.3, 7850.0))
    with pytest.raises(bf.InputError, match="rotations as coordinates"):
        bf.reduce(bf.Model([gradients]), [gradients.start, gradients.end], 2).floating_body()


def test_points_of_a_body_that_is_not_in_the_model_and_between_its_interfaces_are_refused():
    """Without the body, its interfaces are ends of beams without stiffness."""
    body, other = (floating(rod(2.1e11), 0) for _ in range(2))
    clamp, force = bf.Clamp(body.points[0]), bf.PointForce(body.points[1], (0.0, -1.0))
    for masses in ([], [other], [bf.PointMass(body.points[1], 1.0)]):
        with pytest.raises(bf.InputError, match="a floating body that is not in the model; add it to masses"):
            bf.Model([], [clamp], [force], masses=masses)
    model = bf.Model([], [clamp], [force], masses=[body])
    with pytest.raises(bf.InputError, match="a floating body that is not in the model; add it to masses"):
        model.with_(masses=[])
    with pytest.raises(bf.InputError, match="between interfaces of a floating body"):
        model.with_loads([bf.PointForce(body.points[0].beam.at(0.5), (0.0, -1.0))])
