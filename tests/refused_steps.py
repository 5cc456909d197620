"""Motions that ended, or gained energy without limit, before steps were refused: see the tests of that name."""

from contextlib import contextmanager
from itertools import pairwise

import numpy as np

import beamfem as bf
from beamfem.solve.motion.energy_judgement import EnergyJudge

STEEL, ALUMINIUM = bf.Material(2.1e11, 0.3, 7850.0), bf.Material(7e10, 0.3, 2700.0)
CARBON = bf.Material(1e11, 0.3, 1600.0)
ELEMENTS = {
    "CRBF1": bf.CRBF(1),
    "CRBF2": bf.CRBF(2),
    "CRBF3": bf.CRBF(3),
    "ANCF-CRBF": bf.ANCFCRBF(bf.Structural()),
    "ANCF": bf.ANCF(bf.Structural()),
    "ShearRigid": bf.ShearRigid(),
}
GRAVITY = bf.Gravity((0.0, -9.81))
UNDAMPED = bf.GeneralizedAlpha(1.0)


def double_pendulum(element):
    """Aluminium, 20 x 5 mm, from horizontal under gravity."""
    section = bf.Rectangle(0.02, 0.005)
    upper, lower = (bf.Beam(bf.Line((x, 0), (x + 0.5, 0)), 4, element, section, ALUMINIUM) for x in (0.0, 0.5))
    hinge = bf.Hinge(upper.end, lower.start)
    return {"model": bf.Model([upper, lower], [bf.Pin(upper.start)], [GRAVITY], [hinge]), "duration": 5.0}


def _released(beam, force):
    clamp = [bf.Clamp(beam.start)]
    bent = bf.solve_static(bf.Model([beam], clamp, [bf.PointForce(beam.end, (0.0, force))]), steps=10)
    return {"model": bf.Model([beam], clamp), "duration": 1.0, "start": bent}


def strip(element):
    """Steel, 20 x 2 mm, bent by a force of 3 EI / L^2 at its tip and let go."""
    bending = 2.1e11 * 0.02 * 0.002**3 / 12.0
    return _released(bf.Beam(bf.Line((0, 0), (1, 0)), 8, element, bf.Rectangle(0.02, 0.002), STEEL), 3.0 * bending)


def tapered_rod(element):
    """Carbon, 12 to 2.5 mm, bent by 8 N and let go."""
    return _released(
        bf.Beam(bf.Line((0, 0), (2.4, 0)), 8, element, lambda x: bf.Circle(0.012 - 0.0095 * x / 2.4), CARBON), 8.0
    )


def four_bars(element):
    """A soft linkage that falls from rest."""
    section = bf.Section.from_stiffness(axial=1e6, shear=4e5, bending=50.0, mass=1.0, rotary_inertia=1e-3)
    points = [(0.0, 0.0), (0.5, 1.0), (1.7, 1.2), (1.5, 0.0)]
    bars = [bf.Beam(bf.Line(a, b), 4, element, section) for a, b in pairwise(points)]
    joints = [bf.Hinge(one.end, other.start) for one, other in pairwise(bars)]
    return {"model": bf.Model(bars, [bf.Pin(bars[0].start), bf.Pin(bars[2].end)], [GRAVITY], joints), "duration": 3.0}


def _cantilever_without_joint(element, joints):
    section = bf.Rectangle(0.02, 0.005)
    inner, outer = (bf.Beam(bf.Line((x, 0), (x + 0.5, 0)), 4, element, section, ALUMINIUM) for x in (0.0, 0.5))
    clamp, load = [bf.Clamp(inner.start)], [bf.PointForce(outer.end, (0.0, -20.0))]
    start = bf.solve_static(bf.Model([inner, outer], clamp, load, [bf.Rigid(inner.end, outer.start)]), steps=10)
    after = [joint(inner.end, outer.start) for joint in joints]
    return {"model": bf.Model([inner, outer], clamp, load, after), "duration": 1.0, "start": start}


def joint_removed(element):
    """An aluminium cantilever under 20 N breaks in the middle."""
    return _cantilever_without_joint(element, [])


def joint_made_a_hinge(element):
    """The joint in its middle becomes a hinge."""
    return _cantilever_without_joint(element, [bf.Hinge])


def slider_crank(element):
    """A crank that is spun up in a tenth of a second to 40 rad/s drives a slider by a flexible rod."""
    section = bf.Rectangle(0.01, 0.003)
    crank = bf.Beam(bf.Line((0, 0), (0.15, 0)), 2, element, section, STEEL)
    rod = bf.Beam(bf.Line((0.15, 0), (0.45, 0)), 4, element, section, ALUMINIUM)

    def angle(time):
        return 40.0 * (time - 0.1 / np.pi * np.sin(np.pi * time / 0.1)) / 2.0 if time < 0.1 else 40.0 * (time - 0.05)

    supports = [bf.Prescribed(crank.start, ux=0.0, uy=0.0, rotation=angle), bf.Roller(rod.end, (0, 1))]
    joints, masses = [bf.Hinge(crank.end, rod.start)], [bf.PointMass(rod.end, 0.2)]
    model = bf.Model([crank, rod], supports, joints=joints, masses=masses)
    return {"model": model, "duration": 0.5}


def flying_beam(element):
    """A free steel strip that a short pulse across its end sets flying."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, element, bf.Rectangle(0.02, 0.002), STEEL)
    pulse = bf.Piecewise(lambda t: float(t < 0.01), (0.01,))
    return {"model": bf.Model([beam], loads=[bf.PointForce(beam.end, (0.0, 20.0), amplitude=pulse)]), "duration": 0.5}


def linked_arms(element, count=3, elements=4):
    """Soft arms on links that fall from horizontal, and crack like a whip."""
    section, rubber = bf.Section(area=1.6e-3, second_moment=8.533e-6), bf.Material(0.7e6, 0.3, 5540.0)
    arms = [bf.Beam(bf.Line((x, 0), (x + 1.2, 0)), elements, element, section, rubber) for x in 1.3 * np.arange(count)]
    links = [bf.Link(one.end, other.start) for one, other in pairwise(arms)]
    return bf.Model(arms, [bf.Pin(arms[0].start)], [GRAVITY], connectors=links)


# name: motion, step [s], integrator
CASES = {
    "double pendulum, 5 ms": (double_pendulum, 5e-3, UNDAMPED),
    "double pendulum, 2 ms": (double_pendulum, 2e-3, UNDAMPED),
    "strip, 5 ms": (strip, 5e-3, UNDAMPED),
    "strip, 1 ms": (strip, 1e-3, UNDAMPED),
    "tapered rod": (tapered_rod, 1e-3, UNDAMPED),
    "four-bar linkage": (four_bars, 4e-3, None),
    "joint removed": (joint_removed, 1e-3, None),
    "joint made a hinge": (joint_made_a_hinge, 1e-3, None),
    "slider-crank": (slider_crank, 2e-3, UNDAMPED),
    "flying beam": (flying_beam, 5e-3, UNDAMPED),
}


def largest_changes(motion):
    """Return the largest rise and fall of the energy less work since the start, relative to the energy exchanged."""
    from beamfem.results.energy_balance import balance

    found = balance(motion)
    return float(found.rise.max() / found.exchanged), float(found.loss.max() / found.exchanged)


@contextmanager
def all_steps():
    """Provide the states (3, n) at the ends of all steps by their times, those of divided steps included."""
    accept, states = EnergyJudge.accept, {}

    def recorded(judge, times, rows, *options):
        good = accept(judge, times, rows, *options)
        for time in [time for time in states if time > times[0]]:  # steps that are redone
            del states[time]
        states.update(zip(times[: good + 1].tolist(), rows[: good + 1].copy(), strict=True))
        return good

    EnergyJudge.accept = recorded
    try:
        yield states
    finally:
        EnergyJudge.accept = accept


def with_states(motion, states):
    """Return a motion whose rows are states (3, n) by their times."""
    p, v, a = np.stack(list(states.values()), axis=1)
    return bf.Solution(motion.model, False, np.array(list(states)), p, v, a, motion.statistics)
