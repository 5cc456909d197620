"""Docstrings of the public names: every parameter is described, and every example runs and gives what it shows."""

import doctest
import inspect
import re
from collections.abc import Iterator
from typing import Any

import matplotlib
import pytest

import beamfem as bf
import beamfem.testing
from beamfem.convergence.convergence_result import Convergence
from beamfem.section.protocol import CrossSection, HasParts
from beamfem.sweeps.sweep import Sweep

RETURNED = {"Convergence": Convergence, "Sweep": Sweep}  # by public functions
EXTENDED = {"CrossSection": CrossSection, "HasParts": HasParts}  # by user-defined sections, see docs/extending.md
CHECKS = {name: getattr(beamfem.testing, name) for name in beamfem.testing.__all__}


def public() -> dict[str, Any]:
    """Return the public functions and classes, and the public methods of classes, by name."""
    found: dict[str, Any] = {}
    for name, thing in ({name: getattr(bf, name) for name in bf.__all__} | RETURNED | EXTENDED | CHECKS).items():
        found[name] = thing
        if inspect.isclass(thing) and not issubclass(thing, Exception):
            methods = inspect.getmembers(thing, lambda own: inspect.isfunction(own) or isinstance(own, property))
            for own, method in methods:
                documented = method.fget if isinstance(method, property) else method
                if not own.startswith("_") and (documented.__module__ or "").startswith("beamfem."):
                    found[f"{name}.{own}"] = documented
    return found


PUBLIC = public()
# classes whose signature is their own, and functions
DESCRIBED = [
    name
    for name, thing in PUBLIC.items()
    if "." not in name
    and (inspect.isfunction(thing) or not getattr(thing, "_is_protocol", False))
    and (not inspect.isclass(thing) or issubclass(thing, bf.ConvergenceError) or not issubclass(thing, Exception))
    and thing is not bf.Status
]


def sections(docstring: str) -> dict[str, list[str]]:
    """Return the lines of each section by its title, those before the first one by ""."""
    lines = inspect.cleandoc(docstring).split("\n")
    found: dict[str, list[str]] = {"": []}
    title = ""
    for line, below in zip(lines, [*lines[1:], ""], strict=True):
        if re.fullmatch(r"-{3,}", below) and len(below) == len(line):
            title = line
            found[title] = []
        elif not re.fullmatch(r"-{3,}", line):
            found[title].append(line)
    return found


def described(lines: list[str]) -> Iterator[str]:
    """Yield the names that a section describes."""
    for line in lines:
        if line and not line.startswith(" "):
            yield from (name.strip(" *") for name in line.partition(" : ")[0].split(","))


def taken(thing: Any) -> list[str]:
    """Return the parameters of a function or class; constants of the code come after them and are left out."""
    try:
        parameters = inspect.signature(thing).parameters
    except ValueError:  # of abstract classes
        return []
    return [name for name in parameters if name not in ("self", "cls", "args", "kwargs")]


# methods, as the getters of properties take self only
WITH_PARAMETERS = [name for name, thing in PUBLIC.items() if "." in name and taken(thing)]


@pytest.mark.parametrize("name", DESCRIBED)
def test_every_parameter_is_described_and_no_other(name):
    thing = PUBLIC[name]
    found = sections(thing.__doc__)
    assert sorted(described(found.get("Parameters", []))) == sorted(taken(thing))
    if inspect.isfunction(thing):
        assert {"Raises", "Examples"} <= set(found) if name in CHECKS else "Examples" in found


@pytest.mark.parametrize("name", WITH_PARAMETERS)
def test_a_method_that_describes_parameters_describes_all_of_them(name):
    found = sections(PUBLIC[name].__doc__ or "")
    if "Parameters" in found:
        assert sorted(described(found["Parameters"])) == sorted(taken(PUBLIC[name]))


@pytest.mark.parametrize("name", [name for name in PUBLIC if "." in name])
def test_methods_and_properties_have_docstrings(name):
    """Their own, or that of the base class."""
    kind, own = name.split(".")
    assert inspect.getdoc(getattr(PUBLIC[kind], own))


@pytest.mark.parametrize("name", PUBLIC)
def test_summaries_are_one_sentence_in_the_first_line(name):
    docstring = PUBLIC[name].__doc__
    if docstring is not None and "Parameters" in sections(docstring):
        assert sections(docstring)[""][0].rstrip().endswith((".", "`."))


@pytest.fixture(scope="session")
def names() -> dict[str, Any]:
    """Return what the examples of the package leave: a cantilever and its solution."""
    runner = doctest.DocTestRunner()
    example = doctest.DocTestParser().get_doctest(bf.__doc__, {}, "beamfem", None, 0)
    assert runner.run(example, clear_globs=False).failed == 0
    return example.globs


@pytest.mark.parametrize("name", [name for name, thing in PUBLIC.items() if ">>> " in (thing.__doc__ or "")])
def test_examples_give_what_they_show(name, names, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    matplotlib.use("Agg")
    told: list[str] = []
    example = doctest.DocTestParser().get_doctest(PUBLIC[name].__doc__, dict(names), name, None, 0)
    doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(example, out=told.append)
    assert not told, "".join(told)


@pytest.mark.parametrize("name", [name for name in DESCRIBED if hasattr(bf, name)])
def test_errors_about_arguments_start_with_the_public_name(name):
    with pytest.raises((TypeError, bf.InputError)) as caught:
        getattr(bf, name)(no_such_argument=1)
    assert isinstance(caught.value, bf.InputError) or str(caught.value).startswith(f"{name}() ")
