"""Safety factors and envelopes of load cases against closed forms of a simple beam."""

import numpy as np
import pytest
from matplotlib.figure import Figure

import beamfem as bf

STEEL = bf.Material(2.1e11, 0.3, 7850.0, strength=2.35e8)
SECTION = bf.Profile("IPE 200")


def simple_beam(elements=6, element=None, section=SECTION, material=STEEL):
    beam = bf.Beam(bf.Line((0, 0), (6, 0)), elements, element or bf.CRBF(4), section, material)
    return bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end)]), beam


def small_cases(model, beam):
    """Loads so small that the beam stays straight: uniform down, and a force up at 2 m."""
    return {
        "uniform": bf.solve_static(model.with_loads([bf.DistributedLoad(beam, (0.0, -10.0))])),
        "force": bf.solve_static(model.with_loads([bf.PointForce(beam.at(1 / 3), (0.0, 30.0))])),
    }


def test_the_safety_factor_of_a_bar_in_tension_and_of_a_cantilever():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(4), bf.Rectangle(0.01, 0.01), STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -0.1))])
    bent = bf.solve_static(model)
    assert bent.safety_factor(beam) == pytest.approx(2.35e8 / (6 * 0.1 / 0.01**3), rel=1e-6)
    pulled = bf.solve_static(model.with_loads([bf.PointForce(beam.end, (23.5, 0.0))]))
    assert pulled.safety_factor() == pytest.approx(1000.0, rel=1e-5)
    assert bf.solve_static(model.with_loads([])).safety_factor(beam) > 1e20


@pytest.mark.parametrize("section", [bf.Rectangle(0.01, 0.01), bf.Section(1e-4, 1e-9)])
def test_no_safety_factor_without_a_strength_or_a_stress(section):
    material = bf.Material(2.1e11, 0.3, 7850.0) if section.bounds[0] == -0.005 else STEEL
    model, beam = simple_beam(section=section, material=material)
    with pytest.raises(bf.InputError, match="strength"):
        bf.solve_static(model).safety_factor(beam)


def test_an_envelope_has_the_extremes_of_both_cases_between_stations_too():
    """Moments of a simple beam of 6 m: q L^2 / 8 at 3 m, -F a b / L at the force."""
    model, beam = simple_beam(elements=5)
    header, rows = bf.envelope(small_cases(model, beam)).table(["moment", "shear"])
    assert header == ["beam", "quantity", "extreme", "value", "at [m]", "case"]
    assert [row[1:3] for row in rows[:2]] == [["moment [N m]", "smallest"], ["moment [N m]", "largest"]]
    assert [row[3] for row in rows] == pytest.approx([-30 * 2 * 4 / 6, 10 * 36 / 8, -30, 30], rel=1e-6)
    assert [row[4] for row in rows[:2]] == pytest.approx([2.0, 3.0], abs=1e-3)
    assert [row[5] for row in rows[:2]] == ["force", "uniform"]


def test_along_a_beam_cases_with_different_meshes_meet_and_jumps_stay():
    model, beam = simple_beam(elements=5)
    cases = small_cases(model, beam)
    both = bf.envelope(list(cases.values()))
    curve, x = both.along(beam, "shear"), np.linspace(0.1, 5.8, 7)
    assert list(both.cases) == ["case 0", "case 1"]
    for values, expected in ((curve.smallest, np.minimum), (curve.largest, np.maximum)):
        at = np.array([int(np.argmin(np.abs(curve.arc_length - place))) for place in x])
        # M' = -V, with M > 0 where the beam sags
        wanted = expected(-10.0 * (3.0 - curve.arc_length), np.where(curve.arc_length < 2.0, 20.0, -10.0))
        assert values[at] == pytest.approx(wanted[at], rel=1e-6, abs=1e-6)
    beside = np.flatnonzero(np.isclose(curve.arc_length, 2.0))
    before, after = (curve.cases["case 1"][0, station] for station in beside)
    assert abs(before - after) == pytest.approx(30.0, rel=1e-6)
    # as the stations of one solution have it, to the last digits
    own = cases["uniform"].section_forces(beam)
    alone = bf.envelope([cases["uniform"]]).along(beam, "moment")
    at = [int(np.argmin(np.abs(alone.arc_length - place))) for place in own.arc_length]
    np.testing.assert_allclose(alone.smallest[at], own.moment[-1], atol=1e-7 * np.abs(own.moment).max())


def test_beams_without_elements_have_envelopes_as_well():
    beam = bf.Beam(bf.Line((0, 0), (6, 0)), section=SECTION, material=STEEL)
    model = bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end)])
    _, rows = bf.envelope(small_cases(model, beam)).table(["moment"])
    assert [row[3] for row in rows] == pytest.approx([-40.0, 45.0], rel=1e-4)


def test_a_picture_is_curved_between_the_stations_of_few_elements():
    """The moment of a uniform load is a parabola, M = q x (L - x) / 2, on 2 elements as well."""
    model, beam = simple_beam(elements=2, element=bf.CRBF(6))
    solution = bf.solve_static(model.with_loads([bf.DistributedLoad(beam, (0.0, -10.0))]))
    axes = bf.envelope([solution]).plot(beam, "moment", ax=Figure().subplots()).axes[0]
    x, moment = axes.lines[1].get_data()
    assert np.diff(x).max() < 6.0 / 399
    assert moment == pytest.approx(5.0 * x * (6.0 - x), abs=1e-4 * 45)


@pytest.mark.slow
def test_rows_that_count_pandas_and_pictures(tmp_path):
    model, beam = simple_beam()
    loads = [bf.PointForce(beam.at(0.5), (0.0, -30.0))]
    solution = bf.solve_static(model.with_loads(loads), steps=3)
    assert len(bf.envelope([solution]).cases["case 0"]) == 1
    curve = bf.envelope([solution], every_row=True).along(beam, "moment")
    assert min(abs(curve.smallest.max()), abs(curve.largest.min())) <= 1e-6
    both = bf.envelope({"load": solution})
    table = both.to_pandas()
    assert list(table["quantity"])[-1] == "utilisation [-]"
    assert "IPE" not in repr(both)
    assert "load" in repr(both)
    assert "<table>" in both._repr_html_()
    both.plot(beam, "von_mises", tmp_path / "envelope.png")
    assert (tmp_path / "envelope.png").stat().st_size > 5000


def test_what_is_no_set_of_load_cases_is_refused():
    model, beam = simple_beam()
    other, _ = simple_beam()
    solution = bf.solve_static(model)
    for wrong in ([], [model], 3, {"a": 1}):
        with pytest.raises(bf.InputError, match=r"solutions|list"):
            bf.envelope(wrong)
    with pytest.raises(bf.InputError, match="not in this model"):
        bf.envelope([solution, bf.solve_static(other)])
    with pytest.raises(bf.InputError, match="quantity"):
        bf.envelope([solution]).along(beam, "momentum")


def test_a_safety_factor_names_the_beams_that_it_leaves_out():
    """It was that of the beams with a known strength, although another one had twice the stress."""
    known, unknown = bf.Material(2.1e11, 0.3, 7850.0, strength=2.35e8), bf.Material(2.1e11, 0.3, 7850.0)
    beams = [
        bf.Beam(bf.Line((x, 0), (x + 1.0, 0)), 2, bf.CRBF(3), bf.Rectangle(0.02, 0.02), material)
        for x, material in ((0.0, unknown), (1.0, known))
    ]
    push = bf.PointForce(beams[1].end, (0.0, -50.0))
    model = bf.Model(beams, [bf.Clamp(beams[0].start)], [push], [bf.Rigid(beams[0].end, beams[1].start)])
    solution = bf.solve_static(model)
    with pytest.warns(bf.UnknownStressWarning, match="leaves out .* beam 0"):
        assert solution.safety_factor() == pytest.approx(solution.safety_factor(beams[1]))
