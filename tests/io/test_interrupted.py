"""Ctrl-C: what was computed is kept."""

import os
import signal
import subprocess
import sys
from ctypes import CFUNCTYPE, c_int
from pathlib import Path

import numpy as np
import pytest
from connectors import PointMass, cantilever
from connectors import beam as connected_beam
from section_laws import LinearLaw
from typer.testing import CliRunner

import beamfem as bf
from beamfem.cli.app import app
from beamfem.equations.callbacks import Deferred
from beamfem.solve.motion.compiled_steps import CompiledSteps
from beamfem.solve.statics import load_steps

ROOT = Path(__file__).parents[2]
BEAM = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(1), bf.Rectangle(0.1, 0.1), bf.Material(2e11, 0.3, 7800.0))
MODEL = bf.Model([BEAM], [bf.Clamp(BEAM.start)], [bf.PointForce(BEAM.end, (0.0, -1e5))])


@pytest.fixture
def third_time(monkeypatch):
    """Send this process Ctrl-C in the third stretch of steps of a motion; whoever runs the tests may ignore it."""
    advance, calls = CompiledSteps.advance, []
    handler = signal.signal(signal.SIGINT, signal.default_int_handler)

    def interrupted(self, *arguments):
        calls.append(None)
        done = advance(self, *arguments)
        if len(calls) == 3:
            os.kill(os.getpid(), signal.SIGINT)
        return done

    monkeypatch.setattr(CompiledSteps, "advance", interrupted)
    monkeypatch.setattr("beamfem.solve.motion.time_marching._FIRST_CHUNK", 1000)
    yield
    signal.signal(signal.SIGINT, handler)


@pytest.mark.parametrize("save_every", [1, 7])
def test_a_motion_that_is_interrupted_keeps_its_states(third_time, save_every):
    with pytest.raises(KeyboardInterrupt) as caught:
        bf.simulate(MODEL, 1.0, 1e-5, save_every=save_every)
    whole = bf.simulate(MODEL, 0.05, 1e-5, save_every=save_every)
    found = caught.value.solution
    assert found.status.name == "STOPPED"
    steps = np.round(found.time / 1e-5).astype(int)
    assert 60 < steps[-1] < 5000
    rows = len(found) if steps[-1] % save_every == 0 else len(found) - 1
    np.testing.assert_array_equal(found.p[:rows], whole.p[:rows])
    assert np.all(np.diff(steps)[:-1] == save_every)
    assert np.isfinite(found.p).all()
    assert "`solution`" in caught.value.__notes__[0]


def test_a_long_motion_that_is_interrupted_returns_what_is_done(third_time, monkeypatch):
    monkeypatch.setattr("beamfem.progress._WORTH", 0.0)
    with pytest.warns(bf.LongRunWarning, match=r"Ctrl-C: the motion ends early, \d+ steps of 1e-05 s; press it again"):
        found = bf.simulate(MODEL, 1.0, 1e-5)
    assert found.status.name == "STOPPED"
    assert 60 < len(found) < 5000


def test_ctrl_c_ends_a_sweep_of_long_motions(third_time, monkeypatch):
    monkeypatch.setattr("beamfem.progress._WORTH", 0.0)
    with pytest.raises(KeyboardInterrupt):
        bf.sweep(lambda step: bf.simulate(MODEL, 1.0, step).p[-1, 0], step=[1e-5, 2e-5])


def test_a_motion_in_a_file_that_is_interrupted_is_resumed(third_time, monkeypatch, tmp_path):
    monkeypatch.setattr("beamfem.progress._WORTH", 0.0)
    path = tmp_path / "motion.h5"
    with pytest.warns(bf.LongRunWarning, match="bf.resume goes on from there; press it again"):
        found = bf.simulate(MODEL, 0.05, 1e-5, file=path)
    assert found.status.name == "STOPPED"
    assert 1000 < len(found) < 5000
    whole = bf.resume(path)
    np.testing.assert_array_equal(whole.p[: len(found)], found.p)
    assert len(whole) == 5001


def test_a_static_solve_that_is_interrupted_keeps_its_rows(monkeypatch):
    solve = load_steps.solve_equilibrium

    def interrupted(system, start, load_factor, *others):
        if load_factor > 0.6:
            raise KeyboardInterrupt
        return solve(system, start, load_factor, *others)

    monkeypatch.setattr(load_steps, "solve_equilibrium", interrupted)
    model = bf.Model([BEAM], [bf.Clamp(BEAM.start)], [bf.PointForce(BEAM.end, (0.0, -1e5))])
    with pytest.raises(KeyboardInterrupt) as caught:
        bf.solve_static(model, steps=4)
    assert caught.value.solution.load_factor.tolist() == [0.0, 0.25, 0.5]


def test_a_motion_that_stops_on_an_unrefined_mesh_says_so():
    def interrupted(state):
        if state.time > 0.004:
            raise KeyboardInterrupt
        return 1.0

    beam = bf.Beam(bf.Line((0, 0), (1, 0)), "auto", section=bf.Rectangle(0.1, 0.1), material=BEAM.material)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -1e5))])
    with pytest.raises(KeyboardInterrupt) as caught:
        bf.simulate(model, 0.01, 1e-3, accuracy=1e-3, events=[bf.Event("never", interrupted)])
    found = caught.value.solution
    assert found.time[-1] == pytest.approx(0.004)
    assert found.statistics.ended.endswith("; it stopped on mesh 1, whose error is not known")


def test_the_command_line_saves_what_was_found_and_says_so(third_time, tmp_path, monkeypatch):
    monkeypatch.setattr("beamfem.progress._WORTH", 0.0)
    model = (ROOT / "examples" / "cantilever.toml").read_text() + "\n"
    assert "[analysis]" not in model
    motion = '[analysis]\nkind = "dynamics"\nduration = 1.0\nstep = 1e-5\n'
    (tmp_path / "long.toml").write_text(model + motion)
    out = tmp_path / "long.h5"
    done = CliRunner().invoke(app, ["run", str(tmp_path / "long.toml"), "--out", str(out)])
    assert done.exit_code == 130, done.stderr
    assert done.stderr.startswith("error: interrupted\n")
    assert f"are saved in {out}" in done.stderr
    assert 1 < len(bf.load(out)) < 100_000


IMPORTING = """
import os, signal, sys

class Interrupt:
    def find_spec(self, name, path=None, target=None):
        if name == at:
            os.kill(os.getpid(), signal.SIGINT)

at, handler = sys.argv[1:]
sys.meta_path.insert(0, Interrupt())
signal.signal(signal.SIGINT, getattr(signal, handler))
from beamfem_command import main
sys.argv = ["beamfem", "info", "missing.h5"]
main()
"""


def info_interrupted(at, handler):
    """Run `beamfem info missing.h5` with Ctrl-C where a module is looked for."""
    command = [sys.executable, "-c", IMPORTING, at, handler]
    return subprocess.run(command, capture_output=True, text=True, check=False, cwd=ROOT)


@pytest.mark.parametrize(
    "at", ["beamfem", "numpy._core._multiarray_umath", "scipy.sparse", "llvmlite.binding", "typer"]
)
def test_the_command_line_ends_quietly_while_it_is_imported(at):
    done = info_interrupted(at, "default_int_handler")
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "error: interrupted\n")


def test_the_command_line_leaves_an_interrupt_ignored_that_was():
    """As under nohup."""
    done = info_interrupted("llvmlite.binding", "SIG_IGN")
    assert (done.returncode, done.stdout) == (2, "")
    assert done.stderr.startswith("error: ")
    assert "missing.h5" in done.stderr


def hanging(force=None):
    """Return a cantilever with a mass at its end, whose force may be another function."""
    kind = PointMass if force is None else type("Interfering", (PointMass,), {"force": force})
    own = connected_beam(bf.CRBF(2))
    return cantilever(own, [bf.Gravity((0.0, -9.81))], [kind(own.end, 1.0)])


def test_a_ctrl_c_in_a_force_ends_the_motion_between_two_steps():
    """Python handles it where compiled code calls the force, which could neither catch nor pass on the exception."""

    def force(self, at):
        if 0.0201 < np.real(at.time) < 0.0219:
            signal.raise_signal(signal.SIGINT)
        return PointMass.force(self, at)

    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        with pytest.raises(KeyboardInterrupt) as caught:
            bf.simulate(hanging(force), 0.05, 1e-3)
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)
    found = caught.value.solution
    assert len(found) > 20
    assert found.p == pytest.approx(bf.simulate(hanging(), 0.05, 1e-3).p[: len(found)], abs=1e-15)


@pytest.mark.parametrize("solve", [lambda model: bf.simulate(model, 0.05, 1e-3), bf.solve_static])
def test_a_handler_that_only_notes_a_ctrl_c_changes_nothing(solve):
    noted = []

    def force(self, at):
        if 0.0201 < np.real(at.time) < 0.9 and not noted:
            signal.raise_signal(signal.SIGINT)
        return PointMass.force(self, at)

    before = signal.signal(signal.SIGINT, lambda number, frame: noted.append(number))
    try:
        assert np.array_equal(solve(hanging(force)).p, solve(hanging()).p)
    finally:
        signal.signal(signal.SIGINT, before)


def test_errors_of_other_callbacks_are_no_concern_of_a_solve():
    """A function of a user's own that C calls, within a force: Python reports what it raises, and goes on."""

    def fails():
        raise ValueError("of a callback of one's own")

    callback, seen = CFUNCTYPE(c_int)(fails), []

    def force(self, at):
        callback()
        return PointMass.force(self, at)

    before, sys.unraisablehook = sys.unraisablehook, lambda unraisable: seen.append(unraisable.exc_value)
    try:
        assert np.array_equal(bf.simulate(hanging(force), 0.01, 1e-3).p, bf.simulate(hanging(), 0.01, 1e-3).p)
    finally:
        sys.unraisablehook = before
    assert seen
    assert all(isinstance(error, ValueError) for error in seen)


class TimeUp(BaseException):
    """What a signal's handler may raise."""


@pytest.mark.parametrize("number", [1, 2, 3, 4, 5, 40])
@pytest.mark.parametrize("function", ["_add", "_fill", "guarded"])
def test_what_a_signal_raises_is_not_lost(function, number, widest_band):
    """It may come at the entry of a function that compiled code calls, too early to be caught there."""
    own = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), LinearLaw(2e7, 7e6, 166.0, 0.78, 1e-5))
    laws = cantilever(own, [bf.Gravity((0.0, -9.81))])
    if function == "guarded":  # routines of a sparse tangent
        widest_band(-1)
    model, calls, before = laws if function == "_fill" else hanging(), [], sys.gettrace()
    known = bf.simulate(model, 0.02, 1e-3)

    def trace(frame, event, argument):
        if frame.f_code.co_name == function:
            calls.append(event)
            if len(calls) == number:
                sys.settrace(before)
                raise TimeUp

    try:
        sys.settrace(trace)
        with pytest.raises(TimeUp) as caught:
            bf.simulate(model, 0.02, 1e-3)
    finally:
        sys.settrace(before)
    found = getattr(caught.value, "solution", known)  # there is none before the first step
    assert found.p == pytest.approx(known.p[: len(found)], abs=1e-15)
    assert np.array_equal(bf.simulate(model, 0.02, 1e-3).p, known.p)


def test_a_handler_that_could_not_be_restored_passes_a_ctrl_c_on():
    """Another signal's handler may raise before the context restores it; the next one does."""

    def left_behind():
        Deferred().__enter__()

    before, hook = signal.signal(signal.SIGINT, signal.default_int_handler), sys.unraisablehook
    try:
        left_behind()
        assert signal.getsignal(signal.SIGINT) is not signal.default_int_handler
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
        with Deferred() as deferred:
            signal.raise_signal(signal.SIGINT)
        assert deferred.interrupted
        assert signal.getsignal(signal.SIGINT) is signal.default_int_handler
    finally:
        signal.signal(signal.SIGINT, before)
        sys.unraisablehook = hook
