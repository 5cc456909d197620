"""Stages of work on a long chain, its halves on two threads.

Each half has coordinates, groups and work space of its own, so that results do not tell which thread worked on it.
"""

from beamfem.kernels import record as r
from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.pointers import caller, reals, small_code, wholes
from beamfem.kernels.signals import acquired, pause, release, replaced

FREE, POSTED, TAKEN, DONE, CLOSED = range(5)  # states of a job
_SPINS = 400  # some microseconds; whoever waits longer lets others have the core

_stage, _yield = caller("iiii", "d"), caller("", "i")


@inlined
def _wait(j, turns):
    """Wait a little, and longer after many turns."""
    if turns < _SPINS:
        pause()
    elif j[r.JOB_YIELD] != 0:
        _yield(j[r.JOB_YIELD])


@routine("i")
def serve(job):
    """Do the second half of every stage that is posted, until the job is closed."""
    small_code()
    j, turns = wholes(job), 0
    state = acquired(j, r.JOB_STATE)
    while state != CLOSED:
        if state == POSTED and replaced(j, r.JOB_STATE, POSTED, TAKEN):
            found = _stage(j[r.JOB_STAGE], 1, j[r.JOB_SYSTEM], j[r.JOB_SOLVER], j[r.JOB_CALLS])
            reals(job)[r.JOB_RESULT] = found
            release(j, r.JOB_STATE, DONE)
            turns = 0
        else:
            _wait(j, turns)
            turns += 1
        state = acquired(j, r.JOB_STATE)


@routine("iiii", "d")
def in_two(stage, system, solver, calls):
    """Do a stage for both halves, at once where a thread serves, then for what is between; return the largest result.

    What is no number is the largest. A second half that the other thread has not begun in time is done here.
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
