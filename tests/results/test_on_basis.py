"""Fields on a basis of scikit-fem: forms of one's own against what results say."""

import numpy as np
import pytest
from skfem import Functional
from skfem.helpers import dot
from slow_values import mostly_slow

import beamfem as bf
from beamfem.forms import strain_energy

SPLINE = bf.BSpline(3, (0, 0, 0, 0, 2, 3, 3, 3, 3), ((0, 0), (1, 0), (2, 1), (3, 1), (4, 0)))
SECTION, STEEL = bf.Rectangle(0.02, 0.05), bf.Material(2e11, 0.3, 7800.0)


@Functional
def length(w):
    """Of the deformed axis."""
    return np.sqrt(dot(w["u"].grad[:, 0], w["u"].grad[:, 0]))


@Functional
def first_moment(w):
    return w["u"][1]


def bent(element, curve=None, elements=6):
    beam = bf.Beam(curve or bf.Line((0, 0), (1, 0)), elements, element, SECTION, STEEL)
    stiffness = 2e11 * SECTION.second_moment
    loads = [bf.PointForce(beam.end, (0.0, 2.0 * stiffness)), bf.PointMoment(beam.at(0.4), 3.0 * stiffness)]
    return beam, bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], loads))


@pytest.mark.parametrize("element", [bf.ANCF(), bf.ANCFCRBF(), bf.BilinearCRBF(), bf.CRBF(2, bf.ContinuumMechanics())])
def test_the_strain_energy_of_a_form_is_that_of_the_result(element):
    beam, solution = bent(element)
    field, lam, mu = bf.field_on_basis(solution, beam), STEEL.lame_lambda(), STEEL.shear_modulus
    for row in (0, -1):
        energy = strain_energy.assemble(field.basis, u=field.interpolate(row), lam=lam, mu=mu)
        assert energy == pytest.approx(solution.energy().strain[row], rel=1e-9, abs=1e-12)


@pytest.mark.slow
@mostly_slow("element", [bf.CRBF(3), bf.ShearRigid(), bf.ANCF(bf.ElasticLine())])
@mostly_slow("curve", [bf.Line((0, 0), (1, 0)), bf.Arc((0, 0), 1.0, 0.0, 1.0)], quick=(1,))
def test_integrals_over_the_axis_are_those_of_fine_polygons(element, curve):
    beam, solution = bent(element, curve)
    axis = bf.field_on_basis(solution, beam, body=False)
    at = np.linspace(0.0, 1.0, 4001)
    line = np.array([solution.position(beam.at(x))[-1] for x in at[::40]])
    fine = np.array([solution.position(beam.at(x))[-1] for x in at])
    polygon = np.linalg.norm(np.diff(fine, axis=0), axis=1).sum()
    assert length.assemble(axis.basis, u=axis.interpolate()) == pytest.approx(polygon, rel=1e-6)
    moment = np.sum(0.5 * (fine[1:, 1] + fine[:-1, 1])) / 4000.0 * beam.curve.length
    assert first_moment.assemble(axis.basis, u=axis.interpolate()) == pytest.approx(moment, rel=1e-6)
    assert np.abs(line[0] - curve.position(np.zeros(1))[0]).max() < 1e-12


def test_a_function_of_ones_own_is_projected():
    """(s^2, y) is a body of the cubic field, so that its projection gives it back."""
    beam, solution = bent(bf.ANCF())
    basis = bf.field_on_basis(solution, beam).basis
    own = basis.project(lambda x: np.stack([x[0] ** 2, x[1]]))
    s, y = basis.global_coordinates()
    np.testing.assert_allclose(basis.interpolate(own), np.stack([s**2, y]), atol=1e-12)


@pytest.mark.parametrize(
    ("curve", "elements", "said"),
    [
        (bf.Polyline([(0, 0), (1, 0), (1, 1)]), 4, "has corners.*one of its 2 smooth pieces, such as piece=0"),
        (SPLINE, "knots", "knot spans"),
    ],
)
def test_beams_without_one_basis_are_refused(curve, elements, said):
    beam = bf.Beam(curve, elements, bf.ANCF(), SECTION, STEEL)
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], []))
    with pytest.raises(bf.InputError, match=said):
        bf.field_on_basis(solution, beam)


@pytest.mark.parametrize("element", [bf.ANCF(), bf.CRBF(2, bf.ContinuumMechanics())])
def test_the_pieces_of_a_beam_with_corners_add_up_to_the_beam(element):
    beam, solution = bent(element, bf.Polyline([(0, 0), (0.5, 0), (0.5, 0.3), (0.9, 0.3)]), elements=12)
    lam, mu = STEEL.lame_lambda(), STEEL.shear_modulus
    fields = [bf.field_on_basis(solution, beam, piece=piece) for piece in range(3)]
    energies = [strain_energy.assemble(field.basis, u=field.interpolate(), lam=lam, mu=mu) for field in fields]
    assert sum(energies) == pytest.approx(solution.energy().strain[-1], rel=1e-9)
    axes = [bf.field_on_basis(solution, beam, body=False, piece=piece) for piece in range(3)]
    lengths = [length.assemble(axis.basis, u=axis.interpolate(0)) for axis in axes]
    assert lengths == pytest.approx([0.5, 0.3, 0.4], rel=1e-12)
    with pytest.raises(bf.InputError, match="piece of field_on_basis must be between -3 and 2, got 3"):
        bf.field_on_basis(solution, beam, piece=3)


def test_what_is_no_solution_or_no_row_is_named():
    beam, solution = bent(bf.CRBF(2))
    with pytest.raises(bf.InputError, match="needs a Solution, such as solve_static returns, got None"):
        bf.field_on_basis(None, beam)
    with pytest.raises(bf.InputError, match="row of interpolate"):
        bf.field_on_basis(solution, beam).interpolate(9)
