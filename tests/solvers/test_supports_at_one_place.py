"""Reactions where a spring stands beside a prescribed motion, of inclined rollers, of springs stiffer than digits."""

import numpy as np
import pytest

import beamfem as bf

STEEL, SECTION = bf.Material(2e11, 0.3, 7800.0), bf.Rectangle(0.1, 0.1)
AXIAL, BENDING = 2e11 * 0.1**2, 2e11 * 0.1**4 / 12
SHEAR = 5 / 6 * 2e11 / 2.6 * 0.1**2


def test_a_spring_where_a_motion_is_prescribed_is_part_of_the_reaction():
    """A bar stretched by 1e-5: its end is pulled by E A 1e-5 in all, whatever the spring there takes back."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), SECTION, STEEL)
    supports = [bf.Clamp(beam.start), bf.Prescribed(beam.end, ux=1e-5), bf.Spring(beam.end, (3e8, 0.0))]
    solution = bf.solve_static(bf.Model([beam], supports))
    assert solution.reaction(beam.end)[-1, 0] == pytest.approx(AXIAL * 1e-5, rel=1e-4)
    assert solution.reaction(beam.start)[-1, 0] == pytest.approx(-AXIAL * 1e-5, rel=1e-4)


@pytest.mark.parametrize("angle", [0.3, 1.2, 2.5])
def test_an_inclined_roller_pushes_along_its_normal(angle):
    """A pinned beam with a force across its middle: moments about the pin give half of it across, at the roller."""
    normal = np.array([np.cos(angle), np.sin(angle)])
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), SECTION, STEEL)
    supports = [bf.Pin(beam.start), bf.Roller(beam.end, tuple(normal))]
    solution = bf.solve_static(bf.Model([beam], supports, [bf.PointForce(beam.at(0.5), (0.0, -10.0))]))
    pushed = solution.reaction(beam.end)[-1, :2]
    np.testing.assert_allclose(pushed, 5.0 / normal[1] * normal, rtol=1e-5)
    np.testing.assert_allclose(solution.reaction(beam.start)[-1, :2], [-pushed[0], 10.0 - pushed[1]], atol=1e-6)


def test_a_spring_whose_travel_is_below_the_last_digit_still_carries():
    """A prop of 1e18 N/m under a cantilever at height 1: it gives by 3e-18 and carries 5/16 F, less for shear."""
    beam = bf.Beam(bf.Line((0, 1), (1, 1)), 2, bf.CRBF(3), SECTION, STEEL)
    supports = [bf.Clamp(beam.start), bf.Spring(beam.end, (0.0, 1e18))]
    solution = bf.solve_static(bf.Model([beam], supports, [bf.PointForce(beam.at(0.5), (0.0, -10.0))]))
    carried = 10.0 * (5 / (48 * BENDING) + 0.5 / SHEAR) / (1 / (3 * BENDING) + 1 / SHEAR)
    assert solution.reaction(beam.end)[-1, 1] == pytest.approx(carried, rel=1e-5)
