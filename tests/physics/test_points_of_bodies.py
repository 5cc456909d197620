"""Points of a rigid body apart from its beam, against statics and rigid-body equations by hand."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import beamfem as bf

SQUARE, STEEL = bf.Rectangle(0.01, 0.01), bf.Material(2.1e11, 0.3, 7850.0)
STIFF = bf.Material(2.1e16, 0.3, 1e-9)
ELEMENTS = bf.CRBF(3), bf.ANCFCRBF(), bf.ANCF(bf.Structural()), bf.ShearRigid()


def cantilever(element):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, element, SQUARE, STEEL)
    body = bf.RigidBody(beam.end, 2.0, 0.01, offset=(0.2, 0.1))
    return beam, body


@pytest.mark.parametrize("element", ELEMENTS, ids=lambda element: element.name)
def test_a_force_and_a_spring_on_a_body_are_in_balance_with_the_clamp(element):
    beam, body = cantilever(element)
    top, side = body.at(0.2, 0.3), body.at(0.3, -0.1)
    spring = bf.SpringDamper(side, (1.5, -0.5), stiffness=500.0)
    load = bf.PointForce(top, (30.0, -60.0))
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [load], connectors=[spring], masses=[body]))
    (x, y), (u, v) = solution.position(top)[-1], solution.position(side)[-1]
    fx, fy, moment = solution.reaction(beam.start)[-1]
    sx, sy, _ = solution.connector_force(spring)[-1, 0]
    stretched = np.array([1.5 - u, -0.5 - v])
    length = np.hypot(*stretched)
    assert [sx, sy] == pytest.approx(500.0 * (length - np.hypot(0.2, 0.4)) * stretched / length, rel=1e-8)
    assert [fx + 30.0 + sx, fy - 60.0 + sy] == pytest.approx([0.0, 0.0], abs=1e-6)
    assert moment == pytest.approx(60.0 * x + 30.0 * y - u * sy + v * sx, rel=1e-7)
    turn = solution.rotation(beam.end)[-1]
    c, s = np.cos(turn), np.sin(turn)
    assert abs(turn) > 0.1
    arm = np.array([0.2 * c - 0.3 * s, 0.2 * s + 0.3 * c])
    assert solution.position(top)[-1] - solution.position(beam.end)[-1] == pytest.approx(arm, abs=1e-13)


@pytest.mark.parametrize("element", ELEMENTS, ids=lambda element: element.name)
def test_a_mass_on_an_arm_is_an_eccentric_body(element):
    beam, body = cantilever(element)
    clamp = [bf.Clamp(beam.start)]
    light = bf.RigidBody(beam.end, 1e-12, 1e-12)
    ball = bf.PointMass(light.at(0.2, 0.1), 2.0, 0.01)
    one, other = (bf.Model([beam], clamp, masses=masses) for masses in ([body], [light, ball]))
    assert bf.solve_modes(other, 3).frequencies == pytest.approx(bf.solve_modes(one, 3).frequencies, rel=1e-9)


def test_a_body_pinned_beside_its_beam_is_a_compound_pendulum_and_a_second_one_hangs_on_it():
    """Rods of no mass carry the bodies: the equations are those of two bodies with a hinge between them."""
    first, second = (bf.Beam(bf.Line((x, 0), (x + 0.1, 0)), 1, bf.CRBF(3), SQUARE, STIFF) for x in (0.0, 1.0))
    one = bf.RigidBody(first.start, 2.0, 0.05, offset=(0.3, 0.1))
    two = bf.RigidBody(second.start, 1.0, 0.02, offset=(0.1, -0.2))
    pivot, lower, upper = one.at(-0.1, 0.2), one.at(0.7, -0.1), two.at(-0.3, -0.1)
    hinge = bf.Hinge(lower, upper)
    model = bf.Model([first, second], [bf.Pin(pivot)], [bf.Gravity((0, -9.81))], [hinge], masses=[one, two])
    motion = bf.simulate(model, duration=0.5, step=2.5e-4)

    def about(x, y, angle):
        return np.array([np.cos(angle) * x - np.sin(angle) * y, np.sin(angle) * x + np.cos(angle) * y])

    def rates(_, state):
        (a, b), (w, z) = state[:2], state[2:]
        c1, arm, c2 = about(0.4, -0.1, a), about(0.8, -0.3, a), about(0.4, -0.1, b)
        d1, d_arm, d2 = ([-r[1], r[0]] for r in (c1, arm, c2))
        mix = 1.0 * np.dot(d_arm, d2)
        matrix = [[0.05 + 2.0 * (c1 @ c1) + 1.0 * (arm @ arm), mix], [mix, 0.02 + 1.0 * (c2 @ c2)]]
        right = [
            -9.81 * (2.0 * d1[1] + 1.0 * d_arm[1]) + 1.0 * z * z * np.dot(d_arm, c2),
            -9.81 * 1.0 * d2[1] + 1.0 * w * w * np.dot(d2, arm),
        ]
        return [w, z, *np.linalg.solve(matrix, right)]

    exact = solve_ivp(rates, (0.0, 0.5), np.zeros(4), rtol=1e-11, atol=1e-12).y[:2, -1]
    assert [motion.rotation(first.start)[-1], motion.rotation(second.start)[-1]] == pytest.approx(exact, abs=2e-5)
    assert np.abs(exact).min() > 0.5
    assert motion.position(pivot) == pytest.approx(np.tile([-0.1, 0.2], (len(motion), 1)), abs=1e-12)
    energy = motion.energy()
    assert energy.total == pytest.approx(energy.total[0], abs=1e-5 * energy.kinetic.max())


def test_arms_are_saved_loaded_copied_and_drawn(tmp_path):
    beam, body = cantilever(bf.CRBF(3))
    force = bf.PointForce(body.at(0.2, 0.1), (0.0, -50.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [force], masses=[body])
    solution = bf.solve_static(model)
    solution.save(tmp_path / "body.h5")
    loaded = bf.load(tmp_path / "body.h5")
    assert (len(model.beams), len(model.joints), len(loaded.model.joints)) == (2, 2, 2)
    assert bf.solve_static(loaded.model).p == pytest.approx(solution.p, abs=1e-12)
    assert body.at(0.0, 0.0) == beam.end
    propped = model.with_(supports=[*model.supports, bf.Roller(body.at(0.3, 0.0))])
    assert len(propped.beams) == 3
    assert bf.solve_static(propped).reaction(propped.supports[1].point)[-1, 1] > 40.0
    model.plot(tmp_path / "body.png")
    assert (tmp_path / "body.png").stat().st_size > 0


def test_without_its_body_an_arm_stays_as_long_as_a_part_acts_on_it():
    """The force on the arm bends the beam as before, now without mass in between; a body that returns is the same."""
    beam, body = cantilever(bf.CRBF(3))
    force = bf.PointForce(body.at(0.2, 0.1), (0.0, -50.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [force], masses=[body])
    without = model.with_(masses=[])
    assert len(without.beams) == 2
    for other in (without, without.with_(masses=[body])):
        tip = bf.solve_static(other).position(beam.end)[-1]
        assert tip == pytest.approx(bf.solve_static(model).position(beam.end)[-1], abs=1e-12)
    assert model.mass - without.mass == pytest.approx(body.mass)
    bare = without.with_(loads=[])
    slower, faster = (bf.solve_modes(each, 1).frequencies[0] for each in (model, bare))
    assert slower < faster


def test_a_second_call_for_a_point_of_a_body_is_told_to_keep_the_first():
    beam, body = cantilever(bf.CRBF(3))
    force = bf.PointForce(body.at(0.2, 0.1), (0.0, -50.0))
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [force], masses=[body]))
    with pytest.raises(bf.UnknownPointError, match=r"keep the point that body\.at returned first"):
        solution.displacement(body.at(0.2, 0.1))
    assert solution.peak_stress().beam is beam  # without a warning of the arm, whose stress is not known


def test_unknown_stresses_are_counted_among_the_beams_that_the_user_has_made():
    beam, body = cantilever(bf.CRBF(3))
    stiff = bf.Section.from_stiffness(axial=1e6, shear=1e6, bending=1e3, mass=1.0, rotary_inertia=0.1)
    bar = bf.Beam(bf.Line((1, 0), (2, 0)), 2, bf.CRBF(3), stiff, name="bar")
    force = bf.PointForce(body.at(0.2, 0.1), (0.0, -50.0))
    joints = [bf.Rigid(beam.end, bar.start)]
    solution = bf.solve_static(bf.Model([beam, bar], [bf.Clamp(beam.start)], [force], joints, masses=[body]))
    with pytest.warns(bf.UnknownStressWarning, match=r"the stress of 1 of 2 beams \(bar\) is not known"):
        solution.peak_stress()
