"""Statics and vibration in a rotating frame, against closed forms and motions seen from rest."""

import numpy as np
import pytest
from scipy.linalg import eigh

import beamfem as bf
from beamfem.equations.equations import INERTIA, STATICS, linearise, residual, residuals
from beamfem.equations.system import system_of
from beamfem.linalg.tangent import UNROTATED

STEEL = bf.Material(2.1e11, 0.3, 7850.0)
LIGHT = bf.Material(2.1e11, 0.3, 1e-6)
THIN = bf.Rectangle(0.002, 0.002)


def beam_of(start, end, elements=4, element=None, section=THIN, material=STEEL):
    return bf.Beam(bf.Line(start, end), elements, element or bf.CRBF(4), section, material)


@pytest.mark.parametrize(("speed", "expected"), [(0.0, 3.5160), (1.0, 3.5432), (2.0, 3.6218), (3.0, 3.7435)])
@pytest.mark.parametrize(
    "element",
    [bf.CRBF(4), bf.Element(bf.Lagrange(4), bf.Gradients(), bf.Structural(), "full")],
    ids=["CRBF", "gradients"],
)
def test_a_rotating_cantilever_has_the_known_frequency_in_its_plane(element, speed, expected):
    """In the plane of the rotation, about the root of the beam; speeds and frequencies in sqrt(E I / (rho A L^4))."""
    unit = np.sqrt(THIN.rigidity(STEEL).bending / THIN.inertia(STEEL).mass)
    beam = beam_of((0.5, 0.2), (0.5 + 0.8, 0.2 + 0.6), 8, element)
    model = bf.Model([beam], [bf.Clamp(beam.start)], frame=bf.RotatingFrame(speed * unit, about=(0.5, 0.2)))
    spinning = bf.solve_static(model)
    undamped, gyroscopic = bf.solve_modes(model, 1, about=spinning), bf.linearise(model, spinning).modes(1)
    for modes in (undamped, gyroscopic):
        assert 2.0 * np.pi * modes.frequencies[0] / unit == pytest.approx(expected, abs=6e-5)
    assert gyroscopic.growth[0] == pytest.approx(0.0, abs=1e-9 * unit)


def test_a_rotating_rod_is_stretched_by_its_own_mass():
    rod, speed = beam_of((0, 0), (1, 0)), 300.0
    model = bf.Model([rod], [bf.Clamp(rod.start)], frame=bf.RotatingFrame(speed))
    solution = bf.solve_static(model, steps=2)
    strain = 7850.0 * speed**2 / STEEL.youngs_modulus
    assert solution.displacement(rod.end)[1:, 0] == pytest.approx(strain / 3.0 * np.array([0.5, 1.0]), rel=3e-3)
    forces, mass = solution.section_forces(rod), THIN.area * 7850.0
    exact = 0.5 * mass * speed**2 * (1.0 - forces.arc_length**2)
    assert forces.normal[-1] == pytest.approx(exact, rel=2e-3, abs=1e-5 * exact.max())
    assert solution.reaction(rod.start)[-1, 0] == pytest.approx(-forces.normal[-1, 0], rel=1e-9)
    energy = solution.energy()
    assert energy.potential == pytest.approx(-2.0 * energy.strain, rel=2e-3)


def test_a_rotating_arm_keeps_its_shape_seen_from_rest():
    """The equilibrium in the frame is a motion at constant speed: an arm with a heavy tip that bends as it turns."""
    arm, speed = beam_of((0.2, 0), (0.2, 0.6), section=bf.Rectangle(0.01, 0.01)), 40.0
    frame = bf.RotatingFrame(speed, about=(0.1, 0.1))
    body = bf.RigidBody(arm.end, 0.2, 1e-3, offset=(0.05, 0.02))
    model = bf.Model([arm], [bf.Clamp(arm.start)], masses=[body], frame=frame)
    bent = bf.solve_static(model)
    assert bent.rotation(arm.end)[-1] < -0.04

    def place(time):
        return 0.1 * np.cos(speed * time) + 0.1 * np.sin(speed * time), (
            0.1 * np.sin(speed * time) - 0.1 * np.cos(speed * time)
        )

    drive = bf.Prescribed(
        arm.start,
        ux=lambda time: place(time)[0] - 0.1,
        uy=lambda time: place(time)[1] + 0.1,
        rotation=lambda time: speed * time,
    )
    turning = bf.Model([arm], [drive], masses=[body])
    spin = bf.RigidVelocity(angular=speed, about=(0.1, 0.1))
    motion = bf.simulate(turning, duration=0.05, step=1e-4, start=bent[-1], velocity=spin)
    distance = np.linalg.norm(motion.position(arm.end) - (0.1, 0.1), axis=1)
    assert distance == pytest.approx(distance[0], rel=1e-6)
    assert motion.rotation(arm.end) - speed * motion.time == pytest.approx(bent.rotation(arm.end)[-1], abs=1e-5)
    force, moment = bent.reaction(arm.start)[-1, :2], bent.reaction(arm.start)[-1, 2]
    later = motion.reaction(arm.start)[50:]
    assert np.linalg.norm(later[:, :2], axis=1) == pytest.approx(np.linalg.norm(force), rel=1e-3)
    assert later[:, 2] == pytest.approx(moment, rel=2e-3)
    held = bent.connector_force(body)[-1, 0]
    assert np.linalg.norm(held[:2]) == pytest.approx(0.2 * speed**2 * _radius(bent, arm), rel=1e-9)


def _radius(bent, arm):
    """Return the distance of the centre of mass of the body from the axis."""
    turn = bent.rotation(arm.end)[-1]
    c, s = np.cos(turn), np.sin(turn)
    offset = np.array([0.05 * c - 0.02 * s, 0.05 * s + 0.02 * c])
    return np.linalg.norm(bent.position(arm.end)[-1] + offset - (0.1, 0.1))


def test_a_pendulum_hangs_outwards_and_swings_in_the_centrifugal_field():
    radius, length, speed = 2.0, 0.5, 7.0
    bar = beam_of((radius, 0), (radius + length, 0), 1, bf.CRBF(3), bf.Rectangle(0.1, 0.1), LIGHT)
    ball = bf.PointMass(bar.end, 3.0)
    model = bf.Model([bar], [bf.Clamp(bar.start)], masses=[ball], frame=bf.RotatingFrame(speed))
    state = bf.solve_static(model)
    pinned = model.with_(supports=[bf.Pin(bar.start)])
    modes = bf.solve_modes(pinned, 1, about=state)
    assert 2.0 * np.pi * modes.frequencies[0] == pytest.approx(speed * np.sqrt(radius / length), rel=1e-6)


def test_a_mass_on_springs_whirls_at_two_rates():
    """Foucault: isotropic vibration at rest is seen to turn, so that rates are w0 - w and w0 + w."""
    bar, stiffness, speed = beam_of((0, 0), (0.1, 0), 1, material=LIGHT), 400.0, 5.0
    supports = [bf.Spring(bar.start, (stiffness, stiffness)), bf.Prescribed(bar.start, rotation=0.0)]
    model = bf.Model([bar], supports, masses=[bf.PointMass(bar.start, 1.0)], frame=bf.RotatingFrame(speed))
    modes = bf.linearise(model, bf.solve_static(model)).modes(2)
    assert 2.0 * np.pi * modes.frequencies == pytest.approx([20.0 - speed, 20.0 + speed], rel=1e-6)


@pytest.mark.parametrize("element", [bf.CRBF(3), bf.ANCF(), bf.ShearRigid()], ids=lambda own: own.name)
@pytest.mark.parametrize("factor", [1.0, 0.3, -0.2])
def test_tangents_are_derivatives_of_the_residual(element, factor, rng):
    """With a roller, whose prescribed coordinate is accelerated by Coriolis forces, a spring, a body and a link."""
    arm, other = beam_of((0, 0), (1, 0.3), 2, element), beam_of((0, 1), (1, 1.3), 2, element)
    connectors = [bf.Link(arm.end, other.end), bf.SpringDamper(arm.at(0.5), other.at(0.5), 10.0, 2.0)]
    model = bf.Model(
        [arm, other],
        [bf.Roller(arm.start, normal=(0, 1)), bf.Pin(arm.end), bf.Pin(other.start)],
        connectors=connectors,
        masses=[bf.RigidBody(other.at(0.5), 2.0, 0.01, offset=(0.1, 0.05))],
        frame=bf.RotatingFrame(3.0, about=(0.3, -0.2)),
    )
    system = system_of(model, static=True)
    free, n = system.free_dofs, model.size
    p, v, a = system.reference + 1e-3 * rng.standard_normal(n), np.zeros(n), np.zeros(n)
    change = np.zeros(n)
    change[free] = rng.standard_normal(len(free))
    for order, weights in enumerate((STATICS, (0.0, 1.0, 0.0), INERTIA)):
        found = linearise(system, p, v, a, factor, weights)[1].sparse(UNROTATED) @ change[free]
        ends = []
        for side in (-1.0, 1.0):
            moved = [p, v, a]
            moved[order] = moved[order] + side * (1e-6, 1.0, 1.0)[order] * change
            ends.append(residual(system, *moved, factor)[free])
        expected = (ends[1] - ends[0]) / (2.0 * (1e-6, 1.0, 1.0)[order])
        if order == 1 and factor < 0.0:
            continue  # there is no speed whose square is negative
        assert found == pytest.approx(expected, rel=1e-5, abs=1e-7 * np.abs(expected).max())


def critical_speeds(radius, count):
    """Return the speeds at which a cantilever of length 1 that points from a rim inwards buckles, by Ritz.

    E I w'' w'' - rho A w^2 (n w' w' + w w) with the compression n = R (1 - s) - (1 - s^2) / 2; in sqrt(E I / rho A).
    """
    powers = np.arange(2, 10)
    s, weight = np.polynomial.legendre.leggauss(40)
    s, weight = 0.5 * (s[:, None] + 1.0), 0.5 * weight[:, None]
    shapes, slopes = s**powers, powers * s ** (powers - 1)
    bends = powers * (powers - 1) * s ** (powers - 2)
    compression = radius * (1.0 - s) - 0.5 * (1.0 - s**2)
    softening = slopes.T @ (weight * compression * slopes) + shapes.T @ (weight * shapes)
    squares = eigh(softening, bends.T @ (weight * bends), eigvals_only=True)
    return 1.0 / np.sqrt(squares[::-1][:count])


@pytest.mark.slow
@pytest.mark.parametrize("radius", [1.0, 2.0])
def test_a_cantilever_that_points_inwards_buckles_at_a_critical_speed(radius):
    """The load factor multiplies the square of the speed."""
    beam = beam_of((radius, 0), (radius - 1.0, 0), 8)
    unit = np.sqrt(THIN.rigidity(STEEL).bending / THIN.inertia(STEEL).mass)
    model = bf.Model([beam], [bf.Clamp(beam.start)], frame=bf.RotatingFrame(8.0 * unit))
    exact = critical_speeds(radius, 1)[0]
    assert 8.0 * np.sqrt(bf.solve_buckling(model, 1).load_factors[0]) == pytest.approx(exact, rel=1e-5)
    path = bf.trace_equilibrium(model, until=0.5)
    assert 8.0 * np.sqrt(path.bifurcations[0].at) == pytest.approx(exact, rel=1e-5)
    for speed, growing in ((0.99 * exact, False), (1.01 * exact, True)):
        near = bf.Model([beam], [bf.Clamp(beam.start)], frame=bf.RotatingFrame(speed * unit))
        straight = bf.solve_static(near.with_(supports=[*near.supports, bf.Roller(beam.end, normal=(0, 1))]))
        assert (bf.solve_modes(near, 1, about=straight).growth[0] > 0.0) == growing


def test_a_branch_of_buckled_states_is_followed():
    beam = beam_of((2.0, 0), (1.0, 0), 8)
    unit = np.sqrt(THIN.rigidity(STEEL).bending / THIN.inertia(STEEL).mass)
    model = bf.Model([beam], [bf.Clamp(beam.start)], frame=bf.RotatingFrame(10.0 * unit))
    path = bf.trace_equilibrium(model, until=0.2)
    branch = bf.trace_equilibrium(model, start=path.bifurcations[0], until=0.2)
    bent = bf.linearise(model, branch[-1]).modes(1)
    assert branch.stable[-1]
    assert bent.frequencies[0] > 1.0
    # the root carries the centrifugal force of all mass, which is its mass times the place of its centre
    middles = (np.arange(100) + 0.5) / 100
    place = np.mean([branch.position(beam.at(fraction))[-1] for fraction in middles], axis=0)
    force = branch.reaction(beam.start)[-1]
    weight = THIN.area * 7850.0 * 0.2 * (10.0 * unit) ** 2
    assert force[:2] == pytest.approx(-weight * place, rel=1e-4)
    assert branch.section_forces(beam).moment[-1, 0] == pytest.approx(-force[2], rel=1e-6)
    energy = branch.energy()
    slope = np.gradient(energy.strain, branch.at) + np.gradient(energy.potential / branch.at, branch.at) * branch.at
    assert np.abs(slope[3:-1]).max() < 0.05 * np.abs(np.gradient(energy.strain, branch.at)[3:-1]).max()


def test_the_frame_is_kept_and_saved(tmp_path):
    rod = beam_of((0, 0), (1, 0))
    model = bf.Model([rod], [bf.Clamp(rod.start)], frame=bf.RotatingFrame(10.0, about=(0.0, 1.0)))
    assert model.with_loads([bf.Gravity((0, -1))]).frame is model.frame
    bf.solve_static(model).save(tmp_path / "spinning.h5")
    assert bf.load(tmp_path / "spinning.h5").model.frame == model.frame


def test_bad_input_is_named():
    rod = beam_of((0, 0), (1, 0))
    frame = bf.RotatingFrame(10.0)
    with pytest.raises(bf.InputError, match="speed of RotatingFrame"):
        bf.RotatingFrame("fast")
    with pytest.raises(bf.InputError, match="frame of a Model must be a RotatingFrame"):
        bf.Model([rod], frame=10.0)
    model = bf.Model([rod], [bf.Clamp(rod.start)], [bf.PointForce(rod.end, (-1.0, 0.0))], frame=frame)
    with pytest.raises(bf.InputError, match="simulate does not support models in a RotatingFrame"):
        bf.simulate(model, duration=1.0, step=0.1)
    motion = bf.simulate(bf.Model([rod], [bf.Clamp(rod.start)]), duration=0.1, step=0.1)
    with pytest.raises(bf.InputError, match="about a moving state does not support"):
        bf.linearise(model, motion)
    damped = model.with_(connectors=[bf.SpringDamper(rod.end, (1.0, 1.0), 0.0, 1.0)])
    with pytest.raises(bf.InputError, match="resists the rotation"):
        bf.solve_static(damped)


@pytest.mark.parametrize("frame", [None, bf.RotatingFrame(40.0, about=(0.1, 0.1))], ids=["at rest", "rotating"])
def test_residuals_of_several_rates_are_those_of_each(frame):
    arm, random = beam_of((0.2, 0), (0.2, 0.6)), np.random.default_rng(1)
    loads = [bf.Gravity((0.0, -9.81)), bf.PointMoment(arm.end, 0.3)]
    model = bf.Model([arm], [bf.Clamp(arm.start)], loads, masses=[bf.PointMass(arm.end, 0.2)], frame=frame)
    system, rates = system_of(model, static=False), random.normal(size=(3, 2, model.size))
    p = system.reference + 0.01 * random.normal(size=model.size)
    rows, times = [(p, *pair) for pair in rates], [0.1, 0.2, 0.1]
    found = residuals(system, rows, times)
    np.testing.assert_array_equal(found, [residual(system, *row, at) for row, at in zip(rows, times, strict=True)])
    assert np.abs(found[0] - found[1]).max() > 1e-3
