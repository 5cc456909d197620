"""Stages of a time step of a long chain, whose two halves are processed by two threads.

Each half has separate coordinates, groups and workspace, so the results do not depend on which thread processed it.
"""

from beamfem.kernels import record as r
from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.pointers import caller, reals, small_code, wholes
from beamfem.kernels.signals import acquired, pause, release, replaced

FREE, POSTED, TAKEN, DONE, CLOSED = range(5)  # states of a job
_SPINS = 400  # some microseconds; a thread that waits longer yields the core to other threads

_stage, _yield = caller("iiii", "d"), caller("", "i")


@inlined
def _wait(j, turns):
    """Pause briefly, or yield the core after many turns of a spin loop."""
    if turns < _SPINS:
        pause()
    elif j[r.JOB_YIELD] != 0:
        _yield(j[r.JOB_YIELD])


@routine("i")
def serve(job):
    """Run the second half of every stage that is posted, until the job is closed."""
    small_code()
    j, turns = wholes(job), 0
    state = acquired(j, r.JOB_STATE)
    while state != CLOSED:
        if state == POSTED and replaced(j, r.JOB_STATE, POSTED, TAKEN):
            result = _stage(j[r.JOB_STAGE], 1, j[r.JOB_SYSTEM], j[r.JOB_SOLVER], j[r.JOB_CALLS])
            reals(job)[r.JOB_RESULT] = result
            release(j, r.JOB_STATE, DONE)
            turns = 0
        else:
            _wait(j, turns)
            turns += 1
        state = acquired(j, r.JOB_STATE)


@routine("iiii", "d")
def in_two(stage, system, solver, calls):
    """Run a stage for both halves, in parallel if a second thread serves, and then for the part between them.

    Return the largest result, NaN if one is NaN. If the second thread has not started its half by the time this one has
    finished the first half, this one takes it too.
    """
    small_code()
    job = wholes(calls)[r.JOB]
    j = wholes(job)
    if j[r.JOB_SERVED] == 0:
        first = _stage(stage, 0, system, solver, calls)
        second = _stage(stage, 1, system, solver, calls)
    else:
        j[r.JOB_STAGE], j[r.JOB_SYSTEM], j[r.JOB_SOLVER], j[r.JOB_CALLS] = stage, system, solver, calls
        release(j, r.JOB_STATE, POSTED)
        first = _stage(stage, 0, system, solver, calls)
        if replaced(j, r.JOB_STATE, POSTED, FREE):
            second = _stage(stage, 1, system, solver, calls)
        else:
            turns = 0
            while acquired(j, r.JOB_STATE) != DONE:
                _wait(j, turns)
                turns += 1
            second = reals(job)[r.JOB_RESULT]
            release(j, r.JOB_STATE, FREE)
    between = _stage(stage, 2, system, solver, calls)
    if not second <= first and first == first:
        first = second
    if not between <= first and first == first:
        first = between
    return first
