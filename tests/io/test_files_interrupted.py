"""Files whose writing is interrupted at any moment: the earlier one or the new one, whole, and the exception."""

import os
import signal
import threading
import time

import h5py
import matplotlib.pyplot as plt
import numpy as np
import pytest
from slow_values import mostly_slow

import beamfem as bf
from beamfem.io import hdf5
from beamfem.sweeps.result_cache import ResultCache
from beamfem.sweeps.workers import Outcome


class TimeUp(BaseException):
    """What the handler of another signal may raise."""


def motion(rows, tip):
    """Return a result of many rows without a solve of each: the last coordinate is the row plus `tip`."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 10, bf.CRBF(2), bf.Rectangle(0.1, 0.1), bf.Material(2e11, 0.3, 7800.0))
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.Gravity((0.0, -9.81))])
    short = bf.simulate(model, 2e-3, 1e-3)
    p = np.repeat(short.p[:1], rows, axis=0)
    p[:, -1] += tip + np.arange(rows) * 1e-9
    zero = np.zeros_like(p)
    return bf.Solution(model, False, np.arange(rows) * 1e-3, p, zero, zero, short.statistics)


def read_h5(path):
    return bf.load(path).p[:, -1].tobytes()


def read_vtkhdf(path):
    with h5py.File(path) as file:
        data = file["VTKHDF/PointData"]
        return b"".join(data[name][()].tobytes() for name in data) + file["VTKHDF/Points"][()].tobytes()


def read_pvd(path):
    steps = sorted(path.with_suffix("").iterdir())
    assert [step.name for step in steps] == [f"{i:04d}.vtu" for i in range(len(steps))]
    assert path.read_text().count("<DataSet") == len(steps)
    return b"".join(step.read_bytes() for step in steps)


def read_picture(path):
    return plt.imread(path).tobytes()


WRITERS = {
    "a.h5": (bf.Solution.save, read_h5, 1001),
    "a.vtkhdf": (bf.Solution.to_vtk, read_vtkhdf, 201),
    "a.pvd": (bf.Solution.to_vtk, read_pvd, 21),
    "a.png": (bf.Solution.plot, read_picture, 3),
}


def interrupted(write, number, raised, delay):
    """Call a writer and send a signal after a delay [s]; return whether it raised what the handler raises."""
    ended = threading.Event()

    def send():
        time.sleep(delay)
        if not ended.is_set():
            os.kill(os.getpid(), number)

    thread = threading.Thread(target=send)
    try:
        thread.start()
        write()
        ended.set()
        thread.join()
    except raised:
        ended.set()
        return True
    return False


@pytest.fixture(params=[signal.SIGINT, signal.SIGUSR1])
def raising(request):
    """Install a handler that raises; return the signal and the exception."""

    def late(number, frame):
        raise TimeUp

    number = request.param
    handler = signal.default_int_handler if number == signal.SIGINT else late
    before = signal.signal(number, handler)
    yield number, KeyboardInterrupt if number == signal.SIGINT else TimeUp
    signal.signal(number, before)


def interrupt_at_random(name, folder, raising, times):
    write, read, rows = WRITERS[name]
    path, results = folder / name, [motion(rows, tip) for tip in (0.0, 0.25)]
    whole, seconds = [], 0.0
    for result in results:
        begun = time.perf_counter()
        write(result, path)
        seconds = time.perf_counter() - begun
        whole.append(read(path))
    assert whole[0] != whole[1]
    random, count, hits, there = np.random.default_rng(3), 0, 0, sorted(folder.iterdir())
    while count < times or (hits <= times // 4 and count < 20 * times):  # writers may end before the signal
        hit = interrupted(lambda n=count: write(results[n % 2], path), *raising, seconds * random.random())
        found = read(path)
        assert found == whole[count % 2] or (hit and found in whole)
        hits, count = hits + hit, count + 1
    assert hits > times // 4
    assert sorted(folder.iterdir()) == there


@pytest.mark.parametrize("name", WRITERS)
def test_an_interrupted_writer_leaves_the_earlier_file_or_the_new_one(name, raising, tmp_path):
    interrupt_at_random(name, tmp_path, raising, 4)


@pytest.mark.slow
@pytest.mark.parametrize("name", WRITERS)
def test_sixty_interrupts_of_a_writer_lose_nothing(name, raising, tmp_path):
    interrupt_at_random(name, tmp_path, raising, 60)


@pytest.mark.slow
@pytest.mark.parametrize("times", [6, pytest.param(60, marks=pytest.mark.slow)])
def test_an_interrupted_store_has_all_results_so_far(times, raising, tmp_path):
    result, random, stored = motion(401, 0.0), np.random.default_rng(5), []
    for count in range(times):
        with ResultCache(tmp_path / "store", max, [{"x": count}]) as store:

            def write(count=count, store=store):
                store.add(0, "", Outcome({"tip": float(count), "motion": result}, 0.1))

            if not interrupted(write, *raising, 0.02 * random.random()):
                stored.append(count)
    with ResultCache(tmp_path / "store", max, [{"x": count} for count in range(times)]) as store:
        for count, outcome in enumerate(store.found(keep_stale=False)):
            assert outcome is not None or count not in stored
            if outcome is not None:
                assert outcome.value["tip"] == count
                np.testing.assert_array_equal(outcome.value["motion"].p, result.p)


@pytest.mark.parametrize("name", ["a.h5", "a.vtkhdf"])
@mostly_slow("call", [3, 1, 10])
def test_a_signal_while_hdf5_writes_is_raised(name, call, raising, tmp_path, monkeypatch):
    write, read, _ = WRITERS[name]
    write(motion(401, 0.0), tmp_path / name)
    before, plain, calls = read(tmp_path / name), hdf5._Stream.write, []

    def written(self, data):
        calls.append(len(data))
        if len(calls) == call:
            signal.raise_signal(raising[0])
        return plain(self, data)

    result = motion(401, 0.25)
    write(result, tmp_path / f"other_{name}")
    monkeypatch.setattr(hdf5._Stream, "write", written)
    with pytest.raises(raising[1]):
        write(result, tmp_path / name)
    assert read(tmp_path / name) in (before, read(tmp_path / f"other_{name}"))


@pytest.mark.parametrize("name", ["a.h5", "a.vtkhdf"])
def test_what_a_write_raises_leaves_the_earlier_file(name, tmp_path, monkeypatch):
    write, read, _ = WRITERS[name]
    write(motion(401, 0.0), tmp_path / name)
    before, fails = read(tmp_path / name), []

    class Refused:
        def __new__(cls, data):
            fails.append(1)
            raise MemoryError("no room")

    monkeypatch.setattr(hdf5, "memoryview", Refused, raising=False)
    with pytest.raises(MemoryError, match="no room"):
        write(motion(401, 0.25), tmp_path / name)
    assert fails
    monkeypatch.undo()
    assert read(tmp_path / name) == before


def test_writers_work_in_other_threads(tmp_path):
    result = motion(101, 0.0)
    for name in ("a.h5", "a.vtkhdf", "a.pvd"):
        thread = threading.Thread(target=WRITERS[name][0], args=(result, tmp_path / name))
        thread.start()
        thread.join()
        assert WRITERS[name][1](tmp_path / name)
