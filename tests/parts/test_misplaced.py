"""Mistakes of a first model: the message names the place where a part belongs, or what a part lacks."""

from dataclasses import dataclass

import numpy as np
import pytest

import beamfem as bf

STEEL, SQUARE = bf.Material(2e11, 0.3, 7800.0), bf.Rectangle(0.01, 0.01)
AXIS = bf.Line((0, 0), (2, 0))
BEAM = bf.Beam(AXIS, 4, bf.CRBF(2), SQUARE, STEEL)
NEXT, AWAY = (bf.Beam(bf.Line(*ends), 4, bf.CRBF(2), SQUARE, STEEL) for ends in (((2, 0), (3, 0)), ((5, 0), (6, 0))))
CLAMP, FORCE = bf.Clamp(BEAM.start), bf.PointForce(BEAM.end, (0.0, 1.0))


def pull(self, at):
    return 5.0 * (at.q - at.reference).ravel()


def stored(self, at):
    away = (at.q - at.reference)[0]
    return 0.0, 2.5 * (away @ away)


def connector(**members):
    parts = {"unknowns": 0, "conservative": True, "points": property(lambda self: (self.end,))}
    members = {**parts, "force": pull, "energy": stored, "__annotations__": {"end": bf.Point}, **members}
    members = {name: value for name, value in members.items() if value is not None}
    return dataclass(frozen=True)(type("Tie", (), members))(BEAM.end)


def tied(**members):
    return lambda: bf.solve_static(bf.Model([BEAM], [CLAMP], connectors=[connector(**members)]))


@dataclass(frozen=True)
class Pair(bf.Joint):
    first: bf.Point
    second: bf.Point


@dataclass(frozen=True)
class Push(bf.PointLoad):
    where: bf.Point
    value = (0.0, 1.0, 0.0)


@dataclass(frozen=True)
class Called(bf.PointLoad):
    point: bf.Point

    def value(self):
        return 0.0, 1.0, 0.0


@dataclass(frozen=True)
class Flat(bf.LineLoad):
    beam: bf.Beam
    axes = "plane"

    def forces(self, arc_length):
        return np.zeros((2, len(arc_length)))


@dataclass(frozen=True)
class Half(bf.Section):
    def resultants(self, strain, material):
        return strain


@dataclass(frozen=True)
class OtherHalf(bf.Section):
    def energy(self, strain, material):
        return strain[:, 0]


PROFILE = {"area": 1e-4, "second_moment": 8.333e-10}
MISTAKES = {
    "an amplitude of two numbers": (
        lambda: bf.solve_static(
            bf.Model([BEAM], [CLAMP], [bf.PointForce(BEAM.end, (0, 1), amplitude=lambda t: (0, t))])
        ),
        r"^amplitude of PointForce at 0 must be a number, got \(0, 0.0\)$",
    ),
    "a beam for a list": (lambda: bf.Model(BEAM, [CLAMP]), r"beams of Model .* brackets: beams=\[...\]"),
    "a clamp for a list": (lambda: bf.Model([BEAM], CLAMP), r"write it in brackets: supports=\[...\]"),
    "a load among supports": (lambda: bf.Model([BEAM], [FORCE]), "supports of a Model .*; it belongs in loads"),
    "a support among loads": (lambda: bf.Model([BEAM], [], [CLAMP]), "it belongs in supports"),
    "a joint among supports": (lambda: bf.Model([BEAM], [bf.Hinge(BEAM.start, BEAM.end)]), "it belongs in joints"),
    "a connector among loads": (lambda: bf.Model([BEAM], [], [connector()]), "it belongs in connectors"),
    "a connector without energy": (tied(energy=None), "has no energy, but a Contribution"),
    "a connector without two": (tied(energy=None, unknowns=None), "has no unknowns and no energy"),
    "one energy": (tied(energy=lambda self, at: 0.0), "kinetic and potential energy in this order, got 0.0"),
    "a force by points": (
        tied(force=lambda self, at: pull(self, at)[None]),
        r"as an array \(3,\), got float64 \(1, 3\); .ravel\(\) makes it flat",
    ),
    "an element function": (lambda: bf.Beam(AXIS, 4, bf.CRBF, SQUARE, STEEL), r"an Element, such as CRBF\(order=3\)"),
    "section and material swapped": (
        lambda: bf.Beam(AXIS, 4, bf.CRBF(2), STEEL, SQUARE),
        "; the section comes before the material",
    ),
    "an arc length as a fraction": (lambda: BEAM.at(1.5), "got 1.5; an arc length s is at the fraction s / 2$"),
    "beyond the beam": (lambda: BEAM.at(2.5), "got 2.5$"),
    "a joint of the wrong ends": (
        lambda: bf.Model([BEAM, NEXT], joints=[bf.Rigid(BEAM.end, NEXT.end)]),
        "which are 1 m apart; .* of the longer beam; the end of the first beam and the start of the second do$",
    ),
    "a joint of beams apart": (
        lambda: bf.Model([BEAM, AWAY], joints=[bf.Rigid(BEAM.end, AWAY.end)]),
        "which are 4 m apart; a joint needs points that coincide, to 1e-05 .*; Weld .* arm, Link .* SliderOnBeam ",
    ),
    "a joint without a and b": (lambda: Pair(BEAM.start, BEAM.end), "Pair has no field a; it needs one, for a Point"),
    "a load without a point": (lambda: Push(BEAM.end), "Push has no field point"),
    "a value that is called": (lambda: bf.Model([BEAM], [CLAMP], [Called(BEAM.end)]), "a property, not a method"),
    "forces in rows": (lambda: bf.Model([BEAM], [CLAMP], [Flat(BEAM)]), r"array \(n, 2\) .*, got \(2, 3\) array"),
    "resultants alone": (
        lambda: bf.Beam(AXIS, 4, bf.CRBF(2), Half(**PROFILE), STEEL),
        r"Half has resultants, but no energy: a section law needs resultants\(strain, material\) and energy",
    ),
    "energy alone": (
        lambda: bf.Beam(AXIS, 4, bf.CRBF(2), OtherHalf(**PROFILE), STEEL),
        "OtherHalf has energy, but no resultants",
    ),
    "resultants alone, tapered": (
        lambda: bf.Beam(AXIS, 4, bf.CRBF(2), lambda s: Half(**PROFILE), STEEL),
        "Half has resultants, but no energy",
    ),
}


@pytest.mark.parametrize("case", MISTAKES)
def test_the_message_says_what_would_be_right(case):
    make, message = MISTAKES[case]
    with pytest.raises(bf.InputError, match=message):
        make()


def test_a_beam_made_again_is_another_beam():
    """As when the cell of a notebook that makes the beams is run a second time."""
    model = bf.Model([BEAM], [CLAMP], [FORCE])
    again, elsewhere = (bf.Beam(axis, 4, bf.CRBF(2), SQUARE, STEEL) for axis in (AXIS, bf.Line((0, 0), (3, 0))))
    hint = r"; (add it to beams, or )?use model.beams\[0\], a beam on the same axis$"
    solution = bf.solve_static(model)
    for ask in (
        lambda: solution.displacement(again.end),
        lambda: solution.section_forces(again),
        lambda: bf.Model([BEAM], [bf.Clamp(again.start)]),
    ):
        with pytest.raises(bf.UnknownPointError, match=hint):
            ask()
    with pytest.raises(bf.UnknownPointError, match=r"is on a beam that is not in this model$"):
        solution.displacement(elsewhere.end)
    with pytest.raises(bf.UnknownPointError, match=r"; add it to beams$"):
        bf.Model([BEAM], [bf.Clamp(elsewhere.start)])


def test_the_tie_without_a_mistake_is_solved():
    held = bf.solve_static(bf.Model([BEAM], [CLAMP], [FORCE], connectors=[connector()]))
    free = bf.solve_static(bf.Model([BEAM], [CLAMP], [FORCE]))
    assert 0.0 < held.displacement(BEAM.end)[-1, 1] < free.displacement(BEAM.end)[-1, 1]
