"""Field bases r(x, y) = r0(x) + y d(x) on the unit interval, their tables, values, and scikit-fem elements."""

from dataclasses import dataclass
from functools import lru_cache
from itertools import combinations
from math import factorial
from typing import Any, ClassVar, NamedTuple, NoReturn, Protocol, runtime_checkable

import numpy as np
from skfem import Element, MappingAffine
from skfem.element import DiscreteField
from skfem.refdom import RefLine

from beamfem.errors import InputError
from beamfem.quadrature import gauss
from beamfem.validation import called, count, fulfils, members, shown, text


class Axis(NamedTuple):
    """r0, r0', r0'', d and d' (..., 2) at points of the axis; primes are by arc length of the reference."""

    r: np.ndarray
    r_s: np.ndarray
    r_ss: np.ndarray
    d: np.ndarray
    d_s: np.ndarray


def dot(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return the inner product over the last axis."""
    return np.asarray((u * v).sum(axis=-1))


def cross(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Return the planar cross product over the last axis."""
    return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])


def section_frame(d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the unit vectors along the section's normal and along d (..., 2)."""
    across = d / np.linalg.norm(d, axis=-1, keepdims=True)
    return np.stack([across[..., 1], -across[..., 0]], axis=-1), across


HIGHEST_ORDER = 8


@runtime_checkable
class Field(Protocol):
    """A field basis, with the members that an element needs; all tables refer to the unit element, xi in [0, 1]."""

    @property
    def name(self) -> str: ...
    @property
    def nodes(self) -> np.ndarray: ...  # (nn,) xi of the nodes
    @property
    def vectors(self) -> tuple[str, ...]: ...  # nodal vectors, of "r", "r_x", "r_y"
    @property
    def degree(self) -> int: ...  # polynomial degree of r0
    @property
    def director_degree(self) -> int: ...  # polynomial degree of d

    def centreline(self, xi: np.ndarray, derivative: int = 0) -> np.ndarray:
        """Return the shape functions (nq, nr) of the centreline r0, or a derivative of them up to the second.

        They belong to the nodal vectors that interpolate it, node by node; xi (nq,): positions on the unit element.
        """

    def director(self, xi: np.ndarray, derivative: int = 0) -> np.ndarray:
        """Return the shape functions (nq, nd) of the director d, or a derivative of them; see `centreline`."""

    def director_rule(self) -> tuple[np.ndarray, np.ndarray]: ...  # nodes of d (nd,) and weights (nd,) on [0, 1]


def r_slots(field: Field) -> np.ndarray:
    """Return the indices (nr,) of the nodal vectors of an element that interpolate r0, as in `Field.centreline`."""
    return slots(field.vectors, len(field.nodes), ("r", "r_x"))


def d_slots(field: Field) -> np.ndarray:
    """Return the indices (nd,) of the nodal vectors of an element that interpolate d, as in `Field.director`."""
    return slots(field.vectors, len(field.nodes), ("r_y",))


@lru_cache
def slots(vectors: tuple[str, ...], nodes: int, wanted: tuple[str, ...]) -> np.ndarray:
    """Return the indices (k,) of the wanted nodal vectors among those of an element."""
    chosen = [n * len(vectors) + i for n in range(nodes) for i, name in enumerate(vectors) if name in wanted]
    indices = np.array(chosen, dtype=np.int64)
    indices.setflags(write=False)
    return indices


@dataclass(frozen=True)
class Cubic:
    """Hermite cubics in r and r_x, linear in r_y. Source: paper, eqs. (2) to (4); Omar and Shabana 2001."""

    name: ClassVar[str] = "cubic"
    vectors: ClassVar[tuple[str, ...]] = ("r", "r_x", "r_y")
    degree: ClassVar[int] = 3
    director_degree: ClassVar[int] = 1

    @property
    def nodes(self) -> np.ndarray:
        """Nodes (nn,) of an element, as xi in [0, 1]."""
        return np.array([0.0, 1.0])

    def centreline(self, xi: np.ndarray, derivative: int = 0) -> np.ndarray:
        """Return the Hermite cubics (nq, 4) for r and r_x of both nodes, or a derivative; paper, eqs. (2) to (4).

        >>> bf.Cubic().centreline(np.array([0.5]))
        array([[ 0.5  ,  0.125,  0.5  , -0.125]])
        """
        points = np.asarray(xi, dtype=float)
        return _hermite(points.tobytes(), points.shape, derivative).copy()

    def director(self, xi: np.ndarray, derivative: int = 0) -> np.ndarray:
        """Return 1 - xi and xi (nq, 2) for r_y of both nodes, or a derivative; see `Field.director`."""
        return Lagrange(1).director(xi, derivative)

    def director_rule(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the nodes (nd,) of the director on [0, 1], and the weights (nd,) of a quadrature there."""
        return Lagrange(1).director_rule()


@lru_cache(maxsize=128)
def _hermite(points: bytes, shape: tuple[int, ...], derivative: int) -> np.ndarray:
    """Return the Hermite cubics (*shape, 4) at points in [0, 1], given as bytes, or a derivative."""
    xi = np.frombuffer(points).reshape(shape)
    one = np.ones_like(xi)
    if derivative == 0:
        rows = (1 - 3 * xi**2 + 2 * xi**3, xi - 2 * xi**2 + xi**3, 3 * xi**2 - 2 * xi**3, xi**3 - xi**2)
    elif derivative == 1:
        rows = (6 * xi**2 - 6 * xi, 1 - 4 * xi + 3 * xi**2, 6 * xi - 6 * xi**2, 3 * xi**2 - 2 * xi)
    else:
        rows = (12 * xi - 6 * one, 6 * xi - 4 * one, 6 * one - 12 * xi, 6 * xi - 2 * one)
    return np.stack(rows, axis=-1)


@lru_cache
def _lobatto(order: int) -> np.ndarray:
    """Return the Gauss-Lobatto nodes (order + 1,) on [0, 1]."""
    # their interpolated slope is accurate to one order more at the Gauss points, which curved beams need
    inner = np.polynomial.legendre.Legendre.basis(order).deriv().roots()
    return np.concatenate([[0.0], 0.5 + 0.5 * np.sort(inner.real), [1.0]])


# frames of many members need the same points repeatedly
@lru_cache(maxsize=128)
def _table(order: int, points: bytes, shape: tuple[int, ...], derivative: int) -> np.ndarray:
    """Return the derivatives (*shape, order + 1) of the polynomials at points in [0, 1], given as bytes."""
    nodes = _lobatto(order)
    factors = np.subtract.outer(np.frombuffer(points).reshape(shape), nodes)
    columns = []
    for i, node in enumerate(nodes):
        others = np.delete(np.arange(len(nodes)), i)
        # the k-th derivative of a product is the sum over all ordered choices of k factors that are left out
        parts = [
            factors[..., [j for j in others if j not in left_out]].prod(axis=-1)
            for left_out in combinations(others, derivative)
        ]
        columns.append(factorial(derivative) * sum(parts) / np.prod(node - nodes[others]))
    return np.stack(np.broadcast_arrays(*columns, factors[..., 0])[:-1], axis=-1)


@dataclass(frozen=True)
class Lagrange:
    """Polynomials of one order in r and in r_y through Gauss-Lobatto nodes.

    Source: paper, eqs. (8) to (10), for order 1.

    Parameters
    ----------
    order : int, default 1
        Polynomial order, 1 to 8.
    """

    order: int = 1
    vectors: ClassVar[tuple[str, ...]] = ("r", "r_y")

    def __post_init__(self) -> None:
        if count("order", self.order) > HIGHEST_ORDER:
            raise InputError(f"order must be at most {HIGHEST_ORDER}, got {self.order}")

    @property
    def name(self) -> str:
        """Name of the field, as part of the names of elements."""
        return "bilinear" if self.order == 1 else f"order{self.order}"

    @property
    def degree(self) -> int:
        """Polynomial degree of the centreline r0."""
        return self.order

    @property
    def director_degree(self) -> int:
        """Polynomial degree of the director d."""
        return self.order

    @property
    def nodes(self) -> np.ndarray:
        """Nodes (nn,) of an element, as xi in [0, 1]."""
        return _lobatto(self.order)

    def centreline(self, xi: np.ndarray, derivative: int = 0) -> np.ndarray:
        """Return the Lagrange polynomials (nq, order + 1) of the Gauss-Lobatto nodes, or a derivative.

        See `Field.centreline`; paper, eqs. (8) to (10), for order 1.

        >>> bf.Lagrange(order=2).centreline(np.array([0.25])).round(3)
        array([[ 0.375,  0.75 , -0.125]])
        """
        points = np.asarray(xi, dtype=float)
        # a copy, so that callers cannot change the cached table
        return _table(self.order, points.tobytes(), points.shape, derivative).copy()

    def director(self, xi: np.ndarray, derivative: int = 0) -> np.ndarray:
        """Return the same as `centreline`, for r_y of each node."""
        return self.centreline(xi, derivative)

    def director_rule(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the nodes (nd,) of the director on [0, 1], and the weights (nd,) of a quadrature there."""
        xi, weights = gauss(self.order + 1)
        return self.nodes, weights @ self.director(xi)


class BeamMapping(MappingAffine):
    """Map xi in [0, 1] to the arc length s [m]; points may carry y [m] in a second row, which stays y."""

    def F(self, X: np.ndarray, tind: np.ndarray | None = None) -> np.ndarray:
        """Return s (1, ne, nq) [m], with y (2, ne, nq) [m] where X has two rows."""
        # MappingAffine broadcasts its 1x1 Jacobian over a second row and returns the sum of both
        s = super().F(X[:1], tind)
        return np.concatenate([s, *(np.broadcast_to(row, s.shape) for row in X[1:])])


class FieldElement(Element):
    """The body r(x, y) = r0(x) + y d(x) [m] as one vector field on a line mesh; paper, eqs. (2) to (4), (8) to (10).

    Nodal values r^x, r^y [m], r_x^x, r_x^y [-] (cubic only), r_y^x, r_y^y [-]; inner nodes are interior to the element.
    At points X = (xi, y) (2, nq) or (2, ne, nq), y [m], grad(u) is the deformation gradient (2, 2, ne, nq); points
    X = (xi,) lie on the axis. Needs a `BeamMapping`.
    """

    refdom = RefLine

    def __init__(self, field: Field) -> None:
        inner = len(field.nodes) - 2
        self.field = field
        self.nodal_dofs = 2 * len(field.vectors)
        self.interior_dofs = inner * self.nodal_dofs
        self.maxdeg = max(field.degree, field.director_degree)
        names = [f"{vector}^{axis}" for vector in field.vectors for axis in "xy"]
        self.dofnames = names + [f"{name}_{node + 1}" for node in range(inner) for name in names]
        places = [self.place(i) for i in range(len(field.nodes) * self.nodal_dofs)]
        self.doflocs = np.array([[field.nodes[node]] for node, _, _ in places])

    def place(self, i: int) -> tuple[int, int, int]:
        """Return node, nodal vector and axis of a basis function; scikit-fem puts end nodes before inner ones."""
        last = len(self.field.nodes) - 1
        rank, component = divmod(i, self.nodal_dofs)
        if not 0 <= rank <= last:
            self._index_error()
        node = (0, last, *range(1, last))[rank]
        return node, component // 2, component % 2

    def gbasis(
        self, mapping: BeamMapping, X: np.ndarray, i: int, tind: np.ndarray | None = None
    ) -> tuple[DiscreteField, ...]:
        """Return value (2, ne, nq) and grad (2, 2, ne, nq) of a basis function, with columns d/ds and d/dy."""
        node, vector, axis = self.place(i)
        h = mapping.detDF(X, tind)
        xi = np.broadcast_to(X[0], h.shape)
        y = np.broadcast_to(X[1] if len(X) > 1 else 0.0, h.shape)
        value, grad = np.zeros((2, *h.shape)), np.zeros((2, 2, *h.shape))
        name = self.field.vectors[vector]
        if name == "r_y":
            shape, slope = (self.field.director(xi, order)[..., node] for order in (0, 1))
            value[axis] = y * shape
            grad[axis, 0], grad[axis, 1] = y * slope / h, shape
        else:
            column = node * (len(self.field.vectors) - 1) + vector
            shape, slope = (self.field.centreline(xi, order)[..., column] for order in (0, 1))
            scale = h if name == "r_x" else 1.0
            value[axis], grad[axis, 0] = scale * shape, scale * slope / h
        return (DiscreteField(value=value, grad=grad),)


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


class Tables(NamedTuple):
    """Shape functions of r0 and d, and their derivatives by xi, for the nodal vectors (nv,) of an element.

    At the points of the energy: slope (nq, nv), first derivatives of r0 and d; curve (nq, nv), second derivatives of
    r0; director (nq, nn), those of d at its nodes. At the points that integrate mass: r, d (points, nv), and their
    products rr, dd, rd (points, nv nv), rd that of r0 and d plus its transpose.
    """

    slope: np.ndarray
    curve: np.ndarray
    director: np.ndarray
    r: np.ndarray
    d: np.ndarray
    rr: np.ndarray
    dd: np.ndarray
    rd: np.ndarray


def length_rule(field: Field) -> tuple[np.ndarray, np.ndarray]:
    """Return points and weights on [0, 1] that integrate mass exactly on a straight prismatic beam."""
    return gauss(max(field.degree, field.director_degree) + 1)


def tables_of(field: Field, xi: np.ndarray) -> Tables:
    """Return the shape functions of a field; xi (nq,): points of the energy."""
    of_r, of_d, count = r_slots(field), d_slots(field), len(field.nodes) * len(field.vectors)
    slope, curve = np.zeros((2, len(xi), count))
    slope[:, of_r], slope[:, of_d] = field.centreline(xi, 1), field.director(xi, 1)
    curve[:, of_r] = field.centreline(xi, 2)
    at, _ = length_rule(field)
    r, d = np.zeros((2, len(at), count))
    r[:, of_r], d[:, of_d] = field.centreline(at), field.director(at)
    rr, dd, rd = (one[:, :, None] * other[:, None, :] for one, other in ((r, r), (d, d), (r, d)))
    products = (product.reshape(len(at), -1) for product in (rr, dd, rd + np.swapaxes(rd, 1, 2)))
    return Tables(slope, curve, np.ascontiguousarray(field.director(xi)), r, d, *products)
