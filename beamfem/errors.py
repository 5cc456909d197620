"""Exceptions and warnings. Each message names the problem, its place and a remedy."""

import sys
import warnings
from types import FrameType, TracebackType
from typing import Any


class BeamfemError(Exception):
    """Any error that beamfem raises on purpose.

    Parameters
    ----------
    reason : str
        What is wrong.
    remedy : str, optional
        What would be right, in the names of the Python interface; other front ends replace these names.
    """

    def __init__(self, reason: str = "", *, remedy: str = "") -> None:
        joint = ". " if remedy[:1].isupper() else "; "
        super().__init__(f"{reason}{joint}{remedy}" if remedy else reason)
        self.reason, self.remedy = reason, remedy

    def _render_traceback_(self) -> list[str]:
        """Return the lines that a notebook shows."""
        import traceback

        _shorten(self)
        return traceback.format_exception(self)


class InputError(BeamfemError, ValueError):
    """A value that cannot describe a beam: wrong shape, not finite, negative where it must be positive."""


class UnknownPointError(InputError):
    """A support or load at a point of a beam that is not in the model."""


class FreeMotionError(InputError):
    """A static model that can move without resistance."""


class ConvergenceError(BeamfemError, RuntimeError):
    """A solve that could not be continued.

    Parameters
    ----------
    message : str
        What went wrong.
    solution : Solution, optional
        Every state found before.
    remedy : str, optional
        What would be right, see `BeamfemError`.
    """

    def __init__(self, message: str, solution: Any = None, *, remedy: str = "") -> None:
        super().__init__(message, remedy=remedy)
        self.solution = solution


class LimitPointError(ConvergenceError):
    """A static solve reached a limit point: beyond its load factor there is no equilibrium nearby.

    Parameters
    ----------
    message : str
        What went wrong.
    load_factor : float, [-]
        Load factor of the limit point.
    solution : Solution, optional
        The states before it.
    remedy : str, optional
        What would be right, see `BeamfemError`.
    """

    def __init__(self, message: str, load_factor: float, solution: Any = None, *, remedy: str = "") -> None:
        super().__init__(message, solution, remedy=remedy)
        self.load_factor = load_factor


class FileError(BeamfemError, OSError):
    """A file that the system refuses to read or write: disk full, no permission, no such folder."""


class MissingFileError(FileError, FileNotFoundError):
    """A file to be read does not exist."""


class MissingPackageError(BeamfemError, ImportError):
    """A task needs a package that is not installed; the message names the extra of beamfem that installs it."""


class UnstableWarning(UserWarning):
    """Some rows of a static solution are unstable equilibria, which the structure would leave."""


class ChangedCodeWarning(UserWarning):
    """Stored results of a sweep were computed before code that its function runs was changed."""


class NotStoredWarning(UserWarning):
    """The store of a sweep can no longer be written, so the next run computes further results anew."""


class RoundOffWarning(UserWarning):
    """Round-off leaves few digits of the forces of a solution or of a critical load, or shakes a motion."""


class LockingWarning(UserWarning):
    """Elements lock: displacements are likely wrong by 1 % or more."""


class CoarseMeshWarning(UserWarning):
    """The mesh is too coarse: displacements are likely off by 2 % or more."""


class UnitsWarning(UserWarning):
    """Values of materials, sections or loads are implausible in the units of the model."""


class LargeStrainWarning(UserWarning):
    """Strains beyond the range of a linear law, or a utilisation of the strength above 1."""


class CuspWarning(UserWarning):
    """The axis of a beam turns back on itself, in a state that is not the one that the loads lead to."""


class EnergyWarning(UserWarning):
    """The energy of a motion rises or falls by more than work and damping explain."""


class TimeStepWarning(UserWarning):
    """Steps change frequencies that carry the energy of a motion, or leave forces in its rows that are not its own."""


class LongRunWarning(UserWarning):
    """A long motion was interrupted, is complete in its file already, or has more rows than fit into memory."""


class NotJoinedWarning(UserWarning):
    """Lines of a mesh end close to others without being joined to them."""


class SeveralTurnsWarning(UserWarning):
    """An arc of more than one full turn, whose angles may have been given in degrees."""


class NotReadWarning(UserWarning):
    """Parts of a file of another program are not read, such as sections of a mesh file or amplitudes of a model."""


class NotWrittenWarning(UserWarning):
    """Parts of a model are left out of a file for another program."""


class UnknownStressWarning(UserWarning):
    """The shape of some sections is unknown, so their stress is nan or left out of a file."""


def warn(message: str, kind: type[Warning] = UserWarning) -> None:
    """Warn of the line outside the package that led here, however deep inside of it this is."""
    frame, level = sys._getframe(), 1
    while frame.f_back is not None and _package(frame) == __package__:
        frame, level = frame.f_back, level + 1
    warnings.warn(message, kind, stacklevel=level)


def _package(frame: FrameType) -> str:
    return str(frame.f_globals.get("__name__", "")).partition(".")[0]


def _outside(trace: TracebackType | None) -> TracebackType | None:
    """Return a traceback from the first to the last line outside the package, and outside IPython."""
    entries = [] if trace is None else [trace]
    while entries and entries[-1].tb_next is not None:
        entries.append(entries[-1].tb_next)
    while len(entries) > 1 and _package(entries[-1].tb_frame) == __package__:
        entries.pop()
    while len(entries) > 1 and _package(entries[0].tb_frame) in (__package__, "IPython"):
        entries.pop(0)
    ending = None
    for entry in reversed(entries):
        ending = TracebackType(ending, entry.tb_frame, entry.tb_lasti, entry.tb_lineno)
    return ending


def _shorten(error: BaseException | None) -> None:
    """Leave the lines of the package out of the tracebacks of an error and of its causes."""
    while error is not None:
        error.__traceback__, error = _outside(error.__traceback__), error.__cause__


_earlier_hook = sys.excepthook


def _show_error(kind: type[BaseException], error: BaseException, trace: TracebackType | None) -> None:
    """Show an error of beamfem at the line of the user's own code; `sys.last_traceback` has all lines."""
    if isinstance(error, BeamfemError):
        _shorten(error)
    _earlier_hook(kind, error, error.__traceback__)


sys.excepthook = _show_error
