"""Motors against rigid-body equations, supports that move, and the torques that they need."""

from dataclasses import dataclass

import numpy as np
import pytest
from rigid_rods import AREA, DENSITY, DEPTH, double_pendulum
from scipy.integrate import solve_ivp

import beamfem as bf

SQUARE, STIFF = bf.Rectangle(0.01, DEPTH), bf.Material(2.1e14, 0.3, DENSITY)
SOFT = bf.Material(2.1e9, 0.3, DENSITY)
CRANK, ROD, BLOCK = 0.15, 0.3, 0.2


def line(start, end, material=STIFF, elements=2):
    return bf.Beam(bf.Line(start, end), elements, bf.CRBF(3), SQUARE, material)


def swing(time, ramp=1.0, speed=4.0):
    """Angle of a shaft that speeds up smoothly, and its first two derivatives."""
    turn, early = 2 * np.pi / ramp, np.minimum(time, ramp)
    gained = speed / ramp * (early**2 / 2 + (np.cos(turn * early) - 1) / turn**2)
    rate = speed / ramp * (early - np.sin(turn * early) / turn)
    return gained + speed * (time - early), rate, speed / ramp * (1 - np.cos(turn * early))


def angle(time):
    return float(swing(time)[0])


def slider_crank(*loads, material=STIFF):
    crank, rod = line((0, 0), (CRANK, 0), material), line((CRANK, 0), (CRANK + ROD, 0), material)
    supports, masses = [bf.Pin(crank.start), bf.Roller(rod.end)], [bf.PointMass(rod.end, BLOCK)]
    return bf.Model([crank, rod], supports, loads, [bf.Hinge(crank.end, rod.start)], masses=masses)


def rigid_slider_crank(time):
    """Position of the slider and torque of the motor, by the principle of virtual power."""
    (phi, rate, second), (a, b) = swing(time), (CRANK, ROD)
    mass_a, mass_b, height = DENSITY * AREA * a, DENSITY * AREA * b, DEPTH**2 / 12
    psi = -np.arcsin(a * np.sin(phi) / b)
    ratio = -a * np.cos(phi) / (b * np.cos(psi))
    turning = ratio * rate
    change = (a * np.sin(phi) * rate**2 - a * np.cos(phi) * second + b * np.sin(psi) * turning**2) / (b * np.cos(psi))

    def along(own, t):
        return own * np.array([np.cos(t), np.sin(t)])

    def across(own, t):
        return own * np.array([-np.sin(t), np.cos(t)])

    def virtual(mass, share):
        push = across(a, phi) * second - along(a, phi) * rate**2
        push = push + across(share * b, psi) * change - along(share * b, psi) * turning**2
        return mass * (push * (across(a, phi) + across(share * b, psi) * ratio)).sum(axis=0)

    torque = mass_a * (a**2 / 3 + height) * second + virtual(mass_b, 0.5) + virtual(BLOCK, 1.0)
    torque = torque + mass_b * (b**2 / 12 + height) * change * ratio
    return a * np.cos(phi) + b * np.cos(psi), torque


def test_slider_crank_of_stiff_beams_is_that_of_rigid_bars():
    model = slider_crank()
    crank, rod = model.beams
    motor = bf.Motor(crank.start, angle=angle)
    motion = bf.simulate(model.with_loads([motor]), 2.0, 2e-4, save_every=100, integrator=bf.GeneralizedAlpha(0.0))
    slider, torque = rigid_slider_crank(motion.time)
    assert motion.rotation(crank.start) == pytest.approx(swing(motion.time)[0], abs=1e-12)
    assert motion.position(rod.end)[:, 0] == pytest.approx(slider, abs=1e-5 * CRANK)
    assert motion.joint_force(motor)[:, 2] == pytest.approx(torque, abs=1e-5 * np.abs(torque).max())
    assert motion.reaction(crank.start)[:, 2] == pytest.approx(motion.joint_force(motor)[:, 2])


def test_speed_is_the_rate_of_the_angle():
    model = slider_crank(material=SOFT)
    crank, rod = model.beams
    turned, driven = bf.Motor(crank.start, angle=angle), bf.Motor(crank.start, speed=lambda time: float(swing(time)[1]))
    one, other = (bf.simulate(model.with_loads([motor]), 0.5, 1e-3) for motor in (turned, driven))
    assert one.position(rod.end) == pytest.approx(other.position(rod.end), abs=1e-9)
    torque = one.joint_force(turned)[:, 2]
    assert other.joint_force(driven)[:, 2] == pytest.approx(torque, abs=1e-5 * np.abs(torque).max())


def rods(*loads, gravity=0.0, material=STIFF):
    upper, lower = line((0, 0), (1, 0), material, 1), line((1, 0), (1.7, 0), material, 1)
    hinge = bf.Hinge(upper.end, lower.start)
    loads = [bf.Gravity((0, -gravity)), *(make(hinge) for make in loads)]
    return bf.Model([upper, lower], [bf.Pin(upper.start)], loads, [hinge])


def test_torque_in_a_hinge_turns_rigid_rods():
    model = rods(lambda hinge: bf.Motor(hinge, torque=lambda time: 0.5 * np.sin(3.0 * time)))
    motion = bf.simulate(model, 1.0, 1e-4, save_every=500, integrator=bf.GeneralizedAlpha(0.0))

    def rates(time, state):
        return double_pendulum(time, state, 0.0, 0.5 * np.sin(3.0 * time))

    found = solve_ivp(rates, (0, 1), np.zeros(4), "DOP853", motion.time, rtol=1e-12, atol=1e-12)
    for beam, turned in zip(model.beams, found.y[:2], strict=True):
        assert motion.rotation(beam.start) == pytest.approx(turned, abs=1e-5)
    motor, (hinge,) = model.loads[1], model.joints
    assert motion.joint_force(motor)[:, 2] == pytest.approx(0.5 * np.sin(3.0 * motion.time))
    assert not motion.joint_force(hinge)[:, 2].any()


def test_angle_in_a_hinge_needs_the_torque_that_moves_it():
    """The torque of one motor, interpolated, moves the rods as the angle of the other does."""
    turned = rods(lambda hinge: bf.Motor(hinge, angle=angle), gravity=9.81)
    first = bf.simulate(turned, 0.5, 1e-3, integrator=bf.GeneralizedAlpha(0.0))
    upper, lower = turned.beams
    assert first.rotation(lower.start) - first.rotation(upper.end) == pytest.approx(swing(first.time)[0], abs=1e-9)
    torque = first.joint_force(turned.loads[1])[:, 2]
    motor = bf.Motor(turned.joints[0], torque=bf.Interpolated(np.column_stack([first.time, torque])))
    again = bf.simulate(turned.with_loads([turned.loads[0], motor]), 0.5, 1e-3, integrator=bf.GeneralizedAlpha(0.0))
    assert again.position(lower.end) == pytest.approx(first.position(lower.end), abs=2e-5)


@pytest.mark.parametrize("kind", ["angle", "torque", "angle in a hinge", "torque in a hinge"])
def test_work_of_a_motor_is_the_energy_gained(kind):
    """The torque times the rate of the angle, integrated, against kinetic and strain energy."""
    name = kind.split()[0]
    function = {"angle": angle, "torque": lambda time: 0.05 * np.sin(9.0 * time)}[name]
    model = slider_crank(material=SOFT)
    crank, rod = model.beams
    motor = bf.Motor(model.joints[0] if "hinge" in kind else crank.start, **{name: function})
    motion = bf.simulate(model.with_loads([motor]), 0.5, 1e-4, integrator=bf.GeneralizedAlpha(1.0))
    energy, torque = motion.energy(), motion.joint_force(motor)[:, 2]
    turned = motion.rotation(crank.start)
    if "hinge" in kind:
        turned = motion.rotation(rod.start) - motion.rotation(crank.end)
    work = np.append(0.0, np.cumsum(0.5 * (torque[1:] + torque[:-1]) * np.diff(turned)))
    gained = energy.kinetic - energy.kinetic[0] + energy.strain - energy.strain[0]
    assert gained == pytest.approx(work, abs=1e-5 * np.abs(work).max())
    assert energy.work == pytest.approx(work, abs=1e-5 * np.abs(work).max())
    assert energy.error == pytest.approx(0.0, abs=1e-5 * np.abs(work).max())
    assert not motion.warnings


def test_statics_of_motors():
    """Moments at an elastic corner: an angle in its hinge, and the torque that it needs."""
    left, right = line((0, 0), (0, 1), SOFT), line((0, 1), (1, 1), SOFT)
    hinge, supports = bf.Hinge(left.end, right.start), [bf.Clamp(left.start), bf.Roller(right.end)]

    def solved(motor, **options):
        return bf.solve_static(bf.Model([left, right], supports, [motor], [hinge]), **options)

    bent = solved(bf.Motor(hinge, angle=0.2), steps=2)
    turn = bent.rotation(right.start) - bent.rotation(left.end)
    assert turn == pytest.approx([0.0, 0.1, 0.2], abs=1e-10)
    torque = bent.joint_force(bent.model.loads[0])[-1, 2]
    assert torque == pytest.approx(-bent.section_forces(left).moment[-1, -1], rel=1e-6)
    for same in (
        bf.Motor(hinge, torque=torque),
        bf.Motor(hinge, torque=lambda load: torque * load),
        bf.Motor(hinge, speed=0.2),
        bf.Motor(hinge, speed=lambda load: 0.4 * load),
        bf.Motor(hinge, angle=bf.Piecewise(lambda load: 0.1 * load + 0.1 * (load > 0.5), kinks=[0.5])),
        bf.Motor(hinge, torque=bf.Piecewise(lambda load: torque * (load > 0.3), kinks=[0.3])),
    ):
        assert solved(same).position(right.start)[-1] == pytest.approx(bent.position(right.start)[-1], abs=1e-7)


def test_torque_at_a_point_is_a_moment_there():
    beam = line((0, 0), (1, 0), SOFT)
    one, other = (
        bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [load]))
        for load in (bf.Motor(beam.end, torque=0.3), bf.PointMoment(beam.end, 0.3))
    )
    assert np.array_equal(one.p, other.p)
    assert one.energy().total == pytest.approx(other.energy().total)
    stronger = one.model.with_loads([bf.Motor(beam.end, torque=0.6)])
    assert stronger.tables is one.model.tables
    assert bf.solve_static(stronger).rotation(beam.end)[-1] == pytest.approx(2.0 * one.rotation(beam.end)[-1], rel=1e-6)


def test_saved_motors_and_imperfect_models(tmp_path):
    model = slider_crank(material=SOFT)
    crank, rod = model.beams
    (hinge,) = model.joints
    model = model.with_loads([bf.Motor(crank.start, angle=angle), bf.Motor(hinge, torque=lambda time: 0.01 * time)])
    motion = bf.simulate(model, 0.1, 1e-3)
    motion.save(tmp_path / "motors.h5")
    loaded = bf.load(tmp_path / "motors.h5")
    for one, other in zip(model.loads, loaded.model.loads, strict=True):
        assert loaded.joint_force(other) == pytest.approx(motion.joint_force(one), rel=1e-9, abs=1e-12)
    motion.to_vtk(tmp_path / "motors.vtkhdf")
    motion.to_html(tmp_path / "motors.html")
    motion.plot(tmp_path / "motors.svg")
    crooked = model.with_imperfection(np.where(np.arange(model.size) < 4, 1.0, 0.0), 1e-6)
    again = bf.simulate(crooked, 0.1, 1e-3)
    assert again.position(crooked.beams[1].end) == pytest.approx(motion.position(rod.end), abs=1e-5)


def test_invalid_motors():
    model = slider_crank()
    crank, rod = model.beams
    for match, make in (
        (r"Motor needs one of angle, speed and torque, got none", lambda: bf.Motor(crank.start)),
        (r"got angle and torque", lambda: bf.Motor(crank.start, angle=1.0, torque=2.0)),
        (r"Motor acts at a point, .* or in a Hinge, got", lambda: bf.Motor(crank, angle=1.0)),
        (r"Motor acts at a point", lambda: bf.Motor(bf.Rigid(crank.end, rod.start), angle=1.0)),
        (r"speed of Motor must be a function of time alone", lambda: bf.Motor(crank.start, speed=lambda a, b: 1.0)),
        (r"torque of Motor must be .*number", lambda: bf.Motor(crank.start, torque="strong")),
        (
            r"torque of Motor .*time, or of time, angle and speed",
            lambda: bf.Motor(crank.start, torque=lambda a, b: 1.0),
        ),
        (
            r"Motor acts in a Hinge at .* not one of the joints",
            lambda: model.with_loads([bf.Motor(bf.Hinge(crank.start, rod.end), angle=1.0)]),
        ),
        (
            r"another support already prescribes rotation",
            lambda: bf.solve_static(model.with_loads(2 * [bf.Motor(crank.start, angle=1.0)])),
        ),
    ):
        with pytest.raises(bf.InputError, match=match):
            make()
    other = line((0, 0), (1, 0))
    with pytest.raises(bf.UnknownPointError, match=r"Motor at .* is on a beam that is not in this model"):
        model.with_loads([bf.Motor(other.start, torque=1.0)])
    with pytest.raises(bf.InputError, match="prescribes 1 when the motion begins"):
        bf.simulate(model.with_loads([bf.Motor(model.joints[0], angle=1.0)]), 0.1, 1e-3)


@dataclass(frozen=True)
class Regulator:
    """A proportional-derivative controller."""

    stiffness: float
    damping: float
    target: float = 0.0

    def __call__(self, time, angle, speed):
        return -self.stiffness * (angle - self.target) - self.damping * speed


def test_a_controlled_rod_is_a_damped_oscillator(tmp_path):
    """J a'' + d a' + k (a - target) = 0, from rest."""
    rod = line((0, 0), (0.5, 0))
    inertia = DENSITY * AREA * 0.5 * (0.5**2 / 3 + DEPTH**2 / 12)
    stiffness, damping, target = 400.0 * inertia, 8.0 * inertia, 0.3
    motor = bf.Motor(rod.start, torque=Regulator(stiffness, damping, target))
    model = bf.Model([rod], [bf.Pin(rod.start)], [motor])
    motion = bf.simulate(model, 0.5, 1e-4, save_every=100)
    fast = np.sqrt(400.0 - 16.0)
    wave = np.cos(fast * motion.time) + 4.0 / fast * np.sin(fast * motion.time)
    exact = target * (1.0 - np.exp(-4.0 * motion.time) * wave)
    assert motion.rotation(rod.start) == pytest.approx(exact, abs=1e-5 * target)
    torque = -stiffness * (motion.rotation(rod.start) - target) - damping * motion.v[:, 2]
    assert motion.joint_force(motor)[:, 2] == pytest.approx(torque, abs=1e-9 * stiffness)
    poles = bf.linearise(model, about=bf.solve_static(model)).modes(1)
    assert poles.frequencies[0] * 2 * np.pi == pytest.approx(fast, rel=1e-5)
    assert poles.ratios[0] == pytest.approx(0.2, rel=3e-5)
    motion.save(tmp_path / "a.h5")
    loaded = bf.load(tmp_path / "a.h5")
    assert loaded.model.loads[0].torque == motor.torque
    model.plot(tmp_path / "a.png")
    blind = model.with_loads([bf.Motor(rod.start, torque=lambda time, angle, speed: -angle)])
    with pytest.raises(bf.InputError, match="cannot be saved; make it a dataclass"):
        bf.simulate(blind, 0.01, 1e-3).save(tmp_path / "b.h5")


def test_a_controlled_hinge_is_a_torsion_spring_and_its_work_is_counted():
    """In statics, where it may be no smooth function of complex numbers, and in motion."""
    one, two = line((0, 0), (0.3, 0)), line((0.3, 0), (0.6, 0))
    hinge, pull = bf.Hinge(one.end, two.start), bf.PointForce(two.end, (0.0, -4.0))
    motor = bf.Motor(hinge, torque=lambda time, angle, speed: -5.0 * max(angle, -10.0) - 0.02 * speed)
    spring = bf.TorsionSpring(one.end, two.start, stiffness=5.0, damping=0.02)
    driven = bf.Model([one, two], [bf.Clamp(one.start)], [pull, motor], [hinge])
    sprung = bf.Model([one, two], [bf.Clamp(one.start)], [pull], [hinge], connectors=[spring])
    bent, same = bf.solve_static(driven), bf.solve_static(sprung)
    assert bent.p == pytest.approx(same.p[:, : bent.p.shape[1]], abs=1e-9)
    assert bent.joint_force(motor)[-1] == pytest.approx(same.joint_force(spring)[-1], rel=1e-6)
    one_motion, other = (bf.simulate(model, 0.2, 5e-4) for model in (driven, sprung))
    assert one_motion.position(two.end) == pytest.approx(other.position(two.end), abs=1e-8)
    energy = one_motion.energy()
    assert energy.error == pytest.approx(np.zeros(len(energy.error)), abs=1e-4 * np.abs(energy.work).max())


@pytest.mark.parametrize("in_hinge", [False, True])
def test_torques_of_motors_are_in_the_table_of_forces(in_hinge):
    crank, rod = line((0, 0), (CRANK, 0)), line((CRANK, 0), (CRANK + ROD, 0))
    hinge = bf.Hinge(crank.end, rod.start)
    motor = bf.Motor(hinge if in_hinge else crank.start, torque=lambda time: 2.0 + time)
    motion = bf.simulate(bf.Model([crank, rod], [bf.Pin(crank.start)], [motor], [hinge]), 0.003, 1e-3)
    table = motion.to_pandas(forces=True)
    found = table[table["kind"] == "Motor"]["moment"].to_numpy().reshape(len(motion), -1)
    torque = 2.0 + motion.time
    assert found == pytest.approx(np.column_stack([-torque, torque] if in_hinge else [torque]))


WRONG = {
    "an angle that is not finite": (lambda at: bf.Motor(at, angle=lambda time: np.nan), "by Motor at .* finite"),
    "a speed that is not finite": (lambda at: bf.Motor(at, speed=lambda time: np.nan), "by Motor at .* finite"),
    "a speed that is none": (lambda at: bf.Motor(at, speed=lambda time: None), "by Motor at .*NoneType"),
    "a torque that is not finite": (lambda at: bf.Motor(at, torque=lambda time: np.nan), "of Motor at .* finite"),
    "a torque that stops": (lambda at: bf.Motor(at, torque=lambda t: t if t < 2e-3 else np.nan), "of Motor.* finite"),
    "an angle that jumps": (lambda at: bf.Motor(at, angle=1.0), r"^Motor at .* would\s+jump by 1"),
}


@pytest.mark.parametrize("name", WRONG)
@pytest.mark.parametrize("in_hinge", [False, True])
def test_messages_name_the_motor(name, in_hinge):
    crank, rod = line((0, 0), (CRANK, 0)), line((CRANK, 0), (CRANK + ROD, 0))
    hinge = bf.Hinge(crank.end, rod.start)
    make, words = WRONG[name]
    model = bf.Model([crank, rod], [bf.Pin(crank.start)], [make(hinge if in_hinge else crank.start)], [hinge])
    with pytest.raises(bf.InputError, match=words):
        bf.simulate(model, 0.01, 1e-3)


def test_static_messages_and_those_of_conditions_name_the_motor():
    crank, rod = line((0, 0), (CRANK, 0)), line((CRANK, 0), (CRANK + ROD, 0))
    hinge, spring = bf.Hinge(crank.end, rod.start), bf.TorsionSpring(crank.end, rod.start, 10.0)

    def model(*motors, parts=(spring,)):
        return bf.Model([crank, rod], [bf.Clamp(crank.start)], motors, [hinge], connectors=parts)

    with pytest.raises(bf.InputError, match="amplitude of Motor at 0 must be finite"):
        bf.solve_static(model(bf.Motor(hinge, torque=lambda factor: np.nan)))
    with pytest.raises(bf.InputError, match=r"^Motor at .*another support already prescribes rotation"):
        bf.solve_static(model(bf.Motor(rod.end, angle=0.1), bf.Motor(rod.end, angle=0.2)))
    twice = [bf.Motor(hinge, angle=lambda time: time**2) for _ in range(2)]
    with pytest.raises(bf.InputError, match=r"conditions of connectors \(Motor at"):
        bf.simulate(model(*twice, parts=()), 0.01, 1e-3)
    with pytest.raises(bf.InputError, match="the force of Motor depends on velocities"):
        bf.solve_modes(model(bf.Motor(hinge, torque=lambda time, angle, speed: -speed)), 1)
