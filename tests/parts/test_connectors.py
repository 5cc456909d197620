"""Connectors: springs, dampers, masses and walls that lie beside the package, against closed forms and supports."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.optimize import brentq

import beamfem as bf
from tests.connectors import (
    AREA,
    BENDING,
    KINDS,
    SECTION,
    STEEL,
    Anchor,
    Barrier,
    PointMass,
    SpringDamper,
    beam,
    cantilever,
)

names = pytest.mark.parametrize("element", KINDS, ids=lambda element: element.name)


@dataclass(frozen=True)
class Body:
    """A mass [kg] with a moment of inertia [kg m^2]."""

    point: bf.Point
    mass: float
    inertia: float
    unknowns = 0
    conservative = True

    @property
    def points(self):
        return (self.point,)

    def force(self, at):
        return np.array([self.mass, self.mass, self.inertia]) * at.a[0]

    def energy(self, at):
        return 0.5 * (np.array([self.mass, self.mass, self.inertia]) * at.v[0] ** 2).sum(), 0.0


@dataclass(frozen=True)
class Follower:
    """A force [N] that turns with the section."""

    point: bf.Point
    size: float
    unknowns = 0
    conservative = False

    @property
    def points(self):
        return (self.point,)

    def force(self, at):
        turn = at.q[0, 2]
        return np.array([self.size * np.sin(turn), -self.size * np.cos(turn), 0.0 * turn])

    def energy(self, at):
        return 0.0, 0.0


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
    assert height[-1] / height[0] == pytest.approx(np.exp(-2 * 0.05 * rate * period), rel=1e-4)
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
        parts = [SpringDamper(one.end, two.at(0.5), 9 * BENDING), PointMass(two.end, 0.2)]
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
    with pytest.raises(bf.InputError, match="not a connector of this model"):
        solution.multipliers(Anchor(own.end, (1.0, 1.0, 1.0)))


@pytest.mark.parametrize("stiffness", [(1e12, 1e12, 100.0), (1e10, 1e10, 1.0)])
def test_stiff_anchors_hold_turns_with_soft_ones(stiffness):
    own = beam()
    load = [bf.PointForce(own.end, (0.0, 1e-3))]
    one = bf.solve_static(bf.Model([own], [], load, connectors=[Anchor(own.start, stiffness)]))
    other = bf.solve_static(bf.Model([own], [bf.Spring(own.start, stiffness[:2], rotational=stiffness[2])], load))
    assert one.position(own.end)[-1] == pytest.approx(other.position(own.end)[-1], abs=1e-7)


@pytest.mark.parametrize("apart", [0.0, 1e-12, 1e-6])
def test_a_bush_between_points_that_nearly_coincide_is_taken(apart):
    one, two = beam(), beam(start=(1.0 + apart, 0.0), end=(2.0, 0.0))

    @dataclass(frozen=True)
    class Bush(SpringDamper):
        def force(self, at):
            pull = self.stiffness * (at.q[1] - at.q[0] - at.reference[1] + at.reference[0])
            return np.concatenate([-pull, pull])

        def energy(self, at):
            moved = at.q[1] - at.q[0] - at.reference[1] + at.reference[0]
            return 0.0, 0.5 * self.stiffness * (moved @ moved)

    supports, load = [bf.Clamp(one.start), bf.Clamp(two.end)], [bf.PointForce(one.end, (0.0, 1.0))]
    solution = bf.solve_static(bf.Model([one, two], supports, load, connectors=[Bush(one.end, two.start, 1e5)]))
    assert solution.displacement(two.start)[-1] == pytest.approx(solution.displacement(one.end)[-1], abs=1e-4)


def test_a_bar_that_lies_on_connectors_has_digits():
    """Its weight is what acts: "round-off leaves no digit of the forces" was said, for want of loads and supports."""
    bar, springs = beam(elements=2), (1e6, 1e6)
    found = []
    for supports, connectors in (
        ([bf.Spring(end, springs) for end in (bar.start, bar.end)], []),
        ([], [Anchor(end, (*springs, 0.0)) for end in (bar.start, bar.end)]),
    ):
        found.append(bf.solve_static(bf.Model([bar], supports, [bf.Gravity((0.0, -9.81))], connectors=connectors)))
    assert found[1].statistics.digits > 6.0
    expected, other = (solution.displacement(bar.at(0.5))[-1] for solution in found)
    assert other == pytest.approx(expected, rel=1e-7, abs=1e-12)


@pytest.mark.parametrize("turning", [0.0, 3.0])
def test_the_angular_momentum_of_a_mass_is_its_moment_of_momentum_about_the_origin(turning):
    """m (x vy - y vx) + J theta' for a body at (1, 2), beside what the bar has."""
    bar = bf.Beam(bf.Line((0, 2), (1, 2)), 2, bf.CRBF(2), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    velocity = bf.RigidVelocity((4.0, 5.0), turning, (0.0, 0.0))
    vx, vy = 4.0 - turning * 2.0, 5.0 + turning * 1.0
    body = Body(bar.end, 0.3, 0.02)
    with_body, without = (
        bf.simulate(bf.Model([bar], connectors=items), 1e-6, 1e-6, velocity=velocity).angular_momentum()[0]
        for items in ([body], [])
    )
    assert with_body - without == pytest.approx(0.3 * (1.0 * vy - 2.0 * vx) + 0.02 * turning, rel=1e-9)


def test_dissipation_is_unknown_beside_a_connector_that_is_not_conservative():
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    stop = Follower(bar.end, 1.0)
    solution = bf.solve_static(bf.Model([bar], [bf.Clamp(bar.start)], connectors=[stop]))
    assert np.isnan(solution.energy().dissipated).all()
