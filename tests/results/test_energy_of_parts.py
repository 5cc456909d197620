"""Energies and powers of single parts: their sums are those of the model, and powers are forces times velocities."""

import numpy as np
import pytest
from slow_values import mostly_slow

import beamfem as bf

SQUARE, STEEL = bf.Rectangle(0.02, 0.02), bf.Material(2.1e11, 0.3, 7850.0)


@mostly_slow("element", [bf.CRBF(2), bf.ANCF()], ids=lambda element: element.name)
@pytest.mark.parametrize("in_hinge", [False, True])
def test_a_driven_arm_with_spring_damper_and_mass(element, in_hinge):
    post = bf.Beam(bf.Line((0, -0.3), (0, 0)), 1, element, SQUARE, STEEL)
    arm = bf.Beam(bf.Line((0, 0), (0.8, 0)), 2, element, SQUARE, STEEL)
    hinge = bf.Hinge(post.end, arm.start)
    spring = bf.SpringDamper(arm.end, (0.5, 0.9), 200.0, 15.0)
    ball, weight = bf.PointMass(arm.end, 2.0), bf.Gravity((0.0, -9.81))
    motor = bf.Motor(hinge if in_hinge else arm.start, torque=lambda time, angle, speed: 20.0 - 3.0 * speed)
    model = bf.Model([post, arm], [bf.Clamp(post.start)], [weight, motor], [hinge], [spring], masses=[ball])
    motion = bf.simulate(model, 0.4, 2e-4)
    energy = motion.energy()
    parts = [energy.of(part) for part in (post, arm, spring, ball)]
    assert sum(part.kinetic for part in parts) == pytest.approx(energy.kinetic, rel=1e-12, abs=1e-12)
    assert sum(part.strain for part in parts) == pytest.approx(energy.strain, rel=1e-12, abs=1e-12)
    height = motion.displacement(arm.end)[:, 1]
    assert energy.of(ball).potential == pytest.approx(2.0 * 9.81 * height, abs=1e-9)
    given = energy.of(motor).power
    speed = motion.angular_velocity(arm.start) - in_hinge * motion.angular_velocity(post.end)
    assert given == pytest.approx((20.0 - 3.0 * speed) * speed, abs=1e-3 * np.abs(given).max())
    reach = motion.position(arm.end) - (0.5, 0.9)
    along = (reach * motion.velocity(arm.end)).sum(axis=1) / np.hypot(*reach.T)
    pull = -200.0 * (np.hypot(*reach.T) - np.hypot(0.3, 0.9)) - 15.0 * along
    assert energy.of(spring).power == pytest.approx(pull * along, rel=1e-9, abs=1e-9)


def test_a_motor_that_prescribes_an_angle_gives_its_torque_times_the_speed():
    arm = bf.Beam(bf.Line((0, 0), (0.8, 0)), 2, bf.CRBF(2), SQUARE, STEEL)
    motor = bf.Motor(arm.start, angle=lambda time: 2.0 * time**3)
    motion = bf.simulate(bf.Model([arm], [bf.Pin(arm.start)], [motor]), 0.5, 1e-3)
    power = motion.energy().of(motor).power
    assert motion.angular_velocity(arm.start) == pytest.approx(6.0 * motion.time**2, abs=1e-6)
    assert power == pytest.approx(motion.joint_force(motor)[:, 2] * 6.0 * motion.time**2, abs=1e-6 * power.max())
    work = np.append(0.0, np.cumsum(0.5 * (power[1:] + power[:-1]) * 1e-3))
    assert work == pytest.approx(motion.energy().work, rel=1e-3, abs=1e-4 * work.max())


@pytest.mark.slow
def test_powers_of_loads_and_drag_are_the_rate_of_the_energy():
    """A force that moves along an arm, one at its tip, its weight and its drag."""
    arm = bf.Beam(bf.Line((0, 0), (0.8, 0)), 2, bf.CRBF(3), SQUARE, bf.Material(2e9, 0.3, 1200.0))
    fluid, weight = bf.Drag(arm, 0.5), bf.Gravity((0.0, -9.81))
    moving = bf.MovingForce(arm, lambda time: 0.4 + time, (1.0, 2.0))
    push = bf.PointForce(arm.end, (3.0, 1.0), amplitude=lambda time: 5.0 * time, follower=True)
    model = bf.Model([arm], [bf.Pin(arm.start)], [weight, moving, push], connectors=[fluid])
    motion = bf.simulate(model, 0.2, 2e-4)
    energy = motion.energy()
    assert energy.of(moving).power[0] == pytest.approx(motion.velocity(arm.at(0.5))[0] @ (1.0, 2.0), abs=1e-12)
    c, s = np.cos(turn := motion.rotation(arm.end)), np.sin(turn)
    along = np.column_stack([3.0 * c - s, 3.0 * s + c]) * 5.0 * motion.time[:, None]
    assert energy.of(push).power == pytest.approx((along * motion.velocity(arm.end)).sum(axis=1), abs=1e-9)
    power = sum(energy.of(part).power for part in (fluid, weight, moving, push))
    work = np.append(0.0, np.cumsum(0.5 * (power[1:] + power[:-1]) * np.diff(motion.time)))
    gained = energy.kinetic + energy.strain
    assert gained - gained[0] == pytest.approx(work, abs=1e-4 * gained.max())
    with pytest.raises(bf.InputError, match="is not a connector of this model"):
        energy.of(bf.PointForce(arm.end, (3.0, 1.0)))


def test_conditions_of_joints_exert_no_power_and_other_objects_are_refused():
    one, two = (bf.Beam(bf.Line((x, 0), (x, -1)), 2, bf.CRBF(2), SQUARE, STEEL) for x in (0.0, 0.5))
    link, pins = bf.Link(one.end, two.end), [bf.Pin(one.start), bf.Pin(two.start)]
    model = bf.Model([one, two], pins, [bf.Gravity((3.0, -9.81))], connectors=[link])
    motion = bf.simulate(model, 0.2, 1e-3)
    energy = motion.energy()
    forces = np.abs(motion.multipliers(link)).max() * np.abs(motion.velocity(one.end)).max()
    assert np.abs(energy.of(link).power).max() < 1e-12 * forces
    with pytest.raises(bf.InputError, match="is not a connector of this model"):
        energy.of(bf.Link(one.end, two.at(0.5)))
