"""A second thread for the motion of a long chain, which waits in compiled code during a call of `kernels.march`."""

import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from ctypes import CDLL, c_void_p, cast
from functools import cache
from threading import Thread

import numpy as np

from beamfem.assembly.arena import Arena
from beamfem.assembly.system import System
from beamfem.kernels import record
from beamfem.kernels.pointers import address_of
from beamfem.kernels.two_threads import CLOSED, serve
from beamfem.solve.newton import cut_chain


@contextmanager
def routines(system: System, in_two: bool) -> Iterator[np.ndarray]:
    """Provide the addresses of the routines that `kernels.march` calls; in_two: for a chain in two halves.

    A second thread then processes the second halves, if two cores may be used and no section law calls Python. It ends
    before the context does.
    """
    calls = system.solver_table.routines(moving=True, in_two=in_two)
    if not in_two:
        yield calls
        return
    job = Arena({"job": (record.JOB_FIELDS,)}, np.int64).arrays["job"]
    job[record.JOB_YIELD] = _address_of_yield()
    calls = calls.copy()
    calls[record.JOB] = address_of(job)
    thread = Thread(target=serve, args=(job,), name="second half", daemon=True)
    try:
        if cut_chain.usable_cores() > 1 and all(block.law is None for block in system.blocks):
            with suppress(RuntimeError):  # the system may have no thread left
                thread.start()
                job[record.JOB_SERVED] = 1
        yield calls
    finally:
        job[record.JOB_STATE] = CLOSED
        if thread.is_alive():
            thread.join()


@cache
def _address_of_yield() -> int:
    """Return the address of the system's function that yields the core to other threads, 0 if there is none."""
    function = CDLL("kernel32").SwitchToThread if os.name == "nt" else getattr(CDLL(None), "sched_yield", None)
    return (cast(function, c_void_p).value if function else 0) or 0
