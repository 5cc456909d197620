"""Results show themselves in a few lines, however much they hold."""

from dataclasses import replace

import numpy as np
import pytest

import beamfem as bf
from beamfem.convergence.convergence_result import Convergence
from beamfem.results.energies import Energy


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


LONG = [(float(i), float(i % 2)) for i in range(300)]
STEEL = bf.Material(2e11, 0.3, 7800.0, thermal_expansion=1e-5)


def curve_of(elements, load, order=2.0):
    if load == 3.0:
        raise ValueError("much to say about it, " * 50)
    return {"a name that is rather long " * 2: load + elements**-order, **{f"other {i}": 1e-9 / 3 for i in range(30)}}


@pytest.fixture(scope="module")
def large():
    polyline, function = bf.Polyline(LONG), lambda t: np.interp(t, *np.array(LONG).T)
    arcs = [bf.elliptic_arc((0, 0), (1, 0), (0, 1), 0.3 * i, 0.3 * (i + 1)) for i in range(15)]
    nodes = np.array(LONG)
    cells = np.column_stack([np.arange(299), np.arange(1, 300), np.full(299, -1)])
    sets = {f"a set with a long name of number {i}": np.arange(100) for i in range(60)}
    mesh = bf.LineMesh(nodes, cells, sets, sets)
    section = bf.Layered([bf.Layer(STEEL, 0.01) for _ in range(60)], 0.1)
    beam = bf.Beam(polyline, np.linspace(0.0, 1.0, 300), bf.CRBF(2), bf.Rectangle(0.1, 0.1), STEEL)
    own = bf.Interpolated(LONG)
    others = [
        *(bf.Prescribed(beam.start, own, own, own), bf.Foundation(beam, (1.0, 2.0)), bf.Clamp(beam.start)),
        *(bf.PointForce(beam.end, (1.0, 2.0), own), bf.PointMoment(beam.end, 1.0, own), bf.Gravity((0.0, 1.0), own)),
        *(bf.DistributedLoad(beam, (1.0, 2.0), own), bf.Pressure(beam, own), bf.Actuation(beam, own, own, own, own)),
        *(bf.Temperature(beam, own, own, own), bf.Rigid(beam.start, beam.end), bf.Hinge(beam.start, beam.end)),
        *(bf.Roller(beam.start), bf.Spring(beam.start, (1.0, 2.0)), bf.RigidVelocity((1.0, 2.0), 3.0)),
    ]
    straight = bf.Beam(bf.Line((0, 0), (1, 0)), 100, bf.CRBF(2), section)
    model = bf.Model([straight], [bf.Clamp(straight.start)])
    varied = {"elements": [2, 4, 8, 16, 32, 64], "load": np.linspace(1.0, 9.0, 33).tolist()}
    study = bf.converge(curve_of, "a name that is rather long " * 2, refine="elements", **varied)
    one = bf.converge(
        curve_of, "a name that is rather long " * 2, refine="elements", elements=[2, 4, 8, 16, 32, 64], load=[2.0]
    )
    failed = bf.converge(curve_of, "other 0", refine="elements", elements=[2, 4], load=[3.0])
    vectors = np.ones((300, 3))
    return [
        *(
            polyline,
            own,
            bf.Piecewise(function, [x for x, _ in LONG]),
            section,
            mesh,
            beam,
            beam.end,
            straight,
            *others,
        ),
        *(
            bf.Parametric(lambda u: (u, u * u), 0.0, 1.0),
            arcs[0],
            bf.elliptic_arc((0, 0), (1, 0), (0, 1), 0.0, 6.0),
            bf.Chain(arcs),
            bf.Chain(arcs[:3]),
        ),
        *(mesh.frame(1, bf.CRBF(1), bf.Rectangle(0.1, 0.1), STEEL), model),
        *(study, one, failed, study.curves[0], study.failures[0], bf.sweep(curve_of, **varied)),
        *(bf.At(*[vectors] * 6, 0.0, vectors[0]), bf.solve_modes(model, 60), bf.Newton(), bf.GeneralizedAlpha()),
        *(bf.CRBF(2), bf.ANCF(), STEEL, bf.Rectangle(0.1, 0.1), bf.Section.from_stiffness(1.0, 1.0, 1.0, 1.0, 1.0)),
    ]


def test_everything_shows_itself_in_ten_lines_and_800_characters_at_most(large, results):
    for one in (*large, *results.values()):
        # a study is printed as its table, which is what it is made for
        for text in (repr(one), repr(one) if isinstance(one, Convergence) else str(one)):
            said = f"{type(one).__name__}: {len(text)} characters"
            assert (text.count("\n") + 1 <= 10, len(text) < 800) == (True, True), f"{said}: {text}"


def test_a_sweep_prints_its_first_and_last_points_and_a_study_its_table(large):
    (long,) = [one for one in large if type(one).__name__ == "Sweep"]
    lines = str(long).splitlines()
    assert lines[2].split()[:2] == ["2", "1"]
    assert lines[-3].split()[:2] == ["64", "9"]
    assert lines[-2].startswith("198 points, 198 computed now, 6 failed")
    assert lines[-1].startswith("failed at elements=2, load=3: ValueError")
    assert long.report().count("\n") > 40
    study = bf.converge(lambda n: 1.0 + n**-2.0, refine="n", n=[2, 4, 8, 16])
    assert [line.split()[0] for line in str(study).splitlines()[4:8]] == ["2", "4", "8", "16"]
    assert "GCI: grid convergence index" in str(study)
    assert str(study) == study.report()
    assert repr(study) == "Convergence(value over n: 1 curve of 4 points, 0 failed)"


def test_arrays_are_shown_by_shape_and_range(results):
    said = repr(results["section forces"])
    assert said.startswith("SectionForces(arc_length=<array (200,) from 0 to 1> m, normal=<array (2, 200) from ")
    assert said.endswith("> N m)")
    assert "values=({'y': <array (1000,) from 0 to 0>}, {'y': <array " in repr(results["sweep"])
    assert "parameters=<300 items>" in repr(results["long sweep"])


def test_energies_have_the_unit_of_their_model():
    energy = Energy(np.zeros(2), np.ones(2), np.zeros(2), np.zeros(2), unit="N mm")
    assert repr(energy).startswith("Energy(kinetic=[0., 0.] N mm, strain=[1., 1.] N mm, potential=")


def test_a_path_and_its_states_show_load_factors(results):
    path = results["path"]
    (crossing,) = path.bifurcations
    at = f"load factor {crossing.load_factor:.6g}"
    said = f"; 0 limit points, 1 bifurcation ({at}); stability is lost first at {at} by a bifurcation; ended because"
    assert said in repr(path)
    assert repr(path.bifurcations) == (
        f"(Bifurcation(load factor {crossing.load_factor:.6g}, not stable, of Model(1 beam, 1 support, 1 load)),)"
    )
    assert repr(path[0]) == "PathState(load factor 0, stable, of Model(1 beam, 1 support, 1 load))"
    many = replace(path, limit_points=(path[1],) * 9)
    assert f"9 limit points (load factor {', '.join([f'{path.at[1]:.6g}'] * 6)}, ...), 1 bifurc" in repr(many)


def test_loaded_functions_are_shown_by_how_many_values_they_have(tmp_path):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 10, bf.CRBF(2), lambda s: bf.Rectangle(0.1, 0.2 - 0.1 * s), STEEL)
    ramp, growing = np.cos, lambda s: (0.0, -1.0 - s)
    loads = [
        bf.DistributedLoad(beam, growing, ramp),
        bf.Pressure(beam, np.sin),
        bf.Actuation(beam, curvature=lambda s: 1e-3 * s),
    ]
    bf.simulate(bf.Model([beam], [bf.Clamp(beam.start)], loads), duration=0.01, step=1e-4).save(tmp_path / "a.h5")
    model = bf.load(tmp_path / "a.h5").model
    assert "vector=SampledAlong(at=<83 items>, values=<83 items>, kinks=())" in repr(model.loads[0])
    assert "amplitude=Sampled(at=<101 items>, values=<101 items>)" in repr(model.loads[0])
    assert repr(model.beams[0].section).startswith("SampledSection(at=<")
    for one in (*model.loads, model.beams[0].section):
        assert len(repr(one)) < 300, repr(one)


def test_sections_and_states_show_what_they_are_and_no_internals():
    section = bf.Profile("IPE 200")
    assert "name='IPE 200'" in repr(section)
    assert "Outline" not in repr(section)
    beam = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), 1, bf.CRBF(3), section, bf.Material(2.1e11, 0.3, 7850.0))
    state = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)]))[-1]
    assert repr(state) == "State(at=1.0, model=Model(1 beam, 1 support))"
