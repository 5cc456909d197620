"""Results of models with many beams: like beams are evaluated together, with the values of each by itself."""

import numpy as np
import pytest
from slow_values import mostly_slow

import beamfem as bf
from beamfem.io import results_hdf5
from beamfem.io.vtk_cells import Cells
from beamfem.results import axis_fields as along
from beamfem.results import batched_beams as many_beams
from beamfem.results import beam_stress, free_bodies
from beamfem.results.axis_fields import QUANTITIES
from beamfem.results.axis_points import AxisPoints
from beamfem.results.batched_beams import equal_beams, of_each
from tests.many_beams import PLASTIC, SECTION, mixed_model

FORCES = ("arc_length", "normal", "shear", "moment")


@pytest.fixture(scope="module")
def solutions():
    model = mixed_model()
    return bf.solve_static(model, steps=2), bf.simulate(model, duration=0.003, step=1e-3)


def _fresh(solution):
    """Return the same rows, of which nothing has been computed."""
    return solution[:]


def row_of(beams):
    """Return the solution of a row of cantilevers."""
    own = [bf.Beam(bf.Line((i, 0.0), (i + 0.3, 1.0)), 2, bf.CRBF(1), SECTION, PLASTIC) for i in range(beams)]
    loads = [bf.PointForce(beam.end, (1.0 + number, 0.0)) for number, beam in enumerate(own)]
    return bf.solve_static(bf.Model(own, [bf.Clamp(beam.start) for beam in own], loads))


def _all_forces(points, solution, rows):
    return np.stack(list(along.section_forces(points, solution, rows).values()))


def _all_stresses(points, solution, rows):
    stress = beam_stress.stress_at(solution, points, rows)
    return np.stack([stress[part] for part in beam_stress.PARTS])


FIELDS = {
    name: QUANTITIES[name].values for name in ("rotation", "displacement", "speed", "axial_strain", "shear_angle")
}
FIELDS |= {"forces": _all_forces, "stresses": _all_stresses}


@mostly_slow("motion", [False, True], quick=(1,))
@mostly_slow("values", FIELDS.values(), quick=(5,), ids=FIELDS)
def test_fields_of_beams_evaluated_together_are_those_of_each(solutions, values, motion):
    solution = solutions[motion]
    points = [AxisPoints.spaced(mesh, 1 + number % 2) for number, mesh in enumerate(solution.model.meshes)]
    groups = equal_beams(solution.model, points, len(solution))
    assert 1 < len(groups) < len(points)
    rows = slice(1, None)
    each = [values(own, solution, rows) for own in points]
    joined = of_each(groups, lambda many: values(many, solution, rows), each[0].ndim - 1)
    for own, one in zip(joined, each, strict=True):
        assert np.array_equal(own, one, equal_nan=True)
    assert any(np.isfinite(one).any() for one in each)


@pytest.mark.slow
@pytest.mark.parametrize("motion", [False, True])
def test_forces_and_stresses_do_not_depend_on_the_order_in_which_beams_are_asked_for(solutions, motion):
    beams = solutions[motion].model.beams
    first, last = (_fresh(solutions[motion]) for _ in range(2))
    forwards = [(first.section_forces(beam), first.stresses(beam)) for beam in beams]
    for beam, (forces, stresses) in zip(beams[::-1], forwards[::-1], strict=True):
        for name in FORCES:
            assert np.array_equal(getattr(last.section_forces(beam), name), getattr(forces, name))
        for name in beam_stress.PARTS:
            assert np.array_equal(getattr(last.stresses(beam), name), getattr(stresses, name), equal_nan=True)


def test_changing_what_one_gets_changes_no_later_result(solutions):
    solution = _fresh(solutions[0])
    beams = solution.model.beams
    before = [solution.section_forces(beam).moment.copy() for beam in beams]
    for beam in beams:
        solution.section_forces(beam).moment[:] = 0.0
    for beam, moment in zip(beams, before, strict=True):
        assert np.array_equal(solution.section_forces(beam).moment, moment)


@pytest.mark.slow
def test_files_and_tables_are_the_same_beam_by_beam(solutions, monkeypatch, tmp_path):
    h5py = pytest.importorskip("h5py")
    solution = _fresh(solutions[1])
    joined = solution.to_pandas(), Cells(solution.model, True).arrays(solution, slice(None))
    solution.save(tmp_path / "together.h5")
    monkeypatch.setattr(many_beams, "VALUES", 0)
    monkeypatch.setattr(results_hdf5, "VALUES", 0)  # row by row
    points = [AxisPoints.spaced(mesh, 1) for mesh in solution.model.meshes]
    assert len(equal_beams(solution.model, points, 1)) == len(points)
    each = solution.to_pandas(), Cells(solution.model, True).arrays(solution, slice(None))
    solution.save(tmp_path / "each.h5")
    assert joined[0].equals(each[0])
    assert joined[1].keys() == each[1].keys()
    for name, values in each[1].items():
        assert np.array_equal(joined[1][name], values, equal_nan=True)
    with h5py.File(tmp_path / "together.h5") as one, h5py.File(tmp_path / "each.h5") as other:
        for beam in one["beams"]:
            for name, values in one["beams"][beam].items():
                assert np.array_equal(values[()], other["beams"][beam][name][()])


EVALUATIONS = {
    "section forces": lambda solution, _: [solution.section_forces(beam) for beam in solution.model.beams],
    "stresses": lambda solution, _: [solution.stresses(beam) for beam in solution.model.beams],
    "peak": lambda solution, _: solution.peak_stress(),
    "table": lambda solution, _: solution.to_pandas(),
    "file": lambda solution, folder: solution.save(folder / "row.h5"),
    "ParaView": lambda solution, folder: solution.to_vtk(folder / "row.pvd"),
    "picture": lambda solution, folder: solution.plot(folder / "row.png", colour="moment"),
    "page": lambda solution, folder: solution.to_html(folder / "row.html"),
}


@pytest.mark.parametrize("evaluate", EVALUATIONS.values(), ids=EVALUATIONS)
def test_more_beams_do_not_take_more_evaluations(evaluate, monkeypatch, tmp_path):
    """Each beam took an evaluation of its own, 5 ms: of 2400 members 26 s for a file."""
    counts = []
    original = free_bodies.elastic_forces

    def counted(*arguments):
        counts[-1] += 1
        return original(*arguments)

    monkeypatch.setattr(free_bodies, "elastic_forces", counted)
    for beams in (4, 40):
        solution = row_of(beams)
        counts.append(0)
        evaluate(solution, tmp_path)
    assert counts[1] == counts[0] > 0


@pytest.mark.parametrize("rows", [1, 10_000, 10_000_000])
def test_the_more_rows_the_fewer_beams_are_evaluated_at_once(rows):
    """All beams of a long motion at once would take more memory than its coordinates."""
    model = mixed_model()
    groups = equal_beams(model, [AxisPoints.spaced(mesh, 4) for mesh in model.meshes], rows)
    assert sorted(number for group in groups for number in group.numbers) == list(range(len(model.beams)))
    for group in groups:
        assert len(group.numbers) == 1 or sum(group.counts) * rows <= many_beams.VALUES


def test_values_of_large_solutions_are_not_kept(monkeypatch):
    """With the forces of one beam those of the others are kept, but not of a large solution."""
    solution = row_of(12)
    whole = [solution.section_forces(beam).moment for beam in solution.model.beams]
    monkeypatch.setattr(many_beams, "_KEPT", 0)
    again = _fresh(solution)
    for beam, moment in zip(solution.model.beams[::-1], whole[::-1], strict=True):
        assert np.array_equal(again.section_forces(beam).moment, moment)
    assert not any(kept for kept in again.computed(many_beams._none).values())


def test_beams_of_two_kinds_in_turns_do_not_displace_each_other(monkeypatch):
    """Each beam took an evaluation of all beams of its kind."""
    beams = [
        bf.Beam(bf.Line((i, 0.0), (i + 0.3, 1.0)), 2, (bf.CRBF(1), bf.ANCF())[i % 2], SECTION, PLASTIC)
        for i in range(12)
    ]
    solution = bf.solve_static(bf.Model(beams, [bf.Clamp(beam.start) for beam in beams], [bf.Gravity((0.0, -9.81))]))
    joined = []
    original = many_beams.join
    monkeypatch.setattr(many_beams, "join", lambda meshes: joined.append(len(meshes)) or original(meshes))
    for beam in beams:
        solution.section_forces(beam)
    assert joined == [6, 6]


def test_one_beam_is_evaluated_once(monkeypatch):
    solution, sizes = row_of(12), []
    original = free_bodies.elastic_forces

    def sized(block, p, *arguments):
        sizes.append(len(block.node))
        return original(block, p, *arguments)

    monkeypatch.setattr(free_bodies, "elastic_forces", sized)
    solution.section_forces(solution.model.beams[3])
    assert set(sizes) == {2}
