"""Each layer of a layered beam is cells of its own in exports, with the stress of its own modulus where it is."""

import numpy as np
import pytest
import pyvista

import beamfem as bf
from beamfem.results.axis_points import AxisPoints
from beamfem.view import solid_pyvista as body
from beamfem.view.deformed_shapes import Shapes

STEEL, ALUMINIUM = bf.Material(2.1e11, 0.3, 7850.0), bf.Material(7e10, 0.33, 2700.0)
RUBBER = bf.Material(1e7, 0.45, 1100.0)


def transformed(layers, width, axis):
    """Return centroid above the axis and bending stiffness E I about it, by the parallel-axis theorem."""
    edges = np.concatenate([[0.0], np.cumsum([thickness for _, thickness in layers])]) - axis
    modulus = np.array([material.youngs_modulus for material, _ in layers])
    middle, thickness = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)
    centroid = (modulus * thickness) @ middle / (modulus @ thickness)
    return centroid, width * (modulus @ (thickness**3 / 12 + thickness * (middle - centroid) ** 2))


def bent(section, moment, *, elements=3, element=None, curve=None):
    beam = bf.Beam(curve or bf.Line((0, 0), (1, 0)), elements, element or bf.CRBF(4), section)
    return bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointMoment(beam.end, moment)]))


def rows(solution, folder):
    solution.to_vtk(folder / "body.pvd")
    return [pyvista.read(file) for file in sorted((folder / "body").glob("*.vtu"))]


def stresses(grid, rest, layer):
    """Return s, y in the reference and the stress of the points of a layer's cells."""
    cells = np.flatnonzero(grid["layer"] == layer)
    points = np.unique(np.concatenate([grid.get_cell(cell).point_ids for cell in cells]))
    return rest.points[points, 0], rest.points[points, 1], grid["stress_xx"][points]


def test_a_steel_core_between_rubber_shows_the_stress_of_steel(tmp_path):
    """A core of 3.4 mm bent to 1044 MPa at its faces, with rubber of a 21,000th of its modulus on both sides."""
    width, core, cover = 0.02, 0.0034, 0.01
    section = bf.Layered([bf.Layer(RUBBER, cover), bf.Layer(STEEL, core), bf.Layer(RUBBER, cover)], width)
    centroid, stiffness = transformed([(RUBBER, cover), (STEEL, core), (RUBBER, cover)], width, cover + core / 2)
    moment = 1044e6 * stiffness / (2.1e11 * core / 2)
    rest, *_, grid = rows(bent(section, moment), tmp_path)
    assert sorted(set(grid["layer"])) == [0, 1, 2]
    assert grid.n_cells == 9
    for layer, modulus in enumerate((1e7, 2.1e11, 1e7)):
        _, y, stress = stresses(grid, rest, layer)
        np.testing.assert_allclose(stress, -modulus * moment * (y - centroid) / stiffness, rtol=1e-4, atol=1.0)
    assert stresses(grid, rest, 1)[2].max() / 1e6 == pytest.approx(1044, abs=0.1)


@pytest.mark.parametrize("element", [bf.CRBF(4), bf.ANCFCRBF(bf.ElasticLine()), bf.CRBF(3, bf.SplitContinuum())])
def test_layers_jump_at_their_common_face(element, tmp_path):
    section = bf.Layered([bf.Layer(STEEL, 0.01), bf.Layer(ALUMINIUM, 0.03)], 0.05)
    rest, *_, grid = rows(bent(section, 50.0, element=element, elements=8), tmp_path)
    centroid, stiffness = transformed([(STEEL, 0.01), (ALUMINIUM, 0.03)], 0.05, 0.02)
    for layer, modulus in enumerate((2.1e11, 7e10)):
        _, y, stress = stresses(grid, rest, layer)
        expected = -modulus * 50.0 * (y - centroid) / stiffness
        np.testing.assert_allclose(stress, expected, rtol=1e-3, atol=1e-3 * np.abs(expected).max())


def test_layers_that_change_along_the_beam_are_taken_where_they_are(tmp_path):
    """Steel grows from 5 to 10 cm under 5 cm of rubber: the transformed section at each point."""

    def section(s):
        return bf.Layered((bf.Layer(STEEL, 0.05 + 0.05 * s), bf.Layer(RUBBER, 0.05)), 0.1, axis=0.07)

    rest, *_, grid = rows(bent(section, 1e3, elements=8), tmp_path)
    for layer, modulus in enumerate((2.1e11, 1e7)):
        s, y, stress = stresses(grid, rest, layer)
        own = [transformed([(STEEL, 0.05 + 0.05 * at), (RUBBER, 0.05)], 0.1, 0.07) for at in s]
        expected = np.array([-modulus * 1e3 * (height - c) / ei for height, (c, ei) in zip(y, own, strict=True)])
        np.testing.assert_allclose(stress, expected, atol=1e-3 * np.abs(expected).max())
    # y = 0.02 at s = 0.9 is steel there, and was rubber's 2e4 times smaller stress
    s, y, _ = stresses(grid, rest, 0)
    assert y[np.isclose(s, 0.875)].max() == pytest.approx(0.05 + 0.05 * 0.875 - 0.07)


def test_the_axis_shows_the_stress_of_the_layer_it_is_in(tmp_path):
    """The axis at 0.07 leaves rubber and enters steel where that is 7 cm thick, at s = 0.4."""

    def section(s):
        return bf.Layered((bf.Layer(STEEL, 0.05 + 0.05 * s), bf.Layer(RUBBER, 0.05)), 0.1, axis=0.07)

    bent(section, 1e3, elements=8).to_vtk(tmp_path / "body.pvd")
    line = pyvista.read(tmp_path / "body_centreline" / "0001.vtu")
    s = np.linspace(0.0, 1.0, 8 * 12 + 1)
    s = np.concatenate([s[12 * i : 12 * i + 13] for i in range(8)])
    own = [transformed([(STEEL, 0.05 + 0.05 * at), (RUBBER, 0.05)], 0.1, 0.07) for at in s]
    modulus = np.where(s >= 0.4 - 1e-9, 2.1e11, 1e7)
    expected = np.array([1e3 * c / ei for c, ei in own]) * modulus
    here = np.abs(s - 0.4) > 1e-6
    np.testing.assert_allclose(line["stress_xx"][here], expected[here], atol=2e-3 * np.abs(expected).max())


def test_fields_take_the_layer_that_the_axis_is_in():
    """The transformed section: at s = 0.2 the axis is in rubber, at 0.9 in steel, 2e4 times stiffer."""

    def section(s):
        return bf.Layered((bf.Layer(STEEL, 0.05 + 0.05 * s), bf.Layer(RUBBER, 0.05)), 0.1, axis=0.07)

    solution = bent(section, 1e3, elements=8)
    for at, modulus in ((0.2, 1e7), (0.9, 2.1e11)):
        centroid, stiffness = transformed([(STEEL, 0.05 + 0.05 * at), (RUBBER, 0.05)], 0.1, 0.07)
        found = solution.fields(solution.model.beams[0].at(at)).stress.xx[-1]
        assert found == pytest.approx(modulus * 1e3 * centroid / stiffness, rel=1e-6)


def test_shear_stress_between_layers_is_that_of_the_transformed_section(tmp_path):
    """V Q* / (E I b) is the same on both sides of a face, and 0 outside."""
    layers, width = [(STEEL, 0.002), (RUBBER, 0.02), (STEEL, 0.002)], 0.05
    section = bf.Layered([bf.Layer(*layer) for layer in layers], width)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, bf.CRBF(4), section)
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 0.01))]))
    rest, *_, grid = rows(solution, tmp_path)
    _, stiffness = transformed(layers, width, 0.012)
    glue = 0.01 * 2.1e11 * 0.002 * 0.011 / stiffness
    for layer in range(3):
        cells = np.flatnonzero(grid["layer"] == layer)
        points = np.unique(np.concatenate([grid.get_cell(cell).point_ids for cell in cells]))
        y, sheared = rest.points[points, 1], grid["stress_xy"][points]
        np.testing.assert_allclose(sheared[np.isclose(np.abs(y), 0.01)], glue, rtol=1e-4)
        np.testing.assert_allclose(sheared[np.isclose(np.abs(y), 0.012)], 0.0, atol=1e-9 * glue)


def test_a_beam_may_have_more_layers_on_one_part_than_on_another(tmp_path):
    """A patch on the second half: no cells of it on the first, each half with its own stress."""

    def section(s):
        layers = [bf.Layer(STEEL, 0.01)] + ([bf.Layer(ALUMINIUM, 0.01)] if s > 0.5 + 1e-12 else [])
        return bf.Layered(layers, 0.05, axis=0.005)

    rest, *_, grid = rows(bent(section, 10.0, elements=4), tmp_path)
    assert (np.sort(grid["layer"]) == [0, 0, 0, 0, 1, 1]).all()
    s, y, stress = stresses(grid, rest, 0)
    first = s < 0.5 - 1e-9
    np.testing.assert_allclose(stress[first], -10.0 * y[first] / (0.05 * 0.01**3 / 12), rtol=1e-5, atol=1e2)


def test_layers_of_an_arc_have_resultants_by_quadrature_over_their_cells(tmp_path):
    """Gauss points of each cell of a thick layered arc: the hyperbola of each layer gives M and no N."""
    section = bf.Layered([bf.Layer(STEEL, 0.01), bf.Layer(ALUMINIUM, 0.02)], 0.02)
    arc = bf.Arc((0, 0), 0.1, 0.0, 1.0)
    grid = rows(bent(section, 20.0, curve=arc, elements=6), tmp_path)[-1]
    normal = moment = 0.0
    for layer, ends in enumerate(((-0.015, -0.005), (-0.005, 0.015))):
        cells = np.flatnonzero(grid["layer"] == layer)
        points = np.array(grid.get_cell(cells[0]).point_ids)
        # the start: corners 0 and 3, middle of the left edge
        first, middle, last = grid["stress_xx"][points[[0, 9 if len(points) == 12 else 11, 3]]]
        low, high = ends
        y = np.array([low, 0.5 * (low + high), high])
        weights = (high - low) / 6 * np.array([1.0, 4.0, 1.0]) * 0.02
        values = np.array([first, middle, last])
        normal += weights @ values
        moment -= weights @ (y * values)
    assert moment == pytest.approx(20.0, rel=2e-3)
    assert normal * 0.03 == pytest.approx(0.0, abs=2e-3 * 20.0)


def test_pictures_draw_each_layer_from_face_to_face():
    """Two layers of a straight beam at rest, one growing along it; the bodies touch and fill the section."""

    def section(s):
        return bf.Layered((bf.Layer(STEEL, 0.05 + 0.05 * s), bf.Layer(RUBBER, 0.05)), 0.1, axis=0.07)

    solution = bent(section, 1e3, elements=2)
    drawn = Shapes(solution, np.array([0]))
    ((steel, rubber),) = drawn.layers
    s = steel[0, :, 0, 0]
    np.testing.assert_allclose(steel[0, :, :, 1], np.stack([-0.07 + 0 * s, 0.05 * s - 0.02], axis=1), atol=1e-15)
    np.testing.assert_allclose(rubber[0, :, :, 1], np.stack([0.05 * s - 0.02, 0.05 * s + 0.03], axis=1), atol=1e-15)
    scene = body._Scene.__new__(body._Scene)
    scene.shapes = drawn
    faces = body._faces(drawn.points, [len(parts) for parts in scene._parts(0)])
    surface = pyvista.PolyData(scene._points(0), faces).triangulate()
    assert surface.volume == pytest.approx(0.1 * (0.1 + 0.15) / 2, rel=1e-6)
    figure = solution.plot(shapes=1)
    fills = [artist for artist in figure.axes[0].collections if type(artist).__name__ == "PolyCollection"]
    assert len({tuple(colour) for colour in fills[0].get_facecolors()}) == 2


def test_vtkhdf_numbers_layers_as_the_vtu_files_do(tmp_path):
    section = bf.Layered([bf.Layer(STEEL, 0.01), bf.Layer(ALUMINIUM, 0.03)], 0.05)
    solution = bent(section, 50.0)
    grid = rows(solution, tmp_path)[-1]
    solution.to_vtk(tmp_path / "one.vtkhdf")
    import h5py

    with h5py.File(tmp_path / "one.vtkhdf") as file:
        np.testing.assert_array_equal(file["VTKHDF/CellData/layer"], grid["layer"])
        offsets, stress = (
            file["VTKHDF/Offsets"][:-1],
            file["VTKHDF/PointData/stress_xx"][-file["VTKHDF/NumberOfPoints"][0] :],
        )
        corners = np.array([grid.get_cell(cell).point_ids[:4] for cell in range(grid.n_cells)])
        np.testing.assert_allclose(stress[offsets[:, None] + np.arange(4)], grid["stress_xx"][corners], rtol=1e-12)


def test_on_a_face_between_layers_the_upper_one_is_stressed():
    """The axis is on it; pulled without bending, both have one strain: N / (E_1 A_1 + E_2 A_2) at the neutral axis."""
    section = bf.Layered([bf.Layer(STEEL, 0.02), bf.Layer(ALUMINIUM, 0.06)], 0.05, axis=0.02)
    first = (-STEEL.youngs_modulus * 0.02**2 + ALUMINIUM.youngs_modulus * 0.06**2) / 2
    axial = STEEL.youngs_modulus * 0.02 + ALUMINIUM.youngs_modulus * 0.06
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), section)
    # a force at the neutral axis, as a force and a moment about the axis
    loads = [bf.PointForce(beam.end, (1e3, 0.0)), bf.PointMoment(beam.end, -1e3 * first / axial)]
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], loads))
    stress = solution.fields(beam.at(0.5)).stress.xx[-1]
    assert stress == pytest.approx(ALUMINIUM.youngs_modulus * 1e3 / (axial * 0.05), rel=1e-5)


def test_faces_are_those_of_the_layers_that_are_there():
    """Two layers up to the middle and three behind it: the third has no thickness in front, on top of the second."""
    thickness = (0.02, 0.03, 0.04)
    two, three = (bf.Layered([bf.Layer(STEEL, h) for h in thickness[:n]], 0.1, axis=0.01) for n in (2, 3))
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), lambda s: two if s < 0.5 else three)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 1.0))])
    points = AxisPoints.spaced(model.mesh_of(beam.start), 1)
    np.testing.assert_allclose(points.faces, [[-0.01, 0.04]] * 2 + [[-0.01, 0.08]] * 2, atol=1e-15)
    np.testing.assert_allclose(points.layers[0], [[-0.01, 0.01], [0.01, 0.04], [0.04, 0.04]], atol=1e-15)
