"""Thick rings of Reissner's beam under pressure, whose equations Fourier series solve exactly.

A ring of radius R under a uniform pressure p towards its centre shrinks to R s, s = 1 + e, with the normal force
N = E A e = -p R s. About this state, along the arc length of the reference, with k = 1 / R and q = n / R, let

    u = a sin q x (along the axis), v = b cos q x (towards the centre), turn = c sin q x.

The deformed tangent changes by f cos q x along and g sin q x across the section of the state, f = q a - k b and
g = k a - q b. The strain energy has the second variation E A f^2 + G A (g - s c)^2 + E I q^2 c^2 + N (2 g c - s c^2),
and p times the enclosed area p (a g - b f) / 2.
"""

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq

import beamfem as bf

AXIAL, SHEAR, BENDING, MASS, ROTARY = 6.0e4, 2.0e4, 50.0, 2.0, 1.0e-3
RADIUS = 0.8


def stiffness(n, pressure):
    """Return the second variation [N/m], a quadratic form of a, b and c."""
    k, q = 1.0 / RADIUS, n / RADIUS
    normal = -pressure * RADIUS * AXIAL / (AXIAL + pressure * RADIUS)
    s = 1.0 + normal / AXIAL
    a, b, c = np.eye(3)
    f, g = q * a - k * b, k * a - q * b
    form = AXIAL * np.outer(f, f) + SHEAR * np.outer(g - s * c, g - s * c) + BENDING * q**2 * np.outer(c, c)
    form += normal * (np.outer(g, c) + np.outer(c, g) - s * np.outer(c, c))
    area = np.outer(a, g) - np.outer(b, f)
    return form + pressure * (area + area.T) / 2


def frequencies(n, pressure=0.0):
    return np.sqrt(eigh(stiffness(n, pressure), np.diag([MASS, MASS, ROTARY]))[0].clip(0.0)) / (2 * np.pi)


def ring(pressure, held=True):
    section = bf.Section.from_stiffness(AXIAL, SHEAR, BENDING, MASS, ROTARY)
    beam = bf.Beam(bf.Arc((0, 0), RADIUS, 0.0, 2 * np.pi), 16, bf.CRBF(5), section)
    supports = [bf.Roller(beam.at(0.0), (0, 1)), bf.Roller(beam.at(0.5), (0, 1)), bf.Roller(beam.at(0.25), (1, 0))]
    joints = [bf.Rigid(beam.start, beam.end)]
    return beam, bf.Model([beam], supports if held else [], [bf.Pressure(beam, pressure)], joints)


def test_a_thick_ring_buckles_below_three_times_its_stiffness():
    """The determinant for n = 2 vanishes at 2.973 EI / R^3, as the ring shrinks and shears."""
    thin = BENDING / RADIUS**3
    expected = brentq(lambda pressure: np.linalg.det(stiffness(2, pressure)), 2.5 * thin, 3.1 * thin)
    found = bf.solve_buckling(ring(1.0)[1], count=1).load_factors[0]
    assert found == pytest.approx(expected, rel=1e-7)
    assert found / thin == pytest.approx(2.973, abs=5e-4)


@pytest.mark.parametrize("pressure", [0.0, 250.0, -2000.0])
def test_a_thick_ring_under_pressure_vibrates_as_it_should(pressure):
    """Held at rest, let go for the modes: one of breathing, the others in pairs, raised by pressure inside."""
    beam, model = ring(pressure)
    state = bf.solve_static(model)
    shrunk = -pressure * RADIUS / (AXIAL + pressure * RADIUS)
    assert state.displacement(beam.start)[-1, 0] == pytest.approx(RADIUS * shrunk, rel=1e-8, abs=1e-15)
    assert state.section_forces(beam).normal[-1] == pytest.approx(AXIAL * shrunk, rel=1e-6, abs=1e-9)
    breathing = np.sqrt(stiffness(0, pressure)[1, 1] / MASS) / (2 * np.pi)
    pairs = [frequencies(n, pressure)[0] for n in (2, 3, 4, 5)]
    expected = np.sort([breathing, *pairs, *pairs])[:8]
    found = bf.solve_modes(ring(pressure, held=False)[1], count=11, about=state)
    assert found.frequencies[3:] == pytest.approx(expected, rel=1e-6)
