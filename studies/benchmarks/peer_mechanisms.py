"""Slider-crank and four-bar linkage beside Exudyn: the same bars, steps and generalized-alpha method.

All bars are beams, and only the last one is soft; Exudyn has the first one as a rigid body as well. They start from
rest under gravity, and again with a torque that begins at once, so that the stiff bars vibrate faster than the steps
resolve. The error in the table is how far the end and the middle of the last bar are apart in both codes.
"""

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from math import cos, dist, radians, sin

import numpy as np

import beamfem as bf
from studies.benchmarks.peer_cases import (
    CABLE,
    INSTANTS,
    LINEAR_SOLVERS,
    SPARSE,
    STRUCTURAL,
    THREE_NODES,
    TWO_NODES,
    Chain,
    Linkage,
)
from studies.benchmarks.peer_clock import fastest, in_turns
from studies.benchmarks.peer_ratios import Row, row

SHEAR_FREE = bf.ShearRigid(forces=bf.ElasticLine())  # 4 coordinates a node and the strains of the cable
PAIRS = ((STRUCTURAL, TWO_NODES), (bf.CRBF(2), THREE_NODES), (SHEAR_FREE, CABLE))
STEPS, GRAVITY, GOAL = 1000, 9.81, 0.15
RADIUS = 0.9  # spectral radius, by default in both codes
ELEMENTS = (8, 24)  # of the soft bar; stiff ones have one each


def slider_crank() -> Linkage:
    """Return a slider-crank with a soft rod."""
    section = bf.Rectangle(0.02, 0.01)
    bars = _bar(0.15, section, 7e10, 2700.0), _bar(0.4, section, 2e8, 2700.0)
    return Linkage("slider-crank", ((0.0, 0.0), (0.15, 0.0), (0.55, 0.0)), bars, 0.5, 0.5, slider=0.5)


def four_bar() -> Linkage:
    """Return a linkage with a soft rocker, whose crank can turn round."""
    points, section = _FOUR, bf.Rectangle(0.01, 0.004)
    crank, coupler, rocker = (dist(*ends) for ends in pairwise(points))
    stiff = (_bar(length, section, 7e10, 2700.0) for length in (crank, coupler))
    return Linkage("four-bar", points, (*stiff, _bar(rocker, section, 2e9, 1200.0)), 0.02, 0.5)


_FOUR = ((0.0, 0.0), (0.1, 0.0), (0.4 + 0.3 * cos(radians(80.0)), 0.3 * sin(radians(80.0))), (0.4, 0.0))


def _bar(length: float, section: bf.Rectangle, modulus: float, density: float) -> Chain:
    own = section.rigidity(bf.Material(modulus, 0.3, density))
    mass, rotary = density * section.area, density * section.second_moment
    return Chain(length, own.axial, own.shear, own.bending, mass, rotary, False, GRAVITY)


def model(case: Linkage, element: bf.Element, elements: Sequence[int]) -> bf.Model:
    """Return a linkage in beamfem."""
    beams = [
        bf.Beam(bf.Line(*ends), count, element, bf.Section.from_stiffness(*parts))
        for ends, count, parts in zip(
            pairwise(case.points),
            elements,
            [(own.axial, own.shear, own.bending, own.mass, own.rotary) for own in case.bars],
            strict=True,
        )
    ]
    first, last = beams[0].start, beams[-1].end
    return bf.Model(
        beams,
        [bf.Pin(first), bf.Roller(last) if case.slider else bf.Pin(last)],
        [bf.PointMoment(first, case.torque), bf.Gravity((0.0, -GRAVITY))],
        [bf.Hinge(before.end, after.start) for before, after in pairwise(beams)],
        masses=[bf.PointMass(last, case.slider)] if case.slider else [],
    )


def turn(model: bf.Model, case: Linkage, steps: int = STEPS) -> bf.Solution:
    """March, and keep ten instants."""
    method = bf.GeneralizedAlpha(RADIUS)
    return bf.simulate(model, case.duration, case.duration / steps, method, save_every=steps // len(INSTANTS))


def positions(solution: bf.Solution) -> np.ndarray:
    """Return where end and middle of the last bar were at the instants (times, 4) [m]."""
    bar = solution.model.beams[-1]
    return np.hstack([solution.position(bar.end), solution.position(bar.at(0.5))])[1:]


def mechanisms() -> list[Row]:
    """Return the lines of both linkages."""
    driven = slider_crank(), four_bar()
    linkages = [each for case in driven for each in (replace(case, name=f"{case.name} falls", torque=0.0), case)]
    cases = [(case, *pair, count) for case in linkages for pair in PAIRS for count in ELEMENTS]
    return [line for case in cases for line in compared(*case)]


def compared(case: Linkage, element: bf.Element, kind: str, count: int) -> list[Row]:
    """Return lines of a linkage whose soft bar has some elements: the first bar of Exudyn as a beam, and rigid."""
    from studies.benchmarks.exudyn_models import linkage

    if kind == CABLE:  # it has no rotary inertia
        case = replace(case, bars=tuple(replace(bar, rotary=1e-12) for bar in case.bars))
    elements = (1,) * (len(case.bars) - 1) + (count,)
    own, lines = model(case, element, elements), list[Row]()
    solvers = LINEAR_SOLVERS if count <= 8 else (SPARSE,)
    for rigid in (False, True):
        other = linkage(kind, case, elements, rigid)
        tasks = [partial(other.motion, STEPS, case.duration, each, 1, "GeneralizedAlpha") for each in solvers]
        tasks[0]()
        if other.tangents() > STEPS:
            continue  # it hardly converges, and would take minutes
        mine, *theirs = in_turns([lambda: turn(own, case), *tasks], 5)
        apart = float(np.abs(other.positions() - positions(turn(own, case))).max())
        name = f"{kind}{', its crank rigid' if rigid else ''}"
        left, right = (element, count, mine, apart), (name, count, fastest(theirs), apart)
        lines.append(row(f"{case.name}, 1000 steps", left, right, GOAL, other.tangents() / STEPS))
    return lines
