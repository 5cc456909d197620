"""Random motions with steps from a thousandth to three times the lowest period: which finish and keep energy.

Mechanisms with masses, springs and rigid bodies, hinged chains that fall, and bent beams that are let go, of six kinds
of elements, each the same for the same seed: python -m studies.benchmarks.random_motions [first] [last]. Rows of long
steps miss the fastest states, so that the energy exchanged is that of a motion with a fiftieth of the period as well.
"""

import sys
import time
import warnings
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

import beamfem as bf
from beamfem.results.energy_balance import balance

KINDS = [bf.CRBF(1), bf.CRBF(2), bf.CRBF(3), bf.ANCFCRBF(bf.Structural()), bf.ANCF(bf.Structural()), bf.ShearRigid()]
WITHIN = 0.02  # of the energy exchanged
LONGEST = 2.0  # period taken as the lowest one at most [s]
Random = np.random.Generator


@dataclass(frozen=True)
class Case:
    """A model, its state at the start, its lowest period [s], and the step [s] and integrator of a motion."""

    model: bf.Model
    start: bf.Solution | None
    period: float
    step: float
    rho_inf: float

    def simulate(self, duration: float, step: float) -> bf.Solution:
        """Return a motion of the model."""
        return bf.simulate(self.model, duration, step, bf.GeneralizedAlpha(self.rho_inf), self.start)

    @property
    def duration(self) -> float:
        """Return two periods, but 20 steps at least and 3000 at most [s]."""
        return self.step * int(min(max(20.0, 2.0 * self.period / self.step), 3000.0))

    def __str__(self) -> str:
        element = self.model.beams[0].element.name
        return f"{element:27} rho_inf {self.rho_inf} step {self.step / self.period:.2g} periods"


def case(seed: int) -> Case:
    """Return the case of a seed."""
    rng = np.random.default_rng(seed)
    kind, start = KINDS[rng.integers(len(KINDS))], None
    draw = rng.integers(3)
    if draw == 0:
        model = _mechanism(rng, kind)
    elif draw == 1:
        model = _chain(rng, kind)
    else:
        model, start = _released(rng, kind)
    try:
        frequencies = bf.solve_modes(model, 6).frequencies
    except bf.BeamfemError:
        frequencies = np.array([])
    period = min(1.0 / min(frequencies[frequencies > 1e-3], default=2.0), LONGEST)
    return Case(model, start, period, period * 10.0 ** rng.uniform(-3.0, np.log10(3.0)), float(rng.choice([1.0, 0.9])))


def _mechanism(rng: Random, kind: bf.Element) -> bf.Model:
    """Return two to four clamped columns with up to six springs, links, masses and bodies between them."""
    count, (width, height) = int(rng.integers(2, 5)), rng.uniform(0.01, 0.03, 2)
    steel, section = bf.Material(2.1e11, 0.3, 7850.0), bf.Rectangle(width, height)
    bending = 2.1e11 * width * height**3 / 12.0
    feet = np.cumsum(rng.uniform(0.3, 0.8, count))
    lines = [((x, rng.uniform(-0.1, 0.1)), (x + rng.uniform(-0.4, 0.4), rng.uniform(0.6, 1.2))) for x in feet]
    beams = [bf.Beam(bf.Line(*line), 3, kind, section, steel) for line in lines]
    parts, masses = [], []
    for _ in range(int(rng.integers(2, 7))):
        one, two = rng.choice(count, 2, replace=False)
        a, b = beams[one].end, beams[two].at(float(rng.choice([1.0 / 3.0, 1.0])))
        match int(rng.integers(5)):
            case 0:
                masses.append(bf.PointMass(a, rng.uniform(0.1, 3.0), rng.choice([0.0, 0.02])))
            case 1:
                masses.append(bf.RigidBody(a, rng.uniform(0.1, 3.0), 0.01, tuple(rng.uniform(-0.1, 0.1, 2).tolist())))
            case 2:
                parts.append(bf.SpringDamper(a, b, bending * rng.uniform(0.1, 20.0)))
            case 3:
                parts.append(bf.TorsionSpring(a, b, bending * rng.uniform(0.1, 1.0)))
            case _ if not any(isinstance(part, bf.Link) for part in parts):
                parts.append(bf.Link(a, b))
    push = bf.PointForce(beams[0].end, tuple((0.3 * bending * rng.uniform(-1.0, 1.0, 2)).tolist()))
    clamps = [bf.Clamp(beam.start) for beam in beams]
    return bf.Model(beams, clamps, [bf.Gravity((1.0, -9.81)), push], connectors=parts, masses=masses)


def _chain(rng: Random, kind: bf.Element) -> bf.Model:
    """Return one to four beams from rubber to steel that fall from a support."""
    count, width, height = int(rng.integers(1, 5)), 0.02, 10.0 ** rng.uniform(-2.7, -1.3)
    material = bf.Material(10.0 ** rng.uniform(6.0, 11.3), 0.3, rng.uniform(1000.0, 8000.0))
    bars = [rng.uniform(0.3, 1.0) * np.array([np.cos(t), np.sin(t)]) for t in rng.uniform(-1.2, 1.2, count)]
    corners = np.cumsum([(0.0, 0.0), *bars], axis=0).tolist()
    section = bf.Rectangle(width, height)
    beams = [bf.Beam(bf.Line(a, b), int(rng.integers(2, 9)), kind, section, material) for a, b in pairwise(corners)]
    joints = [(bf.Hinge if rng.random() < 0.7 else bf.Rigid)(a.end, b.start) for a, b in pairwise(beams)]
    supports = [(bf.Pin if rng.random() < 0.6 else bf.Clamp)(beams[0].start)]
    if count > 1 and rng.random() < 0.4:
        supports.append(bf.Pin(beams[-1].end))
    masses = [bf.PointMass(beams[-1].end, rng.uniform(0.1, 3.0))] if rng.random() < 0.4 else []
    return bf.Model(beams, supports, [bf.Gravity((0.0, -9.81))], joints, masses=masses)


def _released(rng: Random, kind: bf.Element) -> tuple[bf.Model, bf.Solution]:
    """Return a cantilever, and its state under a force at its tip."""
    height, material = 10.0 ** rng.uniform(-3.0, -1.5), bf.Material(10.0 ** rng.uniform(8.0, 11.3), 0.3, 3000.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), int(rng.integers(2, 13)), kind, bf.Rectangle(0.02, height), material)
    force = rng.uniform(0.1, 4.0) * material.youngs_modulus * 0.02 * height**3 / 12.0
    clamp = [bf.Clamp(beam.start)]
    bent = bf.solve_static(bf.Model([beam], clamp, [bf.PointForce(beam.end, (0.0, force))]), steps=10)
    return bf.Model([beam], clamp), bent


def changes(found: Case) -> tuple[bf.Solution, float, float]:
    """Return the motion of a case, and its largest rise and fall of energy, of what is exchanged."""
    motion = found.simulate(found.duration, found.step)
    judged = balance(motion)
    exchanged = judged.exchanged
    if found.step > 0.02 * found.period:
        fine = found.simulate(min(2.0 * found.period, found.duration), 0.02 * found.period)
        exchanged = max(exchanged, balance(fine).exchanged)
    return motion, float(judged.rise.max() / exchanged), float(judged.loss.max() / exchanged)


def main(first: int = 0, last: int = 500) -> None:
    """Print each case and a summary."""
    warnings.simplefilter("ignore")
    ended, missed = 0, 0
    for seed in range(first, last):
        found, begin = case(seed), time.perf_counter()
        try:
            motion, rise, fall = changes(found)
        except bf.ConvergenceError as error:
            ended += 1
            print(f"{seed:4} {found}: {error}", flush=True)
            continue
        good = rise < WITHIN and (fall < WITHIN or found.rho_inf < 1.0)
        missed += not good
        print(
            f"{seed:4} {found}: rise {rise:.1e} fall {fall:.1e} cuts {motion.statistics.cuts} steps "
            f"{motion.statistics.steps} in {time.perf_counter() - begin:.1f} s{'' if good else ' MISSED'}",
            flush=True,
        )
    print(f"of {last - first} motions {ended} ended in errors, {missed} change their energy by more than {WITHIN:.0%}")


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
