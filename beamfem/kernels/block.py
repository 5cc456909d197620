"""The plain data that a compiled kernel needs of a group of like elements."""

from typing import NamedTuple

import numpy as np

# What carries the nodal vectors of a node, see `node_map`.
GRADIENTS = 0
ROTATION = 1
STRETCH = 2
SHEAR_RIGID = 3
TURNED_GRADIENTS = 4

# Strain measures, see `measures`.
GREEN_LAGRANGE = 0
STRUCTURAL = 1
ELASTIC_LINE = 2


class Block(NamedTuple):
    """Elements of one field and one kind of strain measures.

    Sizes: ne elements, nc classes of identical elements, nq quadrature points, nn nodes an element, nv nodal vectors
    an element (nr of them carry r0, nd carry d), npn coordinates a node at most, ns strain measures.
    """

    measures: int  # GREEN_LAGRANGE, STRUCTURAL or ELASTIC_LINE
    r_slots: np.ndarray  # (nr,) which nodal vectors carry r0
    d_slots: np.ndarray  # (nd,) which nodal vectors carry d
    r_xi: np.ndarray  # (nq, nr) dN_r/dxi on the unit element
    r_xixi: np.ndarray  # (nq, nr) d2N_r/dxi2
    d: np.ndarray  # (nq, nd) N_d
    d_xi: np.ndarray  # (nq, nd) dN_d/dxi
    column_start: np.ndarray  # (carriers, npn) first component of a node's e that a coordinate moves
    column_stop: np.ndarray  # (carriers, npn) one past the last
    kind: np.ndarray  # (ne,) class of an element
    scale: np.ndarray  # (nc, nv) factor of a nodal vector: 1, or the mesh length where it is a gradient [m]
    jacobian: np.ndarray  # (nc, nq) ds/dxi of the reference [m]
    jacobian_xi: np.ndarray  # (nc, nq) its derivative [m]
    weight: np.ndarray  # (nc, nq) quadrature weight times ds/dxi [m]
    stiffness: np.ndarray  # (nc, nq, ns, ns) section stiffness
    reference: np.ndarray  # (nc, nq, ns) strain measures of the stress-free state
    mass: np.ndarray  # (nc, nv, nv) scalar consistent mass, one entry a pair of nodal vectors [kg]
    gravity: np.ndarray  # (nc, nv) mass carried by a nodal vector under a uniform acceleration [kg]
    length: np.ndarray  # (nc, nv) integral of N_r over the reference length [m]
    carrier: np.ndarray  # (ne, nn) what carries the nodal vectors of each node
    frame: np.ndarray  # (ne, nn, 3) cosine and sine of the node's angle, |r_x| in the reference; see `node_map`
    dof: np.ndarray  # (ne, nn * npn) coordinates of an element, -1 where a node has fewer
    beam: np.ndarray  # (ne,) beam that an element belongs to


class PointLoads(NamedTuple):
    """Forces, moments and springs to the ground at points of elements; forces come with each call."""

    element: np.ndarray  # (nl,) element
    position: np.ndarray  # (nl, nv) r0 = sum position_i e_i
    direction: np.ndarray  # (nl, nv) vector that gives the section its direction: d, or r_x
    follows: np.ndarray  # (nl, 2) direction's unit vector in the reference if the force turns with it, else zero
    spring: np.ndarray  # (nl, 2) stiffness against displacement [N/m]
    anchor: np.ndarray  # (nl, 2) where the spring is at rest [m]


class Layout(NamedTuple):
    """Where the entries of a block's element matrices go: into a band, or into slots of a sparse matrix."""

    free: np.ndarray  # (n,) number of a coordinate among the unknown ones, -1 where it is prescribed
    half_width: int  # of the band, -1 where the matrix is sparse
    slot: np.ndarray  # (ne, npe, npe) position in the data of a CSC matrix, empty for a band


class Springs(NamedTuple):
    """Springs of single coordinates to the ground."""

    dof: np.ndarray  # (ns,) coordinate
    stiffness: np.ndarray  # (ns,) [N/m] or [N m/rad]
    rest: np.ndarray  # (ns,) coordinate of the spring at rest
    place: np.ndarray  # (ns,) of the coordinate's diagonal entry in the matrix, -1 where it is held
