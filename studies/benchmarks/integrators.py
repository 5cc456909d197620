"""Work and precision of the integrators of the package: error of the steps against CPU time, with one mesh each.

The paper's pendulum as printed over 0.5 s, 12 elements of order 2, and a strip of spring steel bent by a tip force of
3 E I / L^2 and let go, 8 elements of order 2 over 1 s. A run is judged by the largest error of the tip over ten
instants, against the same mesh with far smaller steps of `Gauss(4)` or `Radau(5)`.
"""

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

import beamfem as bf
from beamfem.view.plots import COLOURS, MARKERS, empty_figure, quiet, save_figure
from studies.benchmarks.peer_cases import pendulum
from studies.benchmarks.peer_clock import once

OUT = Path("out/bench")
ERRORS = (1e-5, 1e-6, 3e-7, 1e-7, 1e-8, 1e-9)
_INSTANTS = 10


@dataclass(frozen=True)
class Case:
    """A motion and the steps that each integrator takes through it; exact: integrator and steps of the reference."""

    name: str
    model: bf.Model
    start: bf.Solution | None
    duration: float
    steps: Mapping[bf.Integrator | bf.Scheme, Sequence[int]]
    exact: tuple[bf.Integrator | bf.Scheme, int]

    def run(self, integrator: bf.Integrator | bf.Scheme, steps: int) -> bf.Solution:
        every, step = steps // _INSTANTS, self.duration / steps
        return bf.simulate(self.model, self.duration, step, integrator, self.start, save_every=every)

    def tip(self, integrator: bf.Integrator | bf.Scheme, steps: int) -> np.ndarray:
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


def soft() -> Case:
    """Return the pendulum."""
    steps: dict[bf.Integrator | bf.Scheme, Sequence[int]] = {
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
    return Case("printed pendulum", pendulum(bf.CRBF(2), 12), None, 0.5, steps, (bf.Gauss(4), 1000))


def stiff() -> Case:
    """Return the strip."""
    section, steel = bf.Rectangle(0.02, 0.002), bf.Material(2.1e11, 0.3, 7850.0)
    strip = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(2), section, steel)
    force = bf.PointForce(strip.end, (0, 3 * 2.1e11 * 0.02 * 0.002**3 / 12))
    bent = bf.solve_static(bf.Model([strip], [bf.Clamp(strip.start)], [force]))
    steps: dict[bf.Integrator | bf.Scheme, Sequence[int]] = {
        bf.GeneralizedAlpha(): (2000, 8000, 32000, 64000, 128000, 256000, 512000),
        bf.Radau(3): (1500, 3000, 6000, 12000, 16000, 24000),
        bf.Radau(4): (1000, 1500, 3000, 4000, 6000, 8000, 12000),
    }
    return Case("steel strip", bf.Model([strip], [bf.Clamp(strip.start)]), bent, 1.0, steps, (bf.Radau(5), 50000))


def cost(runs: np.ndarray, error: float) -> float:
    """Return the CPU time [ms] for an error [m] by interpolation of logarithms between runs; nan where none has it."""
    errors, times = np.log(runs).T
    errors = np.minimum.accumulate(errors)
    if not errors[-1] <= np.log(error) <= errors[0]:
        return float("nan")
    return float(np.exp(np.interp(-np.log(error), -errors, times)))


def draw(found: dict[str, dict[str, np.ndarray]], path: Path) -> None:
    """Draw the errors of all runs against their CPU times, a case beside the other."""
    figure = empty_figure(8.4, 4.6)
    axes = figure.subplots(1, len(found), sharey=True)
    names = list(dict.fromkeys(name for each in found.values() for name in each))
    for own, (case, integrators) in zip(axes, found.items(), strict=True):
        quiet(own)
        for name, runs in integrators.items():
            number = names.index(name)
            own.plot(
                runs[:, 1],
                runs[:, 0],
                f"{MARKERS[number]}-",
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
    """Print what an error costs, and how many times less than with generalized-alpha, and draw all runs."""
    warnings.simplefilter("ignore", bf.LargeStrainWarning)  # of the paper's pendulum
    found = {case.name: case.measured() for case in (soft(), stiff())}
    for case, integrators in found.items():
        print(f"{case}: CPU ms, and times cheaper than the first, for errors of the tip [m]")
        first = next(iter(integrators.values()))
        for name, runs in integrators.items():
            cells = [f"{cost(runs, e):8.2f} ({cost(first, e) / cost(runs, e):4.1f})" for e in ERRORS]
            print(f"{name:28s}", *cells)
    draw(found, OUT / "integrators.svg")


if __name__ == "__main__":
    main()
