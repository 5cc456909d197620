"""Sections of fibres with the laws of the package, against closed forms and integrals by SciPy."""

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import beamfem as bf
from beamfem.testing import check_law

SIDE, MODULUS, YIELD = 0.01, 2e11, 2.5e8
SQUARE = bf.Rectangle(SIDE, SIDE)
SHAPES = [SQUARE, bf.Circle(0.01), bf.Tube(0.02, 0.001), bf.Tube(0.02, 0.004)]
PLASTIC = bf.ElasticPlastic(MODULUS, YIELD, poisson_ratio=0.3, density=7800.0)
HARDENING = bf.ElasticPlastic(MODULUS, YIELD, poisson_ratio=0.3, density=7800.0, hardening=2e10)
SMOOTH = bf.RambergOsgood(MODULUS, proof_stress=2.1e8, exponent=7, poisson_ratio=0.3, density=7900.0)
RELAXING = bf.Maxwell(2e9, branches=[(0.3, 0.01), (0.2, 1.0)], poisson_ratio=0.4, density=1150.0)
LAWS = [PLASTIC, HARDENING, SMOOTH, RELAXING]


@pytest.mark.parametrize("law", LAWS, ids=["plastic", "hardening", "smooth", "relaxing"])
@pytest.mark.parametrize("shape", SHAPES, ids=["square", "circle", "tube", "thick tube"])
def test_every_shape_and_law_is_consistent_and_has_the_stiffness_of_the_shape(shape, law):
    section = bf.Fibres(shape, law, points=12)
    check_law(section)
    stiffness = section.rigidity(None)
    expected = law.youngs_modulus * shape.area, law.youngs_modulus * shape.second_moment
    np.testing.assert_allclose((stiffness.axial, stiffness.bending), expected, rtol=1e-13)
    assert section.inertia(None) == shape.inertia(law.material)


def bent(section, moment, at, element=None, length=0.1):
    beam = bf.Beam(bf.Line((0, 0), (length, 0)), 2, element or bf.CRBF(order=3), section)
    amplitude = lambda t: float(np.interp(t, [0.0, 0.5, 1.0], [0.0, 1.0, 0.0]))  # noqa: E731
    load = bf.PointMoment(beam.end, moment, amplitude=amplitude)
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [load]), at=at)
    return solution, solution.rotation(beam.end) / length


def test_a_square_bends_beyond_yield_and_springs_back_as_in_the_closed_form():
    yield_moment, elastic = YIELD * SIDE**3 / 6, 2.0 * YIELD / MODULUS / SIDE
    under_load = elastic / np.sqrt(3.0 - 2.0 * 1.4)
    for points in (20, 80, 320):  # the stress has a kink between fibres: an error of second order
        curvature = bent(bf.Fibres(SQUARE, PLASTIC, points), 1.4 * yield_moment, [0.0, 0.25, 0.5, 1.0])[1]
        errors = np.abs(curvature[2:] - [under_load, under_load - 1.4 * elastic]) / under_load
        assert np.all(errors < (2.5 / points) ** 2)


@pytest.mark.slow
def test_the_work_of_a_cycle_of_loading_is_dissipated_or_stored_as_residual_stress():
    at = np.linspace(0.0, 1.0, 401)
    solution, curvature = bent(bf.Fibres(SQUARE, HARDENING, 20), 60.0, at)
    moment = 60.0 * np.interp(at, [0.0, 0.5, 1.0], [0.0, 1.0, 0.0])
    work = np.trapezoid(moment, curvature) * 0.1
    energy = solution.energy()
    assert energy.dissipated[-1] > 0.5 * work
    np.testing.assert_allclose(energy.strain[-1] + energy.dissipated[-1], work, rtol=1e-4)


@pytest.mark.parametrize("shape", [SQUARE, bf.Tube(0.02, 0.004)], ids=["square", "tube"])
def test_a_smooth_law_bends_by_the_integral_of_its_stress(shape):
    def stress(strain):
        excess = lambda s: s / MODULUS + 0.002 * (s / 2.1e8) ** 7 - abs(strain)  # noqa: E731
        return np.sign(strain) * brentq(excess, 0.0, abs(strain) * MODULUS, xtol=1e-3, rtol=1e-14)

    outline, curvature = shape.outline, 1.2
    kinks = [outline.inner] if hasattr(outline, "inner") else None
    moment = (
        2.0
        * quad(
            lambda y: y * outline.width(y) * stress(curvature * y),
            0.0,
            outline.high,
            points=kinks,
            epsrel=1e-11,
            limit=200,
        )[0]
    )
    found = bent(bf.Fibres(shape, SMOOTH, 80), moment, [0.0, 0.25, 0.5])[1][-1]
    np.testing.assert_allclose(found, curvature, rtol=1e-4)


def test_energy_per_volume_of_a_smooth_law_is_the_area_under_its_curve():
    strain = np.array([[-0.004, 1e-7, 0.002, 0.03]])
    area = [quad(lambda e: float(SMOOTH.stress(np.array([e]))[0]), 0.0, end, epsrel=1e-12)[0] for end in strain[0]]
    np.testing.assert_allclose(SMOOTH.energy(strain)[0], area, rtol=1e-9)


def test_relaxation_does_not_depend_on_the_steps_of_a_ramp():
    history, one = np.zeros((1, 1, 4)), np.array([[0.01]])
    at_once = RELAXING.remember(one, history, 0.5)
    for part in np.linspace(0.1, 1.0, 10):
        history = RELAXING.remember(part * one, history, 0.05)
    np.testing.assert_allclose(history, at_once, rtol=1e-12)


def test_a_pulled_rod_relaxes_by_its_prony_series():
    """Pulled within 0.1 s and held: the force of each branch of the closed form, with a rod too light to vibrate."""
    law = bf.Maxwell(2e9, branches=[(0.3, 0.05), (0.2, 0.5)], poisson_ratio=0.4, density=1e-3)
    rod = bf.Beam(bf.Line((0, 0), (1, 0)), 1, bf.CRBF(order=2), bf.Fibres(SQUARE, law, 4))
    pulled = lambda t: 0.001 * float(np.clip(t / 0.1, 0.0, 1.0))  # noqa: E731
    supports = [bf.Clamp(rod.start), bf.Prescribed(rod.end, ux=pulled, uy=0.0, rotation=0.0)]
    motion = bf.simulate(bf.Model([rod], supports), duration=1.0, step=0.01)
    stress = 2e9 * 0.001 * 0.5
    for share, time in law.branches:
        stress += 2e9 * 0.001 * share * time / 0.1 * (np.exp(0.1 / time) - 1.0) * np.exp(-1.0 / time)
    np.testing.assert_allclose(motion.reaction(rod.end)[-1, 0], stress * SIDE**2, rtol=1e-6)


@pytest.mark.parametrize("law", LAWS, ids=["plastic", "hardening", "smooth", "relaxing"])
def test_saved_with_its_law(tmp_path, law):
    solution = bent(bf.Fibres(SQUARE, law, 8), 45.0, [0.0, 0.25, 0.5])[0]
    solution.save(tmp_path / "bent.h5")
    back = bf.load(tmp_path / "bent.h5")
    assert back.model.beams[0].section == solution.model.beams[0].section
    np.testing.assert_array_equal(back.p, solution.p)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: bf.Fibres(bf.Section(1e-4, 1e-9), PLASTIC), "must be a Rectangle, Circle, Tube"),
        (lambda: bf.Fibres(SQUARE, bf.Material(2e11, 0.3, 7800.0)), "law of Fibres must be a law"),
        (lambda: bf.Fibres(SQUARE, PLASTIC, points=1), "points of Fibres must be between 2 and"),
        (
            lambda: bf.ElasticPlastic(2e11, -1.0, 0.3, 7800.0),
            "yield_stress of ElasticPlastic must be greater",
        ),
        (lambda: bf.RambergOsgood(2e11, 2e8, 0.5, 0.3, 7800.0), "exponent of RambergOsgood must be at least 1"),
        (lambda: bf.Maxwell(2e9, [(0.7, 1.0), (0.5, 2.0)], 0.4, 1.0), "shares that sum to 1 at most, got 1.2"),
        (lambda: bf.Maxwell(2e9, [0.7, 1.0], 0.4, 1.0), "branch of Maxwell"),
    ],
)
def test_refused_with_a_reason(make, message):
    with pytest.raises(bf.InputError, match=message):
        make()
