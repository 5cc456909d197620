"""What the check of connectors finds: single wrong entries of matrices, and energies that lose complex steps."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf
from beamfem.equations.connectors import connectors_of
from beamfem.testing import check_connector
from tests.connectors import STEEL, Anchor, RigidLink, SpringDamper, beam


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
    """Return a part of which one entry of a matrix is wrong by a hundredth of the largest."""
    rng, number = np.random.default_rng(7), 3 * len(points)
    length = np.tile([points[0].beam.curve.length] * 2 + [1.0], len(points))
    matrices = {}
    for name in ("stiffness", "mass"):
        root = rng.standard_normal((number, number))
        table = root @ root.T
        for of in (name, f"{name}_of_energy"):
            matrices[of] = table.copy()
            matrices[of][row, column] += 1e-2 * table.max() * (of == wrong)
            matrices[of] /= np.multiply.outer(length, length)
    return Linear(points, **matrices)


@pytest.mark.parametrize(
    ("part", "told"),
    [
        (
            lambda own: ComplexEnergyLost(own.end, (1e3, 2e3, 30.0)),
            "kinetic energy of ComplexEnergyLost is no",
        ),
        (lambda own: AsymmetricConditions(own.at(0.5), own.end), "do work in motions that its conditions allow"),
    ],
)
def test_energies_without_complex_steps_and_one_sided_links_are_named(part, told):
    with pytest.raises(AssertionError, match=told):
        check_connector(part(beam()))


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
def test_a_single_wrong_entry_is_found(wrong, many):
    own = beam()
    points = (own.end, own.at(0.5), own.at(0.25))[:many]
    check_connector(linear(points))
    number = 3 * many
    for row, column in {(0, number - 1), (number - 1, 0), (number // 2, number // 2), (number - 1, 1)}:
        with pytest.raises(AssertionError, match="Linear is conservative"):
            check_connector(linear(points, wrong, row, column))


@pytest.mark.parametrize("places", [0.0, 1e3, 1e6, 1e9])
def test_parts_far_from_the_origin_are_judged_as_near_it(places):
    """Round-off of the coordinates looked like a force that is not analytic: maps have the origin 1e6 m away."""
    own = bf.Beam(bf.Line((places, -places), (places + 1.0, -places)), 4, bf.CRBF(1), bf.Rectangle(0.1, 0.1), STEEL)
    points = own.end, own.at(0.5)
    check_connector(linear(points))
    with pytest.raises(AssertionError, match="Linear is conservative"):
        check_connector(linear(points, "stiffness", 0, 4))


@pytest.mark.parametrize("given", [None, 3, "spring", bf.Clamp])
def test_what_is_no_connector_is_named(given):
    with pytest.raises(bf.InputError, match="a connector is an object with the members of Contribution, got"):
        check_connector(given)
