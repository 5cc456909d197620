"""Strains of the cubic field at its nodes and its middle, where it can make them zero however strongly it bends.

At a node r_x is a coordinate of its own, and in the middle it follows from the distance of the nodes: 3 Gauss-Lobatto
points ask for no stretch and no shear without asking anything of the curvature. Together with that there are as many
strains as coordinates less three rigid motions, so that no motion is left without energy either.
"""

import numpy as np

from beamfem.element.coordinates import Coordinates, Gradients, ShearFree
from beamfem.element.forces import ElasticLine, Forces, Structural

POINTS = np.array([0.0, 0.5, 1.0])
WEIGHTS = np.array([1.0, 4.0, 1.0]) / 6.0
STATIONS = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3.0)
_TRAPEZOID = np.array([0.5, 0.0, 0.5])
_OUTER = 0.5 + np.sqrt(0.15) * np.array([-1.0, 1.0])  # of the 3 Gauss points, whose other one is the middle
_GAUSS = np.array([5.0, 8.0, 5.0]) / 18.0
# A bubble that is zero at the nodes is 3/2 of its mean in the middle: 2/3 of the weight gives the mean its energy.
_BUBBLE = 2.0 / 3.0
_STRETCH, _CURVATURE, _THICKNESS = 0, 2, 3


def energy_points(forces: Forces) -> tuple[np.ndarray, np.ndarray]:
    """Return points (nq,) and weights (nq,) on [0, 1]; behind the Lobatto points those that a turning d needs besides.

    The turning rate of an interpolated d is no polynomial: 3 Gauss points find its energy five times better.
    """
    if isinstance(forces, Structural):
        return np.append(POINTS, _OUTER), np.append(WEIGHTS, _GAUSS[[0, 2]])
    return POINTS.copy(), WEIGHTS.copy()


def energy_stiffness(
    forces: Forces, coordinates: Coordinates, stiffness: np.ndarray, jacobian: np.ndarray
) -> np.ndarray:
    """Return what of the section stiffness (ne, nq, ns, ns) counts at the points of the energy.

    jacobian: ds/dxi (ne, nq) [m] there.
    """
    table = assumed(forces, coordinates, jacobian[:, : len(POINTS)])
    result = stiffness.copy()
    inner = result[:, : len(POINTS)]
    inner[:] = np.swapaxes(table, -1, -2) @ inner @ table
    if isinstance(forces, Structural):
        _spread_curvature(result)
    for j in np.flatnonzero(_at_nodes(forces)).tolist():
        inner[..., j, j] *= _TRAPEZOID / WEIGHTS
    if isinstance(coordinates, ShearFree):
        shear = int(np.argmax(forces.shear_measures))
        for j in (shear,) if coordinates.stretchable else (_STRETCH, shear):
            if not _at_nodes(forces)[j]:
                inner[:, 1, j, j] *= _BUBBLE
    return result


def assumed(forces: Forces, coordinates: Coordinates, jacobian: np.ndarray) -> np.ndarray:
    """Return the tables (ne, points, ns, ns) from strains at the Lobatto points to those that are assumed there.

    Thickness strain of the body varies linearly between the nodes, which know the length of d: an interpolated d is
    shorter between them, e_lin = e + xi (1 - xi) J^2 c with c = d'.d' / 2, and g1 = d.d' its derivative.
    Where nodes keep that length there is none.
    """
    count = len(forces.shear_measures)
    table = np.tile(np.eye(count), (*jacobian.shape, 1, 1))
    body = not isinstance(forces, Structural | ElasticLine)
    if not isinstance(coordinates, Gradients):
        for j in (_THICKNESS, 5) if body else (_THICKNESS,):
            table[..., j, j] = 0.0
    elif body:
        table[..., _THICKNESS, 2] = POINTS * (1.0 - POINTS) * jacobian**2
        table[..., 5, 2] = (1.0 - 2.0 * POINTS) * jacobian
    return table


def _at_nodes(forces: Forces) -> np.ndarray:
    """Tell which measures (ns,) only nodes know: the length of d, and of the elastic line its angle to r_x.

    Between the nodes a d that is interpolated linearly would hold the angle of r_x to a straight line, and so pin its
    curvature.
    """
    if isinstance(forces, Structural):
        return np.array(forces.thickness_measures)
    if isinstance(forces, ElasticLine):
        return np.array(forces.thickness_measures) | np.array(forces.shear_measures)
    return np.zeros(len(forces.shear_measures), dtype=bool)


def _spread_curvature(stiffness: np.ndarray) -> None:
    """Move bending stiffness (ne, 5) from the Lobatto to the Gauss points; coupled with stretch it stays."""
    coupled = np.any(stiffness[..., _STRETCH, _CURVATURE] != 0.0, axis=1)[:, None]
    bending = stiffness[..., _CURVATURE, _CURVATURE].copy()
    stiffness[:, len(POINTS) :] = 0.0
    apart = np.array([0.0, _GAUSS[1] / WEIGHTS[1], 0.0, 1.0, 1.0])
    together = np.array([1.0, 1.0, 1.0, 0.0, 0.0])
    stiffness[..., _CURVATURE, _CURVATURE] = np.where(coupled, together, apart) * bending
