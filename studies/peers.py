"""beamfem against Exudyn: the same beams, steps and tolerances in one process, in turns, warm, one thread, CPU time.

Exudyn gets whatever serves it best: the faster of its solvers and the best number of load steps. Where it takes more
than one tangent a step it struggles to converge; such a row has no ratio, it would not measure the speed of elements.
The error at one instant passes through zero, so rows of equal accuracy take the cheapest run found of each.
Table of ratios (below 1 beamfem is faster) on the terminal and as out/bench/peers.csv; figures beside it.
"""

import importlib.util
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from threadpoolctl import threadpool_limits

import beamfem as bf
from beamfem.tabulate import as_text, write_csv

OUT = Path("out/bench")
HEADER = (
    "case",
    "elements",
    "beamfem",
    "ms",
    "median",
    "error",
    "peer",
    "peer ms",
    "peer median",
    "peer error",
    "ratio",
)
REISSNER_TIP = np.array([-1.197012381, -0.072589980])  # pendulum at 1 s, reference 10c
CANTILEVER = np.array([1.0 - 0.38764432832607, 0.71385896416489])  # P L^2 / E I = 5, L / h = 100
STRUCTURAL = bf.BilinearCRBF(forces=bf.Structural(), integration="reduced")

Row = tuple[object, ...]


def main() -> list[Row]:
    """Run all cases, print the table and write the files; say so where Exudyn is not installed."""
    if importlib.util.find_spec("exudyn") is None:
        print("Exudyn is not installed (pip install exudyn, or the extra bench): nothing to compare with")
        return []
    with threadpool_limits(1):
        rows = [*pendulums(), *cantilevers()]
        growing = growth()
    print(as_text(HEADER, rows, "the same task in beamfem and Exudyn; ms of CPU, least and median"))
    print(as_text(("elements", "ns an element and iteration"), growing, "growth, statics"))
    write_csv(OUT / "peers.csv", HEADER, rows)
    write_csv(OUT / "growth.csv", ("elements", "ns"), growing)
    if importlib.util.find_spec("matplotlib") is not None:
        draw(rows)
    return rows


def pendulums() -> list[Row]:
    """The pendulum of the paper with the section as printed: 1000 steps of 1 ms, and to 1e-5 at 1 s."""
    from exudyn_models import CABLE, THREE_NODES, TWO_NODES

    pairs = (
        (STRUCTURAL, TWO_NODES),
        (bf.CRBF(2), THREE_NODES),
        (bf.ANCF(), CABLE),
        (bf.ANCFCRBF(), CABLE),
    )
    rows = [
        _swing("same mesh and steps", element, count, kind, count, *_effort(count))
        for element, kind in pairs
        for count in (6, 12, 24, 100, 1000)
    ]
    rows.append(_swing("tip to 1e-5", bf.CRBF(4), 6, THREE_NODES, 16, 2000, 1.0, 3, 1000))
    return rows


def cantilevers() -> list[Row]:
    """The cantilever P L^2 / E I = 5: the same mesh, and the tip to 1e-6."""
    from exudyn_models import THREE_NODES, TWO_NODES, Peer

    modulus, side = 2e11, 0.01
    area, second = side**2, side**4 / 12.0
    rows = []
    cases = [("same mesh", STRUCTURAL, count, TWO_NODES, count) for count in (12, 100)]
    cases += [("same mesh", bf.CRBF(2), count, THREE_NODES, count) for count in (12, 100)]
    cases += [("tip to 1e-6", bf.CRBF(4), 4, THREE_NODES, 14)]
    for name, element, count, kind, peer_count in cases:
        beam = bf.Beam(
            bf.Line((0.0, 0.0), (1.0, 0.0)), count, element, bf.Rectangle(side, side), bf.Material(modulus, 0.3, 7800.0)
        )
        load = bf.PointForce(beam.end, (0.0, 5.0 * modulus * second))
        model = bf.Model([beam], [bf.Clamp(beam.start)], [load])
        stiffness = (modulus * area, 5.0 / 6.0 * modulus / 2.6 * area, modulus * second)
        mass = (7800.0 * area, 7800.0 * second)
        peer = Peer(kind, peer_count, 1.0, stiffness, mass, True, force=5.0 * modulus * second)
        found: list[bf.Solution] = []

        def own(model: bf.Model = model, found: list[bf.Solution] = found) -> None:
            found[:] = [bf.solve_static(model)]

        choices = [(load_steps, sparse) for load_steps in (1, 2, 3, 5, 10) for sparse in (False, True)]
        fastest = [(lambda chosen=chosen, peer=peer: peer.equilibrium(*chosen)) for chosen in choices]
        times = _in_turns([own, *fastest], 7)
        error = np.abs(found[0].position(beam.end)[-1] - CANTILEVER).max()
        other = np.abs(np.array(peer.tip_position()) - CANTILEVER).max()
        rows.append(_row(f"cantilever, {name}", count, element, times, error, f"{kind}, {peer_count}", other))
    return rows


def growth() -> list[tuple[int, float]]:
    """Time of a Newton iteration for an element of one chain."""
    rows = []
    for count in (100, 1000, 10_000, 100_000):
        beam = bf.Beam(
            bf.Line((0.0, 0.0), (1.0, 0.0)), count, bf.CRBF(2), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0)
        )
        force = bf.PointForce(beam.end, (0.0, 5.0 * 2e11 * 0.01**4 / 12.0))
        model = bf.Model([beam], [bf.Clamp(beam.start)], [force])
        bf.solve_static(model)
        begun = time.process_time()
        iterations = bf.solve_static(model).iterations
        rows.append((count, (time.process_time() - begun) / iterations / count * 1e9))
    return rows


def draw(rows: list[Row]) -> None:
    """Draw cost against elements and against error."""
    import matplotlib.pyplot as plt

    figure, (cost, precision) = plt.subplots(1, 2, figsize=(11, 4.5), layout="constrained")
    motions = [row for row in rows if str(row[0]).startswith("pendulum")]
    for name, column in [(name, 2) for name in _names(motions, 2)] + [(name, 6) for name in _names(motions, 6)]:
        chosen = [row for row in motions if row[column] == name and row[0] == motions[0][0]]
        style = "o-" if column == 2 else "s--"
        cost.loglog([row[1] for row in chosen], [row[column + 1] for row in chosen], style, label=name)
        judged = [row for row in motions if row[column] == name and row[1] != 1000 and not np.isnan(row[column + 3])]
        precision.loglog([row[column + 3] for row in judged], [row[column + 1] for row in judged], style, label=name)
    cost.set(xlabel="elements", ylabel="ms for 1000 steps")
    precision.set(xlabel="error of the tip at 1 s [m]", ylabel="ms")
    cost.legend(fontsize=7)
    figure.savefig(OUT / "peers.svg")
    plt.close(figure)


def _names(rows: list[Row], column: int) -> list[str]:
    return list(dict.fromkeys(str(row[column]) for row in rows))


def _effort(count: int) -> tuple[int, float, int]:
    """Steps, duration and repetitions; long models march 20 steps, reckoned as 1000."""
    return (1000, 1.0, 5) if count <= 24 else (1000, 1.0, 2) if count <= 100 else (20, 0.02, 2)


def _swing(
    name: str,
    element: bf.Element,
    count: int,
    kind: str,
    peer_count: int,
    steps: int,
    duration: float,
    repeat: int,
    peer_steps: int | None = None,
) -> Row:
    from exudyn_models import Peer

    modulus, density, area, second = 0.7e6, 5540.0, 1.6e-3, 8.533e-6
    section, material = bf.Section(area=area, second_moment=second), bf.Material(modulus, 0.3, density)
    beam = bf.Beam(bf.Line((0.0, 0.0), (1.2, 0.0)), count, element, section, material)
    model = bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0.0, -9.81))])
    stiffness = (modulus * area, 5.0 / 6.0 * modulus / 2.6 * area, modulus * second)
    peer = Peer(kind, peer_count, 1.2, stiffness, (density * area, density * second), False, gravity=9.81)
    found: list[bf.Solution] = []

    def own() -> None:
        rule = bf.GeneralizedAlpha(1.0)
        found[:] = [bf.simulate(model, duration=duration, step=duration / steps, integrator=rule)]

    solvers, theirs = (False, True) if peer_count <= 24 else (True,), peer_steps or steps
    others = [(lambda sparse=sparse: peer.motion(theirs, duration, sparse)) for sparse in solvers]
    times = _in_turns([own, *others], repeat)
    times = [[seconds / duration for seconds in each] for each in times]  # reckoned as 1 s of motion
    error = other = np.nan
    if duration == 1.0 and isinstance(element.forces, bf.Structural):
        error = np.abs(found[0].position(beam.end)[-1] - REISSNER_TIP).max()
        other = np.abs(np.array(peer.tip_position()) - REISSNER_TIP).max()
    label = kind if count == peer_count else f"{kind}, {peer_count}"
    return _row(f"pendulum, {name}", count, element, times, error, label, other, peer.tangents() / theirs)


def _in_turns(tasks: list[Callable[[], None]], repeat: int) -> list[list[float]]:
    """CPU seconds of each task, one after the other in every round; the first round is not counted."""
    times: list[list[float]] = [[] for _ in tasks]
    for turn in range(repeat + 1):
        for task, own in zip(tasks, times, strict=True):
            begun = time.process_time()
            task()
            if turn:
                own.append(time.process_time() - begun)
    return times


def _row(
    case: str,
    count: int,
    element: bf.Element,
    times: list[list[float]],
    error: float,
    peer: str,
    other: float,
    tangents: float = np.nan,
) -> Row:
    own, fastest = times[0], min(times[1:], key=min)
    least, peer_least = 1e3 * min(own), 1e3 * min(fastest)
    own_median, peer_median = 1e3 * float(np.median(own)), 1e3 * float(np.median(fastest))
    name = f"{element.name}, {element.forces.name}"
    ratio = np.nan if tangents > 1.0 else round(least / peer_least, 3)
    return case, count, name, least, own_median, error, peer, peer_least, peer_median, other, tangents, ratio


if __name__ == "__main__":
    main()
