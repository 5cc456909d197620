"""What a terminal is told of long work: how much is done, and that kernels are being compiled."""

import io
import sys
from contextvars import ContextVar

import pytest
from bad_inputs import CANTILEVER

import beamfem as bf
from beamfem.equations.compilation_notice import announce_compilation


class Terminal(io.StringIO):
    def isatty(self):
        return True


def a_terminal(monkeypatch):
    """Put a terminal in the place of stderr; within a test, as pytest puts its own there before each."""
    monkeypatch.setattr(sys, "stderr", Terminal())
    return sys.stderr


def twice(x):
    return 2.0 * x


# the work, and how much of it is done at the end
LONG = {
    "motion": (lambda: bf.simulate(CANTILEVER, 0.01, 1e-3), 0.01),
    "path": (lambda: bf.trace_equilibrium(CANTILEVER, lambda state: False, points=5), 5),
    "sweep": (lambda: bf.sweep(twice, x=[1, 2, 3]), 3),
}


@pytest.mark.parametrize("work", LONG)
def test_a_bar_shows_how_much_is_done(work, monkeypatch):
    a_terminal(monkeypatch)
    done = []
    monkeypatch.setattr("rich.progress.Progress.update", lambda self, task, completed: done.append(completed))
    run, whole = LONG[work]
    run()
    assert done == sorted(done)
    assert done[-1] == pytest.approx(whole)


def test_a_pipe_is_shown_no_bar(capsys):
    bf.simulate(CANTILEVER, 0.01, 1e-3)
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("solve", [bf.solve_static, lambda model: bf.simulate(model, 1e-3, 1e-3)])
@pytest.mark.parametrize(
    ("folder", "words"), [("somewhere", "once on this computer"), (None, "BEAMFEM_CACHE_DIR names")]
)
def test_the_first_solve_says_once_that_kernels_are_compiled(solve, folder, words, monkeypatch):
    terminal = a_terminal(monkeypatch)
    monkeypatch.setattr("beamfem.progress._held", ContextVar("held", default=True))  # no bars
    monkeypatch.setattr("beamfem.equations.compilation_notice.kept", lambda: 0)
    monkeypatch.setattr("beamfem.equations.compilation_notice.cache_folder", lambda: folder)
    announce_compilation.cache_clear()
    solve(CANTILEVER)
    solve(CANTILEVER)
    assert terminal.getvalue().count("compiling kernels") == 1
    assert words in terminal.getvalue()
