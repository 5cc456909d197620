"""The points of an element where a nonlinear section law acts, and how its other stiffness counts."""

import numpy as np

from beamfem.element.element import Element, kept_with_elements

STRAINS = 3  # of a law: stretch, shear and curvature, which precede other measures


@kept_with_elements
def coupled_fractions(element: Element) -> np.ndarray:
    """Return the fractions (nq, ns, ns), read-only, of a stiffness that couples all strains in the energy at points."""
    points, measures = len(element.energy_points()[0]), len(element.forces.shear_measures)
    result = element.energy_stiffness(np.ones((1, points, measures, measures)), np.ones((1, points)))[0]
    result.setflags(write=False)
    return result


@kept_with_elements
def law_points(element: Element) -> int:
    """Return at how many points, the first ones, a law acts; 0 if its strains do not all count fully at the same."""
    block = coupled_fractions(element)[:, :STRAINS, :STRAINS]
    count = int(block.any(axis=(1, 2)).sum())
    whole = np.zeros_like(block)
    whole[:count] = 1.0
    return count if np.array_equal(block, whole) else 0
