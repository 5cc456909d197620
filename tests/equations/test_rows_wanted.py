"""Rows of a static solve at the load factors that are asked for, and the turns counted between them."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.solve.start.functions_of_time import FunctionOfTime, kinks_and_turning_points

SQUARE, STEEL = bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0)
EI = 2e11 * 1e-8 / 12


def roll(element, turns):
    """A strip that an end moment rolls up; each load factor is a share of the turns."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 12, element, SQUARE, STEEL)
    return beam, bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, 2 * np.pi * turns * EI)])


@pytest.mark.parametrize("steps", [1, 15])
def test_rows_are_those_that_are_asked_for(steps):
    beam, model = roll(bf.CRBF(order=3), 1.0)
    at = [0.0, 0.1, 1 / 3, 0.5, 0.9]
    solution = bf.solve_static(model, steps, at=at)
    assert solution.load_factor.tolist() == at
    assert solution.rotation(beam.end) == pytest.approx(2 * np.pi * np.array(at), rel=1e-5, abs=1e-9)


def test_what_is_behind_the_last_row_is_not_solved_for():
    """Half a toggle frame gives way between the two."""
    half = bf.Beam(bf.Line((0, 0), (1, 0.04)), 6, bf.CRBF(order=3), SQUARE, STEEL)
    supports = [bf.Clamp(half.start), bf.Prescribed(half.end, ux=0.0, rotation=0.0)]

    def model(force):
        return bf.Model([half], supports, [bf.PointForce(half.end, (0, -force))])

    path = bf.trace_equilibrium(model(1.0), until=1e5)
    limit = path.limit_points[0].load_factor
    before = bf.solve_static(model(2.0 * limit), at=[0.2, 0.4])
    assert before.load_factor.tolist() == [0.2, 0.4]
    assert before.stable.all()
    with pytest.raises(bf.LimitPointError):
        bf.solve_static(model(2.0 * limit), at=[0.2, 0.6])
    behind = bf.solve_static(model(2.0 * limit), at=[0.2, 0.4, 0.6, 1.0], snap="jump")
    assert behind.load_factor.tolist() == [0.2, 0.4, 0.6, 1.0]
    heights = behind.position(half.end)[:, 1]
    assert heights[1] > 0.0 > heights[2]


def test_turns_between_rows_are_counted():
    """Gradients know a rotation up to full turns only; rows more than half a turn apart come of rows in between."""
    element = bf.ANCF(bf.Structural())
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 12, element, SQUARE, STEEL)
    stub = bf.Beam(bf.Line((1, 0), (1.1, 0)), 1, element, SQUARE, STEEL)
    turning = bf.Prescribed(beam.start, ux=0.0, uy=0.0, rotation=lambda factor: 5.0 * np.pi * factor)
    model = bf.Model([beam, stub], [turning], [], [bf.Rigid(beam.end, stub.start)])
    solution = bf.solve_static(model, at=[0.0, 1.0])
    assert solution.rotation(stub.end) == pytest.approx([0.0, 5.0 * np.pi], abs=1e-6)


def test_load_at_zero_alone_is_the_state_without_load():
    beam, model = roll(bf.CRBF(order=2), 0.1)
    solution = bf.solve_static(model, at=[0.0])
    assert (len(solution), solution.displacement(beam.end).tolist()) == (1, [[0.0, 0.0]])


@pytest.mark.parametrize(
    ("at", "said"),
    [
        ([], "must be ascending load factors"),
        ([0.5, 0.25], "must be ascending load factors"),
        ([0.5, 0.5], "must be ascending load factors"),
        ([0.5, 1.5], "between 0 and 1"),
        ([-0.5], "between 0 and 1"),
        ([np.nan], r"at\[0\] must be finite"),
        (["1"], r"at\[0\] must be a number"),
        (0.5, "at must be a list"),
    ],
)
def test_rows_that_there_cannot_be_are_refused(at, said):
    with pytest.raises(bf.InputError, match=said):
        bf.solve_static(roll(bf.CRBF(order=2), 0.1)[1], at=at)


HISTORIES = {
    "function": lambda f: 20.0 * (1.0 - abs(1.0 - 2.0 * f)),
    "declared kink": bf.Piecewise(lambda f: 20.0 * (1.0 - abs(1.0 - 2.0 * f)), kinks=[0.5]),
    "table": bf.Interpolated([(0.0, 0.0), (0.5, 20.0), (1.0, 0.0)]),
}


@pytest.mark.parametrize("history", HISTORIES.values(), ids=HISTORIES)
@pytest.mark.parametrize("steps", [1, 7, 10])
def test_the_peak_of_a_motion_out_and_back_is_a_row(history, steps):
    """Rows were 0, 0 as it comes, and 12 mm at most with 10 steps."""
    bar = bf.Beam(bf.Line((0, 0), (100, 0)), 6, bf.CRBF(2), bf.Rectangle(5, 5), bf.Material(2e5, 0.3, 1e-9))
    model = bf.Model([bar], [bf.Clamp(bar.start), bf.Prescribed(bar.end, uy=history)])
    solution = bf.solve_static(model, steps)
    peak = int(np.argmin(np.abs(solution.load_factor - 0.5)))
    assert solution.load_factor[peak] == 0.5
    assert solution.displacement(bar.end)[peak, 1] == pytest.approx(20.0, rel=1e-12)
    assert solution.displacement(bar.end)[-1, 1] == pytest.approx(0.0, abs=1e-12)


def test_an_amplitude_that_turns_between_the_ends_has_a_row_there():
    beam, model = roll(bf.CRBF(3), 0.25)
    load = bf.PointMoment(beam.end, model.loads[0].moment, amplitude=lambda f: np.sin(np.pi * f))
    solution = bf.solve_static(bf.Model(model.beams, model.supports, [load]))
    assert solution.rotation(beam.end).max() == pytest.approx(0.5 * np.pi, rel=1e-6)
    assert solution.rotation(beam.end)[-1] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("steps", [2, 4, 9])
def test_steps_are_rows(steps):
    _, model = roll(bf.CRBF(3), 0.1)
    assert bf.solve_static(model, steps).load_factor == pytest.approx(np.linspace(0.0, 1.0, steps + 1), abs=1e-15)


def test_what_varies_between_rows_is_named():
    beam, model = roll(bf.CRBF(3), 0.01)
    load = bf.PointMoment(beam.end, 1.0, amplitude=lambda f: np.sin(997.3 * np.pi * f))
    with pytest.warns(UserWarning, match="amplitude of PointMoment .* varies more between load factors"):
        bf.solve_static(bf.Model(model.beams, model.supports, [load]))


BENDS = {
    "triangle": (lambda f: 1.0 - abs(1.0 - 2.0 * f), [0.5]),
    "ramps": (lambda f: min(f / 0.3, 1.0, (1.0 - f) / 0.2), [0.3, 0.8]),
    "third": (lambda f: abs(f - 1.0 / 3.0), [1.0 / 3.0]),
    "table": (bf.Interpolated([(0.0, 0.0), (0.2, 1.0), (0.7, 1.5), (1.0, 0.0)]), [0.2, 0.7]),
    "waves": (lambda f: np.sin(3.0 * np.pi * f), [1 / 6, 0.5, 5 / 6]),
    "power": (lambda f: f**2, []),
    "exponential": (lambda f: np.exp(9.0 * f), []),
    "constant": (lambda f: 1.0, []),
}


@pytest.mark.parametrize(("function", "expected"), BENDS.values(), ids=BENDS)
def test_kinks_and_turning_points_of_functions_are_found(function, expected):
    found = kinks_and_turning_points([FunctionOfTime("a function", function, True)], 0.0, 1.0)
    assert found == pytest.approx(expected, abs=1e-8)


@pytest.mark.parametrize("steps", [1, 7, 10])
def test_load_that_jumps_from_rest_is_solved(steps):
    """A load that is zero until it jumps: the search beyond the jump divided by a movement of zero."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=4), SQUARE, STEEL)
    force = bf.PointForce(beam.end, (0, 2 * EI), amplitude=lambda factor: float(factor >= 0.437))
    sudden = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [force]), steps)
    steady = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, 2 * EI))]))
    np.testing.assert_allclose(sudden.p[-1], steady.p[-1], atol=1e-8)
    assert sudden.load_factor[np.flatnonzero(np.diff(sudden.displacement(beam.end)[:, 1]))[0]] == pytest.approx(0.437)


@pytest.mark.parametrize("width", [0.05, 0.012, 0.008])
def test_all_three_kinks_of_a_narrow_peak_are_found(width):
    """Of a peak narrower than two samples one kink was found where three are."""
    for centre in np.linspace(0.1, 0.9, 23).tolist():
        peak = FunctionOfTime("a peak", lambda at, c=centre: max(0.0, 1.0 - 2.0 * abs(at - c) / width), True)
        found = kinks_and_turning_points([peak], 0.0, 1.0)
        expected = [centre - 0.5 * width, centre, centre + 0.5 * width]
        assert np.abs(np.subtract.outer(expected, found)).min(axis=1).max() < 1e-7
