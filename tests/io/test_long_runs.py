"""Motions that are written into a file while they run: resumed, they are those that were not interrupted."""

import os
import shutil
import signal
import subprocess
import sys
import time
import tracemalloc
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np
import pytest
from refused_steps import ELEMENTS, slider_crank
from slow_values import mostly_slow

import beamfem as bf
from beamfem.errors import MissingFileError
from beamfem.io import hdf5
from beamfem.io.motion_file import MotionFile
from beamfem.solve.motion import long_runs

ROOT = Path(__file__).parents[2]
RUBBER, SECTION = bf.Material(0.7e6, 0.3, 5540.0), bf.Section(1.6e-3, 8.533e-6)
WEIGHT = bf.Gravity((0.0, -9.81))


def arm(element=None, elements=4, **others):
    return bf.Beam(bf.Line((0, 0), (1.2, 0)), elements, element or bf.CRBF(2), SECTION, RUBBER, **others)


def pendulum(element=None, loads=(WEIGHT,), connectors=(), **others):
    beam = arm(element, **others)
    return bf.Model([beam], [bf.Pin(beam.start)], loads, connectors=[make(beam) for make in connectors])


def released_strip():
    """Let go where it was bent; steps are cut."""
    strip = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(2), bf.Rectangle(0.02, 0.002), bf.Material(2.1e11, 0.3, 7850.0))
    force = 3.0 * 2.1e11 * 0.02 * 0.002**3 / 12.0
    bent = bf.solve_static(bf.Model([strip], [bf.Clamp(strip.start)], [bf.PointForce(strip.end, (0.0, force))]))
    return bf.Model([strip], [bf.Clamp(strip.start)]), bent[-1]


def driven():
    beam = arm()
    hub = bf.Prescribed(beam.start, ux=0.0, uy=0.0, rotation=lambda t: 0.5 * np.sin(5.0 * t) ** 2)
    return bf.Model([beam], [hub], [WEIGHT])


def struck():
    """A force that jumps and has kinks within steps."""
    beam = arm()
    push = bf.Piecewise(lambda t: 15.0 * t if t < 0.0333 else 2.0 - 10.0 * min(t, 0.2), kinks=[0.0333, 0.2001])
    return bf.Model([beam], [bf.Pin(beam.start)], [bf.PointForce(beam.end, (0.0, 1.0), amplitude=push)])


def driven_crank():
    return slider_crank(ELEMENTS["ANCF-CRBF"])["model"]


def linked():
    bars = [arm(), bf.Beam(bf.Line((1.3, 0), (1.8, 0)), 2, bf.CRBF(2), SECTION, RUBBER)]
    return bf.Model(bars, [bf.Pin(bars[0].start)], [WEIGHT], connectors=[bf.Link(bars[0].end, bars[1].start)])


def rubbing():
    bars = [arm(), bf.Beam(bf.Line((1.2, 0), (1.8, 0)), 2, bf.CRBF(2), SECTION, RUBBER)]
    hinge = bf.Hinge(bars[0].end, bars[1].start)
    friction = bf.HingeFriction(bars[0].end, bars[1].start, torque=0.5, stiffness=1e3)
    return bf.Model(bars, [bf.Pin(bars[0].start)], [WEIGHT], [hinge], [friction])


def yielding():
    mild = bf.ElasticPlastic(2e11, 2e8, poisson_ratio=0.3, density=7800.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Fibres(bf.Rectangle(0.02, 0.02), mild))
    return bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -500.0))])


@dataclass
class Counting:
    """Semi-implicit Euler steps that depend on how many there were: an integrator with a memory."""

    count: int = field(default=0, init=False)

    def run(self):
        return Counting()

    def memory(self):
        return {"count": np.array(self.count)}

    def recall(self, memory):
        self.count = int(memory["count"])

    def step(self, motion, begin, end):
        self.count += 1
        h, free = end - begin.at, motion.free
        p, v, a = begin.p.copy(), begin.v.copy(), np.zeros_like(begin.p)
        mass = motion.tangent(begin.p, begin.v, a, begin.at, (0.0, 0.0, 1.0))
        a[free] = -motion.solver(mass)(motion.residual(begin.p, begin.v, a, begin.at))
        v[free] += h * a[free] * (1.0 + 1e-6 * self.count)
        p[free] += h * v[free]
        return bf.State(p, v, a, end, begin.model)


def tip_event(model, **how):
    point = model.beams[0].end
    return bf.Event("the tip turns", lambda state: state.velocity(point)[1], **how)


CASES = {
    "generalized-alpha": (pendulum, {"duration": 0.5, "step": 1e-3, "save_every": 3}),
    "full turns": (lambda: pendulum(bf.ANCF()), {"duration": 0.2, "step": 1e-3}),
    "undamped with cuts": (released_strip, {"duration": 1.0, "step": 5e-3, "integrator": bf.GeneralizedAlpha(1.0)}),
    "driven with cuts": (driven_crank, {"duration": 0.2, "step": 2e-3, "integrator": bf.GeneralizedAlpha(1.0)}),
    "Gauss": (pendulum, {"duration": 0.2, "step": 2e-3, "integrator": bf.Gauss(2)}),
    "Radau": (pendulum, {"duration": 0.2, "step": 2e-3, "integrator": bf.Radau(3)}),
    "energy-momentum": (pendulum, {"duration": 0.2, "step": 2e-3, "integrator": bf.EnergyMomentum()}),
    "own integrator": (pendulum, {"duration": 0.01, "step": 2e-5, "integrator": Counting(), "save_every": 7}),
    "tolerance": (pendulum, {"duration": 0.5, "tolerance": 1e-4}),
    "tolerance, rows at times": (pendulum, {"duration": 0.5, "tolerance": 1e-4, "save_at": (0.1, 0.25, 0.5)}),
    "tolerance, Radau": (pendulum, {"duration": 0.3, "tolerance": 1e-5, "integrator": bf.Radau(2), "step": 0.01}),
    "kinks": (struck, {"duration": 0.3, "step": 1e-3}),
    "kinks, tolerance": (struck, {"duration": 0.3, "tolerance": 1e-4}),
    "moved support": (driven, {"duration": 0.3, "step": 1e-3}),
    "moved support, Radau": (driven, {"duration": 0.1, "step": 1e-3, "integrator": bf.Radau(2)}),
    "conditions": (linked, {"duration": 0.3, "step": 1e-3}),
    "friction": (rubbing, {"duration": 0.2, "step": 1e-3}),
    "history": (yielding, {"duration": 0.05, "step": 5e-4}),
    "damper": (
        lambda: pendulum(
            connectors=[lambda beam: bf.SpringDamper(beam.end, (1.2, -1.0), stiffness=3.0, damping=0.2)],
            damping=bf.KelvinVoigt(0.01),
        ),
        {"duration": 0.3, "step": 1e-3},
    ),
}

# what others keep in a file, one of these does as well
QUICK = (
    "generalized-alpha",
    "driven with cuts",
    "energy-momentum",
    "own integrator",
    "tolerance, Radau",
    "kinks, tolerance",
    "history",
)


def datasets(path):
    """Everything in a file by name, but for what HDF5 and the version say."""
    found = {}
    with h5py.File(path, "r") as file:
        file.visititems(lambda name, item: found.update({name: item[()]}) if isinstance(item, h5py.Dataset) else None)
        return {**found, "rows": file.attrs["rows"]}


def assert_same(one, other):
    assert one.keys() == other.keys()
    for name, values in one.items():
        np.testing.assert_array_equal(values, other[name], err_msg=name)


@pytest.fixture
def short(monkeypatch):
    """Sections of 32 steps, each of which is written."""
    monkeypatch.setattr(long_runs, "_STEPS", 32)
    monkeypatch.setattr(long_runs, "_SECONDS", 0.0)


@pytest.mark.filterwarnings("ignore::beamfem.errors.LargeStrainWarning", "ignore::beamfem.errors.LockingWarning")
@mostly_slow("name", list(CASES), quick=[list(CASES).index(name) for name in QUICK])
def test_a_resumed_motion_is_the_same_bit_for_bit(name, short, tmp_path, monkeypatch):
    made, how = CASES[name]
    made = made()
    model, start = made if isinstance(made, tuple) else (made, None)
    events = [tip_event(model)]
    commit, copies = MotionFile.commit, []

    def copied(self, *arguments):
        commit(self, *arguments)
        copies.append(shutil.copy(self.path, tmp_path / f"{len(copies)}.h5"))

    monkeypatch.setattr(MotionFile, "commit", copied)
    motion = bf.simulate(model, start=start, events=events, file=tmp_path / "whole.h5", **how)
    monkeypatch.setattr(MotionFile, "commit", commit)
    whole = datasets(tmp_path / "whole.h5")
    assert len(copies) > 3
    assert motion.status.name == "COMPLETED"
    assert not (tmp_path / "whole.h5.journal").exists()
    if "cuts" in name:
        assert motion.statistics.rejected > 0
    for copy in sorted({*copies[:2], copies[len(copies) // 2], copies[-2]}):
        again = bf.resume(copy, model, events=events, integrator=how.get("integrator"))
        assert_same(datasets(copy), whole)
        np.testing.assert_array_equal(again.p, motion.p)
    assert again.events == motion.events
    # as a motion in memory, but for sections: to the accuracy of iterations
    plain = bf.simulate(model, start=start, events=events, **how)
    assert len(plain.events) == len(motion.events)
    if "cuts" not in name and "tolerance" not in name and "own" not in name:
        np.testing.assert_array_equal(plain.time, motion.time)
        np.testing.assert_allclose(motion.p, plain.p, atol=2e-6 * np.abs(plain.p).max())


def test_events_of_sections_that_are_written_together_count_once(monkeypatch, tmp_path):
    """They were counted again with each section, so that a killed motion went on with events at time 0."""
    monkeypatch.setattr(long_runs, "_STEPS", 32)
    monkeypatch.setattr(long_runs, "_SECONDS", np.inf)
    model = pendulum()
    motion = bf.simulate(model, 1.5, 1e-3, events=[tip_event(model)], file=tmp_path / "motion.h5")
    assert len(motion.events) == datasets(tmp_path / "motion.h5")["checkpoint/counts"][4] == 2


@pytest.mark.parametrize("how", [{"step": 1e-3}, {"tolerance": 1e-4}], ids=["step", "tolerance"])
def test_a_motion_is_extended_and_the_same_if_it_was_killed_before(how, short, tmp_path):
    """Also by the call that extends it: the first part is completed as it was begun."""
    model, one, other = pendulum(), tmp_path / "one.h5", tmp_path / "other.h5"
    bf.simulate(model, 0.2, file=one, **how)
    longer = bf.resume(one, duration=0.4)
    assert longer.time[-1] == pytest.approx(0.4)
    assert np.all(np.diff(longer.time) > 0.0)
    stop = bf.Event("never", lambda state: 1.0 if state.time < 0.1 else 1 / 0)
    with pytest.raises(ZeroDivisionError) as caught:
        bf.simulate(model, 0.2, file=other, events=[stop], **how)
    assert 0.05 < caught.value.solution.time[-1] < 0.1
    held = bf.load(other)
    assert held.status.name == "STOPPED"
    assert "bf.resume goes on from there" in held.statistics.ended
    np.testing.assert_array_equal(held.p, bf.load(one).p[: len(held)])
    never = bf.Event("never", lambda state: 1.0)
    resumed = bf.resume(other, events=[never], duration=0.4)
    np.testing.assert_array_equal(resumed.p, longer.p)
    np.testing.assert_array_equal(resumed.time, longer.time)


@pytest.mark.slow
def test_integrators_of_the_package_are_found_in_files_by_a_process_that_has_used_none(tmp_path):
    named = (bf.GeneralizedAlpha(0.5), bf.HHT(-0.1), bf.Newmark(0.3025, 0.6), bf.Trapezoidal(), bf.Midpoint(),
             bf.Gauss(2), bf.Radau(2), bf.EnergyMomentum())  # fmt: skip
    files = [tmp_path / f"{number}.h5" for number in range(len(named))]
    for integrator, file in zip(named, files, strict=True):
        bf.simulate(pendulum(), 0.05, 1e-3, integrator, file=file)
        shutil.copy(file, file.with_suffix(".copy"))
        bf.resume(file.with_suffix(".copy"), integrator=integrator, duration=0.1)
    script = "import sys, beamfem as bf\nfor file in sys.argv[1:]: bf.resume(file, duration=0.1)"
    subprocess.run([sys.executable, "-c", script, *files], check=True, cwd=ROOT)
    for file in files:
        np.testing.assert_array_equal(bf.load(file).p, bf.load(file.with_suffix(".copy")).p)
        assert bf.load(file).time[-1] == pytest.approx(0.1)


def test_an_event_ends_a_motion_in_a_file(short, tmp_path):
    model, path = pendulum(), tmp_path / "swing.h5"
    events = [tip_event(model, rising=True, stop=True)]
    motion = bf.simulate(model, 2.0, 1e-3, events=events, file=path)
    assert motion.time[-1] == motion.events[0].time < 0.7
    assert motion.events[0].row == len(motion) - 1
    with pytest.warns(bf.LongRunWarning, match="holds a complete motion: an event has ended it"):
        assert len(bf.resume(path, events=events, duration=3.0)) == len(motion)


def test_functions_of_time_are_saved_at_the_rows(short, tmp_path):
    model, path = driven(), tmp_path / "driven.h5"
    motion = bf.simulate(model, 0.1, tolerance=1e-4, file=path)
    hub = motion.model.supports[0].rotation
    assert [hub(t) for t in motion.time] == [model.supports[0].rotation(t) for t in motion.time]
    with pytest.raises(bf.InputError, match="give resume the model itself"):
        bf.resume(path, duration=0.2)
    longer = bf.resume(path, model, duration=0.2)
    hub = longer.model.supports[0].rotation
    assert [hub(t) for t in longer.time] == [model.supports[0].rotation(t) for t in longer.time]


def test_rows_are_selected(tmp_path, short):
    model, path = pendulum(), tmp_path / "swing.h5"
    motion = bf.simulate(model, 1.0, 1e-3, events=[tip_event(model)], file=path)
    every = bf.load(path, rows=slice(5, None, 10))
    np.testing.assert_array_equal(every.p, motion.p[5::10])
    assert [each.time for each in every.events] == [each.time for each in motion.events]
    assert every.time[every.events[0].row] >= every.events[0].time > every.time[every.events[0].row - 1]
    with pytest.raises(bf.InputError, match="must select some of its 1001 rows"):
        bf.load(path, rows=slice(5, 5))


def test_a_motion_beyond_the_memory_is_returned_in_part(short, tmp_path, monkeypatch):
    monkeypatch.setattr(long_runs, "installed_memory", lambda: 100_000)
    with pytest.warns(bf.LongRunWarning, match=r"every \d+th is returned"):
        motion = bf.simulate(pendulum(), 0.3, 1e-3, file=tmp_path / "swing.h5")
    assert 10 < len(motion) < 150
    assert len(bf.load(tmp_path / "swing.h5")) == 301


def test_what_does_not_fit_a_file_is_said_in_a_sentence(short, tmp_path):
    model, path = pendulum(), tmp_path / "swing.h5"
    bf.simulate(model, 0.1, 1e-3, file=path)
    with pytest.raises(bf.InputError, match="holds a motion of another model than the one given"):
        bf.resume(path, pendulum(loads=()), duration=0.2)
    with pytest.raises(bf.InputError, match=r"begun with no events; give the same"):
        bf.resume(path, events=[tip_event(model)], duration=0.2)
    with pytest.raises(bf.InputError, match=r"GeneralizedAlpha \{'rho_inf': 0.9\}, give the same"):
        bf.resume(path, integrator=bf.Gauss(2), duration=0.2)
    with pytest.raises(bf.InputError, match=r"holds a motion of 0.1 s, which is not made shorter"):
        bf.resume(path, duration=0.05)
    with pytest.warns(bf.LongRunWarning, match=r"holds a complete motion: 0.1 s of 0.1 s"):
        assert len(bf.resume(path)) == 101
    bf.simulate(model, 0.1, 1e-3).save(tmp_path / "saved.h5")
    with pytest.raises(bf.InputError, match="holds no motion that simulate wrote"):
        bf.resume(tmp_path / "saved.h5")
    (tmp_path / "text.h5").write_text("text")
    with pytest.raises(bf.InputError, match="it is no HDF5 file"):
        bf.resume(tmp_path / "text.h5")
    with pytest.raises(bf.InputError, match="a Model is asked for"):
        bf.resume(path, "model")
    with pytest.raises(bf.FileError, match="there is no file"):
        bf.resume(tmp_path / "nothing.h5")
    with pytest.raises(bf.InputError, match="1e\\+18 steps, whose times are kept, need"):
        bf.simulate(model, 1e15, 1e-3, file=tmp_path / "nothing.h5")
    bf.simulate(model, 0.1, 1e-3, file=tmp_path / "text.h5")  # as save, it replaces what is no unfinished motion
    open_file = MotionFile(path)
    for begin in (lambda: bf.resume(path), lambda: bf.simulate(model, 0.1, 1e-3, file=path)):
        with pytest.raises(bf.InputError, match=r"swing.h5 is being written by another process"):
            begin()
    open_file.close()


@pytest.mark.filterwarnings("ignore:.* holds a complete motion:beamfem.LongRunWarning")
def test_a_damaged_file_is_refused_in_a_sentence(short, tmp_path):
    """It also stayed locked; parts of a file that are not used may be lost."""
    path, refused = tmp_path / "swing.h5", 0
    rows = bf.simulate(pendulum(), 0.05, 1e-3, file=path).p
    whole = path.read_bytes()
    for begin in range(0, len(whole), 20480):
        path.write_bytes(whole[:begin] + bytes(4096) + whole[begin + 4096 :])
        try:
            np.testing.assert_array_equal(bf.resume(path).p, rows)
        except bf.InputError as error:
            refused += "damaged" in str(error)
    assert refused > 1


def test_an_unfinished_motion_is_not_replaced(short, tmp_path):
    model, path = pendulum(), tmp_path / "swing.h5"
    fails = bf.Event("fails", lambda state: 1.0 if state.time < 0.05 else 1 / 0)
    with pytest.raises(ZeroDivisionError):
        bf.simulate(model, 0.1, 1e-3, events=[fails], file=path)
    with pytest.raises(bf.InputError, match="a motion that has not ended; resume it, or delete the file"):
        bf.simulate(model, 0.1, 1e-3, file=path)


def test_a_full_disk_leaves_what_was_written(short, tmp_path, monkeypatch):
    model, path, whole = pendulum(), tmp_path / "swing.h5", tmp_path / "whole.h5"
    bf.simulate(model, 0.3, 1e-3, file=whole)
    put, calls = hdf5._put, []

    def full(file, data, at):
        calls.append(None)
        if len(calls) > 40:
            put(file, data[: len(data) // 2], at)
            raise OSError(28, "No space left on device")
        put(file, data, at)

    monkeypatch.setattr(hdf5, "_put", full)
    with pytest.raises(
        bf.FileError, match=r"No space left on device; the motion up to then is in it, and bf.resume goes"
    ):
        bf.simulate(model, 0.3, 1e-3, file=path)
    monkeypatch.setattr(hdf5, "_put", put)
    assert 30 < len(bf.load(path)) < 301
    bf.resume(path)
    assert_same(datasets(path), datasets(whole))


def test_a_file_is_as_before_or_after_a_change_wherever_its_writer_ends(tmp_path, short, monkeypatch):
    """The process ends, here by an exception, before each single piece that is written."""
    model, path, put = pendulum(), tmp_path / "swing.h5", hdf5._put
    motion = bf.simulate(model, 0.03, 1e-3, file=path)
    before = datasets(path)
    shutil.copy(path, tmp_path / "before.h5")
    after = datasets(bf.resume(path, duration=0.05) and path)
    for allowed in range(0, 60, 3):
        shutil.copy(tmp_path / "before.h5", path)
        calls = []

        def ends(file, data, at, calls=calls, allowed=allowed):
            calls.append(None)
            put(file, data if len(calls) <= allowed else data[: len(data) // 2], at)
            if len(calls) > allowed:
                raise SystemExit

        monkeypatch.setattr(hdf5, "_put", ends)
        with suppress(SystemExit):
            bf.resume(path, duration=0.05)
        monkeypatch.setattr(hdf5, "_put", put)
        assert len(bf.load(path)) >= len(motion)
        found = datasets(path)
        if found["rows"] == before["rows"]:
            assert_same({name: found[name] for name in ("p", "turned") if name in found}, {"p": before["p"]})
        assert len(bf.resume(path, duration=0.05)) == 51
        assert_same(datasets(path), after)


def test_memory_does_not_grow_with_rows(tmp_path, monkeypatch):
    """A row has 1.1 kB; times of steps, which are known before, have some 10 bytes each."""
    monkeypatch.setattr(long_runs, "_BYTES", 2**18)
    monkeypatch.setattr(long_runs, "_loaded", lambda file: bf.load(file.path, rows=slice(0, 1)))
    model, peaks = pendulum(), []
    row = 24 * model.size
    for steps in (1000, 2000, 10_000):  # the first one warms up
        tracemalloc.start()
        bf.simulate(model, steps * 1e-4, 1e-4, file=tmp_path / f"{steps}.h5")
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        assert len(bf.load(tmp_path / f"{steps}.h5")) == steps + 1
    assert peaks[2] - peaks[1] < 0.15 * 8000 * row


KILLED = """
import sys
import beamfem as bf
from beamfem.solve.motion import long_runs
long_runs._SECONDS = 0.02
beam = bf.Beam(bf.Line((0, 0), (1.2, 0)), 4, bf.CRBF(2), bf.Section(1.6e-3, 8.533e-6), bf.Material(0.7e6, 0.3, 5540.0))
model = bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0.0, -9.81))])
events = [bf.Event("the tip turns", lambda state: state.velocity(beam.end)[1])]
path, how = sys.argv[1:3]
print("begins", flush=True)
if how == "begin":
    kind, *numbers = sys.argv[3:]
    bf.simulate(model, 10.0, 1e-3, getattr(bf, kind)(*map(float, numbers)), events=events, file=path)
else:
    bf.resume(path, model, events=events)
"""


@contextmanager
def motion_process(path, how, integrator=("GeneralizedAlpha",)):
    """Begin or resume a motion in a process of its own, which is ready to take steps."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-W", "ignore", "-c", KILLED, str(path), how, *integrator]
    with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE) as process:
        process.stdout.readline()
        yield process


@pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGKILL")
@pytest.mark.parametrize(
    ("kills", "integrator"),
    [
        (1, ("GeneralizedAlpha",)),
        pytest.param(20, ("GeneralizedAlpha",), marks=pytest.mark.slow),
        pytest.param(5, ("HHT", "-0.1"), marks=pytest.mark.slow),
        pytest.param(5, ("Radau",), marks=pytest.mark.slow),
        pytest.param(5, ("Gauss",), marks=pytest.mark.slow),
    ],
)
def test_a_motion_that_is_killed_at_random_moments_is_the_same(kills, integrator, tmp_path):
    """10,000 steps, each time from the beginning of the file or from where the last process was killed.

    The integrator is that of the file.
    """
    whole, path = tmp_path / "whole.h5", tmp_path / "killed.h5"
    with motion_process(whole, "begin", integrator) as process:
        began = time.monotonic()
        assert process.wait() == 0
    lasts, random, done = time.monotonic() - began, np.random.default_rng(kills), 0
    while done < kills:
        # a process needs a while until it takes its first step
        with motion_process(path, "resume" if path.exists() else "begin", integrator) as process:
            time.sleep(float(random.uniform(0.0, lasts)))
            process.send_signal(signal.SIGKILL)
            if process.wait() == 0:
                path.unlink()
            done += process.returncode != 0
        if path.exists():
            rows = bf.load(path).p
            np.testing.assert_array_equal(rows, bf.load(whole, rows=slice(len(rows))).p)
    with motion_process(path, "resume") as process:
        assert process.wait() == 0
    assert_same(datasets(path), datasets(whole))


@pytest.mark.slow
@pytest.mark.skipif(os.name == "nt", reason="nothing keeps readers and writers apart there")
def test_a_file_is_read_while_it_is_written(tmp_path):
    """Each reading shows rows that the motion has; a second writer is refused."""
    path, counts = tmp_path / "motion.h5", []
    with motion_process(path, "begin") as process:
        while process.poll() is None:
            time.sleep(0.1)
            if path.exists():
                counts.append(len(bf.load(path, rows=slice(0, None, 50))))
    assert process.returncode == 0
    assert counts == sorted(counts)
    assert len(bf.load(path)) == 10_001


def test_a_file_that_was_removed_is_none_to_go_on_from(tmp_path):
    """The message said that the motion up to then was in it."""
    file, bar = tmp_path / "long.h5", bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), SECTION, RUBBER)
    model = bf.Model([bar], [bf.Pin(bar.start)], [bf.Gravity((0.0, -9.81))])

    def away(state):
        if state.time > 0.05:
            file.unlink(missing_ok=True)
        return 1.0

    with pytest.raises(MissingFileError, match="replaced or removed") as error:
        bf.simulate(model, 0.1, 1e-3, file=file, events=[bf.Event("away", away)])
    assert "resume" not in str(error.value)
