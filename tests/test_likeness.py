"""Models that are alike but for the size of their loads share what does not depend on it, and nothing else."""

import gc
import weakref
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace

import numpy as np
import pytest

import beamfem as bf
from beamfem.assembly.system import System, system_of
from beamfem.model import likeness
from beamfem.once import shared_property

STEEL = bf.Material(2.1e11, 0.3, 7850.0, thermal_expansion=1.2e-5)
SECTION = bf.Rectangle(0.01, 0.01)


def frame(height=0.5, element=None, section=SECTION, load=20.0, more=lambda beam: (), base=bf.Clamp, angle=0.0, at=1.0):
    """Return an angle of two beams under a load, turned by an angle [rad]."""
    corner = (-height * np.sin(angle), height * np.cos(angle))
    tip = (corner[0] + np.cos(angle), corner[1] + np.sin(angle))
    column = bf.Beam(bf.Line((0.0, 0.0), corner), 3, element or bf.CRBF(order=3), section, STEEL)
    arm = bf.Beam(bf.Line(corner, tip), 4, element or bf.CRBF(order=3), section, STEEL)
    loads = [bf.PointForce(arm.at(at), (0.3 * load, -load)), *more(arm)]
    return bf.Model([column, arm], [base(column.start)], loads, [bf.Rigid(column.end, arm.start)])


CASES = {
    "other force": ({}, {"load": -35.0}, True),
    "no force": ({}, {"load": 0.0}, True),
    "other place": ({}, {"at": 0.75}, False),
    "other length": ({}, {"height": 0.6}, False),
    "turned": ({}, {"angle": 0.4}, False),
    "other section": ({}, {"section": bf.Rectangle(0.02, 0.01)}, False),
    "other field": ({}, {"element": bf.CRBF(order=2)}, False),
    "other support": ({}, {"base": lambda point: bf.Spring(point, (1e5, 1e6), 1e3)}, False),
    "stiffer support": (
        {"base": lambda point: bf.Spring(point, (1e5, 1e6), 1e3)},
        {"base": lambda point: bf.Spring(point, (1e5, 2e6), 1e3)},
        False,
    ),
    "moved support": ({}, {"base": lambda point: bf.Prescribed(point, ux=0.01, uy=0.0, rotation=0.1)}, False),
    "moved further": (
        {"base": lambda point: bf.Prescribed(point, ux=0.01, uy=0.0, rotation=0.1)},
        {"base": lambda point: bf.Prescribed(point, ux=0.01, uy=0.0, rotation=0.2)},
        False,
    ),
    "with gravity": (
        {"more": lambda beam: [bf.Gravity((0.0, -9.81))]},
        {"more": lambda beam: [bf.Gravity((3.0, -1.6))]},
        True,
    ),
    "uniform loads": (
        {"more": lambda beam: [bf.DistributedLoad(beam, (0.0, -5.0))]},
        {"more": lambda beam: [bf.DistributedLoad(beam, (2.0, 5.0))]},
        True,
    ),
    "moments": (
        {"more": lambda beam: [bf.PointMoment(beam.end, 3.0)]},
        {"more": lambda beam: [bf.PointMoment(beam.end, -7.0)]},
        True,
    ),
    "follower": (
        {"more": lambda beam: [bf.PointForce(beam.end, (0.0, 5.0))]},
        {"more": lambda beam: [bf.PointForce(beam.end, (0.0, 5.0), follower=True)]},
        False,
    ),
    "pressures": (
        {"more": lambda beam: [bf.Pressure(beam, -5.0)]},
        {"more": lambda beam: [bf.Pressure(beam, -9.0)]},
        False,
    ),
    "same pressure": (
        {"more": lambda beam: [bf.Pressure(beam, -5.0)]},
        {"more": lambda beam: [bf.Pressure(beam, -5.0)], "load": 7.0},
        True,
    ),
    "temperatures": (
        {"more": lambda beam: [bf.Temperature(beam, 20.0)]},
        {"more": lambda beam: [bf.Temperature(beam, 40.0)]},
        False,
    ),
    "an amplitude": (
        {"more": lambda beam: [bf.PointForce(beam.end, (0.0, 5.0), amplitude=lambda time: time)]},
        {"more": lambda beam: [bf.PointForce(beam.end, (0.0, 5.0), amplitude=lambda time: time**2)]},
        True,
    ),
    "functions": (
        {"more": lambda beam: [bf.DistributedLoad(beam, lambda s: (0.0, -5.0 * s))]},
        {"more": lambda beam: [bf.DistributedLoad(beam, lambda s: (0.0, -9.0 * s))]},
        False,
    ),
}


@pytest.fixture
def nothing_known():
    likeness._known.cache_clear()
    yield
    likeness._known.cache_clear()


def results(model):
    """Return what solvers find, without any model made before."""
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


@pytest.mark.parametrize(("first", "second", "alike"), CASES.values(), ids=CASES)
def test_results_do_not_depend_on_the_models_before(first, second, alike, nothing_known):
    alone = results(frame(**second))
    likeness._known.cache_clear()
    before, after = frame(**first), frame(**second)
    results(before)
    found = results(after)
    assert (before.alike is after.alike) == alike
    for name, values in alone.items():
        np.testing.assert_array_equal(found[name], values, err_msg=name)


def test_one_solved_after_the_other_and_again(nothing_known):
    one, other = frame(load=20.0), frame(load=-3.0)
    found = [bf.solve_static(model).p for model in (one, other, one, other)]
    np.testing.assert_array_equal(found[0], found[2])
    np.testing.assert_array_equal(found[1], found[3])
    assert np.any(found[0] != found[1])


def test_meshes_are_those_of_the_beams_of_the_model(nothing_known):
    one, other = frame(), frame(load=7.0)
    for model in (one, other):
        assert all(mesh.beam is beam for mesh, beam in zip(model.meshes, model.beams, strict=True))
    assert one.meshes[0].classes is other.meshes[0].classes


@pytest.mark.parametrize("common", [0, 1])
def test_models_that_have_one_of_their_beams_in_common(common, nothing_known):
    """The mesh of each other beam is that of the own beam: results are looked up by it, and files name it."""

    def second(load, name):
        arm = replace(one.beams[1], name=name) if common == 0 else one.beams[1]
        column = one.beams[0] if common == 0 else replace(one.beams[0], name=name)
        loads = [bf.PointForce(arm.end, (0.0, load)), bf.Temperature(arm, 20.0, 30.0)]
        return bf.Model([column, arm], [bf.Clamp(column.start)], loads, [bf.Rigid(column.end, arm.start)])

    one = frame()
    models = second(-5.0, "first"), second(-7.0, "second")
    for model in models:
        bf.solve_static(model)
    assert models[0].alike is models[1].alike
    for model in models:
        assert all(mesh.beam is beam for mesh, beam in zip(model.meshes, model.beams, strict=True))
    crooked = models[1].with_imperfection(bf.solve_modes(models[1], 1), 1e-3)
    assert crooked.beams[1 - common].name == "second"


def test_beams_of_users_own_classes_are_like_no_other(nothing_known):
    class Low(bf.Beam):
        def section_at(self, arc_length):
            return bf.Rectangle(0.01, 0.005)

    def tip(kind):
        beam = kind(bf.Arc((0.0, 0.0), 1.0, 0.0, 1.0), 4, bf.CRBF(order=3), SECTION, STEEL)
        model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -1.0))])
        return bf.solve_static(model).displacement(beam.end)[-1]

    assert np.linalg.norm(tip(Low)) > 5.0 * np.linalg.norm(tip(bf.Beam))


def test_amplitudes_of_the_first_model_are_not_kept(nothing_known):
    """They may hold a whole solution."""

    class Amplitude:
        def __call__(self, time):
            return time

    model = frame(more=lambda beam: [bf.PointMoment(beam.end, 1.0, amplitude=Amplitude())])
    kept = weakref.ref(model.loads[-1].amplitude)
    bf.simulate(model, 0.01, 0.001)
    assert frame(more=lambda beam: [bf.PointMoment(beam.end, 1.0)]).alike is model.alike
    del model
    gc.collect()
    assert kept() is None


@pytest.mark.parametrize("large", ["corners", "loads"])
def test_large_models_are_not_kept_however_their_elements_come_about(large, nothing_known):
    place = np.linspace(0.0, 10.0, 400)
    corners = tuple(zip(place.tolist(), np.sin(7.0 * place).tolist(), strict=True))
    curve = bf.Polyline(corners) if large == "corners" else bf.Line((0.0, 0.0), (10.0, 0.0))

    def made():
        beam = bf.Beam(curve, 1, bf.CRBF(order=3), SECTION, STEEL)
        fractions = (0.1 * place).tolist() if large == "loads" else [1.0]
        return bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.at(at), (0.0, 1.0)) for at in fractions])

    assert made().meshes[0].elements > 300
    assert made().alike is not made().alike


def test_names_of_beams_are_their_own(nothing_known):
    """Messages name the beam of the model that fails, not of the one before it."""

    def free(name):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=3), SECTION, STEEL, name=name)
        return bf.Model([beam], [bf.Pin(beam.start)], [bf.PointForce(beam.end, (0.0, 1.0))])

    for name in ("first", "second"):
        with pytest.raises(bf.FreeMotionError, match=name):
            bf.solve_static(free(name))


def test_loads_added_together_keep_their_order(nothing_known):
    def loaded(*forces):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=3), SECTION, STEEL)
        loads = [bf.PointForce(beam.at(place), (0.0, force)) for place, force in forces]
        return bf.Model([beam], [bf.Clamp(beam.start)], loads)

    one, other = loaded((0.5, 3.0), (1.0, -2.0)), loaded((1.0, -2.0), (0.5, 3.0))
    assert one.alike is not other.alike
    ends = [bf.solve_static(model).displacement(model.beams[0].end)[-1] for model in (one, other)]
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-12)


def test_models_with_parts_of_users_are_like_no_other(nothing_known):
    @dataclass(frozen=True)
    class Heavy(bf.PointForce):
        pass

    def loaded():
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=3), SECTION, STEEL)
        return bf.Model([beam], [bf.Clamp(beam.start)], [Heavy(beam.end, (0.0, 1.0))])

    assert loaded().alike is not loaded().alike


def test_threads_that_solve_models_alike_do_not_disturb_each_other(nothing_known):
    loads = np.linspace(-40.0, 40.0, 40)
    expected = [bf.solve_static(frame(load=load)).p[-1] for load in loads]
    likeness._known.cache_clear()
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda load: bf.solve_static(frame(load=load)).p[-1], loads))
    np.testing.assert_array_equal(found, expected)


def test_what_a_solve_finds_out_is_not_shared(nothing_known):
    """Whether a tangent keeps its digits depends on the state, and further solves on what was found."""
    one, other = system_of(frame(), True), system_of(frame(load=3.0), True)
    one.proven.add("something")
    assert not other.proven
    assert one.known_loads is not other.known_loads


def test_no_shared_property_depends_on_the_size_of_loads(nothing_known):
    """Whoever marks a property as shared: it must be the same for all models that are alike."""
    models = [frame(load=load, more=lambda beam, load=load: [bf.Gravity((load, 1.0))]) for load in (20.0, -3.0)]
    shared = [name for name, item in vars(System).items() if isinstance(item, shared_property)]
    assert len(shared) > 10
    found = []
    for model in models:
        likeness._known.cache_clear()
        system = system_of(replace(model), True)
        found.append({name: _numbers(getattr(system, name)) for name in shared if name not in _WITHOUT_NUMBERS})
    for name in found[0]:
        for one, other in zip(found[0][name], found[1][name], strict=True):
            np.testing.assert_array_equal(one, other, err_msg=name)


# addresses, work spaces, and the unit loads of the first model, which `Actions.of` replaces
_WITHOUT_NUMBERS = (
    *("solver_table", "equations", "without_stiffness", "strain_rates"),
    *("spare", "spare_motions", "spare_assemblers", "_actions_alike"),
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


@pytest.mark.parametrize("curve", [bf.Line((0, 0), (1, 0)), bf.Arc((0, 0), 1.0, 0.0, 1.0)])
def test_what_is_shared_cannot_be_overwritten(curve, nothing_known):
    mesh = bf.Model([bf.Beam(curve, 3, bf.CRBF(2), SECTION, STEEL)]).meshes[0]
    for values in (
        mesh.position,
        mesh.tangent,
        mesh.arc,
        mesh.lengths,
        mesh.node,
        *mesh.kinematics,
        *mesh.classes,
    ):
        with pytest.raises(ValueError, match="read-only"):
            values[...] = 0


def test_zeros_have_no_sign():
    line = bf.Line((-0.0, 0.0), (-1.0, -0.0))
    assert [str(x) for x in (*line.start, *line.end)] == ["0.0", "0.0", "-1.0", "0.0"]


def test_loads_of_a_motion_are_not_kept_with_its_workspace(nothing_known):
    model = frame(more=lambda beam: [bf.PointForce(beam.end, (0.0, 5.0), amplitude=np.sin)])
    bf.simulate(model, 0.5, 1e-3)
    (space,) = system_of(model, static=False).spare_motions
    assert max(array.size for array in space.assembler._acting) == 0
