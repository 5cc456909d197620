"""The strength of the materials of a beam."""

import numpy as np

from beamfem.errors import InputError
from beamfem.model.grid import Grid
from beamfem.model.reference import sections_at
from beamfem.section.protocol import CrossSection


def strengths(grid: Grid, element: np.ndarray, xi: np.ndarray, layer: int) -> np.ndarray:
    """Return the strength (n,) [Pa] of a layer of the sections at points (element, xi); nan if none is given."""
    prismatic = isinstance(grid.beam.section, CrossSection)
    sections = [grid.beam.section_at(0.0)] if prismatic else sections_at(grid, element, xi)
    found = np.array([_strength(grid, section, layer) for section in sections])
    return np.broadcast_to(found, len(element)) if prismatic else found


def _strength(grid: Grid, section: CrossSection, layer: int) -> float:
    try:
        parts = [material for material, _ in section.moments(grid.beam.material)]
    except InputError:  # the section is defined by its stiffness and has no materials
        return np.nan
    own = parts[min(layer, len(parts) - 1)].strength
    return np.nan if own is None else own
