"""Sweeps that are interrupted, killed or cannot write: what is computed is kept, and no worker stays behind."""

import signal
import subprocess
import sys
import textwrap
import time
from concurrent.futures import Executor, ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
from slow_values import mostly_slow

import beamfem as bf


def square(x):
    return x**2


def interrupts(x):
    if x == 3:
        raise KeyboardInterrupt
    return x


def test_what_an_interrupted_sweep_computed_is_kept():
    with pytest.raises(KeyboardInterrupt) as caught:
        bf.sweep(interrupts, x=[1, 2, 3, 4])
    found = caught.value.sweep
    assert found.values == (1, 2, None, None)
    assert found.computed == 2
    assert [failure.error.split(":")[0] for failure in found.failures] == ["NotComputed"] * 2
    assert "in the `sweep` of this exception" in caught.value.__notes__[0]


class Plain(ThreadPoolExecutor):
    """An executor as dask's is: its shutdown takes nothing but `wait`."""

    def __init__(self):
        super().__init__(2)

    def shutdown(self, wait=True):
        super().shutdown(wait)


def test_an_interruption_reaches_through_any_executor():
    with pytest.raises(KeyboardInterrupt) as caught:
        bf.sweep(interrupts, x=[1, 2, 3, 4], executor=Plain)
    assert caught.value.sweep.values[:2] == (1, 2)


SCRIPT = """
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)  # whoever runs the tests may ignore it
import os, sys, time
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
import beamfem as bf

def slow(x, folder):
    (Path(folder) / str(os.getpid())).touch()
    time.sleep(0.0 if x < 4 else 60.0)
    return x

if __name__ == "__main__":
    try:
        bf.sweep(slow, x=range(8), folder=sys.argv[1], executor=partial(ProcessPoolExecutor, 2))
    except KeyboardInterrupt as interrupt:
        print(interrupt.sweep.values[:4])
"""


def running(folder):
    """Return which workers are alive."""
    return [file.name for file in folder.iterdir() if alive(int(file.name))]


def alive(number):
    try:
        return Path(f"/proc/{number}/stat").read_text().split(") ")[1][0] != "Z"
    except FileNotFoundError:
        return False


@pytest.mark.slow
@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="tells processes by /proc")
@mostly_slow("how", [signal.SIGKILL, signal.SIGINT, signal.SIGTERM])
def test_a_sweep_that_is_killed_leaves_no_workers(tmp_path, how):
    (tmp_path / "pids").mkdir()
    script = tmp_path / "script.py"
    script.write_text(SCRIPT)
    command = [sys.executable, str(script), str(tmp_path / "pids")]
    sweeping = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 120.0
    while len(list((tmp_path / "pids").iterdir())) < 2:
        assert time.monotonic() < deadline
        time.sleep(0.05)
    time.sleep(1.0)
    assert len(running(tmp_path / "pids")) == 2
    sweeping.send_signal(how)
    said, _ = sweeping.communicate(timeout=30)
    deadline = time.monotonic() + 20.0
    while running(tmp_path / "pids"):
        assert time.monotonic() < deadline, running(tmp_path / "pids")
        time.sleep(0.05)
    if how is signal.SIGINT:
        assert said == "(0, 1, 2, 3)\n"


FULL = """
import resource, sys, warnings
import numpy as np
import beamfem as bf

def square(x):
    return {"square": x**2, "many": np.full(40, float(x))}

resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))
with warnings.catch_warnings(record=True) as said:
    warnings.simplefilter("always")
    found = bf.sweep(square, x=range(30), store=sys.argv[1])
print(sum(value is not None for value in found.values), [warning.category.__name__ for warning in said])
"""


def test_a_store_on_a_full_disk_does_not_end_the_sweep(tmp_path):
    pytest.importorskip("resource")
    script = tmp_path / "full.py"
    script.write_text(FULL)
    store = tmp_path / "results.jsonl"
    done = subprocess.run([sys.executable, str(script), str(store)], capture_output=True, text=True, check=False)
    assert done.stdout == "30 ['NotStoredWarning']\n", done.stderr
    # without the limit the next run finds what was written whole
    script.write_text(textwrap.dedent(FULL).replace("(3000, 3000)", "(10**6, 10**6)"))
    done = subprocess.run([sys.executable, str(script), str(store)], capture_output=True, text=True, check=False)
    assert done.stdout.startswith("30 [")


def test_a_store_that_cannot_be_opened_is_named(tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(bf.FileError, match=r"the store .* cannot be written"):
        bf.sweep(square, x=[1], store=tmp_path / "file" / "results.jsonl")


@pytest.mark.parametrize("executor", [4, "processes", lambda: 3, lambda n: n], ids=["number", "text", "none", "needs"])
def test_an_executor_that_makes_none_is_refused(executor):
    with pytest.raises(bf.InputError, match="executor must"):
        bf.sweep(square, x=[1], executor=executor)


def test_an_executor_itself_is_refused_with_what_would_be_right():
    with ThreadPoolExecutor(1) as pool, pytest.raises(bf.InputError, match=r"such as ProcessPoolExecutor or functools"):
        bf.sweep(square, x=[1], executor=pool)


@pytest.mark.slow
def test_two_sweeps_write_one_store(tmp_path):
    store = tmp_path / "shared.jsonl"
    script = tmp_path / "one.py"
    script.write_text(
        "import sys, beamfem as bf\n"
        "def square(x):\n    return x**2\n"
        "first = int(sys.argv[2])\n"
        "print(bf.sweep(square, x=range(first, first + 300), store=sys.argv[1]).computed)\n"
    )
    both = [
        subprocess.Popen([sys.executable, str(script), str(store), str(first)], stdout=subprocess.PIPE, text=True)
        for first in (0, 150)
    ]
    said = [one.communicate(timeout=60)[0] for one in both]
    # what the other one has written when one begins is found
    assert 450 <= sum(map(int, said)) <= 600
    for first in ("0", "150"):
        again = subprocess.run([sys.executable, str(script), str(store), first], capture_output=True, text=True)
        assert again.stdout == "0\n", again.stderr
    assert np.all([line.endswith("}") for line in store.read_text().splitlines()])


STORES = {"a number": 3, "bytes": b"x", "nothing": "", "a zero byte": "a\0b"}


@pytest.mark.parametrize("case", STORES)
def test_a_store_that_is_no_path_is_named(case):
    with pytest.raises(bf.InputError, match="a path is a text"):
        bf.sweep(square, x=[1], store=STORES[case])


def test_sweeps_larger_than_the_memory_are_refused_at_once():
    with pytest.raises(bf.InputError, match=r"= 1e\+12 points need .* this computer has"):
        bf.sweep(lambda x, y: x, x=range(10**6), y=range(10**6))


def refuses():
    raise OSError("no cluster")


@pytest.mark.parametrize(
    ("executor", "words"), [(refuses, "it raised OSError: no cluster"), (Executor, "takes no calls")]
)
def test_executors_that_cannot_work_are_named(executor, words):
    with pytest.raises(bf.BeamfemError, match=words):
        bf.sweep(square, x=[1], executor=executor)


def test_keep_stale_is_a_flag():
    with pytest.raises(bf.InputError, match="keep_stale must be True or False"):
        bf.sweep(square, x=[1], keep_stale="no")


def test_a_sweep_of_many_points_begins_at_once():
    """Labels were compared each with each: 10,000 points took seconds before the first call, 100,000 minutes."""
    begun = time.perf_counter()
    assert bf.sweep(square, x=range(30_000)).computed == 30_000
    assert time.perf_counter() - begun < 30.0
