"""Bad curves, sections, materials and elements get an error that names them where they are given."""

import numpy as np
import pytest
from bad_inputs import END, INF, LINE, NAN, SECTION, STEEL, Unreadable, a_beam, require_named

import beamfem as bf

BAD = bf.InputError
SPLINE = {"degree": 2, "knots": (0, 0, 0, 1, 1, 1), "control_points": ((0, 0), (1, 1), (2, 0))}
SQUARE = (lambda u: (u, u * u), 0.0, 1.0)
HERMITE = ((0, 1), ((0, 0), (1, 0)), ((1, 0), (1, 0)))

CURVES = {
    "line without length": (lambda: bf.Line((1, 1), (1, 1)), BAD, "two different points"),
    "line with nan": (lambda: bf.Line((0, NAN), (1, 1)), BAD, "start of Line must be two finite"),
    "line with three numbers": (lambda: bf.Line((0, 0, 0), (1, 1)), BAD, "start of Line"),
    "line of text": (lambda: bf.Line("00", (1, 1)), BAD, "start of Line must be two numbers"),
    "line of bytes": (lambda: bf.Line(b"ab", (1, 1)), BAD, "start of Line must be two numbers"),
    "line of a set": (lambda: bf.Line({0.0, 1.0}, (1, 1)), BAD, "start of Line must be two numbers"),
    "line of a mapping": (lambda: bf.Line({0: 1, 1: 2}, (1, 1)), BAD, "start of Line must be two numbers"),
    "line of truth values": (lambda: bf.Line((True, False), (1, 1)), BAD, "start of Line must be two numbers"),
    "line of one number": (lambda: bf.Line(0.0, (1, 1)), BAD, "start of Line must be two numbers"),
    "line of complex numbers": (lambda: bf.Line((0, 1j), (1, 1)), BAD, "start of Line must be two numbers"),
    "line to infinity": (lambda: bf.Line((0, 0), (INF, 1)), BAD, "end of Line must be two finite"),
    "line of a whole number beyond floats": (lambda: bf.Line((0, 0), (10**400, 1)), BAD, "end of Line"),
    "line to an array of four": (lambda: bf.Line((0, 0), np.ones((2, 2))), BAD, "end of Line"),
    "line to what has no text": (lambda: bf.Line((0, 0), Unreadable()), BAD, "an object of Unreadable"),
    "arc of no radius": (lambda: bf.Arc((0, 0), 0.0, 0.0, 1.0), BAD, "radius of Arc must be greater than zero"),
    "arc of radius as an array": (lambda: bf.Arc((0, 0), np.ones(1), 0.0, 1.0), BAD, "radius of Arc must be a number"),
    "arc of no angle": (lambda: bf.Arc((0, 0), 1.0, 2.0, 2.0), BAD, "two different angles"),
    "arc to nan": (lambda: bf.Arc((0, 0), 1.0, 0.0, NAN), BAD, "end_angle of Arc must be finite"),
    "arc of a huge whole number": (lambda: bf.Arc((0, 0), 10**400, 0.0, 1.0), BAD, "radius of Arc .* double precision"),
    "polyline of one point": (lambda: bf.Polyline([(0, 0)]), BAD, "at least two points"),
    "polyline of text": (lambda: bf.Polyline("abc"), BAD, "points must be a list"),
    "polyline that stands still": (lambda: bf.Polyline([(0, 0), (0, 0), (1, 0)]), BAD, "points 0 and 1"),
    "polyline with nan": (lambda: bf.Polyline([(0, 0), (NAN, 0)]), BAD, r"points\[1\] must be two finite"),
    "polyline of a set": (lambda: bf.Polyline({(0, 0), (1, 0)}), BAD, "points must be a list"),
    "chain of nothing": (lambda: bf.Chain([]), BAD, "at least one curve"),
    "chain of a number": (lambda: bf.Chain([LINE, 1.0]), BAD, r"curves\[1\] of a Chain must be a curve"),
    "chain of a class": (lambda: bf.Chain(bf.Line), BAD, "curves of a Chain must be a list"),
    "chain with a gap": (lambda: bf.Chain([LINE, bf.Line((2, 0), (3, 0))]), BAD, "must start where"),
    "spline of half a degree": (
        lambda: bf.BSpline(**SPLINE | {"degree": 2.5}),
        BAD,
        "degree of BSpline",
    ),
    "spline of degree zero": (
        lambda: bf.BSpline(**SPLINE | {"degree": 0}),
        BAD,
        "must be at least 1",
    ),
    "spline without knots": (lambda: bf.BSpline(**SPLINE | {"knots": None}), BAD, "knots must be a list"),
    "spline of too few knots": (lambda: bf.BSpline(**SPLINE | {"knots": (0, 0, 1, 1)}), BAD, "need 6, got 4"),
    "spline of falling knots": (lambda: bf.BSpline(**SPLINE | {"knots": (0, 0, 1, 0, 1, 1)}), BAD, "must not decrease"),
    "spline of a point of text": (
        lambda: bf.BSpline(**SPLINE | {"control_points": ("a", "b", "c")}),
        BAD,
        r"control_points\[0\]",
    ),
    "spline of weight zero": (lambda: bf.BSpline(**SPLINE, weights=(1, 0, 1)), BAD, r"weights\[1\] must be greater"),
    "spline of two weights": (lambda: bf.BSpline(**SPLINE, weights=(1, 1)), BAD, "control points need 3, got 2"),
    "parametric of no function": (lambda: bf.Parametric(1.0, 0, 1), BAD, "function of a Parametric"),
    "parametric of no length": (lambda: bf.Parametric(lambda u: (u, u), 1, 1), BAD, "two different parameters"),
    "parametric to text": (lambda: bf.Parametric(lambda u: (u, u), 0, "1"), BAD, "end of Parametric must be a number"),
    "parametric that raises": (lambda: bf.Parametric(lambda u: 1 / 0, 0, 1), BAD, "cannot be computed: ZeroDivision"),
    "parametric of one number": (lambda: bf.Parametric(lambda u: u, 0, 1), BAD, "two numbers"),
    "parametric of text": (lambda: bf.Parametric(lambda u: (u, "1"), 0, 1), BAD, "two numbers"),
    "parametric of truth values": (lambda: bf.Parametric(lambda u: (u, True), 0, 1), BAD, "two numbers"),
    "parametric of complex numbers": (lambda: bf.Parametric(lambda u: (u, u + 1j), 0, 1), BAD, "two numbers"),
    "parametric of nan": (lambda: bf.Parametric(lambda u: (u, NAN), 0, 1), BAD, "two finite numbers"),
    "parametric that stands still": (lambda: bf.Parametric(lambda u: (0.0, 0.0), 0, 1), BAD, "no length"),
    "parametric of a wrong derivative": (
        lambda: bf.Parametric(*SQUARE, derivative=lambda u: (1.0, u)),
        BAD,
        "not that of function",
    ),
    "ellipse of parallel axes": (lambda: bf.elliptic_arc((0, 0), (1, 0), (2, 0), 0, 1), BAD, "not be parallel"),
    "ellipse of no angle": (lambda: bf.elliptic_arc((0, 0), (1, 0), (0, 1), 1, 1), BAD, "two different angles"),
    "ellipse of 1e-300 rad": (lambda: bf.elliptic_arc((0, 0), (1, 0), (0, 1), 0, 1e-300), BAD, "no length"),
    "ellipse with a center of text": (lambda: bf.elliptic_arc("ab", (1, 0), (0, 1), 0, 1), BAD, "center"),
    "cubic of no numbers": (lambda: bf.spline_through_hermite("ab", *HERMITE[1:]), BAD, "u must be a list"),
    "cubic that falls": (lambda: bf.spline_through_hermite((1, 0), *HERMITE[1:]), BAD, "two increasing numbers"),
    "cubic of one point": (lambda: bf.spline_through_hermite((0, 1), [(0, 0)], HERMITE[2]), BAD, "r must be 2 finite"),
    "cubic of slopes of text": (lambda: bf.spline_through_hermite(*HERMITE[:2], ["a", "b"]), BAD, r"r_u\[0\]"),
    "knots of no spline": (lambda: bf.without_removable_knots(LINE), BAD, "removed from a BSpline"),
}

SECTIONS = {
    "negative width": (lambda: bf.Rectangle(-1.0, 1.0), BAD, "width of Rectangle must be greater"),
    "zero height": (lambda: bf.Rectangle(1.0, 0.0), BAD, "height of Rectangle must be greater"),
    "height of nan": (lambda: bf.Rectangle(1.0, NAN), BAD, "height of Rectangle must be finite"),
    "height of None": (lambda: bf.Rectangle(1.0, None), BAD, "height of Rectangle must be a number"),
    "width as True": (lambda: bf.Rectangle(True, 1.0), BAD, "width of Rectangle must be a number"),
    "shear factor of text": (lambda: bf.Rectangle(1.0, 1.0, "5/6"), BAD, "shear_factor of Rectangle must be a number"),
    "rectangle of 1e300": (lambda: bf.Rectangle(1e300, 1e300), BAD, "area of this Rectangle is inf"),
    "rectangle of 1e-300": (lambda: bf.Rectangle(1.0, 1e-300), BAD, "second moment of this Rectangle is 0"),
    "circle without diameter": (lambda: bf.Circle(0.0), BAD, "diameter of Circle must be greater"),
    "circle of 1e300": (lambda: bf.Circle(1e300), BAD, "area of this Tube is"),
    "tube of a thick wall": (lambda: bf.Tube(1.0, 0.6), BAD, "at most half its diameter"),
    "tube of no wall": (lambda: bf.Tube(1.0, 0.0), BAD, "thickness of Tube must be greater"),
    "infinite area": (lambda: bf.Section(INF, 1.0), BAD, "area of Section must be finite"),
    "negative second moment": (lambda: bf.Section(1.0, -1.0), BAD, "second_moment of Section must be greater"),
    "second moment of 1e300": (lambda: bf.Section(1.0, 1e300), BAD, "fourth_moment of Section must be finite"),
    "negative fourth moment": (lambda: bf.Section(1.0, 1.0, fourth_moment=-1.0), BAD, "fourth_moment of Section"),
    "fourth moment of no section": (lambda: bf.Section(1.0, 1.0, fourth_moment=0.5), BAD, "no section has less"),
    "centroid without height": (lambda: bf.Section(1.0, 1 / 12, centroid=0.5), BAD, "give its height"),
    "centroid above the height": (
        lambda: bf.Section(1.0, 1 / 12, height=1.0, centroid=2.0),
        BAD,
        "upper face",
    ),
    "second moment beyond the faces": (lambda: bf.Section(1.0, 1.0, height=1.0), BAD, "at most"),
    "zero stiffness": (lambda: bf.Section.from_stiffness(0, 1, 1, 1, 1), BAD, "axial of StiffnessSection"),
    "stiffness of text": (lambda: bf.Section.from_stiffness(1, "1", 1, 1, 1), BAD, "shear of StiffnessSection"),
    "too strong a coupling": (lambda: bf.Section.from_stiffness(1, 1, 1, 1, 1, 1.0), BAD, "gain energy"),
    "a coupling of 1e300": (lambda: bf.Section.from_stiffness(1, 1, 1, 1, 1, 1e300), BAD, "gain energy"),
    "layer of a number": (lambda: bf.Layer(2e11, 0.1), BAD, "material of a Layer"),
    "layer without thickness": (lambda: bf.Layer(STEEL, 0.0), BAD, "thickness of Layer must be greater"),
    "no layers": (lambda: bf.Layered([], 0.1), BAD, "list of Layer"),
    "layers of numbers": (lambda: bf.Layered([0.1, 0.2], 0.1), BAD, "list of Layer"),
    "one layer for a list": (
        lambda: bf.Layered(bf.Layer(STEEL, 0.1), 0.1),
        BAD,
        "layers of a Layered section must be a list",
    ),
    "layers of width nan": (lambda: bf.Layered([bf.Layer(STEEL, 0.1)], NAN), BAD, "width of Layered must be finite"),
    "axis of text": (
        lambda: bf.Layered([bf.Layer(STEEL, 0.1)], 0.1, "middle"),
        BAD,
        "axis of Layered must",
    ),
    "zero modulus": (lambda: bf.Material(0.0, 0.3, 1.0), BAD, "youngs_modulus of Material must be greater"),
    "modulus of words": (lambda: bf.Material("steel", 0.3, 1.0), BAD, "youngs_modulus of Material must be a number"),
    "modulus as text": (lambda: bf.Material("1", 0.3, 1.0), BAD, "youngs_modulus of Material must be a number"),
    "modulus as True": (lambda: bf.Material(True, 0.3, 1.0), BAD, "youngs_modulus of Material must be a number"),
    "modulus as a list": (lambda: bf.Material([1.0], 0.3, 1.0), BAD, "youngs_modulus of Material must be a number"),
    "modulus that is complex": (lambda: bf.Material(1 + 1j, 0.3, 1.0), BAD, "youngs_modulus"),
    "modulus as a complex scalar": (
        lambda: bf.Material(np.complex128(1.0), 0.3, 1.0),
        BAD,
        "youngs_modulus of Material",
    ),
    "modulus as an array": (lambda: bf.Material(np.ones(1), 0.3, 1.0), BAD, "youngs_modulus"),
    "incompressible": (lambda: bf.Material(1.0, 0.5, 1.0), BAD, "poisson_ratio of Material must lie"),
    "poisson of minus one": (lambda: bf.Material(1.0, -1.0, 1.0), BAD, "poisson_ratio of Material must lie"),
    "poisson of nan": (lambda: bf.Material(1.0, NAN, 1.0), BAD, "poisson_ratio of Material must be finite"),
    "no density": (lambda: bf.Material(1.0, 0.3, 0.0), BAD, "density of Material must be greater"),
}

ELEMENTS = {
    "unknown integration": (lambda: bf.ANCF(integration="ful"), BAD, 'did you mean "full"'),
    "integration as a number": (lambda: bf.CRBF(1, integration=2), BAD, "integration must be"),
    "integration as an array": (lambda: bf.CRBF(1, integration=np.ones(2)), BAD, "integration must be"),
    "forces as False": (lambda: bf.ANCF(False), BAD, "forces of an element"),
    "forces as an empty list": (lambda: bf.CRBF(1, []), BAD, "forces of an element"),
    "forces as an array": (lambda: bf.CRBF(1, np.ones(2)), BAD, "forces of an element"),
    "forces as a class": (lambda: bf.ANCF(bf.Structural), BAD, "forces of an element"),
    "forces by name": (lambda: bf.ShearRigid(forces="structural"), BAD, "forces of an element"),
    "field as a class": (lambda: bf.Element(bf.Cubic, bf.Rotation(), bf.Structural()), BAD, "field of an element"),
    "coordinates as a field": (lambda: bf.Element(bf.Cubic(), bf.Cubic(), bf.Structural()), BAD, "coordinates of an"),
    "label as a number": (
        lambda: bf.Element(bf.Cubic(), bf.Rotation(), bf.Structural(), label=3),
        BAD,
        "label of an element must be a text",
    ),
    "order zero": (lambda: bf.CRBF(0), BAD, "order must be at least 1"),
    "order nine": (lambda: bf.CRBF(9), BAD, "order must be at most"),
    "order as text": (lambda: bf.CRBF("2"), BAD, "order must be a whole number"),
    "order as True": (lambda: bf.Lagrange(True), BAD, "order must be a whole number"),
    "shear-rigid by words": (lambda: bf.ShearRigid("no"), BAD, "stretchable must be True or False"),
    "plane stress by words": (lambda: bf.ContinuumMechanics("no"), BAD, "plane_stress must be True or False"),
    "no shear without slopes": (lambda: bf.Element(bf.Lagrange(1), bf.ShearFree(), bf.Structural()), BAD, "no r_x"),
    "curvature without slopes": (lambda: bf.CRBF(2, bf.ElasticLine()), BAD, "r_xx"),
    "lobatto without slopes": (lambda: bf.CRBF(2, integration="lobatto"), BAD, "cubic field"),
}

BEAMS = {
    "elements as True": (lambda: a_beam(elements=True), BAD, "elements must be a whole number"),
    "zero elements": (lambda: a_beam(elements=0), BAD, "elements must be at least 1"),
    "half an element": (lambda: a_beam(elements=2.5), BAD, "elements must be a whole number"),
    "more elements than floats count": (lambda: a_beam(elements=10**400), BAD, r"elements must be at most 2\^53"),
    "elements as a time": (lambda: a_beam(elements=np.timedelta64(3, "s")), BAD, "elements must be a whole number"),
    "elements as half in an array": (lambda: a_beam(elements=np.array(2.5)), BAD, "elements must be a whole number"),
    "elements as a table": (lambda: a_beam(elements=np.ones((2, 2))), BAD, "elements must be a whole number"),
    "elements that do not rise": (lambda: a_beam(elements=[0, 0.5, 0.5, 1]), BAD, "rise from 0 to 1"),
    "elements of text": (lambda: a_beam(elements=["0", 1]), BAD, r"elements\[0\] must be a number"),
    "elements by a misspelt name": (lambda: a_beam(elements="knot"), BAD, '"knots"'),
    "knots of a line": (lambda: a_beam(elements="knots"), BAD, "needs a BSpline"),
    "elements of a set": (lambda: a_beam(elements={0.0, 1.0}), BAD, "elements must be a whole number"),
    "element by name": (lambda: a_beam(element="ANCF"), BAD, "element of a Beam must be an Element"),
    "element as a function": (lambda: a_beam(element=bf.ANCF), BAD, "element of a Beam must be an Element"),
    "curve of points": (lambda: a_beam(curve=[(0, 0), (1, 0)]), BAD, "curve of a Beam must be a curve"),
    "curve as a class": (lambda: a_beam(curve=bf.Line), BAD, "curve of a Beam must be a curve"),
    "section by number": (lambda: a_beam(section=0.01), BAD, "section of a Beam must be a section"),
    "section as a class": (lambda: a_beam(section=bf.Section), BAD, "section of a Beam must be a section"),
    "section of two": (lambda: a_beam(section=lambda s, t: SECTION), BAD, "section .* of arc length alone"),
    "section of nothing": (lambda: a_beam(section=lambda s: None), BAD, "section at arc length 0 must be a section"),
    "section that raises": (lambda: a_beam(section=lambda s: 1 / 0), BAD, r"section\(0\) cannot be computed: Zero"),
    "material by name": (lambda: a_beam(material="steel"), BAD, "material of a Beam must be a Material"),
    "no material": (lambda: a_beam(material=None), BAD, "needs a material"),
    "a body of a stiffness": (
        lambda: a_beam(element=bf.ANCF(), section=bf.Section.from_stiffness(1, 1, 1, 1, 1)),
        BAD,
        "has none",
    ),
    "graded by zero": (lambda: bf.graded(3, 0.0), BAD, "ratio must be greater than zero"),
    "graded by text": (lambda: bf.graded(3, "2"), BAD, "ratio must be a number"),
    "graded by 1e-300": (lambda: bf.graded(3, 1e-300), BAD, "leaves elements without length"),
    "no graded elements": (lambda: bf.graded(0, 2.0), BAD, "elements must be at least 1"),
    "a point beyond the end": (lambda: a_beam().at(1.5), BAD, "between 0 and 1, got 1.5"),
    "a point before the start": (lambda: bf.Point(a_beam(), -1.0), BAD, "between 0 and 1, got -1"),
    "a point at text": (lambda: a_beam().at("0.5"), BAD, "fraction must be a number"),
    "a point at nan": (lambda: a_beam().at(NAN), BAD, "fraction must be finite"),
    "a point at True": (lambda: a_beam().at(True), BAD, "fraction must be a number"),
    "a point of a point": (lambda: bf.Point(END, 0.5), BAD, "beam of a Point must be a Beam"),
    "a point of a class": (lambda: bf.Point(bf.Beam, 0.5), BAD, "beam of a Point must be a Beam"),
}

# double precision cannot square what solvers form of these beams
MAGNITUDES = {
    "a length of 1e300": (lambda: a_beam(curve=bf.Line((0, 0), (1e300, 0))), BAD, "length of Beam.* 1e.300"),
    "a length of 1e-300": (lambda: a_beam(curve=bf.Line((0, 0), (1e-300, 0))), BAD, "length of Beam.* 1e-300"),
    "a length that overflows": (lambda: a_beam(curve=bf.Line((-1e308, 0), (1e308, 0))), BAD, "length of Beam.* inf"),
    "a place of 1e160": (lambda: a_beam(curve=bf.Line((0, 1e160), (1e160, 1e160))), BAD, "the length of"),
    "a radius of 1e300": (lambda: a_beam(curve=bf.Arc((0, 0), 1e300, 0, 1)), BAD, "the length of"),
    "an angle of 1e300": (lambda: a_beam(curve=bf.Arc((0, 0), 1.0, 0, 1e300)), BAD, "the length of"),
    "a slender length of 1e100": (lambda: a_beam(curve=bf.Line((0, 0), (1e100, 0))), BAD, r"E I / h\^3 of"),
    "a short length of 1e-100": (lambda: a_beam(curve=bf.Line((0, 0), (1e-100, 0))), BAD, r"E I / h\^3 of"),
    "a modulus of 1e300": (lambda: a_beam(material=bf.Material(1e300, 0.3, 1.0)), BAD, "E A of"),
    "a modulus of 1e-300": (lambda: a_beam(material=bf.Material(1e-300, 0.3, 1.0)), BAD, "E A of"),
    "a density of 1e300": (lambda: a_beam(material=bf.Material(1.0, 0.3, 1e300)), BAD, "mass of an element"),
    "a density of 1e-300": (lambda: a_beam(material=bf.Material(1.0, 0.3, 1e-300)), BAD, "mass of an element"),
    "an area of 1e300": (lambda: a_beam(section=bf.Section(1e300, 1.0)), BAD, "E A of .* inf"),
    "a shear factor of 1e-300": (lambda: a_beam(section=bf.Rectangle(0.1, 0.1, 1e-300)), BAD, "k_s G A of"),
    "a stiffness of 1e300": (
        lambda: a_beam(section=bf.Section.from_stiffness(1, 1, 1e300, 1, 1)),
        BAD,
        r"E I / h of .*units in which they are closer to 1",
    ),
    "a rotary inertia of 1e-300": (
        lambda: a_beam(section=bf.Section.from_stiffness(1, 1, 1, 1, 1e-300)),
        BAD,
        "rotary inertia",
    ),
    "a layer of 1e300": (lambda: a_beam(section=bf.Layered([bf.Layer(STEEL, 1e300)], 1.0)), BAD, "of Beam"),
    "an axis of 1e160": (lambda: a_beam(section=bf.Layered([bf.Layer(STEEL, 1.0)], 1.0, 1e160)), BAD, "of Beam"),
    "a body of 1e40": (
        lambda: a_beam(section=bf.Section(1.0, 1.0, fourth_moment=1e200), element=bf.ANCF()),
        BAD,
        "moment of order 4",
    ),
    "a flat body of a length of 1e-35": (
        lambda: a_beam(curve=bf.Line((0, 0), (1e-35, 0)), section=bf.Rectangle(1.0, 1.0), element=bf.ANCF()),
        BAD,
        "moment of order 4",
    ),
    "elements of 1e-60 of the length": (lambda: a_beam(elements=[0.0, 1e-60, 1.0]), BAD, r"E I / h\^3"),
}

TABLE = CURVES | SECTIONS | ELEMENTS | BEAMS | MAGNITUDES


@pytest.mark.filterwarnings("ignore::beamfem.errors.SeveralTurnsWarning")
@pytest.mark.parametrize("case", TABLE)
def test_bad_geometry_is_named(case):
    require_named(*TABLE[case])


@pytest.mark.parametrize("unit", [np.float32, np.int16, np.float64, int])
def test_numbers_of_other_types_are_stored_as_floats(unit):
    """A product of 16-bit integers would overflow without a word: 200 * 200 is -25536."""
    section = bf.Rectangle(unit(200), unit(200))
    assert (section.area, section.second_moment) == (40000.0, 200.0**4 / 12.0)
    material = bf.Material(unit(200), 0.3, unit(1))
    assert isinstance(material.youngs_modulus, float)
    assert hash(bf.Material(np.array(200.0), 0.3, 1.0)) == hash(bf.Material(200.0, 0.3, 1.0))


def test_lists_may_be_generators_and_counts_arrays_without_dimensions():
    assert a_beam(elements=(share / 2 for share in range(3))).elements == (0.0, 0.5, 1.0)
    assert a_beam(elements=np.array(3)).elements == 3
    assert len(bf.Chain(bf.Line((x, 0), (x + 1, 0)) for x in range(2)).curves) == 2
    assert bf.Layered((bf.Layer(STEEL, 0.1) for _ in range(2)), 0.1).height == 0.2


class OwnMeasures(bf.Structural):
    code = -1


class OwnNodes(bf.Rotation):
    code = 9


@pytest.mark.parametrize(("part", "own"), [("forces", OwnMeasures()), ("coordinates", OwnNodes())])
def test_a_code_that_compiled_code_does_not_know_is_refused(part, own):
    """A code of -1 wrapped round to the last strain measure, and another one ended in an IndexError."""
    parts = {"coordinates": bf.Rotation(), "forces": bf.Structural()} | {part: own}
    with pytest.raises(bf.InputError, match=f"{part} of an element: code of {type(own).__name__} is {own.code}, but"):
        bf.Element(bf.Lagrange(2), **parts)
