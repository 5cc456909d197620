"""A beam: axis, mesh, element, section and material, and the checks where it is made."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal, cast

import numpy as np
from skfem import MeshLine, MeshLine1

from beamfem.cached_properties import cached_property
from beamfem.curves import BSpline, Curve, Line
from beamfem.curves.curve import numbers
from beamfem.damping import Damping
from beamfem.element.coordinates import ShearFree
from beamfem.element.element import CRBF, Element
from beamfem.element.fields import Cubic
from beamfem.element.forces import Structural
from beamfem.errors import InputError
from beamfem.material import Material
from beamfem.model.jumps import find_jumps
from beamfem.section.law import ConstitutiveLaw, SectionLaw, law_of
from beamfem.section.moments import expansion
from beamfem.section.protocol import CrossSection
from beamfem.validation import (
    LARGEST,
    SMALLEST,
    called,
    count,
    finite,
    fulfils,
    function_of_one,
    members,
    positive,
    shown,
    text,
)


def require_different_names(beams: Sequence["Beam"]) -> None:
    """Raise InputError for a name of two beams, or for the number of a beam without a name as the name of another."""
    beam_names = [beam.name for beam in beams if beam.name is not None]
    if not beam_names:
        return
    counts = Counter(beam_names)
    for name, number in counts.items():
        if number > 1:
            raise InputError(f"{number} beams of a Model have the name {name!r}; give each one of its own, or none")
    for number, beam in enumerate(beams):
        if beam.name is None and str(number) in counts:
            raise InputError(f"a beam has the name {str(number)!r}, the number of one without a name; name both")


def names(beams: Sequence["Beam"]) -> list[str]:
    """Return the name of every beam, or its number if it has none."""
    return [str(number) if beam.name is None else beam.name for number, beam in enumerate(beams)]


def beam_in_words(beams: Sequence["Beam"], number: int) -> str:
    """Return "beam 'arm'" for a beam with a name, "beam 3" for one without."""
    name = beams[number].name
    return f"beam {number if name is None else repr(name)}"


def retardation_time(section: CrossSection, material: Material | None) -> float:
    """Return the retardation time [s] of a section; material: that of its beam, which layered sections do not need.

    Raises InputError if layers have different ones.
    """
    try:
        times = {part_material.retardation_time for part_material, _ in section.moments(material)}
    except InputError:  # known by its stiffness
        return 0.0 if material is None else material.retardation_time
    if len(times) > 1:
        raise InputError(
            f"the materials of a {type(section).__name__} section have different retardation times {sorted(times)}; "
            "a beam has one: damping is proportional to its stiffness"
        )
    return times.pop()


Tapered = Callable[[float], CrossSection]
_SAMPLES = 32
_ENDS = 1e-9  # of the length: tolerance of the ends of a mesh
_ELEMENT = CRBF(order=4)
_FIRST_ELEMENTS, _MOST_FIRST = 1, 256  # of a beam whose mesh is refined to an accuracy
_LARGEST_TURN = 1.01 * np.pi  # of the axis within one of them: sections overlap where it turns further


@dataclass(frozen=True, eq=False)
class Beam:
    """A beam along a curve, which is its stress-free configuration.

    Raises InputError for an invalid value, also if the squares of the stiffness, mass or lengths exceed double
    precision.

    Parameters
    ----------
    curve : Curve
        Axis of the beam in the reference.
    elements : int, sequence of float, MeshLine, "auto" or "knots", default "auto"
        Number of equal elements; or the fractions of the arc length from 0 to 1 at which elements end; or a mesh of
        scikit-fem over the arc length [m] from the start; or "auto" for a mesh that analyses refine to an accuracy, by
        default 1e-4, see `solve_static`; or "knots" for one cubic element per knot span of a cubic BSpline, which it
        represents exactly.
    element : Element, default CRBF(order=4)
        Kind of the elements.
    section : Section or callable
        A section, or a function of the arc length [m] from the start that returns one.
    material : Material, optional
        Material of the section; not needed if the section includes its materials.
    name : str, optional
        Name of the beam in messages, tables and files, by default its number in the model.
    damping : Rayleigh or KelvinVoigt, optional
        Damping in motions, by default only that of the material.

    Notes
    -----
    If a support, joint, point load or jump of the section requires a node inside an element, the element is divided; an
    element end that is very close (1 % of an element) is moved there instead. Jumps are found, or declared as `kinks`
    of the function.

    Examples
    --------
    >>> axis, height = bf.Line((0, 0), (2, 0)), bf.Interpolated([(0.0, 0.1), (2.0, 0.05)])
    >>> bf.Beam(axis, 4, bf.CRBF(order=3), lambda s: bf.Rectangle(0.05, height(s)), steel)
    Beam(Line of length 2, 4 x CRBF-3)
    """

    curve: Curve
    elements: int | Sequence[float] | np.ndarray | MeshLine1 | Literal["auto", "knots"] = "auto"
    element: Element = _ELEMENT
    section: CrossSection | Tapered | None = None
    material: Material | None = None
    name: str | None = None
    damping: Damping | None = None

    @property
    def holding(self) -> tuple[Any, ...] | None:
        """Joints of a beam that the model adds by itself, such as the arm of a rigid body; None for any other."""
        return None

    def require_place(self, fraction: float, parts: Sequence[Any]) -> None:
        """Raise InputError if no part may act at this fraction of the beam in a model with these parts."""

    def __post_init__(self) -> None:
        if not fulfils(self.curve, Curve):
            raise InputError(f"curve of a Beam must be a curve such as Line, got {shown(self.curve)}")
        if isinstance(self.elements, MeshLine1):
            object.__setattr__(self, "elements", _fractions_of(self.elements, self.curve.length))
        elif isinstance(self.elements, str):
            if self.elements != "auto":
                _check_knots(self.elements, self.curve, self.element)
        elif isinstance(self.elements, int | float | np.generic) or getattr(self.elements, "ndim", 1) == 0:
            object.__setattr__(self, "elements", count("elements", self.elements))
        else:
            object.__setattr__(self, "elements", _fractions(self.elements))
        if not isinstance(self.element, Element):
            raise InputError(f"element of a Beam must be an Element, such as CRBF(order=3), got {shown(self.element)}")
        if self.material is not None and not isinstance(self.material, Material):
            swapped = "; the section comes before the material" if isinstance(self.section, Material) else ""
            raise InputError(f"material of a Beam must be a Material, got {shown(self.material)}{swapped}")
        if self.name is not None and not text("name of a Beam", self.name).strip():
            raise InputError("name of a Beam must not be empty; leave it out for a beam without one")
        if self.name is not None and ("\0" in self.name or any("\ud800" <= sign <= "\udfff" for sign in self.name)):
            raise InputError(f"name of a Beam must not contain NUL or half a surrogate pair, got {self.name!r}")
        if self.damping is not None and not isinstance(self.damping, Damping):
            raise InputError(
                "damping of a Beam must be a Rayleigh, such as Rayleigh(stiffness=1e-4), or a KelvinVoigt, got "
                f"{shown(self.damping)}"
            )
        if isinstance(self.section, type) or not (self.prismatic or callable(self.section)):
            raise InputError(
                f"section of a Beam must be a section or a function of arc length, got {shown(self.section)}"
            )
        if not self.prismatic:
            function_of_one("section", self.section, "arc length")
        require_law_fits(self)
        for fraction in (0.0,) if self.prismatic else (0.0, 0.5, 1.0):
            section = self.section_at(fraction * self.curve.length)
            require_magnitudes(self, section)
            retardation_time(section, self.material)

    def __repr__(self) -> str:
        count = self.elements if isinstance(self.elements, int | str) else len(self.elements) - 1
        called = "" if self.name is None else f"{self.name!r}, "
        curve = f"{type(self.curve).__name__} of length {self.curve.length:g}"
        return f"Beam({called}{curve}, {count} x {self.element.name})"

    def _repr_html_(self) -> str:
        from beamfem.view.summary import beam_table

        return beam_table(self)

    @cached_property
    def prismatic(self) -> bool:
        """Whether the section is the same along the whole beam."""
        return fulfils(self.section, CrossSection)

    def section_at(self, arc_length: float) -> CrossSection:
        """Return the section at an arc length [m]. Raises InputError if a user's function returns anything else."""
        if self.prismatic:
            return cast(CrossSection, self.section)
        section = called("section", cast(Tapered, self.section), arc_length)
        if not fulfils(section, CrossSection):
            raise InputError(f"the section at arc length {arc_length:g} must be a section, got {shown(section)}")
        return section

    @cached_property
    def retardation_time(self) -> float:
        """Retardation time [s] of the section forces: that of the material plus what `damping` adds to it."""
        own = retardation_time(self.section_at(0.0), self.material)
        return own if self.damping is None else own + self.damping.stiffness

    @property
    def mass_damping(self) -> float:
        """Force against the velocity per mass [1/s]."""
        return 0.0 if self.damping is None else self.damping.mass

    @cached_property
    def law(self) -> ConstitutiveLaw | None:
        """Nonlinear law of the section, None for linear sections and for sections that vary along the beam."""
        return law_of(self.section, self.material) if self.prismatic else None

    def at(self, fraction: float) -> "Point":
        """Return the point at a fraction of the arc length, from 0 to 1.

        >>> beam.at(0.5).reference
        array([1., 0.])
        """
        return Point(self, fraction)

    @cached_property
    def jumps(self) -> tuple[float, ...]:
        """Arc lengths (nj,) [m] at which the section jumps, or has a declared kink."""
        if self.prismatic:
            return ()
        return find_jumps("section of a Beam", self.section, self._measured, self.curve.length, self.samples)

    @cached_property
    def mesh(self) -> MeshLine1:
        """Mesh over the arc length [m] from the start, before supports, joints and loads divide any element.

        Its boundaries are "start" and "end". If the section jumps, its subdomains are the parts between the jumps, "0",
        "1" and so on from the start.

        >>> beam.mesh.p[0]
        array([0. , 0.5, 1. , 1.5, 2. ])
        """
        from beamfem.mesh.beam_grid import make_grid

        ends = make_grid(self, [jump / self.curve.length for jump in self.jumps]).vertices
        boundaries = {"start": lambda s: s[0] == ends[0], "end": lambda s: s[0] == ends[-1]}
        mesh = MeshLine(ends).with_boundaries(boundaries)
        if not self.jumps:
            return mesh
        parts = np.searchsorted(np.array(self.jumps), 0.5 * (ends[1:] + ends[:-1]))
        return mesh.with_subdomains({str(part): np.flatnonzero(parts == part) for part in range(parts[-1] + 1)})

    @property
    def element_count(self) -> int:
        """Number of elements, before supports and loads divide any of them."""
        if self.elements == "auto":
            return self._first_elements
        if isinstance(self.elements, str):
            return len(cast(BSpline, self.curve).breaks) - 1
        return self.elements if isinstance(self.elements, int) else len(self.elements) - 1

    @cached_property
    def _first_elements(self) -> int:
        """Number of equal elements that follow the axis, doubled until none of them turns too far."""
        along = np.linspace(0.0, 1.0, 4 * _MOST_FIRST + 1)
        tangent = self.curve.tangent(along * self.curve.length)
        turned = np.append(0.0, np.cumsum(np.abs(np.diff(np.unwrap(np.arctan2(tangent[:, 1], tangent[:, 0]))))))
        elements = _FIRST_ELEMENTS
        while elements < _MOST_FIRST and np.diff(turned[:: 4 * _MOST_FIRST // elements]).max() > _LARGEST_TURN:
            elements *= 2
        return elements

    @property
    def shortest(self) -> float:
        """Length of the shortest element over that of the beam [-], before supports and loads divide any element.

        For one element per knot span it is the mean.
        """
        whole = isinstance(self.elements, int | str)
        return 1.0 / self.element_count if whole else float(np.diff(cast(Sequence[float], self.elements)).min())

    @property
    def samples(self) -> int:
        """Number of equal intervals in which jumps of functions of the arc length are searched for."""
        return max(self.element_count, _SAMPLES)

    def _measured(self, arc_length: float) -> np.ndarray:
        """Return the values of the section at an arc length that elastic forces, inertia, heat and drawings use."""
        section = self.section_at(arc_length)
        parts = (section.rigidity(self.material), section.inertia(self.material))
        numbers = [value for part in parts for value in vars(part).values()]
        return np.array([*numbers, *section.bounds, *expansion(section, self.material).ravel()])

    @property
    def start(self) -> "Point":
        """Point at the start of the axis, fraction 0."""
        return Point(self, 0.0)

    @property
    def end(self) -> "Point":
        """Point at the end of the axis, fraction 1."""
        return Point(self, 1.0)


@dataclass(frozen=True, slots=True)
class Point:
    """A point of a beam's axis.

    Raises InputError for a fraction outside 0 to 1.

    Parameters
    ----------
    beam : Beam
        The beam.
    fraction : float, [-]
        Fraction of the arc length, from 0 to 1.

    Examples
    --------
    >>> bf.Point(beam, 0.5) == beam.at(0.5)
    True
    """

    beam: Beam
    fraction: float

    def __post_init__(self) -> None:
        if not isinstance(self.beam, Beam):
            raise InputError(f"beam of a Point must be a Beam, got {shown(self.beam)}")
        fraction = finite("fraction", self.fraction)
        if not 0.0 <= fraction <= 1.0:
            length = self.beam.curve.length
            hint = f"; an arc length s is at the fraction s / {length:g}" if 1.0 < fraction <= length else ""
            raise InputError(f"the fraction along a beam lies between 0 and 1, got {fraction}{hint}")
        object.__setattr__(self, "fraction", fraction)

    @property
    def reference(self) -> np.ndarray:
        """Position (2,) [m] in the reference configuration."""
        return self.beam.curve.position(np.array([self.fraction * self.beam.curve.length]))[0]

    def __str__(self) -> str:
        x, y = self.reference
        beam = "its beam" if self.beam.name is None else f"beam {self.beam.name!r}"
        return f"({x:g}, {y:g}), fraction {self.fraction:g} of {beam}"


def require_point(kind: str, point: object, name: str = "point") -> None:
    """Raise InputError if the place given for a support, load or joint is not a point."""
    if not isinstance(point, Point):
        raise InputError(f"{name} of {kind} must be a Point, such as beam.end or beam.at(0.5), got {shown(point)}")


def require_point_of(item: object, name: str = "point") -> None:
    """Raise InputError if a field of a user-defined part is missing, or is not a point."""
    kind = type(item).__name__
    if not hasattr(item, name):
        raise InputError(f"{kind} has no field {name}; it needs one, for a Point such as beam.end or beam.at(0.5)")
    require_point(kind, getattr(item, name), name)


def require_beam(kind: str, beam: object) -> None:
    """Raise InputError if the place given for a load or foundation is not a beam."""
    if not isinstance(beam, Beam):
        raise InputError(f"beam of {kind} must be a Beam, one of the model's beams, got {shown(beam)}")


def reference_positions(points: Sequence[Point]) -> np.ndarray:
    """Return the reference positions (n, 2) [m] of points; those on straight beams are computed together."""
    result = np.empty((len(points), 2))
    curves = [point.beam.curve for point in points]
    straight = [(i, curve) for i, curve in enumerate(curves) if type(curve) is Line]
    for i, curve in enumerate(curves):
        if type(curve) is not Line:  # a subclass may be curved
            result[i] = points[i].reference
    if straight:
        indices, lines = zip(*straight, strict=True)
        fraction = np.array([points[i].fraction for i in indices])[:, None]
        start, end = np.array([line.start for line in lines]), np.array([line.end for line in lines])
        result[list(indices)] = (1.0 - fraction) * start + fraction * end
    return result


def _fractions(values: Sequence[float] | np.ndarray) -> tuple[float, ...]:
    """Return element ends given by a user as fractions. Raises InputError."""
    try:
        ends = numbers("elements", values)
    except InputError as error:
        raise InputError(f'elements must be a whole number, a list of fractions, "auto" or "knots": {error}') from None
    if len(ends) < 2 or ends[0] != 0.0 or ends[-1] != 1.0 or np.any(np.diff(ends) <= 0.0):
        raise InputError(
            f"elements as a list must rise from 0 to 1, the fractions where elements end, got {shown(ends)}"
        )
    return ends


def _fractions_of(mesh: MeshLine1, length: float) -> tuple[float, ...]:
    """Return the element ends of a mesh over the arc length [m] as fractions. Raises InputError."""
    order = np.argsort(mesh.p[0])
    ends, links = mesh.p[0, order], np.sort(np.argsort(order)[mesh.t], axis=0)
    links = links[:, np.argsort(links[0])]
    chain = np.arange(len(ends) - 1)
    if not np.array_equal(links, [chain, chain + 1]) or np.any(np.diff(ends) <= 0.0):
        raise InputError("elements as a MeshLine must be one chain of elements without gaps or overlaps")
    if not np.allclose([ends[0], ends[-1]], [0.0, length], rtol=0.0, atol=_ENDS * length):
        raise InputError(
            f"elements as a MeshLine must cover the arc length of the beam from 0 to {length:g}, got {ends[0]:g} to "
            f"{ends[-1]:g}"
        )
    return (0.0, *(ends[1:-1] / length).tolist(), 1.0)


def _check_knots(elements: str, curve: Curve, element: Element) -> None:
    """Raise InputError if elements, curve and element do not fit a mesh of knot spans."""
    if elements != "knots":
        raise InputError(f'elements must be a number, a list of fractions, "auto" or "knots", got {elements!r}')
    if not isinstance(curve, BSpline):
        raise InputError(f'elements="knots" needs a BSpline as curve, got a {type(curve).__name__}')
    curve.hermite()
    if not isinstance(element.field, Cubic):
        raise InputError(f'elements="knots" needs a cubic element such as ANCF(), got {element.name}')


def graded(elements: int, ratio: float) -> tuple[float, ...]:
    """Return the ends of elements whose lengths grow geometrically, as fractions for `Beam(elements=...)`.

    Raises InputError if the number or the ratio is not positive, or an element would have no length.

    Parameters
    ----------
    elements : int
        Number of elements.
    ratio : float, [-]
        Length of the last element over that of the first; below 1 the lengths decrease.

    Examples
    --------
    >>> [round(end, 3) for end in bf.graded(3, ratio=4.0)]
    [0.0, 0.143, 0.429, 1.0]
    """
    number, ratio = count("elements", elements), positive("ratio", ratio)
    growth = ratio ** (1.0 / max(number - 1, 1))
    ends = np.cumsum(np.concatenate([[0.0], growth ** np.arange(number)]))
    ends /= ends[-1]
    if not np.all(np.diff(ends) > 0.0):
        raise InputError(f"a ratio of {ratio:g} leaves elements without length; take one closer to 1, or fewer")
    return (*(float(end) for end in ends[:-1]), 1.0)


def sections_along(beam: Beam, arc_length: np.ndarray) -> list[CrossSection]:
    """Return the sections at arc lengths (n,) [m]: a single one stands for all along a prismatic beam."""
    return [beam.section_at(at) for at in ([0.0] if beam.prismatic else arc_length.tolist())]


def require_law_fits(beam: Beam) -> None:
    """Raise InputError if the section has a law but the element assumes a linear one, or if the law returns
    arrays of another shape or numbers that are not finite.

    A law is a function of all strains at one point. Elements that evaluate some strains at other points, or scale them
    there, are defined for quadratic energies only. A shear that is zero at the nodes, for example, is 3/2 of its mean
    at the midpoint: no factor and weight give a law both this mean and the stretch and curvature of the point.
    """
    if not beam.prismatic:
        section = beam.section_at(0.0)
        _require_whole(section)
        if fulfils(section, SectionLaw):
            raise InputError(
                "the section of a Beam is a function of the arc length, but a section with a law of its own must be "
                "the same all along: join beams, each with its own"
            )
        return
    if beam.law is None:
        _require_whole(beam.section)
        return
    name = type(beam.section).__name__
    element = beam.element
    if not isinstance(element.forces, Structural):
        raise InputError(
            f"{name} has a law of its own, of stretch, shear and curvature: it needs Structural forces, such as "
            f"CRBF(order=2) or ANCF(Structural()), but the element {element.name} has {type(element.forces).__name__}"
        )
    if not element.law_points:
        why = ", since its nodes do not shear" if isinstance(element.coordinates, ShearFree) else ""
        raise InputError(
            f"{name} has a law of its own, for stretch, shear and curvature at one point; the element {element.name} "
            f'with integration="{element.integration}" takes some of them at other points or scales them{why}: use '
            "CRBF(order=3), ANCF(Structural()), ANCFCRBF(Structural()) or, without shear at the nodes, "
            'ShearRigid(stretchable=False, integration="reduced")'
        )
    require_shapes(beam.law)


def require_shapes(law: ConstitutiveLaw) -> None:
    """Raise InputError if a law returns arrays of another shape, or numbers that are not finite, at zero strain."""
    if not fulfils(law.section, CrossSection):
        raise InputError(f"{law.name} has resultants, but is no section: it lacks members of CrossSection")
    zero, start = np.zeros((2, 3)), law.at_start(2)
    values = [*law.linearised(zero, start), law.energy(zero, start)]
    if law.remembers:
        values.append(law.remember(zero, start))
    if not all(np.isfinite(each).all() for each in values):
        raise InputError(f"resultants, tangent and energy of {law.name} must be finite at zero strain")


def _require_whole(section: object) -> None:
    """Raise InputError if a section has some methods of a law only: it would be taken as linear without a word."""
    lacking = [name for name in members(SectionLaw) if not hasattr(section, name)]
    found = [name for name in ("resultants", "energy", "remember") if hasattr(section, name)]
    if found and lacking:
        raise InputError(
            f"{type(section).__name__} has {found[0]}, but no {lacking[0]}: a section law needs "
            "resultants(strain, material) and energy(strain, material)"
        )


_PLACES = 5  # points of a curve at which its coordinates are checked


def require_magnitudes(beam: Beam, section: CrossSection) -> None:
    """Raise InputError if the square of a quantity that solvers compute from a beam exceeds double precision.

    The quantities are coordinates and the length h of the shortest element [m]; E A and k_s G A, also times and over h;
    E I / h and E I / h^3; the mass of an element and its rotary inertia over h^2; and for bodies, the section moments
    times E over powers of h.
    """
    for name, value in _quantities(beam, section):
        if not SMALLEST <= value <= LARGEST:
            raise InputError(
                f"{name} of {beam!r} is {value:g}, beyond what double precision can square ({SMALLEST:.1g} to "
                f"{LARGEST:.1g}); give all lengths, forces and masses in units in which they are closer to 1"
            )


def _quantities(beam: Beam, section: CrossSection) -> list[tuple[str, float]]:
    """Return the quantities as Python floats, whose products and quotients overflow without a warning."""
    curve = beam.curve
    length = float(curve.length)
    if type(curve) is Line:
        reach = max(*map(abs, curve.start), *map(abs, curve.end), 1.0)
    else:
        reach = max(float(np.abs(curve.position(np.linspace(0.0, length, _PLACES))).max()), 1.0)
    h = length * beam.shortest
    lengths = [("the length", length), ("the largest coordinate", reach), ("the length h of the shortest element", h)]
    if not h > 0.0:
        return lengths
    with np.errstate(over="ignore", under="ignore", invalid="ignore"):
        rigidity, inertia = section.rigidity(beam.material), section.inertia(beam.material)
        parts = section.moments(beam.material) if beam.element.forces.fills_body else []
    axial, shear, bending = float(rigidity.axial), float(rigidity.shear), float(rigidity.bending)
    result = [
        *lengths,
        ("E A", axial),
        ("E A / h", axial / h),
        ("E A h", axial * h),
        ("k_s G A", shear),
        ("k_s G A / h", shear / h),
        ("k_s G A h", shear * h),
        ("E I / h", bending / h),
        ("E I / h^3", bending / h / h / h),
        ("the mass of an element", float(inertia.mass) * h),
        ("the rotary inertia of an element over h^2", float(inertia.rotary) / h),
    ]
    for material, moments in parts:
        area, second, fourth = (material.youngs_modulus * moments[order].item() / h for order in (0, 2, 4))
        result += [
            ("E times the moment of order 0 over h^1", area),
            ("E times the moment of order 2 over h^3", second / h / h),
            ("E times the moment of order 4 over h^5", fourth / h / h / h / h),
        ]
    return result
