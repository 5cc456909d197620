"""Stress of a beam over its sections: extremes of each, where they are, and how much of the strength they take."""

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np

from beamfem.brief import brief
from beamfem.model.beam import Beam
from beamfem.model.distributions import distributions
from beamfem.model.mesh import BeamMesh
from beamfem.results.free_bodies import Cuts
from beamfem.results.section_forces import at_points, stations
from beamfem.results.self_stress import self_stress
from beamfem.results.strength import strengths
from beamfem.results.stresses import von_mises
from beamfem.tabulate import as_html
from beamfem.validation import require_known, shown

if TYPE_CHECKING:
    from beamfem.results.solution import Solution

Part = Literal["lower", "upper", "tension", "compression", "shear", "von_mises", "utilisation"]
_HEIGHTS = np.linspace(0.0, 1.0, 9)  # of a layer: its faces, and where a parabola of shear stress is largest
_VALUES = 4_000_000  # in one array


class Peak(NamedTuple):
    """The extreme of a stress: its value, where it is along the beam [m], and in which row."""

    value: float
    arc_length: float
    row: int


@dataclass(frozen=True)
class BeamStress:
    """Extreme stress [Pa] of the sections of a beam (steps, stations); arc_length (stations,) [m], as `SectionForces`.

    lower, upper: along the beam at the two faces; tension, compression: the largest and the smallest along the beam
    over the height, at the faces of layers too; shear: the largest size over the height; von_mises: the largest
    sqrt(sigma^2 + 3 tau^2) over the height, of the faces alone where the shear stress inside is not known; utilisation
    [-]: the largest ratio of stress to the strength of the material there, nan if none is given (`Material`). Cauchy
    stress, as in `Fields`; nan for sections that give none. Seven more heights are evaluated between the faces of a
    layer.
    """

    arc_length: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    tension: np.ndarray
    compression: np.ndarray
    shear: np.ndarray
    von_mises: np.ndarray
    utilisation: np.ndarray

    __repr__ = brief

    def _repr_html_(self) -> str:
        names = [name for name in self.__dataclass_fields__ if name != "arc_length"]
        rows = [(name, *self.peak(name)) for name in names]  # type: ignore[arg-type]
        return f"<b>Stress, peaks</b>{as_html(('', 'extreme', 'at arc length', 'row'), rows)}"

    def peak(self, part: Part = "von_mises") -> Peak:
        """Return the extreme of one of these, nan if none is known. Raises InputError.

        The smallest of `compression`, the largest by its size of `lower` and `upper`, else the largest.
        """
        known = [name for name in self.__dataclass_fields__ if name != "arc_length"]
        require_known(f"there is no stress {shown(part)}", part, known)
        values = getattr(self, part)
        if not np.isfinite(values).any():
            return Peak(np.nan, np.nan, -1)
        measured = -values if part == "compression" else np.abs(values) if part in ("lower", "upper") else values
        row, station = np.unravel_index(np.nanargmax(measured), values.shape)
        return Peak(float(values[row, station]), float(self.arc_length[station]), int(row))


def beam_stress(solution: "Solution", beam: Beam) -> BeamStress:
    """Return the stress of a beam at the stations of its section forces."""
    mesh = solution.model.mesh_of(beam.start)
    cuts = stations(mesh)
    found = stress_at(solution, mesh, cuts.element, cuts.xi)
    arc = mesh.arc_length(cuts.element, cuts.xi)
    return BeamStress(arc, *(found[name] for name in BeamStress.__dataclass_fields__ if name != "arc_length"))


def stress_at(
    solution: "Solution",
    mesh: BeamMesh,
    element: np.ndarray,
    xi: np.ndarray,
    rows: slice | np.ndarray = slice(None),
) -> dict[str, np.ndarray]:
    """Return what `BeamStress` has (steps, points) of some rows at points (element, xi) of a beam, by name."""
    chosen, parts = np.arange(len(solution))[rows], []
    chunk = max(1, _VALUES // (len(_HEIGHTS) * max(len(xi), 1)))
    for first in range(0, max(len(chosen), 1), chunk):
        parts.append(_of_rows(solution, mesh, element, xi, chosen[first : first + chunk]))
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def _of_rows(
    solution: "Solution", mesh: BeamMesh, element: np.ndarray, xi: np.ndarray, rows: np.ndarray
) -> dict[str, np.ndarray]:
    normal, shear, moment = np.moveaxis(at_points(solution, mesh, Cuts(element, xi), rows), 1, 0)
    own, extremes = distributions(mesh, element, xi), dict[str, np.ndarray]()
    for layer in range(own.layers.shape[1]):
        low, high = np.moveaxis(own.layers[:, layer], -1, 0)
        y = low[:, None] + (high - low)[:, None] * _HEIGHTS
        along = own.normal_stress(layer, y, normal, moment) + self_stress(solution, mesh, element, xi, layer, y, rows)
        sheared = own.shear_stress(layer, y, shear)
        equivalent = von_mises(along, sheared)
        fraction = equivalent / strengths(mesh, element, xi, layer)[:, None]
        found = {
            "lower": along[..., 0],
            "upper": along[..., -1],
            "tension": along.max(axis=-1),
            "compression": along.min(axis=-1),
            "shear": np.abs(sheared).max(axis=-1),
            # where the width inside is not known, nor is the shear stress there: the faces, without any, still count
            "von_mises": np.fmax.reduce(equivalent, axis=-1),
            "utilisation": np.fmax.reduce(fraction, axis=-1),
        }
        # a layer that a section has not is its upper face
        extremes = {name: _joined(name, extremes[name], found[name]) for name in found} if extremes else found
    return extremes


def _joined(name: str, before: np.ndarray, layer: np.ndarray) -> np.ndarray:
    if name == "lower":
        return before
    if name == "upper":
        return layer
    return np.fmin(before, layer) if name == "compression" else np.fmax(before, layer)
