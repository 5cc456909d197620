"""Results show themselves in a few lines, however much they hold."""

import numpy as np
import pytest

import beamfem as bf


@pytest.fixture(scope="module")
def results():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 40, bf.CRBF(order=2), bf.Circle(0.01), bf.Material(2e11, 0.3, 7800.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-1000.0, 0.0))])
    path = bf.trace_equilibrium(model, until=1.0)
    solution = bf.solve_static(bf.Model([beam], model.supports, [bf.PointForce(beam.end, (0.0, 100.0))]))
    sweep = bf.sweep(lambda x: {"y": np.full(1000, x)}, x=np.linspace(0.0, 1.0, 3))
    many = bf.sweep(lambda x: {"y": x}, x=np.linspace(0.0, 1.0, 300))
    return {
        "path": path,
        "state of a path": path[0],
        "bifurcation": path.bifurcations[0],
        "state": solution[-1],
        "solution": solution,
        "statistics": solution.statistics,
        "energy": bf.simulate(model, duration=0.01, step=1e-4).energy(),
        "fields": solution.fields(beam.at(0.5)),
        "section forces": solution.section_forces(beam),
        "field on a basis": bf.field_on_basis(solution, beam),
        "modes": bf.solve_modes(model, count=12),
        "buckling": bf.solve_buckling(model),
        "sweep": sweep,
        "long sweep": many,
        "model": model,
        "beam": beam,
    }


def test_every_result_shows_itself_in_ten_lines_at_most(results):
    lengths = {name: (repr(one).count("\n") + 1, len(repr(one))) for name, one in results.items()}
    assert all(lines <= 10 and characters <= 1200 for lines, characters in lengths.values()), lengths


def test_arrays_are_shown_by_shape_and_range(results):
    said = repr(results["section forces"])
    assert said.startswith("SectionForces(arc_length=<array (160,) from 0 to 1>, normal=<array (2, 160) from ")
    assert repr(results["path"]).endswith("; 0 limit points, 1 bifurcation)")
    assert "values=({'y': <array (1000,) from 0 to 0>}, {'y': <array " in repr(results["sweep"])
    assert "parameters=<300 items>" in repr(results["long sweep"])
