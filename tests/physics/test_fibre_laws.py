"""Sections that yield fibre by fibre: pure bending against the closed curve, unloading, restrained bars."""

import math

import numpy as np
import pytest
from fibre_beam import axial_force
from fibre_laws import SIDE, STEEL, moment, square
from history_laws import SECTION, Plastic
from scipy.optimize import brentq
from slow_values import mostly_slow

import beamfem as bf

YIELD_MOMENT = 2.5e8 * SIDE**3 / 6
YIELD_CURVATURE = 2 * 2.5e8 / (2.1e11 * SIDE)


def bar(section, loads=lambda beam: [], supports=lambda beam: [], elements=2):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, bf.CRBF(order=3), section, STEEL)
    return beam, bf.Model([beam], [bf.Clamp(beam.start), *supports(beam)], loads(beam))


@pytest.mark.parametrize("steps", [1, 5])
@pytest.mark.parametrize("fibres", [21, 31, 101])
def test_perfect_plasticity_follows_the_moment_curvature_curve(fibres, steps):
    section = square(fibres)
    beam, model = bar(section, lambda beam: [bf.PointMoment(beam.end, 1.4 * YIELD_MOMENT)])
    bent = bf.solve_static(model, steps=steps)
    by_fibres = brentq(lambda curvature: moment(section, curvature) - 1.4 * YIELD_MOMENT, 0.0, 1.0)
    turn = bent.rotation(beam.end)[-1]
    assert turn == pytest.approx(by_fibres, rel=1e-6)
    # M = 1.5 M_y (1 - (kappa_y / kappa)^2 / 3): fibres differ from it by the area of one
    assert turn == pytest.approx(YIELD_CURVATURE / math.sqrt(3 - 2 * 1.4), rel=4 / fibres**1.5 + 1e-3)
    assert bent.stable.all()


@pytest.mark.slow
def test_fibres_near_the_plastic_moment():
    section = square(201)
    beam, model = bar(section, lambda beam: [bf.PointMoment(beam.end, 1.49 * YIELD_MOMENT)], elements=8)
    turn = bf.solve_static(model).rotation(beam.end)[-1]
    assert turn == pytest.approx(YIELD_CURVATURE / math.sqrt(3 - 2 * 1.49), rel=2e-3)


def test_no_equilibrium_beyond_the_plastic_moment():
    _, model = bar(square(5), lambda beam: [bf.PointMoment(beam.end, 1.6 * YIELD_MOMENT)])
    with pytest.raises(bf.ConvergenceError, match="no load step") as caught:
        bf.solve_static(model)
    largest = 2.5e8 * np.abs(square(5).places).sum() * SIDE**2 / 5
    assert caught.value.solution.at[-1] == pytest.approx(largest / (1.6 * YIELD_MOMENT), rel=1e-3)


@pytest.mark.parametrize("steps", [2, 4, 10])
@pytest.mark.parametrize("amplitude", [lambda at: 1 - abs(2 * at - 1), lambda at: math.sin(math.pi * at)])
def test_unloading_leaves_the_plastic_curvature(amplitude, steps):
    section = square(21)
    beam, model = bar(section, lambda beam: [bf.PointMoment(beam.end, 1.2 * YIELD_MOMENT, amplitude=amplitude)])
    bent = bf.solve_static(model, steps=steps, at=[0.0, 0.5, 1.0])
    by_fibres = brentq(lambda curvature: moment(section, curvature) - 1.2 * YIELD_MOMENT, 0.0, 1.0)
    elastic = 1.2 * YIELD_MOMENT / section.rigidity(STEEL).bending
    assert bent.rotation(beam.end) == pytest.approx([0.0, by_fibres, by_fibres - elastic], rel=1e-6)
    assert bent.warnings == ()
    assert bent.statistics.digits > 4.0


@pytest.mark.parametrize("limit", [1e12, 2.5e8])
def test_a_force_is_taken_back(limit):
    section = square(21, limit=limit, hardening=2.1e9)
    force = 0.6 * YIELD_MOMENT if limit > 1e11 else 1.2 * YIELD_MOMENT
    triangle = lambda at: 1 - abs(2 * at - 1)  # noqa: E731
    beam, model = bar(section, lambda beam: [bf.PointForce(beam.end, (0, force), amplitude=triangle)])
    moved = bf.solve_static(model, steps=10, at=[0.5, 1.0]).displacement(beam.end)[:, 1]
    assert moved[0] > 0.04
    if limit > 1e11:
        assert abs(moved[1]) < 1e-12
    else:  # what is plastic at the clamp only bends the arm by little
        assert 1e-4 < moved[1] < 0.02 * moved[0]


def test_modes_of_a_structure_that_was_unloaded():
    arch = lambda at: math.sin(math.pi * at)  # noqa: E731
    frequencies = []
    for limit, size in ((2.5e8, 1.1 * YIELD_MOMENT), (1e12, 1e-3)):
        bend = lambda beam, size=size: [bf.PointMoment(beam.end, size, amplitude=arch)]  # noqa: E731
        _, model = bar(square(21, hardening=2.1e9, limit=limit), bend, elements=4)
        frequencies.append(bf.solve_modes(model, 2, bf.solve_static(model, steps=4)).frequencies)
    # a slight curvature raises no frequency of bending by more than its square
    assert frequencies[0] == pytest.approx(frequencies[1], rel=1e-3)


def restrained(elements, steps):
    """Return the mean axial force [N] of a bar whose ends keep their distance and direction while one is lifted."""
    lift = lambda b: [bf.Prescribed(b.end, ux=0.0, uy=lambda at: 0.1 * at, rotation=0.0)]  # noqa: E731
    beam, model = bar(square(5, hardening=2.1e9), supports=lift, elements=elements)
    bent = bf.solve_static(model, steps=steps)
    assert bent.at[-1] == 1.0
    work = bent.energy().dissipated
    assert np.all(np.diff(work) >= -1e-9 * work[-1])
    return bent.section_forces(beam).normal[-1].mean()


@pytest.mark.slow
@mostly_slow("steps", [1, 2, 5, 10], quick=(1,))
def test_a_restrained_bar_yields_under_displacement_control(steps):
    # 25692.9 N with 80 elements and 200 steps of fibre_beam.py; four elements resolve the hinges at the clamps coarsely
    assert restrained(4, steps) == pytest.approx(25692.9, rel=1e-2)


@pytest.mark.slow
def test_a_restrained_bar_against_an_independent_beam():
    coarse, fine = (axial_force(0.1, 50, elements) for elements in (20, 40))
    assert restrained(16, 1) == pytest.approx(fine + (fine - coarse) / 3, rel=2e-4)


@pytest.mark.parametrize("steps", [1, 7])
def test_short_steps_do_not_pass_a_limit_point(steps):
    """A shallow truss of two bars: it snaps at E A (h / l)^3 2 / (3 sqrt(3)), twice the vertical part of a bar."""
    rise, bars = 0.005, Plastic(**{**SECTION, "bending": 1.0}, limit=1e30, hardening=25.0)
    left, right = (
        bf.Beam(bf.Line(*ends), 4, bf.CRBF(order=3), bars) for ends in (((0, 0), (0.5, rise)), ((0.5, rise), (1, 0)))
    )
    limit = 1e6 * (rise / 0.5) ** 3 * 2 / (3 * math.sqrt(3))
    model = bf.Model(
        [left, right],
        [bf.Pin(left.start), bf.Pin(right.end)],
        [bf.PointForce(left.end, (0, -2 * limit))],
        joints=[bf.Hinge(left.end, right.start)],
    )
    with pytest.raises(bf.ConvergenceError, match="no load step") as caught:
        bf.solve_static(model, steps=steps)
    assert caught.value.solution.at[-1] == pytest.approx(0.5, rel=2e-4)
