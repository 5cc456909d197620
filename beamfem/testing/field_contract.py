"""Check of a field: nodal values interpolate, rigid motions and constant strains are represented."""

from typing import NoReturn

import numpy as np

from beamfem.element.fields import Field, require_field, rule_of, shape_functions

_PLACES = np.array([0.0371, 0.2718, 0.4142, 0.5772, 0.8319, 0.9634])  # arbitrary, inside of an element
_STEP = 1e-5  # of central differences
_EXACT, _SLOPES = 1e-6, 1e-5  # agreement of values, as high orders lose digits, and of derivatives with differences


def check_field(field: Field) -> None:
    """Check that the shape functions of a user-defined field interpolate and represent constant strains.

    A shape function is 1 at its own node and 0 at the others; with `r_x`, so is its slope. Sums represent a rigid
    translation and a constant stretch. Derivatives are those by differences, and `director_rule` integrates linear
    functions over the nodes.

    Parameters
    ----------
    field : Field
        Field on the unit element, see `beamfem.element.fields.Field`.

    Raises
    ------
    AssertionError
        If a shape function is inconsistent; the message names which one and where.
    InputError
        If members are missing or return arrays of another shape.

    Examples
    --------
    >>> from beamfem.testing import check_field
    >>> class Rough(bf.Lagrange):
    ...     def director(self, xi, derivative=0):
    ...         return 1.01 * super().director(xi, derivative)
    >>> try:
    ...     check_field(Rough(2))
    ... except AssertionError as error:
    ...     print(error)
    the field Rough: director(xi)[:, 0] must be 1 at its node and 0 at the others, got 1.01 at node 0, xi = 0
    """
    require_field(field)
    nodes = field.nodes
    per_node = len(field.vectors) - 1  # all but r_y belong to the centreline
    eye, none = np.eye(len(nodes)), np.zeros((len(nodes), len(nodes)))
    _require_nodal(field, "centreline", 0, slice(0, None, per_node), eye)
    if per_node == 2:
        _require_nodal(field, "centreline", 0, slice(1, None, 2), none)
        _require_nodal(field, "centreline", 1, slice(0, None, 2), none)
        _require_nodal(field, "centreline", 1, slice(1, None, 2), eye)
    values = shape_functions(field, "centreline", _PLACES, 0)
    of_r = values[:, ::per_node]
    linear, said = of_r @ nodes, "centreline(xi)"
    if per_node == 2:
        linear, said = linear + values[:, 1::2].sum(axis=1), f"{said}[:, ::2]"
    _require_sum(field, said, "1", of_r.sum(axis=1), 1.0)
    said = f"the nodes times {said}" + (" and of centreline(xi)[:, 1::2]" if per_node == 2 else "")
    _require_sum(field, said, "xi, as in a constant stretch", linear, _PLACES)
    _require_nodal(field, "director", 0, slice(None), eye)
    _require_sum(field, "director(xi)", "1", shape_functions(field, "director", _PLACES, 0).sum(axis=1), 1.0)
    for name, order in (("centreline", 1), ("centreline", 2), ("director", 1)):
        _require_derivative(field, name, order)
    _require_rule(field, nodes)


def _require_nodal(field: Field, name: str, order: int, columns: slice, right: np.ndarray) -> None:
    """Compare shape functions at the nodes, or their derivatives, with what they must be there (nn, nn)."""
    nodes = field.nodes
    table = shape_functions(field, name, nodes, order)
    wrong = np.abs(table[:, columns] - right)
    if wrong.max() > _EXACT:
        node, column = np.argwhere(wrong > _EXACT)[0].tolist()
        number = range(table.shape[1])[columns][column]
        what = "must be 1 at its node and 0 at the others" if right.any() else "must be 0 at all nodes"
        _refuse(
            field,
            f"{_called(name, order)}[:, {number}] {what}, got {table[node, number]:.6g} at node {node}, "
            f"xi = {nodes[node]:g}",
        )


def _require_sum(field: Field, said: str, right: str, found: np.ndarray, wanted: np.ndarray | float) -> None:
    wrong = np.abs(found - wanted)
    if wrong.max() > _EXACT:
        worst = int(wrong.argmax())
        _refuse(field, f"the sum of {said} must be {right}, got {found[worst]:.6g} at xi = {_PLACES[worst]:g}")


def _require_derivative(field: Field, name: str, order: int) -> None:
    exact = shape_functions(field, name, _PLACES, order)
    ends = [shape_functions(field, name, _PLACES + side * _STEP, order - 1) for side in (1.0, -1.0)]
    slopes = (ends[0] - ends[1]) / (2.0 * _STEP)
    wrong = np.abs(exact - slopes) > _SLOPES * max(1.0, np.abs(slopes).max())
    if wrong.any():
        index, column = np.argwhere(wrong)[0].tolist()
        _refuse(
            field,
            f"{_called(name, order)}[:, {column}] is no derivative of {_called(name, order - 1)}[:, {column}]: at "
            f"xi = {_PLACES[index]:g} it is {exact[index, column]:.6g}, by differences {slopes[index, column]:.6g}",
        )


def _require_rule(field: Field, nodes: np.ndarray) -> None:
    points, weights = rule_of(field)
    said = (
        f"director_rule() must return the nodes ({len(nodes)},) and weights ({len(nodes)},) of a quadrature on [0, 1]"
    )
    if np.abs(points - nodes).max() > _EXACT:
        _refuse(field, f"{said}, got the nodes {points}")
    for power, right in ((0, 1.0), (1, 0.5)):
        mean = float(weights @ points**power)
        if not abs(mean - right) <= _EXACT:
            _refuse(field, f"{said}: its integral of xi^{power} must be {right:g}, got {mean:.6g}")


def _called(name: str, order: int) -> str:
    return f"{name}(xi, derivative={order})" if order else f"{name}(xi)"


def _refuse(field: object, what: str) -> NoReturn:
    raise AssertionError(f"the field {type(field).__name__}: {what}")
