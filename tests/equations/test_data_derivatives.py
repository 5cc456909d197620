"""Derivatives of the residual by data of every part, against residuals of models that are built anew."""

from dataclasses import fields
from functools import cache

import numpy as np
import pytest
from connectors import Barrier
from slow_values import mostly_slow

import beamfem as bf
from beamfem.equations.data_derivatives import residual_derivative
from beamfem.equations.equations import STATICS, linearise, residual
from beamfem.equations.system import system_of
from beamfem.public_names import public_dataclasses
from beamfem.section.moments import StiffnessSection

DATA = {
    "steel": (bf.Material, [2e7, 0.3, 1000.0, 1e-3, 1e-5, 1e6]),
    "rubber": (bf.Material, [3e6, 0.2, 900.0, 2e-3, 2e-5, 1e6]),
    "section": (bf.Section, [0.002, 4e-7, 0.8, 1e-4, 0.05, 0.02]),
    "given": (StiffnessSection, [4e4, 1e4, 70.0, 2.0, 0.03, 50.0]),
    "layer": (bf.Layer, ["steel", 0.02]),
    "rayleigh": (bf.Rayleigh, [0.3, 0.002]),
    "voigt": (bf.KelvinVoigt, [0.004]),
    "line": (bf.Line, [(0.0, 0.0), (1.0, 0.1)]),
    "other": (bf.Line, [(1.0, 0.1), (1.6, 0.4)]),
    "arc": (bf.Arc, [(0.4, 1.5), 0.7, -2.4, -0.5]),
    "spring": (bf.Spring, ["first half", (500.0, 300.0), 20.0]),
    "foundation": (bf.Foundation, ["first", (400.0, 700.0)]),
    "prescribed": (bf.Prescribed, ["third start", 0.01, -0.02, 0.1]),
    "gravity": (bf.Gravity, [(0.5, -9.81)]),
    "force": (bf.PointForce, ["second half", (30.0, -50.0), None, True, True]),
    "moment": (bf.PointMoment, ["second end", 4.0]),
    "line load": (bf.DistributedLoad, ["first", (7.0, -9.0)]),
    "pressure": (bf.Pressure, ["second", 11.0]),
    "actuation": (bf.Actuation, ["first", 0.1, 0.002, 0.003]),
    "pretension": (bf.Pretension, ["first", 3.0]),
    "temperature": (bf.Temperature, ["second", 40.0, 3e3]),
    "wheel": (bf.MovingForce, ["first", lambda time: 0.3 + time, (3.0, -20.0)]),
    "motor": (bf.Motor, ["hinge", None, None, 5.0]),
    "drive": (bf.Motor, ["guided", 0.2]),
    "gear": (bf.Gear, ["first half", "third half", -2.0]),
    "slider": (bf.Slider, ["first quarter", "third quarter", (1.0, 0.4)]),
    "cable": (bf.Cable, ["second half", (2.0, 1.0), 900.0, 12.0]),
    "cable between": (bf.Cable, ["second half", "third half", 800.0, 9.0]),
    "bushing": (bf.Bushing, ["first quarter", "third quarter", (900.0, 800.0, 30.0), (3.0, 4.0, 0.5)]),
    "drag": (bf.Drag, ["first", 2.0]),
    "damper": (bf.SpringDamper, ["first half", "third half", 600.0, 5.0, 0.7]),
    "stop": (bf.Stop, ["second end", (1.4, 0.35), (-0.2, -1.0), 1e4, 0.1, 0.5]),
    "slipping stop": (bf.Stop, ["guided end", (0.0, 0.5), (0.1, 1.0), 1e4, 0.1, 1e-4]),
    "smooth stop": (bf.Stop, ["first half", (0.5, 0.06), (0.1, 1.0), 1e4, 0.1]),
    "friction": (bf.HingeFriction, ["first end", "second start", 0.1, 200.0]),
    "hinge stop": (bf.HingeStop, ["first end", "second start", 0.05, 0.06, 300.0, 0.2]),
    "other hinge stop": (bf.HingeStop, ["first end", "second start", -0.06, -0.05, 300.0, 0.2]),
    "slider stop": (bf.SliderStop, ["first half", "third half", (1.0, 0.2), 0.05, 0.06, 300.0, 0.2]),
    "turn": (bf.TorsionSpring, ["first end", "second start", 40.0, 2.0]),
    "mass": (bf.PointMass, ["second end", 0.7, 0.02]),
    "body": (bf.RigidBody, ["third end", 0.9, 0.03, (0.05, 0.08)]),
    "frame": (bf.RotatingFrame, [2.0, (0.3, 0.4)]),
}
PLACES = {"start": 0.0, "quarter": 0.25, "half": 0.5, "end": 1.0}
ALL = [
    (key, each.name)
    for key, (kind, values) in DATA.items()
    for each, value in zip(fields(kind), values, strict=False)
    if isinstance(value, float) or (isinstance(value, tuple) and isinstance(value[0], float))
]
JOINED = {("line", "end"): ("other", "start")}  # in a hinge
SILENT = [("section", "height"), ("section", "centroid"), ("steel", "strength"), ("rubber", "strength")]
SILENT += [("stop", "friction"), ("friction", "stiffness"), ("rubber", "thermal_expansion")]
SILENT += [("hinge stop", "high"), ("other hinge stop", "low"), ("slider stop", "high")]
FIELDS = [place for place in ALL if place not in JOINED.values()]
STEP = 1e-3
SIXTH = ((-3, -1 / 60), (-2, 3 / 20), (-1, -3 / 4), (1, 3 / 4), (2, -3 / 20), (3, 1 / 60))  # order


def build(turning=False, **changed):
    """Return a model of all parts, and these by name; changed: numbers of fields, by name of the part and the field."""
    parts = {}

    def part(key, **given):
        kind, values = DATA[key]
        values = dict(zip((each.name for each in fields(kind)), values, strict=False)) | changed.get(key, {}) | given
        values = {name: found(value) for name, value in values.items()}
        parts[key] = kind(**values)
        return parts[key]

    def found(value):
        if not isinstance(value, str):
            return value
        beam, _, place = value.partition(" ")
        return parts[beam].at(PLACES[place]) if place else parts[value]

    steel, rubber = part("steel"), part("rubber")
    structural, thick = bf.CRBF(2), bf.CRBF(3, bf.ContinuumMechanics())
    parts["first"] = bf.Beam(part("line"), 4, structural, part("section"), steel, damping=part("rayleigh"))
    parts["second"] = bf.Beam(part("other"), 2, structural, bf.Layered((part("layer"),), 0.03, 0.012))
    parts["third"] = bf.Beam(part("arc"), 4, thick, parts["section"], rubber, damping=part("voigt"))
    parts["guided"] = bf.Beam(bf.Line((3.0, 0.0), (3.5, 0.0)), 2, structural, part("given"))
    parts["thick"] = bf.Beam(
        bf.Line((4.0, 0.0), (4.5, 0.1)), 2, bf.CRBF(2, bf.ContinuumMechanics()), parts["section"], rubber
    )
    parts["hinge"] = bf.Hinge(parts["first"].end, parts["second"].start)
    supports = [bf.Clamp(parts["first"].start), bf.Clamp(parts["thick"].start), bf.Pin(parts["guided"].start)]
    supports += map(part, ("spring", "foundation", "prescribed"))
    loads = ("gravity", "force", "moment", "line load", "pressure", "actuation", "temperature", "wheel", "motor")
    loads += ("pretension",)
    between = [
        "cable",
        "cable between",
        "bushing",
        "drag",
        "damper",
        "stop",
        "smooth stop",
        "slipping stop",
        "friction",
    ]
    drive = part("drive", at=parts["guided"].start)
    model = bf.Model(
        [parts[name] for name in ("first", "second", "third", "guided", "thick")],
        supports,
        [*map(part, loads), drive],
        [parts["hinge"], part("gear"), part("slider")],
        [] if turning else list(map(part, [*between, "hinge stop", "other hinge stop", "slider stop", "turn"])),
        masses=[part("mass"), part("body")],
        frame=part("frame") if turning else None,
    )
    return model, parts


@cache
def moving(turning, static):
    """Return a system, its parts, and an arbitrary motion near the reference with displacements of about 3e-3."""
    model, parts = build(turning)
    system, rng = system_of(model, static), np.random.default_rng(4)
    p, v, a = (system.reference, 0.0 * system.reference, 0.0 * system.reference)
    p, v, a = (values + size * rng.standard_normal(len(p)) for values, size in ((p, 3e-3), (v, 0.3), (a, 2.0)))
    p[system.connectors.multipliers] = 3.0
    p[system.prescribed_dofs] = system.prescribed_values(0.3)
    p[system.history.numbers] = 0.0
    return system, parts, (p, v, a)


def fresh_differences(system, state, key, name, turning):
    """Return differences (n, k) of sixth order of the residual of models that are built anew."""
    kind, values = DATA[key]
    value = np.array(dict(zip((each.name for each in fields(kind)), values, strict=False))[name])
    places = [(key, name), *([JOINED[key, name]] if (key, name) in JOINED else [])]
    columns = []
    for place in np.ndindex(value.shape):
        width, column = STEP * (np.abs(value).max() or 1.0), np.zeros_like(state[0])
        for offset, weight in SIXTH:
            moved = value.copy()
            moved[place] += offset * width
            other = system_of(build(turning, **{key: {name: moved.tolist()} for key, name in places})[0], system.static)
            p = state[0].copy()
            p[other.prescribed_dofs] = other.prescribed_values(0.3)
            column += weight / width * residual(other, p, *state[1:], 0.3)
        columns.append(column)
    return np.array(columns).T


@mostly_slow(
    ("key", "name"),
    FIELDS,
    quick=range(0, len(FIELDS), 4),
    ids=lambda value: value.replace(" ", "_"),
)
def test_the_derivative_by_each_field_is_that_of_models_built_anew(key, name):
    turning = key == "frame"
    system, parts, state = moving(turning, False)
    joined = [JOINED[key, name]] if (key, name) in JOINED else []
    places = [(parts[part], field) for part, field in [(key, name), *joined]]
    found = residual_derivative(system, state, 0.3, *places).residual
    wanted = fresh_differences(system, state, key, name, turning)
    if (key, name) in SILENT:
        assert np.abs(found).max() * np.abs(getattr(parts[key], name)) < 1e-8
    else:
        size = np.abs(wanted).max(axis=0)
        assert (size > 0.0).all()
        assert (np.abs(found - wanted) <= 1e-7 * size).all()


def test_all_parts_with_numbers_are_tried():
    tried = {kind for kind, _ in DATA.values()}
    numbers = ("float", "tuple", "Value", "Along")
    for kind in public_dataclasses("parts"):
        has = [each for each in fields(kind) if str(each.type).startswith(numbers) and "Point" not in str(each.type)]
        assert kind in tried or not has or kind is bf.Roller, kind  # see the test of solutions


TIP = {
    "steel": ["youngs_modulus", "poisson_ratio"],
    "section": ["area", "second_moment", "shear_factor"],
    "arc": ["radius", "center"],
    "roller": ["normal"],
    "force": ["vector"],
    "lift": ["uy"],
}
NUMBERS = {
    "steel": {"youngs_modulus": 2e9, "poisson_ratio": 0.3, "density": 1000.0},
    "section": {"area": 8e-4, "second_moment": 1e-7, "shear_factor": 0.8},
    "arc": {"center": (0.0, 0.0), "radius": 1.0, "start_angle": 3.0, "end_angle": 1.0},
    "roller": {"normal": (0.3, 1.0)},
    "force": {"vector": (100.0, -200.0)},
    "lift": {"uy": 0.05},
}


def bow(**changed):
    """Return an arc on an inclined roller, its foot lifted, that a force bends far, and its parts."""
    data = {key: values | changed.get(key, {}) for key, values in NUMBERS.items()}
    steel, section, arc = bf.Material(**data["steel"]), bf.Section(**data["section"]), bf.Arc(**data["arc"])
    beam = bf.Beam(arc, 6, bf.CRBF(3), section, steel)
    lift = bf.Prescribed(beam.start, ux=0.0, rotation=0.0, **data["lift"])
    roller, force = bf.Roller(beam.end, **data["roller"]), bf.PointForce(beam.at(0.5), **data["force"])
    parts = {"steel": steel, "section": section, "arc": arc, "roller": roller, "force": force, "lift": lift}
    return bf.Model([beam], [lift, roller], [force]), parts


def test_the_tip_changes_with_ten_numbers_as_whole_solves_do():
    """One factorisation: K dp = -dr where coordinates are free, with what supports prescribe moved along."""
    model, parts = bow()
    system, p = system_of(model, True), bf.solve_static(model).p[-1]
    free, rest = system.free_dofs, np.zeros_like(p)
    factors = linearise(system, p, rest, rest, 1.0, STATICS)[1].factorised(system.rotated)
    tip = model.meshes[0].coordinates_of(model.meshes[0].node_at(1.0))
    found, wanted = [], []
    for key, name in ((key, name) for key, names in TIP.items() for name in names):
        changed, moved = residual_derivative(system, (p, rest, rest), 1.0, (parts[key], name))
        moved[free] -= np.array([factors.solve(column) for column in changed[free].T]).T
        found += moved[[tip["r^x"], tip["r^y"]]].T.tolist()
        wanted += tip_differences(key, name).tolist()
    assert len(found) == 13
    size = np.abs(wanted).max(axis=1, keepdims=True)
    np.testing.assert_allclose(found / size, wanted / size, rtol=0.0, atol=1e-6)


def tip_differences(key, name):
    """Return the derivative (k, 2) of the position of the tip by differences of solves."""
    value = np.array(NUMBERS[key][name])
    rows = []
    for place in np.ndindex(value.shape):
        width, row = STEP * (np.abs(value).max() or 1.0), np.zeros(2)
        for offset, weight in SIXTH:
            moved = value.copy()
            moved[place] += offset * width
            model = bow(**{key: {name: moved.tolist()}})[0]
            row += weight / width * bf.solve_static(model).position(model.beams[0].end)[-1]
        rows.append(row)
    return np.array(rows)


def arm(*connectors, **options):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Section(8e-4, 1e-7), bf.Material(2e9, 0.3, 1000.0))
    parts = [make(beam.end) for make in connectors]
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (1.0, 2.0))], connectors=parts, **options)
    system = system_of(model, True)
    rest = np.zeros_like(system.reference)
    return system, (system.reference, rest, rest), parts


@pytest.mark.parametrize("damped", [0.0, 0.1])
def test_forces_that_begin_nearby_are_not_passed(damped):
    """A penetration of 1e-9 m, by complex steps, and data at the end of what is valid, by differences to one side."""
    system, state, (stop,) = arm(lambda end: bf.Stop(end, (0.0, 1e-9), (0.0, 1.0), 1e6, damped))
    names = "place", "stiffness", "damping"
    found = [residual_derivative(system, state, 1.0, (stop, name)).residual for name in names]
    height = system.model.meshes[0].coordinates_of(system.model.meshes[0].node_at(1.0))["r^y"]
    np.testing.assert_allclose(found[0][height], [0.0, -1e6], rtol=1e-12, atol=1e-6)
    np.testing.assert_allclose(found[1][height], -1e-9, rtol=1e-9)
    assert not found[2].any()  # at rest


def test_parts_in_python_are_stepped_as_well():
    system, state, (wall,) = arm(lambda end: Barrier(end, -0.01, 1e3, 0.02))
    push = 1e3 * 0.02 * np.exp(-0.5)
    height = system.model.meshes[0].coordinates_of(system.model.meshes[0].node_at(1.0))["r^y"]
    for name, wanted in (("stiffness", -push / 1e3), ("level", -push / 0.02), ("width", -push / 0.02 * 1.5)):
        found = residual_derivative(system, state, 1.0, (wall, name)).residual
        assert found[height, 0] == pytest.approx(wanted, rel=1e-13)


def test_what_has_no_derivative_is_told():
    system, state, (stop,) = arm(lambda end: bf.Stop(end, (0.0, 1.0), (0.0, 1.0), 1e6))
    with pytest.raises(bf.InputError, match=r"Line.* is no part of the model"):
        residual_derivative(system, state, 1.0, (bf.Line((0, 0), (1, 0)), "end"))
    with pytest.raises(bf.InputError, match="amplitude of PointForce is no field of numbers"):
        residual_derivative(system, state, 1.0, (system.model.loads[0], "amplitude"))
    with pytest.raises(bf.InputError, match=r"another definition with other data|other coordinates"):
        residual_derivative(system, state, 1.0, (stop, "friction"))  # it remembers where it sticks
