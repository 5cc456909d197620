"""Features between the integration points of a first mesh, found in review: results and estimates missed them."""

import warnings

import numpy as np
import pytest

import beamfem as bf

STEEL = bf.Material(2e11, 0.3, 7800.0)
WIDTHS = np.array([0.05, 0.02, 0.01])
SIDES = np.concatenate([0.4 + side * WIDTHS + beside for side in (-0.5, 0.5) for beside in (-1e-12, 1e-12)])
LENGTHS = np.sort([*np.linspace(0.0, 1.0, 200001), *SIDES])
THIN = bf.Rectangle(0.02, 0.01)
MOMENT = 2e11 * THIN.second_moment


def bump(width):
    return lambda s: np.exp(-(((s - 0.4) / width) ** 2))


def notched(width):
    return lambda s: 0.01 * (1.0 - 0.9 * bump(width)(s))


def jumped(width):
    return lambda s: np.where(abs(s - 0.4) < 0.5 * width, 0.003, 0.01)


def along(values):
    """Return the integral from the start of values at `LENGTHS`."""
    return np.append(0.0, np.cumsum(0.5 * (values[1:] + values[:-1]) * np.diff(LENGTHS)))


def end_of(curvature):
    """Return the end of a cantilever of length 1 with a curvature at `LENGTHS`."""
    turned = along(curvature)
    return along(np.cos(turned))[-1], along(np.sin(turned))[-1]


@pytest.mark.parametrize("accuracy", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize("width", WIDTHS.tolist())
@pytest.mark.parametrize("shape", [notched, jumped])
def test_a_notch_bends_under_a_moment(shape, width, accuracy):
    height = shape(width)
    flexibility = 12.0 / (2e11 * 0.02 * height(LENGTHS) ** 3)
    moment = 1.0 / along(flexibility)[-1]  # turns the end by 1 rad
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), section=lambda s: bf.Rectangle(0.02, float(height(s))), material=STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, moment)])
    solution = bf.solve_static(model, accuracy=accuracy)
    exact = end_of(moment * flexibility)
    assert solution.position(beam.end)[-1] == pytest.approx(exact, abs=1.5 * accuracy)


@pytest.mark.parametrize("accuracy", [1e-2, 1e-4, 1e-6])
@pytest.mark.parametrize("width", [0.05, 0.01, 0.003])
def test_an_actuator_bends_where_it_is(width, accuracy):
    curvature = lambda s: 0.8 * bump(width)(s) / width  # noqa: E731
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), section=bf.Rectangle(0.02, 0.01), material=STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.Actuation(beam, curvature=curvature)])
    solution = bf.solve_static(model, accuracy=accuracy)
    assert solution.position(beam.end)[-1] == pytest.approx(end_of(curvature(LENGTHS)), abs=1.5 * accuracy)


@pytest.mark.parametrize("accuracy", [1e-2, 1e-4])
@pytest.mark.parametrize("width", [0.01, 0.003])
def test_a_narrow_load_is_a_force(width, accuracy):
    """At 0.4 of the length; within its width it differs from a force by its square."""
    ends = []
    for narrow in (True, False):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), section=bf.Rectangle(0.02, 0.01), material=STEEL)
        spread = lambda s: (0.0, 6.0 * MOMENT * bump(width)(s) / (np.sqrt(np.pi) * width))  # noqa: E731
        load = bf.DistributedLoad(beam, spread) if narrow else bf.PointForce(beam.at(0.4), (0.0, 6.0 * MOMENT))
        solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [load]), accuracy=accuracy)
        ends.append(solution.position(beam.end)[-1])
    assert ends[0] == pytest.approx(ends[1], abs=2.0 * accuracy + 6.0 * width**2)


def test_smooth_functions_cost_no_elements():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), section=lambda s: bf.Rectangle(0.02, 0.01 * (1 - 0.5 * s)), material=STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 0.3 * MOMENT))])
    assert bf.solve_static(model, accuracy=1e-4).model.beams[0].element_count == 1


@pytest.mark.parametrize("found", [float("nan"), float("inf"), None])
def test_a_quantity_that_is_no_number_is_refused(found):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), section=bf.Rectangle(0.02, 0.01), material=STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, MOMENT))])
    with pytest.raises(bf.InputError, match="quantity must return a number"):
        bf.solve_static(model, accuracy=1e-4, quantity=lambda solution: found)


@pytest.mark.parametrize("what", ["section", "load", "actuation"])
def test_estimates_on_meshes_of_ones_own_warn_of_what_they_miss(what):
    def solved(width, elements):
        section = (lambda s: bf.Rectangle(0.02, float(notched(width)(s)))) if what == "section" else THIN
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, bf.CRBF(2), section, STEEL)
        loads = {
            "load": bf.DistributedLoad(beam, lambda s: (0.0, MOMENT * bump(width)(s) / width)),
            "actuation": bf.Actuation(beam, curvature=lambda s: 0.1 * bump(width)(s) / width),
        }
        load = loads.get(what, bf.PointForce(beam.end, (0.0, 0.01 * MOMENT)))
        return bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [load]))

    with pytest.warns(bf.CoarseMeshWarning, match="what varies along beam 0 is narrower than its elements"):
        solved(0.01, 3).error()
    with warnings.catch_warnings(action="error"):
        solved(0.2, 24).error()
