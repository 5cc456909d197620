"""Whether the body of a beam can be: its sections must not reach the centre of the axis' curvature."""

import numpy as np

from beamfem.errors import InputError
from beamfem.model.grid import Grid
from beamfem.model.reference import curvature, sections_at, stations
from beamfem.section.protocol import CrossSection, HasParts


def require_body(grid: Grid) -> None:
    """Raise InputError where a face of a section of known shape lies at the centre of curvature or beyond it."""
    if grid.straight:
        return
    element, xi = stations(grid)
    section = grid.beam.section
    if isinstance(section, CrossSection):
        faces = np.array(_faces(section, grid))
    else:
        faces = np.array([_faces(own, grid) for own in sections_at(grid, element, xi)])
    bend = curvature(grid, element, xi)
    reach = (bend[:, None] * faces).max(axis=1)
    worst = int(np.argmax(reach))
    if reach[worst] >= 1.0:
        at = float(grid.arc_length(element, xi)[worst])
        face = float(np.broadcast_to(faces, (len(bend), 2))[worst, int(bend[worst] > 0.0)])
        raise InputError(
            f"at arc length {at:g} m the axis of {grid.beam!r} has a radius of curvature of {1.0 / abs(bend[worst]):g} "
            f"m, and its section reaches {abs(face):g} m towards the centre: the body would overlap itself; take a "
            "larger radius or a lower section"
        )


def _faces(section: CrossSection, grid: Grid) -> tuple[float, float]:
    """Return lower and upper y [m] of a section, the axis where its height is neither known nor integrated over."""
    if grid.beam.element.forces.fills_body:
        return section.bounds
    parts = section.parts(grid.beam.material) if isinstance(section, HasParts) else ()
    if not parts or not all(part.outline.known for part in parts):
        return 0.0, 0.0
    return parts[0].outline.low, parts[-1].outline.high
