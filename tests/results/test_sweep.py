"""Sweeps: every combination once, in any kind of worker, found again, and no loss by what fails or dies."""

import importlib
import os
import subprocess
import sys
import textwrap
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np
import pytest

import beamfem as bf
from beamfem.sweeps.parameters import labels
from beamfem.sweeps.result_cache import canonical, point_key

TWO_PROCESSES = partial(ProcessPoolExecutor, 2)
TWO_THREADS = partial(ThreadPoolExecutor, 2)


def product(x, y=1.0):
    return {"product": x * y, "sum": x + y}


def counted(x, folder):
    """Leave a file for each call."""
    with (Path(folder) / f"{x}").open("a") as file:
        file.write("x")
    if x == 3 and not (Path(folder) / "mended").exists():
        raise ValueError("three is refused")
    return x**2


def deadly(x):
    if x == 7:
        os._exit(3)
    return x


def blas_threads(x):
    from threadpoolctl import threadpool_info

    np.linalg.solve(np.eye(3), np.ones(3))
    return os.getpid() != x and max(library["num_threads"] for library in threadpool_info())


def calls(folder):
    return sum(len(file.read_text()) for file in folder.iterdir() if file.name.isdigit())


@pytest.mark.parametrize("executor", [None, TWO_THREADS, TWO_PROCESSES], ids=["here", "threads", "processes"])
def test_every_combination_in_order(executor):
    found = bf.sweep(product, x=[1, 2, 3], y=np.array([0.5, 4.0]), executor=executor)
    assert found.shape == (3, 2)
    assert found.parameters[1] == {"x": 1, "y": 4.0}
    np.testing.assert_array_equal(found["product"].reshape(found.shape), np.outer([1, 2, 3], [0.5, 4.0]))
    assert found.values[-1] == {"product": 12.0, "sum": 7.0}
    assert not found.failures
    assert found.computed == 6


@pytest.mark.slow
def test_processes_are_spawned_with_one_thread_each():
    assert bf.sweep(blas_threads, x=[os.getpid()], executor=TWO_PROCESSES).values == (1,)


def test_a_dead_worker_costs_one_point():
    found = bf.sweep(deadly, x=range(20), executor=TWO_PROCESSES)
    assert [value for value in found.values if value is not None] == [x for x in range(20) if x != 7]
    (failure,) = found.failures
    assert failure.parameters == {"x": 7}
    assert "WorkerDied" in str(failure)
    assert "x=7" in str(failure)
    assert np.isnan(found["deadly"][7])


@pytest.mark.slow
def test_dask_survives_a_dead_worker():
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        found = bf.sweep(deadly, x=range(20), executor=client.get_executor)
    assert [value for value in found.values if value is not None] == [x for x in range(20) if x != 7]
    assert [failure.parameters for failure in found.failures] == [{"x": 7}]


def test_store_is_used_and_failures_are_tried_again(tmp_path):
    folder, store = tmp_path / "calls", tmp_path / "new" / "store"
    folder.mkdir()
    arguments = {"x": [1, 2, 3, 4], "folder": str(folder), "store": store}
    first = bf.sweep(counted, **arguments)
    assert first.values == (1, 4, None, 16)
    assert first.failures[0].error == "ValueError: three is refused"
    assert "counted" in first.failures[0].traceback
    assert calls(folder) == 4
    second = bf.sweep(counted, **arguments)
    assert (second.values, second.computed, calls(folder)) == (first.values, 1, 5)
    (folder / "mended").touch()
    third = bf.sweep(counted, **arguments | {"x": [1, 2, 3, 4, 5]}, executor=TWO_THREADS)
    assert third.values == (1, 4, 9, 16, 25)
    assert third.computed == 2


@pytest.mark.slow
def test_store_keeps_every_kind_of_value(tmp_path):
    array = np.linspace(0.0, 1.0, 6).reshape(2, 3) / 3.0
    for value in (1, 0.1, True, float("inf"), {"data": 1.5, "array": array}, array, np.zeros((0, 2), dtype=int)):
        bf.sweep(kept, x=[1], value=[value], store=tmp_path)
        again = bf.sweep(kept, x=[1], value=[value], store=tmp_path)
        assert again.computed == 0
        np.testing.assert_equal(again.values[0], value)


def kept(x, value):
    return value


def test_what_a_function_closes_over_belongs_to_its_key(tmp_path):
    def times(factor):
        def scaled(x):
            return factor * x

        return scaled

    assert bf.sweep(times(2), x=[1], store=tmp_path).values == (2,)
    assert bf.sweep(times(3), x=[1], store=tmp_path).values == (3,)
    assert bf.sweep(times(2), x=[1], store=tmp_path).computed == 0
    with pytest.raises(bf.InputError, match="closes over"):
        bf.sweep(times(object()), x=[1], store=tmp_path)


def test_store_of_a_killed_run_is_read(tmp_path):
    """Killed hard after some points: these are found again, also behind a line that was cut off."""
    script = tmp_path / "killed.py"
    script.write_text(
        textwrap.dedent("""
        import os, signal, sys
        import beamfem as bf

        def square(x):
            if x == 5 and len(sys.argv) > 1:
                os.kill(os.getpid(), signal.SIGKILL)
            return x**2

        if __name__ == "__main__":
            found = bf.sweep(square, x=range(8), store="store.jsonl")
            print(found.computed, found["square"].tolist())
        """)
    )
    run = partial(subprocess.run, cwd=tmp_path, capture_output=True, text=True)
    assert run([sys.executable, script, "die"]).returncode == -9
    with (tmp_path / "store.jsonl").open("a") as file:
        file.write('{"key": "cut of')
    assert run([sys.executable, script]).stdout.strip() == "3 [0, 1, 4, 9, 16, 25, 36, 49]"
    done = run([sys.executable, script])
    assert done.stdout.strip() == "0 [0, 1, 4, 9, 16, 25, 36, 49]"
    assert done.stderr == ""


def test_a_changed_function_is_called_again(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    module_file = tmp_path / "changing_module.py"
    module_file.write_text("def value(x):\n    return x\n")
    module = importlib.import_module("changing_module")
    assert bf.sweep(module.value, x=[1, 2], store=tmp_path / "s").values == (1, 2)
    module_file.write_text("def value(x):\n    return x + 10\n")
    importlib.invalidate_caches()
    sys.modules.pop("changing_module")
    module = importlib.import_module("changing_module")
    with pytest.warns(bf.ChangedCodeWarning, match="changing_module"):
        assert bf.sweep(module.value, x=[1, 2], store=tmp_path / "s").values == (11, 12)


def test_keys_tell_values_apart():
    values = [1, 1.0, True, "1", None, "None", (1,), (1, 2), [(1, 2)], 0.1, np.float32(0.1), np.array([1, 2])]
    values += [np.array([1.0, 2.0]), np.array([[1, 2]]), {"a": 1}, Path("1"), product, blas_threads]
    values += [lambda x: x, lambda x: 2 * x, lambda x, y=1: x]
    values += [bf.ANCF(), bf.ANCFCRBF(), bf.ANCF(bf.ContinuumMechanics(True)), bf.CRBF(1), bf.CRBF(2)]
    values += [bf.Rectangle(0.1, 0.2), bf.Rectangle(0.2, 0.1), partial(product, 1), partial(product, 2)]
    forms = [str(canonical(value, "x")) for value in values]
    assert len(set(forms)) == len(forms)
    assert canonical(np.float64(0.1), "x") == canonical(0.1, "x")
    assert canonical(np.int32(3), "x") == canonical(3, "x")
    assert canonical(np.array([1.0, 2.0], dtype=">f8"), "x") == canonical(np.array([1.0, 2.0]), "x")
    assert canonical(bf.CRBF(2), "x") == canonical(bf.CRBF(order=2), "x")


def test_keys_are_the_same_in_another_process():
    code = "import beamfem as bf; from beamfem.sweeps.result_cache import point_key; "
    code += "print(point_key('f', {'b': bf.CRBF(2), 'a': {'z': 0.1, 'y': (1, 'x')}}))"
    there = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip()
    assert there == point_key("f", {"a": {"y": (1, "x"), "z": 0.1}, "b": bf.CRBF(2)})


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ({"x": []}, "x must have at least one value"),
        ({"z": [1]}, "cannot be called with z"),
        ({"x": [object()], "store": "unused"}, "x is a object, which cannot be stored"),
        ({"x": [np.array([None])], "store": "unused"}, "array of objects"),
        ({"x": [1], "executor": dict}, r"must make a concurrent\.futures\.Executor"),
    ],
)
def test_bad_input_is_refused_before_any_call(parameters, message, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(bf.InputError, match=message):
        bf.sweep(product, **parameters)
    assert not list(tmp_path.iterdir())


def test_a_function_that_processes_cannot_import():
    with pytest.raises(bf.InputError, match="define it with def at the top level of a module"):
        bf.sweep(lambda x: x, x=[1], executor=TWO_PROCESSES)


def test_a_script_without_guard_is_told_so(tmp_path):
    script = tmp_path / "unguarded.py"
    script.write_text(
        "from concurrent.futures import ProcessPoolExecutor\nimport beamfem as bf\n"
        "def f(x):\n    return x\nbf.sweep(f, x=[1, 2], executor=ProcessPoolExecutor)\n"
    )
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=60)
    assert done.returncode != 0
    assert 'must stand below `if __name__ == "__main__":`' in done.stderr


def test_what_is_no_number_is_a_failure():
    found = bf.sweep(kept, x=1, value=["text", None, 2.0, {}])
    assert found.values == (None, None, 2.0, None)
    assert all("must return a number" in failure.error for failure in found.failures)


def test_table_csv_and_markdown(tmp_path):
    found = bf.sweep(product, x=[1, 2], y=[1 / 3])
    assert found.table()[1] == {"x": 2, "y": 1 / 3, "product": 2 / 3, "sum": 2 + 1 / 3, "seconds": found.seconds[1]}
    found.to_csv(tmp_path / "new" / "table.csv")
    lines = (tmp_path / "new" / "table.csv").read_text().splitlines()
    assert lines[0] == "x,y,product,sum,seconds"
    assert lines[2].startswith(f"2,{1 / 3!r},{2 / 3!r},")
    assert found.to_markdown().splitlines()[0].replace(" ", "") == "|x|y|product|sum|seconds|"
    assert "2 points, 2 computed now, 0 failed" in str(found)
    with pytest.raises(bf.InputError, match="no 'missing'; known are x, y, product"):
        found["missing"]


def test_a_value_called_like_a_parameter():
    assert bf.sweep(same_name, x=[1])["x (result)"] == [2]


def same_name(x):
    return {"x": 2 * x}


def test_labels_tell_elements_apart():
    continuum, plane = bf.ContinuumMechanics(), bf.ContinuumMechanics(True)
    assert labels([bf.CRBF(1), bf.CRBF(2)]) == ("CRBF-1", "CRBF-2")
    assert labels([bf.CRBF(2, bf.ContinuumMechanics()), bf.CRBF(2)]) == ("CRBF-2 (continuum)", "CRBF-2 (structural)")
    assert labels([bf.ANCF(bf.Structural()), bf.ANCF()]) == ("ANCF (structural, lobatto)", "ANCF (continuum, full)")
    assert labels([bf.ANCF(continuum), bf.ANCF(plane)]) == (
        "ANCF (continuum (plane_stress=False))",
        "ANCF (continuum (plane_stress=True))",
    )
    assert labels([1, 1, 0.25]) == ("1 #1", "1 #2", "0.25")
