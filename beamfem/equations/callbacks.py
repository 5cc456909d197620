"""Python functions that compiled code calls: exceptions cannot propagate through it, so they wait until it returns."""

import functools
import signal
import sys
from collections.abc import Callable, Iterable
from threading import current_thread, get_ident, main_thread
from types import FrameType, TracebackType
from typing import Any, ParamSpec, Self, TypeVar

_Taken = ParamSpec("_Taken")
_Returned = TypeVar("_Returned")


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
    ctypes then reports the exception as ignored, and HDF5 ignores it without a report; compiled code goes on.
    signals: those whose handlers wait; lost: any other exception that was ignored, so that results are wrong.
    """

    def __init__(self, signals: Iterable[int] = (signal.SIGINT,)) -> None:
        self.lost = None
        self._signals, self._pending = tuple(signals), list[int]()
        self._main = current_thread() is main_thread()  # other threads handle no signals
        self._owner: FrameType | None = None
        self._handlers: dict[int, Any] = {}

    lost: BaseException | None

    def __enter__(self) -> Self:
        if self._main:
            self._owner, self._hook = sys._getframe(1), sys.unraisablehook
            handlers = {number: _without_leftovers(number, signal.getsignal(number)) for number in self._signals}
            self._handlers = {number: handler for number, handler in handlers.items() if callable(handler)}
            for number in self._handlers:
                signal.signal(number, self._note)
            sys.unraisablehook = self._keep
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None
    ) -> None:
        if self._main:
            sys.unraisablehook = self._hook
            for number, handler in self._handlers.items():
                signal.signal(number, handler)
            self._owner = None

    @property
    def interrupted(self) -> bool:
        """Whether there was a signal that has not been handled."""
        return bool(self._pending)

    def handle(self) -> None:
        """Call the handlers of the signals so far, where they may raise; later signals still wait."""
        while self._pending:
            number = self._pending.pop(0)
            self._handlers[number](number, sys._getframe(1))

    def deliver(self) -> None:
        """Raise what was to be raised inside, after the context."""
        try:
            while self._pending:
                signal.raise_signal(self._pending.pop(0))
        finally:
            if self._pending:  # the handler of one signal does not hide the next one
                self.deliver()
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
        if not self.inside:
            self._handlers[number](number, frame)
        elif number not in self._pending:
            self._pending.append(number)

    def _keep(self, unraisable: "sys.UnraisableHookArgs") -> None:
        # that of a function of the package that compiled code calls, ignored at its entry
        function = unraisable.object  # from Python 3.13 on it stands in the message only
        text = f"{unraisable.err_msg} {function!r} {getattr(function, '__module__', '')}"
        of_package = "ctypes callback" in text and ("beamfem." in text or "CoupledStages." in text)
        if of_package and current_thread() is main_thread() and self.inside:
            self.lost = unraisable.exc_value
        else:
            self._hook(unraisable)


def uninterrupted(function: Callable[_Taken, _Returned]) -> Callable[_Taken, _Returned]:
    """Return a function whose signals, all of them, are handled when it has returned or raised."""

    @functools.wraps(function)
    def called(*arguments: _Taken.args, **keywords: _Taken.kwargs) -> _Returned:
        deferred = Deferred(signal.valid_signals())
        try:
            with deferred:
                return function(*arguments, **keywords)
        finally:
            deferred.deliver()

    return called


def _without_leftovers(number: int, handler: Any) -> Any:
    """Return a handler, or that which a context replaced by it and could not restore."""
    while isinstance(owner := getattr(handler, "__self__", None), Deferred) and not owner.inside:
        handler = owner._handlers[number]
    return handler
