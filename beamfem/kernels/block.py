"""The plain data that a compiled kernel needs of a group of equal elements."""

from typing import NamedTuple

import numpy as np

# Nodal coordinates, see `node_map`.
GRADIENTS = 0
ROTATION = 1

# Strain measures, see `measures`.
GREEN_LAGRANGE = 0
STRUCTURAL = 1


class Block(NamedTuple):
    """Elements of one field, one kind of coordinates and one kind of strain measures.

    Sizes: ne elements, nc classes of identical elements, nq quadrature points, nn nodes an element, nv nodal vectors
    an element (nr of them carry r0, nd carry d), npn coordinates a node, ns strain measures.
    """

    coordinates: int  # GRADIENTS or ROTATION
    measures: int  # GREEN_LAGRANGE or STRUCTURAL
    r_slots: np.ndarray  # (nr,) which nodal vectors carry r0
    d_slots: np.ndarray  # (nd,) which nodal vectors carry d
    r_xi: np.ndarray  # (nq, nr) dN_r/dxi on the unit element
    d: np.ndarray  # (nq, nd) N_d
    d_xi: np.ndarray  # (nq, nd) dN_d/dxi
    column_start: np.ndarray  # (npn,) first component of a node's e that this coordinate moves
    column_stop: np.ndarray  # (npn,) one past the last
    kind: np.ndarray  # (ne,) class of an element
    scale: np.ndarray  # (nc, nv) factor of a nodal vector: 1, or the mesh length where it is a gradient [m]
    jacobian: np.ndarray  # (nc, nq) ds/dxi of the reference [m]
    weight: np.ndarray  # (nc, nq) quadrature weight times ds/dxi [m]
    stiffness: np.ndarray  # (nc, nq, ns, ns) section stiffness
    reference: np.ndarray  # (nc, nq, ns) strain measures of the stress-free state
    mass: np.ndarray  # (nc, nv, nv) scalar consistent mass, one entry a pair of nodal vectors [kg]
    gravity: np.ndarray  # (nc, nv) mass carried by a nodal vector under a uniform acceleration [kg]
    length: np.ndarray  # (nc, nv) integral of N_r over the reference length [m]
    frame: np.ndarray  # (ne, nn, 2) cosine and sine of the section's angle in the reference
    dof: np.ndarray  # (ne, nn * npn) coordinates of an element
    beam: np.ndarray  # (ne,) beam that an element belongs to


class PointLoads(NamedTuple):
    """Forces and moments at points of elements; their sizes come with each call."""

    element: np.ndarray  # (nl,) element
    r: np.ndarray  # (nl, nr) N_r at the point, scaled
    d: np.ndarray  # (nl, nd) N_d at the point


class Layout(NamedTuple):
    """Where the entries of element matrices go: into a band, or into slots of a sparse matrix."""

    free: np.ndarray  # (n,) number of a coordinate among the unknown ones, -1 where it is prescribed
    half_width: int  # of the band
    slot: np.ndarray  # (ne, npe, npe) position in the data of a CSC matrix, empty for a band
