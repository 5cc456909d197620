"""Layers in motion: section forces and energies of mass off the axis, and the stress of stretch and heat."""

import numpy as np
import pytest

import beamfem as bf

STEEL, LIGHT = bf.Material(2e11, 0.3, 7800.0), bf.Material(7e10, 0.3, 500.0)
LAYERS = bf.Layered([bf.Layer(STEEL, 0.1), bf.Layer(LIGHT, 0.2)], 0.1, axis=0.2)
# integrals of the density, of density times y and times y^2; the layers are from y = -0.2 to -0.1 and to 0.1
MASS = 0.1 * (7800.0 * 0.1 + 500.0 * 0.2)
FIRST = 0.1 * (7800.0 * (0.1**2 - 0.2**2) / 2)
ROTARY = 0.1 * (7800.0 * (0.2**3 - 0.1**3) / 3 + 500.0 * 2 * 0.1**3 / 3)


@pytest.mark.parametrize("element", [bf.CRBF(3), bf.ANCF(bf.Structural())], ids=lambda element: element.name)
def test_section_forces_of_a_driven_bar_are_those_of_a_rigid_one(element):
    """A stiff bar turned by sin(5 t)^4, much slower than it vibrates and without a jump at the start.

    The part beyond a cut at s turns with alpha and omega about the start, its points at (x, y) accelerate by
    (-alpha y - omega^2 x, alpha x - omega^2 y): force and moment about the axis of the cut follow by integration.
    """
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, element, LAYERS)
    held = bf.Prescribed(beam.start, ux=0.0, uy=0.0, rotation=lambda t: np.sin(5.0 * t) ** 4)
    motion = bf.simulate(bf.Model([beam], [held]), duration=0.14, step=1e-3)
    found = motion.section_forces(beam)
    t, s = motion.time[-1], found.arc_length
    si, co = np.sin(5.0 * t), np.cos(5.0 * t)
    omega, alpha = 20.0 * si**3 * co, 100.0 * si**2 * (3.0 * co**2 - si**2)
    rest, half = 1.0 - s, 0.5 * (1.0 - s**2)
    normal = alpha * FIRST * rest + omega**2 * MASS * half
    shear = omega**2 * FIRST * rest - alpha * MASS * half
    third = (1.0 - s**3) / 3 - s * half  # integral of (x - s) x
    moment = -(
        alpha * MASS * third - omega**2 * FIRST * 0.5 * rest**2 + alpha * ROTARY * rest + omega**2 * FIRST * half
    )
    for values, expected in ((found.normal, normal), (found.shear, shear), (found.moment, moment)):
        np.testing.assert_allclose(values[-1], expected, atol=2e-3 * np.abs(expected).max())


def test_the_potential_of_weight_off_the_axis_is_zero_in_the_reference():
    """A rigid bar that turns by a quarter: its centre is at 0.5 along and FIRST / MASS above the axis."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), LAYERS)
    angle = 0.5 * np.pi
    held = bf.Prescribed(beam.start, ux=0.0, uy=0.0, rotation=angle)
    solution = bf.solve_static(bf.Model([beam], [held], [bf.Gravity((0.0, -1e-3), scale=False)]), steps=4)
    turned = solution.rotation(beam.start)
    height = 0.5 * np.sin(turned) + FIRST / MASS * (np.cos(turned) - 1.0)
    np.testing.assert_allclose(solution.energy().potential, 1e-3 * MASS * height, atol=1e-9)


def test_a_moment_has_its_potential_whether_it_follows_or_not():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), bf.Rectangle(0.02, 0.02), STEEL)
    for follower in (False, True):
        load = bf.PointMoment(beam.end, 500.0, follower=follower)
        solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [load]))
        expected = -500.0 * solution.load_factor * solution.rotation(beam.end)
        np.testing.assert_allclose(solution.energy().potential, expected, rtol=1e-12)


def test_loads_that_follow_have_no_potential():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(3), bf.Rectangle(0.02, 0.02), STEEL)
    for load in (
        bf.DistributedLoad(beam, (0.0, 500.0), follower=True),
        bf.Pressure(beam, 500.0),
        bf.PointForce(beam.end, (0.0, 500.0), follower=True),
    ):
        solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [load]))
        assert solution.energy().strain[-1] > 1.0
        assert not solution.energy().potential.any()


def test_stress_of_layers_that_are_stretched_and_heated_in_time():
    """A strip between clamps takes its strain from them: sigma = E (eps + tau eps' - alpha (T + T' y)) in each layer.

    The viscous part resists the whole strain, also that which heat would cause freely.
    """
    tau, width, thick = 0.05, 0.02, 0.01
    moduli, expansion = np.array([2e9, 5e8]), np.array([2e-4, 6e-4])
    materials = [
        bf.Material(modulus, 0.3, 1.0, retardation_time=tau, thermal_expansion=alpha)
        for modulus, alpha in zip(moduli, expansion, strict=True)
    ]
    section = bf.Layered([bf.Layer(material, thick) for material in materials], width)
    strip = bf.Beam(bf.Line((0, 0), (0, 1)), 2, bf.CRBF(2), section)
    stretch = bf.Prescribed(strip.end, ux=0.0, uy=lambda t: 1e-3 * np.sin(3 * t) ** 4, rotation=0.0)
    heat = bf.Temperature(strip, change=5.0, gradient=100.0, amplitude=lambda t: np.sin(2 * t) ** 4)
    motion = bf.simulate(bf.Model([strip], [bf.Clamp(strip.start), stretch], [heat]), duration=0.7, step=2e-3)
    t = motion.time[-1]
    strain, rate = 1e-3 * np.sin(3 * t) ** 4, 1e-3 * 12 * np.sin(3 * t) ** 3 * np.cos(3 * t)

    def stress(layer, y):
        free = expansion[layer] * np.sin(2 * t) ** 4 * (5.0 + 100.0 * y)
        return moduli[layer] * (strain + tau * rate - free)

    found = motion.stresses(strip)
    assert found.lower[-1] == pytest.approx(stress(0, -thick), rel=2e-5)
    assert found.upper[-1] == pytest.approx(stress(1, thick), rel=2e-5)
    middles = [stress(0, -thick / 2), stress(1, thick / 2)]
    assert motion.reaction(strip.end)[-1, 1] == pytest.approx(width * thick * sum(middles), rel=2e-5)
    # in each layer the stress is linear, so its moment is that of its mean and of its slope
    slopes = -moduli * expansion * np.sin(2 * t) ** 4 * 100.0
    moment = -width * (thick**2 / 2 * (middles[1] - middles[0]) + thick**3 / 12 * slopes.sum())
    assert motion.section_forces(strip).moment[-1] == pytest.approx(moment, rel=2e-5)
