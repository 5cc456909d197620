"""Measures of plane stress in a section: what bends and what shears it."""

import numpy as np


def von_mises(along: np.ndarray, sheared: np.ndarray) -> np.ndarray:
    """Return von Mises' equivalent stress [Pa] of a stress along the beam and a shear stress; no other acts."""
    return np.sqrt(along**2 + 3.0 * sheared**2)


def in_the_plane(along: np.ndarray, sheared: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Return the stress tensor (steps, points, heights, 6) [Pa] in the axes of the plane: xx, yy, zz, xy, yz, xz.

    along, sheared (steps, points, heights) [Pa]: along the normal (steps, points, 2) of the section, and in it.
    """
    x, y = normal[..., None, 0], normal[..., None, 1]
    zero = np.zeros_like(along)
    both = along * x * y + sheared * (x**2 - y**2)
    parts = (along * x**2 - 2.0 * sheared * x * y, along * y**2 + 2.0 * sheared * x * y, zero, both, zero, zero)
    return np.stack(parts, axis=-1)
