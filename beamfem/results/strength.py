"""The strength of the materials of a beam."""

import numpy as np

from beamfem.errors import InputError
from beamfem.model.beam_grid import Grid
from beamfem.model.reference import sections_at
from beamfem.section.protocol import CrossSection


def strengths(grid: Grid, element: np.ndarray, xi: np.ndarray, layers: int) -> np.ndarray:
    """Return the strength (layers, n) [Pa] of each layer of the sections at points (element, xi); nan if none is given.

    Sections with fewer layers repeat the last one.
    """
    prismatic = isinstance(grid.beam.section, CrossSection)
    sections = [grid.beam.section_at(0.0)] if prismatic else sections_at(grid, element, xi)
    values = np.array([_strengths(grid, section, layers) for section in sections]).T
    return np.broadcast_to(values, (layers, len(element))) if prismatic else values


def _strengths(grid: Grid, section: CrossSection, layers: int) -> list[float]:
    try:
        known = [material.strength for material, _ in section.moments(grid.beam.material)][:layers]
    except InputError:  # the section is defined by its stiffness and has no materials
        return [np.nan] * layers
    own = [np.nan if strength is None else strength for strength in known]
    return own + [own[-1]] * (layers - len(own))
