"""Shape functions of a field at the points that integrate energy and mass."""

from typing import NamedTuple

import numpy as np

from beamfem.element.fields import Field, d_slots, r_slots
from beamfem.quadrature import gauss


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
