"""From a CAD spline to analysis and back without sampling."""

import numpy as np
import pytest

import beamfem as bf

CONTROL = ((0.0, 0.0), (0.5, 0.6), (1.2, 0.1), (1.6, 0.9), (2.4, 0.4), (3.0, 0.8))
C2 = bf.BSpline(3, (0, 0, 0, 0, 0.7, 2.0, 3.0, 3.0, 3.0, 3.0), CONTROL)
C1 = bf.BSpline(3, (0, 0, 0, 0, 1.3, 1.3, 3.0, 3.0, 3.0, 3.0), CONTROL)
SECTION, MATERIAL = bf.Rectangle(0.05, 0.04), bf.Material(1e9, 0.3, 1200.0)
MAKERS = (bf.ANCF, bf.ANCFCRBF, bf.ShearRigid, lambda: bf.ShearRigid(stretchable=False))


def beam_along(spline, element, elements="knots"):
    return bf.Beam(spline, elements, element, SECTION, MATERIAL)


@pytest.mark.parametrize("spline", [C2, C1], ids=["C2", "C1"])
@pytest.mark.parametrize("make", MAKERS)
def test_the_reference_is_the_spline_and_gives_it_back(spline, make):
    beam = beam_along(spline, make())
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)]))
    back = solution.spline(beam)
    assert back.knots == pytest.approx(spline.knots, abs=1e-13)
    assert np.abs(np.array(back.control_points) - CONTROL).max() < 1e-13
    for fraction in (0.1, 0.37, 0.5, 0.93):
        assert np.abs(solution.displacement(beam.at(fraction))[-1]).max() < 1e-13


def test_a_deformed_mesh_gives_the_spline_of_its_axis():
    beam = beam_along(C2, bf.ANCF(forces=bf.Structural()))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 4.0))])
    solution = bf.solve_static(model)
    back = solution.spline(beam)
    for fraction in np.linspace(0.0, 1.0, 23):
        u = C2.parameter(np.array([fraction * C2.length]))
        assert back.evaluate(u)[0] == pytest.approx(solution.position(beam.at(fraction))[-1], abs=1e-13)


def test_a_support_within_a_span_splits_it_exactly():
    beam = beam_along(C2, bf.ANCF())
    model = bf.Model([beam], [bf.Clamp(beam.start), bf.Roller(beam.at(0.4))])
    solution = bf.solve_static(model)
    assert len(solution.model.meshes[0].vertices) == 5
    assert np.abs(np.array(solution.spline(beam).control_points)).max() < 4.0
    assert solution.position(beam.at(0.77))[-1] == pytest.approx(beam.at(0.77).reference, abs=1e-13)


def test_knot_spans_converge_to_the_same_as_arc_lengths():
    """Halving the spans by double knots; both meshes tend to one tip position."""
    tips = []
    for elements in (48, 96):
        beam = beam_along(C2, bf.ANCFCRBF(forces=bf.Structural()), elements)
        model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 4.0))])
        tips.append(bf.solve_static(model).position(beam.end)[-1])
    limit = tips[1] + (tips[1] - tips[0]) / 3.0
    u = np.unique(np.concatenate([np.linspace(a, b, 33) for a, b in zip(C2.breaks[:-1], C2.breaks[1:], strict=True)]))
    fine = bf.spline_through_hermite(u, C2.evaluate(u), C2.derivative(u))
    beam = beam_along(fine, bf.ANCFCRBF(forces=bf.Structural()))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 4.0))])
    assert bf.solve_static(model).position(beam.end)[-1] == pytest.approx(limit, abs=2e-4)


@pytest.mark.parametrize(
    ("curve", "elements", "element", "message"),
    [
        (bf.Line((0, 0), (1, 0)), "knots", bf.ANCF(), "needs a BSpline"),
        (C2, "knots", bf.CRBF(3), "needs a cubic element"),
        (C2, "spans", bf.ANCF(), '"knots"'),
        (bf.BSpline(1, (0, 0, 1, 1), ((0, 0), (1, 0))), "knots", bf.ANCF(), "degree 3"),
    ],
)
def test_what_is_no_mesh_of_cubics_is_refused(curve, elements, element, message):
    with pytest.raises(bf.InputError, match=message):
        beam_along(curve, element, elements)
