"""Results, sweeps and studies as tables of pandas and arrays of xarray."""

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
    axes, (legend,) = figure.axes[0].get_window_extent(), figure.legends
    assert len(legend.get_texts()) == len(n) * len(h)
    assert not legend.get_window_extent().overlaps(axes)
    assert axes.height > 0.75 * figure.bbox.height
    assert axes.width > 5.0 * figure.dpi
    assert figure.bbox.x1 >= legend.get_window_extent().x1
