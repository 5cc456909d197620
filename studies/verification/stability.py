"""Critical loads and equilibrium paths of the verification manual."""

import numpy as np
from scipy.optimize import brentq

import beamfem as bf
from studies.stability import becks_column, deep_arches, lee_frame, williams_toggle
from studies.verification.case import Case, Value
from studies.verification.statics import STEEL, compared

SLENDER = bf.Section.from_stiffness(axial=1e8, shear=1e8, bending=1.0, mass=1.0, rotary_inertia=1e-8)


def columns() -> Case:
    """Slender columns on different supports."""
    ends = {
        "clamped-free": (bf.Clamp, None, 0.25 * np.pi**2),
        "hinged-hinged": (bf.Pin, {"uy": 0.0}, np.pi**2),
        "clamped-hinged": (bf.Clamp, {"uy": 0.0}, brentq(lambda k: np.tan(k) - k, 4.4, 4.6) ** 2),
        "clamped-clamped": (bf.Clamp, {"uy": 0.0, "rotation": 0.0}, 4.0 * np.pi**2),
    }
    values, shown = [], []
    for name, (start, end, exact) in ends.items():
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(4), SLENDER)
        supports = [start(beam.start), *([bf.Prescribed(beam.end, **end)] if end else [])]
        model = bf.Model([beam], supports, [bf.PointForce(beam.end, (-1.0, 0.0))])
        shown.append(bf.solve_buckling(model, 1))
        values.append(Value(f"{name}, P L^2 / E I", float(exact), float(shown[-1].load_factors[0])))
    problem = "Columns of E I = L = 1 on Euler's four kinds of supports; E A = k G A = 1e8."
    return Case("Euler columns", problem, "Euler", shown[0].model, tuple(values), shown[-1].plot)


def thick_columns() -> Case:
    """Columns in which shear and stretch count."""
    values, shown = [], []
    for name, slenderness, exact, end in (
        ("hinged-hinged, L / h = 20", 20.0, 9.8269530896528, {"uy": 0.0}),
        ("clamped-free, L / h = 10", 10.0, 2.4567382724132, {}),
    ):
        section = bf.Rectangle(0.1, 1.0 / slenderness)
        bending = section.rigidity(STEEL).bending
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(4), section, STEEL)
        supports = [bf.Pin(beam.start), bf.Prescribed(beam.end, **end)] if end else [bf.Clamp(beam.start)]
        shown.append(bf.solve_buckling(bf.Model([beam], supports, [bf.PointForce(beam.end, (-bending, 0.0))]), 1))
        values.append(Value(f"{name}, P L^2 / E I", exact, float(shown[-1].load_factors[0])))
    problem = "Steel columns of rectangular section, nu = 0.3, k = 5/6, compressed and sheared before they buckle."
    source = "closed form of Reissner's beam, Reissner 1982"
    return Case("Thick columns", problem, source, shown[0].model, tuple(values), shown[-1].plot, 1e-8)


def heated_column() -> Case:
    """A column between hinges that do not give way, heated until it buckles."""
    steel = bf.Material(2e11, 0.3, 7800.0, thermal_expansion=1.2e-5)
    section = bf.Rectangle(0.02, 0.02)
    rigidity = section.rigidity(steel)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(4), section, steel)
    model = bf.Model([beam], [bf.Pin(beam.start), bf.Pin(beam.end)], [bf.Temperature(beam, change=1.0)])
    buckling = bf.solve_buckling(model, 1)
    euler = np.pi**2 * rigidity.bending
    thrust = 0.5 * rigidity.shear * (np.sqrt(1.0 + 4.0 * euler / rigidity.shear) - 1.0)
    exact = thrust / (rigidity.axial * 1.2e-5)
    values = (Value("change of temperature [K]", float(exact), float(buckling.load_factors[0])),)
    problem = "A square steel column of 20 mm and 1 m between hinges that do not move, heated evenly."
    source = "Euler's load with shear, P (1 + P / k G A) = pi^2 E I / L^2, P = E A alpha dT"
    return Case("Heated column", problem, source, model, values, buckling.plot)


def own_weight() -> Case:
    """Greenhill's column."""
    beam = bf.Beam(bf.Line((0, 0), (0, 1)), 8, bf.CRBF(4), SLENDER)
    buckling = bf.solve_buckling(bf.Model([beam], [bf.Clamp(beam.start)], [bf.DistributedLoad(beam, (0.0, -1.0))]), 1)
    values = (Value("q L^3 / E I", 7.83734744, float(buckling.load_factors[0])),)
    problem = "A clamped column under its own weight."
    return Case("Column under its weight", problem, "Greenhill 1881", buckling.model, values, buckling.plot)


def column_on_foundation() -> Case:
    """A hinged column in an elastic medium."""
    soil = 3000.0
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(4), SLENDER)
    supports = [bf.Pin(beam.start), bf.Prescribed(beam.end, uy=0.0), bf.Foundation(beam, (0.0, soil))]
    buckling = bf.solve_buckling(bf.Model([beam], supports, [bf.PointForce(beam.end, (-1.0, 0.0))]), 2)
    waves = np.arange(1, 8) * np.pi
    exact = np.sort(waves**2 + soil / waves**2)
    names = ("lowest P L^2 / E I", "second P L^2 / E I")
    values = compared(names, (float(exact[0]), float(exact[1])), tuple(map(float, buckling.load_factors)))
    problem = "A hinged column, E I = L = 1, in a medium of stiffness 3000: n^2 pi^2 + k / (n pi)^2, least for n = 2."
    return Case("Column on a foundation", problem, "Timoshenko and Gere", buckling.model, values, buckling.plot)


def sway_frame() -> Case:
    """A portal on hinges that sways."""
    common = (2, bf.CRBF(4), SLENDER)
    left, right = (bf.Beam(bf.Line((x, 0), (x, 1)), *common) for x in (0, 1))
    bar = bf.Beam(bf.Line((0, 1), (1, 1)), *common)
    joints = [bf.Rigid(left.end, bar.start), bf.Rigid(bar.end, right.end)]
    loads = [bf.PointForce(left.end, (0.0, -1.0)), bf.PointForce(right.end, (0.0, -1.0))]
    buckling = bf.solve_buckling(
        bf.Model([left, right, bar], [bf.Pin(left.start), bf.Pin(right.start)], loads, joints), 1
    )
    root = float(brentq(lambda k: k * np.tan(k) - 6.0, 1.0, 1.5)) ** 2
    values = (Value("P L^2 / E I", root, float(buckling.load_factors[0])),)
    problem = "A portal of three equal members on hinged feet under a force on each column: k tan k = 6, P = k^2."
    return Case("Sway of a portal", problem, "Timoshenko and Gere", buckling.model, values, buckling.plot)


def beck() -> Case:
    """Beck's column flutters."""
    unloaded = becks_column.column(1000.0)
    flutter = becks_column.flutter_load(unloaded)
    about = becks_column.modes(unloaded, 15.0)
    values = (Value("P L^2 / E I", 20.0509, flutter),)
    problem = (
        "A cantilever, L / h = 1000, under a compressive force that follows its tip; two frequencies meet at flutter."
    )
    return Case("Beck's column", problem, "Beck 1952", unloaded, values, about.plot, 1e-5)


def follower_pressure() -> Case:
    """A ring under external pressure."""
    beam = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, 0.5 * np.pi), 6, bf.CRBF(4), SLENDER)
    supports = [bf.Prescribed(beam.start, uy=0.0, rotation=0.0), bf.Prescribed(beam.end, ux=0.0, rotation=0.0)]
    buckling = bf.solve_buckling(bf.Model([beam], supports, [bf.Pressure(beam, 1.0)]), 1)
    values = (Value("p R^3 / E I", 3.0, float(buckling.load_factors[0])),)
    problem = "A thin ring under external pressure, which stays normal to it; a quarter is modelled."
    return Case("Ring under pressure", problem, "Levy 1884", buckling.model, values, buckling.plot)


def lee() -> Case:
    """Lee's frame."""
    path = list(lee_frame.main().values())[-1]
    limits = [point.load_factor for point in path.limit_points[:2]]
    values = compared(("first limit [N]", "second limit [N]"), (18544.5270944, -9392.48964035), tuple(limits))
    problem = (
        "Two rigidly joined bars of 120 cm, A = 6 cm^2, I = 2 cm^4, E = 7.2e6 N / cm^2, nu = 0.3, hinged at both ends."
    )
    source = "arc length on collocated equations of Reissner's beam, 11 digits"
    return Case("Lee's frame", problem, source, path.model, values, path.plot, 1e-6)


def williams() -> Case:
    """Williams' toggle."""
    path, _ = williams_toggle.main()
    names = ("first limit [lb]", "second limit [lb]")
    values = compared(names, (33.8491411685, 31.2444502955), tuple(p.load_factor for p in path.limit_points[:2]))
    problem = (
        "A toggle of half span 12.943 in and rise 0.386 in, clamped outside, E A = 1.885e6 lb, E I = 9274 lb in^2."
    )
    source = "arc length on collocated equations of Reissner's beam, 9 digits; data of Williams 1964"
    return Case("Williams' toggle", problem, source, path.model, values, path.plot, 1e-7)


def deep_arch() -> Case:
    """A deep arch, clamped and hinged."""
    model = deep_arches.arch("clamped-hinged", 24, 4, 5000.0)
    path = bf.trace_equilibrium(model, until=lambda state: deep_arches.crown(state)[1] > 1.3)
    limit = path.limit_points[0]
    u, w = deep_arches.crown(limit)
    turned = limit.rotation(model.beams[0].at(0.5))
    names = ("P R^2 / E I", "u / R", "w / R", "rotation [rad]")
    found = (limit.load_factor, float(u), float(w), abs(float(turned)))
    values = compared(names, (8.97308996972, 0.61141465795, 1.13732063125, 0.0498860774865), found)
    problem = (
        "A circular arch of 215 degrees, clamped at one end and hinged at the other, under a dead force on its crown."
    )
    source = "arc length on the collocated elastica; DaDeppo and Schmidt 1975: 8.97"
    return Case("Deep arch", problem, source, model, values, path.plot, 1e-5)


def truss() -> Case:
    """A shallow truss of two bars that snaps through."""
    section = bf.Section.from_stiffness(axial=1.0, shear=1.0, bending=1e-5, mass=1.0, rotary_inertia=1e-5)
    bar = bf.Beam(bf.Line((0, 0), (1, 0.2)), 1, bf.CRBF(1), section)
    supports = [bf.Pin(bar.start), bf.Prescribed(bar.end, ux=0.0)]
    model = bf.Model([bar], supports, [bf.PointForce(bar.end, (0.0, -1.0))])
    path = bf.trace_equilibrium(model, until=lambda state: state.displacement(bar.end)[1] < -0.5)
    first = np.hypot(1.0, 0.2)
    height = np.sqrt(first ** (2.0 / 3.0) - 1.0)
    limit = (1.0 - np.hypot(1.0, height) / first) * height / np.hypot(1.0, height)
    values = (Value("limit P / E A", float(limit), path.limit_points[0].load_factor),)
    problem = (
        "A bar of half a shallow truss, rise 0.2 over a base of 1: P = E A (1 - l / l0) z / l, largest at l^3 = l0."
    )
    return Case("Truss of two bars", problem, "closed form", model, values, path.plot, 1e-8)


CASES = (
    *(
        columns,
        thick_columns,
        heated_column,
        own_weight,
        column_on_foundation,
        sway_frame,
        beck,
        follower_pressure,
        lee,
    ),
    *(williams, deep_arch, truss),
)
