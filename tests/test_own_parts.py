"""Loads, supports and joints from beside the package: the same as ours, solved, drawn, saved and checked."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf
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
    class Nothing(bf.model.load.Load):
        place = None
        conservative = True

        def shapes(self, weight, placed):
            return ()

    with pytest.raises(bf.InputError, match=r"loads of a Model cannot hold .*, but Gravity, DistributedLoad, Pressure"):
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
