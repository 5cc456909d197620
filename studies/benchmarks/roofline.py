"""Roofline of the kernels: operations and bytes per coordinate against measured ceilings of one core.

Operations are counted (`flop_counts`), bytes are the least that must move (`roofline_cases.least_traffic`), times are
of warm kernels. 1000 elements stay in cache, 100,000 do not. The limit named is the ceiling of which a kernel reaches
half or more: that of memory (or cache), or of arithmetic without vectors. Where it is none, operations wait for each
other: chains, divisions, sines.
"""

from pathlib import Path

import numpy as np

from beamfem.kernels.bidirectional_lu import SHORT, bidirectional_lu
from beamfem.kernels.model_passes import balance
from beamfem.tables import as_text, write_csv
from studies.benchmarks.ceilings import Ceilings, least_seconds, measure
from studies.benchmarks.flop_counts import count_all
from studies.benchmarks.roofline_cases import (
    FACTOR,
    FORMS,
    KERNELS,
    RESIDUAL,
    SOLVE,
    TANGENT,
    case,
    least_traffic,
    place,
)

OUT = Path("out/bench")
SIZES = (1000, 100_000)
HEADER = (
    "form",
    "elements",
    "kernel",
    "us",
    "ns a coordinate",
    "operations",
    "of which slow",
    "bytes",
    "GFlop/s",
    "of vector peak [%]",
    "of scalar peak [%]",
    "GB/s",
    "of bandwidth [%]",
    "limit",
)


def seconds(form: str, elements: int) -> dict[str, float]:
    """Return the CPU time of one call of each kernel [s]."""
    one = case(form, elements)[1]
    times = max(1, 100_000 // elements)
    half, n = one.half_width, len(one.right)
    own = bidirectional_lu(half, n < SHORT)
    copy, right, space = np.empty_like(one.band), np.empty_like(one.right), np.empty_like(one.right)

    def balanced() -> None:
        for _ in range(times):
            balance(one.equations.record.address)

    def copied() -> None:
        for _ in range(times):
            np.copyto(copy, one.band)

    def factored() -> None:
        for _ in range(times):
            np.copyto(copy, one.band)
            own.factor(n, half, one.reach, copy, space)

    def solved() -> None:
        for _ in range(times):
            np.copyto(right, one.right)
            own.solve(n, half, copy, right)

    found = {TANGENT: least_seconds(balanced), FACTOR: least_seconds(factored) - least_seconds(copied)}
    found[SOLVE] = least_seconds(solved)
    place(one, tangent=False)
    found[RESIDUAL] = least_seconds(balanced)
    return {name: found[name] / times for name in KERNELS}


def rows_of(
    form: str, elements: int, counts: dict[str, tuple[float, float]], top: Ceilings
) -> list[tuple[object, ...]]:
    """Return a line for each kernel."""
    system, one = case(form, elements)
    times, traffic = seconds(form, elements), least_traffic(system, one)
    unknown = len(one.right)
    bandwidth = top.cache if traffic[TANGENT] < 1e7 else top.memory
    rows = []
    for name in KERNELS:
        spent, (operations, slow) = times[name], counts[name]
        flops, rate = operations * elements / spent / 1e9, traffic[name] / spent / 1e9
        shares = {"compute": flops / top.scalar, "memory": rate / bandwidth}
        limit = max(shares, key=lambda key: shares[key])
        per = elements / unknown
        work = operations * per, slow * per, traffic[name] / unknown
        rates = flops, 100.0 * flops / top.peak, 100.0 * shares["compute"], rate, 100.0 * shares["memory"]
        each = 1e6 * spent, 1e9 * spent / unknown
        rows.append((form, elements, name, *each, *work, *rates, limit if shares[limit] >= 0.5 else "latency"))
    return rows


def main(sizes: tuple[int, ...] = SIZES, folder: Path = OUT) -> list[tuple[object, ...]]:
    """Measure all sizes, print the table and write it as CSV.

    Parameters
    ----------
    sizes : tuple of int
        Numbers of elements.
    folder : Path
        Folder of the table.
    """
    top, counts = measure(), count_all()
    print(f"one core: {top.memory:.1f} GB/s from memory, {top.cache:.0f} GB/s in cache (stream triad)")
    print(
        f"fused multiply-adds: {top.peak:.1f} GFlop/s in vectors, {top.scalar:.1f} without, {top.chain:.2f} in a chain"
    )
    rows = [row for form in FORMS for elements in sizes for row in rows_of(form, elements, counts[form], top)]
    print(as_text(HEADER, rows, "kernels in motion; operations, slow ones among them, and bytes a coordinate"))
    write_csv(folder / "roofline.csv", HEADER, rows)
    return rows


if __name__ == "__main__":
    main()
