"""Columns beyond buckling, and under a force that follows."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

import beamfem as bf


def test_a_hinged_column_buckles_along_the_elastica_and_shortens():
    """P L^2 / EI = 4 K(k)^2, k = sin(end angle / 2); the ends approach by 2 (1 - E(k) / K(k)) L."""
    section = bf.Section.from_stiffness(1e8, 1e8, 1.0, 1.0, 1.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 12, bf.CRBF(4), section)
    model = bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end)], [bf.PointForce(beam.end, (-1.0, 0.0))])
    path = bf.trace_equilibrium(model, 11.0)
    assert path.bifurcations[0].load_factor == pytest.approx(np.pi**2, rel=1e-6)
    branch = bf.trace_equilibrium(
        model, lambda state: abs(state.rotation(beam.start)) > 2.2, start=path.bifurcations[0]
    )
    angle = branch.rotation(beam.start)[1:]
    assert branch.load_factor[1:] == pytest.approx(4 * ellipk(np.sin(angle / 2) ** 2) ** 2, rel=2e-6)
    closer = 2 * (1 - ellipe(np.sin(angle / 2) ** 2) / ellipk(np.sin(angle / 2) ** 2))
    assert -branch.displacement(beam.end)[1:, 0] == pytest.approx(closer, abs=1e-6)
    assert closer[-1] > 0.9


def beck(load, slenderness):
    section = bf.Rectangle(1.0, 1.0 / slenderness)
    stiffness = 1.0 / section.second_moment
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(4), section, bf.Material(stiffness, 0.3, slenderness))
    force = bf.PointForce(beam.end, (-load, 0.0), follower=True)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [force])
    return bf.solve_modes(model, 3, about=bf.solve_static(model))


def beck_exactly():
    """Load and frequency at which the lowest two frequencies of Beck's column meet; Euler and Bernoulli's beam.

    P^2 + 2 w^2 + P w sinh a sin b + 2 w^2 cosh a cos b = 0 with a^2, b^2 = sqrt(P^2 / 4 + w^2) -+ P / 2.
    """

    def equation(p, w):
        root = np.sqrt(p**2 / 4 + w**2)
        a, b = np.sqrt(root - p / 2), np.sqrt(root + p / 2)
        return p**2 + 2 * w**2 + p * w * np.sinh(a) * np.sin(b) + 2 * w**2 * np.cosh(a) * np.cos(b)

    def meet(p):
        """Frequency between the two, where the equation is level."""
        return brentq(lambda w: equation(p, w + 1e-4) - equation(p, w - 1e-4), 9.0, 13.0, xtol=1e-12)

    load = brentq(lambda p: equation(p, meet(p)), 19.0, 21.0, xtol=1e-12)
    return load, meet(load)


def test_becks_column_flutters_at_the_load_where_its_frequencies_meet():
    """Beck 1952 prints 20.05 EI / L^2; a slender beam, so that shear and rotary inertia change some 1e-6 of it."""
    exact, frequency = beck_exactly()
    assert round(exact, 2) == 20.05
    before, after = beck(0.9999 * exact, 2000), beck(1.0001 * exact, 2000)
    assert np.all(before.growth == 0.0)
    assert after.growth[:2] == pytest.approx([after.growth[0], -after.growth[0]])
    assert after.growth[0] > 0.05
    assert 2 * np.pi * after.frequencies[:2] == pytest.approx(frequency, rel=5e-5)  # the load is 1e-4 above
    # growth^2 rises in proportion to the load above the critical one; what is left is of second order
    squares = [beck(share * exact, 2000).growth[0] ** 2 for share in (1.001, 1.002)]
    assert (2 * squares[0] - squares[1]) / squares[0] == pytest.approx(0.0, abs=2.5e-3)
