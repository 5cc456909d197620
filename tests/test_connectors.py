"""Connectors: springs, dampers, masses, links with a multiplier and walls that lie beside the package."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import beamfem as bf
from beamfem.assembly.equations import STATICS, linearise, residual
from beamfem.assembly.system import system_of
from tests.connectors import Anchor, Barrier, PointMass, RigidLink, SpringDamper

SECTION, STEEL = bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0)
BENDING, AREA = 2e11 * 1e-8 / 12, 1e-4
KINDS = [bf.ANCF(), bf.CRBF(3), bf.BilinearCRBF(bf.Structural(), "reduced")]
names = pytest.mark.parametrize("element", KINDS, ids=lambda element: element.name)


def beam(element=KINDS[1], start=(0.0, 0.0), end=(1.0, 0.0), elements=4, density=7800.0):
    material = bf.Material(2e11, 0.3, density)
    return bf.Beam(bf.Line(start, end), elements, element, SECTION, material)


def cantilever(own, loads, connectors=(), supports=()):
    return bf.Model([own], [bf.Clamp(own.start), *supports], loads, connectors=connectors)


@names
def test_an_anchor_is_a_spring_support(element):
    own = beam(element)
    push = [bf.PointForce(own.end, (-0.4 * BENDING, 2.0 * BENDING)), bf.PointMoment(own.at(0.5), 0.3 * BENDING)]
    stiffness = (3.0 * BENDING, 0.5 * BENDING, 0.2 * BENDING)
    spring = bf.Spring(own.end, stiffness[:2], rotational=stiffness[2])
    one = cantilever(own, push, supports=[spring])
    other = cantilever(own, push, [Anchor(own.end, stiffness)])
    states = [bf.solve_static(model) for model in (one, other)]
    for found in (
        lambda s: s.position(own.end)[-1],
        lambda s: s.rotation(own.end)[-1:],
        lambda s: s.reaction(own.start)[-1],
    ):
        first, second = (found(state) for state in states)
        assert second == pytest.approx(first, rel=1e-8, abs=1e-8 * np.abs(first).max())
    energies = [state.energy().total[-1] for state in states]
    assert energies[1] == pytest.approx(energies[0], rel=1e-9)
    frequencies = [bf.solve_modes(model, count=4).frequencies for model in (one, other)]
    assert frequencies[1] == pytest.approx(frequencies[0], rel=1e-8)
    motions = [bf.simulate(model, 0.02, 5e-5) for model in (one, other)]
    assert motions[1].position(own.end) == pytest.approx(motions[0].position(own.end), abs=1e-7)


def test_buckling_and_paths_know_connectors():
    own = beam(elements=8)
    push = [bf.PointForce(own.end, (-BENDING, 0.0))]
    models = [
        cantilever(own, push, supports=[bf.Spring(own.end, (0.0, 4.0 * BENDING))]),
        cantilever(own, push, [Anchor(own.end, (0.0, 4.0 * BENDING, 0.0))]),
    ]
    one, other = (bf.solve_buckling(model, count=2).load_factors for model in models)
    assert other == pytest.approx(one, rel=1e-8)
    push = [bf.PointForce(own.end, (-2.0 * BENDING, 0.1 * BENDING))]
    models = [cantilever(own, push, supports=models[0].supports[1:]), cantilever(own, push, models[1].connectors)]
    one, other = (bf.solve_static(model).position(own.end)[-1] for model in models)
    assert other == pytest.approx(one, abs=1e-8)


@pytest.mark.parametrize("axis", [(1.0, 0.0), (0.6, 0.8)])
def test_a_spring_between_two_cantilevers_shares_their_load(axis):
    """A small load across one of two equal cantilevers: with k between the tips, the other bends by w k / (K + k)."""
    along, across = np.array(axis), np.array([-axis[1], axis[0]])
    low, high = (beam(start=tuple(s * across), end=tuple(s * across + along)) for s in (0.0, 0.5))
    force = 1e-6 * BENDING
    spring = SpringDamper(low.end, high.end, stiffness=2.0 * BENDING)
    loads = [bf.PointForce(low.end, tuple(force * across))]
    model = bf.Model([low, high], [bf.Clamp(low.start), bf.Clamp(high.start)], loads, connectors=[spring])
    solution = bf.solve_static(model)
    shear = BENDING / (STEEL.youngs_modulus / 2.6 * SECTION.shear_factor * AREA)
    stiffness, between = BENDING / (1.0 / 3.0 + shear), 2.0 * BENDING
    moved = force * (stiffness + between) / (stiffness**2 + 2.0 * stiffness * between)
    assert solution.displacement(low.end)[-1] @ across == pytest.approx(moved, rel=1e-5)
    other = moved * between / (stiffness + between)
    assert solution.displacement(high.end)[-1] @ across == pytest.approx(other, rel=1e-5)


@names
def test_tangents_are_derivatives_of_the_residual(element):
    one, two = beam(element), beam(element, (0.0, 0.5), (1.0, 0.8))
    model = bf.Model(
        [one, two],
        [bf.Clamp(one.start), bf.Clamp(two.start)],
        connectors=[
            SpringDamper(one.end, two.at(0.5), 1e3, 2.0),
            RigidLink(one.at(0.5), two.end),
            PointMass(two.end, 0.3),
        ],
    )
    system, rng = system_of(model, static=True), np.random.default_rng(1)
    p, step, zeros = system.reference, np.zeros(model.size), np.zeros(model.size)
    p = p + 1e-3 * rng.standard_normal(model.size)
    step[system.free_dofs] = rng.standard_normal(len(system.free_dofs))
    tangent = linearise(system, p, zeros, zeros, 1.0, STATICS)[1].sparse(system.rotated)
    ends = [residual(system, p + side * 1e-6 * step, zeros, zeros, 1.0) for side in (1.0, -1.0)]
    differences = ((ends[0] - ends[1]) / 2e-6)[system.free_dofs]
    assert tangent @ step[system.free_dofs] == pytest.approx(differences, abs=1e-6 * np.abs(differences).max())


def portal(turn=0.0):
    """A column clamped at its foot and one on a pin, which a rigid link between the heads holds."""
    c, s = np.cos(turn), np.sin(turn)

    def place(x, y):
        return c * x - s * y, s * x + c * y

    left, right = beam(start=place(0, 0), end=place(0, 1)), beam(start=place(2, 0), end=place(2, 1))
    link = RigidLink(left.end, right.end)
    loads = [bf.PointForce(right.end, place(0.5 * BENDING, 0.0))]
    return left, right, bf.Model([left, right], [bf.Clamp(left.start), bf.Pin(right.start)], loads, connectors=[link])


@pytest.mark.parametrize("turn", [0.0, 0.7, 3.0])
def test_a_column_that_only_a_link_holds_stands(turn):
    left, right, model = portal(turn)
    solution = bf.solve_static(model)
    heads = solution.position(left.end)[-1], solution.position(right.end)[-1]
    assert np.linalg.norm(heads[1] - heads[0]) == pytest.approx(2.0, rel=1e-11)
    pull = solution.multipliers(model.connectors[0])[-1, 0] * (heads[1] - heads[0]) / 2.0
    # the column on the pin is a pendulum: no moment about its foot
    foot, load = solution.position(right.start)[-1], 0.5 * BENDING * np.array([np.cos(turn), np.sin(turn)])
    arm, net = heads[1] - foot, load - pull
    assert abs(arm[0] * net[1] - arm[1] * net[0]) < 1e-7 * BENDING
    reaction = solution.reaction(left.start)[-1]
    assert reaction[:2] == pytest.approx(-pull, abs=1e-6 * BENDING)
    assert solution.stability[-1]
    alone = bf.solve_static(cantilever(left, [bf.PointForce(left.end, tuple(pull))]))
    assert alone.position(left.end)[-1] == pytest.approx(heads[0], abs=1e-8)


def test_a_column_on_a_link_sways_at_its_critical_load():
    """The column on the pin carries N down: its link pulls the cantilever aside by N / L, against 3 EI / L^3.

    It shortens, which tilts the link: the bifurcation is imperfect by 1e-10 of the length.
    """
    swayed = []
    for size in (2.98, 3.02):
        _, right, model = portal()
        down = [bf.PointForce(right.end, (0.0, -size * BENDING))]
        solution = bf.solve_static(bf.Model(model.beams, model.supports, down, connectors=model.connectors))
        swayed.append(abs(float(solution.displacement(right.end)[-1, 0])))
        assert solution.stability[-1]
    assert swayed[0] < 1e-6
    assert swayed[1] > 0.02


def test_without_its_link_the_column_can_move():
    _, _, model = portal()
    with pytest.raises(bf.FreeMotionError, match="beam 1 can move freely"):
        bf.solve_static(bf.Model(model.beams, model.supports, model.loads))


def test_a_mass_at_the_tip_slows_the_first_mode():
    """Cantilever with a tip mass M of its own: 1 + cosh b cos b = b M / m (sin b cosh b - cos b sinh b)."""
    own = beam(bf.CRBF(3), elements=8)
    mass = 7800.0 * AREA
    model = cantilever(own, [], [PointMass(own.end, 0.7 * mass)])

    def singular(b):
        return 1 + np.cosh(b) * np.cos(b) - 0.7 * b * (np.sin(b) * np.cosh(b) - np.cos(b) * np.sinh(b))

    root = brentq(singular, 0.5, 1.8)
    frequency = root**2 / (2 * np.pi) * np.sqrt(BENDING / mass)
    assert bf.solve_modes(model, count=1).frequencies[0] == pytest.approx(frequency, rel=2e-4)


def test_masses_and_springs_in_free_flight_keep_momenta_and_energy():
    one, two = beam(bf.CRBF(2)), beam(bf.CRBF(2), (0.0, 0.5), (1.0, 0.8))
    parts = [SpringDamper(one.end, two.end, 200.0), PointMass(one.start, 0.1), PointMass(two.at(0.5), 0.4)]
    model = bf.Model([one, two], connectors=parts)
    motion = bf.simulate(model, 0.2, 2e-4, velocity=bf.RigidVelocity((1.0, 2.0), 3.0, (0.2, 0.1)))
    linear, angular = motion.linear_momentum(), motion.angular_momentum()
    assert linear == pytest.approx(np.broadcast_to(linear[0], linear.shape), abs=1e-6 * np.abs(linear).max())
    assert angular == pytest.approx(np.full(len(angular), angular[0]), rel=1e-5)
    total = motion.energy().total
    assert total == pytest.approx(np.full(len(total), total[0]), rel=1e-4)
    assert motion.energy_drift is not None
    mass = 2 * 7800.0 * AREA * np.array([0.5, 0.5 * np.hypot(1.0, 0.3)]).sum() + 0.5
    assert motion.energy().kinetic[0] > 0.5 * mass


def test_a_damper_takes_energy_at_its_rate():
    """A mass on a light cantilever: x'' + 2 z w x' + w^2 x = 0 decays by exp(-z w t)."""
    own, ground = beam(bf.CRBF(3), density=1e-3), beam(start=(1.0, -1.0), end=(2.0, -1.0))
    rate = np.sqrt(3.0 * BENDING / 0.5)
    damper = SpringDamper(ground.start, own.end, damping=2 * 0.05 * rate * 0.5)
    supports = [bf.Clamp(own.start), bf.Clamp(ground.start), bf.Clamp(ground.end)]
    loads = [bf.PointForce(own.end, (0.0, 1e-3 * BENDING), amplitude=lambda t: 0.0)]
    bent = bf.solve_static(bf.Model([own, ground], supports, [bf.PointForce(own.end, (0.0, 1e-3 * BENDING))]))
    model = bf.Model([own, ground], supports, loads, connectors=[damper, PointMass(own.end, 0.5)])
    period = 2 * np.pi / (rate * np.sqrt(1 - 0.05**2))
    motion = bf.simulate(model, 2 * period, period / 400, start=bent[-1], integrator=bf.GeneralizedAlpha(1.0))
    height = motion.displacement(own.end)[:, 1]
    assert height[-1] / height[0] == pytest.approx(np.exp(-2 * 0.05 * rate * period), rel=2e-3)
    assert motion.energy_drift is None


def test_forces_along_a_beam_are_those_beside_a_spring_support():
    own = beam(elements=6)
    push = [bf.PointForce(own.end, (0.1 * BENDING, BENDING)), bf.Gravity((0.0, -9.81))]
    models = [
        cantilever(own, push, supports=[bf.Spring(own.at(0.5), (0.0, 9.0 * BENDING))]),
        cantilever(own, push, [Anchor(own.at(0.5), (0.0, 9.0 * BENDING, 0.0))]),
    ]
    one, other = (bf.solve_static(model).section_forces(own) for model in models)
    for name in ("normal", "shear", "moment"):
        expected = getattr(one, name)[-1]
        assert getattr(other, name)[-1] == pytest.approx(expected, abs=1e-7 * np.abs(expected).max())


@pytest.mark.parametrize("turn", [0.4, 2.0])
def test_models_with_connectors_do_not_know_the_axes(turn):
    def solved(angle):
        c, s = np.cos(angle), np.sin(angle)

        def place(x, y):
            return c * x - s * y, s * x + c * y

        one = beam(bf.CRBF(2), place(0, 0), place(1, 0))
        two = beam(bf.CRBF(2), place(0, 0.5), place(1, 0.8))
        parts = [SpringDamper(one.end, two.at(0.5), 9 * BENDING, 0.4), PointMass(two.end, 0.2)]
        supports = [bf.Clamp(one.start), bf.Pin(two.start)]
        load = bf.PointForce(two.end, place(0.02 * BENDING, -0.05 * BENDING))
        model = bf.Model([one, two], supports, [load, bf.Gravity(place(0, -9.81))], connectors=parts)
        states = bf.solve_static(model), bf.simulate(model, 0.05, 5e-4)
        back = np.array([[c, -s], [s, c]])
        return [state.position(two.end)[-1] @ back for state in states], bf.solve_modes(model, count=3).frequencies

    (places, frequencies), (turned, same) = solved(0.0), solved(turn)
    assert turned[0] == pytest.approx(places[0], abs=1e-8)
    assert turned[1] == pytest.approx(places[1], abs=1e-7)
    assert same == pytest.approx(frequencies, rel=1e-8)


def test_a_beam_is_stopped_by_a_wall():
    own = beam(elements=6)
    wall = Barrier(own.end, -0.05, 1e4 * BENDING, 1e-4)
    solution = bf.solve_static(cantilever(own, [bf.PointForce(own.end, (0.0, -3.0 * BENDING))], [wall]))
    gap = solution.position(own.end)[-1, 1] + 0.05
    assert abs(gap) < 5e-4
    # what the wall bears and what the clamp bears is the load
    pushed = solution.connector_force(wall)[-1, 0, 1]
    assert solution.reaction(own.start)[-1, 1] + pushed == pytest.approx(3.0 * BENDING, rel=1e-7)
    with pytest.raises(bf.InputError, match="no connector of this model"):
        solution.multipliers(Anchor(own.end, (1.0, 1.0, 1.0)))


@dataclass(frozen=True)
class Absolute(Anchor):
    def force(self, at):
        return np.abs(at.q - at.reference).ravel() * np.array(self.stiffness)


@dataclass(frozen=True)
class Uneven(Anchor):
    def force(self, at):
        x, y, _ = (at.q - at.reference)[0]
        return np.array([y, 0.0 * x, 0.0 * x])


@dataclass(frozen=True)
class Short(Anchor):
    def force(self, at):
        return at.q[0, :2]


def test_what_is_no_connector_is_refused():
    own = beam()
    stiffness = (1.0, 1.0, 1.0)
    for kind, words in (
        (Absolute, "no analytic function of q"),
        (Uneven, "not symmetric"),
        (Short, "must return 3 numbers"),
    ):
        with pytest.raises(bf.InputError, match=words):
            bf.solve_static(cantilever(own, [], [kind(own.end, stiffness)]))
    with pytest.raises(bf.InputError, match="connectors of a Model cannot hold"):
        cantilever(own, [], [bf.Pin(own.end)])
    with pytest.raises(bf.UnknownPointError, match="not in this model"):
        cantilever(own, [], [Anchor(beam().end, stiffness)])
    with pytest.raises(bf.InputError, match="lists a point twice"):
        cantilever(own, [], [SpringDamper(own.end, own.end)])
    _, _, model = portal()
    for solve in (bf.solve_modes, bf.solve_buckling, bf.trace_equilibrium):
        with pytest.raises(bf.InputError, match="takes no connectors with unknowns of their own, which RigidLink has"):
            solve(model)


def crossbar(link, turn=0.0):
    """A parallelogram that falls: two beams on pins, whose free ends a link keeps apart."""
    c, s = np.cos(turn), np.sin(turn)

    def place(x, y):
        return c * x - s * y, s * x + c * y

    one = beam(bf.CRBF(2), place(0, 0), place(1, 0), elements=3)
    two = beam(bf.CRBF(2), place(0, 0.5), place(1, 0.5), elements=3)
    parts = [link(one.end, two.end), PointMass(two.end, 0.3)]
    pins = [bf.Pin(one.start), bf.Pin(two.start)]
    return two, bf.Model([one, two], pins, [bf.Gravity(place(0.0, -9.81))], connectors=parts)


@pytest.mark.parametrize("turn", [0.0, 1.0])
def test_a_link_in_motion_keeps_its_length_and_the_energy(turn):
    """Of nearly rigid arms it is a pendulum: w' = -g (2 m L / 2 + M L) cos(angle) / (2 m L^2 / 3 + M L^2)."""
    two, model = crossbar(RigidLink, turn)
    motion = bf.simulate(model, 0.4, 5e-4)
    one = model.beams[0]
    gap = np.linalg.norm(motion.position(two.end) - motion.position(one.end), axis=1)
    assert np.abs(gap - 0.5).max() < 1e-10
    total = motion.energy().total
    assert np.abs(total - total[0]).max() < 2e-4 * np.ptp(motion.energy().potential)
    assert motion.energy_drift is not None
    mass = 7800.0 * AREA
    speed = 9.81 * (mass + 0.3) / (2 * mass / 3 + 0.3)

    def fall(_, state):
        return state[1], -speed * np.cos(state[0])

    angle = solve_ivp(fall, (0.0, 0.4), (0.0, 0.0), rtol=1e-9, atol=1e-12).y[0, -1]
    moved = motion.position(two.end)[-1] - motion.position(two.start)[-1]
    assert np.arctan2(moved[1], moved[0]) - turn == pytest.approx(angle, abs=2e-3)
    # the bar's force: it carries what one arm needs more than gravity gives it, of either sign
    assert np.ptp(motion.multipliers(model.connectors[0])) > 0.1


def test_multipliers_of_a_motion_converge_with_the_square_of_the_step():
    found = []
    for step in (4e-3, 2e-3, 1e-3):
        _, model = crossbar(RigidLink)
        motion = bf.simulate(model, 0.2, step, integrator=bf.GeneralizedAlpha(0.6))
        found.append((motion.p[-1, -1], *motion.position(model.beams[1].end)[-1]))
    coarse, fine = np.abs(np.diff(found, axis=0))
    assert np.all(fine < 0.35 * coarse)


def test_a_stiff_spring_moves_like_a_link():
    two, linked = crossbar(RigidLink)
    three, sprung = crossbar(lambda a, b: SpringDamper(a, b, stiffness=1e8))
    motions = [
        bf.simulate(model, 0.2, 5e-4).position(point)[-1] for model, point in ((linked, two.end), (sprung, three.end))
    ]
    assert motions[1] == pytest.approx(motions[0], abs=1e-5)


def test_starts_that_break_a_condition_are_refused():
    two, model = crossbar(RigidLink)
    with pytest.raises(bf.InputError, match="the initial velocity does not meet what RigidLink asks for"):
        bf.simulate(model, 0.1, 1e-3, velocity=lambda x: (0.0, x[0] * x[1]))
    apart = bf.Model(model.beams, model.supports, [bf.PointMoment(two.start, 1.0)], connectors=())
    state = bf.simulate(apart, 0.05, 1e-3)[-1]
    with pytest.raises(bf.InputError, match="the start of the motion does not meet what RigidLink asks for"):
        bf.simulate(model, 0.1, 1e-3, start=state)


def test_results_with_connectors_of_ones_own_say_why_they_cannot_be_saved(tmp_path):
    own = beam()
    solution = bf.solve_static(cantilever(own, [], [Anchor(own.end, (1.0, 1.0, 1.0))]))
    with pytest.raises(bf.InputError, match="a Anchor cannot be saved"):
        solution.save(tmp_path / "own.h5")
    solution.plot(tmp_path / "own.png")
    solution.to_vtk(tmp_path / "own.vtkhdf")
