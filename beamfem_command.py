"""The command `beamfem`; beside the package, whose import takes a second that Ctrl-C may end."""

import os
import signal
import sys
from types import FrameType

_TOLD_AT_ONCE = {"--version", "--help", "-h"}


def main() -> None:
    """Run the command with the arguments of the process; Ctrl-C while it is imported ends it at once, exit code 130."""
    usual = signal.default_int_handler
    if signal.getsignal(signal.SIGINT) is usual:  # it may be ignored, as under nohup
        signal.signal(signal.SIGINT, _end)
    import beamfem
    from beamfem.cli.app import app

    if not set(sys.argv[1:]) <= _TOLD_AT_ONCE:
        for name in beamfem.__all__:
            getattr(beamfem, name)  # imports it
    if signal.getsignal(signal.SIGINT) is _end:
        signal.signal(signal.SIGINT, usual)
    app(prog_name="beamfem")


def _end(number: int, frame: FrameType | None) -> None:
    # not by an exception: a compiled module whose import it ends may lose it or make another one of it
    os.write(2, b"error: interrupted\n")
    os._exit(130)
