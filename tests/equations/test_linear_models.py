"""Linear models of small motions: against differences of nonlinear solutions, and modes found in another way."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from scipy.linalg import eigh, expm

import beamfem as bf
from beamfem.equations.equations import residual
from beamfem.equations.system import system_of
from tests.eccentric import Eccentric

STEEL = bf.Material(2.1e11, 0.3, 7850.0)
SQUARE = bf.Rectangle(0.02, 0.02)


def beam_of(start, end, elements=4, element=None):
    return bf.Beam(bf.Line(start, end), elements, element or bf.CRBF(3), SQUARE, STEEL)


BEAM = beam_of((0, 0), (1, 0))
BENT = [bf.PointForce(BEAM.end, (-200.0, -800.0))]
LOADS = {
    "force": bf.PointForce(BEAM.end, (0.3, 1.0)),
    "follower": bf.PointForce(BEAM.end, (0.3, 1.0), follower=True),
    "moment": bf.PointMoment(BEAM.at(0.5), 2.0),
    "weight": bf.Gravity((0.5, -9.81)),
    "line": bf.DistributedLoad(BEAM, (1.0, -2.0)),
    "tangential": bf.DistributedLoad(BEAM, (1.0, -2.0), follower=True),
    "pressure": bf.Pressure(BEAM, 3.0),
    "curvature": bf.Actuation(BEAM, curvature=1e-4),
    "heat": bf.Actuation(BEAM, stretch=1e-5),
}
QUANTITIES = [("ux", BEAM.end), ("uy", BEAM.at(0.37)), ("rotation", BEAM.at(0.81))]


@pytest.mark.parametrize("load", LOADS.values(), ids=LOADS)
def test_the_steady_response_about_a_bent_state_is_the_derivative_of_static_solutions(load):
    model = bf.Model([BEAM], [bf.Clamp(BEAM.start)], [*BENT, bf.PointForce(BEAM.at(0.5), (0.0, 0.0))])
    linear = bf.linearise(model, bf.solve_static(model), [load])
    a, b, c, d = linear.state_space(QUANTITIES)
    ends = []
    for side in (-1.0, 1.0):
        factor = lambda time, side=side: 1e-2 * side * time  # noqa: E731
        moved = bf.solve_static(model.with_loads([*model.loads, _with_amplitude(load, factor)]))
        fine = [moved.displacement(BEAM.end)[-1, 0], moved.displacement(BEAM.at(0.37))[-1, 1]]
        ends.append([*fine, moved.rotation(BEAM.at(0.81))[-1]])
    expected = (np.array(ends[1]) - ends[0]) / 2e-2
    found = (-c @ np.linalg.solve(a, b) + d)[:, 0]
    assert found == pytest.approx(expected, rel=1e-5, abs=1e-5 * np.abs(expected).max())


def _with_amplitude(load, amplitude):
    return replace(load, amplitude=amplitude)


def test_one_load_that_is_listed_twice_is_one_input():
    force = LOADS["force"]
    once, twice = (bf.linearise(bf.Model([BEAM], [bf.Clamp(BEAM.start)], count * [force])) for count in (1, 2))
    assert twice.input_matrix.shape[1] == 2
    assert np.all(twice.input_matrix == once.input_matrix)


def test_gravity_acts_on_masses_and_on_connectors_in_python():
    for parts in ({"masses": [bf.PointMass(BEAM.end, 3.0)]}, {"connectors": [Eccentric(BEAM.end, 3.0, 0.0)]}):
        linear = bf.linearise(bf.Model([BEAM], **parts), loads=[bf.Gravity((0.0, -10.0))])
        up = np.array([name.endswith("r^y") for name in linear.names], dtype=float)
        weight = 10.0 * (3.0 + 7850.0 * 4e-4)
        assert up @ linear.input_matrix[:, 0] == pytest.approx(-weight, rel=1e-12)


def frequencies(linear, count):
    """Return the lowest frequencies [Hz] from all eigenvalues of the dense matrices."""
    squares = eigh(linear.stiffness.toarray(), linear.mass.toarray(), eigvals_only=True)
    return np.sqrt(np.maximum(squares[:count], 0.0)) / (2.0 * np.pi)


def test_an_inclined_roller_is_eliminated():
    """A loaded frame of two posts and a bar, of which one post stands on the roller."""
    left, right = beam_of((0, 0), (0, 1)), beam_of((1, 0), (1, 1.2))
    bar = beam_of((0, 1), (1, 1.2))
    supports = [bf.Clamp(left.start), bf.Roller(right.start, normal=(-0.6, 0.8)), bf.Spring(right.start, (1e4, 1e4))]
    joints = [bf.Rigid(bar.end, right.end), bf.Hinge(left.end, bar.start)]
    loads = [bf.PointForce(bar.end, (300.0, -2000.0)), bf.PointForce(right.at(0.5), (500.0, 0.0))]
    model = bf.Model([left, bar, right], supports, loads, joints)
    state = bf.solve_static(model)
    linear = bf.linearise(model, state)
    assert frequencies(linear, 5) == pytest.approx(bf.solve_modes(model, 5, about=state).frequencies, rel=1e-8)
    normal = np.array([-0.6, 0.8])
    moved = np.array([linear.output((name, model.beams[2].start)) for name in ("ux", "uy")])
    assert np.abs(normal @ moved).max() < 1e-14
    assert np.abs(moved).max() > 0.1


@pytest.mark.parametrize("weight", [0.0, 50.0])
def test_conditions_are_eliminated_with_their_curvature(weight):
    """Two arms and a link under load: modes on the null space are those with multipliers as unknowns."""
    left, right = beam_of((0, 0), (0, -1)), beam_of((1, 0), (1, -1.3))
    link = bf.Link(left.end, right.end)
    loads = [bf.Gravity((3.0, -9.81)), bf.PointForce(right.end, (weight, -weight))]
    model = bf.Model([left, right], [bf.Clamp(left.start), bf.Pin(right.start)], loads, connectors=[link])
    state = bf.solve_static(model)
    linear, modes = bf.linearise(model, state), bf.solve_modes(model, 4, about=state)
    assert abs(state.multipliers(link)[-1, 0]) > 1.0
    assert len(linear) == model.size - 1 - 3 - 2 - 1
    assert frequencies(linear, 4) == pytest.approx(modes.frequencies, rel=1e-7)
    apart = [linear.output((name, beam.end)) for beam in (left, right) for name in ("ux", "uy")]
    along = state.position(right.end)[-1] - state.position(left.end)[-1]
    assert np.abs(along @ (np.array(apart[2:]) - apart[:2])).max() < 1e-12


def test_the_tension_of_a_link_makes_a_pendulum_swing():
    """A short stiff bar hangs on two links: it swings as on a swing of their length."""
    bar = bf.Beam(bf.Line((0, -2), (0.1, -2)), 1, bf.CRBF(3), bf.Rectangle(0.05, 0.05), STEEL)
    top = bf.Beam(bf.Line((0, 0), (0.1, 0)), 1, bf.CRBF(3), bf.Rectangle(0.05, 0.05), STEEL)
    links = [bf.Link(top.start, bar.start), bf.Link(top.end, bar.end)]
    model = bf.Model([top, bar], [bf.Clamp(top.start), bf.Clamp(top.end)], [bf.Gravity((0, -9.81))], connectors=links)
    held = model.with_(supports=[*model.supports, bf.Roller(bar.start, normal=(1, 0))])
    linear = bf.linearise(model, bf.solve_static(held))
    assert frequencies(linear, 1) == pytest.approx(np.sqrt(9.81 / 2.0) / (2.0 * np.pi), rel=1e-5)


def test_redundant_conditions_are_refused():
    links = [bf.Link(BEAM.start, BEAM.end), bf.Link(BEAM.end, BEAM.start)]
    model = bf.Model([BEAM], [bf.Clamp(BEAM.start)], connectors=links)
    with pytest.raises(bf.InputError, match="conditions of connectors"):
        bf.linearise(model)


@pytest.mark.parametrize("element", [bf.CRBF(3), bf.ANCF(), bf.ShearRigid()], ids=lambda own: own.name)
def test_matrices_of_a_moving_state_are_derivatives_of_its_residual(element, rng):
    """A damped arm with an eccentric body in a turn: M, C and K along random changes."""
    arm = beam_of((0, 0), (1, 0), 2, element)
    body = bf.RigidBody(arm.end, 2.0, 0.01, offset=(0.1, 0.05))
    stay = bf.SpringDamper(arm.end, (1.0, 1.0), 1e3, 20.0)
    model = bf.Model([arm], [bf.Pin(arm.start)], [bf.Gravity((0, -9.81))], connectors=[stay], masses=[body])
    turn = bf.RigidVelocity(angular=5.0)
    state = bf.simulate(model, duration=0.02, step=1e-3, velocity=turn)[-1]
    linear, system = bf.linearise(model, state), system_of(model, static=False)
    change = rng.standard_normal(len(linear))
    along, time = linear.transformation @ change, state.at
    for order, matrix in enumerate((linear.stiffness, linear.damping, linear.mass)):
        motion, width, ends = [state.p, state.v, state.a], (1e-7, 1e-3, 1.0)[order], []
        for side in (-1.0, 1.0):
            moved = motion.copy()
            moved[order] = motion[order] + side * width * along
            ends.append(linear.transformation.T @ residual(system, *moved, time))
        expected = (ends[1] - ends[0]) / (2.0 * width)
        assert matrix @ change == pytest.approx(expected, rel=1e-5, abs=1e-7 * np.abs(expected).max())
    assert abs(linear.damping - linear.damping.T).max() > 0.1  # gyroscopic


def test_small_changes_of_a_motion_on_conditions_satisfy_the_matrices():
    """M z'' + C z' + K z = 0 for the difference of two motions with other speeds; a third of it is the turning of T."""
    soft = bf.Material(2.1e7, 0.3, 1000.0)
    one, two = (
        bf.Beam(bf.Line(*ends), 1, bf.CRBF(2), bf.Rectangle(0.05, 0.05), soft)
        for ends in (((0, 0), (1, 0)), ((1.3, -0.2), (2, 0.3)))
    )
    joints = [bf.Link(one.end, two.start), bf.Slider(one.at(0.5), two.end, (1.0, 0.3))]
    damper = bf.SpringDamper(one.end, (1.0, 1.0), 30.0, 4.0)
    model = bf.Model([one, two], [bf.Pin(one.start)], [], joints, [damper])
    motions = []
    for angular in (3.0, 3.0 - 1e-4, 3.0 + 1e-4):
        spin = bf.RigidVelocity(angular=angular, about=(0.0, 0.0))
        motions.append(bf.simulate(model, 0.1, 1e-3, velocity=spin))
    linear = bf.linearise(model, motions[0][-1])
    p, v, a = (getattr(motions[2], name)[-1] - getattr(motions[1], name)[-1] for name in "pva")
    changes = zip((linear.mass, linear.damping, linear.stiffness), (a, v, p), strict=True)
    terms = [matrix @ change[linear.coordinates] for matrix, change in changes]
    assert np.abs(sum(terms)).max() < 1e-5 * max(np.abs(term).max() for term in terms)


def test_coordinates_have_names():
    named = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(1), SQUARE, STEEL, name="arm")
    linear = bf.linearise(bf.Model([named], [bf.Pin(named.start)]))
    assert linear.names == tuple(
        f"beam 'arm', node {node}, {name}" for node, name in [(0, "theta"), (1, "r^x"), (1, "r^y"), (1, "theta")]
    )
    assert repr(linear) == "LinearModel(4 coordinates, 0 loads)"
    assert [matrix.shape for matrix in linear.state_space()] == [(8, 8), (8, 0), (4, 8), (4, 0)]


@dataclass(frozen=True)
class Lifted:
    """A point rises as time goes on."""

    point: bf.Point
    unknowns = 1
    conservative = True
    rotations = False

    @property
    def points(self):
        return (self.point,)

    def force(self, at):
        (pull,) = at.own
        return np.array([0.0 * pull, pull, 0.0 * pull, at.q[0, 1] - at.reference[0, 1] - at.time**2])

    def energy(self, at):
        return 0.0, 0.0


def test_bad_input_is_named():
    model = bf.Model([BEAM], [bf.Clamp(BEAM.start)], BENT)
    other = model.with_loads([bf.PointForce(BEAM.end, (0, 9))])
    with pytest.raises(bf.InputError, match="not in equilibrium"):
        bf.linearise(other, bf.solve_static(model))
    with pytest.raises(bf.InputError, match="no node of the model"):
        bf.linearise(model, loads=[bf.PointForce(BEAM.at(0.123), (0, 1))])
    with pytest.raises(bf.InputError, match="a quantity is a pair"):
        bf.linearise(model).output("uy")
    with pytest.raises(bf.InputError, match="no quantity of a linear model"):
        bf.linearise(model).output(("vy", BEAM.end))
    with pytest.raises(bf.UnknownPointError):
        bf.linearise(model).output(("uy", beam_of((0, 0), (2, 0)).end))
    motion = bf.simulate(model, duration=0.01, step=1e-3)
    with pytest.raises(bf.InputError, match="same model if it moves"):
        bf.linearise(model.with_(supports=[bf.Pin(BEAM.start)]), motion)
    lifted = model.with_(connectors=[Lifted(BEAM.end)])
    with pytest.raises(bf.InputError, match="at rest only"):
        bf.linearise(lifted, bf.simulate(lifted, duration=0.01, step=1e-3))


def test_the_state_space_form_moves_as_the_nonlinear_model_does_after_a_small_step_of_a_load():
    arm = replace(BEAM, damping=bf.Rayleigh(mass=2.0, stiffness=1e-4))
    force, clamp, small, times = (
        bf.PointForce(arm.end, (-200.0, -800.0)),
        [bf.Clamp(arm.start)],
        1e-4,
        np.linspace(0.0, 0.05, 11),
    )
    bent = bf.solve_static(bf.Model([arm], clamp, [force]))
    more = replace(force, vector=tuple((1.0 + small) * np.array(force.vector)))
    motion = bf.simulate(bf.Model([arm], clamp, [more]), times[-1], tolerance=1e-9, save_at=times, start=bent)
    a, b, c, _ = bf.linearise(bent.model, bent).state_space([("uy", arm.end)])
    step = np.vstack([np.hstack([a, small * b]), np.zeros(len(a) + 1)])
    expected = [(c @ expm(time * step)[:-1, -1])[0] for time in times]
    moved = motion.displacement(arm.end)[:, 1]
    assert moved - moved[0] == pytest.approx(expected, abs=1e-3 * np.abs(expected).max())
