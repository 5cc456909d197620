"""What is no connector, or asks for what an analysis cannot do, is refused by name."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf
from tests.connectors import (
    BENDING,
    Anchor,
    PointMass,
    RigidLink,
    SpringDamper,
    beam,
    cantilever,
    crossbar,
    portal,
)


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


@dataclass(frozen=True)
class Nowhere(Anchor):
    points = ()


@dataclass(frozen=True)
class Driven(Anchor):
    conservative = False

    def force(self, at):
        return np.array([0.0 * at.q[0, 0], np.sin(300.0 * at.time), 0.0])


@dataclass(frozen=True)
class Undefined(Anchor):
    def force(self, at):
        return super().force(at) + (np.nan if at.time > self.stiffness[0] else 0.0)


@dataclass(frozen=True)
class Unlike(Anchor):
    def energy(self, at):
        return 0.0, 0.0


@dataclass(frozen=True)
class Heavy(PointMass):
    def energy(self, at):
        return 0.5 * self.mass * float(np.linalg.norm(at.v[0, :2])) ** 2, super().energy(at)[1]


@dataclass(frozen=True)
class Growing(RigidLink):
    def force(self, at):
        return super().force(at) + np.array(6 * [0.0] + [0.1 * at.time])


def test_modes_refuse_dampers():
    own, ground = beam(), beam(start=(1.0, -1.0), end=(2.0, -1.0))
    supports = [bf.Clamp(own.start), bf.Clamp(ground.start)]
    with pytest.raises(bf.InputError, match="the force of SpringDamper depends on velocities"):
        bf.solve_modes(bf.Model([own, ground], supports, connectors=[SpringDamper(ground.start, own.end, 100.0, 5.0)]))


def test_a_force_that_follows_time_drives_a_motion():
    own = beam()
    assert bf.simulate(cantilever(own, [], [Driven(own.end, (1.0, 1.0, 1.0))]), 0.01, 1e-3).energy_drift is None


def test_energies_are_those_of_the_forces():
    own = beam()
    for part, words in (
        (Unlike(own.end, (1.0, 1.0, 1.0)), "potential of its energy"),
        (Heavy(own.end, 1.0), "kinetic energy of Heavy is no analytic function"),
    ):
        with pytest.raises(bf.InputError, match=words):
            bf.simulate(cantilever(own, [], [part]), 0.01, 1e-3)


def test_forces_that_are_no_numbers_end_in_named_errors():
    own = beam()
    with pytest.raises(bf.InputError, match="force of Undefined is not finite near the reference"):
        bf.solve_static(cantilever(own, [], [Undefined(own.end, (0.2, 1.0, 1.0))]))
    load = [bf.PointForce(own.end, (0.0, BENDING))]
    with pytest.raises(bf.ConvergenceError) as caught:
        bf.solve_static(cantilever(own, load, [Undefined(own.end, (0.85, 1.0, 1.0))]), steps=5)
    assert caught.value.solution.at[-1] > 0.5


def test_conditions_of_motions_are_independent_of_time_and_each_other():
    two, model = crossbar(RigidLink)
    growing = bf.Model(model.beams, model.supports, connectors=[Growing(model.beams[0].end, two.end)])
    with pytest.raises(bf.InputError, match="conditions of Growing depend on time"):
        bf.simulate(growing, 0.1, 1e-3)
    twice = bf.Model(model.beams, model.supports, connectors=2 * [*model.connectors[:1]])
    with pytest.raises(bf.BeamfemError):
        bf.simulate(twice, 0.1, 1e-3)
    held = [bf.Clamp(end) for own in model.beams for end in (own.start, own.end)]
    with pytest.raises(bf.InputError, match=r"conditions of connectors \(RigidLink\) are redundant"):
        bf.simulate(bf.Model(model.beams, held, connectors=model.connectors[:1]), 0.1, 1e-3)


def test_conditions_that_say_the_same_twice_are_refused_in_statics():
    left, right, model = portal(0.4)
    slack = bf.Model([left, right], model.supports, model.loads, connectors=[*model.connectors, *model.connectors])
    held = bf.Model([left, right], [*model.supports, bf.Pin(left.end), bf.Pin(right.end)], connectors=model.connectors)
    for wrong in (slack, held):
        with pytest.raises(bf.InputError, match=r"conditions of connectors \(RigidLink\) are redundant"):
            bf.solve_static(wrong)
    normal = np.array([np.cos(0.4), np.sin(0.4)])
    roller = bf.Roller(left.end, tuple(normal))
    more = bf.Model([left, right], [*model.supports, roller], model.loads, connectors=model.connectors)
    assert bf.solve_static(more).displacement(left.end)[-1] @ normal == pytest.approx(0.0, abs=1e-12)


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
    with pytest.raises(bf.InputError, match="has no points"):
        cantilever(own, [], [Nowhere(own.end, stiffness)])
    _, _, model = portal()
    for solve in (bf.solve_modes, bf.solve_buckling, bf.trace_equilibrium):
        with pytest.raises(
            bf.InputError, match="does not support connectors with unknowns of their own, such as RigidLink"
        ):
            solve(model)


def test_starts_that_break_a_condition_are_refused():
    two, model = crossbar(RigidLink)
    with pytest.raises(bf.InputError, match="the initial velocity does not satisfy the conditions of RigidLink"):
        bf.simulate(model, 0.1, 1e-3, velocity=lambda x: (0.0, x[0] * x[1]))
    apart = bf.Model(model.beams, model.supports, [bf.PointMoment(two.start, 1.0)], connectors=())
    state = bf.simulate(apart, 0.05, 1e-3)[-1]
    with pytest.raises(bf.InputError, match="the start of the motion does not satisfy the conditions of RigidLink"):
        bf.simulate(model, 0.1, 1e-3, start=state)


def test_results_with_connectors_of_ones_own_say_why_they_cannot_be_saved(tmp_path):
    @dataclass(frozen=True)
    class Local(Anchor):
        pass

    own = beam()
    solution = bf.solve_static(cantilever(own, [], [Local(own.end, (1.0, 1.0, 1.0))]))
    with pytest.raises(bf.InputError, match="a Local cannot be saved: define its class at the top level of a module"):
        solution.save(tmp_path / "own.h5")
    solution.plot(tmp_path / "own.png")
    solution.to_vtk(tmp_path / "own.vtkhdf")
