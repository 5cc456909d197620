"""The plain data that a compiled kernel needs of a group of like elements."""

from typing import NamedTuple, Protocol

import numpy as np

# What carries the nodal vectors of a node, see `physics.kinematics`.
GRADIENTS = 0
ROTATION = 1
STRETCH = 2
SHEAR_RIGID = 3
TURNED_GRADIENTS = 4

# Strain measures, see `physics.measures`.
GREEN_LAGRANGE = 0
STRUCTURAL = 1
ELASTIC_LINE = 2


NO_HISTORY = np.empty((0, 0, 0), dtype=np.int64)


class Law(Protocol):
    """What takes the place of the linear law of a block, see `kernels.linear_law`."""

    @property
    def address(self) -> int:
        """Where its pass is; whoever calls it by address keeps this object alive."""
        ...

    def raise_error(self) -> None:
        """Raise what it could not raise in compiled code."""
        ...

    def linearised(self, strain: np.ndarray, history: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return resultants (..., ns) and their derivatives (..., ns, ns) at strains (..., ns) from the reference's.

        history (..., k): committed history variables.
        """
        ...


class Imposed(NamedTuple):
    """Strain measures that loads impose on elements: m loads at most on one of them, ne elements, nq points."""

    load: np.ndarray  # (m, ne) number of a load among all that impose strains, -1 where an element has fewer
    first: np.ndarray  # (m, ne, nq, ns) measures by the factor of a load
    second: np.ndarray  # (m, m, ne, nq, ns) by products of two factors; (0, 0, ne, nq, ns) where there are none

    def at(self, factors: np.ndarray) -> np.ndarray:
        """Return the measures (ne, nq, ns) of loads with these factors (k,)."""
        own = np.append(factors, 0.0)[self.load]
        result = np.einsum("me,meqs->eqs", own, self.first)
        if self.second.size:
            result += np.einsum("me,ke,mkeqs->eqs", own, own, self.second)
        return np.asarray(result)

    def of(self, elements: slice | np.ndarray) -> "Imposed":
        """Return those of some elements."""
        return Imposed(self.load[:, elements], self.first[:, elements], self.second[:, :, elements])


class Block(NamedTuple):
    """Elements of one field and one kind of strain measures.

    Sizes: ne elements, nc classes of identical elements, nq quadrature points, N nodes in all, nn of an element, vpn
    nodal vectors a node (the last is r_y, which carries d; the others carry r0), nv = nn vpn, npn coordinates a node at
    most, ns strain measures.
    """

    measures: int  # GREEN_LAGRANGE, STRUCTURAL or ELASTIC_LINE
    slope: np.ndarray  # (nc, nq, nv) dN/ds, of a gradient times the mesh length
    second: np.ndarray  # (nc, nq, nv) d2N/ds2 of those that carry r0, likewise; empty but for the elastic line
    director: np.ndarray  # (nq, nn) N of those that carry d
    kind: np.ndarray  # (ne,) class of an element
    scale: np.ndarray  # (nc, nv) factor of a nodal vector: 1, or the mesh length where it is a gradient [m]
    jacobian: np.ndarray  # (nc, nq) ds/dxi of the reference [m]
    weight: np.ndarray  # (nc, nq) quadrature weight times ds/dxi [m]
    stiffness: np.ndarray  # (nc, nq, ns, ns) section stiffness, of a law of its own that at zero strain
    reference: np.ndarray  # (nc, nq, ns) strain measures of the stress-free state
    mass: np.ndarray  # (nc, nv, nv) scalar consistent mass, one entry a pair of nodal vectors [kg]
    gravity: np.ndarray  # (nc, nv) mass carried by a nodal vector under a uniform acceleration [kg]
    length: np.ndarray  # (nc, nv) integral of N_r over the reference length [m]
    node: np.ndarray  # (ne, nn) nodes of an element
    beam: np.ndarray  # (ne,) beam that an element belongs to
    node_kind: np.ndarray  # (N,) what carries the nodal vectors of a node
    frame: np.ndarray  # (N, 3) cosine and sine of the node's angle, |r_x| in the reference; see `coordinates`
    dof: np.ndarray  # (N, npn) coordinates of a node, -1 where it has fewer
    home: np.ndarray  # (N, 2) an element of the node, and its place there
    damping: np.ndarray  # (nc,) retardation time [s]: rates of strains add that much of the stiffness
    law: Law | None = None  # instead of the linear one
    imposed: Imposed | None = None  # strains of the state without stress, besides those of the reference
    history: np.ndarray = NO_HISTORY  # (ne, nq, k) coordinates that are history variables of the law

    def history_of(self, elements: slice | np.ndarray) -> np.ndarray:
        """Return the history variables of some elements."""
        return self.history[elements] if self.history.size else self.history

    def resisting(self, stiffness: np.ndarray) -> "Block":
        """Return the block with the linear law of a stiffness (nc, nq, ns, ns)."""
        return self._replace(stiffness=np.ascontiguousarray(stiffness), law=None)

    def linearised(self, strain: np.ndarray, p: np.ndarray) -> np.ndarray:
        """Return the stiffness (ne, nq, ns, ns) at strains (ne, nq, ns) from the reference's, p (n,) with history."""
        return self.stiffness[self.kind] if self.law is None else self.law.linearised(strain, p[self.history])[1]


class PointLoads(NamedTuple):
    """Forces, moments and springs to the ground at points of elements; forces come with each call."""

    element: np.ndarray  # (nl,) element
    position: np.ndarray  # (nl, nv) r0 = sum position_i e_i
    direction: np.ndarray  # (nl, nv) vector that gives the section its direction: d, or r_x
    follows: np.ndarray  # (nl, 2) direction's unit vector in the reference if the force turns with it, else zero
    stretches: np.ndarray  # (nl,) whether a force that turns grows with the length of the direction: pressure
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
    place: np.ndarray  # (ns,) of the coordinate's diagonal entry in the matrix, -1 where it is prescribed
