"""Strains of the cubic field at its nodes and midpoint, where stretch and shear can vanish however strongly it bends.

At a node, zero stretch and shear determine r_x, which is a coordinate; at the midpoint, they determine the distance of
the nodes. At the 3 Gauss-Lobatto points they therefore impose no condition on the curvature, and no locking occurs.
With the curvature there are as many strains as coordinates minus three rigid-body motions, so that no zero-energy modes
remain.
"""

import numpy as np

from beamfem.element.coordinates import Coordinates, Gradients, ShearFree
from beamfem.element.forces import Forces
from beamfem.kernels.block import ELASTIC_LINE, GREEN_LAGRANGE, STRUCTURAL

POINTS = np.array([0.0, 0.5, 1.0])
WEIGHTS = np.array([1.0, 4.0, 1.0]) / 6.0
STATIONS = 0.5 + np.array([-0.5, 0.5]) / np.sqrt(3.0)
_TRAPEZOID = np.array([0.5, 0.0, 0.5])
_OUTER = 0.5 + np.sqrt(0.15) * np.array([-1.0, 1.0])  # of the 3 Gauss points; the other one is the midpoint
_GAUSS = np.array([5.0, 8.0, 5.0]) / 18.0
# A bubble that is zero at the nodes is 3/2 of its mean at the midpoint: 2/3 of the weight there gives the energy of the
# mean, (2/3)^2 (3/2)^2 = 1.
_BUBBLE = 2.0 / 3.0
_STRETCH, _CURVATURE, _THICKNESS = 0, 2, 3


def knows(forces: Forces) -> bool:
    """Return whether there are rules here for the strain measures of forces, which their code number determines."""
    return forces.code in (STRUCTURAL, ELASTIC_LINE, GREEN_LAGRANGE)


def is_default(forces: Forces) -> bool:
    """Return whether these rules are the default of forces; the paper integrates those of a continuum fully."""
    return forces.code in (STRUCTURAL, ELASTIC_LINE)


def energy_points(forces: Forces) -> tuple[np.ndarray, np.ndarray]:
    """Return points (nq,) and weights (nq,) on [0, 1]: the Lobatto points, then two more for structural curvature.

    The rotation rate of an interpolated d is not a polynomial: 3 Gauss points give its energy five times more
    accurately.
    """
    if forces.code == STRUCTURAL:
        return np.append(POINTS, _OUTER), np.append(WEIGHTS, _GAUSS[[0, 2]])
    return POINTS.copy(), WEIGHTS.copy()


def energy_stiffness(
    forces: Forces, coordinates: Coordinates, stiffness: np.ndarray, jacobian: np.ndarray
) -> np.ndarray:
    """Return the section stiffness (ne, nq, ns, ns) that enters the energy at its points.

    stiffness: that of the sections there; jacobian (ne, nq): ds/dxi [m].
    """
    table = assumed(forces, coordinates, jacobian[:, : len(POINTS)])
    result = stiffness.copy()
    inner = result[:, : len(POINTS)]
    inner[:] = np.swapaxes(table, -1, -2) @ inner @ table
    if forces.code == STRUCTURAL:
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
    """Return the tables (ne, points, ns, ns) from strains at the Lobatto points to the strains assumed there.

    For continuum forces, the thickness strain is made linear between its nodal values, because an interpolated d is
    shorter between the nodes: e_lin = e + xi (1 - xi) J^2 c with c = d'.d' / 2; g1 = d.d' is replaced by the derivative
    of e_lin. There is no thickness strain if the nodes keep the length of d constant.
    """
    count = len(forces.shear_measures)
    table = np.tile(np.eye(count), (*jacobian.shape, 1, 1))
    body = forces.code == GREEN_LAGRANGE
    if not isinstance(coordinates, Gradients):
        for j in (_THICKNESS, 5) if body else (_THICKNESS,):
            table[..., j, j] = 0.0
    elif body:
        table[..., _THICKNESS, 2] = POINTS * (1.0 - POINTS) * jacobian**2
        table[..., 5, 2] = (1.0 - 2.0 * POINTS) * jacobian
    return table


def _at_nodes(forces: Forces) -> np.ndarray:
    """Return the mask (ns,) of the measures evaluated at nodes only: thickness, and shear of the elastic line.

    Between the nodes, a linear d would make the angle of r_x linear as well, and so the curvature of the elastic line
    constant.
    """
    if forces.code == STRUCTURAL:
        return np.array(forces.thickness_measures)
    if forces.code == ELASTIC_LINE:
        return np.array(forces.thickness_measures) | np.array(forces.shear_measures)
    return np.zeros(len(forces.shear_measures), dtype=bool)


def _spread_curvature(stiffness: np.ndarray) -> None:
    """Move the bending stiffness from the Lobatto to the Gauss points, unless it is coupled with stretch.

    stiffness (ne, 5, ns, ns) is changed in place.
    """
    coupled = np.any(stiffness[..., _STRETCH, _CURVATURE] != 0.0, axis=1)[:, None]
    bending = stiffness[..., _CURVATURE, _CURVATURE].copy()
    stiffness[:, len(POINTS) :] = 0.0
    apart = np.array([0.0, _GAUSS[1] / WEIGHTS[1], 0.0, 1.0, 1.0])
    together = np.array([1.0, 1.0, 1.0, 0.0, 0.0])
    stiffness[..., _CURVATURE, _CURVATURE] = np.where(coupled, together, apart) * bending
