"""Supports that are moved far along the path of a beam so slender that any strain is large beside what bends it."""

import numpy as np
import pytest

import beamfem as bf
from beamfem.equations.equations import STATICS, linearise, load_change
from beamfem.equations.system import system_of


def _strip(slenderness, element, unit=1.0):
    section = bf.Rectangle(unit / slenderness, unit / slenderness)
    beam = bf.Beam(bf.Line((0, 0), (unit, 0)), 6, element, section, bf.Material(2e11 / unit**2, 0.3, 7800.0))
    return beam, [bf.Clamp(beam.start)], bf.Prescribed(beam.end, ux=-0.05 * unit, uy=0.1 * unit)


@pytest.mark.parametrize("width", [1e-6, 1e-3, 1.0])
@pytest.mark.parametrize("slenderness", [1e2, 1e4])
@pytest.mark.parametrize("element", [bf.ANCF(), bf.CRBF(3)], ids=["ANCF", "CRBF(3)"])
def test_the_slope_of_a_prescribed_motion_is_that_of_the_tangent(element, slenderness, width):
    """Whatever the width at which loads are compared: the tangent of the beam without the motion tells it."""
    beam, clamp, moved = _strip(slenderness, element)
    free, held = system_of(bf.Model([beam], clamp), True), system_of(bf.Model([beam], [*clamp, moved]), True)
    p, zeros = free.reference.copy(), np.zeros(len(free.reference))
    p[held.free_dofs] += 1e-3 / slenderness * np.random.default_rng(1).standard_normal(len(held.free_dofs))
    rate = np.zeros(len(p))
    rate[held.prescribed_dofs] = held.prescribed_values(1.0) - held.prescribed_values(0.0)
    none = np.empty(0, dtype=np.int64), np.empty((0, 2))
    tangent = linearise(free, p, zeros, zeros, 0.0, STATICS)[1].sparse(none)
    expected = np.zeros(len(p))
    expected[free.free_dofs] = tangent @ rate[free.free_dofs]
    found = load_change(held, p, -width, width)[held.free_dofs] / (2.0 * width)
    assert found == pytest.approx(expected[held.free_dofs], abs=1e-8 * np.abs(expected).max())


@pytest.mark.parametrize("unit", [1.0, 1e-6])
def test_a_strip_that_is_shortened_and_led_aside_is_followed_to_the_end(unit):
    beam, clamp, moved = _strip(1e3, bf.ANCF(), unit)
    model = bf.Model([beam], [*clamp, moved])
    path = bf.trace_equilibrium(model, until=1.0, points=150)
    assert path.load_factor[-1] == 1.0
    assert path.position(beam.end)[-1] == pytest.approx([0.95 * unit, 0.1 * unit], abs=1e-12 * unit)
    solution = bf.solve_static(model)
    assert solution.reaction(beam.end)[-1] == pytest.approx(path.reaction(beam.end)[-1], rel=1e-6, abs=1e-9)
