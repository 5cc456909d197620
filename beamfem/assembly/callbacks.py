"""Python functions that compiled code calls: exceptions cannot propagate through it, so they wait until it returns."""

import signal
import sys
from threading import current_thread, get_ident, main_thread
from types import FrameType, TracebackType
from typing import Any, Self


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
        self._owner: FrameType | None = None

    interrupted: bool
    lost: BaseException | None

    def __enter__(self) -> Self:
        if self._main:
            self._owner, self._hook = sys._getframe(1), sys.unraisablehook
            self._handler = _without_leftovers(signal.getsignal(signal.SIGINT))
            if callable(self._handler):
                signal.signal(signal.SIGINT, self._note)
            sys.unraisablehook = self._keep
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        if self._main:
            sys.unraisablehook = self._hook
            if callable(self._handler):
                signal.signal(signal.SIGINT, self._handler)
            self._owner = None

    def deliver(self) -> None:
        """Raise what was to be raised inside."""
        if self.interrupted:
            signal.raise_signal(signal.SIGINT)
        if self.lost is not None:
            raise self.lost

    @property
    def inside(self) -> bool:
        """Whether the context has not been left; another signal may have kept it from restoring the handlers."""
        frame: FrameType | None = sys._getframe(1)
        while frame is not None and frame is not self._owner:
            frame = frame.f_back
        return frame is not None

    def _note(self, number: int, frame: FrameType | None) -> None:
        if self.inside:
            self.interrupted = True
        elif callable(self._handler):
            self._handler(number, frame)

    def _keep(self, unraisable: "sys.UnraisableHookArgs") -> None:
        if current_thread() is main_thread() and self.inside and _is_of_package(unraisable):
            self.lost = unraisable.exc_value
        else:
            self._hook(unraisable)


def _without_leftovers(handler: Any) -> Any:
    """Return a handler, or that which a context replaced by it and could not restore."""
    while isinstance(owner := getattr(handler, "__self__", None), Deferred) and not owner.inside:
        handler = owner._handler
    return handler


def _is_of_package(unraisable: "sys.UnraisableHookArgs") -> bool:
    """Return whether an exception was ignored at the entry of a function of the package that compiled code calls."""
    function = unraisable.object  # from Python 3.13 on it stands in the message only
    text = f"{unraisable.err_msg} {function!r} {getattr(function, '__module__', '')}"
    return "ctypes callback" in text and ("beamfem." in text or "CoupledStages." in text)
