"""beamfem against Exudyn: the same beams, steps and tolerances, in turns in one warm process; CPU time of one thread.

Exudyn gets whatever serves it best: the fastest of its linear solvers and the best number of load steps. Where it takes
more than one tangent a step it struggles to converge; such a row has no ratio, it would not measure the speed of
elements. Rows of equal accuracy take the cheapest run found of each code. Ratios below 1: beamfem is faster.
Tables on the terminal and as CSV in out/bench, figures of cost and of work and precision beside them.
"""

import time
from pathlib import Path

from threadpoolctl import threadpool_limits

from beamfem.tables import as_text, write_csv

OUT = Path("out/bench")


def main(folder: Path = OUT) -> int:
    """Run all cases and return the number of rows written, 0 without Exudyn.

    Parameters
    ----------
    folder : Path
        Folder of the tables and figures.
    """
    try:
        import exudyn  # noqa: F401
    except ImportError:
        print("Exudyn cannot be imported here (pip install exudyn, or the extra bench): nothing to compare with")
        return 0
    from studies.benchmarks.peer_figures import draw_cost, draw_precision
    from studies.benchmarks.peer_mechanisms import mechanisms
    from studies.benchmarks.peer_precision import equal_accuracy, motion_runs, static_runs
    from studies.benchmarks.peer_ratios import HEADER, THREADS_HEADER, as_tuples, default_threads, same_mesh

    begun = time.perf_counter()
    with threadpool_limits(1):
        rows = same_mesh()
        draw_cost(rows, folder / "cost.svg")
        rows += mechanisms()
        statics, motions = static_runs(), motion_runs()
        rows += [
            equal_accuracy("cantilever, tip to 1e-6", statics, 1e-6, 0.1),
            equal_accuracy("pendulum, tip at 1 s to 1e-5", motions, 1e-5, 0.1, at_end=True),
            equal_accuracy("pendulum, tip to 1e-4 at all instants", motions, 1e-4, 0.1),
            equal_accuracy("pendulum, tip to 1e-5 at all instants", motions, 1e-5, 0.05),
            equal_accuracy("pendulum, tip to 1e-6 at all instants", motions, 1e-6, 0.033),
        ]
    draw_precision(
        statics, "Cantilever, P L²/EI = 5, L/h = 100", "error of the tip [m], L = 1 m", folder / "statics.svg"
    )
    draw_precision(
        motions,
        "Pendulum over 1 s, printed section",
        "largest error of the tip at 0.1, ..., 1 s [m]",
        folder / "motion.svg",
    )
    threads = default_threads()
    print(as_text(HEADER, as_tuples(rows), "beamfem and Exudyn: ms of CPU time, one thread, least and median"))
    print(as_text(THREADS_HEADER, threads, "default threads: ms on the wall, least"))
    write_csv(folder / "peers.csv", HEADER, as_tuples(rows))
    write_csv(folder / "peers_threads.csv", THREADS_HEADER, threads)
    sweep = [
        (run.name, run.elements, run.steps, run.milliseconds, run.error, run.last_error) for run in statics + motions
    ]
    write_csv(folder / "precision.csv", ("code", "elements", "steps", "ms", "error [m]", "error at the end [m]"), sweep)
    print(f"figures {folder}/cost.svg, statics.svg, motion.svg; {time.perf_counter() - begun:.0f} s")
    return len(rows) + len(threads)


if __name__ == "__main__":
    main()
