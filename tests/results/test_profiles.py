"""Rolled and hollow sections against published tables; polygons against closed forms."""

import csv
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import quad

import beamfem as bf
from beamfem.section import profiles
from beamfem.section.distribution import distribution

STEEL = bf.Material(2.1e11, 0.3, 7850.0, strength=2.35e8)
# area [cm^2], I about the strong and the weak axis [cm^4], as printed: ArcelorMittal, Sections and Merchant Bars, 2024;
# hollow sections: annexes of EN 10210-2 and EN 10219-2; angles: EN 10056-1
PUBLISHED = {
    "IPE 80": (7.64, 80.1, 8.49),
    "IPE 200": (28.5, 1943, 142.3),
    "IPE 300": (53.8, 8356, 603.7),
    "IPE 450": (98.8, 33740, 1675),
    "IPE 600": (156.0, 92080, 3387),
    "HEA 100": (21.2, 349.2, 133.8),
    "HEA 240": (76.8, 7763, 2768),
    "HEA 1000": (346.8, 553840, 14000),
    "HEB 160": (54.3, 2491, 889.2),
    "HEB 300": (149.1, 25160, 8562),
    "UPN 80": (11.0, 106, 19.4),
    "UPN 140": (20.4, 605, 62.7),
    "UPN 200": (32.2, 1910, 148),
    "UPN 300": (58.8, 8030, 495),
    "UPN 320": (75.8, 10870, 597),
    "L 50x50x5": (4.80, 11.0, 11.0),
    "L 100x100x10": (19.2, 177, 177),
    "L 100x50x8": (11.4, 116, 19.7),
    "L 200x200x20": (76.3, 2851, 2851),
    "SHS 100x5": (18.7, 279, 279),
    "SHS 100x5 cold": (18.4, 271, 271),
    "RHS 120x80x5": (18.7, 365, 193),
    "RHS 200x100x8": (44.8, 2234, 739),
    "CHS 114.3x5": (17.2, 257, 257),
}


@pytest.mark.parametrize("name", PUBLISHED)
def test_areas_and_second_moments_are_the_published_ones(name):
    area, strong, weak = PUBLISHED[name]
    along, across = bf.Profile(name), bf.Profile(name, weak=True)
    rounding = 6e-3 if area < 20 else 3e-3  # tables give three digits
    assert 1e4 * along.area == pytest.approx(area, rel=rounding)
    assert across.area == pytest.approx(along.area, rel=1e-12)
    assert 1e8 * along.second_moment == pytest.approx(strong, rel=rounding)
    # tables of UPN are older than computers: 0.4 % off the shape of the standard at most
    assert 1e8 * across.second_moment == pytest.approx(weak, rel=5e-3 if name.startswith("UPN") else rounding)


def test_every_profile_of_the_table_has_the_area_of_the_formula_of_its_standard():
    """EN 10365: A = 2 tf b + (h - 2 tf) tw + (4 - pi) r^2; EN 10056: t (a + b - t) + (1 - pi/4) (r1^2 - 2 r2^2)."""
    with (Path(profiles.__file__).parent / "profiles.csv").open() as file:
        table = list(csv.DictReader(file))
    assert len(table) == len({row["name"] for row in table}) > 150
    for row in table:
        h, b, tw, tf, r, toe = (float(row[key]) for key in ("h", "b", "tw", "tf", "r1", "r2"))
        area = 1e6 * bf.Profile(row["name"]).area
        if row["name"][0] in "IH":
            assert area == pytest.approx(2 * tf * b + (h - 2 * tf) * tw + (4 - np.pi) * r**2, rel=1e-12)
        elif row["name"][0] == "L":
            assert area == pytest.approx(tw * (h + b - tw) + (1 - np.pi / 4) * (r**2 - 2 * toe**2), rel=1e-12)
    for one, other in pairwise(table):
        if one["name"][:3] == other["name"][:3] and one["name"][0] != "L":
            small, large = bf.Profile(one["name"]), bf.Profile(other["name"])
            assert small.second_moment < large.second_moment


@pytest.mark.parametrize(("name", "centroid"), [("UPN 80", 14.5), ("UPN 200", 20.1), ("L 100x100x10", 28.2)])
def test_centroids_are_the_published_ones(name, centroid):
    assert -1e3 * bf.Profile(name, weak=True).bounds[0] == pytest.approx(centroid, abs=0.05)


@pytest.mark.parametrize(("name", "modulus"), [("IPE 200", 220.6), ("HEB 300", 1868), ("UPN 200", 228)])
def test_fibres_of_a_profile_have_its_published_plastic_modulus(name, modulus):
    """W_pl f_y is the moment of a section that has yielded over its whole height."""
    law = bf.ElasticPlastic(2.1e11, yield_stress=2.35e8, poisson_ratio=0.3, density=7850.0)
    section = bf.Fibres(bf.Profile(name), law, points=60)
    heights, areas = section.fibres
    assert 1e6 * np.abs(heights) @ areas == pytest.approx(modulus, rel=3e-3)
    assert areas.sum() == pytest.approx(bf.Profile(name).area, rel=1e-3)


@pytest.mark.parametrize("name", ["IPE 200", "HEA 100", "UPN 200", "L 100x50x8", "RHS 120x80x5", "SHS 100x5 cold"])
@pytest.mark.parametrize("weak", [False, True])
@pytest.mark.parametrize("curvature", [0.0, 2.0])
def test_stresses_over_the_true_shape_add_up_to_the_section_forces(name, weak, curvature):
    section = bf.Profile(name, weak)
    found, (normal, shear, moment) = distribution(section, STEEL, curvature), (3e3, 2e3, 5e2)
    total = np.zeros(3)
    for layer, strip in enumerate(section.outline):

        def over(value, strip=strip):
            along = lambda angle: strip.low + 0.5 * (strip.high - strip.low) * (1 - np.cos(angle))  # noqa: E731
            half = 0.5 * (strip.high - strip.low)
            return quad(lambda t: float(value(along(t)) * strip.width(along(t))) * half * np.sin(t), 0, np.pi)[0]

        total[0] += over(lambda y: found.normal_stress(layer, y, normal, moment))  # noqa: B023
        total[1] += over(lambda y: found.shear_stress(layer, y, shear))  # noqa: B023
        total[2] += over(lambda y: -y * found.normal_stress(layer, y, normal, moment))  # noqa: B023
    assert total == pytest.approx([normal, shear, moment], rel=1e-7)


def test_the_higher_side_of_a_hollow_section_is_its_strong_one_and_units_are_free():
    assert bf.Profile("RHS 80x120x5").second_moment == bf.Profile("RHS 120x80x5").second_moment
    assert bf.Profile("UPN 320", millimetre=1).second_moment == pytest.approx(10869e4, rel=1e-3)
    assert bf.Profile("CHS 60.3x4", millimetre=1).bounds == (-30.15, 30.15)


def test_polygons_are_the_shapes_that_they_describe():
    square = [(0, 0), (0.03, 0), (0.03, 0.03), (0, 0.03)]
    disc = bf.Polygon([(*corner, 0.015) for corner in square])
    circle = bf.Circle(0.03)
    ring = bf.Polygon([(*corner, 0.015) for corner in square], [[(x / 2, y / 2 + 0.0075, 0.0075) for x, y in square]])
    tube = bf.Tube(0.03, 0.0075)
    for shape, same in ((disc, circle), (bf.Polygon(square), bf.Rectangle(0.03, 0.03)), (ring, tube)):
        for moment in ("area", "second_moment", "fourth_moment"):
            assert getattr(shape, moment) == pytest.approx(getattr(same, moment), rel=1e-12)
        assert shape.bounds == pytest.approx(same.bounds)
    assert disc.shear_factor == pytest.approx(circle.shear_factor, rel=1e-12)
    triangle = bf.Polygon([(0, 0), (0.06, 0), (0.03, 0.09)])
    assert triangle.second_moment == pytest.approx(0.06 * 0.09**3 / 36, rel=1e-12)
    third = 0.06 * 0.09**4 / 270  # of y^3 about the centroid
    assert triangle.moments(STEEL)[0][1][3] == pytest.approx(third, rel=1e-12)
    mirrored = bf.Polygon([(0.03, 0.09), (0.06, 0), (0, 0)])
    assert mirrored.second_moment == pytest.approx(triangle.second_moment, rel=1e-12)
    # V S / (I b) of a triangle: 3/2 V/A at half its height
    found = distribution(triangle, STEEL, 0.0)
    assert float(found.shear_stress(0, 0.045 - 0.03, 700.0)) == pytest.approx(1.5 * 700.0 / triangle.area, rel=1e-12)


def cantilever(section, force=-5e3, elements=2):
    beam = bf.Beam(bf.Line((0, 0), (2, 0)), elements, bf.CRBF(4), section, STEEL)
    return bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, force))])


def test_stresses_of_a_cantilever_ipe_200():
    """M / W at the faces, V S / (I t) in the web with the half section's S = W_pl / 2, by the published table."""
    solution = bf.solve_static(cantilever(bf.Profile("IPE 200"), -50.0))
    stress = solution.stresses(solution.model.beams[0])
    assert stress.peak("tension").value == pytest.approx(50 * 2 / 194.3e-6, rel=1e-3)
    assert stress.peak("shear").value == pytest.approx(50 * 110.3e-6 / (1943e-8 * 5.6e-3), rel=1e-3)


def test_von_mises_stress_is_largest_at_the_root_of_the_web_of_a_short_beam():
    """By hand: at the end of the fillet y = h/2 - tf - r, sigma = M y / I and tau = V S / (I tw)."""
    section, shear, moment = bf.Profile("HEB 300"), 5e5, 1e5
    found = distribution(section, STEEL, 0.0)
    y = 0.15 - 0.019 - 0.027
    inertia, plastic = 25166e-8, 1869e-6
    first = plastic / 2 - 0.011 * y**2 / 2
    web = next(layer for layer, (low, high) in enumerate(found.layers) if low < 0 < high)
    assert found.layers[web][1] == pytest.approx(y)
    assert float(found.normal_stress(web, y, 0.0, moment)) == pytest.approx(-moment * y / inertia, rel=1e-4)
    assert float(found.shear_stress(web, y, shear)) == pytest.approx(shear * first / (inertia * 0.011), rel=1e-3)


@pytest.mark.parametrize("section", [bf.Profile("IPE 200"), bf.Profile("UPN 200", weak=True), bf.Profile("CHS 60.3x4")])
def test_a_profile_is_saved_and_loaded(section, tmp_path):
    solution = bf.solve_static(cantilever(section, -50.0))
    solution.save(tmp_path / "saved.h5")
    again = bf.load(tmp_path / "saved.h5")
    assert again.model.beams[0].section == section
    assert again.peak_stress().value == solution.peak_stress().value


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: bf.Profile("IPE 205"), "did you mean IPE 200"),
        (lambda: bf.Profile("HEB 1"), "did you mean HEB 100"),
        (lambda: bf.Profile("W 8x31"), "there are IPE, HEA"),
        (lambda: bf.Profile("L 100x100x11"), "did you mean L 100x100x1"),
        (lambda: bf.Profile("CHS 100x50x5"), "no profile"),
        (lambda: bf.Profile("SHS 20x8"), "twice the radius"),
        (lambda: bf.Profile("SHS 20x0"), "greater than 0"),
        (lambda: bf.Profile(200), "name of Profile"),
        (lambda: bf.Polygon([(0, 0), (1, 0)]), "at least 3 corners"),
        (lambda: bf.Polygon([(0, 0), (1, 0), (2, 0)]), "needs an area"),
        (lambda: bf.Polygon([(0, 0), (2, 1), (2, 0), (0, 3)]), "cross itself"),
        (lambda: bf.Polygon([(0, 0), (1, 0), (1, 0), (0, 1)]), "are the same"),
        (lambda: bf.Polygon([(0, 0, 1), (1, 0, 1), (1, 1), (0, 1)]), "too large"),
        (lambda: bf.Polygon([(0, 0, -1), (1, 0), (1, 1)]), "radius"),
        (lambda: bf.Polygon([(0,), (1, 0), (1, 1)]), r"\(x, y\) or"),
        (lambda: bf.Polygon([(0, 0), (1, 0), (1, 1)], shear_factor=0), "shear_factor"),
        (lambda: bf.Polygon([(0, 0), (1, 0), (1, 1)], [[(2, 0.2), (3, 0.2), (3, 0.9)]]), "holes are inside"),
    ],
)
def test_wrong_profiles_and_polygons_are_refused(make, message):
    with pytest.raises(bf.InputError, match=message):
        make()
