"""Checks of a user's field: nodal values interpolate, rigid motions and constant strains are represented."""

from typing import Any, NoReturn

import numpy as np

from beamfem.element.fields import Cubic, Field, Lagrange
from beamfem.errors import InputError
from beamfem.validation import called, count, fulfils, members, shown, text

_VECTORS = (("r", "r_y"), ("r", "r_x", "r_y"))
_PLACES = np.array([0.0371, 0.2718, 0.4142, 0.5772, 0.8319, 0.9634])  # arbitrary, inside of an element
_STEP = 1e-5  # of central differences
_EXACT, _SLOPES = 1e-6, 1e-5  # agreement of values, as high orders lose digits, and of derivatives with differences
_ENDS = 1e-12


def require_field(field: Any) -> None:
    """Raise InputError if a field that is not of the package cannot be that of an element."""
    if type(field) in (Cubic, Lagrange):  # elements of the package are made in microseconds
        return
    if not fulfils(field, Field):
        missing = [name for name in members(Field) if not hasattr(field, name)]
        raise InputError(
            "field of an element must be Cubic, Lagrange or an object with all members of "
            "beamfem.element.fields.Field, got "
            f"{shown(field)}{' without ' + ', '.join(missing) if missing else ': it is a class'}"
        )
    if type(field).__hash__ is not None:
        try:
            hash(field)
        except TypeError as error:
            _refuse(
                field, f"elements are compared by their fields, but {error}; let it hold tuples, not arrays or lists"
            )
    text(f"name of the field {type(field).__name__}", field.name)
    if not isinstance(field.vectors, tuple) or field.vectors not in _VECTORS:
        _refuse(field, f"vectors must be {_VECTORS[0]} or {_VECTORS[1]}, got {shown(field.vectors)}")
    for name in ("degree", "director_degree"):
        count(f"{name} of the field {type(field).__name__}", getattr(field, name))
    nodes = _nodes(field)
    per_node = len(field.vectors) - 1  # all but r_y belong to the centreline
    eye, none = np.eye(len(nodes)), np.zeros((len(nodes), len(nodes)))
    _require_nodal(field, "centreline", 0, slice(0, None, per_node), eye)
    if per_node == 2:
        _require_nodal(field, "centreline", 0, slice(1, None, 2), none)
        _require_nodal(field, "centreline", 1, slice(0, None, 2), none)
        _require_nodal(field, "centreline", 1, slice(1, None, 2), eye)
    values = _table(field, "centreline", _PLACES, 0)
    of_r = values[:, ::per_node]
    linear, said = of_r @ nodes, "centreline(xi)"
    if per_node == 2:
        linear, said = linear + values[:, 1::2].sum(axis=1), f"{said}[:, ::2]"
    _require_sum(field, said, "1", of_r.sum(axis=1), 1.0)
    said = f"the nodes times {said}" + (" and of centreline(xi)[:, 1::2]" if per_node == 2 else "")
    _require_sum(field, said, "xi, as in a constant stretch", linear, _PLACES)
    _require_nodal(field, "director", 0, slice(None), eye)
    _require_sum(field, "director(xi)", "1", _table(field, "director", _PLACES, 0).sum(axis=1), 1.0)
    for name, order in (("centreline", 1), ("centreline", 2), ("director", 1)):
        _require_derivative(field, name, order)
    _require_rule(field, nodes)


def _nodes(field: Field) -> np.ndarray:
    nodes: Any = field.nodes
    valid = isinstance(nodes, np.ndarray) and nodes.dtype.kind in "fiu" and nodes.ndim == 1 and len(nodes) > 1
    if not valid or not np.isfinite(nodes).all() or np.any(np.diff(nodes) <= 0.0):
        _refuse(field, f"nodes must be an array of two or more increasing numbers, got {shown(nodes)}")
    if np.abs(nodes[[0, -1]] - [0.0, 1.0]).max() > _ENDS:
        _refuse(field, f"nodes must begin at 0 and end at 1, the ends of an element, got {nodes[0]:g} to {nodes[-1]:g}")
    return nodes


def _table(field: Field, name: str, xi: np.ndarray, order: int) -> np.ndarray:
    """Return the shape functions (n, k) of a field at xi (n,), or a derivative of them."""
    kind = type(field).__name__
    width = len(field.nodes) * (1 if name == "director" else len(field.vectors) - 1)
    # a copy, as it may change its argument
    table = np.asarray(called(f"{name} of the field {kind}", getattr(field, name), xi.copy(), order))
    if table.shape != (len(xi), width) or table.dtype.kind != "f" or not np.isfinite(table).all():
        said = f"{table.dtype} {table.shape}"
        _refuse(
            field,
            f"{name}(xi, derivative={order}) of {len(xi)} points must be an array ({len(xi)}, {width}) of finite "
            f"numbers, got {said if table.shape != (len(xi), width) or table.dtype.kind != 'f' else shown(table)}",
        )
    return table


def _require_nodal(field: Field, name: str, order: int, columns: slice, right: np.ndarray) -> None:
    """Compare shape functions at the nodes, or their derivatives, with what they must be there (nn, nn)."""
    nodes = field.nodes
    table = _table(field, name, nodes, order)
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
    exact = _table(field, name, _PLACES, order)
    ends = [_table(field, name, _PLACES + side * _STEP, order - 1) for side in (1.0, -1.0)]
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
    rule = called(f"director_rule of the field {type(field).__name__}", field.director_rule)
    said = (
        f"director_rule() must return the nodes ({len(nodes)},) and weights ({len(nodes)},) of a quadrature on [0, 1]"
    )
    try:
        points, weights = (np.asarray(part, dtype=float) for part in rule)
    except (TypeError, ValueError):
        _refuse(field, f"{said}, got {shown(rule)}")
    if points.shape != nodes.shape or weights.shape != nodes.shape or np.abs(points - nodes).max() > _EXACT:
        _refuse(field, f"{said}, got {shown(rule)}")
    for power, right in ((0, 1.0), (1, 0.5)):
        mean = float(weights @ points**power)
        if not abs(mean - right) <= _EXACT:
            _refuse(field, f"{said}: its integral of xi^{power} must be {right:g}, got {mean:.6g}")


def _called(name: str, order: int) -> str:
    return f"{name}(xi, derivative={order})" if order else f"{name}(xi)"


def _refuse(field: object, what: str) -> NoReturn:
    raise InputError(f"the field {type(field).__name__}: {what}")
