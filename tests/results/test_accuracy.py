"""Static solves to a given accuracy: true errors against much finer meshes, and what the result tells."""

import numpy as np
import pytest

import beamfem as bf

STEEL = bf.Material(2e11, 0.3, 7800.0)
SECTION = bf.Rectangle(0.02, 0.01)
EI = 2e11 * SECTION.second_moment


def model_of(element, elements, loads):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, SECTION, STEEL, "arm")
    return beam, bf.Model([beam], [bf.Clamp(beam.start)], loads(beam))


def bent(beam):
    return [bf.PointForce(beam.end, (0.0, 5.0 * EI)), bf.PointForce(beam.at(0.3), (0.0, -9.0 * EI))]


@pytest.mark.parametrize("accuracy", [1e-2, 1e-4, 1e-6, 1e-8])
@pytest.mark.parametrize(("element", "elements"), [(bf.CRBF(1), 4), (bf.CRBF(3), 1), (bf.CRBF(8), 1)])
def test_displacements_are_as_accurate_as_asked_for(element, elements, accuracy):
    beam, model = model_of(element, elements, bent)
    solution = bf.solve_static(model, accuracy=accuracy)
    fine_beam, fine = model_of(bf.CRBF(8), 20, bent)
    exact = bf.solve_static(fine)
    for at in (0.3, 0.5, 1.0):
        error = exact.displacement(fine_beam.at(at))[-1] - solution.displacement(beam.at(at))[-1]
        assert np.linalg.norm(error) < 1.2 * accuracy
    assert solution.error() <= accuracy
    assert solution.model.size < 130


def test_cubic_elements_are_shortened():
    beam, model = model_of(bf.ANCF(bf.Structural()), 4, bent)
    solution = bf.solve_static(model, accuracy=1e-3)
    fine_beam, fine = model_of(bf.ANCF(bf.Structural()), 256, bent)
    error = bf.solve_static(fine).displacement(fine_beam.end)[-1] - solution.displacement(beam.end)[-1]
    assert np.linalg.norm(error) < 2e-3
    assert solution.model.meshes[0].elements > 8


def test_a_quantity_may_be_what_is_accurate():
    beam, model = model_of(bf.CRBF(2), 2, bent)
    solution = bf.solve_static(model, accuracy=1e-5, quantity=lambda s: s.reaction(beam.start)[-1, 2])
    fine_beam, fine = model_of(bf.CRBF(8), 20, bent)
    exact = bf.solve_static(fine).reaction(fine_beam.start)[-1, 2]
    assert solution.reaction(beam.start)[-1, 2] == pytest.approx(exact, rel=2e-5)


def test_elements_are_short_only_where_it_is_needed():
    """On a stiff foundation only the loaded end bends."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(4), SECTION, STEEL)
    bed = bf.Foundation(beam, (0.0, 4e6 * EI))
    held = [bf.Roller(beam.start, (1, 0)), bed]
    solution = bf.solve_static(bf.Model([beam], held, [bf.PointForce(beam.end, (0.0, 1e3 * EI))]), accuracy=1e-7)
    lengths = solution.model.meshes[0].lengths
    assert lengths[0] > 3.0 * lengths[-1]


def test_the_result_tells_its_mesh_and_is_saved_with_it(tmp_path):
    beam, model = model_of(bf.CRBF(1), 4, bent)
    solution = bf.solve_static(model, accuracy=1e-4)
    assert "the estimated error is" in solution.statistics.ended
    assert solution.model.beams[0].element.name == "CRBF-3"
    solution.save(tmp_path / "arm.h5")
    loaded = bf.load(tmp_path / "arm.h5")
    again = loaded.model.beams[0]
    assert np.array_equal(loaded.displacement(again.end), solution.displacement(beam.end))
    assert loaded.reaction(again.start) == pytest.approx(solution.reaction(beam.start))


def test_the_finer_model_can_be_used_on():
    beam, model = model_of(bf.CRBF(1), 4, bent)
    finer = bf.solve_static(model, accuracy=1e-4).model
    more = finer.with_loads([bf.PointForce(beam.end, (0.0, EI))])
    assert bf.solve_static(more).displacement(beam.end)[-1, 1] > 0.2
    crooked = finer.with_imperfection(bf.solve_modes(finer, 1), size=1e-3)
    assert bf.solve_static(crooked).displacement(crooked.beams[0].end)[-1, 1] > 0.0


def test_elements_that_lock_and_bad_accuracies_are_refused():
    _, model = model_of(bf.ANCF(), 4, bent)
    with pytest.raises(bf.InputError, match="an accuracy cannot be had with these elements: elements lock"):
        bf.solve_static(model, accuracy=1e-3)
    with pytest.raises(bf.InputError, match="accuracy must be"):
        bf.solve_static(model, accuracy=0.0)
