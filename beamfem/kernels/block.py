"""Plain data of a group of like elements, as compiled kernels need them."""

from typing import Any, NamedTuple, Protocol

import numpy as np

# Coordinates on which the nodal vectors of a node depend, see `physics.kinematics`; with gradients they are components.
GRADIENTS = 0
ROTATION = 1
STRETCH = 2
SHEAR_RIGID = 3
ROTATED_GRADIENTS = 4  # gradients, with r_y rotated by the reference angle of the node
COORDINATES = (GRADIENTS, ROTATION, STRETCH, SHEAR_RIGID)  # those of elements

# Strain measures, see `physics.kinematics`.
GREEN_LAGRANGE = 0
STRUCTURAL = 1
ELASTIC_LINE = 2
MEASURES = (GREEN_LAGRANGE, STRUCTURAL, ELASTIC_LINE)


NO_HISTORY = np.empty((0, 0, 0), dtype=np.int64)


class Law(Protocol):
    """A nonlinear section law that replaces the linear one of a block, see `kernels.linear_law`.

    It acts at the first nl of the quadrature points; thickness stretch is linear.
    """

    @property
    def address(self) -> int:
        """Address of its pass, valid as long as this object exists."""
        ...

    @property
    def fields(self) -> dict[str, Any]:
        """Fields of `record.Group` that its pass reads."""
        ...

    @property
    def in_python(self) -> bool:
        """Whether its pass calls Python."""
        ...

    def take_error(self) -> BaseException | None:
        """Return the error that occurred in a call from compiled code, which cannot raise it, if there was one."""
        ...

    def linearised(
        self, strain: np.ndarray, history: np.ndarray, stiffness: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return resultants (ne, nq, ns) and their derivatives (ne, nq, ns, ns) with respect to the strains.

        strain (ne, nq, ns): difference from the stress-free strains; history (ne, nl, k): committed history variables;
        stiffness (ne, nq, ns, ns): at zero strain.
        """
        ...


class Imposed(NamedTuple):
    """Strain measures that loads impose on elements: a sum of products of one or two of their factors with values.

    terms: numbers of the loads among all that impose strains, elements, and values (elements, nq, ns); shape: of the
    measures (ne, nq, ns) of all elements; chosen: those of interest.
    """

    terms: tuple[tuple[list[int], slice, np.ndarray], ...]
    shape: tuple[int, ...]
    chosen: slice | np.ndarray = slice(None)

    def at(self, factors: np.ndarray) -> np.ndarray:
        """Return the measures imposed by loads with given factors (k,)."""
        result = np.zeros(self.shape)
        for loads, elements, values in self.terms:
            result[elements] += factors[loads].prod() * values
        return result[self.chosen]


class Block(NamedTuple):
    """Elements with the same interpolation and the same strain measures.

    Sizes: ne elements, nc classes of identical elements, nq quadrature points, N nodes in total, nn per element, vpn
    nodal vectors per node (the last one, r_y, interpolates d; the others interpolate r0), nv = nn vpn, npn coordinates
    per node at most, ns strain measures.
    """

    measures: int  # GREEN_LAGRANGE, STRUCTURAL or ELASTIC_LINE
    slope: np.ndarray  # (nc, nq, nv) dN/ds, times the mesh length for gradients
    second: np.ndarray  # (nc, nq, nv) d2N/ds2 of r0, scaled likewise; empty except for the elastic line
    director: np.ndarray  # (nq, nn) N of d
    kind: np.ndarray  # (ne,) class of an element
    scale: np.ndarray  # (nc, nv) factor of a nodal vector: 1, or the mesh length [m] for gradients
    jacobian: np.ndarray  # (nc, nq) ds/dxi of the reference [m]
    weight: np.ndarray  # (nc, nq) quadrature weight times ds/dxi [m]
    stiffness: np.ndarray  # (nc, nq, ns, ns) section stiffness; with `law`, its tangent at zero strain
    reference: np.ndarray  # (nc, nq, ns) strain measures of the stress-free state
    mass: np.ndarray  # (nc, nv, nv) consistent mass [kg], one entry for each pair of nodal vectors
    gravity: np.ndarray  # (nc, nv) force on a nodal vector per unit of a uniform acceleration [kg]
    length: np.ndarray  # (nc, nv) integral of N_r over the reference length [m]
    node: np.ndarray  # (ne, nn) nodes of an element
    beam: np.ndarray  # (ne,) beam that an element belongs to
    node_kind: np.ndarray  # (N,) GRADIENTS, ROTATION, STRETCH, SHEAR_RIGID or ROTATED_GRADIENTS
    frame: np.ndarray  # (N, 3) cosine and sine of the node's angle, and |r_x|, in the reference; see `coordinates`
    dof: np.ndarray  # (N, npn) coordinates of a node, -1 where it has fewer
    home: np.ndarray  # (N, 2) an element that contains the node, and the node's number in that element
    damping: np.ndarray  # (nc,) retardation time [s]: resultants of strain rates = this time x stiffness x rates
    mass_damping: float = 0.0  # [1/s]: inertia forces M (e'' + this e')
    law: Law | None = None  # replaces the linear law
    imposed: Imposed | None = None  # stress-free strains imposed by loads, added to `reference`
    history: np.ndarray = NO_HISTORY  # (ne, nl, k) numbers of the coordinates that store history variables of the law

    def resisting(self, stiffness: np.ndarray) -> "Block":
        """Return the block with a linear law of given stiffness (nc, nq, ns, ns)."""
        return self._replace(stiffness=np.ascontiguousarray(stiffness), law=None)

    def linearised(self, strain: np.ndarray, p: np.ndarray) -> np.ndarray:
        """Return the section stiffness (ne, nq, ns, ns) at given strains.

        strain (ne, nq, ns): difference from the stress-free strains; p (n,): coordinates, which include the history.
        """
        linear = self.stiffness[self.kind]
        return linear if self.law is None else self.law.linearised(strain, p[self.history], linear)[1]


class Stations(NamedTuple):
    """Points of elements where forces act; values of forces are passed with each call."""

    element: np.ndarray  # (nl,) element
    position: np.ndarray  # (nl, nv) weights of the nodal vectors e_i in r0 = sum position_i e_i
    direction: np.ndarray  # (nl, nv) likewise for the vector that defines the direction of the section: d or r_x
    kind: np.ndarray  # (nl,) index in `physics.stations.STATIONS`
    constants: np.ndarray  # (nl, 4): unit vector of that direction in the reference, or stiffness [N/m] and place [m]


class Layout(NamedTuple):
    """Positions of the entries of element matrices in the model's matrix, which is a band or sparse."""

    free: np.ndarray  # (n,) number of a coordinate among the unknowns, -1 if it is prescribed
    half_width: int  # half-bandwidth, -1 for a sparse matrix
    slot: np.ndarray  # (ne, npe, npe) position in the data of a CSC matrix, empty for a band
