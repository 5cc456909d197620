"""What the compiler of kernels does not know, or what Python would do otherwise, is refused with its line."""

import importlib

import numpy as np
import pytest

from beamfem.kernels.compiling import inlined, routine


@routine("ir", "d")
def added(n, values):
    total = 0.0
    for i in range(n):
        total += values[i]
    return total


def unknown_function(n, x):
    return sorted(x)


def not_a_name(n, x):
    return missing + n  # noqa: F821


def kind_in_a_loop(n, x):
    total = 0
    for i in range(n):
        total = total + x[i]
    return total


def number_as_place(n, x):
    return x[0.5]


def entries_of_a_number(n, x):
    return n[0]


def step_of_unknown_size(n, x):
    for i in range(0, 8, n):
        x[i] = 0.0
    return 0


def too_few(n, x):
    a, b, c = n, n
    return a + b + c


def chained(n, x):
    with x:
        return n


def other_counts(n, x):
    if n > 0:
        return n, n
    return n


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (unknown_function, "sorted.* cannot be called"),
        (not_a_name, "missing is not known"),
        (kind_in_a_loop, "total is a whole number and cannot become a number"),
        (number_as_place, "a number is no place"),
        (entries_of_a_number, "a whole number has no entries"),
        (step_of_unknown_size, "the step of a range"),
        (too_few, "2 values for 3 names"),
        (chained, "with x: is not known"),
        (other_counts, "as many values"),
    ],
)
def test_what_is_not_known_is_named_with_its_line(function, words):
    with pytest.raises(TypeError, match=words) as caught:
        _ = routine("ir", "i")(function).address
    assert any(f"{__file__}, line " in note for note in caught.value.__notes__)
    line = int(caught.value.__notes__[0].rsplit(" ", 1)[1])
    assert function.__code__.co_firstlineno < line <= function.__code__.co_firstlineno + 3


def test_a_function_without_a_text_is_named():
    space = {"__name__": "somewhere"}
    exec("def nowhere(n):\n    return n\n", space)
    with pytest.raises(TypeError, match="the text of nowhere is not in"):
        _ = routine("i", "i")(space["nowhere"]).address


def test_arrays_of_other_numbers_are_refused():
    with pytest.raises(TypeError, match="contiguous float64, got float32"):
        added(2, np.ones(2, dtype=np.float32))
    with pytest.raises(TypeError, match="contiguous float64"):
        added(2, np.ones((2, 2))[:, 0])


def perhaps_nothing(n, x):
    if n > 5:
        q = 1
    return q


def after_an_empty_loop(n, x):
    for i in range(n):
        x[i] = 0.0
    return i


def no_value_at_the_end(n, x):
    if n > 0:
        return 1


def value_after_none(n, x):
    if n < 0:
        return
    return n


total = 100


def own_name_of_the_module(n, x):
    x[0] = total  # noqa: F823
    if n > 5:
        total = 1  # noqa: F841
    return 0


def whole_numbers_joined(n, x):
    return n or 7


def range_of_four(n, x):
    for i in range(0, n, 1, 5):
        x[i] = 0.0
    return 0


def in_nothing(n, x):
    return n in ()  # noqa: RUF060


@inlined
def with_default(a, b=3):
    return a + b


def call_with_default(n, x):
    return with_default(n)


@inlined
def of_itself(n):
    return of_itself(n)


def endless_calls(n, x):
    return of_itself(n)


def index_from_the_end(n, x):
    return x[-1]


def set_from_the_end(n, x):
    x[-2] = 0.0
    return 0


def add_from_the_end(n, x):
    x[-2] += 1.0
    return 0


def power_of_whole_numbers(n, x):
    return n**3


def chained_with_an_entry(n, x):
    return 0 < n < x[n]


def chained_with_a_call(n, x):
    return 0 < n < of_itself(n)


def chained_with_a_division(n, x):
    return 0 < n < 7 // n


NOT_A_NUMBER = float("nan")


def int_of_no_number(n, x):
    return int(NOT_A_NUMBER)


def division_by_zero(n, x):
    return n % 0


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (index_from_the_end, r"\[-1\]: compiled code does not count from the end"),
        (set_from_the_end, r"\[-2\]: compiled code does not count from the end"),
        (add_from_the_end, r"\[-2\]: compiled code does not count from the end"),
        (power_of_whole_numbers, r"a power of whole numbers .* write x \* x or 2\.0\*\*n"),
        (chained_with_an_entry, r"x\[n\] is computed in any case here"),
        (chained_with_a_call, r"of_itself\(n\) is computed in any case here"),
        (chained_with_a_division, "7 // n is computed in any case here"),
        (int_of_no_number, "nan is no whole number of 64 bits"),
        (division_by_zero, "division by zero"),
        (perhaps_nothing, "q may have no value here"),
        (after_an_empty_loop, "i may have no value here"),
        (no_value_at_the_end, "returns a value, but not where it ends"),
        (value_after_none, "as many values everywhere"),
        (own_name_of_the_module, "total is not known"),
        (whole_numbers_joined, "and, or join conditions, and n is a whole number"),
        (range_of_four, "is not known to compiled code"),
        (in_nothing, r"n in \(\)"),
        (call_with_default, "parameters without defaults"),
        (endless_calls, "RecursionError"),
    ],
)
def test_what_python_would_do_otherwise_is_refused(function, words):
    with pytest.raises(TypeError, match=words):
        _ = routine("ir", "i")(function).address


def test_a_module_that_is_loaded_again_is_compiled_again(tmp_path, monkeypatch):
    """Its old text was found in memory."""
    monkeypatch.syspath_prepend(tmp_path)
    text = "from beamfem.kernels.compiling import routine\n\n@routine('d', 'd')\ndef times(x):\n    return {} * x\n"
    (tmp_path / "loaded_again.py").write_text(text.format("2.0"))
    module = importlib.import_module("loaded_again")
    assert module.times(1.0) == 2.0
    (tmp_path / "loaded_again.py").write_text(text.format("33.0"))
    importlib.invalidate_caches()
    old = module.times
    module = importlib.reload(module)
    assert (module.times(1.0), old(1.0)) == (33.0, 2.0)


def test_a_text_that_has_changed_is_not_taken_for_the_function(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    file = tmp_path / "changed_meanwhile.py"
    text = "from beamfem.kernels.compiling import routine\n\n@routine('d', 'd')\ndef times(x):\n    return {} * x\n"
    file.write_text(text.format("2.0"))
    module = importlib.import_module("changed_meanwhile")
    file.write_text(text.format("33.0"))
    with pytest.raises(TypeError, match="has been changed since it was imported"):
        module.times(1.0)
