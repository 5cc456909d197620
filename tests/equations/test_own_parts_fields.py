"""Fields beside the package: elements with them, and what their shape functions must be."""

import re
from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf
from beamfem.element.coordinates import Gradients, Rotation
from beamfem.element.fields import Lagrange
from beamfem.testing import check_field
from tests import fields
from tests.fields import Equidistant, Quintic

SECTION, STEEL = bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0)
BENDING = 2e11 * 1e-8 / 12


def tip(element):
    """Return where a bent cantilever of 4 elements ends; its estimate of locking is of another rule."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, element, SECTION, STEEL)
    loads = [bf.PointForce(beam.end, (0.0, 2.0 * BENDING))]
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], loads))
    assert not [warning for warning in solution.warnings if "lock" in warning and element.field.degree > 2]
    return solution.position(beam.end)[-1]


@pytest.mark.parametrize("order", [1, 2])
def test_equidistant_nodes_are_those_of_the_package_at_low_orders(order):
    own, known = (bf.Element(kind(order), Rotation(), bf.Structural(), "reduced") for kind in (Equidistant, Lagrange))
    assert tip(own) == pytest.approx(tip(known), rel=1e-9)


@pytest.mark.parametrize("order", range(1, 13))
def test_round_off_of_high_orders_is_no_fault_of_a_field(order):
    check_field(Equidistant(order))


@pytest.mark.parametrize("coordinates", [Gradients(), Rotation()])
def test_slopes_at_three_nodes_are_a_field_but_not_the_cubic_one(coordinates):
    """Its strains at the Lobatto points of the cubic field would not determine it."""
    element = bf.Element(Quintic(), coordinates, bf.Structural())
    assert element.integration == "full"
    assert tip(element) == pytest.approx(tip(bf.CRBF(5)), abs=1e-4)
    with pytest.raises(bf.InputError, match=r'"lobatto" is for the cubic field, .* on the quintic field "reduced"'):
        bf.Element(Quintic(), coordinates, bf.Structural(), "lobatto")


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ("Scaled", "centreline(xi)[:, 0] must be 1 at its node and 0 at the others, got 1.01 at node 0, xi = 0"),
        ("DirectorScaled", "director(xi)[:, 0] must be 1 at its node and 0 at the others, got 1.01 at node 0"),
        ("Bumps", "the sum of centreline(xi) must be 1, got "),
        ("Bent", "the sum of the nodes times centreline(xi) must be xi, as in a constant stretch, got "),
        (
            "SlopeOfAnother",
            "centreline(xi, derivative=1)[:, 0] is no derivative of centreline(xi)[:, 0]: at xi = 0.0371 it is",
        ),
        ("FlatCurvature", "is no derivative of centreline(xi, derivative=1)[:, "),
        ("SlopesPerNothing", "centreline(xi, derivative=1)[:, 1] must be 1 at its node and 0 at the others, got 2"),
        ("HeavyRule", "on [0, 1]: its integral of xi^0 must be 1, got 3"),
        ("RuleElsewhere", "director_rule() must return the nodes (3,) and weights (3,)"),
    ],
)
def test_what_is_wrong_with_shape_functions_is_named(kind, said):
    with pytest.raises(AssertionError, match=re.escape(said)) as caught:
        check_field(getattr(fields, kind)())
    assert f"field {kind}" in str(caught.value)


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ("Inside", "nodes must begin at 0 and end at 1, the ends of an element, got 0.1 to 0.9"),
        ("Downward", "nodes must be an array of two or more increasing numbers"),
        ("DirectorFirst", "vectors must be ('r', 'r_y') or ('r', 'r_x', 'r_y'), got ('r_y', 'r')"),
        ("OneColumnLess", "must be an array (3, 3) of finite numbers, got float64 (3, 2)"),
        ("Raising", "director of the field Raising(array([0. , 0.5, 1. ]), 0) cannot be computed: KeyError"),
        ("Fractional", "degree of the field Fractional must be a whole number"),
    ],
)
def test_fields_of_another_shape_are_refused(kind, said):
    with pytest.raises(bf.InputError, match=re.escape(said)) as caught:
        bf.Element(getattr(fields, kind)(), Rotation(), bf.Structural())
    assert f"field {kind}" in str(caught.value)


def test_a_field_without_members_is_told_which():
    @dataclass(frozen=True)
    class Named:
        name: str = "mine"

    @dataclass(frozen=True)
    class Tabulated(Equidistant):
        table: np.ndarray | None = None

    with pytest.raises(bf.InputError, match=r"Named\(name='mine'\) without nodes, vectors, degree, director_"):
        bf.Element(Named(), Rotation(), bf.Structural())
    with pytest.raises(bf.InputError, match=r"got <class 'tests\.fields\.Equidistant'>: it is a class"):
        bf.Element(Equidistant, Rotation(), bf.Structural())
    with pytest.raises(bf.InputError, match=r"the field Tabulated: elements are compared .* let it hold tuples"):
        bf.Element(Tabulated(2, np.ones(3)), Rotation(), bf.Structural())
