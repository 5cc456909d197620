"""Check that the body of a beam is possible: sections must not overlap, neither on the curve nor when interpolated."""

from collections.abc import Callable

import numpy as np

from beamfem.element.axis import cross
from beamfem.errors import InputError
from beamfem.mesh.beam_grid import Grid
from beamfem.mesh.reference import curvature, reference_axis, sections_at, stations
from beamfem.section.protocol import CrossSection, HasParts

_SAMPLES = 33  # along an element


def require_body(grid: Grid, unit: Callable[[str], str]) -> None:
    """Raise InputError if a face of a section of known shape lies at or beyond the centre of curvature.

    The axis and its sections are interpolated between nodes, so elements that turn by too large an angle are refused as
    well. unit: see `Model.unit`.
    """
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
        at, metre = float(grid.arc_length(element, xi)[worst]), unit("m")
        face = float(np.broadcast_to(faces, (len(bend), 2))[worst, int(bend[worst] > 0.0)])
        raise InputError(
            f"at arc length {at:g} {metre} the axis of {grid.beam!r} has a radius of curvature of "
            f"{1.0 / abs(bend[worst]):g} {metre}, and its section reaches {abs(face):g} {metre} towards the centre: "
            "the body would overlap itself; take a larger radius or a lower section"
        )
    _require_short(grid, element, xi, faces, unit)


def _require_short(
    grid: Grid, element: np.ndarray, xi: np.ndarray, faces: np.ndarray, unit: Callable[[str], str]
) -> None:
    """Raise InputError if the interpolated body has det J = (r0' + y d') x d <= 0.

    This is checked on the axis and, for forces integrated over the body, at its faces (2,) or (n, 2).
    """
    axis = reference_axis(grid, element, xi)
    heights = np.zeros((len(xi), 3))  # of both faces and of the axis
    if grid.beam.element.forces.fills_body:
        heights[:, :2] = faces
    volume = (cross(axis.r_s, axis.d)[:, None] + heights * cross(axis.d_s, axis.d)[:, None]).min(axis=1)
    worst = int(np.argmin(volume))
    if volume[worst] <= 0.0:
        elements = np.full(_SAMPLES, element[worst])
        along = np.linspace(0.0, 1.0, _SAMPLES)
        arc = grid.arc_length(elements, along)
        turn = np.degrees(np.abs(np.trapezoid(curvature(grid, elements, along), arc)))
        raise InputError(
            f"elements of {grid.beam!r} are too long: that from arc length {arc[0]:g} {unit('m')} to {arc[-1]:g} "
            f"{unit('m')} turns by {turn:.0f} degrees, and the sections that it interpolates between its nodes "
            "overlap; take more elements"
        )


def _faces(section: CrossSection, grid: Grid) -> tuple[float, float]:
    """Return lower and upper y [m] of a section, zero if its height is unknown and forces do not integrate over it."""
    if grid.beam.element.forces.fills_body:
        return section.bounds
    parts = section.parts(grid.beam.material) if isinstance(section, HasParts) else ()
    if not parts or not all(part.outline.known for part in parts):
        return 0.0, 0.0
    return parts[0].outline.low, parts[-1].outline.high
