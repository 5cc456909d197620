"""Linear buckling, K0 phi = -lambda K_sigma phi, against frame elements programmed here and closed forms."""

from itertools import pairwise

import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.optimize import brentq
from slow_values import mostly_slow

import beamfem as bf

_PARTS = 8  # elements of a bar in the reference


def bar(start, end, extension, bending, shear, elements=8, element=None):
    """A beam with given E A, E I and k G A."""
    section = bf.Section(area=1.0, second_moment=bending / extension, shear_factor=2.0 * shear / extension)
    curve, material = bf.Line(tuple(start), tuple(end)), bf.Material(extension, 0.0, 1.0)
    return bf.Beam(curve, elements, element or bf.CRBF(3), section, material)


def frame(points, loads, extension, bending, shear, clamped=False, elements=8, element=None):
    """Bars in a chain, rigidly joined, on two supports, with forces at the inner corners."""
    bars = [bar(a, b, extension, bending, shear, elements, element) for a, b in pairwise(points)]
    support = bf.Clamp if clamped else bf.Pin
    supports = [support(bars[0].start), support(bars[-1].end)]
    joints = [bf.Rigid(a.end, b.start) for a, b in pairwise(bars)]
    forces = [bf.PointForce(one.end, tuple(load)) for one, load in zip(bars, loads, strict=False)]
    return bf.Model(bars, supports, forces, joints)


def euler_bernoulli(points, loads, extension, bending, clamped):
    """Lowest load factor of the same frame, of Euler-Bernoulli elements with consistent geometric stiffness."""
    n = _PARTS * (len(points) - 1) + 1
    elastic, geometric, force = np.zeros((3 * n, 3 * n)), np.zeros((3 * n, 3 * n)), np.zeros(3 * n)
    parts = []
    for number, (start, end) in enumerate(pairwise(np.asarray(points, dtype=float))):
        length = np.hypot(*(end - start)) / _PARTS
        c, s = (end - start) / (_PARTS * length)
        turn = np.kron(np.eye(2), [[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]])
        k = np.zeros((6, 6))
        k[np.ix_([0, 3], [0, 3])] = extension / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
        a, b, d = 12.0, 6.0 * length, length**2
        cubic = np.array([[a, b, -a, b], [b, 4 * d, -b, 2 * d], [-a, -b, a, -b], [b, 2 * d, -b, 4 * d]])
        k[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])] = bending / length**3 * cubic
        e = 3.0 * length
        slope = np.array([[36, e, -36, e], [e, 4 * d, -e, -d], [-36, -e, 36, -e], [e, -d, -e, 4 * d]]) / (30.0 * length)
        for part in range(_PARTS):
            first = 3 * (number * _PARTS + part)
            own = slice(first, first + 6)
            elastic[own, own] += turn.T @ k @ turn
            parts.append((own, turn, length, slope))
    for number, load in enumerate(loads, start=1):
        force[3 * number * _PARTS : 3 * number * _PARTS + 2] += load
    fixed = [0, 1, 3 * n - 3, 3 * n - 2] + ([2, 3 * n - 1] if clamped else [])
    free = np.setdiff1d(np.arange(3 * n), fixed)
    moved = np.zeros(3 * n)
    moved[free] = np.linalg.solve(elastic[np.ix_(free, free)], force[free])
    for own, turn, length, slope in parts:
        local = turn @ moved[own]
        k = np.zeros((6, 6))
        k[np.ix_([1, 2, 4, 5], [1, 2, 4, 5])] = extension * (local[3] - local[0]) / length * slope
        geometric[own, own] += turn.T @ k @ turn
    rates = eigh(-geometric[np.ix_(free, free)], elastic[np.ix_(free, free)], eigvals_only=True)
    return 1.0 / rates[-1]


def random_frame(seed):
    """Points, pressing loads, E A, E I, G A >= E A and whether it is clamped, of a slender frame of 2 or 3 bars."""
    rng = np.random.default_rng(seed)
    height, width, lean = rng.uniform(2.0, 6.0, 3) * (1.0, 1.0, 0.2)
    corners = [(0.0, 0.0), (lean, height), (lean + width, height * rng.uniform(0.8, 1.2))]
    points = corners + ([(width + 2.0 * lean, rng.uniform(-0.5, 0.5))] if rng.uniform() < 0.6 else [])
    loads = [(0.1 * rng.uniform(-1.0, 1.0), -rng.uniform(0.2, 1.0)) for _ in points[1:-1]]
    extension = 10.0 ** rng.uniform(6.0, 9.0)
    bending = extension * 10.0 ** rng.uniform(-5.5, -4.0)
    return points, loads, extension, bending, extension * 10.0 ** rng.uniform(0.0, 4.0), bool(rng.uniform() < 0.5)


def compare(seed):
    points, loads, extension, bending, shear, clamped = random_frame(seed)
    found = bf.solve_buckling(frame(points, loads, extension, bending, shear, clamped)).linearised
    assert found[0] == pytest.approx(euler_bernoulli(points, loads, extension, bending, clamped), rel=5e-3), seed


@pytest.mark.parametrize("seed", range(4))
def test_random_frames_have_the_linear_buckling_load_of_euler_bernoulli_elements(seed):
    compare(seed)


@pytest.mark.slow
def test_300_random_frames_have_the_linear_buckling_load_of_euler_bernoulli_elements():
    for seed in range(300):
        compare(seed)


@pytest.mark.slow
@mostly_slow(("seed", "element", "other"), [(72, bf.CRBF(4), bf.CRBF(5)), (228, bf.CRBF(2), bf.CRBF(3))])
def test_limit_points_of_knee_frames_are_found_where_round_off_exceeds_the_softest_stiffness(seed, element, other):
    """k G A L^2 / E I is 2e10 to 1e11; the loading path was lost beside its limit point, or passed it unseen."""
    points, loads, extension, bending, shear, clamped = random_frame(seed)
    found = [
        bf.solve_buckling(frame(points, loads, extension, bending, shear, clamped, element=each))
        for each in (element, other)
    ]
    assert [each.kinds for each in found] == [("limit point",)] * 2
    assert found[0].load_factors[0] == pytest.approx(found[1].load_factors[0], rel=5e-4)


@pytest.mark.parametrize("extension", [1e4, 1e6, 1e8])
def test_a_shear_rigid_column_has_eulers_linear_load(extension):
    """612.5 at E A = 1e6 and 9.88 at 1e4, because terms G A / E A were part of the geometric stiffness."""
    beam = bar((0, 0), (1, 0), extension, 100.0, 1e9, 10)
    supports = [bf.Pin(beam.start), bf.Roller(beam.end, (0, 1))]
    found = bf.solve_buckling(bf.Model([beam], supports, [bf.PointForce(beam.end, (-1.0, 0.0))]))
    assert found.linearised == pytest.approx([100.0 * np.pi**2], rel=2e-6)


@pytest.mark.parametrize("extension", [15000.0, 150000.0, 1.5e7])
def test_a_hinged_portal_has_its_linear_load_at_any_stiffness_of_extension(extension):
    """1.05 and 7.76 were found for the first two."""
    points, loads = [(0, 0), (0, 5), (5, 5), (5, 0)], [(0.0, -25.0)] * 2
    found = bf.solve_buckling(frame(points, loads, extension, 5000.0, 1e8))
    assert found.linearised == pytest.approx([euler_bernoulli(points, loads, extension, 5000.0, False)], rel=2e-4)


def test_an_l_frame_has_its_linear_load():
    """15114 for 17359."""
    points, loads = [(0, 0), (0, 4), (4, 4)], [(0.0, -1.0)]
    found = bf.solve_buckling(frame(points, loads, 1e7, 2e4, 1e9))
    assert found.linearised == pytest.approx([euler_bernoulli(points, loads, 1e7, 2e4, False)], rel=5e-4)


@pytest.mark.parametrize("ratio", [2.0, 5.0, 30.0])
@pytest.mark.parametrize(
    ("element", "engesser"),
    [(bf.CRBF(3), False), (bf.CRBF(3, forces=bf.SplitContinuum()), True)],
    ids=["structural", "split continuum"],
)
def test_timoshenko_columns_have_haringx_or_engessers_load(ratio, element, engesser):
    """Strains along the normal of the section: P (1 + P / GA) = P_E; along the axis: P (1 + P_E / GA) = P_E."""
    bending, euler = 100.0, 100.0 * np.pi**2
    shear = ratio * euler
    beam = bar((0, 0), (1, 0), 1e9, bending, shear, 12, element)
    supports = [bf.Pin(beam.start), bf.Roller(beam.end, (0, 1))]
    found = bf.solve_buckling(bf.Model([beam], supports, [bf.PointForce(beam.end, (-1.0, 0.0))]))
    haringx = 0.5 * shear * (np.sqrt(1.0 + 4.0 * euler / shear) - 1.0)
    assert found.linearised == pytest.approx([euler / (1.0 + euler / shear) if engesser else haringx], rel=1e-4)


@pytest.mark.parametrize("slenderness", [3333, 1e4, 1e5])
def test_slender_portals_sway_at_the_load_of_thick_ones(slenderness):
    """Nothing was found: "no further than 300 times the linearised load factors", which were 4e-4 of the right ones."""
    section, steel = bf.Rectangle(0.02, 1.0 / slenderness), bf.Material(2e11, 0.3, 7800.0)
    bending = 2e11 * section.second_moment
    bars = [
        bf.Beam(bf.Line(a, b), 4, bf.CRBF(3), section, steel) for a, b in pairwise([(0, 0), (0, 1), (1, 1), (1, 0)])
    ]
    joints = [bf.Rigid(a.end, b.start) for a, b in pairwise(bars)]
    loads = [bf.PointForce(bars[1].at(0.5), (0.0, -bending))]
    found = bf.solve_buckling(bf.Model(bars, [bf.Pin(bars[0].start), bf.Pin(bars[2].end)], loads, joints))
    assert found.load_factors == pytest.approx([3.4917], abs=1e-4)
    # kL tan kL = 6 of loads on the columns; the thrust in the beam lowers it
    by_hand = 2.0 * brentq(lambda u: u * np.tan(u) - 6.0, 1.2, 1.5) ** 2
    assert found.linearised == pytest.approx([by_hand], rel=2e-3)


_TABLE, _FLAT = bf.Interpolated([(0, 0), (1, 100)]), bf.Interpolated([(0, 0), (0.5, 0), (1, 100)])


@pytest.mark.parametrize(
    ("amplitude", "inverse", "slope"),
    [
        (None, lambda x: x, 1.0),
        (_TABLE, lambda x: x / 100.0, 100.0),
        (lambda t: 10.0 * (t + t**3), lambda x: brentq(lambda t: 10.0 * (t + t**3) - x, 0.0, 10.0), 10.0),
        (lambda t: 10.0 * (np.exp(t) - 1.0), lambda x: np.log(1.0 + 0.1 * x), 10.0),
        (lambda t: 10.0 * t**2, lambda x: np.sqrt(0.1 * x), 0.0),
        (_FLAT, lambda x: 0.5 + x / 200.0, 0.0),
    ],
    ids=["none", "table", "cubic", "exponential", "square", "flat"],
)
def test_a_clamped_heated_bar_buckles_with_any_amplitude(amplitude, inverse, slope):
    """Nothing moves before, and amplitudes were evaluated at 1e13 to 1e17."""
    warm, section = bf.Material(2e11, 0.3, 7800.0, thermal_expansion=1.2e-5), bf.Rectangle(0.01, 0.01)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 10, bf.CRBF(3), section, warm)
    heat = bf.Temperature(beam, 1.0, amplitude=amplitude)
    found = bf.solve_buckling(bf.Model([beam], [bf.Clamp(beam.start), bf.Clamp(beam.end)], [heat]))
    strain = 4.0 * np.pi**2 * section.second_moment / section.area
    kelvin = strain / (1.0 + strain * 2.6 * 1.2) / 1.2e-5
    assert found.load_factors == pytest.approx([inverse(kelvin)], rel=1e-4)
    assert found.linearised == pytest.approx([kelvin / slope] if slope else [], rel=1e-4)


@pytest.mark.parametrize(
    "amplitude",
    [lambda t: t**2, lambda t: max(0.0, t - 0.5), lambda t: max(0.0, t - 1.0)],
    ids=["square", "flat", "flat to 1"],
)
def test_a_force_whose_amplitude_is_flat_at_the_start_buckles_a_column(amplitude):
    """It was refused: no load grows with the load factor."""
    beam = bar((0, 0), (1, 0), 1e6, 1.0, 1e6)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (-1.0, 0.0), amplitude=amplitude)])
    found = bf.solve_buckling(model)
    assert amplitude(float(found.load_factors[0])) == pytest.approx(0.25 * np.pi**2, rel=1e-5)
    assert len(found.linearised) == 0
