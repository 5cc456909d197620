"""A field basis as a scikit-fem element on a line mesh, for the forms of `beamfem.forms`."""

import numpy as np
from skfem import Element, MappingAffine
from skfem.element import DiscreteField
from skfem.refdom import RefLine

from beamfem.element.fields import Field


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
