"""Requirements of user-defined fields: members, nodes, shapes of tables."""

from typing import Any, NoReturn

import numpy as np

from beamfem.element.fields import Cubic, Field, Lagrange
from beamfem.errors import InputError
from beamfem.validation import called, count, fulfils, members, shown, text

_VECTORS = (("r", "r_y"), ("r", "r_x", "r_y"))
_ENDS = 1e-12


def require_field(field: Any) -> None:
    """Raise InputError if a field that is not of the package lacks members, or its tables have another shape."""
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
    for name, orders in (("centreline", 3), ("director", 2)):
        for order in range(orders):
            shape_functions(field, name, nodes, order)
    rule_of(field)


def _nodes(field: Field) -> np.ndarray:
    nodes: Any = field.nodes
    valid = isinstance(nodes, np.ndarray) and nodes.dtype.kind in "fiu" and nodes.ndim == 1 and len(nodes) > 1
    if not valid or not np.isfinite(nodes).all() or np.any(np.diff(nodes) <= 0.0):
        _refuse(field, f"nodes must be an array of two or more increasing numbers, got {shown(nodes)}")
    if np.abs(nodes[[0, -1]] - [0.0, 1.0]).max() > _ENDS:
        _refuse(field, f"nodes must begin at 0 and end at 1, the ends of an element, got {nodes[0]:g} to {nodes[-1]:g}")
    return nodes


def shape_functions(field: Field, name: str, xi: np.ndarray, order: int) -> np.ndarray:
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


def rule_of(field: Field) -> tuple[np.ndarray, np.ndarray]:
    """Return nodes and weights (nn,) of the quadrature of a field. Raises InputError for another shape."""
    rule = called(f"director_rule of the field {type(field).__name__}", field.director_rule)
    try:
        points, weights = (np.asarray(part, dtype=float) for part in rule)
        if points.shape == weights.shape == (len(field.nodes),) and np.isfinite([points, weights]).all():
            return points, weights
    except (TypeError, ValueError):
        pass
    number = len(field.nodes)
    _refuse(field, f"director_rule() must return the nodes ({number},) and weights ({number},), got {shown(rule)}")


def _refuse(field: object, what: str) -> NoReturn:
    raise InputError(f"the field {type(field).__name__}: {what}")
