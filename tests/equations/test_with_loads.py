"""Models made by `with_loads` and `with_` share what does not depend on what they change, and nothing else."""

import gc
import pickle
import weakref
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from connectors import SpringDamper

import beamfem as bf
from beamfem.equations.motion_workspace import MotionWorkspace
from beamfem.equations.system import Proven, System, shared_table, system_of

STEEL = bf.Material(2.1e11, 0.3, 7850.0, thermal_expansion=1.2e-5)


def frame(element=None, connectors=lambda beam: ()):
    """Return an angle of two beams, clamped at its foot, under a force at its tip."""
    element, section = element or bf.CRBF(order=3), bf.Rectangle(0.01, 0.01)
    column = bf.Beam(bf.Line((0.0, 0.0), (0.0, 0.5)), 3, element, section, STEEL)
    arm = bf.Beam(bf.Line((0.0, 0.5), (1.0, 0.5)), 4, element, section, STEEL)
    joints = [bf.Rigid(column.end, arm.start)]
    return bf.Model([column, arm], [bf.Clamp(column.start)], [force(arm)], joints, connectors(arm))


def force(arm, size=20.0, at=1.0, **more):
    return bf.PointForce(arm.at(at), (0.3 * size, -size), **more)


def results(model):
    halves = bf.solve_static(model, at=[0.5, 1.0])
    motion = bf.simulate(model, 0.02, 0.002, start=halves)
    arm = model.beams[1]
    return {
        "p": halves.p,
        "tip": halves.displacement(arm.end),
        "reaction": halves.reaction(model.beams[0].start),
        "moments": halves.section_forces(arm).moment,
        "energy": halves.energy().total,
        "motion": motion.p,
        "frequencies": bf.solve_modes(model, 3).frequencies,
        "reference": system_of(model, True).reference,
    }


def assert_equal_to_a_fresh_one(model):
    """Bit for bit, to a model of the same parts that shares nothing."""
    fresh = results(bf.Model(model.beams, model.supports, model.loads, model.joints, model.connectors))
    for name, values in results(model).items():
        np.testing.assert_array_equal(values, fresh[name], err_msg=name)


# loads before (besides the force) and after; whether mesh and tables are shared
LOADS = {
    "other size": (lambda arm: [], lambda arm, same: [force(arm, -35.0)], True, True),
    "no size": (lambda arm: [], lambda arm, same: [force(arm, 0.0)], True, True),
    "no load": (lambda arm: [], lambda arm, same: [], True, False),
    "same place": (lambda arm: [], lambda arm, same: [force(arm), force(arm, 3.0)], True, False),
    "other place": (lambda arm: [], lambda arm, same: [force(arm, at=0.3)], False, False),
    "at a node": (lambda arm: [], lambda arm, same: [force(arm, at=0.75)], True, False),
    "with gravity": (lambda arm: [], lambda arm, same: [force(arm), bf.Gravity((3.0, -1.6))], True, True),
    "other gravity": (
        lambda arm: [bf.Gravity((0.0, -9.81))],
        lambda arm, same: [bf.Gravity((3.0, -1.6)), force(arm)],
        True,
        True,
    ),
    "uniform": (
        lambda arm: [bf.DistributedLoad(arm, (0.0, -5.0))],
        lambda arm, same: [force(arm), bf.DistributedLoad(arm, (2.0, 5.0))],
        True,
        True,
    ),
    "moment": (
        lambda arm: [bf.PointMoment(arm.end, 3.0)],
        lambda arm, same: [force(arm), bf.PointMoment(arm.end, -7.0)],
        True,
        True,
    ),
    "other order": (
        lambda arm: [bf.PointForce(arm.at(0.5), (0.0, 1.0))],
        lambda arm, same: [bf.PointForce(arm.at(0.5), (0.0, 1.0)), force(arm)],
        True,
        False,
    ),
    "follower": (lambda arm: [], lambda arm, same: [force(arm, follower=True)], True, False),
    "same pressure": (lambda arm: [bf.Pressure(arm, -5.0)], lambda arm, same: [force(arm, 7.0), *same], True, True),
    "other pressure": (
        lambda arm: [bf.Pressure(arm, -5.0)],
        lambda arm, same: [force(arm), bf.Pressure(arm, -9.0)],
        True,
        False,
    ),
    "same temperature": (
        lambda arm: [bf.Temperature(arm, 20.0, 30.0)],
        lambda arm, same: [force(arm, 7.0), *same],
        True,
        True,
    ),
    "other temperature": (
        lambda arm: [bf.Temperature(arm, 20.0, 30.0)],
        lambda arm, same: [force(arm), bf.Temperature(arm, 40.0)],
        True,
        False,
    ),
    "amplitude": (lambda arm: [], lambda arm, same: [force(arm, amplitude=lambda time: time**2)], True, True),
    "varying": (
        lambda arm: [bf.DistributedLoad(arm, lambda s: (0.0, -5.0 * s))],
        lambda arm, same: [force(arm), bf.DistributedLoad(arm, lambda s: (0.0, -9.0 * s))],
        True,
        False,
    ),
}


@pytest.mark.parametrize("solved", [True, False])
@pytest.mark.parametrize(("before", "after", "mesh", "tables"), LOADS.values(), ids=LOADS)
def test_with_other_loads_a_model_is_a_fresh_one(before, after, mesh, tables, solved):
    first = frame()
    same = before(first.beams[1])
    old = first.with_loads([*first.loads, *same])
    if solved:
        results(old)
    new = old.with_loads(after(old.beams[1], same))
    assert_equal_to_a_fresh_one(new)
    assert_equal_to_a_fresh_one(old)
    assert all(one is other for one, other in zip(old.beams, new.beams, strict=True))
    assert (new.meshes is old.meshes) == mesh
    one, other = system_of(old, True), system_of(new, True)
    for name in ("blocks", "unknowns", "equations", "reference", "solver_fields", "stations"):
        assert (getattr(one, name) is getattr(other, name)) == tables, name


def propped(model):
    return [*model.supports, bf.Roller(model.beams[1].end)]


def softer(model):
    return [bf.Spring(model.beams[0].start, (1e5, 1e6), 1e3)]


def lifted(model):
    return [bf.Prescribed(model.beams[0].start, ux=0.01, uy=0.0, rotation=0.1)]


def held_inside(model):
    return [*model.supports, bf.Pin(model.beams[1].at(0.3))]


@pytest.mark.parametrize(
    ("supports", "mesh"),
    [(propped, True), (softer, True), (lifted, True), (held_inside, False), (lambda model: model.supports, True)],
)
@pytest.mark.parametrize("element", [bf.CRBF(order=3), bf.ANCF(forces=bf.Structural())], ids=["CRBF", "ANCF"])
def test_with_other_supports_a_model_is_a_fresh_one(supports, mesh, element):
    old = frame(element)
    bf.solve_static(old)
    new = old.with_(supports=supports(old), loads=[force(old.beams[1], 5.0)])
    assert (new.meshes is old.meshes) == mesh
    assert_equal_to_a_fresh_one(new)


def test_a_support_that_makes_an_angle_a_coordinate_renumbers():
    """Gradients at a node whose rotation is held become an angle."""
    old = frame(bf.ANCF(forces=bf.Structural()))
    new = old.with_(supports=[*old.supports, bf.Spring(old.beams[1].end, (0.0, 0.0), 10.0)])
    assert new.meshes is not old.meshes
    assert new.size == old.size - 1
    assert_equal_to_a_fresh_one(new)


def spring(arm):
    return SpringDamper(arm.at(0.5), arm.end, stiffness=50.0)


@pytest.mark.parametrize("loads", [lambda arm: [force(arm, 7.0)], lambda arm: [force(arm), bf.Gravity((0.0, -9.81))]])
def test_connectors_are_shared_and_replaced(loads):
    old = frame(connectors=lambda arm: [spring(arm)])
    results(old)
    new = old.with_loads(loads(old.beams[1]))
    assert new.connectors[0] is old.connectors[0]
    assert (system_of(new, True).unknowns is system_of(old, True).unknowns) == (not new.gravity)
    assert_equal_to_a_fresh_one(new)
    without, with_other = old.with_(connectors=[]), old.with_(connectors=[spring(old.beams[1])])
    assert with_other.meshes is old.meshes
    for model in (without, with_other):
        assert_equal_to_a_fresh_one(model)


def test_models_solved_in_turns_do_not_disturb_each_other():
    one = frame()
    other = one.with_loads([force(one.beams[1], -3.0)])
    found = [bf.solve_static(model).p for model in (one, other, one, other)]
    np.testing.assert_array_equal(found[0], found[2])
    np.testing.assert_array_equal(found[1], found[3])
    assert np.any(found[0] != found[1])


def test_threads_that_solve_models_with_common_tables_do_not_disturb_each_other():
    model, sizes = frame(), np.linspace(-40.0, 40.0, 40)

    def solved(size):
        return bf.solve_static(model.with_loads([force(model.beams[1], size)])).p[-1]

    expected = [solved(size) for size in sizes]
    with ThreadPoolExecutor(4) as pool:
        np.testing.assert_array_equal(list(pool.map(solved, sizes)), expected)


def test_what_a_solve_finds_out_is_not_shared():
    """Whether a tangent keeps its digits depends on the state, and further solves on what was found."""
    model = frame()
    one, other = system_of(model, True), system_of(model.with_loads([force(model.beams[1], 3.0)]), True)
    one.proven.add(Proven.KEEPS_DIGITS)
    assert not other.proven
    assert one.loads.known is not other.loads.known


def test_no_shared_table_depends_on_the_size_of_loads():
    names = [name for name, item in vars(System).items() if isinstance(item, shared_table)]
    assert len(names) > 10
    model, found = frame(), []
    for size in (20.0, -3.0):
        loads = [force(model.beams[1], size), bf.Gravity((size, 1.0))]
        system = system_of(bf.Model(model.beams, model.supports, loads, model.joints), True)
        found.append({name: _numbers(getattr(system, name)) for name in names if name not in _WITHOUT_NUMBERS})
    for name in found[0]:
        for one, other in zip(found[0][name], found[1][name], strict=True):
            np.testing.assert_array_equal(one, other, err_msg=name)


# addresses, and supports
_WITHOUT_NUMBERS = (
    *("prescribed", "_rotated"),
    *("equations", "without_stiffness", "strain_rates"),
)


def _numbers(value):
    """Return all arrays and numbers that a value holds."""
    if isinstance(value, np.ndarray | float | int | str | frozenset | set | type(None)):
        return [value]
    if isinstance(value, dict):
        value = value.values()
    elif not isinstance(value, tuple | list):
        value = vars(value).values()
    return [number for part in value for number in _numbers(part)]


def test_amplitudes_of_other_models_are_not_kept():
    """They may hold a whole solution."""

    class Amplitude:
        def __call__(self, time):
            return time

    model = frame()
    driven = model.with_loads([force(model.beams[1], amplitude=Amplitude())])
    kept = weakref.ref(driven.loads[0].amplitude)
    bf.simulate(driven, 0.01, 0.001)
    (space,) = system_of(model, static=False).spare(MotionWorkspace)
    assert space.assembler.record.body is None
    assert space.solver.saved is None
    del driven
    gc.collect()
    assert kept() is None


def test_copies_in_other_processes_are_models_by_themselves():
    model = frame()
    bf.solve_static(model)
    new = model.with_loads([force(model.beams[1], 3.0)])
    copied = pickle.loads(pickle.dumps(new))
    assert copied.meshes is not new.meshes
    np.testing.assert_array_equal(bf.solve_static(copied).p, bf.solve_static(new).p)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        (lambda model: model.with_loads(force(model.beams[1])), r"write it in brackets: loads=\[\.\.\.\]"),
        (lambda model: model.with_loads(None), "loads of Model"),
        (lambda model: model.with_loads([bf.Clamp(model.beams[1].end)]), "it belongs in supports"),
        (lambda model: model.with_(loads=7.0), "loads of Model"),
        (lambda model: model.with_(supports=[force(model.beams[1])]), "it belongs in loads"),
        (lambda model: model.with_(connectors=[1.0]), "connectors of a Model cannot hold"),
        (lambda model: model.with_(), "with_ takes the supports, loads, connectors or masses"),
        (
            lambda model: model.with_loads([force(frame().beams[1])]),
            r"not in this model; add it to beams, or use model\.beams\[1\]",
        ),
    ],
)
def test_what_is_no_part_of_a_model_is_refused(change, told):
    with pytest.raises(bf.InputError, match=told):
        change(frame())


def test_other_words_are_refused():
    with pytest.raises(TypeError, match="joints"):
        frame().with_(joints=[])
