"""Loads, supports and joints from beside the package: the same as ours, solved, drawn, saved and checked."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf
from beamfem.equations.system import system_of
from beamfem.solve.start.functions_of_time import functions_of_time
from tests.own_parts import Bracket, Growth, Guide, HalfWave, Traction, Weld

ELEMENTS = [bf.CRBF(order=2), bf.ANCFCRBF(), bf.ANCF(forces=bf.Structural()), bf.ShearRigid()]
STEEL = bf.Material(youngs_modulus=1e7, poisson_ratio=0.0, density=1000.0)


def bar(element, at=(0.0, 0.0)):
    return bf.Beam(bf.Line(at, (at[0] + 1.0, at[1])), 6, element, bf.Rectangle(0.05, 0.1), STEEL)


@pytest.mark.parametrize("element", ELEMENTS, ids=str)
def test_loads_of_ones_own_are_those_of_the_package(element):
    own, ours = bar(element), bar(element)
    wave = bf.DistributedLoad(ours, lambda s: (0.0, -20.0 * np.sin(np.pi * s)))
    force, moment = bf.PointForce(ours.end, (0.0, -30.0)), bf.PointMoment(ours.end, -6.0)
    growth = bf.Actuation(ours, stretch=0.0 if element == bf.ShearRigid() else 0.01)
    theirs = [HalfWave(own, -20.0), Bracket(own.end, 30.0, 0.2), Growth(own, growth.stretch)]
    a = bf.solve_static(bf.Model([own], [bf.Clamp(own.start)], theirs))
    b = bf.solve_static(bf.Model([ours], [bf.Clamp(ours.start)], [wave, force, moment, growth]))
    assert np.abs(a.p[-1] - b.p[-1]).max() < 1e-12
    assert a.energy().potential == pytest.approx(b.energy().potential, rel=1e-12)


@pytest.mark.parametrize("element", ELEMENTS, ids=str)
def test_a_traction_along_the_deformed_axis_pulls_with_the_chord(element):
    """The integral of t r' ds is t times the vector between the ends, whatever the shape."""
    own = bar(element)
    loads = [Traction(own, 200.0), bf.PointForce(own.end, (0.0, 40.0), scale=False)]
    model = bf.Model([own], [bf.Clamp(own.start)], loads)
    solution = bf.solve_static(model)
    chord = solution.position(own.end)[-1] - solution.position(own.start)[-1]
    assert chord[1] > 0.05
    assert solution.reaction(own.start)[-1, :2] == pytest.approx(-200.0 * chord - [0.0, 40.0], rel=1e-7)
    assert not solution.model.loads[0].conservative


def test_supports_and_joints_of_ones_own_are_those_of_the_package():
    element = bf.CRBF(order=2)

    def solved(support, joint):
        one, two = bar(element), bar(element, (1.0, 0.0))
        supports = [bf.Clamp(one.start), *support(two.end)]
        return bf.solve_static(
            bf.Model([one, two], supports, [bf.PointForce(one.end, (0.0, -50.0))], [joint(one, two)])
        )

    own = solved(lambda at: [Guide(at, 100.0)], lambda one, two: Weld(one.end, two.start))
    ours = solved(
        lambda at: [bf.Prescribed(at, ux=0.0, rotation=0.0), bf.Spring(at, (0.0, 100.0))],
        lambda one, two: bf.Rigid(one.end, two.start),
    )
    assert np.array_equal(own.p, ours.p)
    end = [solution.model.beams[1].end for solution in (own, ours)]
    assert np.array_equal(own.reaction(end[0]), ours.reaction(end[1]))


def test_models_with_parts_of_ones_own_are_drawn_and_saved(tmp_path):
    own = bar(bf.CRBF(order=2))
    loads = [Traction(own, 20.0, lambda time: time**2), Bracket(own.end, 3.0, 0.2), Growth(own, lambda s: 0.01 * s)]
    model = bf.Model([own], [bf.Clamp(own.start), Guide(own.end, 10.0)], loads)
    solution = bf.solve_static(model)
    model.plot(tmp_path / "model.png")
    solution.plot(tmp_path / "state.png")
    solution.save(tmp_path / "own.h5")
    loaded = bf.load(tmp_path / "own.h5")
    assert np.array_equal(loaded.p, solution.p)
    assert type(loaded.model.supports[1]) is Guide
    assert [type(load) for load in loaded.model.loads] == [Traction, Bracket, Growth]
    assert loaded.reaction(loaded.model.beams[0].start) == pytest.approx(solution.reaction(own.start), rel=1e-12)


@dataclass(frozen=True)
class Springy(bf.PointSupport):
    """Has a function of something."""

    point: bf.Point
    law: object

    def prescribed(self):
        return {"ux": 0.0, "uy": 0.0, "rotation": 0.0}


def test_functions_of_an_unknown_argument_are_not_saved(tmp_path):
    own = bar(bf.ANCFCRBF())
    solution = bf.solve_static(bf.Model([own], [Springy(own.start, np.sin)], []))
    with pytest.raises(bf.InputError, match="a Springy cannot be saved: its field law is a function"):
        solution.save(tmp_path / "a.h5")


def test_parts_that_no_equation_would_see_are_refused():
    own = bar(bf.ANCFCRBF())

    @dataclass(frozen=True)
    class Nothing(bf.model.load_base.Load):
        place = None
        conservative = True

        def shapes(self, weight, placed):
            return ()

    with pytest.raises(bf.InputError, match=r"loads of a Model cannot hold .*, but Actuation, DistributedLoad"):
        bf.Model([own], [bf.Clamp(own.start)], [Nothing()])

    class Plain(bf.PointSupport):
        def __init__(self, point):
            self.point = point

    with pytest.raises(bf.InputError, match="Plain, one of the supports of a Model, must be a frozen dataclass"):
        bf.Model([own], [Plain(own.start)])
    with pytest.raises(bf.InputError, match="scale of Scaled"):
        Scaled(own, 1.0)
    with pytest.raises(bf.InputError, match="point of Bracket must be a Point"):
        Bracket(own, 1.0, 1.0)


@dataclass(frozen=True)
class Scaled(HalfWave):
    scale: object = 1


@dataclass(frozen=True)
class Push(bf.PointSupport):
    """Prescribes a displacement from the start, along with a spring that turns back."""

    point: bf.Point
    size: float
    stiffness: float

    def prescribed(self):
        return {"uy": lambda time: self.size}

    def springs(self):
        return {"rotation": self.stiffness}


@dataclass(frozen=True)
class Turned(bf.PointSupport):
    """Slides along an inclined line, turned from the start."""

    point: bf.Point
    angle: float

    def prescribed(self):
        return {"normal": 0.0, "rotation": lambda time: self.angle}

    @property
    def direction(self):
        return np.array([0.6, 0.8])


def arch():
    section = bf.Rectangle(0.05, 0.02)
    return bf.Beam(bf.Arc((0.0, 0.0), 1.0, np.pi, 0.0), 12, bf.CRBF(order=2), section, STEEL)


def test_supports_that_are_moved_far_from_the_start_keep_their_springs():
    """Their first equilibrium is found by a path along which they grow, as no step of Newton reaches it."""

    def first(supports):
        beam = arch()
        moved = bf.Prescribed(beam.end, ux=lambda time: -2.2)
        model = bf.Model([beam], [bf.Clamp(beam.start), moved, *supports(beam.end)], [])
        return bf.solve_static(model).p[0]

    own = first(lambda at: [Push(at, -0.7, 50.0)])
    ours = first(lambda at: [bf.Prescribed(at, uy=lambda time: -0.7), bf.Spring(at, (0.0, 0.0), 50.0)])
    assert own == pytest.approx(ours, abs=1e-9)


def test_supports_that_are_turned_far_from_the_start_keep_their_direction():
    def first(supports):
        beam = arch()
        return bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start), *supports(beam.end)], [])).p[0]

    own = first(lambda at: [Turned(at, -4.0)])
    ours = first(lambda at: [bf.Roller(at, (0.6, 0.8)), bf.Prescribed(at, rotation=lambda time: -4.0)])
    assert own == pytest.approx(ours, abs=1e-9)


@dataclass(frozen=True)
class Standing(Bracket):
    """A weight that acts from the start."""

    scale: bool = False


def test_large_loads_without_an_amplitude_among_their_fields_grow_from_nothing():
    own, ours = bar(bf.CRBF(order=2)), bar(bf.CRBF(order=2))
    a = bf.solve_static(bf.Model([own], [bf.Clamp(own.start)], [Standing(own.end, 5000.0, 0.0)]))
    force = bf.PointForce(ours.end, (0.0, -5000.0), scale=False)
    b = bf.solve_static(bf.Model([ours], [bf.Clamp(ours.start)], [force]))
    assert a.p == pytest.approx(b.p, abs=1e-9)


@dataclass(frozen=True)
class Size(bf.LineLoad):
    """A force [N/m] in y whose size is a function of the arc length."""

    beam: bf.Beam
    size: object
    along = ("size",)
    axes = "plane"

    def forces(self, arc_length):
        return np.column_stack([np.zeros_like(arc_length), [self.size(s) for s in arc_length.tolist()]])


def test_sizes_along_a_beam_are_saved_as_what_they_are(tmp_path):
    own = bar(bf.CRBF(order=2))
    load = Size(own, lambda s: -20.0 if s < 0.43 else -5.0)
    solution = bf.solve_static(bf.Model([own], [bf.Clamp(own.start)], [load]))
    solution.save(tmp_path / "own.h5")
    loaded = bf.load(tmp_path / "own.h5")
    assert bf.solve_static(loaded.model).p == pytest.approx(solution.p, abs=1e-12)
    assert loaded.energy().potential == pytest.approx(solution.energy().potential, rel=1e-12)


@dataclass(frozen=True)
class Degrees(bf.PointLoad):
    """Turns its field into radians, again whenever it is made."""

    point: bf.Point
    angle: float

    def __post_init__(self):
        object.__setattr__(self, "angle", float(np.radians(self.angle)))

    @property
    def value(self):
        return np.cos(self.angle), np.sin(self.angle), 0.0


class Heavy(Bracket):
    """Has arguments of its own."""

    def __init__(self, point):
        super().__init__(point, 5.0, 0.0)


@pytest.mark.parametrize(
    ("load", "message"),
    [
        (lambda at: Degrees(at, 80.0), "Degrees cannot be .*: its field angle changes when"),
        (lambda at: Heavy(at), "Heavy cannot be .*: it cannot be recreated from its fields"),
    ],
)
def test_parts_that_differ_when_made_anew_are_neither_saved_nor_moved(tmp_path, load, message):
    own = bar(bf.CRBF(order=2))
    model = bf.Model([own], [bf.Clamp(own.start)], [load(own.end)])
    solution = bf.solve_static(model)
    with pytest.raises(bf.InputError, match=message):
        solution.save(tmp_path / "a.h5")
    with pytest.raises(bf.InputError, match=message):
        model.with_imperfection(bf.solve_modes(model, 1), 0.01)


@dataclass(frozen=True)
class Beside(bf.PointLoad):
    """Knows another beam, and numbers in a tuple."""

    point: bf.Point
    other: object
    value = (0.0, -1.0, 0.0)


def test_what_parts_hold_is_saved_as_it_is_or_refused(tmp_path):
    own = bar(bf.CRBF(order=2))

    def saved(other):
        model = bf.Model([own], [bf.Clamp(own.start)], [Beside(own.end, other)])
        bf.solve_static(model).save(tmp_path / "a.h5")
        return bf.load(tmp_path / "a.h5").model.loads[0].other

    assert [type(part) for part in saved((np.ones(2), 3.0))] == [np.ndarray, float]
    with pytest.raises(bf.InputError, match=r"refers to the beam .*, which is not in the model"):
        saved(bar(bf.CRBF(order=2)))
    with pytest.raises(bf.InputError, match="its field other is a function"):
        saved(((np.sin,),))


def test_files_name_a_class_that_has_changed_or_is_missing(tmp_path, monkeypatch):
    own = bar(bf.CRBF(order=2))
    bf.solve_static(bf.Model([own], [bf.Clamp(own.start)], [Standing(own.end, 5.0, 0.0)])).save(tmp_path / "a.h5")
    monkeypatch.setitem(globals(), "Standing", Degrees)
    with pytest.raises(bf.InputError, match=r"class .*:Standing is no longer that which the file was saved with"):
        bf.load(tmp_path / "a.h5")
    monkeypatch.delitem(globals(), "Standing")
    with pytest.raises(bf.InputError, match="the file holds a Standing of the module"):
        bf.load(tmp_path / "a.h5")


def test_amplitudes_that_are_methods_are_each_their_own():
    @dataclass(frozen=True)
    class Blow(bf.LineLoad):
        beam: bf.Beam
        period: float
        axes = "axis"
        uniform = True

        def amplitude(self, time):
            return np.sin(time / self.period)

        def forces(self, arc_length):
            return np.tile([0.0, 20.0], (len(arc_length), 1))

    one, two = bar(bf.CRBF(order=2)), bar(bf.CRBF(order=2), (1.0, 0.0))
    loads = [Blow(one, 1.0), Blow(two, 2.0)]
    model = bf.Model([one, two], [bf.Clamp(one.start), bf.Clamp(two.end)], loads, [bf.Rigid(one.end, two.start)])
    assert not system_of(model, static=True).symmetric
    assert len(functions_of_time(system_of(model, static=False))) == 2
