"""Work and precision of integrators, Exudyn's beside them: error of the steps against CPU time, with one mesh each.

The paper's pendulum over 0.5 s, as printed and thin, with 12 elements of order 2; a free beam that is thrown, 16 over
6 s; a strip of spring steel bent by a tip force of 3 E I / L^2 and let go, 8 over 1 s. A run is judged by the largest
error of the tip over ten instants, against the same mesh with far smaller steps. Exudyn has as many elements with three
nodes, its fastest linear solver, and is judged by its own limit: its explicit methods have one of their own, which is
farther from the solution. `VelocityVerlet` is not finished, as it says itself.
"""

import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import redirect_stdout
from dataclasses import dataclass, field, replace
from functools import partial
from importlib.util import find_spec
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

import beamfem as bf
from beamfem.view.plots import COLOURS, MARKERS, empty_figure, quiet, save_figure
from studies.benchmarks.peer_cases import PENDULUM, SPARSE, THREE_NODES, Chain, pendulum
from studies.benchmarks.peer_clock import once

if TYPE_CHECKING:
    from studies.benchmarks.exudyn_models import Peer

OUT = Path("out/bench")
ERRORS = (1e-5, 1e-6, 3e-7, 1e-7, 1e-8, 1e-9)
IMPLICIT = ("TrapezoidalIndex2", "GeneralizedAlpha")
_INSTANTS = 10

Method = bf.Integrator | bf.Scheme
Steps = Mapping[Method, Sequence[int]]


@dataclass(frozen=True)
class Case:
    """A motion and the steps that each integrator takes through it.

    exact: integrator and steps of the reference; peer: the same in Exudyn; peer_steps: by its methods; the last one of
    the first, and of the last if that is explicit, has steps for a reference.
    """

    name: str
    model: bf.Model
    start: bf.Solution | None
    duration: float
    steps: Steps
    exact: tuple[Method, int]
    peer: Callable[[], "Peer"] | None = None
    peer_steps: Mapping[str, Sequence[int]] = field(default_factory=dict)

    def run(self, integrator: Method, steps: int) -> bf.Solution:
        every, step = steps // _INSTANTS, self.duration / steps
        return bf.simulate(self.model, self.duration, step, integrator, self.start, save_every=every)

    def tip(self, integrator: Method, steps: int) -> np.ndarray:
        return self.run(integrator, steps).position(self.model.beams[0].end)

    def measured(self) -> dict[str, np.ndarray]:
        """Return errors [m] and CPU times [ms] (runs, 2) of each integrator."""
        exact = self.tip(*self.exact)
        return {
            repr(integrator): np.array(
                [
                    (np.abs(self.tip(integrator, count) - exact).max(), once(partial(self.run, integrator, count)))
                    for count in counts
                ]
            )
            for integrator, counts in self.steps.items()
        }

    def measured_peer(self) -> dict[str, np.ndarray]:
        """Return the same of Exudyn's methods, nothing where it is not installed."""
        if self.peer is None or find_spec("exudyn") is None:
            return {}
        peer, result, exact = self.peer(), dict[str, np.ndarray](), dict[bool, np.ndarray]()
        for method, counts in self.peer_steps.items():
            implicit, runs = method in IMPLICIT, []
            for count in sorted(counts, reverse=True):
                task = partial(peer.motion, count, self.duration, SPARSE, 1, method)
                with redirect_stdout(StringIO()):  # warnings of unfinished methods
                    task()
                    tip = peer.positions()
                    if implicit not in exact:  # far smaller steps than the next
                        exact[implicit] = tip
                        continue
                    runs.append((np.abs(tip - exact[implicit]).max(), once(task)))
            result[f"Exudyn {method}"] = np.array(runs[::-1])
        return result


def soft() -> Case:
    """Return the pendulum as printed."""
    steps: Steps = {
        bf.GeneralizedAlpha(): (100, 200, 400, 800, 1600, 3200, 6400, 12800, 25600, 51200, 102400),
        bf.Gauss(2): (20, 40, 80, 160, 320, 640, 1280),
        bf.Gauss(3): (20, 40, 60, 80, 120, 160, 240, 320, 480),
        bf.Gauss(4): (20, 30, 40, 60, 80, 100, 120, 160, 240),
        bf.Gauss(5): (20, 30, 40, 60, 80, 100, 120, 160),
        bf.Radau(3): (20, 40, 60, 80, 120, 160, 240, 320, 640),
        bf.Bathe(): (100, 400, 1600, 6400, 25600),
        bf.CentralDifferences(): (400, 1600, 6400, 25600),
        bf.DormandPrince(): (120, 160, 240, 480),
    }
    peer_steps = {
        "TrapezoidalIndex2": (100, 200, 400, 800, 1600, 3200, 6400, 51200),
        "GeneralizedAlpha": (100, 200, 400, 800, 1600, 3200, 6400),
        "ExplicitMidpoint": (600, 1000, 2000, 4000, 32000),
        "RK44": (400, 800, 1600, 3200),
        "RK67": (300, 600, 1200, 2400),
        "VelocityVerlet": (400, 500, 700, 1000, 2000, 4000),
    }
    case = Case("printed pendulum", pendulum(bf.CRBF(2), 12), None, 0.5, steps, (bf.Gauss(4), 1000))
    return replace(case, peer=lambda: _chain(12, PENDULUM, 0.05), peer_steps=peer_steps)


def thin() -> Case:
    """Return the thin pendulum, 8 mm deep."""
    section = bf.Section(1.6e-3, 8.533e-9)
    beam = bf.Beam(bf.Line((0.0, 0.0), (1.2, 0.0)), 12, bf.CRBF(2), section, bf.Material(0.7e6, 0.3, 5540.0))
    model = bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0.0, -9.81))])
    steps: Steps = {
        bf.GeneralizedAlpha(): (200, 800, 3200, 12800, 51200),
        bf.Gauss(3): (40, 80, 160, 320, 640, 1280, 2560),
        bf.Gauss(5): (40, 80, 160, 320, 640, 1280),
        bf.Radau(3): (40, 80, 160, 320, 640, 1280, 2560),
    }
    own = replace(PENDULUM, bending=0.7e6 * 8.533e-9, rotary=5540.0 * 8.533e-9)
    peer_steps = {"TrapezoidalIndex2": (200, 800, 3200, 12800, 102400), "GeneralizedAlpha": (200, 800, 3200, 12800)}
    case = Case("thin pendulum", model, None, 0.5, steps, (bf.Gauss(5), 10000))
    return replace(case, peer=lambda: _chain(12, own, 0.05), peer_steps=peer_steps)


def flying() -> Case:
    """Return the flying beam of Simo and Vu-Quoc."""
    ends, pulse = ((6.0, 0.0), (0.0, 8.0)), ((0.0, 0.0), (2.5, 1.0), (5.0, 0.0), (100.0, 0.0))
    section = bf.Section.from_stiffness(axial=1e4, shear=1e4, bending=100.0, mass=1.0, rotary_inertia=10.0)
    beam = bf.Beam(bf.Line(*ends), 16, bf.CRBF(2), section)
    amplitude = bf.Interpolated(pulse)
    force = bf.PointForce(beam.start, (8.0, 0.0), amplitude=amplitude)
    loads = [force, bf.PointMoment(beam.start, -80.0, amplitude=amplitude)]
    steps: Steps = {
        bf.GeneralizedAlpha(): (240, 960, 3840, 15360, 61440),
        bf.Gauss(3): (120, 240, 480, 960, 1920, 3840),
        bf.Radau(3): (120, 240, 480, 960, 1920, 3840),
    }
    own = Chain(10.0, 1e4, 1e4, 100.0, 1.0, 10.0, False)
    times, values = np.array(pulse).T

    def peer() -> "Peer":
        from studies.benchmarks.exudyn_models import thrown

        return thrown(16, own, ends, lambda time: float(np.interp(time, times, values)), 0.6)

    peer_steps = {"TrapezoidalIndex2": (960, 3840, 15360, 61440), "GeneralizedAlpha": (960, 3840, 15360)}
    return Case("flying beam", bf.Model([beam], loads=loads), None, 6.0, steps, (bf.Radau(5), 7680), peer, peer_steps)


def stiff() -> Case:
    """Return the strip."""
    section, steel = bf.Rectangle(0.02, 0.002), bf.Material(2.1e11, 0.3, 7850.0)
    strip = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(2), section, steel)
    rigidity, force = section.rigidity(steel), 3.0 * 2.1e11 * section.second_moment
    loaded = bf.Model([strip], [bf.Clamp(strip.start)], [bf.PointForce(strip.end, (0, force))])
    steps: Steps = {
        bf.GeneralizedAlpha(): (2000, 8000, 32000, 64000, 128000, 256000, 512000),
        bf.Radau(3): (1500, 3000, 6000, 12000, 16000, 24000),
        bf.Radau(4): (1000, 1500, 3000, 4000, 6000, 8000, 12000),
    }
    own = Chain(
        1.0,
        rigidity.axial,
        rigidity.shear,
        rigidity.bending,
        7850.0 * section.area,
        7850.0 * section.second_moment,
        True,
        force=force,
    )
    peer_steps = {"TrapezoidalIndex2": (8000, 32000, 128000, 512000), "GeneralizedAlpha": (8000, 32000, 128000)}
    bent, model = bf.solve_static(loaded), bf.Model([strip], [bf.Clamp(strip.start)])
    case = Case("steel strip", model, bent, 1.0, steps, (bf.Radau(5), 50000))
    return replace(case, peer=lambda: _chain(8, own, 0.1, released=True), peer_steps=peer_steps)


def _chain(elements: int, beam: Chain, instants: float, released: bool = False) -> "Peer":
    from studies.benchmarks.exudyn_models import chain

    return chain(THREE_NODES, elements, beam, instants, released)


def cost(runs: np.ndarray, error: float) -> float:
    """Return the CPU time [ms] for an error [m] by interpolation of logarithms between runs; nan where none has it."""
    errors, times = np.log(runs).T
    errors = np.minimum.accumulate(errors)
    if not errors[-1] <= np.log(error):
        return float("nan")
    return float(np.exp(np.interp(-np.log(error), -errors, times)))


def draw(found: dict[str, dict[str, np.ndarray]], path: Path) -> None:
    """Draw the errors of all runs against their CPU times, a case beside the other."""
    figure = empty_figure(4.2 * len(found), 4.6)
    axes = figure.subplots(1, len(found), sharey=True)
    names = list(dict.fromkeys(name for each in found.values() for name in each))
    for own, (case, integrators) in zip(axes, found.items(), strict=True):
        quiet(own)
        for name, runs in integrators.items():
            number = names.index(name)
            own.plot(
                runs[:, 1],
                runs[:, 0],
                f"{MARKERS[number % len(MARKERS)]}{'--' if name.startswith('Exudyn') else '-'}",
                color=COLOURS[number % len(COLOURS)],
                markersize=4,
                label=name,
            )
        own.set(xscale="log", yscale="log", xlabel="CPU time [ms], one thread")
        own.set_title(case, fontsize=10)
        own.legend(frameon=False, fontsize=7)
    axes[0].set_ylabel("largest error of the tip at ten instants [m]")
    save_figure(figure, path)


def main() -> None:
    """Print what an error costs in all cases, and draw all runs."""
    warnings.simplefilter("ignore", bf.LargeStrainWarning)  # of the paper's pendulum
    found = {}
    for case in (soft(), thin(), flying(), stiff()):
        own, others = case.measured(), case.measured_peer()
        found[case.name] = own | others
        print(f"{case.name}: CPU ms for errors of the tip of {', '.join(f'{e:g}' for e in ERRORS)} m; in brackets:")
        print("how many times cheaper than the first; of Exudyn, how many times dearer than the cheapest of beamfem")
        first, *_ = costs = {name: np.array([cost(runs, e) for e in ERRORS]) for name, runs in found[case.name].items()}
        cheapest = np.fmin.reduce([costs[name] for name in own])
        for name, each in costs.items():
            times = each / cheapest if name in others else costs[first] / each
            print(f"{name:28s}", *(f"{c:8.2f} ({t:4.1f})" for c, t in zip(each, times, strict=True)), flush=True)
    draw(found, OUT / "integrators.svg")


if __name__ == "__main__":
    main()
