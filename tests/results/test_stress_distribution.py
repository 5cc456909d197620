"""How sections distribute N, V and M: closed forms, and resultants by quadrature over the true shape."""

import numpy as np
import pytest
from scipy.integrate import quad

import beamfem as bf
from beamfem.section.distribution import distribution

STEEL = bf.Material(2.1e11, 0.3, 7850.0)
RUBBER = bf.Material(1e6, 0.49, 1000.0)


def faces(section, moment, normal=0.0, curvature=0.0):
    found = distribution(section, STEEL, curvature)
    low, high = found.layers[0][0], found.layers[-1][1]
    return [
        float(found.normal_stress(layer, y, normal, moment)) for layer, y in ((0, low), (len(found.layers) - 1, high))
    ]


@pytest.mark.parametrize(
    ("section", "second_moment", "reach"),
    [
        (bf.Rectangle(0.01, 0.02), 0.01 * 0.02**3 / 12, 0.01),
        (bf.Circle(0.02), np.pi * 0.02**4 / 64, 0.01),
        (bf.Tube(0.02, 0.001), np.pi * (0.02**4 - 0.018**4) / 64, 0.01),
        (bf.Section(28.5e-4, 1943e-8, height=0.2), 1943e-8, 0.1),
    ],
    ids=["rectangle", "circle", "tube", "IPE 200"],
)
def test_bending_stress_at_the_faces_is_that_of_the_true_height(section, second_moment, reach):
    expected = 20.0 * reach / second_moment
    assert faces(section, 20.0) == pytest.approx([expected, -expected], rel=1e-12)
    axial = 300.0 / section.area
    assert faces(section, 20.0, 300.0) == pytest.approx([axial + expected, axial - expected], rel=1e-12)


def test_a_circle_and_a_tube_under_20_newton_metres():
    """25.46 MPa = 32 M / (pi d^3), and 74.05 MPa of the tube, not those of rectangles of the same A and I."""
    assert faces(bf.Circle(0.02), 20.0)[0] == pytest.approx(25.4648e6, rel=1e-6)
    assert faces(bf.Tube(0.02, 0.001), 20.0)[0] == pytest.approx(74.0471e6, rel=1e-6)


def test_a_centroid_off_mid_height_has_two_section_moduli():
    """A tee: flange 100 x 10 mm over a web 10 x 90 mm, its parallel-axis moments by hand."""
    flange, web = 0.1 * 0.01, 0.01 * 0.09
    centroid = (flange * 0.095 + web * 0.045) / (flange + web)
    second = 0.1 * 0.01**3 / 12 + flange * (0.095 - centroid) ** 2 + 0.01 * 0.09**3 / 12 + web * (0.045 - centroid) ** 2
    tee = bf.Section(flange + web, second, height=0.1, centroid=centroid)
    assert tee.bounds == pytest.approx((-centroid, 0.1 - centroid))
    assert faces(tee, 50.0) == pytest.approx([50.0 * centroid / second, -50.0 * (0.1 - centroid) / second], rel=1e-12)


def test_winkler_distribution_of_a_thick_arc():
    """R = 0.1, h = 0.05 under pure moment: R. Winkler with the neutral radius h / ln(ro / ri)."""
    radius, height, width, moment = 0.1, 0.05, 0.01, 50.0
    inner, outer = radius - 0.5 * height, radius + 0.5 * height
    neutral = height / np.log(outer / inner)

    def winkler(r):
        return moment * (r - neutral) / (width * height * (radius - neutral) * r)

    # +y towards the centre where the curvature is positive: a moment > 0 compresses the inner face
    below, above = faces(bf.Rectangle(width, height), moment, curvature=1.0 / radius)
    assert (below, above) == pytest.approx((winkler(outer), winkler(inner)), rel=1e-12)
    assert (below / 12e6, above / 12e6) == pytest.approx((0.8531, -1.1996), rel=1e-4)
    mirrored = faces(bf.Rectangle(width, height), moment, curvature=-1.0 / radius)
    assert mirrored == pytest.approx([-above, -below], rel=1e-12)


@pytest.mark.parametrize(
    ("section", "largest"),
    [
        (bf.Rectangle(0.01, 0.02), 1.5),
        (bf.Circle(0.02), 4 / 3),
        # half of an annulus: Q = 2/3 (R^3 - r^3), b = 2 (R - r)
        (bf.Tube(0.02, 0.004), 4 / 3 * (1.0**2 + 1.0 * 0.6 + 0.6**2) / (1.0**2 + 0.6**2)),
        (bf.Tube(0.02, 1e-6), 2.0),
    ],
    ids=["rectangle", "circle", "tube", "thin tube"],
)
def test_largest_shear_stress_over_the_mean(section, largest):
    found = distribution(section, STEEL, 0.0)
    assert float(found.shear_stress(0, 0.0, 700.0)) == pytest.approx(largest * 700.0 / section.area, rel=2e-4)
    assert found.shear_stress(0, np.array(found.layers[0]), 700.0) == pytest.approx([0.0, 0.0])


def test_shear_stress_of_a_sandwich():
    """V Q* / (EI b): E-weighted first moments of the transformed section, by hand."""
    core = bf.Material(7e7, 0.3, 60.0)
    section = bf.Layered((bf.Layer(STEEL, 0.001), bf.Layer(core, 0.02), bf.Layer(STEEL, 0.001)), 0.05)
    found = distribution(section, None, 0.0)
    ei = 0.05 * (2.1e11 * 2 * (0.001**3 / 12 + 0.001 * 0.0105**2) + 7e7 * 0.02**3 / 12)
    glue, middle = 2.1e11 * 0.001 * 0.0105, 2.1e11 * 0.001 * 0.0105 + 7e7 * 0.01 * 0.005
    assert float(found.shear_stress(0, -0.01, 900.0)) == pytest.approx(900.0 * glue / ei, rel=1e-12)
    assert float(found.shear_stress(1, -0.01, 900.0)) == pytest.approx(900.0 * glue / ei, rel=1e-12)
    assert float(found.shear_stress(1, 0.0, 900.0)) == pytest.approx(900.0 * middle / ei, rel=1e-12)
    assert float(found.shear_stress(2, 0.011, 900.0)) == 0.0
    # both sides of a face between layers: stress by their moduli
    both = [float(found.normal_stress(layer, 0.01, 0.0, 10.0)) for layer in (1, 2)]
    assert both == pytest.approx([-7e7 * 10.0 * 0.01 / ei, -2.1e11 * 10.0 * 0.01 / ei], rel=1e-12)


def a_section(random):
    """Return a section of random kind and size, the width of its true shape, and half its height."""
    size = 10.0 ** random.uniform(-3, 0)
    kind = random.integers(4)
    if kind == 0:
        return bf.Rectangle(0.3 * size, size), lambda y: 0.3 * size
    if kind == 1:
        return bf.Circle(size), lambda y: 2 * np.sqrt(max(size**2 / 4 - y**2, 0.0))
    if kind == 2:
        inner = size / 2 * random.uniform(0.2, 0.98)
        hole = lambda y: 2 * np.sqrt(max(inner**2 - y**2, 0.0))  # noqa: E731
        return bf.Tube(size, size / 2 - inner), lambda y: 2 * np.sqrt(max(size**2 / 4 - y**2, 0.0)) - hole(y)
    layers = [
        bf.Layer(bf.Material(10.0 ** random.uniform(6, 11), 0.3, 1.0), size * random.uniform(0.1, 0.5))
        for _ in range(random.integers(1, 5))
    ]
    return bf.Layered(layers, 0.2 * size, axis=size * random.uniform(0.0, 0.6)), lambda y: 0.2 * size


@pytest.mark.parametrize("number", range(40))
def test_resultants_of_random_sections_are_the_section_forces(number):
    """Integrals of sigma, -y sigma and tau over the true shape, straight and with h / R up to 1.4."""
    random = np.random.default_rng(number)
    section, width = a_section(random)
    low, high = section.bounds
    size = high - low
    curvature = random.choice([0.0, 1.0, -1.0]) * random.uniform(0.01, 0.7) / max(-low, high)
    normal, shear, moment = random.normal(size=3) * [1.0, 1.0, size]
    found = distribution(section, STEEL, curvature)
    total = np.zeros(3)
    for layer, (bottom, top) in enumerate(found.layers):
        inner = section.outline.inner if hasattr(section, "outline") and hasattr(section.outline, "inner") else None
        kinks = None if inner is None else (-inner, inner)

        def over(value, bottom=bottom, top=top, kinks=kinks):
            return quad(lambda y: float(value(y)) * width(y), bottom, top, points=kinks, limit=200, epsabs=1e-12)[0]

        total[0] += over(lambda y: found.normal_stress(layer, y, normal, moment))  # noqa: B023
        total[1] += over(lambda y: found.shear_stress(layer, y, shear))  # noqa: B023
        total[2] += over(lambda y: -y * found.normal_stress(layer, y, normal, moment))  # noqa: B023
    scale = abs(normal) + abs(moment) / size
    assert total / [scale, abs(shear), scale * size] == pytest.approx(
        np.array([normal, shear, moment]) / [scale, abs(shear), scale * size], abs=1e-7
    )


def test_shear_and_bending_stress_of_a_thick_ring_balance_each_other():
    """Fibres of a ring: d(r^2 tau b)/dr = -+ r d(sigma b)/d(angle), from statics of a wedge under a tip force."""
    radius, height, width, force = 0.1, 0.06, 0.02, 800.0
    found = distribution(bf.Rectangle(width, height), STEEL, 1.0 / radius)

    def sigma(y, angle):
        # a force F at the end of a quarter ring: N = F sin, V = F cos, M' = -V
        return found.normal_stress(0, y, force * np.sin(angle), -force * radius * np.sin(angle))

    angle, step = 0.4, 1e-4
    change = lambda y: (sigma(y, angle + step) - sigma(y, angle - step)) / (2 * step)  # noqa: E731
    for y in (-0.02, 0.0, 0.015):
        flow = -quad(lambda at: (radius - at) * float(change(at)), -0.5 * height, y)[0]
        tau = float(found.shear_stress(0, y, force * np.cos(angle)))
        assert tau * (radius - y) ** 2 == pytest.approx(flow, rel=1e-7)


def test_arrays_of_forces_and_curvatures_go_together():
    curvature = np.array([0.0, 5.0, -5.0])
    y = np.linspace(-0.02, 0.02, 5)
    normal, moment = np.arange(6.0).reshape(2, 3), np.ones((2, 3))
    section = bf.Rectangle(0.01, 0.04)
    found = distribution(section, STEEL, curvature[:, None])
    together = found.normal_stress(0, y, normal[..., None], moment[..., None])
    sheared = found.shear_stress(0, y, normal[..., None])
    assert together.shape == sheared.shape == (2, 3, 5)
    for i, own in enumerate(curvature):
        alone = distribution(section, STEEL, own)
        np.testing.assert_allclose(together[:, i], alone.normal_stress(0, y, normal[:, i, None], moment[:, i, None]))
        np.testing.assert_allclose(sheared[:, i], alone.shear_stress(0, y, normal[:, i, None]))


def test_what_is_not_known_is_nan():
    y = np.array([-0.05, 0.0, 0.05])
    by_stiffness = distribution(bf.Section.from_stiffness(1e4, 1e4, 100.0, 1.0, 1.0), None, 0.0)
    assert len(by_stiffness.layers) == 1
    assert np.isnan(by_stiffness.normal_stress(0, y, 1.0, 1.0)).all()
    assert np.isnan(by_stiffness.shear_stress(0, y, np.ones(3))).all()
    # moments alone: N / A on the axis, and no face to speak of
    by_moments = distribution(bf.Section(1e-3, 1e-6), STEEL, 0.0)
    np.testing.assert_allclose(by_moments.normal_stress(0, y, 3.0, 1.0), [np.nan, 3e3, np.nan])
    assert np.isnan(by_moments.shear_stress(0, y, 1.0)).all()
    # with a height both faces are known, the width between is not
    with_height = distribution(bf.Section(1e-3, 1e-6, height=0.1), STEEL, 0.0)
    np.testing.assert_allclose(with_height.shear_stress(0, y, 1.0), [0.0, np.nan, 0.0])
    # a section that reaches the centre of curvature
    assert np.isnan(distribution(bf.Rectangle(0.01, 0.1), STEEL, 20.0).normal_stress(0, y, 1.0, 1.0)).all()


def test_a_slightly_curved_section_by_moments_is_the_shape_of_these_moments():
    """A rectangle known by A, I, I4 and its height: Winkler's hyperbola to the fourth order of h / R."""
    shape = bf.Rectangle(0.01, 0.05)
    same = bf.Section(shape.area, shape.second_moment, height=0.05)
    one, other = (faces(section, 10.0, 50.0, curvature=3.0) for section in (shape, same))
    assert one == pytest.approx(other, rel=1e-4)


class Users:
    """A section with the members of the protocol only: a rectangle off the axis."""

    shear_factor = 1.0
    bounds = (0.01, 0.03)

    def rigidity(self, material): ...

    def inertia(self, material): ...

    def strips(self, material): ...

    def moments(self, material):
        return [(material, 0.1 * np.array([(0.03**n - 0.01**n) / n for n in range(1, 6)]))]

    def materials_at(self, y, material):
        return [(material, np.ones_like(y, dtype=bool))]


@pytest.mark.parametrize("curvature", [0.0, 4.0])
def test_a_users_own_section_by_its_moments(curvature):
    same = bf.Layered((bf.Layer(STEEL, 0.02),), 0.1, axis=-0.01)
    assert same.bounds == pytest.approx((0.01, 0.03))
    assert faces(Users(), 10.0, 20.0, curvature) == pytest.approx(faces(same, 10.0, 20.0, curvature), rel=1e-5)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"height": -0.1}, "height"),
        ({"height": 0.1, "centroid": 0.1}, "below the upper face"),
        ({"height": 0.1, "centroid": 0.0}, "centroid"),
        ({"centroid": 0.1}, "give its height"),
        ({"height": 0.05}, "at most"),
    ],
)
def test_heights_that_cannot_be_are_refused(arguments, message):
    with pytest.raises(bf.InputError, match=message):
        bf.Section(1e-3, 1e-6, **arguments)


@pytest.mark.parametrize("curvature", [0.0, 3.0, -8.0])
def test_two_flanges_of_a_curved_beam_carry_the_moment_as_a_couple(curvature):
    """All of the area is at the faces, I = A h^2 / 4: each carries M / h on A / 2, however the beam is curved."""
    section = bf.Section(2e-3, 2e-3 * 0.1**2 / 4, height=0.1)
    own = distribution(section, bf.Material(2e11, 0.3, 7800.0), curvature)
    faces = own.normal_stress(0, np.array([-0.05, 0.05]), np.array(0.0), np.array(700.0))
    np.testing.assert_allclose(faces, [7e6, -7e6], rtol=1e-12)
