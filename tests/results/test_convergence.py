"""Convergence studies against functions whose order, limit and error are known exactly."""

import csv
import os
import re
from concurrent.futures import ProcessPoolExecutor
from functools import partial

import numpy as np
import pytest

import beamfem as bf
from beamfem.convergence.refinement_curve import (
    clean_points,
    extrapolate,
    fit_order,
    grid_convergence_index,
    order_of_three,
)
from beamfem.convergence.study import MOST_DOUBLINGS

LIMIT = 2.5


def power(elements, order=2.0, factor=0.3, limit=LIMIT):
    """Error exactly C h^p."""
    return {"value": limit + factor * elements**-order, "coordinates": 3 * elements, "half": elements / 2}


def step_power(step, order=2.0):
    return LIMIT - 0.7 * step**order


def failing(elements, order):
    if elements == 8 and order == 2:
        raise bf.ConvergenceError("no equilibrium found")
    if elements == 4 and order == 3:
        return float("nan")
    if elements == 16 and order == 1:
        os._exit(5)
    return 1.0 + elements**-order


def test_order_of_three_for_any_ratio():
    for h in ([1.0, 0.5, 0.25], [1.0, 0.7, 0.1], [0.3, 0.1, 0.09]):
        for p in (0.5, 1.0, 2.0, 3.7, 8.0):
            h = np.array(h)
            for sign in (-1.0, 1.0):
                assert order_of_three(h, sign * h**p) == pytest.approx(p, abs=1e-9)
    assert np.isnan(order_of_three(np.array([1.0, 0.5, 0.25]), np.array([1.0, 2.0, 1.5])))  # turns back
    assert np.isnan(order_of_three(np.array([1.0, 0.5, 0.25]), np.array([1.0, 2.0, 4.0])))  # runs away
    assert np.isnan(order_of_three(np.array([1.0, 0.5, 0.25]), np.array([1.0, 2.0, 2.0])))  # stands still


@pytest.mark.parametrize("elements", [[2, 4, 8, 16], [3, 4, 9, 11]], ids=["doubled", "uneven"])
@pytest.mark.parametrize("reference", [None, LIMIT], ids=["Richardson", "reference"])
def test_orders_and_limits_are_exact(elements, reference):
    study = bf.converge(
        power, quantity="value", refine="elements", order=[1.0, 2.0, 4.0], elements=elements, reference=reference
    )
    assert [curve.label for curve in study.curves] == ["order=1", "order=2", "order=4"]
    for curve, p in zip(study.curves, (1.0, 2.0, 4.0), strict=True):
        assert curve.limit == pytest.approx(LIMIT, rel=1e-12)
        np.testing.assert_allclose(curve.order[1:], p, atol=1e-6)
        assert curve.fit.order == pytest.approx(p, abs=1e-6)
        assert curve.fit.band < 1e-6
        assert (curve.fit.first, curve.fit.last) == (0, 3)
        np.testing.assert_allclose(curve.error, 0.3 / np.array(elements) ** p / LIMIT, rtol=1e-6)
        assert curve.estimated_error == pytest.approx(curve.error[-1], rel=1e-6)
        assert curve.others["coordinates"] == tuple(3 * n for n in elements)
        # of an exact power law the index is 1.25 times the error relative to the value
        np.testing.assert_allclose(curve.gci[2:], 1.25 * (0.3 / np.array(elements) ** p / curve.value)[2:], rtol=1e-6)
        assert np.isnan(curve.gci[:2]).all()


def test_grid_convergence_index_of_roache():
    """P. J. Roache 1998, in NASA's tutorial on grid convergence: 0.97050, 0.96854, 0.96178 with ratio 2.

    Printed there: limit 0.97130, GCI 0.103083 %; p = ln(0.00676 / 0.00196) / ln 2.
    """
    h, q = np.array([4.0, 2.0, 1.0]), np.array([0.96178, 0.96854, 0.97050])
    assert order_of_three(h, q) == pytest.approx(np.log2(0.00676 / 0.00196), abs=1e-9)
    assert extrapolate(h, q).limit == pytest.approx(0.97130, abs=5e-6)
    assert grid_convergence_index(h, q)[2] == pytest.approx(0.00103083, abs=1e-8)


def test_step_sizes_and_bare_numbers():
    study = bf.converge(step_power, refine="step", step=[0.4, 0.2, 0.1, 0.05], order=3)
    (curve,) = study.curves
    assert study.quantity == curve.label == "step_power"
    np.testing.assert_allclose(curve.size, [0.4, 0.2, 0.1, 0.05])
    assert curve.fit.order == pytest.approx(3.0, abs=1e-6)
    assert curve.limit == pytest.approx(LIMIT, rel=1e-12)


def test_errors_are_absolute_where_the_limit_is_zero():
    for reference in (None, 0.0):
        study = bf.converge(
            power, quantity="value", refine="elements", elements=[2, 4, 8], limit=0.0, reference=reference
        )
        np.testing.assert_allclose(study.curves[0].error, 0.3 / np.array([2.0, 4.0, 8.0]) ** 2, rtol=1e-9)
        assert study.error_name == "error"


def test_band_is_that_of_student():
    """Slope and its 95 % interval of four points, from the formulas of a regression; t(0.975, 2) = 4.302653."""
    h = np.array([1.0, 0.5, 0.25, 0.125])
    error = h**2 * np.array([1.0, 1.1, 0.95, 1.0])
    x, y = np.log(h), np.log(error)
    slope, offset = np.polyfit(x, y, 1)
    spread = np.sqrt(((y - slope * x - offset) ** 2).sum() / 2 / ((x - x.mean()) ** 2).sum())
    fit = fit_order(h, error)
    assert fit.order == pytest.approx(slope, abs=1e-12)
    assert fit.band == pytest.approx(4.302653 * spread, rel=1e-6)


def test_round_off_and_coarse_points_are_left_out():
    h = 0.5 ** np.arange(8)
    error = 1e-2 * h**4
    error[0] = 1.2e-2 * 0.5  # not asymptotic: order 3.26 with the next
    error[5:] = [6e-8, 7e-8, 4e-8]
    assert clean_points(h, error) == 5
    fit = fit_order(h, error)
    assert (fit.first, fit.last) == (1, 4)
    assert fit.order == pytest.approx(4.0, abs=1e-10)
    settled = extrapolate(h, 1.0 + error)
    assert settled.limit == 1.0 + error[-1]
    assert settled.settled


def test_a_reference_that_is_not_the_limit_is_told():
    study = bf.converge(power, quantity="value", refine="elements", elements=[8, 16, 32], reference=LIMIT + 0.5)
    assert study.curves[0].fit is None
    assert "may not be the limit" in study.report()


def test_until_refines_each_curve_as_far_as_it_must():
    study = bf.converge(power, quantity="value", refine="elements", elements=[2, 4], order=[1.0, 2.0, 4.0], until=1e-4)
    slow, medium, fast = study.curves
    assert slow.refinement[-1] == 4 * 2**MOST_DOUBLINGS
    assert "not reached after 8 doublings" in slow.notes[-1]
    assert medium.refinement == (2, 4, 8, 16, 32, 64)  # 0.3 / 32^2 / 2.5 = 1.17e-4
    assert medium.estimated_error < 1e-4
    assert "reached at elements=64" in medium.notes[-1]
    assert fast.refinement == (2, 4, 8, 16)  # an order that only three values show is not believed
    halved = bf.converge(step_power, refine="step", step=[0.1], until=1e-4, reference=LIMIT)
    assert halved.curves[0].refinement == (0.1, 0.05, 0.025, 0.0125)
    assert "reached at step=0.0125" in halved.report()


def test_until_stops_where_a_call_fails():
    study = bf.converge(failing, refine="elements", elements=[2, 4], order=[2], until=1e-9)
    assert "refined no further: elements=8 failed" in study.curves[0].notes


@pytest.mark.slow
def test_failures_are_named_and_the_others_go_on():
    study = bf.converge(
        failing,
        refine="elements",
        elements=[2, 4, 8, 16, 32],
        order=[1, 2, 3],
        executor=partial(ProcessPoolExecutor, 2),
    )
    assert [curve.refinement for curve in study.curves] == [(2, 4, 8, 32), (2, 4, 16, 32), (2, 8, 16, 32)]
    for curve, p in zip(study.curves, (1.0, 2.0, 3.0), strict=True):
        assert curve.fit.order == pytest.approx(p, abs=1e-6)
    dead, failed, not_a_number = study.failures
    assert dead.parameters == {"elements": 16, "order": 1}
    assert "WorkerDied" in dead.error
    assert str(failed) == "failed at order=2, elements=8: ConvergenceError: no equilibrium found"
    assert not_a_number.error == "the value is nan, not a finite number"
    assert str(failed) in study.report()
    assert "ConvergenceError" in study.to_markdown()


def test_nothing_but_failures_is_shown_too(tmp_path):
    study = bf.converge(failing, refine="elements", elements=[8], order=[2])
    assert study.curves == ()
    assert "no equilibrium found" in study.report()
    assert "no equilibrium found" in study.to_html(tmp_path / "page.html").read_text()


def test_table_csv_markdown_picture_and_page(tmp_path):
    elements = [bf.CRBF(2), bf.ANCF(bf.Structural()), bf.ANCF()]
    study = bf.converge(of_element, quantity="tip", refine="elements", element=elements, elements=[2, 4, 8])
    names = ["CRBF-2", "ANCF (structural, lobatto)", "ANCF (continuum, full)"]
    assert [curve.label for curve in study.curves] == names
    assert study.curves[1].parameters == {"element": elements[1]}
    header = ["element", "elements", "tip", "relative error", "order", "GCI", "coordinates", "seconds"]
    study.to_csv(tmp_path / "out" / "study.csv")
    with (tmp_path / "out" / "study.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert list(rows[0]) == header
    assert len(rows) == 9
    assert float(rows[2]["tip"]) == study.curves[0].value[2]
    assert float(rows[8]["order"]) == pytest.approx(2.0, abs=1e-6)
    text, markdown = study.report(), study.to_markdown()
    for name in [*names, *header, "2.000"]:
        assert name in text
        assert name in markdown
    page = study.to_html(tmp_path / "out" / "study.html").read_text()
    assert page.count("data:image/svg+xml") == 1
    assert not re.search(r"(src|href)=.http", page)
    for name in names:
        assert f">{name}</td>" in page
    figure = study.plot(tmp_path / "out" / "study.png")
    (axes,) = figure.axes
    assert (axes.get_xscale(), axes.get_yscale()) == ("log", "log")
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("elements", "relative error of tip")
    lines = [line for line in axes.lines if not line.get_label().startswith("_")]
    assert len({(line.get_color(), line.get_marker()) for line in lines}) == 3
    assert len(axes.patches) == 1  # one triangle for curves of one order
    assert (tmp_path / "out" / "study.png").stat().st_size > 10_000


def of_element(element, elements):
    return {"tip": 1.0 + element.coordinates_per_node * elements**-2.0, "coordinates": elements}


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"refine": "mesh"}, "refine names the parameter 'mesh'"),
        ({"elements": [2.5, 8.0, 4.0]}, r"falling step sizes, got 2\.5, 8\.0, 4\.0"),
        ({"elements": [2, 2]}, r"counts \(whole numbers, each once\) or falling"),
        ({"elements": [0, 2]}, "elements must be greater than zero"),
        ({"elements": []}, "elements must have at least one value"),
        ({"wrong": 1}, "cannot be called with"),
        ({"quantity": "weight"}, "known are value, coordinates, half"),
        ({"quantity": None}, "known are value, coordinates, half"),
        ({"until": -1.0}, "until must be greater than zero"),
        ({"reference": "exact"}, "reference must be a number"),
    ],
)
def test_bad_input(changes, message):
    arguments = {"quantity": "value", "refine": "elements", "elements": [2, 4]} | changes
    with pytest.raises(bf.InputError, match=message):
        bf.converge(power, **arguments)


def test_elements_converge_with_their_order():
    """Cantilever, P L^2 / EI = 5: the tip converges with order 2 k; extrapolation beats the finest value twentyfold."""

    def tip(element, elements):
        material = bf.Material(2e11, 0.3, 7800.0)
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, bf.Rectangle(0.1, 0.1), material)
        model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, 5 * 2e11 * 0.1**4 / 12))])
        return bf.solve_static(model).displacement(beam.end)[-1, 1]

    exact = 0.72054526137677  # Reissner beam, Gauss collocation of degree 30 and 44, 12 digits
    study = bf.converge(tip, refine="elements", element=[bf.CRBF(1), bf.CRBF(2)], elements=[16, 32, 64])
    # a fitted order nears that of the element with the square of the size: 0.02 short at these, 0.07 at twice the size
    assert [curve.fit.order for curve in study.curves] == pytest.approx([2, 4], abs=0.03)
    for curve in study.curves:
        assert abs(curve.limit - exact) < 0.05 * abs(curve.value[-1] - exact)


def estimated_tip(elements, order=1):
    """Deflection of a cantilever bent far, and the estimate of its error."""
    section, steel = bf.Rectangle(0.1, 0.1), bf.Material(2e11, 0.3, 7800.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, bf.CRBF(order), section, steel)
    force = bf.PointForce(beam.end, (0.0, 5.0 * steel.youngs_modulus * section.second_moment))
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [force]))
    return {"tip": solution.displacement(beam.end)[-1, 1], "tip_error": float(solution.error(beam.end)[1])}


def test_the_table_shows_the_effectivity_of_estimates():
    study = bf.converge(estimated_tip, "tip", refine="elements", elements=[8, 16, 32, 64], order=[1, 2])
    header, rows = study.points()
    ratios = np.array([row[header.index("effectivity")] for row in rows])
    assert np.all((ratios > 0.9) & (ratios < 1.1) | np.isnan(ratios))
    assert np.isfinite(ratios).sum() >= 7
    assert "effectivity" in str(study)


def test_one_level_has_the_error_that_its_function_estimates():
    study = bf.converge(estimated_tip, "tip", refine="elements", elements=[16])
    fine = estimated_tip(8, 8)["tip"]
    (curve,) = study.curves
    assert curve.estimated_error == pytest.approx(abs(fine / curve.value[0] - 1.0), rel=0.1)


def test_work_of_fixed_and_adaptive_meshes_is_compared(tmp_path):
    """A cantilever with a large deflection, whose limit is that of many elements of order 8."""
    steel, section = bf.Material(2e11, 0.3, 7800.0), bf.Rectangle(0.02, 0.01)

    def tip(element, elements, accuracy):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, section, steel)
        load = bf.PointForce(beam.end, (0.0, 5.0 * 2e11 * section.second_moment))
        solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [load]), accuracy=accuracy)
        return {"deflection": solution.displacement(beam.end)[-1, 1], "unknowns": solution.model.size}

    exact = tip(bf.CRBF(8), 24, None)["deflection"]
    meshes = {"accuracy": [1e-2, 1e-4], "elements": [2, 8, 32], "element": [bf.CRBF(1), bf.ShearRigid()]}
    study = bf.converge(tip, "deflection", refine="accuracy", reference=exact, **meshes)
    assert [curve.label for curve in study.curves] == [
        *(f"fixed, {kind}" for kind in ("CRBF-1", "shear-rigid-stretchable")),
        *(f"adaptive, {kind}" for kind in ("CRBF-1", "shear-rigid-stretchable")),
    ]
    for curve in study.curves[2:]:
        assert (curve.error * exact < curve.refinement).all()
    fixed, adaptive = study.curves[0], study.curves[2]
    assert fixed.others["unknowns"] == (9, 27, 99)
    assert adaptive.error[-1] < fixed.error[-1]
    assert adaptive.others["unknowns"][-1] < fixed.others["unknowns"][-1] / 2
    header, rows = study.points()
    assert header[:3] == ["mesh", "element", "accuracy or elements"]
    assert [row[0] for row in rows] == ["fixed"] * 6 + ["adaptive"] * 4
    (axes,) = study.plot(tmp_path / "work.png", against="unknowns").axes
    assert axes.get_xlabel() == "unknowns"
    assert sorted(axes.lines[0].get_xdata()) == list(fixed.others["unknowns"])
    assert study.plot().axes[0].get_xlabel() == "seconds"
    with pytest.raises(bf.InputError, match="the study has no number 'work'"):
        study.plot(against="work")
