"""Reduction of a linear model to the coordinates of interfaces and a few modes."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from scipy.sparse import csc_array, csr_array

from beamfem.errors import InputError
from beamfem.linalg.eigenpairs import digits_for, largest_pairs
from beamfem.linalg.tangent import UNROTATED, SparseTangent
from beamfem.model.beam import Point
from beamfem.model.model import Model
from beamfem.results.solution import Solution, State
from beamfem.solve.linear.linear_model import LinearModel
from beamfem.solve.linear.linearise import linearised
from beamfem.solve.modes.modes import meshed_for_modes
from beamfem.validation import items, number_below

_SPARE = 4  # modes found beyond those asked for, so that the last ones are accurate


def reduce(model: Model, interfaces: Sequence[Point], modes: int, about: State | Solution | None = None) -> LinearModel:
    """Reduce the linearised model to the coordinates of interfaces and modes by Craig and Bampton.

    z = [1, 0; -K_ii^-1 K_ib, Phi] (z_b, eta): static motions by unit displacements of the interfaces, and the lowest
    modes Phi, K_ii Phi = M_ii Phi lambda, with fixed interfaces and Phi^T M_ii Phi = 1.

    Parameters
    ----------
    model : Model
        Beams, supports, loads, joints and connectors.
    interfaces : sequence of Point
        Points at nodes, such as ends of beams, all of whose coordinates are in the reduced model.
    modes : int
        Number of modes with fixed interfaces.
    about : State or Solution, optional
        State to linearise about, see `linearise`.

    Returns
    -------
    LinearModel
        The matrices of z_b and eta; `transformation` recovers the coordinates of the model, and the loads are those of
        the model.

    Raises
    ------
    InputError
        For an invalid argument, see `linearise`, for a point that is no node, is listed twice, or whose coordinates
        conditions determine, and if the model is not stable with fixed interfaces.
    ConvergenceError
        If the modes cannot be found.

    References
    ----------
    Craig and Bampton 1968, AIAA Journal 6(7), 1313-1319.

    Examples
    --------
    >>> small = bf.reduce(model, [beam.end], modes=4)
    >>> len(small), small.modes(2).frequencies.round(2)
    (7, array([ 20.85, 129.15]))
    """
    model, about = meshed_for_modes(model, about)
    kept = _coordinates(model, interfaces)
    linear = linearised(model, about, None, kept)
    boundary = np.flatnonzero(np.isin(linear.coordinates, kept))
    inner = np.setdiff1d(np.arange(len(linear)), boundary)
    count = number_below("modes", modes, len(inner) + 1)
    if not len(inner):
        return linear
    stiffness = 0.5 * (linear.stiffness + linear.stiffness.T)
    own = csr_array(linear.mass[inner][:, inner])
    with digits_for("modes with fixed interfaces"):
        factors = SparseTangent(csc_array(stiffness[inner][:, inner])).factorised(UNROTATED)
        if factors.negative_pivots:
            raise InputError("the model moves rigidly or is unstable while its interfaces are fixed")
        static = np.array([factors.solve(column) for column in stiffness[inner][:, boundary].toarray().T])
        wanted = min(count + _SPARE, len(inner))
        shapes = largest_pairs(own, factors, wanted, np.empty((len(inner), 0)))[1][:, :count]
    basis = np.zeros((len(linear), len(boundary) + shapes.shape[1]))
    basis[boundary, np.arange(len(boundary))] = 1.0
    basis[inner, : len(boundary)] = -static.reshape(len(boundary), len(inner)).T
    basis[inner, len(boundary) :] = shapes
    names = [linear.names[number] for number in boundary.tolist()]
    names += [f"mode {number} with fixed interfaces" for number in range(shapes.shape[1])]
    return replace(
        linear,
        **{name: csr_array(basis.T @ (getattr(linear, name) @ basis)) for name in ("mass", "damping", "stiffness")},
        input_matrix=basis.T @ linear.input_matrix,
        transformation=csr_array(linear.transformation @ csr_array(basis)),
        coordinates=np.append(linear.coordinates[boundary], np.full(shapes.shape[1], -1)),
        names=tuple(names),
        interfaces=tuple(interfaces),
    )


def _coordinates(model: Model, interfaces: Sequence[Point]) -> np.ndarray:
    """Return the numbers of the coordinates at points. Raises InputError."""
    nodes: dict[frozenset[int], Point] = {}
    for point in items("interfaces", interfaces):
        mesh = model.mesh_of(point)
        node = mesh.node_near(point.fraction)
        if node is None:
            raise InputError(
                f"the interface {point} is at no node of its beam",
                remedy="Add a PointForce of (0, 0) there to the model",
            )
        own = frozenset(mesh.coordinates_of(node).values())
        if own in nodes:
            raise InputError(f"the interfaces {nodes[own]} and {point} are one; list it once")
        nodes[own] = point
    return np.array(sorted(frozenset().union(*nodes)), dtype=np.int64)
