"""Green-Lagrange strain in the body r0 + y d of a beam, from the strain measures of a continuum."""

import numpy as np

from beamfem.element.fields import Axis, dot, section_frame
from beamfem.physics.kinematics import evaluate, green_lagrange

Strain = tuple[np.ndarray, np.ndarray, np.ndarray]  # exx, eyy and 2 exy


InverseJacobian = tuple[np.ndarray, np.ndarray, np.ndarray]  # k11, k21 and k22 of [[k11, 0], [k21, k22]]


def inverse_jacobian(reference: Axis, y: np.ndarray) -> tuple[InverseJacobian, np.ndarray]:
    """Return J^-1 and det J (..., heights) of points (...) of the reference axis at heights y (heights,) [m].

    J = (r0' + y d', d); components are those along n and t = d / |d|.
    """
    along, across = section_frame(reference.d)
    first = reference.r_s[..., None, :] + y[..., None] * reference.d_s[..., None, :]
    j11, j21 = dot(first, along[..., None, :]), dot(first, across[..., None, :])
    j22 = np.linalg.norm(reference.d, axis=-1)[..., None]
    k11, k22 = 1.0 / j11, 1.0 / j22
    return (k11, -j21 * k11 * k22, k22), j11 * j22


def convected(measures: np.ndarray, y: np.ndarray) -> Strain:
    """Return the convected strain (..., heights) of measures (..., 6) at heights y (heights,) [m]."""
    a, b, c, eyy, g0, g1 = np.moveaxis(measures, -1, 0)[..., None]
    xx = a + y * (b + y * c)
    return xx, np.broadcast_to(eyy, xx.shape), g0 + y * g1


def in_section_frame(inverse: InverseJacobian, strain: Strain) -> Strain:
    """Return E = J^-T (E_convected) J^-1 in the frame of the section."""
    (k11, k21, k22), (xx, yy, xy) = inverse, strain
    return k11**2 * xx + k21**2 * yy + k11 * k21 * xy, k22**2 * yy, 2.0 * k21 * k22 * yy + k11 * k22 * xy


def strain_of_measures(reference: Axis, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the derivative (..., heights, 3, 6) of (exx, eyy, 2 exy) by the measures, and det J (..., heights)."""
    (k11, k21, k22), volume = inverse_jacobian(reference, y)
    entries = k11[..., None, :], k21[..., None, :], k22[..., None, :]
    rows = np.stack(in_section_frame(entries, convected(np.eye(6), y)), axis=-3)
    return np.moveaxis(rows, -1, -3), volume


def green_strain(now: Axis, reference: Axis, y: np.ndarray) -> Strain:
    """Return exx, eyy and 2 exy (..., heights) at heights y (heights,) [m] in the frame of the reference."""
    change = evaluate(green_lagrange, now.r_s, now.d, now.d_s)
    change = change - evaluate(green_lagrange, reference.r_s, reference.d, reference.d_s)
    return in_section_frame(inverse_jacobian(reference, y)[0], convected(change, y))
