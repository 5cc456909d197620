"""Features of sections, loads and curves that are so narrow that they lie between the integration points of a mesh."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from beamfem.curves import Arc, Line, Polyline
from beamfem.element.fields import length_rule
from beamfem.errors import CoarseMeshWarning, warn
from beamfem.mesh.beam_mesh import BeamMesh
from beamfem.model.along_beam import AlongBeam, functions_along
from beamfem.model.beam import Beam, beam_in_words
from beamfem.model.imposed_strains import ImposedStrain
from beamfem.model.jumps import find_jumps
from beamfem.model.model import Model
from beamfem.results.solution import Solution
from beamfem.solve.accuracy.error_estimate import enriched, remeshed, with_elements

if TYPE_CHECKING:
    from scipy.interpolate import PPoly

_SAMPLES = 128  # intervals of a beam: what is narrower is seen only if its function declares kinks
_UNSEEN = 0.02  # of an integral along a beam: what an estimate may miss
_SHARE = 0.1  # of an accuracy that may be missed
_LEAST = 1e-4  # smallest error of integration that the samples tell
_NOTHING = 1e-12  # of the mean size: tails of functions, whose slopes would underflow
_Rows = Callable[[np.ndarray], np.ndarray]  # values (n, ...) at arc lengths (n,) [m]
_BESIDE = 1e-9  # of the length of a beam: distance from a jump at which its sides are sampled


@dataclass(frozen=True, eq=False)
class Profile:
    """What varies along a beam, and the fractions of it where it jumps.

    strains, forces: splines over the fraction of functions of a mean size of 1 and of them times the fraction, which
    are integrated with the strains, and with forces.
    """

    jumps: tuple[float, ...]
    strains: "PPoly"
    forces: "PPoly"

    def missed(self, beam: Beam, ends: np.ndarray) -> np.ndarray:
        """Return the largest error (ne,) in integrals of the functions, and of their moments, over each element."""
        element, sizes = beam.element, np.diff(ends)[:, None]
        errors = []
        for spline, (points, weights) in (
            (self.strains, element.quadrature()),
            (self.forces, length_rule(element.field)),
        ):
            found = weights @ spline(ends[:-1, None] + sizes * points)
            errors.append(np.abs(sizes * found - np.diff(spline.antiderivative()(ends), axis=0)))
        return np.concatenate(errors, axis=1).max(axis=1, initial=0.0)


def profiles_of(model: Model) -> list[Profile | None]:
    """Return what varies along each beam: direction, flexibility, mass, loads and imposed strains; None if nothing."""
    loads: list[list[AlongBeam]] = [[] for _ in model.beams]
    for load in (*model.line_loads, *(load for _, load in model.imposing)):
        loads[model.number_of(load.beam)].append(load)
    return [_profile(*each) for each in zip(model.beams, loads, strict=True)]


def _profile(beam: Beam, loads: Sequence[AlongBeam]) -> Profile | None:
    functions: list[tuple[bool, Any, _Rows]] = []
    if type(beam.curve) not in (Line, Polyline, Arc):
        functions.append((True, None, beam.curve.tangent))
    if not beam.prismatic:
        functions.append((True, beam.section, lambda arc: _flexibility_and_mass(beam, arc.tolist())))
    for load in loads:
        for name, function in functions_along(load).items():
            own = partial(load.values_of, name)
            functions.append((isinstance(load, ImposedStrain), function, own))
    if not functions:
        return None
    length = beam.curve.length
    sampled = [_sampled(function, rows, length) for _, function, rows in functions]
    jumps = np.unique([jump for _, own in sampled for jump in own]) / length
    sides = [*(jumps - _BESIDE), *(jumps + _BESIDE)]
    at = np.array([*np.linspace(0.0, 1.0, _SAMPLES + 1), *sides])
    order = np.argsort(at)
    strains, forces = [np.empty((len(at), 0))], [np.empty((len(at), 0))]
    for (with_strains, _, rows), (values, _) in zip(functions, sampled, strict=True):
        whole = np.vstack([values, *(rows(np.array([side * length])).reshape(1, -1) for side in sides)])
        (strains if with_strains else forces).append(whole[order])
    return Profile(tuple(jumps.tolist()), _spline(at[order], strains), _spline(at[order], forces))


def _sampled(
    function: Any, rows: Callable[[np.ndarray], np.ndarray], length: float
) -> tuple[np.ndarray, tuple[float, ...]]:
    """Return the values (n, k) of a function at equal distances, and its jumps [m]; elements end at those of curves."""
    at = np.linspace(0.0, length, _SAMPLES + 1)
    values = rows(at).reshape(len(at), -1)
    if function is None:
        return values, ()
    known = dict(zip(at.tolist(), values, strict=True))

    def row(arc_length: float) -> np.ndarray:
        return known[arc_length] if arc_length in known else rows(np.array([arc_length])).ravel()

    return values, find_jumps("a function along a Beam", function, row, length, _SAMPLES)


def _spline(at: np.ndarray, columns: Sequence[np.ndarray]) -> "PPoly":
    from scipy.interpolate import PchipInterpolator  # slow to import and rarely needed

    values = np.hstack(columns)
    means = np.trapezoid(np.abs(values), at, axis=0)
    values = values[:, means > 0.0] / means[means > 0.0]
    values[np.abs(values) < _NOTHING] = 0.0
    return PchipInterpolator(at, np.hstack([values, values * at[:, None]]))


def _flexibility_and_mass(beam: Beam, arc_lengths: Iterable[float]) -> np.ndarray:
    sections = [beam.section_at(s) for s in arc_lengths]
    stiffness = [section.rigidity(beam.material) for section in sections]
    return np.array(
        [
            (1.0 / k.axial, 1.0 / k.shear, 1.0 / k.bending, section.inertia(beam.material).mass)
            for k, section in zip(stiffness, sections, strict=True)
        ]
    )


def resolved(model: Model, profiles: Sequence[Profile | None], accuracy: float) -> Model:
    """Return the model, with elements halved that miss too much of what varies along them for an accuracy [-].

    Neither an estimate nor the coefficients of a solution tell what lies between the integration points.
    """
    if not any(profiles):
        return model
    beams = [_resolved(*each, max(_SHARE * accuracy, _LEAST)) for each in zip(model.meshes, profiles, strict=True)]
    same = all(beam is mesh.beam for beam, mesh in zip(beams, model.meshes, strict=True))
    return model if same else remeshed(model, beams)


def _resolved(mesh: BeamMesh, profile: Profile | None, least: float) -> Beam:
    beam, ends = mesh.beam, mesh.vertices / mesh.vertices[-1]
    while profile is not None:
        unseen = (profile.missed(beam, ends) > least) & (np.diff(ends) > 1.0 / _SAMPLES)
        if not unseen.any():
            break
        ends = np.sort([*ends, *(0.5 * (ends[1:] + ends[:-1]))[unseen]])
        beam = with_elements(beam, ends)
    return beam


def warn_of_unseen(solution: Solution) -> None:
    """Warn of what varies along beams that their enriched elements miss as well, so that no estimate shows it."""
    model = solution.model
    pairs = zip(profiles_of(model), enriched(model).meshes, strict=True)
    for number, (profile, mesh) in enumerate(pairs):
        missed = 0.0 if profile is None else profile.missed(mesh.beam, mesh.vertices / mesh.vertices[-1]).sum()
        if missed > _UNSEEN:
            warn(
                f"what varies along {beam_in_words(model.beams, number)} is narrower than its elements, of which the "
                f"estimate of the error misses {min(100.0 * missed, 100.0):.2g} %: use more of them there, or "
                'elements="auto", which are placed by it',
                CoarseMeshWarning,
            )
