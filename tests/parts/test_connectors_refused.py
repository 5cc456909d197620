"""What is no connector, or asks for what an analysis cannot do, is refused by name."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf
from beamfem.testing import check_connector
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
class HalfAbsolute(Anchor):
    """One component by its absolute value: 0 is that of ux, 2 the moment."""

    component: int = 0

    def force(self, at):
        force = super().force(at)
        force[self.component] = np.abs(force[self.component])
        return force


@dataclass(frozen=True)
class Forgetful(Anchor):
    """A potential without one component."""

    component: int = 0

    def energy(self, at):
        moved = (at.q - at.reference)[0]
        moved[self.component] = 0.0
        return 0.0, 0.5 * float((np.array(self.stiffness) * moved**2).sum())


@dataclass(frozen=True)
class OneSided(Anchor):
    """A force along uy that grows with the rotation, whose moment knows nothing of it."""

    coupling: float = 0.0

    def force(self, at):
        return super().force(at) + np.array([0.0, self.coupling * at.q[0, 2], 0.0])


@dataclass(frozen=True)
class Flywheel(PointMass):
    """A mass with rotary inertia [kg m^2]; kept: which of both the kinetic energy has."""

    inertia: float = 0.0
    kept: tuple[bool, bool] = (True, True)

    def force(self, at):
        return super().force(at) + np.array([0.0, 0.0, self.inertia * at.a[0, 2]])

    def energy(self, at):
        moving, potential = super().energy(at)
        return moving * self.kept[0] + 0.5 * self.inertia * at.v[0, 2] ** 2 * self.kept[1], potential


@dataclass(frozen=True)
class Friction:
    """Friction [N] against ux, turned over within a speed [m/s]."""

    point: bf.Point
    most: float
    speed: float
    unknowns = 0
    conservative = False

    @property
    def points(self):
        return (self.point,)

    def force(self, at):
        return self.most * np.tanh(at.v[0] / self.speed) * np.array([1.0, 0.0, 0.0])

    def energy(self, at):
        return 0.0, 0.0


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
        with pytest.raises(AssertionError, match=words):
            check_connector(part)


@pytest.mark.slow
def test_forces_that_are_no_numbers_end_in_named_errors():
    own = beam()
    with pytest.raises(bf.InputError, match="force or energy of Undefined is not finite near the reference"):
        bf.solve_static(cantilever(own, [], [Undefined(own.end, (0.2, 1.0, 1.0))]))
    load = [bf.PointForce(own.end, (0.0, BENDING))]
    with pytest.raises(bf.ConvergenceError) as caught:
        bf.solve_static(cantilever(own, load, [Undefined(own.end, (0.85, 1.0, 1.0))]), steps=5)
    assert caught.value.solution.at[-1] > 0.5


def test_conditions_of_motions_are_independent_of_each_other():
    _, model = crossbar(RigidLink)
    twice = bf.Model(model.beams, model.supports, connectors=2 * [*model.connectors[:1]])
    with pytest.raises(bf.InputError, match=r"conditions of connectors \(RigidLink at .* are redundant"):
        bf.simulate(twice, 0.1, 1e-3)
    held = [bf.Clamp(end) for own in model.beams for end in (own.start, own.end)]
    with pytest.raises(bf.InputError, match=r"conditions of connectors \(RigidLink at .* are redundant"):
        bf.simulate(bf.Model(model.beams, held, connectors=model.connectors[:1]), 0.1, 1e-3)


def test_conditions_that_say_the_same_twice_are_refused_in_statics():
    left, right, model = portal(0.4)
    slack = bf.Model([left, right], model.supports, model.loads, connectors=[*model.connectors, *model.connectors])
    held = bf.Model([left, right], [*model.supports, bf.Pin(left.end), bf.Pin(right.end)], connectors=model.connectors)
    for wrong in (slack, held):
        with pytest.raises(bf.InputError, match=r"conditions of connectors \(RigidLink at .* are redundant"):
            bf.solve_static(wrong)
    normal = np.array([np.cos(0.4), np.sin(0.4)])
    roller = bf.Roller(left.end, tuple(normal))
    more = bf.Model([left, right], [*model.supports, roller], model.loads, connectors=model.connectors)
    assert bf.solve_static(more).displacement(left.end)[-1] @ normal == pytest.approx(0.0, abs=1e-12)


def test_what_is_no_connector_is_refused():
    own = beam()
    stiffness = (1.0, 1.0, 1.0)
    for kind, words in ((Absolute, "no analytic function of q"), (Uneven, "not symmetric")):
        with pytest.raises(AssertionError, match=words):
            check_connector(kind(own.end, stiffness))
    with pytest.raises(bf.InputError, match="must return 3 numbers"):
        bf.solve_static(cantilever(own, [], [Short(own.end, stiffness)]))
    with pytest.raises(bf.InputError, match="must return 3 numbers"):
        check_connector(Short(own.end, stiffness))
    with pytest.raises(bf.InputError, match="connectors of a Model cannot hold"):
        cantilever(own, [], [bf.Pin(own.end)])
    with pytest.raises(bf.UnknownPointError, match="not in this model"):
        cantilever(own, [], [Anchor(beam().end, stiffness)])
    with pytest.raises(bf.InputError, match="lists a point twice"):
        cantilever(own, [], [SpringDamper(own.end, own.end)])
    with pytest.raises(bf.InputError, match="has no points"):
        cantilever(own, [], [Nowhere(own.end, stiffness)])


OWN = beam()
TOP, FOOT = OWN.end, OWN.start
HUGE = {
    "stiffness of SpringDamper": lambda k: bf.SpringDamper(TOP, (9.0, 9.0), k),
    "damping of SpringDamper": lambda k: bf.SpringDamper(TOP, (9.0, 9.0), 1.0, k),
    "b of SpringDamper": lambda k: bf.SpringDamper(TOP, (9.0, k), 1.0),
    "stiffness of Cable": lambda k: bf.Cable(TOP, (9.0, 9.0), k),
    "stiffness of TorsionSpring": lambda k: bf.TorsionSpring(FOOT, TOP, k),
    "damping of Bushing": lambda k: bf.Bushing(FOOT, TOP, (1.0, 1.0, 1.0), (0.0, 0.0, k)),
    "stiffness of Slider": lambda k: bf.Slider(FOOT, TOP, (1, 0), 0.1, k),
    "ratio of Gear": lambda k: bf.Gear(FOOT, TOP, k),
    "stiffness of Stop": lambda k: bf.Stop(TOP, (0, 0), (0, 1), k),
    "stiffness of HingeStop": lambda k: bf.HingeStop(FOOT, TOP, low=0.0, stiffness=k),
    "torque of HingeFriction": lambda k: bf.HingeFriction(FOOT, TOP, k, 1.0),
    "coefficient of Drag": lambda k: bf.Drag(OWN, k),
    "mass of PointMass": lambda k: bf.PointMass(TOP, k),
    "inertia of RigidBody": lambda k: bf.RigidBody(TOP, 1.0, k),
}


@pytest.mark.parametrize("name", HUGE)
def test_numbers_that_would_overflow_within_a_solve_are_refused_before_it(name):
    with pytest.raises(bf.InputError, match=rf"{name} is 1e\+308, which double precision cannot square"):
        HUGE[name](1e308)


def test_starts_that_break_a_condition_are_refused():
    two, model = crossbar(RigidLink)
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


WRONG = {
    "a force by its absolute value": (
        lambda p, m, n: HalfAbsolute(p, (1e2 * n / m, 1e2 * n / m, 10.0 * n * m)),
        "force of HalfAbsolute is no analytic function of q",
    ),
    "a moment by its absolute value": (
        lambda p, m, n: HalfAbsolute(p, (1e2 * n / m, 1e2 * n / m, 10.0 * n * m), 2),
        "force of HalfAbsolute is no analytic function of q",
    ),
    "a potential without ux": (
        lambda p, m, n: Forgetful(p, (1e2 * n / m, 1e2 * n / m, 10.0 * n * m)),
        "potential of its energy",
    ),
    "a potential without the rotation": (
        lambda p, m, n: Forgetful(p, (1e2 * n / m, 1e2 * n / m, 10.0 * n * m), 2),
        "potential of its energy",
    ),
    "a force without its moment": (
        lambda p, m, n: OneSided(p, (1e2 * n / m, 1e2 * n / m, 10.0 * n * m), n),
        "stiffness is not symmetric",
    ),
    "no energy of rotation": (
        lambda p, m, n: Flywheel(p, 3.0 * n / m, 0.1 * n * m, (True, False)),
        "Flywheel is conservative, but the kinetic energy of its energy.. is not that of its force",
    ),
    "no energy of translation": (
        lambda p, m, n: Flywheel(p, 3.0 * n / m, 0.1 * n * m, (False, True)),
        "Flywheel is conservative, but the kinetic energy of its energy.. is not that of its force",
    ),
}
RIGHT = {
    "soft beside stiff in torsion": lambda p, m, n: Anchor(p, (1.0 * n / m, 1e6 * n / m, 1e6 * n * m)),
    "stiff beside soft in torsion": lambda p, m, n: Anchor(p, (1e6 * n / m, 1e6 * n / m, 1.0 * n * m)),
    "mass and rotary inertia": lambda p, m, n: Flywheel(p, 3.0 * n / m, 0.1 * n * m),
    "friction": lambda p, m, n: Friction(p, 10.0 * n, 1e-3 * m),
}
UNITS = {
    "m N": (1.0, 1.0),
    "mm N": (1e3, 1.0),
    "km GN": (1e-3, 1e-9),
    "um uN": (1e6, 1e6),
    "of a micrometre": (1e-6, 1e-12),
    "nm nN": (1e9, 1e9),
}


def in_units(part, metre, newton):
    material = bf.Material(2e11 * newton / metre**2, 0.3, 7800.0 * newton / metre**4)
    section = bf.Rectangle(0.01 * metre, 0.01 * metre)
    own = bf.Beam(bf.Line((0.0, 0.0), (metre, 0.0)), 2, bf.CRBF(2), section, material)
    return bf.Model([own], [bf.Clamp(own.start)], connectors=[part(own.end, metre, newton)])


@pytest.mark.parametrize(("part", "told"), WRONG.values(), ids=WRONG)
@pytest.mark.parametrize("units", UNITS.values(), ids=UNITS)
def test_a_wrong_connector_is_refused_in_any_units(part, told, units):
    """Forces beside moments, in N/mm beside N mm, went unnoticed, as did moments in a model in km."""
    with pytest.raises(AssertionError, match=told):
        check_connector(in_units(part, *units).connectors[0])


@pytest.mark.parametrize("part", RIGHT.values(), ids=RIGHT)
@pytest.mark.parametrize("units", UNITS.values(), ids=UNITS)
def test_a_right_connector_is_taken_in_any_units(part, units):
    """A mass and a friction were called not analytic in a model in nm, and in a beam of a micrometre."""
    model = in_units(part, *units)
    check_connector(model.connectors[0])
    bf.solve_static(model)
