"""Thousands of random models, from everyday to absurd, each judged: python tests/fuzz.py [first] [last].

Each ends in states that are in balance, in modes that are some, or in a named error, within a time limit; what does
not is listed with its seed. A seed always gives the same case.
"""

import faulthandler
import signal
import sys
import tempfile
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from pathlib import Path
from types import FrameType

from absurd_models import ANALYSES, draw
from conftest import ELEMENTS
from fuzz_judged import Outcome, judge
from threadpoolctl import threadpool_limits

import beamfem as bf
from beamfem.element.element import Element

CPU_SECONDS = 600.0  # a first compilation included; the slowest, seed 11681, takes 100 to 200 with 342 steps of a path
WALL_SECONDS = 1500.0  # where the interpreter itself hangs in compiled code
# kinds that have compiled code of their own that tests compile anyway
FEW = (
    *(bf.ANCF(), bf.ANCFCRBF(), bf.BilinearANCF(), bf.BilinearCRBF(), bf.ShearRigid(), bf.ShearRigid(False)),
    *(bf.ANCF(bf.Structural()), bf.ANCFCRBF(bf.ElasticLine()), *(bf.CRBF(order) for order in (1, 2, 3, 4))),
)


class TimeUp(BaseException):
    """No Exception, so that nothing between catches it."""


def judged(seed: int, elements: Sequence[Element] = ELEMENTS) -> Outcome:
    """Draw, run and judge the case of a seed."""
    try:
        case = draw(seed, elements)
    except bf.InputError as error:
        return Outcome(seed, "drawing", type(error).__name__, str(error))
    except Exception as error:
        return Outcome(seed, "drawing", "unnamed exception", f"{type(error).__name__}: {error}")
    try:
        found = judge(case)
    except Exception as error:
        found = Outcome(seed, case.analysis, "not judged", f"{type(error).__name__}: {error}")
    return Outcome(seed, found.analysis, found.verdict, f"{found.said} | {case.said}") if found.unexplained else found


def within_limits(seed: int, elements: Sequence[Element], folder: str) -> Outcome:
    """Judge a seed in a worker that ends itself where not even a signal gets through."""
    mark = Path(folder) / str(seed)

    def stop(number: int, frame: FrameType | None) -> None:
        raise TimeUp

    signal.signal(signal.SIGVTALRM, stop)
    with open(mark, "w") as trace:
        faulthandler.dump_traceback_later(WALL_SECONDS, exit=True, file=trace)
        signal.setitimer(signal.ITIMER_VIRTUAL, CPU_SECONDS)
        try:
            with threadpool_limits(1):
                return judged(seed, elements)
        except TimeUp:
            return Outcome(seed, "any", "hang", f"after {CPU_SECONDS:g} s")
        finally:
            signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
            faulthandler.cancel_dump_traceback_later()
            mark.unlink()


def run(seeds: Iterable[int], elements: Sequence[Element] = ELEMENTS, workers: int = 2) -> list[Outcome]:
    """Return what comes of all seeds, in their order, judged in other processes."""
    done: dict[int, Outcome] = {}
    left = list(seeds)
    with tempfile.TemporaryDirectory() as folder:
        while left:
            done |= _run(left, elements, workers, folder)
            left = [seed for seed in left if seed not in done]
            for seed in [int(mark.name) for mark in Path(folder).iterdir()]:
                mark = Path(folder) / str(seed)
                if mark.stat().st_size:
                    done[seed] = Outcome(seed, "any", "hang", mark.read_text().splitlines()[0])
                else:
                    alone = _run([seed], elements, 1, folder)
                    done |= alone or {seed: Outcome(seed, "any", "died", "the process ended")}
                mark.unlink(missing_ok=True)
            left = [seed for seed in left if seed not in done]
    return [done[seed] for seed in sorted(done)]


def _run(seeds: Sequence[int], elements: Sequence[Element], workers: int, folder: str) -> dict[int, Outcome]:
    """Return what comes of the seeds until a worker dies."""
    done = {}
    with ProcessPoolExecutor(workers, get_context("spawn")) as pool:
        try:
            for future in as_completed([pool.submit(within_limits, seed, elements, folder) for seed in seeds]):
                found = future.result()
                done[found.seed] = found
                if found.unexplained:
                    print(f"seed {found.seed}: {found.verdict}: {found.said}", flush=True)
        except BrokenProcessPool:
            pass
    return done


def summary(outcomes: Sequence[Outcome]) -> str:
    """Counts by analysis and outcome, and the seeds of what is unexplained."""
    verdicts = Counter(found.verdict for found in outcomes)
    kinds = [kind for kind in (*ANALYSES, "drawing", "any") if any(found.analysis == kind for found in outcomes)]
    table = defaultdict(int)
    for found in outcomes:
        table[found.verdict, found.analysis] += 1
    lines = [f"{len(outcomes)} random models", f"{'':<22}" + "".join(f"{kind:>10}" for kind in (*kinds, "all"))]
    for verdict, count in verdicts.most_common():
        counts = [table[verdict, kind] for kind in kinds]
        lines.append(f"{verdict:<22}" + "".join(f"{number:>10}" for number in (*counts, count)))
    lines += [f"seed {found.seed}: {found.verdict}: {found.said}" for found in outcomes if found.unexplained]
    return "\n".join(lines)


if __name__ == "__main__":
    first, last = (int(value) for value in (*sys.argv[1:], "0", "10000")[:2]) if len(sys.argv) > 2 else (0, 10_000)
    print(summary(run(range(first, last))))
