"""Stored results of a sweep and the code that computed them: what counts as changed, and what is said of it."""

import importlib
import shutil
import subprocess
import sys
import textwrap
from contextlib import nullcontext
from functools import partial

import pytest

import beamfem as bf
from beamfem.sweeps.result_cache import code_digests

SCRIPT = """
import importlib
import beamfem as bf
import helper

E = 2e11
TABLE = {"factor": 1.0}

def inertia(height):
    import late
    return late.factor * importlib.import_module("named").factor * 0.1 * height**3 / 12

def stiffness(height):
    return helper.scale * TABLE["factor"] * E * inertia(height)

if __name__ == "__main__":
    found = bf.sweep(stiffness, height=[0.1, 0.2], store="store")
    print(found.computed, found["stiffness"].tolist())
"""


def run_script(folder, *changes, **files):
    """Run the script with changes (old, new) to it and its files; return points computed, value over first, stderr."""
    text = SCRIPT
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (folder / "study.py").write_text(text)
    for name, content in files.items():
        (folder / f"{name}.py").write_text(content)
    done = subprocess.run([sys.executable, "-B", "study.py"], cwd=folder, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    computed, values = done.stdout.split(" ", 1)
    first = float(values.strip("[]\n").split(",")[0])
    return int(computed), first / (2e11 * 0.1**4 / 12), done.stderr


@pytest.fixture(scope="module")
def once(tmp_path_factory):
    """The script after its first run."""
    folder = tmp_path_factory.mktemp("script")
    helper = "from deep import factor\nscale = factor\n"
    ones = dict.fromkeys(("deep", "late", "named"), "factor = 1.0\n")
    assert run_script(folder, helper=helper, **ones) == (2, pytest.approx(1.0), "")
    return folder


@pytest.fixture
def script(once, tmp_path):
    """Run the script again, in a copy of its folder."""
    return partial(run_script, shutil.copytree(once, tmp_path / "copy"))


@pytest.mark.slow
def test_a_changed_constant_of_the_script_is_computed_again(script):
    """The values of E I, by hand: E from 2e11 to 7e10 takes them to 0.35 of what they were."""
    assert script() == (0, pytest.approx(1.0), "")
    computed, value, said = script(("E = 2e11", "E = 7e10"))
    assert (computed, value) == (2, pytest.approx(0.35))
    assert "ChangedCodeWarning: 2 of 2 points in the store were computed before study.py changed" in said
    # both are kept
    assert script() == (0, pytest.approx(1.0), "")
    assert script(("E = 2e11", "E = 7e10")) == (0, pytest.approx(0.35), "")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("changes", "files", "factor", "names"),
    [
        ([("/ 12", "/ 6")], {}, 2.0, "study.py"),
        ([("def inertia", 'TABLE["factor"] = 3.0\ndef inertia')], {}, 3.0, "study.py"),
        ([("def inertia", "helper.scale = 5.0\ndef inertia")], {}, 5.0, "study.py"),
        ([], {"helper": "from deep import factor\nscale = 4.0\n"}, 4.0, "helper"),
        ([], {"deep": "factor = 6.0\n"}, 6.0, "deep"),
        ([], {"late": "factor = 7.0\n"}, 7.0, "late"),
        ([], {"named": "factor = 8.0\n"}, 8.0, "named"),
    ],
    ids=[
        "a function it calls",
        "a member of a table",
        "a member of a module",
        "another file",
        "a file behind that one",
        "a file that the function imports",
        "a file that the function imports by its name",
    ],
)
def test_any_edit_of_a_module_of_the_user_computes_again(script, changes, files, factor, names):
    computed, value, said = script(*changes, **files)
    assert (computed, value) == (2, pytest.approx(factor))
    assert f"2 of 2 points in the store were computed before {names} changed" in said


def test_comments_do_not_count(script):
    assert script(("E = 2e11", "E = 2e11  # Pa")) == (0, pytest.approx(1.0), "")


def test_what_a_lambda_closes_over_counts(tmp_path):
    """Also its defaults, and its code where several of them are in one line."""

    def times(factor):
        return lambda x, more=factor / 10: (factor + more) * x

    def found(function):
        result = bf.sweep(function, x=[1.0], store=tmp_path / "s")
        return result.computed, result.values[0]

    assert [found(times(2.0)), found(times(3.0)), found(times(2.0))] == [(1, 2.2), (1, 3.3), (0, 2.2)]
    assert [found(function) for function in (lambda x: x + 1.0, lambda x: x + 2.0)] == [(1, 2.0), (1, 3.0)]


def same(x):
    return x


@pytest.mark.slow
def test_another_version_of_beamfem_computes_again(tmp_path, monkeypatch):
    assert bf.sweep(same, x=[1.0], store=tmp_path / "s").computed == 1
    assert bf.sweep(same, x=[1.0], store=tmp_path / "s").computed == 0
    monkeypatch.setattr(bf, "__version__", "99.0")
    with pytest.warns(bf.ChangedCodeWarning, match="1 of 1 points in the store were computed before beamfem changed"):
        assert bf.sweep(same, x=[1.0], store=tmp_path / "s").computed == 1


def test_a_module_edited_in_a_running_process_counts_once_it_is_reloaded(tmp_path, monkeypatch):
    """Until then its old code runs, and what that computes is not returned to the new one."""
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    module = loaded(tmp_path, edited_module="def value(x):\n    return x\n")
    assert bf.sweep(module.value, x=[1], store=tmp_path / "s").values == (1,)
    (tmp_path / "edited_module.py").write_text("def value(x):\n    return 10 * x\n")
    assert bf.sweep(module.value, x=[1, 2], store=tmp_path / "s").values == (1, 2)
    importlib.reload(module)
    with pytest.warns(bf.ChangedCodeWarning, match="2 of 2 points"):
        assert bf.sweep(module.value, x=[1, 2], store=tmp_path / "s").values == (10, 20)


def test_old_results_are_kept_where_that_is_asked(script):
    keep = ("store=", "keep_stale=True, store=")
    computed, value, said = script(("E = 2e11", "E = 7e10"), keep)
    assert (computed, value) == (0, pytest.approx(1.0))
    assert "the old results are kept" in said


def loaded(folder, **files):
    """Import the first of some modules anew."""
    for name, text in files.items():
        (folder / f"{name}.py").write_text(textwrap.dedent(text))
    importlib.invalidate_caches()
    for name in files:
        sys.modules.pop(name, None)
    return importlib.import_module(next(iter(files)))


def test_a_changed_function_in_a_module_is_called_again(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    module = loaded(tmp_path, changing_module="def value(x):\n    return x\n")
    assert bf.sweep(module.value, x=[1, 2], store=tmp_path / "s").values == (1, 2)
    module = loaded(tmp_path, changing_module="def value(x):\n    return x + 10\n")
    with pytest.warns(bf.ChangedCodeWarning, match="2 of 3 points in the store were computed before changing_module"):
        assert bf.sweep(module.value, x=[1, 2, 3], store=tmp_path / "s").values == (11, 12, 13)


def test_what_parameters_bring_along_counts(tmp_path, monkeypatch):
    """A dataclass with a method and a function, each from a file of its own, one imported only when it is called."""
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    shapes = "from dataclasses import dataclass\n@dataclass(frozen=True)\nclass Square:\n    a: float\n"
    shapes += "    def area(self):\n        return self.a**2\n"
    lazy = "def twice(x):\n    import behind_lazy\n    return behind_lazy.two * x\n"
    main = "def area(shape, by):\n    return by(shape.area())\n"
    loaded(tmp_path, behind_lazy="two = 2\n")
    module, shape, by = (
        loaded(tmp_path, **{name: text})
        for name, text in (("asked_module", main), ("shapes_module", shapes), ("lazy_module", lazy))
    )
    arguments = {"shape": shape.Square(3.0), "by": by.twice, "store": tmp_path / "s"}
    assert bf.sweep(module.area, **arguments).values == (18.0,)
    assert bf.sweep(module.area, **arguments).computed == 0
    loaded(tmp_path, behind_lazy="two = 20\n")
    with pytest.warns(bf.ChangedCodeWarning, match="before behind_lazy changed"):
        assert bf.sweep(module.area, **arguments).values == (180.0,)
    shape = loaded(tmp_path, shapes_module=shapes.replace("self.a**2", "self.a"))
    with pytest.warns(bf.ChangedCodeWarning, match="before shapes_module changed"):
        assert bf.sweep(module.area, **arguments | {"shape": shape.Square(3.0)}).values == (60.0,)


def test_the_value_behind_a_member_of_an_enum_counts(tmp_path, monkeypatch):
    """It is a parameter by its name."""
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    text = "from enum import Enum\nclass Grade(Enum):\n    SOFT = 2\n"
    main = loaded(tmp_path, graded_module="def value(grade):\n    return grade.value\n")
    for content, expected in ((text, 2), (text.replace("2", "3"), 3)):
        grades = loaded(tmp_path, grades_module=content)
        expectation = nullcontext() if expected == 2 else pytest.warns(bf.ChangedCodeWarning, match="grades_module")
        with expectation:
            assert bf.sweep(main.value, grade=grades.Grade.SOFT, store=tmp_path / "s").values == (expected,)


def test_packages_with_relative_imports(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    package = tmp_path / "own_package"
    package.mkdir()
    (package / "__init__.py").write_text("")
    (package / "data.py").write_text("k = 2\n")
    (package / "run.py").write_text("from . import data\ndef value(x):\n    return data.k * x\n")
    module = importlib.import_module("own_package.run")
    assert bf.sweep(module.value, x=[1], store=tmp_path / "s").values == (2,)
    (package / "data.py").write_text("k = 5\n")
    importlib.reload(sys.modules["own_package.data"])
    with pytest.warns(bf.ChangedCodeWarning, match=r"before own_package\.data changed"):
        assert bf.sweep(module.value, x=[1], store=tmp_path / "s").values == (5,)


def test_a_cell_of_a_notebook(tmp_path):
    """Code without a file: its source and the values that it takes from other cells."""
    cells = """
        import linecache, sys, warnings
        import beamfem as bf
        sys.modules["__main__"].__dict__.pop("__file__", None)
        warnings.simplefilter("always")

        def cell(text, number):
            name = f"<cell {number}>"
            linecache.cache[name] = (len(text), None, text.splitlines(True), name)
            exec(compile(text, name, "exec"), globals())

        cell("E = 2.0\\ndef helped(x):\\n    return E * x\\n", 1)
        cell("def value(x):\\n    return helped(x)\\n", 2)
        def run():
            found = bf.sweep(value, x=[1.0], store="s")
            print(found.computed, found.values)
        run(), run()
        E = 3.0
        run()
        cell("def helped(x):\\n    return 2.0 * E * x\\n", 3)
        run()
    """
    script = tmp_path / "cells.py"
    script.write_text(textwrap.dedent(cells))
    done = subprocess.run([sys.executable, script], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert done.stdout.splitlines() == ["1 (2.0,)", "0 (2.0,)", "1 (3.0,)", "1 (6.0,)"], done.stderr


def test_only_files_of_the_user_are_looked_at():
    digests = code_digests()
    assert {"beamfem", __name__} <= set(digests)
    assert not [name for name in digests if name.split(".")[0] in ("numpy", "pytest", "ast") or name[:8] == "beamfem."]


def test_of_several_older_results_the_one_written_last_is_kept(tmp_path, monkeypatch):
    """Version 1, then 2, then 1 again, computed anew after its first result was lost: version 3 gets the last."""
    store = tmp_path / "results.jsonl"
    for version in ("1", "2"):
        monkeypatch.setattr(bf, "__version__", version)
        with nullcontext() if version == "1" else pytest.warns(bf.ChangedCodeWarning):
            bf.sweep(same, x=[1.0], store=store)
    first = next(line for line in store.read_text().splitlines() if '"value"' in line)
    with store.open("a") as file:
        file.write(first.replace("[1.0]", "[3.0]") + "\n")
    monkeypatch.setattr(bf, "__version__", "3")
    with pytest.warns(bf.ChangedCodeWarning, match="the old results are kept"):
        assert bf.sweep(same, x=[1.0], store=store, keep_stale=True).values == (3.0,)


LAST = 2.0


def scaled(load):
    return LAST * load


def test_another_value_of_a_global_variable_computes_again(tmp_path, monkeypatch):
    """No file had changed, so the results of the old value were returned."""
    store = tmp_path / "store.jsonl"
    assert bf.sweep(scaled, load=[1.0, 3.0], store=store)["scaled"].tolist() == [2.0, 6.0]
    monkeypatch.setattr(sys.modules[__name__], "LAST", 5.0)
    with pytest.warns(bf.ChangedCodeWarning, match="LAST of test_sweep_code changed"):
        assert bf.sweep(scaled, load=[1.0, 3.0], store=store)["scaled"].tolist() == [5.0, 15.0]
    monkeypatch.undo()
    assert bf.sweep(scaled, load=[1.0, 3.0], store=store).computed == 0
