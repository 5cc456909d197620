"""The scikit-fem element that carries a whole field: nodality, partition of unity, gradients."""

import numpy as np
import pytest
from skfem import MeshLine

from beamfem.element.fields import BeamMapping, Cubic, FieldElement, Lagrange

FIELDS = [Cubic(), Lagrange(1), Lagrange(2), Lagrange(3)]


@pytest.fixture(params=FIELDS, ids=lambda field: field.name)
def on_line(request) -> tuple[FieldElement, BeamMapping, np.ndarray]:
    """An element, a mapping of two different lengths, and element lengths."""
    return (
        FieldElement(request.param),
        BeamMapping(MeshLine(np.array([1000.0, 1000.25, 1000.95]))),
        np.array([0.25, 0.7]),
    )


def functions(element: FieldElement) -> range:
    return range(element.nodal_dofs * 2 + element.interior_dofs)


def test_element_is_a_partition_of_unity(on_line):
    element, mapping, _ = on_line
    points = np.array([[0.0, 0.13, 0.6, 1.0], [0.3, -0.2, 0.0, 0.1]])
    for name, constant in (("r", 1.0), ("r_y", points[1])):
        for axis in range(2):
            own = [i for i in functions(element) if element.place(i)[2] == axis]
            own = [i for i in own if element.field.vectors[element.place(i)[1]] == name]
            total = sum(element.gbasis(mapping, points, i)[0] for i in own)
            np.testing.assert_allclose(total[axis], np.broadcast_to(constant, total[axis].shape), atol=1e-14)
            np.testing.assert_array_equal(total[1 - axis], 0.0)


def test_element_is_nodal(on_line):
    element, mapping, lengths = on_line
    nodes = np.stack([element.field.nodes, np.zeros(len(element.field.nodes))])
    for i in functions(element):
        node, vector, axis = element.place(i)
        field = element.gbasis(mapping, nodes, i)[0]
        values = {"r": np.asarray(field), "r_x": field.grad[:, 0], "r_y": field.grad[:, 1]}
        for number, name in enumerate(element.field.vectors):
            expected = np.zeros((2, len(lengths), nodes.shape[1]))
            if number == vector:
                expected[axis, :, node] = 1.0
            np.testing.assert_allclose(values[name], expected, atol=1e-13)


def test_element_gradient_is_the_derivative(on_line):
    element, mapping, lengths = on_line
    points, step = np.array([[0.21, 0.5, 0.83], [0.3, -0.2, 0.1]]), 1e-5
    for i in functions(element):
        grad = element.gbasis(mapping, points, i)[0].grad
        for row, size in ((0, lengths[:, None]), (1, 1.0)):
            shift = step * np.eye(2)[row][:, None]
            high, low = (np.asarray(element.gbasis(mapping, points + sign * shift, i)[0]) for sign in (1, -1))
            np.testing.assert_allclose((high - low) / (2.0 * step * size), grad[:, row], atol=1e-8)


def test_element_index_and_numbers(on_line):
    element, mapping, _ = on_line
    assert len(element.dofnames) == element.nodal_dofs + element.interior_dofs
    assert element.doflocs.shape == (len(functions(element)), 1)
    with pytest.raises(ValueError, match="Index"):
        element.gbasis(mapping, np.array([[0.5]]), len(functions(element)))


def test_axis_is_where_y_is_not_given(on_line):
    element, mapping, _ = on_line
    xi = np.array([[0.1, 0.7]])
    for i in functions(element):
        on_axis = element.gbasis(mapping, xi, i, tind=np.array([1]))[0]
        both = element.gbasis(mapping, np.vstack([xi, 0.0 * xi]), i)[0]
        np.testing.assert_array_equal(np.asarray(on_axis), np.asarray(both)[:, 1:])
        np.testing.assert_array_equal(on_axis.grad, both.grad[:, :, 1:])


def test_mapping_keeps_y():
    mapping = BeamMapping(MeshLine(np.array([0.0, 2.0, 3.0])))
    expected = np.array([[[1.0, 2.0], [2.5, 3.0]], [[5.0, 6.0], [5.0, 6.0]]])
    np.testing.assert_allclose(mapping.F(np.array([[0.5, 1.0], [5.0, 6.0]])), expected)


def test_cubic_shape_functions_of_the_paper():
    """Eq. (4): s1 to s6 with xi = x / l, eta = y / l."""
    length, x, y = 0.8, np.array([0.1, 0.37, 0.8]), np.array([0.02, -0.05, 0.04])
    xi, eta = x / length, y / length
    paper = [
        1 - 3 * xi**2 + 2 * xi**3,
        length * (xi - 2 * xi**2 + xi**3),
        eta * length * (1 - xi),
        3 * xi**2 - 2 * xi**3,
        length * (-(xi**2) + xi**3),
        xi * eta * length,
    ]
    mapping = BeamMapping(MeshLine(np.array([0.0, length])))
    for i, expected in enumerate(paper):
        value = np.asarray(FieldElement(Cubic()).gbasis(mapping, np.stack([xi, y]), 2 * i)[0])
        np.testing.assert_allclose(value[0, 0], expected, atol=1e-15)
