"""Peaks between stations: section forces, stresses and extremes in pictures against closed forms."""

import pytest

import beamfem as bf

STEEL = bf.Material(2.1e11, 0.3, 7850.0, strength=2.35e8)
BREADTH, HEIGHT, LENGTH, LOAD = 0.05, 0.1, 2.0, 1e3
WIDEST = BREADTH * HEIGHT**2 / 6.0  # section modulus


def loaded(count, element, left, right):
    """A straight beam under a uniform load, and its solution."""
    beam = bf.Beam(bf.Line((0, 0), (LENGTH, 0)), count, element, bf.Rectangle(BREADTH, HEIGHT), STEEL)
    model = bf.Model([beam], [left(beam.start), right(beam.end)], [bf.DistributedLoad(beam, (0, -LOAD))])
    return beam, bf.solve_static(model)


@pytest.mark.parametrize("nodes", [2, 4])
@pytest.mark.parametrize("count", [1, 2, 3, 5])
def test_a_simple_beam_under_a_uniform_load(count, nodes):
    """M = q L^2 / 8 at midspan on any mesh; stations alone gave 0.667, 0.889, 0.963 and 0.987 of it."""
    beam, solution = loaded(count, bf.CRBF(nodes), bf.Pin, bf.Roller)
    moment = LOAD * LENGTH**2 / 8.0
    peak = solution.section_forces(beam).peak("moment")
    assert peak.value == pytest.approx(moment, rel=1e-6)
    assert (peak.arc_length, peak.row, peak.at) == pytest.approx((LENGTH / 2.0, 1, 1.0), abs=1e-3)
    assert solution.peak_stress("tension").value == pytest.approx(moment / WIDEST, rel=1e-5)
    assert solution.stresses(beam).peak("compression").value == pytest.approx(-moment / WIDEST, rel=1e-5)
    assert solution.peak_stress("utilisation").value == pytest.approx(moment / WIDEST / STEEL.strength, rel=1e-5)
    assert solution.section_forces(beam).moment.max() == pytest.approx(moment, rel=0.02)


def test_the_largest_sagging_moment_of_a_propped_beam():
    """M = R^2 / (2 q) at R / q from the support with the reaction R, on a mesh of one element."""
    beam, solution = loaded(1, bf.CRBF(4), bf.Clamp, bf.Roller)
    reaction = solution.reaction(beam.end)[-1, 1]
    table = solution.section_forces(beam)._repr_html_()
    assert f"{reaction**2 / (2.0 * LOAD):.6g}" in table
    assert solution.section_forces(beam).peak().value == pytest.approx(
        -(LOAD * LENGTH**2 / 2.0 - reaction * LENGTH), rel=1e-5
    )


def test_the_largest_stress_of_a_taper_is_where_its_depth_has_doubled():
    """Depth h (1 + 4 s), force P at its tip: sigma = 6 P s / (b h^2 (1 + 4 s)^2) is largest at s = 1/4."""
    depth, force = 0.02, 1.0
    beam = bf.Beam(
        bf.Line((0, 0), (1, 0)), 1, bf.CRBF(4), lambda s: bf.Rectangle(depth, depth * (1.0 + 4.0 * s)), STEEL
    )
    model = bf.Model([beam], [bf.Clamp(beam.end)], [bf.PointForce(beam.start, (0.0, -force))])
    value, arc_length, _ = bf.solve_static(model).peak_stress("tension")
    assert value == pytest.approx(6.0 * force * 0.25 / (depth * (2.0 * depth) ** 2), rel=1e-5)
    assert arc_length == pytest.approx(0.25, abs=1e-3)


def test_the_largest_of_many_beams_and_rows():
    """Three equal spans under different loads in three rows: the peak is that of the middle one in the last."""
    beams = [
        bf.Beam(bf.Line((x, 0), (x + LENGTH, 0)), 1, bf.CRBF(2), bf.Rectangle(BREADTH, HEIGHT), STEEL)
        for x in (0.0, 3.0, 6.0)
    ]
    supports = [support for beam in beams for support in (bf.Pin(beam.start), bf.Roller(beam.end))]
    loads = [bf.DistributedLoad(beam, (0, -LOAD * size)) for beam, size in zip(beams, (1.0, 1.5, 1.2), strict=True)]
    peak = bf.solve_static(bf.Model(beams, supports, loads), steps=3).peak_stress("tension")
    assert peak.value == pytest.approx(1.5 * LOAD * LENGTH**2 / 8.0 / WIDEST, rel=1e-5)
    assert peak.beam is beams[1]
    assert peak.at == 1.0


def test_a_picture_names_the_extreme_between_its_points():
    """On a propped beam the largest sagging moment is at 5/8 of the length, between the points that are drawn."""
    pytest.importorskip("matplotlib")
    beam, solution = loaded(1, bf.CRBF(4), bf.Clamp, bf.Roller)
    figure = solution.plot(colour="moment", loads=False)
    clamped = LOAD * LENGTH**2 / 2.0 - solution.reaction(beam.end)[-1, 1] * LENGTH
    texts = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    assert any(f"extreme {-clamped:.4g} N m" in text for text in texts)


def test_there_is_no_such_section_force():
    beam, solution = loaded(1, bf.CRBF(2), bf.Pin, bf.Roller)
    with pytest.raises(bf.InputError, match="there is no section force 'torsion'"):
        solution.section_forces(beam).peak("torsion")
