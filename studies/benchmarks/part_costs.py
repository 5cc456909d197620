"""What parts, those of `tests/trials` and of the package, add to an iteration and to a step on 12 elements.

An iteration of Newton's method in statics has a tangent; most of those of motions do not. A step also changes by the
iterations that it takes with the part.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import hypot
from pathlib import Path

import beamfem as bf
from beamfem.equations.system import system_of
from beamfem.solve.newton.newton import Newton, solve_equilibrium
from beamfem.tables import as_text, write_csv
from studies.benchmarks.peer_clock import in_turns
from tests.trials.test_between_states import SpringBetweenStates
from tests.trials.test_disc import Disc
from tests.trials.test_drag_along import Fluid
from tests.trials.test_kelvin_voigt import OwnBushing
from tests.trials.test_magnet import Magnet
from tests.trials.test_plastic_section import Hinging
from tests.trials.test_rigid_link import OwnLink
from tests.trials.test_rope import Rope
from tests.trials.test_rough_stop import OwnStop

OUT = Path("out/bench")
HEADER = ("part", "places", "statics, us", "with it", "each place", "motion, us", "with it", "each place", "each step")
ITERATIONS, STEPS = (2, 4), (200, 1200)  # the difference of two solves leaves out what they do once
STIFF, STEP = 2.0, 1e-3

Parts = Callable[[bf.Beam, bf.Beam], Sequence[object]]


@dataclass(frozen=True)
class Case:
    """Parts on two beams of 12 elements, of which there are so many, or which act at so many places.

    alone: whether the second beam is left out; section: that of the beams, in place of a rectangle of rubber.
    """

    name: str
    places: int
    parts: Parts
    alone: bool = True
    section: object = None


def springs(one: bf.Beam, two: bf.Beam) -> list[bf.SpringDamper]:
    """Return ten springs and dampers from a beam to the ground."""
    return [bf.SpringDamper(one.at(k / 12), (k / 12, 1.0), STIFF / 10, 0.01) for k in range(1, 11)]


def across(one: bf.Beam, two: bf.Beam) -> list[bf.SpringDamper]:
    """Return ten springs and dampers between two beams."""
    return [bf.SpringDamper(one.at(k / 12), two.at(k / 12), STIFF / 10, 0.01) for k in range(1, 11)]


def within(one: bf.Beam) -> tuple[bf.Point, bf.Point]:
    """Return nodes of an element, so that what couples them is within the band."""
    return one.at(5 / 12), one.at(6 / 12)


TORSION, BUSHING = (0.1, 1e-3), ((STIFF, STIFF, 0.1), (0.01, 0.01, 1e-3))

CASES = (
    Case("ten point forces", 10, lambda a, b: [bf.PointForce(a.at(k / 12), (0.0, -1e-3)) for k in range(1, 11)]),
    Case("drag along a beam", 25, lambda a, b: [Fluid(a, 0.1)]),
    Case("disc along a beam", 24, lambda a, b: [Disc(a, (0.6, -0.3), 0.1, 1e2)]),
    Case("magnet along a beam", 24, lambda a, b: [Magnet(a, 0.01)]),
    Case("rope", 1, lambda a, b: [Rope(a.end, b.end, ((1.2, 2.0), (1.2, 2.5)), 0.5 + 2 * hypot(0.2, 2))], alone=False),
    Case("rigid link", 1, lambda a, b: [OwnLink(a.end, b.end)], alone=False),
    Case("stop with friction", 1, lambda a, b: [OwnStop(a.end, -0.1, STIFF, 0.3)]),
    Case("bushing", 1, lambda a, b: [OwnBushing(a.end, b.end, (STIFF, 0.1), 0.01)], alone=False),
    Case("between two states, Python", 1, lambda a, b: [SpringBetweenStates(a.end, (1.0, 1.0), STIFF)]),
    Case("plastic section, Python", 24, lambda a, b: [], section=Hinging(2e3, 7e2, 0.07, 0.44, 1e-5, 0.0, 0.05, 0.01)),
    Case("ten springs to the ground", 10, springs),
    Case("ten springs across", 10, across, alone=False),
    Case("PointMass", 1, lambda a, b: [bf.PointMass(a.end, 0.05, 1e-5)]),
    Case("RigidBody", 1, lambda a, b: [bf.RigidBody(a.end, 0.05, 1e-5, (0.02, 0.01))]),
    Case("SpringDamper within the band", 1, lambda a, b: [bf.SpringDamper(*within(a), STIFF, 0.01)]),
    Case("TorsionSpring within the band", 1, lambda a, b: [bf.TorsionSpring(*within(a), *TORSION)]),
    Case("Bushing within the band", 1, lambda a, b: [bf.Bushing(*within(a), *BUSHING)]),
    Case("SpringDamper far away", 1, lambda a, b: [bf.SpringDamper(a.end, b.end, STIFF, 0.01)], alone=False),
    Case("TorsionSpring far away", 1, lambda a, b: [bf.TorsionSpring(a.end, b.end, *TORSION)], alone=False),
    Case("Bushing far away", 1, lambda a, b: [bf.Bushing(a.end, b.end, *BUSHING)], alone=False),
    Case("Link", 1, lambda a, b: [bf.Link(a.end, b.end)], alone=False),
    Case("Slider", 1, lambda a, b: [bf.Slider(a.end, b.end, (0.0, 1.0))], alone=False),
    Case("Gear", 1, lambda a, b: [bf.Gear(a.end, b.end, -2.0)], alone=False),
)


def model(case: Case, with_it: bool) -> bf.Model:
    """Return clamped beams under a force at the tip of the first, with the parts of a case or without."""
    rubber, shape = bf.Material(5e6, 0.3, 1100.0), bf.Rectangle(0.02, 0.02)
    own = {"section": case.section} if with_it and case.section else {"section": shape, "material": rubber}
    one, two = (bf.Beam(bf.Line((0, y), (1, y)), 12, bf.CRBF(2), **own) for y in (0.0, 0.5))
    beams = [one] if case.alone else [one, two]
    parts = list(case.parts(one, two)) if with_it else []
    loads = [bf.PointForce(beam.end, (0.0, -0.2 - k)) for k, beam in enumerate(beams)]
    loads += [part for part in parts if isinstance(part, bf.PointForce)]
    connectors = [part for part in parts if not isinstance(part, bf.PointForce)]
    return bf.Model(beams, [bf.Clamp(beam.start) for beam in beams], loads, connectors=connectors)


def tasks(own: bf.Model) -> tuple[list[Callable[[], object]], list[int]]:
    """Return solves of a model, of which the second does more iterations, in statics and in motion, and how many."""
    system = system_of(own, static=True)

    def iterated(most: int) -> int:
        return solve_equilibrium(system, system.reference, 1.0, Newton(iterations=most)).iterations

    def moved(steps: int) -> int:
        return bf.simulate(own, steps * STEP, STEP, save_every=steps).iterations

    calls = [lambda most=most: iterated(most) for most in ITERATIONS]
    calls += [lambda steps=steps: moved(steps) for steps in STEPS]
    counts = [call() for call in calls]
    return calls, [counts[1] - counts[0], counts[3] - counts[2]]


def main(rounds: int = 8, folder: Path = OUT, parts: tuple[str, ...] = ()) -> list[tuple[object, ...]]:
    """Measure parts, print the table and write it as CSV.

    Parameters
    ----------
    rounds : int
        Number of times each model is solved with its part and without.
    folder : Path
        Folder of the table.
    parts : tuple of str
        Names of the parts, by default all of them.
    """
    rows: list[tuple[object, ...]] = []
    for case in (each for each in CASES if not parts or each.name in parts):
        (plain, fewer), (own, more) = tasks(model(case, False)), tasks(model(case, True))
        times = [1e3 * each.least for each in in_turns((*plain, *own), rounds)]
        row: list[object] = [case.name, case.places]
        for first, without, with_it in zip((0, 2), fewer, more, strict=True):
            before = (times[first + 1] - times[first]) / without
            after = (times[first + 5] - times[first + 4]) / with_it
            row += [round(before, 2), round(after, 2), round((after - before) / case.places, 2)]
        per_step = 1.0 / (case.places * (STEPS[1] - STEPS[0]))
        rows.append((*row, round(per_step * (times[7] - times[6] - times[3] + times[2]), 2)))
    print(as_text(HEADER, rows, "what parts add to an iteration and to a step, CPU time"))
    write_csv(folder / "part_costs.csv", HEADER, rows)
    return rows


if __name__ == "__main__":
    main()
