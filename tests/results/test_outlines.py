"""Bodies have the height of their section, in files and pictures, and the stress of its true faces."""

import numpy as np
import pytest
import pyvista
from scipy.integrate import quad

import beamfem as bf
from beamfem.forms import beam_basis
from beamfem.view.deformed_shapes import Shapes

STEEL = bf.Material(2.1e11, 0.3, 7850.0)
IPE_200 = bf.Section(28.5e-4, 1943e-8, height=0.2)
TEE = bf.Section(19e-4, 1.8e-6, height=0.1, centroid=0.07)


def bent(section, moment, curve=None, element=None, elements=2, material=STEEL):
    """Return a beam under a pure moment."""
    beam = bf.Beam(curve or bf.Line((0, 0), (1, 0)), elements, element or bf.CRBF(4), section, material)
    return bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, moment)]))


def body(solution, folder, row=-1):
    """Return the exported body of a row as PyVista reads it."""
    path = folder / "body.pvd"
    solution.to_vtk(path)
    return pyvista.read(sorted((folder / "body").glob("*.vtu"))[row])


SECTIONS = {
    "circle": (bf.Circle(0.02), 20.0, (-0.01, 0.01), np.pi * 0.02**4 / 64),
    "tube": (bf.Tube(0.02, 0.001), 20.0, (-0.01, 0.01), np.pi * (0.02**4 - 0.018**4) / 64),
    "rectangle": (bf.Rectangle(0.01, 0.02), 20.0, (-0.01, 0.01), 0.01 * 0.02**3 / 12),
    "IPE 200": (IPE_200, 1e4, (-0.1, 0.1), 1943e-8),
    "tee": (TEE, 1e3, (-0.07, 0.03), 1.8e-6),
}


@pytest.mark.parametrize("name", SECTIONS)
def test_an_exported_body_has_the_height_and_the_faces_stress_of_its_section(name, tmp_path):
    section, moment, (low, high), second = SECTIONS[name]
    solution = bent(section, moment)
    grid = body(solution, tmp_path, row=0)
    assert grid.points[:, 1].min() == pytest.approx(low, rel=1e-12)
    assert grid.points[:, 1].max() == pytest.approx(high, rel=1e-12)
    y = grid.points[:, 1]
    stress = body(solution, tmp_path)["stress_xx"]
    np.testing.assert_allclose(stress, -moment * y / second, rtol=1e-6, atol=1e-6 * moment * high / second)


def test_a_circle_of_20_mm_under_20_newton_metres_is_20_mm_high_and_shows_25_46_megapascal(tmp_path):
    grid = body(bent(bf.Circle(0.02), 20.0), tmp_path)
    assert grid["stress_xx"].max() / 1e6 == pytest.approx(25.465, abs=0.001)
    grid = body(bent(bf.Tube(0.02, 0.001), 20.0), tmp_path)
    assert grid["stress_xx"].max() / 1e6 == pytest.approx(74.047, abs=0.001)


@pytest.mark.parametrize("name", SECTIONS)
def test_a_drawn_body_has_the_height_of_its_section(name):
    section, moment, (low, high), _ = SECTIONS[name]
    drawn = Shapes(bent(section, moment), np.array([0]))
    assert drawn.body[0][0, :, 0, 1] == pytest.approx(low, rel=1e-12)
    assert drawn.body[0][0, :, 1, 1] == pytest.approx(high, rel=1e-12)


@pytest.mark.parametrize("element", [bf.CRBF(4), bf.ANCFCRBF(bf.ElasticLine()), bf.ShearRigid()])
def test_a_thick_arc_under_pure_moment_shows_winklers_stress(element, tmp_path):
    """R = 0.1, h = 0.05; 6 M / (b h^2) = 12 MPa: -14.40 MPa at the inner face, +10.24 at the outer one."""
    radius, height, width = 0.1, 0.05, 0.02
    moment = 12e6 * width * height**2 / 6
    arc = bf.Arc((0, 0), radius, 0.0, 0.5 * np.pi)
    solution = bent(bf.Rectangle(width, height), moment, arc, element, 12)
    stress, r = body(solution, tmp_path)["stress_xx"], np.hypot(*body(solution, tmp_path, 0).points[:, :2].T)
    neutral = height / np.log((radius + height / 2) / (radius - height / 2))
    expected = moment * (r - neutral) / (width * height * (radius - neutral) * r)
    np.testing.assert_allclose(stress, expected, rtol=2e-3, atol=2e-3 * 12e6)
    assert stress.min() / 1e6 == pytest.approx(-14.40, abs=0.02)
    assert stress.max() / 1e6 == pytest.approx(10.24, abs=0.02)


@pytest.mark.parametrize(
    ("section", "largest"),
    [(bf.Rectangle(0.02, 0.05), 1.5), (bf.Circle(0.05), 4 / 3)],
    ids=["rectangle", "circle"],
)
def test_the_exported_shear_stress_is_a_parabola(section, largest, tmp_path):
    """V / A = 1e5 Pa in every section: its factor in the middle, 0 at the faces; every cell is exact between."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(4), section, STEEL)
    force = 1e5 * section.area
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, force))]))
    solution.to_vtk(tmp_path / "body.pvd")
    rest, grid = (pyvista.read(tmp_path / "body" / f"000{row}.vtu") for row in (0, 1))
    expected = largest * 1e5 * (1.0 - (rest.points[:, 1] / 0.025) ** 2)
    np.testing.assert_allclose(grid["stress_xy"], expected, atol=1e-3 * 1e5)
    line = pyvista.read(tmp_path / "body_centreline" / "0001.vtu")
    np.testing.assert_allclose(line["stress_xy"], largest * 1e5, rtol=1e-3)


def test_a_beam_known_by_its_stiffness_does_not_take_the_stress_of_the_others(tmp_path):
    other = bf.Section.from_stiffness(1e7, 1e7, 1e4, 1.0, 1.0)
    one = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(4), bf.Circle(0.02), STEEL)
    two = bf.Beam(bf.Line((0, 1), (1, 1)), 2, bf.CRBF(4), other)
    supports = [bf.Clamp(one.start), bf.Clamp(two.start)]
    loads = [bf.PointMoment(one.end, 20.0), bf.PointMoment(two.end, 20.0)]
    with pytest.warns(bf.UnknownStressWarning, match=r"1 of 2 beams \(1\) is not known and is nan"):
        grid = body(bf.solve_static(bf.Model([one, two], supports, loads)), tmp_path)
    of_one, of_two = (grid.extract_cells(grid["beam"] == number)["stress_xx"] for number in (0, 1))
    assert of_one.max() == pytest.approx(32 * 20.0 / (np.pi * 0.02**3), rel=1e-6)
    assert np.isnan(of_two).all()


def test_moments_without_a_height_have_no_faces_but_an_axis(tmp_path):
    """N / A is known on the axis; where the faces are, is not, so their stress is left out and that is said."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Section(28.5e-4, 1943e-8), STEEL)
    loads = [bf.PointForce(beam.end, (1e5, 0.0))]
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], loads))
    with pytest.warns(bf.UnknownStressWarning, match="height="):
        grid = body(solution, tmp_path)
    assert not [name for name in grid.point_data if name.startswith("stress")]
    line = pyvista.read(tmp_path / "body_centreline" / "0001.vtu")
    np.testing.assert_allclose(line["stress_xx"], 1e5 / 28.5e-4, rtol=1e-5)
    assert "stress_xy" not in line.point_data


@pytest.mark.parametrize("thickness", [0.02, 0.004])
def test_the_basis_of_the_forms_has_the_volume_and_moments_of_a_tapered_beam(thickness):
    sections = {
        "rectangle": (lambda s: bf.Rectangle(0.01, thickness * (2 - s)), lambda s: 0.01 * thickness * (2 - s)),
        "circle": (lambda s: bf.Circle(thickness * (2 - s)), lambda s: np.pi / 4 * (thickness * (2 - s)) ** 2),
    }
    for section, area in sections.values():
        beam = bf.Beam(bf.Line((0, 0), (1.5, 0)), 3, bf.ANCF(), section, STEEL)
        mesh = bf.Model([beam]).meshes[0]
        basis = beam_basis(mesh, 6)
        y = basis.mapping.F(basis.X)[1]
        assert basis.dx.sum() == pytest.approx(quad(area, 0.0, 1.5)[0], rel=1e-12)
        second = quad(lambda s: section(s).second_moment, 0.0, 1.5)[0]  # noqa: B023
        assert (basis.dx * y**2).sum() == pytest.approx(second, rel=1e-12)


def test_an_outline_is_saved_and_loaded(tmp_path):
    for section in (bf.Circle(0.02), TEE, bf.Section(1e-3, 1e-6), lambda s: bf.Tube(0.02 + 0.01 * s, 0.001)):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(4), section, STEEL)
        model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, 20.0)])
        bf.solve_static(model).save(tmp_path / "saved.h5")
        again = bf.load(tmp_path / "saved.h5")
        if callable(section):
            assert body(again, tmp_path)["stress_xx"].max() == pytest.approx(74.047e6, rel=1e-4)
        else:
            assert again.model.beams[0].section == section
