"""Stresses that users read, of fields and files, against closed forms, for every kind of element."""

import numpy as np
import pytest
from conftest import ELEMENTS, identify
from test_vtk import point_data, read

import beamfem as bf

STEEL = bf.Material(2e11, 0.3, 7800.0)
SECTION = bf.Rectangle(0.01, 0.01)
LINE = bf.Line((0, 0), (1, 0))
SHEARED = 10.0  # N, V / A = 1e5 Pa
# interpolated strain times G gave -1.07e7 to 1.09e7, 22, 3.6 and 2 times the shear stress here
WRONG = [
    bf.CRBF(1),
    bf.BilinearCRBF(integration="reduced"),
    bf.CRBF(2),
    bf.ANCF(),
    bf.ANCFCRBF(bf.ElasticLine()),
]


def cantilever(element, elements, force, section=SECTION, curve=LINE):
    beam = bf.Beam(curve, elements, element, section, STEEL)
    return bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, force)])), beam


@pytest.mark.parametrize("element", WRONG, ids=identify)
def test_shear_stress_is_the_parabola_of_the_shear_force(element, tmp_path):
    solution, beam = cantilever(element, 8, (0.0, SHEARED))
    solution.to_vtk(tmp_path / "bent.pvd")
    rest, data = (point_data(read(tmp_path / "bent" / f"{row:04d}.vtu")) for row in (0, 1))
    grid = read(tmp_path / "bent" / "0000.vtu")
    s, y = np.array([grid.GetPoint(i)[:2] for i in range(grid.GetNumberOfPoints())]).T
    # round-off of strains is worth 1e-4 Pa
    assert all(np.abs(rest[name]).max() < 1e-3 for name in data if "stress" in name)
    shear = 1.5 * 1e5 * (1.0 - (2.0 * y / 0.01) ** 2)
    # the sag turns the force by its slope
    np.testing.assert_allclose(data["stress_xy"], shear, atol=1e-3 * 1e5)
    bending = -SHEARED * (1.0 - s) * y / SECTION.second_moment
    np.testing.assert_allclose(data["stress_xx"], bending, atol=3e-3 * np.abs(bending).max())
    mises = np.sqrt(data["stress_xx"] ** 2 + 3.0 * data["stress_xy"] ** 2)
    np.testing.assert_allclose(data["von_mises_stress"], mises, rtol=1e-12)
    middle = solution.fields(beam.at(0.3)).stress
    assert middle.xy[-1] == pytest.approx(1.5e5, rel=1e-3)
    assert abs(middle.xx[-1]) < 3e3
    assert middle.yy[-1] == 0.0


@pytest.mark.parametrize("element", ELEMENTS, ids=identify)
def test_stress_on_the_axis_is_that_of_the_section_forces(element):
    """N / A and 3/2 V / A of a force cut by hand, at a large turn, at nodes and between."""
    material, section, force = bf.Material(2e5, 0.3, 1.0), bf.Rectangle(0.2, 0.2), np.array([-3.0, 6.0])
    beam = bf.Beam(LINE, 3, element, section, material)
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, tuple(force))]))
    for share in (0.0, 1.0 / 3.0, 0.45, 1.0):
        fields = solution.fields(beam.at(share))
        slope = element.forces.turns_with == "r_x"
        along = fields.r_x[-1] if slope else np.array([fields.r_y[-1, 1], -fields.r_y[-1, 0]])
        along = along / np.linalg.norm(along)
        assert fields.stress.xx[-1] == pytest.approx(along @ force / section.area, rel=1e-8, abs=1e-8)
        across = along[0] * force[1] - along[1] * force[0]
        assert fields.stress.xy[-1] == pytest.approx(1.5 * across / section.area, rel=1e-8, abs=1e-8)


@pytest.mark.parametrize("element", [bf.CRBF(3), bf.ANCF(bf.Structural()), bf.ANCFCRBF(bf.ElasticLine())], ids=identify)
def test_the_tensor_stands_in_the_axes_of_the_plane(element, tmp_path):
    """A bar that stands at 60 degrees, pulled along: sigma n n of its direction, with tension alone."""
    normal = np.array([0.5, np.sqrt(0.75)])
    solution, _ = cantilever(element, 2, tuple(1e3 * normal), curve=bf.Line((0, 0), tuple(normal)))
    solution.to_vtk(tmp_path / "pulled.pvd", fields=["stress_xx", "von_mises_stress", "cauchy_stress"])
    data = point_data(read(tmp_path / "pulled" / "0001.vtu"))
    x, y = normal
    expected = 1e3 / SECTION.area * np.array([x * x, y * y, 0.0, x * y, 0.0, 0.0])
    np.testing.assert_allclose(data["cauchy_stress"], np.tile(expected, (len(data["stress_xx"]), 1)), atol=1.0)
    np.testing.assert_allclose(data["von_mises_stress"], 1e3 / SECTION.area, rtol=1e-6)


def test_traction_on_a_turned_section_is_the_force_per_area(tmp_path):
    """Sheared and pulled far: the tensor times the normal is the force on the section, over the height its mean."""
    element = bf.CRBF(4)
    solution, _ = cantilever(element, 4, (400.0, 900.0))
    solution.to_vtk(tmp_path / "bent.pvd", fields=["rotation", "cauchy_stress"])
    data = point_data(read(tmp_path / "bent" / f"{len(solution) - 1:04d}.vtu"))
    angle = data["rotation"]
    normal = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    assert np.ptp(angle) > 0.8
    xx, yy, _, xy, _, _ = data["cauchy_stress"].T
    traction = np.stack([xx * normal[:, 0] + xy * normal[:, 1], xy * normal[:, 0] + yy * normal[:, 1]], axis=1)
    # lower face, middle and upper face of each place by Simpson's rule: exact for line and parabola
    cells = traction.reshape(4, -1, 2)
    n = int(cells.shape[1] / 3) - 1
    low = [0, 1, *range(4, 4 + n - 1)]
    high = [3, 2, *range(5 + n - 1, 5 + 2 * (n - 1))]
    middle = [4 + 2 * (n - 1) + 1, 4 + (n - 1), *range(6 + 2 * (n - 1), 6 + 3 * (n - 1))]
    mean = (cells[:, low] + 4.0 * cells[:, middle] + cells[:, high]) / 6.0
    np.testing.assert_allclose(mean.reshape(-1, 2), np.tile([400.0, 900.0], (4 * (n + 1), 1)) / SECTION.area, rtol=1e-6)


@pytest.mark.parametrize(("plane_stress", "coefficient"), [(False, 1.5), (True, 0.78 / 0.91)])
def test_stress_of_strains_of_a_continuum_is_hookes(plane_stress, coefficient):
    """lambda tr(E) + 2 mu E: mu = 1, and lambda = E nu / ((1 + nu)(1 - 2 nu)) = 1.5 or E nu / (1 - nu^2)."""
    forces, material = bf.ContinuumMechanics(plane_stress), bf.Material(2.6, 0.3, 1.0)
    found = forces.stress(np.array([[0.1], [0.0]]), np.array([[0.2], [0.0]]), np.array([[0.03], [1.0]]), material)
    trace = 0.3 * coefficient
    expected = ([[trace + 0.2], [0.0]], [[trace + 0.4], [0.0]], [[0.06], [2.0]])
    for part, own in zip(found, expected, strict=True):
        np.testing.assert_allclose(part, own, rtol=1e-14)
