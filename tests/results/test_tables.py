"""Results, sweeps and studies as tables of pandas and arrays of xarray."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from drawn import cantilever, frame, pendulum

import beamfem as bf

pandas = pytest.importorskip("pandas")
xarray = pytest.importorskip("xarray")


@pytest.mark.parametrize(("make", "over"), [(frame, "load_factor"), (pendulum, "time")])
def test_all_beams_at_once(make, over):
    solution = make()
    found = solution.to_xarray()
    assert found["moment"].dims == (over, "station")
    np.testing.assert_array_equal(found[over], solution.at)
    for number, beam in enumerate(solution.model.beams):
        own = found.where(found.beam == number, drop=True)
        alone = solution.to_xarray(beam)
        assert np.unique(alone.beam) == [number]
        np.testing.assert_array_equal(own["moment"], alone["moment"])
        np.testing.assert_allclose(own["x"][:, -1], solution.position(beam.end)[:, 0], atol=1e-12)
        np.testing.assert_allclose(own["arc_length"][-1], beam.curve.length, rtol=1e-12)


def test_a_data_frame_has_a_row_for_each_state_and_station():
    solution = frame()
    table, found = solution.to_pandas(), solution.to_xarray()
    assert table.index.names == ["load_factor", "beam", "arc_length"]
    assert len(table) == found.sizes["load_factor"] * found.sizes["station"]
    for name in ("x", "moment", "rotation"):
        np.testing.assert_array_equal(table[name].to_numpy().reshape(found[name].shape), found[name])
    beam = solution.model.beams[1]
    last = table.xs((1.0, 1), level=("load_factor", "beam"))
    np.testing.assert_allclose(last[["ux", "uy"]].iloc[-1], solution.displacement(beam.end)[-1], atol=1e-12)


def test_a_beam_of_another_model_is_refused():
    with pytest.raises(bf.InputError, match="not in"):
        cantilever().to_pandas(frame().model.beams[0])


def grown(length: float, kind: str, grades: int = 2) -> dict[str, object]:
    if kind == "bad" and length > 2.0:
        raise bf.InputError("too long")
    return {"area": length**2, "both": np.array([length, grades])}


def test_a_sweep_is_a_grid_over_what_varies():
    done = bf.sweep(grown, length=[1.0, 2.0, 3.0], kind=["good", "bad"])
    found = done.to_xarray()
    assert found["area"].dims == ("length", "kind")
    assert found["both"].dims == ("length", "kind", "both_0")
    np.testing.assert_array_equal(found["area"].sel(kind="good"), [1.0, 4.0, 9.0])
    np.testing.assert_array_equal(found["area"].sel(kind="bad"), [1.0, 4.0, np.nan])
    table = done.to_pandas()
    assert list(table.columns[:3]) == ["length", "kind", "area"]
    np.testing.assert_array_equal(table["area"], done["area"])


def test_a_sweep_is_drawn_over_a_parameter(tmp_path):
    done = bf.sweep(grown, length=[3.0, 1.0, 2.0], kind=["good", "bad"])
    axes = done.plot(path=tmp_path / "sweep.png").axes[0]
    assert (tmp_path / "sweep.png").stat().st_size > 5000
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("length", "area")
    good, bad = axes.lines
    assert (good.get_label(), bad.get_label()) == ("kind=good", "kind=bad")
    np.testing.assert_array_equal(good.get_xydata(), [[1.0, 1.0], [2.0, 4.0], [3.0, 9.0]])
    np.testing.assert_array_equal(bad.get_ydata(), [1.0, 4.0, np.nan])
    assert done.plot("seconds").axes[0].get_ylabel() == "seconds"
    for options, words in (({"value": "aera"}, "did you mean area"), ({"over": "kind"}, "over is no parameter")):
        with pytest.raises(bf.InputError, match=words):
            done.plot(**options)
    with pytest.raises(bf.InputError, match="nothing to draw"):
        bf.sweep(grown, length=1.0, kind=["good", "bad"]).plot()


def test_modes_buckling_and_studies_are_tables():
    steel = bf.Material(2e11, 0.3, 7800.0)
    column = bf.Beam(bf.Line((0, 0), (0, 1)), 4, bf.CRBF(3), bf.Rectangle(0.01, 0.01), steel)
    model = bf.Model([column], supports=[bf.Clamp(column.start)], loads=[bf.PointForce(column.end, (0, -1.0))])
    modes, buckling = bf.solve_modes(model, 3), bf.solve_buckling(model)
    np.testing.assert_array_equal(modes.to_pandas()["frequency"], modes.frequencies)
    assert list(buckling.to_pandas()["kind"]) == ["bifurcation"]

    def frequency(elements: int) -> float:
        beam = bf.Beam(bf.Line((0, 0), (0, 1)), elements, bf.CRBF(2), bf.Rectangle(0.01, 0.01), steel)
        return float(bf.solve_modes(bf.Model([beam], supports=[bf.Clamp(beam.start)]), 1).frequencies[0])

    study = bf.converge(frequency, refine="elements", elements=[2, 4, 8])
    table = study.to_pandas()
    np.testing.assert_array_equal(table["elements"], [2, 4, 8])
    np.testing.assert_array_equal(table[study.quantity], study.curves[0].value)


def of_three(load: float, n: int, h: float) -> float:
    return load * n * h


@pytest.mark.parametrize(("n", "h"), [([1, 2, 3, 4, 5], [1.0, 2.0]), ([1, 2, 3], [1.0])])
def test_the_legend_of_a_sweep_leaves_the_axes_their_height(n, h):
    """Ten curves took half of the figure, above the axes."""
    figure = bf.sweep(of_three, load=[1.0, 2.0], n=n, h=h).plot()
    figure.canvas.draw()
    axes, legend = figure.axes[0].get_window_extent(), figure.axes[0].get_legend()
    assert len(legend.get_texts()) == len(n) * len(h)
    assert not legend.get_window_extent().overlaps(axes)
    assert axes.height > 0.75 * figure.bbox.height
    assert axes.width > 5.0 * figure.dpi
    assert figure.bbox.x1 >= legend.get_window_extent().x1


def stepped():
    """A cantilever with a moment at its middle, which the moment jumps by, and a force along it."""
    steel = bf.Material(2e11, 0.3, 7800.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), bf.Rectangle(0.1, 0.1), steel)
    loads = [bf.PointMoment(beam.at(0.5), 7.0), bf.PointForce(beam.end, (20.0, 0.0))]
    return bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], loads))


def test_of_one_beam_the_arc_length_is_a_dimension_in_which_nothing_is_twice_or_lost():
    solution = stepped()
    (beam,) = solution.model.beams
    found = solution.to_xarray(beam)
    assert found["moment"].dims == ("load_factor", "arc_length")
    arc = found["arc_length"].to_numpy()
    assert np.all(np.diff(arc) > 0.0)
    last = found.sel(load_factor=1.0)
    for share in (0.25, 0.5, 0.75):  # the side towards the end, as fields have it; just before it the other one
        np.testing.assert_allclose(last["rotation"].sel(arc_length=share), solution.rotation(beam.at(share))[-1])
    assert last["moment"].sel(arc_length=0.5) == pytest.approx(0.0, abs=1e-3)
    assert last["moment"].sel(arc_length=np.nextafter(0.5, 0.0)) == pytest.approx(7.0, abs=1e-3)
    assert last["moment"].max() == pytest.approx(7.0, abs=1e-3)
    assert last["moment"].interp(arc_length=0.4999) == pytest.approx(7.0, abs=1e-3)
    assert last["moment"].sel(arc_length=0.3, method="nearest") == pytest.approx(7.0, abs=1e-3)
    assert last["moment"].integrate("arc_length") == pytest.approx(3.5, abs=1e-3)


def test_stations_of_a_curve_fall_nowhere():
    """Elements whose common end both compute, with round-off."""
    wave = bf.Parametric(lambda u: (u, np.sin(7.0 * u)), 0.0, 2.0)
    beam = bf.Beam(wave, 23, bf.CRBF(2), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)]))
    assert np.all(np.diff(solution.to_xarray(beam)["arc_length"]) > 0.0)


def test_stresses_are_in_tables_where_sections_have_them():
    solution = stepped()
    (beam,) = solution.model.beams
    for found in (solution.to_xarray(beam).isel(load_factor=-1), solution.to_pandas(beam).xs(1.0, level="load_factor")):
        top = 7.0 / (0.1**3 / 6)
        assert found["stress_lower"].max() == pytest.approx(20.0 / 0.01 + top, rel=1e-4)
        assert found["stress_upper"].min() == pytest.approx(20.0 / 0.01 - top, rel=1e-4)
        assert found["stress_shear"].max() < 1.0
        assert found["stress_von_mises"].max() == pytest.approx(20.0 / 0.01 + top, rel=1e-4)
    bare = bf.Section.from_stiffness(1e6, 1e6, 1e3, 1.0, 1.0)
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bare)
    other = bf.Beam(bf.Line((0, 1), (1, 1)), 2, bf.CRBF(2), bf.Rectangle(0.1, 0.1), bf.Material(2e11, 0.3, 1.0))
    both = bf.solve_static(bf.Model([one, other], [bf.Clamp(one.start), bf.Clamp(other.start)]))
    assert "stress_lower" not in both.to_xarray(one)
    table = both.to_pandas()["stress_lower"]
    assert table.xs(0, level="beam").isna().all()
    assert table.xs(1, level="beam").notna().all()


@pytest.fixture(scope="module")
def column():
    beam = bf.Beam(bf.Line((0, 0), (0, 1)), 4, bf.CRBF(3), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    return bf.Model([beam], supports=[bf.Clamp(beam.start)], loads=[bf.PointForce(beam.end, (0, -1.0))])


@pytest.mark.parametrize("engine", ["scipy", "h5netcdf"])
def test_labelled_arrays_are_written_as_netcdf(column, engine, tmp_path):
    pytest.importorskip(engine)
    results = [stepped(), pendulum(), bf.solve_modes(column, 3), bf.solve_buckling(column)]
    results += [bf.converge(lambda n: 1.0 + n**-2.0, refine="n", n=[2, 4, 8])]
    results.append(bf.sweep(grown, length=[1.0, 2.0], kind=["good", "bad"]))
    for number, result in enumerate(results):
        found = result.to_xarray()
        found.to_netcdf(tmp_path / f"{number}.nc", engine=engine)
        with xarray.open_dataset(tmp_path / f"{number}.nc", engine=engine) as again:
            xarray.testing.assert_allclose(again, found)
            assert again.attrs.get("status") == found.attrs.get("status")


def test_modes_and_critical_points_are_labelled_arrays(column):
    (beam,) = column.beams
    modes, buckling = bf.solve_modes(column, 3), bf.solve_buckling(column)
    found = modes.to_xarray(beam)
    np.testing.assert_array_equal(found["frequency"], modes.frequencies)
    assert found["ux"].dims == ("mode", "arc_length")
    drawn = modes.solution(1, 1e-6, frames=5).displacement(beam.at(0.5))[0, 0] / 1e-6
    shape = found["ux"].sel(mode=1)
    np.testing.assert_allclose(shape.sel(arc_length=0.5) / abs(shape).max(), drawn, rtol=1e-5)
    found = buckling.to_xarray()
    np.testing.assert_array_equal(found["load_factor"], buckling.load_factors)
    assert found["ux"].dims == ("mode", "station")
    s = found["arc_length"]
    np.testing.assert_allclose(abs(found["ux"][0]), 1.0 - np.cos(0.5 * np.pi * s), atol=1e-3)
    with pytest.raises(bf.InputError, match="not in this model"):
        modes.to_xarray(frame().model.beams[0])


def test_a_study_is_a_grid_of_curves_and_refinement():
    def power(elements, order):
        if order == 2.0 and elements == 8:
            raise ValueError
        return {"error of it": elements**-order, "limit": 3.0}

    study = bf.converge(power, "error of it", refine="elements", elements=[8, 2, 4], order=[1.0, 2.0], reference=0.0)
    found = study.to_xarray()
    assert found["error of it"].dims == ("curve", "elements")
    np.testing.assert_array_equal(found["elements"], [2, 4, 8])
    np.testing.assert_array_equal(found["error of it"], [[1 / 2, 1 / 4, 1 / 8], [1 / 4, 1 / 16, np.nan]])
    np.testing.assert_array_equal(found["limit"], [0.0, 0.0])
    np.testing.assert_array_equal(found["limit (result)"].sel(curve="order=1"), 3.0)


def deflection(elements):
    return 1.0 + elements**-2.0


def test_a_bare_number_is_named_after_its_function_in_sweeps_and_studies():
    study, done = bf.converge(deflection, refine="elements", elements=[1, 2, 4]), bf.sweep(deflection, elements=[1, 2])
    assert study.quantity == "deflection"
    assert list(done.table()[0]) == ["elements", "deflection", "seconds"]
    assert bf.sweep(partial(deflection), elements=[1])["deflection"] == [2.0]
    assert bf.sweep(lambda x: x, x=[1])["value"] == [1]
    assert bf.converge(lambda x: 1.0 + x**-2.0, refine="x", x=[1, 2, 4]).quantity == "value"


def test_tables_of_studies_leave_out_whole_solutions_as_those_of_sweeps_do():
    def solved(elements):
        solution = cantilever(elements=elements)
        return {"tip": solution.displacement(solution.model.beams[0].end)[-1, 1], "solution": solution}

    study = bf.converge(solved, "tip", refine="elements", elements=[1, 2])
    assert "solution" not in study.points()[0]
    assert "Solution(" not in str(study)
    assert len(study.curves[0].others["solution"]) == 2


def doubled(x: float) -> float:
    return 2.0 * x


def test_a_bare_number_is_found_as_value_too():
    """As before it had the name of its function."""
    sweep = bf.sweep(doubled, x=[1.0, 2.0])
    np.testing.assert_array_equal(sweep["value"], sweep["doubled"])
    assert sweep.plot("value", over="x").axes[0].get_ylabel() == "doubled"
    assert list(sweep.to_pandas().columns) == ["x", "doubled", "seconds"]
    named = bf.sweep(lambda x: {"value": 3.0 * x}, x=[1.0, 2.0])
    np.testing.assert_array_equal(named["value"], [3.0, 6.0])


@pytest.mark.parametrize("element", [bf.CRBF(order=2), bf.ANCF()])
def test_buckling_without_a_critical_point_is_an_empty_table(element):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, element, bf.Rectangle(0.01, 0.02), bf.Material(2e11, 0.3, 7850.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -1.0))])
    found = bf.solve_buckling(model)
    assert not len(found)
    assert found.to_xarray(beam).sizes["mode"] == found.to_xarray().sizes["mode"] == 0


@pytest.mark.parametrize("make", [cantilever, frame])
def test_an_index_row_of_a_data_frame_is_there_once(make):
    """Both sides of each end that two elements share are rows, of which 15 of 100 had the same index."""
    solution = make()
    table = solution.to_pandas()
    assert table.index.is_unique
    wide = table["moment"].unstack()
    assert wide.shape[0] == len(solution) * len(solution.model.beams)
    assert wide.notna().to_numpy().sum() == len(table)
    labelled = table.to_xarray()["moment"]
    assert int(labelled.notnull().sum()) == len(table)
    arc = table.index.get_level_values("arc_length").to_numpy()
    lengths = np.array([beam.curve.length for beam in solution.model.beams])[table.index.get_level_values("beam")]
    assert np.all(arc <= lengths)
    assert np.all(arc >= 0.0)


def test_rows_before_and_after_a_jump_are_told_apart():
    """Two equilibria at one load factor, of which the first belongs before it."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -1.0))])
    jumped = replace(bf.solve_static(model, at=[0.0, 0.4, 0.6, 1.0]), at=np.array([0.0, 0.5, 0.5, 1.0]))
    table = jumped.to_pandas()
    assert table.index.is_unique
    before, after = table["uy"].unstack("arc_length").iloc[1:3, -1]
    assert (before, after) == tuple(jumped.displacement(beam.end)[1:3, 1])
