"""Python functions that compiled code calls: exceptions cannot propagate through it, so they wait until it returns."""

import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from threading import current_thread, get_ident, main_thread
from types import FrameType, TracebackType
from typing import Self

# those whose handlers may raise; others have none, or end the process
_SIGNALS = {
    getattr(signal, name)
    for name in ("SIGINT", "SIGTERM", "SIGALRM", "SIGHUP", "SIGUSR1", "SIGUSR2", "SIGVTALRM", "SIGPROF")
    if hasattr(signal, name)
}


class KeptErrors:
    """The first error in such functions since it was last taken, of each thread."""

    def __init__(self) -> None:
        self._errors: dict[int, BaseException] = {}

    def keep(self, error: BaseException) -> None:
        """Keep an error of this thread, unless there is one."""
        self._errors.setdefault(get_ident(), error)

    def take(self) -> BaseException | None:
        """Return the error of this thread and forget it."""
        return self._errors.pop(get_ident(), None)

    @property
    def waiting(self) -> bool:
        """Whether this thread has an error."""
        return get_ident() in self._errors


class Deferred:
    """A context for compiled code that calls Python: what would be raised inside is raised by `deliver`.

    Python handles Ctrl-C, and other signals, at the beginning of such a function, before it could catch anything;
    ctypes then reports the exception as ignored, and compiled code goes on with a result of zero. interrupted: whether
    there was a Ctrl-C, after which all goes on; lost: any other exception that was ignored, so that results are wrong.
    """

    def __init__(self) -> None:
        self.interrupted, self.lost = False, None
        self._main = current_thread() is main_thread()  # other threads handle no signals

    interrupted: bool
    lost: BaseException | None

    def __enter__(self) -> Self:
        if self._main:
            with _signals_waiting():
                self._hook, self._handler = sys.unraisablehook, signal.getsignal(signal.SIGINT)
                if callable(self._handler):
                    signal.signal(signal.SIGINT, self._note)
                sys.unraisablehook = self._keep
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        if self._main:
            with _signals_waiting():
                sys.unraisablehook = self._hook
                if callable(self._handler):
                    signal.signal(signal.SIGINT, self._handler)

    def deliver(self) -> None:
        """Raise what was to be raised inside."""
        if self.interrupted:
            signal.raise_signal(signal.SIGINT)
        if self.lost is not None:
            raise self.lost

    def _note(self, number: int, frame: FrameType | None) -> None:
        self.interrupted = True

    def _keep(self, unraisable: "sys.UnraisableHookArgs") -> None:
        if current_thread() is main_thread() and _is_of_package(unraisable):
            self.lost = unraisable.exc_value
        else:
            self._hook(unraisable)


@contextmanager
def _signals_waiting() -> Iterator[None]:
    """Let signals wait, so that none is handled between two of the statements inside, where systems can."""
    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    before = signal.pthread_sigmask(signal.SIG_BLOCK, _SIGNALS)
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


def _is_of_package(unraisable: "sys.UnraisableHookArgs") -> bool:
    """Return whether an exception was ignored at the entry of a function of the package that compiled code calls."""
    function = unraisable.object  # from Python 3.13 on it stands in the message only
    text = f"{unraisable.err_msg} {function!r} {getattr(function, '__module__', '')}"
    return "ctypes callback" in text and ("beamfem." in text or "CoupledStages." in text)
