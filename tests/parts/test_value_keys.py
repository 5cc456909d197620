"""Sections, materials, fields and curves that derive from those of the package, or change, keep what is their own."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

import beamfem as bf

STEEL = bf.Material(2.1e11, 0.3, 7850.0)
SECTION = bf.Rectangle(0.05, 0.1)
FORCE = 1.0  # so small that deflections are those of the linear beam to 1e-9


class Timber(bf.Material):
    """A material with a shear modulus of its own; equal to any other of the same Young's modulus."""

    def __init__(self, shear_modulus):
        super().__init__(1e10, 0.3, 500.0)
        object.__setattr__(self, "own", shear_modulus)

    @property
    def shear_modulus(self):
        return self.own


class Ribbed(bf.Section):
    def __init__(self, factor):
        super().__init__(SECTION.area, SECTION.second_moment, height=0.1)
        object.__setattr__(self, "factor", factor)

    def rigidity(self, material):
        found = super().rigidity(material)
        return replace(found, bending=self.factor * found.bending)


def made(section, material, curve=None, element=None):
    return bf.Beam(curve or bf.Line((0, 0), (1, 0)), 4, element or bf.CRBF(order=3), section, material)


def deflections(*beams):
    clamps, loads = [bf.Clamp(beam.start) for beam in beams], [bf.PointForce(beam.end, (0, -FORCE)) for beam in beams]
    solution = bf.solve_static(bf.Model(beams, clamps, loads))
    return [-solution.displacement(beam.end)[-1, 1] for beam in beams]


def by_hand(bending, shear):
    return FORCE / (3 * bending) + FORCE / shear


_RIGIDITY = SECTION.rigidity(STEEL)
RIBBED = [by_hand(factor * _RIGIDITY.bending, _RIGIDITY.shear) for factor in (1.0, 0.1)]


@pytest.mark.parametrize("together", [True, False])
@pytest.mark.parametrize("layered", [True, False])
def test_a_material_that_adds_to_those_of_the_package(together, layered):
    moduli = (1e9, 1e7)
    beams = []
    for timber in map(Timber, moduli):
        section = (bf.Layered([bf.Layer(timber, 0.1)], 0.05), None) if layered else (SECTION, timber)
        beams.append(made(*section))
    found = deflections(*beams) if together else [*deflections(beams[0]), *deflections(beams[1])]
    expected = [by_hand(1e10 * SECTION.second_moment, 5 / 6 * modulus * SECTION.area) for modulus in moduli]
    assert found == pytest.approx(expected, rel=1e-8)


def test_sections_that_add_to_those_of_the_package_and_are_equal():
    one, other = Ribbed(1.0), Ribbed(0.1)
    assert one == other
    first, second = deflections(made(one, STEEL), made(other, STEEL))
    assert [first, second] == pytest.approx(RIBBED, rel=1e-8)


@dataclass(frozen=True)
class Bonded:
    """A section that consists of another."""

    inner: object

    def __getattr__(self, name):
        return getattr(self.inner, name)


def test_sections_that_consist_of_what_is_equal():
    first, second = deflections(*(made(Bonded(Ribbed(factor)), STEEL) for factor in (1.0, 0.1)))
    assert [first, second] == pytest.approx(RIBBED, rel=1e-8)


class Damped(bf.Section):
    """A section with a damping that changes."""

    time = 0.0

    def moments(self, material):
        return [(replace(material, retardation_time=self.time), super().moments(material)[0][1])]


def test_a_section_that_changes_between_models():
    section, found = Damped(SECTION.area, SECTION.second_moment, height=0.1), []
    for time in (0.0, 1e-3, 0.0):
        object.__setattr__(section, "time", time)
        beam = made(section, STEEL)
        model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, -FORCE))])
        motion = bf.simulate(model, 0.05, 1e-3)
        expected = made(SECTION, replace(STEEL, retardation_time=time))
        like = bf.Model([expected], [bf.Clamp(expected.start)], [bf.PointForce(expected.end, (0, -FORCE))])
        assert motion.displacement(beam.end) == pytest.approx(
            bf.simulate(like, 0.05, 1e-3).displacement(expected.end), rel=1e-6, abs=1e-12
        )
        found.append(motion.displacement(beam.end)[-1, 1])
    assert found[0] == found[2] != pytest.approx(found[1], rel=0.1)


@dataclass(frozen=True)
class Nodes(bf.Lagrange):
    kind: str = "float64"

    @property
    def nodes(self):
        return bf.Lagrange(self.order).nodes.astype(self.kind)


@pytest.mark.parametrize("kind", ["float64", "int64", "float32"])
def test_nodes_of_a_field_are_numbers_of_any_kind(kind):
    element = bf.Element(Nodes(1, kind), bf.Rotation(), bf.Structural(), "reduced")
    assert deflections(made(SECTION, STEEL, element=element)) == deflections(
        made(SECTION, STEEL, element=bf.Element(bf.Lagrange(1), bf.Rotation(), bf.Structural(), "reduced"))
    )


class Wave(bf.Line):
    """What derives from a line and is none."""

    def position(self, arc_length):
        found = bf.Line.position(self, arc_length)
        found[:, 1] += 0.1 * np.sin(np.pi * np.asarray(arc_length))
        return found


def test_what_derives_from_a_line_may_bend():
    beam = made(SECTION, STEEL, Wave((0, 0), (1, 0)))
    model = bf.Model([beam], [bf.Clamp(beam.start)])
    assert model.meshes[0].position[6, 1] == pytest.approx(0.1)
    assert beam.at(0.5).reference == pytest.approx([0.5, 0.1])


class Placed(bf.Lagrange):
    """A quadratic field with its middle node anywhere: the same functions, whatever the nodes."""

    def __init__(self, middle):
        super().__init__(2)
        object.__setattr__(self, "middle", middle)

    @property
    def nodes(self):
        return np.array([0.0, self.middle, 1.0])

    def centreline(self, xi, derivative=0):
        powers = [np.polynomial.Polynomial(row) for row in np.linalg.inv(np.vander(self.nodes, increasing=True)).T]
        return np.stack([(own.deriv(derivative) if derivative else own)(np.asarray(xi)) for own in powers], axis=-1)

    director = centreline


class Soft(bf.Structural):
    def __init__(self, factor):
        super().__init__()
        object.__setattr__(self, "factor", factor)

    def stiffness(self, *arguments):
        return self.factor * super().stiffness(*arguments)


@pytest.mark.parametrize("together", [True, False])
def test_elements_of_what_derives_from_the_package_and_is_equal(together):
    def placed(middle):
        return bf.Element(Placed(middle), bf.Rotation(), bf.Structural(), "reduced")

    assert Placed(0.3) == Placed(0.7)
    assert bf.CRBF(order=2) == bf.CRBF(order=2)
    elements = [placed(0.3), placed(0.7), bf.CRBF(order=2), *(bf.CRBF(2, forces=Soft(factor)) for factor in (1.0, 0.1))]
    beams = [made(SECTION, STEEL, element=element) for element in elements]
    found = deflections(*beams) if together else [deflections(beam)[0] for beam in beams]
    assert found == pytest.approx(np.array([1.0, 1.0, 1.0, 1.0, 10.0]) * found[2], rel=1e-6)
    assert found[:2] == pytest.approx([found[2]] * 2, rel=1e-6)


class InPlace:
    """A straight curve that works in what it is given."""

    length, corners = 2.0, ()

    def position(self, arc_length):
        arc_length /= self.length
        return np.column_stack([self.length * arc_length, 0.0 * arc_length])

    def tangent(self, arc_length):
        arc_length /= self.length
        return np.tile([1.0, 0.0], (len(arc_length), 1))


def test_a_curve_that_works_in_what_it_is_given():
    found = []
    for curve in (InPlace(), bf.Line((0, 0), (2, 0))):
        beam = made(SECTION, STEEL, curve)
        model = bf.Model([beam], [bf.Clamp(beam.start), bf.Pin(beam.at(0.75))], [bf.PointForce(beam.end, (0, -FORCE))])
        found.append(bf.solve_static(model).displacement(beam.end)[-1, 1])
    assert found[0] == pytest.approx(found[1], rel=1e-9) != 0.0


def test_a_field_that_changes_between_elements():
    field = Placed(0.3)
    element = bf.Element(field, bf.Rotation(), bf.Structural(), "reduced")
    deflections(made(SECTION, STEEL, element=element))
    object.__setattr__(field, "middle", 0.7)
    other = bf.Element(field, bf.Rotation(), bf.Structural(), "reduced")
    assert deflections(made(SECTION, STEEL, element=other)) == pytest.approx(
        deflections(made(SECTION, STEEL, element=bf.CRBF(order=2))), rel=1e-6
    )
