"""Static cases of the verification manual."""

from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import ellipeinc, ellipkinc

import beamfem as bf
from beamfem.model.load_base import Load
from beamfem.section.protocol import CrossSection
from studies.verification.case import Case, Value

STEEL = bf.Material(youngs_modulus=2e11, poisson_ratio=0.3, density=7800.0, thermal_expansion=1.2e-5)
SQUARE = bf.Rectangle(0.01, 0.01)
INEXTENSIBLE = bf.Section.from_stiffness(axial=1e8, shear=1e8, bending=1.0, mass=1.0, rotary_inertia=1e-6)
SPECTRAL = "collocation of the equations of Reissner's beam, 12 digits, no elements"


def cantilever(section: CrossSection, load: Callable[[bf.Beam], Load], elements: int = 4, **keywords: Any) -> bf.Model:
    """Return a cantilever of length 1 along x with a load."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, bf.CRBF(4), section, **keywords)
    return bf.Model([beam], [bf.Clamp(beam.start)], [load(beam)])


def tip(solution: bf.Solution) -> tuple[float, float, float]:
    """Return shortening, deflection and rotation of the end of the first beam in the last row."""
    end = solution.model.beams[0].end
    ux, uy = solution.displacement(end)[-1]
    return -float(ux), float(uy), float(solution.rotation(end)[-1])


def compared(
    names: tuple[str, ...], references: tuple[float, ...], found: tuple[float, ...], size: float | None = None
) -> tuple[Value, ...]:
    """Return the values of a case; size: what differences are compared with, by default each reference."""
    return tuple(Value(*row, size) for row in zip(names, references, found, strict=True))


def elastica(load: float) -> tuple[float, float, float]:
    """Return shortening, deflection and angle of the end of an elastica of L = EI = 1 under a dead tip force.

    With p = sin(pi/4 + a/2) for the tip angle a and sin(f) = 1 / (p sqrt 2), sqrt(P) = K(p) - F(f, p), and the
    deflection is 1 - 2 (E(p) - E(f, p)) / sqrt(P) (Bisshopp and Drucker 1945).
    """

    def lengths(angle: float) -> tuple[float, float]:
        m = 0.5 * (1.0 + np.sin(angle))
        phi = np.arcsin(1.0 / np.sqrt(2.0 * m))
        first, second = (full(0.5 * np.pi, m) - full(phi, m) for full in (ellipkinc, ellipeinc))
        return float(first), float(second)

    angle = brentq(lambda a: lengths(a)[0] - np.sqrt(load), 1e-6, 0.5 * np.pi - 1e-9, xtol=1e-15)
    along = np.sqrt(2.0 * np.sin(angle) / load)
    return 1.0 - float(along), 1.0 - 2.0 * lengths(angle)[1] / float(np.sqrt(load)), float(angle)


def tip_force() -> Case:
    """A cantilever under dead forces at its tip."""
    model = cantilever(INEXTENSIBLE, lambda beam: bf.PointForce(beam.end, (0.0, 10.0)), 8)
    solution = bf.solve_static(model, at=[0.1, 0.5, 1.0])
    values: tuple[Value, ...] = ()
    for row, load in enumerate((1.0, 5.0, 10.0)):
        names = tuple(f"P L^2 / EI = {load:g}: {name}" for name in ("u / L", "v / L", "angle [rad]"))
        ux, uy = solution.displacement(model.beams[0].end)[row]
        found = (-float(ux), float(uy), float(solution.rotation(model.beams[0].end)[row]))
        values += compared(names, elastica(load), found)
    problem = (
        "A straight inextensible cantilever under a dead transverse force P at its tip; E A = k G A = 1e8 E I / L^2."
    )
    source = "elliptic integrals, Bisshopp and Drucker 1945; tabulated by Mattiasson 1981"
    return Case("Elastica", problem, source, model, values, lambda path: solution.plot(path, shapes=3), 1e-6)


def thick_tip_force() -> Case:
    """A cantilever of L / h = 10, where shear counts."""
    section = bf.Rectangle(0.1, 0.1)
    force = 5.0 * section.rigidity(STEEL).bending
    model = cantilever(section, lambda beam: bf.PointForce(beam.end, (0.0, force)), 8, material=STEEL)
    solution = bf.solve_static(model)
    references = (0.38922722797924, 0.72054526137677, 1.21246073906392)
    values = compared(("u / L", "v / L", "section rotation [rad]"), references, tip(solution))
    problem = "A cantilever of L / h = 10 with a square section under P = 5 E I / L^2; nu = 0.3, k = 5/6."
    return Case("Reissner cantilever", problem, SPECTRAL, model, values, solution.plot, 1e-7)


def roll_up() -> Case:
    """A cantilever that an end moment rolls up."""
    model = cantilever(SQUARE, lambda beam: bf.PointMoment(beam.end, 2.0 * np.pi * 2e11 * 1e-8 / 12), 8, material=STEEL)
    solution = bf.solve_static(model, at=[0.25, 0.5, 1.0])
    positions, turned = solution.position(model.beams[0].end), solution.rotation(model.beams[0].end)
    values: tuple[Value, ...] = ()
    for row, angle in enumerate((0.5 * np.pi, np.pi, 2.0 * np.pi)):
        names = tuple(f"{angle / np.pi:g} pi: {name}" for name in ("x / L", "y / L", "angle [rad]"))
        circle = (round(np.sin(angle) / angle, 15) + 0.0, round((1.0 - np.cos(angle)) / angle, 15), angle)
        values += compared(names, circle, (*map(float, positions[row]), float(turned[row])))
    problem = "A cantilever under an end moment, up to 2 pi E I / L, is bent into circles."
    return Case("Roll-up", problem, "exact", model, values, lambda path: solution.plot(path, shapes=3), 1e-7)


def follower_force() -> Case:
    """A cantilever under a force that stays normal to its end section."""
    model = cantilever(INEXTENSIBLE, lambda beam: bf.PointForce(beam.end, (0.0, 5.0), follower=True), 8)
    solution = bf.solve_static(model)
    x, y, angle = 0.1722778753991, 0.7806901427781, 2.0981572399410
    values = compared(("x / L", "y / L", "angle [rad]"), (1.0 - x, y, angle), tip(solution))
    problem = "An inextensible cantilever under a force P = 5 E I / L^2 that stays normal to the end section."
    return Case("Follower force", problem, "collocation of the elastica, 13 digits", model, values, solution.plot)


def distributed_load() -> Case:
    """A cantilever under a dead load along its length."""
    model = cantilever(INEXTENSIBLE, lambda beam: bf.DistributedLoad(beam, (0.0, 5.0)), 8)
    solution = bf.solve_static(model)
    values = compared(
        ("u / L", "v / L", "angle [rad]"), (0.1533428200457, 0.4959050446224, 0.6970047775365), tip(solution)
    )
    problem = "An inextensible cantilever under a dead transverse load q = 5 E I / L^3 along its length."
    source = "collocation of the elastica, 13 digits; Holden 1972 treats the same problem"
    return Case("Distributed load", problem, source, model, values, solution.plot)


def small_bending() -> Case:
    """Beams under small loads against Timoshenko's theory."""
    stiffness, small = SQUARE.rigidity(STEEL), 1e-3
    values, solutions = [], []
    for name, support, shape in (
        ("hinged, force at middle", bf.Pin, 1.0 / 48.0),
        ("clamped, force at middle", bf.Clamp, 1.0 / 192.0),
    ):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(4), SQUARE, STEEL)
        ends = [support(beam.start), bf.Roller(beam.end) if support is bf.Pin else bf.Clamp(beam.end)]
        solutions.append(bf.solve_static(bf.Model([beam], ends, [bf.PointForce(beam.at(0.5), (0.0, -small))])))
        exact = small * (shape / stiffness.bending + 0.25 / stiffness.shear)
        values.append(Value(f"{name} [m]", exact, -float(solutions[-1].displacement(beam.at(0.5))[-1, 1])))
    problem = "A steel beam of L = 1 m, 10 mm square, under 1 mN: P L^3 / (48 E I) or / (192 E I), and P L / (4 k G A)."
    first = solutions[0]
    return Case("Small bending", problem, "Timoshenko", first.model, tuple(values), first.plot, 1e-8)


def foundation() -> Case:
    """A free beam on an elastic foundation under a force at its middle."""
    soil, force = 1e4, 1e-3
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(4), bf.Section.from_stiffness(1e6, 1e9, 10.0, 1.0, 1.0))
    supports = [bf.Foundation(beam, (0.0, soil)), bf.Prescribed(beam.at(0.5), ux=0.0)]
    solution = bf.solve_static(bf.Model([beam], supports, [bf.PointForce(beam.at(0.5), (0.0, -force))]))
    beta = (soil / 40.0) ** 0.25
    below = np.sinh(beta) + np.sin(beta)
    middle = force * beta / (2.0 * soil) * (np.cosh(beta) + np.cos(beta) + 2.0) / below
    end = 2.0 * force * beta / soil * np.cosh(0.5 * beta) * np.cos(0.5 * beta) / below
    found = [-float(solution.displacement(beam.at(place))[-1, 1]) for place in (0.5, 0.0)]
    values = compared(("middle [m]", "ends [m]"), (float(middle), float(end)), (found[0], found[1]))
    problem = "A free beam on a Winkler foundation, k = 1e4 N/m^2, E I = 10 N m^2, L = 1 m, under 1 mN at its middle."
    return Case("Beam on a foundation", problem, "Hetenyi 1946", solution.model, values, solution.plot, 1e-6)


def quarter_ring() -> Case:
    """A curved cantilever under a small force."""
    section, force = bf.Section.from_stiffness(1e4, 4e3, 10.0, 1.0, 1.0), 1e-5
    beam = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, 0.5 * np.pi), 4, bf.CRBF(4), section)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -force))])
    solution = bf.solve_static(model)
    quarter, across = 0.25 * np.pi * force, 0.5 * force
    down = quarter * (1.0 / 10.0 + 1.0 / 1e4 + 1.0 / 4e3)
    right = across * (1.0 / 10.0 - 1.0 / 1e4 + 1.0 / 4e3)
    ux, uy = solution.displacement(beam.end)[-1]
    values = compared(("down [m]", "sideways [m]"), (down, right), (-float(uy), abs(float(ux))))
    problem = "A quarter of a ring of radius 1 m, clamped at one end, under a small force at the other one."
    return Case("Quarter ring", problem, "Castigliano: bending, stretch and shear", model, values, solution.plot, 1e-6)


def diametral_ring() -> Case:
    """A ring that two opposite forces compress."""
    section, force = bf.Section.from_stiffness(1e6, 1e6, 1.0, 1.0, 1.0), 1e-6
    beam = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, 0.5 * np.pi), 4, bf.CRBF(4), section)
    supports = [bf.Prescribed(beam.start, uy=0.0, rotation=0.0), bf.Prescribed(beam.end, ux=0.0, rotation=0.0)]
    solution = bf.solve_static(bf.Model([beam], supports, [bf.PointForce(beam.end, (0.0, -0.5 * force))]))
    shorter = force * (0.25 * np.pi - 2.0 / np.pi + 0.25 * np.pi * (1e-6 + 1e-6))
    moment = force / np.pi
    found = 2.0 * -float(solution.displacement(beam.end)[-1, 1])
    under = abs(float(solution.section_forces(beam).moment[-1, -1]))
    values = compared(
        ("shortening of the diameter [m]", "moment under the force [N m]"), (shorter, moment), (found, under)
    )
    problem = "A thin ring of radius 1 m under two small opposite forces; a quarter is modelled."
    return Case("Ring under two forces", problem, "Roark", solution.model, values, solution.plot, 1e-6)


def tapered() -> Case:
    """A tapered cantilever under a small force."""
    force = 1e-3
    beam = bf.Beam(
        bf.Line((0, 0), (1, 0)), 8, bf.CRBF(4), lambda s: bf.Rectangle(0.01, 0.02 - 0.015 * s), material=STEEL
    )
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, force))]))

    def compliance(s: float) -> float:
        stiffness = bf.Rectangle(0.01, 0.02 - 0.015 * s).rigidity(STEEL)
        return (1.0 - s) ** 2 / stiffness.bending + 1.0 / stiffness.shear

    exact = force * float(quad(compliance, 0.0, 1.0, epsabs=0.0, epsrel=1e-12)[0])
    values = (Value("deflection [m]", exact, float(solution.displacement(beam.end)[-1, 1])),)
    problem = "A steel cantilever of 1 m whose height falls from 20 mm to 5 mm, under 1 mN at its tip."
    return Case("Tapered cantilever", problem, "unit load method, integrated", solution.model, values, solution.plot)


def portal() -> Case:
    """A clamped portal frame under a small side force."""
    common = (2, bf.CRBF(4), bf.Section.from_stiffness(1e9, 1e9, 1.0, 1.0, 1.0))
    left, right = (bf.Beam(bf.Line((x, 0), (x, 1)), *common) for x in (0, 1))
    bar = bf.Beam(bf.Line((0, 1), (1, 1)), *common)
    joints = [bf.Rigid(left.end, bar.start), bf.Rigid(bar.end, right.end)]
    load = bf.PointForce(left.end, (1e-5, 0.0))
    model = bf.Model([left, right, bar], [bf.Clamp(left.start), bf.Clamp(right.start)], [load], joints)
    solution = bf.solve_static(model)
    sway, foot = 1e-5 * 5.0 / 84.0, 1e-5 * 2.0 / 7.0
    found = (float(solution.displacement(left.end)[-1, 0]), abs(float(solution.reaction(left.start)[-1, 2])))
    values = compared(("sway [m]", "moment at a foot [N m]"), (sway, foot), found)
    problem = (
        "A clamped portal of three equal members, E I = L = 1, without stretch and shear, under a small side force."
    )
    return Case(
        "Portal frame", problem, "slope deflection: 5 P L^3 / (84 E I), 2 P L / 7", model, values, solution.plot
    )


def bimetal() -> Case:
    """Timoshenko's bimetal strip."""
    brass = bf.Material(1e11, 0.3, 8500.0, thermal_expansion=1.9e-5)
    strip = bf.Layered([bf.Layer(STEEL, 0.001), bf.Layer(brass, 0.002)], width=0.01)
    model = cantilever(strip, lambda beam: bf.Temperature(beam, change=100.0), 6)
    solution = bf.solve_static(model)
    m, n = 0.5, 2.0  # thickness and modulus of the steel over those of the brass
    curvature = 6.0 * 0.7e-5 * 100.0 * (1.0 + m) ** 2
    curvature /= 0.003 * (3.0 * (1.0 + m) ** 2 + (1.0 + m * n) * (m * m + 1.0 / (m * n)))
    values = (Value("curvature [1/m]", curvature, -tip(solution)[2]),)
    problem = "Steel of 1 mm under brass of 2 mm, warmer by 100 K; expansion 1.2e-5 and 1.9e-5 / K, E 2e11 and 1e11 Pa."
    source = "Timoshenko 1925"
    return Case("Bimetal strip", problem, source, model, values, solution.plot, 1e-9)


def heated_bar() -> Case:
    """A heated bar between walls."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), SQUARE, STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start), bf.Clamp(beam.end)], [bf.Temperature(beam, change=1.0)])
    solution = bf.solve_static(model)
    values = (Value("normal force [N]", -2e11 * 1e-4 * 1.2e-5, float(solution.section_forces(beam).normal[-1, 0])),)
    return Case(
        "Heated bar", "A steel bar between walls, warmer by 1 K.", "- E A alpha dT", model, values, solution.plot
    )


def warmer_above() -> Case:
    """Bars with a gradient of temperature over their height: one held by a clamp and a roller, one by two clamps."""
    gradient, rigidity = 1.0, SQUARE.rigidity(STEEL)
    curvature = -1.2e-5 * gradient
    solved = []
    for far in (bf.Roller, bf.Clamp):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(4), SQUARE, STEEL)
        load = bf.Temperature(beam, change=0.0, gradient=gradient)
        solved.append(bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start), far(beam.end)], [load])))
    propped, held = solved
    force = propped.reaction(propped.model.beams[0].end)[-1, 1]
    moment = held.section_forces(held.model.beams[0]).moment[-1, 0]
    exact = -0.5 * curvature / (1.0 / (3.0 * rigidity.bending) + 1.0 / rigidity.shear)
    values = compared(
        ("reaction of the roller [N]", "moment between clamps [N m]"),
        (exact, -rigidity.bending * curvature),
        (float(force), float(moment)),
    )
    problem = "Square steel bars of 10 mm and 1 m, warmer at the upper face by 1 K per metre of height."
    source = "3/2 E I alpha dT' / L with shear, and E I alpha dT'"
    return Case("Bars warmer above", problem, source, propped.model, values, propped.plot)


def plastic_hinge() -> Case:
    """A square section bent beyond yield."""
    side, stress = 0.02, 2.5e8
    law = bf.ElasticPlastic(youngs_modulus=2e11, yield_stress=stress, poisson_ratio=0.3, density=7800.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(4), bf.Fibres(bf.Rectangle(side, side), law, points=320))
    bent = 3.0 * 2.0 * stress / (2e11 * side)  # three times the curvature at yield
    supports = [bf.Clamp(beam.start), bf.Prescribed(beam.end, rotation=bent)]
    solution = bf.solve_static(bf.Model([beam], supports), steps=20)
    moment = stress * side**3 / 6.0 * 1.5 * (1.0 - 1.0 / 27.0)
    values = (Value("moment [N m]", moment, float(solution.reaction(beam.end)[-1, 2])),)
    problem = "A square section of an ideally plastic material, 250 MPa, bent to three times the curvature at yield."
    source = "M = 1.5 M_y (1 - (k_y / k)^2 / 3)"
    return Case("Plastic bending", problem, source, solution.model, values, solution.plot, 5e-4)


def beam_column() -> Case:
    """An eccentrically compressed column, by the secant formula."""
    section, load, offset = bf.Section.from_stiffness(1e9, 1e9, 1.0, 1.0, 1.0), 5.0, 1e-6
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(4), section)
    loads = [
        bf.PointForce(beam.end, (-load, 0.0)),
        bf.PointMoment(beam.start, -load * offset),
        bf.PointMoment(beam.end, load * offset),
    ]
    solution = bf.solve_static(bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end)], loads))
    exact = offset * (1.0 / np.cos(0.5 * np.sqrt(load)) - 1.0)
    found = abs(float(solution.displacement(beam.at(0.5))[-1, 1]))
    problem = "A hinged column, E I = L = 1, under P = 5 with the eccentricity 1e-6: e (sec(sqrt(P) / 2) - 1)."
    values = (Value("deflection of the middle [m]", float(exact), found),)
    return Case("Eccentric column", problem, "secant formula", solution.model, values, solution.plot, 1e-6)


def catenary() -> Case:
    """A hanging chain with little bending stiffness."""
    length, span, weight = 1.0, 0.8, 1.0
    section = bf.Section.from_stiffness(1e6, 1e6, 1e-6, 1.0, 1e-9)
    beam = bf.Beam(bf.Line((0, 0), (length, 0)), 16, bf.CRBF(4), section)
    led = bf.Prescribed(beam.end, ux=span - length, uy=0.0)
    load = bf.DistributedLoad(beam, (0.0, -weight), scale=False)
    solution = bf.solve_static(bf.Model([beam], [bf.Pin(beam.start), led], [load]), steps=10)
    a = brentq(lambda a: 2.0 * a * np.sinh(0.5 * span / a) - length, 0.05, 10.0)
    sag, thrust = a * (np.cosh(0.5 * span / a) - 1.0), weight * a
    found = (-float(solution.position(beam.at(0.5))[-1, 1]), abs(float(solution.reaction(beam.start)[-1, 0])))
    values = compared(("sag [m]", "thrust [N]"), (float(sag), float(thrust)), found)
    problem = "A chain of 1 m and 1 N over a span of 0.8 m; its bending stiffness is 1e-6 N m^2."
    return Case("Catenary", problem, "a cosh(x / a)", solution.model, values, solution.plot, 1e-4)


CASES = (
    *(tip_force, thick_tip_force, roll_up, follower_force, distributed_load, small_bending, foundation, quarter_ring),
    *(diametral_ring, tapered, portal, bimetal, heated_bar, warmer_above, plastic_hinge, beam_column, catenary),
)
