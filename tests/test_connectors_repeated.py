"""Connectors of one class in one model: each of them is checked, later ones by fewer calls than the first."""

import re
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np
import pytest

import beamfem as bf
from beamfem.assembly.connectors import connectors_of
from tests.connectors import STEEL, Anchor, PointMass, RigidLink, SpringDamper, beam
from tests.test_connectors_conditions import (
    HalfLever,
    HalfLeverOnADamper,
    InAnotherOrder,
    Offset,
    OfTheOtherSign,
    Wheel,
)
from tests.test_connectors_refused import RIGHT, UNITS, WRONG, Absolute, Heavy, Uneven, Unlike, in_units

STIFF = (1e3, 2e3, 30.0)


@dataclass(frozen=True)
class AnyPart:
    """A part of any kind, so that a wrong one has the class of a right one."""

    part: Any

    @property
    def points(self):
        return self.part.points

    @property
    def unknowns(self):
        return self.part.unknowns

    @property
    def conservative(self):
        return self.part.conservative

    def force(self, at):
        return self.part.force(at)

    def energy(self, at):
        return self.part.energy(at)


@dataclass(frozen=True)
class Counted(SpringDamper):
    """A spring and damper that counts how often it is asked for its force, by its stiffness."""

    asked: ClassVar[dict[float, int]] = {}

    def force(self, at):
        self.asked[self.stiffness] = self.asked.get(self.stiffness, 0) + 1
        return super().force(at)


@dataclass(frozen=True)
class ComplexEnergyLost(Anchor):
    """A kinetic energy in which complex numbers do not stay complex."""

    def energy(self, at):
        return 0.5 * float(np.real(at.v[0] @ at.v[0])), super().energy(at)[1]


class AsymmetricConditions(RigidLink):
    """Two points keep their distance, by a multiplier that pulls one of them by half."""

    def force(self, at):
        force = super().force(at)
        return np.concatenate([0.5 * force[:3], force[3:]])


@dataclass(frozen=True)
class Linear:
    """Linear springs and masses between all coordinates of some points; those of the energy may be others."""

    points: tuple[bf.Point, ...]
    stiffness: np.ndarray
    mass: np.ndarray
    stiffness_of_energy: np.ndarray
    mass_of_energy: np.ndarray
    unknowns = 0
    conservative = True

    def force(self, at):
        return self.stiffness @ (at.q - at.reference).ravel() + self.mass @ at.a.ravel()

    def energy(self, at):
        moved, rate = (at.q - at.reference).ravel(), at.v.ravel()
        return 0.5 * rate @ self.mass_of_energy @ rate, 0.5 * moved @ self.stiffness_of_energy @ moved


def linear(points, wrong=None, row=0, column=0):
    """Return a part of which one entry of a matrix is wrong by a thousandth of the largest."""
    rng, number = np.random.default_rng(7), 3 * len(points)
    length = np.tile([points[0].beam.curve.length] * 2 + [1.0], len(points))
    matrices = {}
    for name in ("stiffness", "mass"):
        root = rng.standard_normal((number, number))
        table = root @ root.T
        for of in (name, f"{name}_of_energy"):
            matrices[of] = table.copy()
            matrices[of][row, column] += 1e-3 * table.max() * (of == wrong)
            matrices[of] /= np.multiply.outer(length, length)
    return Linear(points, **matrices)


def is_refused(own, *parts):
    try:
        connectors_of(bf.Model([own], [bf.Clamp(own.start)], connectors=parts), static=True)
    except bf.InputError:
        return True
    return False


def refused(right, wrong, own):
    """Solve a model in which a wrong part follows a right one of its class; return what is said of it alone."""

    def solve(*parts):
        with pytest.raises(bf.InputError) as refusal:
            bf.solve_static(bf.Model([own], [bf.Clamp(own.start)], connectors=[AnyPart(part) for part in parts]))
        return str(refusal.value)

    return solve(wrong), solve(right, wrong)


@pytest.mark.parametrize("units", UNITS.values(), ids=UNITS)
@pytest.mark.parametrize(("part", "told"), WRONG.values(), ids=WRONG)
def test_a_wrong_part_after_a_right_one_of_its_class_is_refused_in_any_units(part, told, units):
    model = in_units(part, *units)
    own, wrong = model.beams[0], model.connectors[0]
    metre, newton = units
    right = (
        PointMass(own.at(0.5), newton / metre)
        if isinstance(wrong, PointMass)
        else Anchor(own.at(0.5), (newton / metre, newton / metre, newton * metre))
    )
    alone, after = refused(right, wrong, own)
    assert re.search(told.replace(type(wrong).__name__, "AnyPart"), after)
    assert after == alone


@pytest.mark.parametrize("kind", [Absolute, Uneven, Unlike, ComplexEnergyLost])
def test_a_wrong_spring_after_a_right_one_is_refused(kind):
    own = beam()
    alone, after = refused(Anchor(own.at(0.5), STIFF), kind(own.end, STIFF), own)
    assert after == alone


def test_a_mass_whose_energy_is_not_analytic_is_refused_after_a_right_one():
    own = beam()
    alone, after = refused(PointMass(own.at(0.5), 2.0), Heavy(own.end, 2.0), own)
    assert after == alone


@pytest.mark.parametrize("kind", [HalfLever, HalfLeverOnADamper])
def test_half_the_lever_of_a_contact_is_refused_after_a_right_one(kind):
    own = beam()
    alone, after = refused(Wheel(own.at(0.5)), kind(own.end), own)
    assert after == alone
    assert "the forces of its multipliers do work" in after


@pytest.mark.parametrize("kind", [OfTheOtherSign, InAnotherOrder])
def test_multipliers_against_their_conditions_are_refused_after_right_ones(kind):
    own = beam()
    alone, after = refused(Offset(own.start, own.at(0.5)), kind(own.at(0.5), own.end), own)
    assert after == alone


def test_a_link_that_pulls_one_end_only_is_refused_after_a_right_one():
    own = beam()
    alone, after = refused(RigidLink(own.at(0.25), own.at(0.5)), AsymmetricConditions(own.at(0.5), own.end), own)
    assert after == alone


@pytest.mark.parametrize("units", UNITS.values(), ids=UNITS)
def test_later_parts_of_a_class_are_asked_less_often(units):
    metre, newton = units
    own = in_units(RIGHT["mass and rotary inertia"], metre, newton).beams[0]
    points = [own.at(fraction) for fraction in (0.25, 0.5, 0.75, 1.0)]
    Counted.asked.clear()
    springs = [
        Counted(own.start, point, number * newton / metre, 0.1 * newton / metre)
        for number, point in enumerate(points, start=1)
    ]
    connectors_of(bf.Model([own], [bf.Clamp(own.start)], connectors=springs), static=True)
    first, *later = Counted.asked.values()
    assert len(later) == 3
    assert all(3 * asked < first for asked in later)


def test_calls_of_a_tangent_do_not_copy_the_state_of_the_model():
    """The time of each connector grew with the coordinates of the model: that of many with their square."""
    own = beam()
    spring = SpringDamper(own.start, own.end, 1e3, 1.0)
    item = connectors_of(bf.Model([own], [bf.Clamp(own.start)], connectors=[spring]), static=True).items[0]
    assert item.variables == 6
    motion = tuple(np.arange(1.0, 1.0 + own.element_count * 30) / number for number in (3.0, 5.0, 7.0))
    alone = tuple(values[item.dofs] for values in motion)
    weights, gravity = (1.0, 2.0, 3.0), np.zeros(2)
    assert np.array_equal(item.tangent(motion, 0.0, gravity, weights), item.alone.tangent(alone, 0.0, gravity, weights))


@pytest.mark.parametrize("many", [1, 2, 3])
@pytest.mark.parametrize("wrong", ["stiffness", "mass", "stiffness_of_energy", "mass_of_energy"])
def test_a_single_wrong_entry_is_refused_after_right_parts_too(wrong, many):
    """Parts wrong by less than 1e-2 passed, if other entries hid it in the sum over all coordinates."""
    own = beam()
    points = (own.end, own.at(0.5), own.at(0.25))[:many]
    right, alone = linear(points), []
    for row in range(3 * many):
        for column in range(3 * many):
            part = linear(points, wrong, row, column)
            alone.append(is_refused(own, part))
            assert is_refused(own, right, part) or not alone[-1]
    assert any(alone)


@pytest.mark.parametrize("places", [0.0, 1e3, 1e6, 1e9])
def test_parts_far_from_the_origin_are_judged_as_near_it(places):
    """Round-off of the coordinates looked like a force that is not analytic: maps have the origin 1e6 m away."""
    own = bf.Beam(bf.Line((places, -places), (places + 1.0, -places)), 4, bf.CRBF(1), bf.Rectangle(0.1, 0.1), STEEL)
    points = own.end, own.at(0.5)
    right, wrong = linear(points), linear(points, "stiffness", 0, 4)
    assert not is_refused(own, right, right)
    assert is_refused(own, wrong)
    assert is_refused(own, right, wrong)
