"""Connectors with `rotations = False` leave elements with gradients as they are, stretch of the thickness included."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf
from beamfem.testing import check_connector
from tests.connectors import BENDING, KINDS, Anchor, PointMass, RigidLink, SpringDamper, beam, cantilever


@dataclass(frozen=True)
class Spring(Anchor):
    """Springs to the place of a point in the reference, without rotations unless stated."""

    rotations: bool = False


@dataclass(frozen=True)
class Mass(PointMass):
    rotations: bool = False


@dataclass(frozen=True)
class Link(RigidLink):
    rotations = False


@dataclass(frozen=True)
class Damper(SpringDamper):
    rotations = False


@dataclass(frozen=True)
class Wheel(Mass):
    """A mass whose kinetic energy, but not its force, contains its spin."""

    def energy(self, at):
        kinetic, potential = super().energy(at)
        return kinetic + 0.5 * at.v[0, 2] ** 2, potential


@dataclass(frozen=True)
class Lifted(Mass):
    """A mass with a force that grows with the rotation."""

    def force(self, at):
        return super().force(at) + np.array([0.0, 1.0, 0.0]) * at.q[0, 2]


@dataclass(frozen=True)
class Bracket(Link):
    """A link whose pull acts beside its points."""

    def force(self, at):
        force = super().force(at)
        force[2] = 0.1 * force[1]
        return force


@dataclass(frozen=True)
class SideForce(Link):
    """A link that pushes its second point aside as well."""

    def force(self, at):
        force = super().force(at)
        force[3] += 0.5 * at.own[0]
        return force


def loaded(element=KINDS[0]):
    own = beam(element)
    return own, [bf.PointForce(own.end, (0.0, 2.0 * BENDING)), bf.PointForce(own.at(0.5), (0.0, 0.0))]


def test_a_force_of_zero_changes_nothing_on_gradients():
    """The angle of a connector with rotations keeps the thickness constant: the tip moves by 1.5 % of the length."""
    own, loads = loaded()
    none, turned, free = (
        cantilever(own, loads, parts)
        for parts in ([], [Mass(own.at(0.5), 0.0, rotations=True)], [Mass(own.at(0.5), 0.0)])
    )
    assert free.coordinates == none.coordinates == turned.coordinates + 1
    one, two, other = (bf.solve_static(model) for model in (none, turned, free))
    assert np.array_equal(one.p, other.p)
    assert np.abs(one.position(own.end) - two.position(own.end)).max() > 1e-2
    modes = [bf.solve_modes(model, count=4) for model in (none, free)]
    assert np.array_equal(modes[0].frequencies, modes[1].frequencies)
    assert np.array_equal(modes[0].modes, modes[1].modes)
    # motions with any connector keep tangents for longer; the clamp has an angle anyway
    beside = cantilever(own, loads, [Mass(own.start, 0.0, rotations=True)])
    motions = [bf.simulate(model, 0.02, 1e-4) for model in (none, free, beside)]
    assert motions[1].p == pytest.approx(motions[0].p, abs=1e-10)
    assert np.array_equal(motions[1].p, motions[2].p)


def test_springs_without_rotations_are_spring_supports_on_gradients():
    own, loads = loaded()
    stiffness = (3.0 * BENDING, 20.0 * BENDING)
    middle = own.at(0.5)
    models = [
        cantilever(own, loads, supports=[bf.Spring(middle, stiffness)]),
        cantilever(own, loads, [Spring(middle, (*stiffness, 0.0))]),
    ]
    assert models[0].coordinates == models[1].coordinates
    one, other = (bf.solve_static(model) for model in models)
    assert other.p == pytest.approx(one.p, abs=1e-10)
    assert other.reaction(own.start)[-1] == pytest.approx(one.reaction(own.start)[-1], rel=1e-8)
    assert other.energy().total[-1] == pytest.approx(one.energy().total[-1], rel=1e-9)
    force = other.connector_force(models[1].connectors[0])
    moved = other.displacement(middle)
    assert force.shape == (len(other), 1, 3)
    assert force[-1, 0] == pytest.approx([*(-np.array(stiffness) * moved[-1]), 0.0], rel=1e-12)
    one, other = (bf.solve_modes(model, count=4).frequencies for model in models)
    assert other == pytest.approx(one, rel=1e-9)
    one, other = (bf.simulate(model, 0.02, 1e-4) for model in models)
    assert other.position(own.end) == pytest.approx(one.position(own.end), abs=1e-9)


def test_buckling_with_springs_without_rotations():
    own = beam(KINDS[0], elements=8)
    push = [bf.PointForce(own.end, (-BENDING, 0.0))]
    middle, stiffness = own.at(0.5), (0.0, 40.0 * BENDING)
    models = [
        cantilever(own, push, supports=[bf.Spring(middle, stiffness)]),
        cantilever(own, push, [Spring(middle, (*stiffness, 0.0))]),
    ]
    one, other = (bf.solve_buckling(model, count=2).load_factors for model in models)
    assert other == pytest.approx(one, rel=1e-8)


def test_springs_without_rotations_alone_hold_a_beam():
    """Which motions connectors stop is found without their rotations."""
    own = beam(KINDS[0])
    stiff, soft = (1e6, 1e6, 0.0), (0.0, 1e6, 0.0)
    load = [bf.PointForce(own.at(0.5), (0.0, 10.0))]
    held = bf.Model([own], [], load, connectors=[Spring(own.start, stiff), Spring(own.end, soft)])
    expected = bf.Model([own], [bf.Spring(own.start, stiff[:2]), bf.Spring(own.end, soft[:2])], load)
    one, other = (bf.solve_static(model).displacement(own.at(0.5))[-1] for model in (expected, held))
    assert other == pytest.approx(one, rel=1e-7, abs=1e-12)
    with pytest.raises(bf.FreeMotionError):
        bf.solve_static(bf.Model([own], [], load, connectors=[Spring(own.start, stiff)]))


def test_masses_and_springs_without_rotations_keep_momenta_and_energy():
    one, two = beam(KINDS[0]), beam(KINDS[0], (0.0, 0.5), (1.0, 0.8))
    parts = [Damper(one.end, two.end, 200.0), Mass(one.start, 0.1), Mass(two.at(0.5), 0.4)]
    model = bf.Model([one, two], connectors=parts)
    bare = bf.Model([one, two], loads=[bf.PointForce(part.points[-1], (0.0, 0.0)) for part in parts])
    assert model.coordinates == bare.coordinates
    flight = bf.RigidVelocity((1.0, 2.0), 3.0, (0.2, 0.1))
    motion, light = (bf.simulate(each, 0.05, 2e-4, velocity=flight) for each in (model, bare))
    linear, angular = motion.linear_momentum(), motion.angular_momentum()
    points = [(0.1, np.array([0.0, 0.0])), (0.4, two.at(0.5).reference)]
    velocities = [np.array([1.0, 2.0]) + 3.0 * np.array([-(y - 0.1), x - 0.2]) for _, (x, y) in points]
    added = sum(m * v for (m, _), v in zip(points, velocities, strict=True))
    turn = sum(m * (x * v[1] - y * v[0]) for (m, (x, y)), v in zip(points, velocities, strict=True))
    assert linear[0] - light.linear_momentum()[0] == pytest.approx(added, rel=1e-9)
    assert angular[0] - light.angular_momentum()[0] == pytest.approx(turn, rel=1e-9)
    assert linear == pytest.approx(np.broadcast_to(linear[0], linear.shape), abs=1e-6 * np.abs(linear).max())
    assert angular == pytest.approx(np.full(len(angular), angular[0]), rel=1e-5)
    total = motion.energy().total
    assert total == pytest.approx(np.full(len(total), total[0]), rel=1e-4)


def test_a_link_without_rotations_holds_its_distance_on_gradients():
    left, right = beam(KINDS[0], (0.0, 0.0), (0.0, 1.0)), beam(KINDS[0], (1.5, 0.0), (1.5, 1.0))
    link = Link(left.at(0.5), right.at(0.5))
    supports = [bf.Clamp(left.start), bf.Clamp(right.start)]
    loads = [bf.PointForce(right.end, (0.5 * BENDING, 0.0)), bf.PointForce(left.at(0.5), (0.0, 0.0))]
    model = bf.Model([left, right], supports, loads, connectors=[link])
    loads.append(bf.PointForce(right.at(0.5), (0.0, 0.0)))
    assert model.coordinates == bf.Model([left, right], supports, loads).coordinates
    for solution in (bf.solve_static(model), bf.simulate(model, 0.02, 2e-4)):
        between = solution.position(link.b) - solution.position(link.a)
        assert np.hypot(*between.T) == pytest.approx(np.full(len(solution), 1.5), rel=1e-9)
        assert np.abs(solution.displacement(link.b)[-1]).max() > 1e-3
        pull, forces = solution.multipliers(link)[-1, 0], solution.connector_force(link)[-1]
        assert forces[0, :2] == pytest.approx(pull * between[-1] / 1.5, rel=1e-9)
        assert not forces[:, 2].any()


def test_rotations_make_no_difference_where_nodes_have_angles():
    own, loads = loaded(KINDS[1])
    middle, stiffness = own.at(0.5), (3.0 * BENDING, 20.0 * BENDING, 0.0)
    models = [
        cantilever(own, loads, [Mass(own.end, 0.2, turns), Spring(middle, stiffness, turns)]) for turns in (True, False)
    ]
    assert models[0].coordinates == models[1].coordinates
    for solve in (bf.solve_static, lambda model: bf.simulate(model, 0.02, 1e-4)):
        one, other = (solve(model) for model in models)
        assert other.p == pytest.approx(one.p, abs=1e-10)
    one, other = (bf.solve_modes(model, count=4).frequencies for model in models)
    assert other == pytest.approx(one, rel=1e-10)


@pytest.mark.parametrize("element", KINDS[:2], ids=lambda element: element.name)
def test_connectors_with_and_without_rotations_at_one_point(element):
    own, loads = loaded(element)
    middle = own.at(0.5)
    turning, straight = (0.0, 0.0, 0.5 * BENDING), (3.0 * BENDING, 20.0 * BENDING, 0.0)
    models = [
        cantilever(own, loads, [Spring(middle, turning, True), Spring(middle, straight), Mass(middle, 0.2)]),
        cantilever(own, loads, [Spring(middle, (*straight[:2], turning[2]), True), Mass(middle, 0.2, True)]),
    ]
    assert models[0].coordinates == models[1].coordinates
    for solve in (bf.solve_static, lambda model: bf.simulate(model, 0.02, 1e-4)):
        one, other = (solve(model) for model in models)
        assert other.p == pytest.approx(one.p, abs=1e-9)
    one, other = (bf.solve_modes(model, count=4).frequencies for model in models)
    assert other == pytest.approx(one, rel=1e-9)


def test_what_needs_rotations_is_refused():
    own, other = beam(KINDS[0]), beam(KINDS[0], (0.0, 1.0), (1.0, 1.5))
    for part, words in (
        (Spring(own.end, (1.0, 1.0, 1.0)), r"Spring has rotations = False, so its moments must be zero.*points\[0\]"),
        (Bracket(own.end, other.end), r"Bracket has rotations = False, so its moments must be zero.*points\[0\]"),
        (Mass(own.end, 1.0, rotations="no"), "rotations of Mass must be True or False"),
    ):
        with pytest.raises(bf.InputError, match=words):
            bf.solve_static(bf.Model([own, other], [bf.Clamp(own.start), bf.Clamp(other.start)], connectors=[part]))
    for part, words in (
        (Wheel(own.end, 1.0), "Wheel has rotations = False, but its energy depends on the rotations"),
        (Lifted(own.end, 1.0), "Lifted has rotations = False, but its force depends on the rotations"),
        (SideForce(own.end, other.end), r"SideForce: .* do work in motions .*; f[xy] at points\[1\] is not"),
    ):
        with pytest.raises(AssertionError, match=words):
            check_connector(part)


@pytest.mark.filterwarnings("ignore::beamfem.EnergyWarning")  # ten steps, of which the start counts
def test_a_start_goes_between_models_with_and_without_angles():
    own, loads = loaded()
    middle = own.at(0.5)
    bent = bf.solve_static(cantilever(own, loads, [Mass(middle, 0.1)]))
    for turns in (False, True):
        motion = bf.simulate(cantilever(own, loads, [Mass(middle, 0.1, turns)]), 1e-3, 1e-4, start=bent[-1])
        assert motion.position(middle)[0] == pytest.approx(bent.position(middle)[-1], abs=1e-12)


def test_results_of_connectors_without_rotations_are_saved_and_written(tmp_path):
    own, loads = loaded()
    other = beam(KINDS[0], (0.0, 1.0), (1.0, 1.0))
    link, mass = Link(own.end, other.end), Mass(own.at(0.5), 0.1)
    model = bf.Model([own, other], [bf.Clamp(own.start), bf.Clamp(other.start)], loads, connectors=[link, mass])
    solution = bf.solve_static(model)
    solution.save(tmp_path / "own.h5")
    loaded_again = bf.load(tmp_path / "own.h5")
    assert np.array_equal(loaded_again.p, solution.p)
    assert loaded_again.model.coordinates == model.coordinates
    for before, after in zip(model.connectors, loaded_again.model.connectors, strict=True):
        assert after.rotations is False
        assert np.array_equal(loaded_again.connector_force(after), solution.connector_force(before))
    solution.to_vtk(tmp_path / "own.vtkhdf")
