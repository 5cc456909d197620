"""Stress of a beam: over its sections, the extremes and peaks along it, and the utilisation of the strength."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from beamfem.element.fields import Axis
from beamfem.errors import InputError, UnknownStressWarning, warn
from beamfem.mesh.beam_grid import Grid
from beamfem.mesh.beam_mesh import BeamMesh, JoinedMesh
from beamfem.mesh.reference import sections_at
from beamfem.model.along_beam import jumps_along
from beamfem.model.beam import Beam, beam_in_words, names
from beamfem.model.imposed_strains import heat_of
from beamfem.results.axis_points import AxisPoints
from beamfem.results.batched_beams import of_beam
from beamfem.results.extremes import Measure, Part, Peak, estimate, extreme_of_beams
from beamfem.results.section_forces import at_points, in_parts, peak_of, stations
from beamfem.results.solution import Solution
from beamfem.results.solution_system import imposing
from beamfem.section.moments import expands_evenly, materials_of, thermal_strain
from beamfem.section.protocol import CrossSection
from beamfem.units import Units, units_of
from beamfem.validation import require_known, shown


def von_mises(along: np.ndarray, sheared: np.ndarray) -> np.ndarray:
    """Return the von Mises stress sqrt(sigma^2 + 3 tau^2) [Pa] of a normal and a shear stress."""
    return np.sqrt(along**2 + 3.0 * sheared**2)


def in_the_plane(along: np.ndarray, sheared: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Return the stress tensor (steps, points, heights, 6) [Pa] in global axes: xx, yy, zz, xy, yz, xz.

    along, sheared (steps, points, heights) [Pa]: along the normal (steps, points, 2) of the section, and in it.
    """
    x, y = normal[..., None, 0], normal[..., None, 1]
    zero = np.zeros_like(along)
    both = along * x * y + sheared * (x**2 - y**2)
    parts = (along * x**2 - 2.0 * sheared * x * y, along * y**2 + 2.0 * sheared * x * y, zero, both, zero, zero)
    return np.stack(parts, axis=-1)


def second_piola_kirchhoff(cauchy: np.ndarray, now: Axis, reference: Axis, y: np.ndarray) -> np.ndarray:
    """Return the second Piola-Kirchhoff stress (steps, points, heights, 6) [Pa] for a Cauchy stress, in this order.

    S = det(F) F^-1 sigma F^-T in global axes, with F = (r0' + y d', d) J^-1 and J the same for the reference
    configuration; nan where F is singular.
    """
    (ax, ay), (bx, by) = _derivatives(now, y)
    (jx, jy), (kx, ky) = _derivatives(reference, y)
    xx, yy, xy = (cauchy[..., component] for component in (0, 1, 3))
    # det(G) G^-1 sigma G^-T det(G) with the columns a and b of G: minors instead of the inverse avoid a division
    first = by**2 * xx - 2.0 * bx * by * xy + bx**2 * yy
    second = ay**2 * xx - 2.0 * ax * ay * xy + ax**2 * yy
    mixed = (ax * by + ay * bx) * xy - ay * by * xx - ax * bx * yy
    size = (ax * by - ay * bx) * (jx * ky - jy * kx)
    size = np.where(size == 0.0, np.nan, size)
    of_x, of_y, zero = (jx, kx), (jy, ky), np.zeros_like(xx)

    def component(one: tuple[np.ndarray, ...], other: tuple[np.ndarray, ...]) -> np.ndarray:
        (j, k), (n, m) = one, other
        return (j * n * first + (j * m + n * k) * mixed + k * m * second) / size

    parts = (component(of_x, of_x), component(of_y, of_y), zero, component(of_x, of_y), zero, zero)
    return np.stack(parts, axis=-1)


def _derivatives(axis: Axis, y: np.ndarray) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Return components x and y (..., points, heights) of the derivatives of the position by arc length and by y."""
    along = axis.r_s[..., None, :] + y[..., None] * axis.d_s[..., None, :]
    up = np.broadcast_to(axis.d[..., None, :], along.shape)
    return [along[..., 0], along[..., 1]], [up[..., 0], up[..., 1]]


def strengths(grid: Grid, element: np.ndarray, xi: np.ndarray, layers: int) -> np.ndarray:
    """Return the strength (layers, n) [Pa] of each layer of the sections at points (element, xi); nan if none is given.

    Sections with fewer layers repeat the last one.
    """
    rows = []
    for section in sections_at(grid, element, xi):
        own = [material.strength for material in materials_of(section, grid.beam.material)] or [None]
        rows.append((own + own[-1:] * layers)[:layers])  # the last one counts for missing layers too
    return np.broadcast_to(np.array(rows, dtype=float).T, (layers, len(element)))


_NAMED = 10  # beams that the warning names


def warn_of_unknown_stress(beams: Sequence[Beam], unknown: Sequence[int], what: str) -> None:
    """Warn of beams by their numbers, if there are any; what: what becomes of their stress, such as "left out".

    Arms of bodies are no beams of the user's, and have no stress.
    """
    made = [number for number, beam in enumerate(beams) if beam.holding is None]
    unknown = [number for number in unknown if number in made]
    if not unknown:
        return
    called = names(beams)
    shown = ", ".join(called[number] for number in unknown[:_NAMED]) + (", ..." if len(unknown) > _NAMED else "")
    warn(
        f"the stress of {len(unknown)} of {len(made)} beams ({shown}) is not known and is {what}: their sections are "
        "given by a stiffness, a law of their own, or moments without a height; Section(..., height=) gives it",
        UnknownStressWarning,
    )


def stress_in_layer(
    solution: Solution,
    points: AxisPoints,
    layer: int | None,
    y: np.ndarray,
    forces: np.ndarray,
    rows: slice | np.ndarray = slice(None),
) -> tuple[np.ndarray, np.ndarray]:
    """Return normal and shear stress (steps, n, heights) [Pa] of section forces (steps, 3, n), see `self_stress`."""
    along = points.distributions.normal_stress(layer, y, forces[:, 0], forces[:, 2])
    along = along + self_stress(solution, points, layer, y, rows)
    return along, points.distributions.shear_stress(layer, y, forces[:, 1])


def self_stress(
    solution: Solution, points: AxisPoints, layer: int | None, y: np.ndarray, rows: slice | np.ndarray = slice(None)
) -> np.ndarray | float:
    """Return E (eps - y kappa - alpha T(y)) (steps, n, heights) [Pa] at points of a beam; 0 if there is none.

    eps, kappa: free strains of the section; y (n, heights) [m]; layer: the one, of several, to which y belongs; None:
    the one at the axis. It does not contribute to section forces.
    """
    mesh, element, xi = points.mesh, points.element, points.xi
    if not any(part.beam in solution.model.imposed_on for part in mesh.parts):
        return 0.0
    if isinstance(mesh, JoinedMesh):
        result = np.zeros((len(solution.computed(imposing)[rows]), *y.shape))
        for part, some, own in mesh.by_beam(element):
            result[:, some] = self_stress(solution, AxisPoints(part, own, xi[some]), layer, y[some], rows)
        return result
    beam = mesh.beam
    imposed = solution.model.imposed_on[beam]
    sections = sections_at(mesh, element, xi)
    if all(expands_evenly(section, beam.material) for section in sections):
        return 0.0
    each = sections * len(y) if len(sections) == 1 else sections
    units = np.array([_units(section, mesh, layer, heights) for section, heights in zip(each, y, strict=True)])
    factors = solution.computed(imposing)[rows]
    result = np.zeros((len(factors), *y.shape))
    for number, load in imposed:
        inside = mesh.arc_length_inside(element, xi, jumps_along(load))
        result += factors[:, number, None, None] * np.einsum("nhc,nc->nh", units, heat_of(load, inside))
    return result


def _units(section: CrossSection, mesh: BeamMesh, layer: int | None, y: np.ndarray) -> np.ndarray:
    """Return the stress (heights, 2) [Pa] for a change of 1 K and a gradient of 1 K/m."""
    material = mesh.beam.material
    if layer is None:
        materials = [part for part, present in section.materials_at(np.zeros(1), material) if present.any()]
    else:
        parts = section.moments(material)
        materials = [parts[min(layer, len(parts) - 1)][0]]
    free = thermal_strain(section, material)
    hindered = free[0] - y[:, None] * free[1] - materials[0].thermal_expansion * np.column_stack([np.ones_like(y), y])
    return np.asarray(materials[0].youngs_modulus * hindered)


PARTS: tuple[Part, ...] = ("lower", "upper", "tension", "compression", "shear", "von_mises", "utilisation")
HEIGHTS = np.linspace(0.0, 1.0, 9)  # fractions of a layer: its faces, and the peak of a parabolic shear stress
_VALUES = 4_000_000  # most values in one array


@dataclass(frozen=True)
class BeamStress:
    """Extreme stresses of the sections of a beam, at the stations of its section forces.

    Between stations stresses may be larger: `peak` finds their extremes there too. The stress is the Cauchy stress, as
    in `Fields`; it is nan for sections that define none. Each layer is evaluated at its faces and at seven heights
    between them.

    Parameters
    ----------
    arc_length : array, [m], (stations,)
        Arc lengths of the stations, as in `SectionForces`.
    lower, upper : array, [Pa], (steps, stations)
        Normal stress at the two faces.
    tension, compression : array, [Pa], (steps, stations)
        Largest and smallest normal stress over the height.
    shear : array, [Pa], (steps, stations)
        Largest magnitude of the shear stress over the height.
    von_mises : array, [Pa], (steps, stations)
        Largest sqrt(sigma^2 + 3 tau^2) over the height; at the faces only if the shear stress inside is not known.
    utilisation : array, [-], (steps, stations)
        Largest ratio of von Mises stress to the strength of the material there; nan if no strength is given
        (`Material`).
    at : array, (steps,)
        Load factors, or times of a motion [s].
    beam : Beam
        The beam.
    static : bool, default True
        Whether `at` are load factors.
    units : Units
        Units of the model, for the text of peaks.
    solution : Solution
        The solution, which `peak` evaluates between stations.

    Examples
    --------
    >>> stress = solution.stresses(beam)
    >>> float(stress.tension[-1, 0].round(-5))  # at the clamp
    240000000.0
    """

    arc_length: np.ndarray
    lower: np.ndarray
    upper: np.ndarray
    tension: np.ndarray
    compression: np.ndarray
    shear: np.ndarray
    von_mises: np.ndarray
    utilisation: np.ndarray
    at: np.ndarray
    beam: Beam
    static: bool = True
    units: Units = field(default=Units(), repr=False)
    solution: Solution = field(repr=False, kw_only=True)

    def __repr__(self) -> str:
        rows, stations = self.von_mises.shape
        told: tuple[Part, ...] = ("tension", "compression", "von_mises", "utilisation")
        known = [part for part in told if np.isfinite(getattr(self, part)).any()]
        peaks = "; ".join(f"{part} {self.peak(part).in_words}" for part in known) or "none is known"
        return f"BeamStress({rows} rows, {stations} stations of {self.beam!r}; peaks: {peaks})"

    def _repr_html_(self) -> str:
        from beamfem.view.summary import stress_table

        return stress_table(self)

    def peak(self, part: Part = "von_mises") -> Peak:
        """Return the peak along the beam, at and between its stations, and over the rows.

        It is the smallest value of `compression`, the largest magnitude of `lower` and `upper`, and the largest value
        of the others; nan if no value is known. part: "lower", "upper", "tension", "compression", "shear", "von_mises"
        or "utilisation". Raises InputError for another one.

        Examples
        --------
        >>> value, arc_length, row = solution.stresses(beam).peak("tension")
        >>> round(arc_length, 3), row
        (0.0, 1)
        """
        require_known(f"there is no stress {shown(part)}", part, PARTS)
        unit = "-" if part == "utilisation" else "Pa"

        def at(solution: Solution, points: AxisPoints, rows: np.ndarray) -> np.ndarray:
            return stress_at(solution, points, rows)[part]

        return peak_of(self.solution, self.beam, (part, unit), getattr(self, part), _measure(part), at)


def beam_stress(solution: Solution, beam: Beam) -> BeamStress:
    """Return the stress of a beam at the stations of its section forces."""
    number = solution.model.number_of(beam)
    stress = dict(zip(PARTS, of_beam(solution, number, _at_stations), strict=True))
    arc = stations(solution.model.meshes[number]).arc_length
    units = units_of(solution.model.units)
    return BeamStress(arc, at=solution.at, beam=beam, static=solution.static, units=units, solution=solution, **stress)


def _at_stations(solution: Solution, mesh: BeamMesh) -> np.ndarray:
    """Return all parts of the stress (parts, steps, stations)."""
    stress = stress_at(solution, stations(mesh))
    return np.stack([stress[part] for part in PARTS])


def peak_stress(solution: Solution, part: Part = "von_mises") -> Peak:
    """Return the peak of a stress over all beams and rows, as `BeamStress.peak`; nan if none is known.

    Warns of beams with sections that define no stress.
    """
    require_known(f"there is no stress {shown(part)}", part, PARTS)
    measure, beams = _measure(part), solution.model.beams
    by_mesh = zip(solution.model.meshes, (getattr(beam_stress(solution, beam), part) for beam in beams), strict=True)
    sizes = np.array([estimate(*stations(mesh).by_element(values), measure) for mesh, values in by_mesh])
    unknown = np.isnan(sizes)
    if part != "utilisation":  # which a material without a strength does not have either
        what = "nan" if unknown.all() else "left out"
        warn_of_unknown_stress(beams, np.flatnonzero(unknown).tolist(), what)
    return extreme_of_beams(sizes, measure, lambda number: beam_stress(solution, beams[number]).peak(part))[1]


def safety_factor(solution: Solution, beam: Beam | None) -> float:
    """Return strength over the largest von Mises stress of a beam, or of all, see `Solution.safety_factor`."""
    beams = solution.model.beams if beam is None else (beam,)
    peaks = [beam_stress(solution, each).peak("utilisation").value for each in beams]
    unknown = [number for number, value in enumerate(peaks) if not np.isfinite(value)]
    if len(unknown) == len(peaks):
        raise InputError(
            "a safety factor needs the strength of a material, Material(..., strength=), and a section with a stress, "
            "such as Rectangle, Profile or Section(..., height=)"
        )
    if unknown:
        named = ", ".join(beam_in_words(solution.model.beams, number) for number in unknown)
        warn(f"the safety factor leaves out what has no known strength or stress: {named}", UnknownStressWarning)
    largest = max(value for value in peaks if np.isfinite(value))
    return 1.0 / largest if largest > 0.0 else np.inf


def _measure(part: Part) -> Measure:
    """Return what is largest at the peak."""
    return np.negative if part == "compression" else np.abs if part in ("lower", "upper") else np.asarray


def stress_at(solution: Solution, points: AxisPoints, rows: slice | np.ndarray = slice(None)) -> dict[str, np.ndarray]:
    """Return the stresses of `BeamStress` (steps, points) of some rows at points of a beam, by name."""
    chunk = max(1, _VALUES // (len(HEIGHTS) * max(len(points.xi), 1)))
    chosen = list(in_parts(len(solution), rows, chunk)) or [slice(0)]
    parts = [_of_rows(solution, points, part) for part in chosen]
    return {name: np.concatenate([part[name] for part in parts]) for name in parts[0]}


def stress_over_height(solution: Solution, points: AxisPoints, rows: slice | np.ndarray, name: str) -> np.ndarray:
    """Return a stress (rows, points, layers, heights) at equal distances between the faces of each layer.

    A shear stress that is not known there, as the width is not, counts as zero.
    """
    layers = _layers(solution, points, rows)
    parts = [
        (von_mises(along, np.where(np.isnan(sheared), 0.0, sheared)), strength) for along, sheared, strength in layers
    ]
    ratio = name == "utilisation"
    return np.stack([values / strength if ratio else values for values, strength in parts], axis=2)


def _of_rows(solution: Solution, points: AxisPoints, rows: slice | np.ndarray) -> dict[str, np.ndarray]:
    extremes = dict[str, np.ndarray]()
    for along, sheared, strength in _layers(solution, points, rows):
        equivalent = von_mises(along, sheared)
        stresses = {
            "lower": along[..., 0],
            "upper": along[..., -1],
            "tension": along.max(axis=-1),
            "compression": along.min(axis=-1),
            "shear": _largest_of_parabola(sheared),
            # without a known width there is no shear stress inside: the faces, free of shear stress, still count
            "von_mises": np.fmax.reduce(equivalent, axis=-1),
            "utilisation": np.fmax.reduce(equivalent / strength, axis=-1),
        }
        # missing layers of a section coincide with its upper face
        joined = {name: _JOINED.get(name, np.fmax)(extremes[name], stresses[name]) for name in extremes}
        extremes = joined or stresses
    return extremes


# of layers from the bottom up
_JOINED: dict[str, Callable[[np.ndarray, np.ndarray], np.ndarray]] = {
    "lower": lambda before, layer: before,
    "upper": lambda before, layer: layer,
    "compression": np.fmin,
}


_PARABOLIC = 1e-9  # of the largest stress: deviation from a parabola through three heights


def _largest_of_parabola(stress: np.ndarray) -> np.ndarray:
    """Return the largest magnitude (...,) over `HEIGHTS` (..., heights), also between them if it is a parabola."""
    largest = np.abs(stress).max(axis=-1)
    first, middle, last = stress[..., 0], stress[..., len(HEIGHTS) // 2], stress[..., -1]
    bend, slope = 2.0 * (first + last - 2.0 * middle), 4.0 * middle - 3.0 * first - last
    with np.errstate(divide="ignore", invalid="ignore"):
        place = -slope / (2.0 * bend)
        vertex = np.abs(first - slope**2 / (4.0 * bend))
    parabola = first[..., None] + HEIGHTS * (slope[..., None] + HEIGHTS * bend[..., None])
    fits = np.abs(stress - parabola).max(axis=-1) <= _PARABOLIC * largest
    inside = (place > 0.0) & (place < 1.0) & fits
    return np.where(inside, np.fmax(largest, vertex), largest)


def _layers(
    solution: Solution, points: AxisPoints, rows: slice | np.ndarray
) -> Iterator[tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Yield normal and shear stress (rows, points, heights) [Pa] and the strength (points, 1) [Pa] of each layer."""
    forces, layers = at_points(solution, points, rows), points.distributions.layers
    strength = strengths(points.mesh, points.element, points.xi, layers.shape[1])
    for layer in range(layers.shape[1]):
        low, high = np.moveaxis(layers[:, layer], -1, 0)
        y = low[:, None] + (high - low)[:, None] * HEIGHTS
        yield *stress_in_layer(solution, points, layer, y, forces, rows), strength[layer][:, None]
