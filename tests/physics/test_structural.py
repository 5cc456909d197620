"""Structural forces against the Reissner beam, computed by collocation to 12 digits (references, families 1 and 2)."""

import numpy as np
import pytest

import beamfem as bf

TIPS = {10: (-0.38922722797924, 0.72054526137677), 100: (-0.38764432832607, 0.71385896416489)}


def cantilever(element, elements, slenderness, load):
    section = bf.Rectangle(1.0 / slenderness, 1.0 / slenderness)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, section, bf.Material(2e11, 0.3, 7800.0))
    bending = 2e11 * section.second_moment
    return beam, bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [load(beam, bending)]))


def tip_force(beam, bending):
    return bf.PointForce(beam.end, (0.0, 5 * bending))


@pytest.mark.parametrize("slenderness", TIPS)
@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_the_tip_converges_with_twice_the_order(order, slenderness):
    meshes = {1: (16, 32, 64), 2: (8, 16, 32), 3: (4, 8, 16), 4: (4, 6, 8)}[order]
    errors = []
    for elements in meshes:
        beam, solution = cantilever(bf.CRBF(order), elements, slenderness, tip_force)
        errors.append(np.abs(solution.displacement(beam.end)[-1] - TIPS[slenderness]).max())
    rate = -np.polyfit(np.log(meshes), np.log(errors), 1)[0]
    assert 2 * order - 0.3 < rate < 2 * order + 0.6, (rate, errors)


@pytest.mark.parametrize("slenderness", TIPS)
@pytest.mark.parametrize(("order", "elements", "most"), [(4, 4, 9), (8, 1, 14)])
def test_few_elements_of_high_order_are_right_to_six_digits_in_one_step(order, elements, most, slenderness):
    beam, solution = cantilever(bf.CRBF(order), elements, slenderness, tip_force)
    assert np.abs(solution.displacement(beam.end)[-1] - TIPS[slenderness]).max() < 1e-6
    assert solution.statistics.steps == 1
    assert solution.iterations <= most


@pytest.mark.parametrize("slenderness", [10, 100, 1000, 10000])
@pytest.mark.parametrize(("order", "elements", "closes", "most"), [(4, 8, 1e-7, 7), (6, 4, 1e-9, 9)])
def test_roll_up_closes_in_one_step(order, elements, closes, most, slenderness):
    beam, solution = cantilever(
        bf.CRBF(order), elements, slenderness, lambda b, bending: bf.PointMoment(b.end, 2 * np.pi * bending)
    )
    assert np.linalg.norm(solution.position(beam.end)[-1]) < closes
    assert solution.statistics.steps == 1
    assert solution.iterations <= most


@pytest.mark.parametrize("make", [bf.ANCF, bf.ANCFCRBF, bf.BilinearANCF])
def test_other_fields_and_coordinates_come_to_the_same_limit(make):
    errors = []
    for elements in (50, 100, 200):
        beam, solution = cantilever(make(forces=bf.Structural()), elements, 10, tip_force)
        errors.append(np.abs(solution.displacement(beam.end)[-1] - TIPS[10]).max())
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert errors[-1] < 2e-3
    assert np.all((orders > 1.7) & (orders < 2.3)), (orders, errors)


def test_pendulum_with_structural_forces():
    """Case 10c: Reissner pendulum, spectral elements 128 x 6, tip at 0.5 s."""
    section = bf.Section(area=1.6e-3, second_moment=8.533e-6)
    beam = bf.Beam(bf.Line((0, 0), (1.2, 0)), 12, bf.CRBF(4), section, bf.Material(0.7e6, 0.3, 5540.0))
    model = bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0, -9.81))])
    solution = bf.simulate(model, 0.5, 2.5e-4, bf.GeneralizedAlpha(1.0))
    assert solution.position(beam.end)[-1] == pytest.approx([0.354311304, -1.307082330], abs=2e-5)


@pytest.mark.parametrize("slenderness", [10, 100, 1000])
@pytest.mark.parametrize(
    ("gradients", "rotations", "elements"),
    [
        (bf.ANCF(bf.Structural()), bf.ANCFCRBF(bf.Structural()), 24),
        (bf.BilinearANCF(bf.Structural(), "reduced"), bf.CRBF(1), 32),
        (bf.Element(bf.Lagrange(4), bf.Gradients(), bf.Structural(), "reduced"), bf.CRBF(4), 6),
    ],
)
def test_gradients_do_not_lock_in_thickness(gradients, rotations, elements, slenderness):
    """The thickness strain of gradients is taken at the nodes, so that thin beams come where rotations come."""
    errors = []
    for element in (gradients, rotations):
        beam, solution = cantilever(element, elements, slenderness, tip_force)
        _, fine = cantilever(bf.CRBF(6), 10, slenderness, lambda b, bending: tip_force(b, bending))
        limit = fine.displacement(fine.model.beams[0].end)[-1]
        errors.append(np.abs(solution.displacement(beam.end)[-1] - limit).max())
    assert errors[0] < 1.3 * errors[1] + 1e-8, errors


@pytest.mark.parametrize("order", [0, 9, 1.5])
def test_orders_outside_the_table_are_refused(order):
    with pytest.raises(bf.InputError, match="order"):
        bf.CRBF(order)


@pytest.mark.parametrize("forces", [bf.Structural(), bf.ElasticLine(), bf.SplitContinuum()], ids=lambda f: f.name)
def test_stress_of_strains_without_poisson_coupling_is_hookes(forces):
    """E times the strains, and G times the angle of shear, twice the strain component: E = 2.6, nu = 0.3, G = 1."""
    found = forces.stress(np.array(0.1), np.array(0.2), np.array(0.03), bf.Material(2.6, 0.3, 1.0))
    assert found == pytest.approx((0.26, 0.52, 0.06))
