"""A misspelt keyword of anything public is named with the right one, and nothing else changes by that."""

import inspect
import pickle
import typing

import pytest

import beamfem as bf
from beamfem.convergence.result import Convergence
from beamfem.errors import UnknownKeywordError
from beamfem.sweeps.result import Sweep

BEAM = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), bf.Rectangle(0.1, 0.1), bf.Material(1e9, 0.3, 1e3))
SOLUTION = bf.solve_static(bf.Model([BEAM], [bf.Clamp(BEAM.start)]))


def checked():
    """Return what is public and takes keywords: functions, classes, and methods of classes, by name."""
    found = {}
    for name in bf.__all__:
        item = getattr(bf, name)
        if not inspect.isclass(item):
            found[name] = item
        elif not issubclass(item, Exception) and not getattr(item, "_is_protocol", False):
            if "__init__" in vars(item):
                found[name] = item
            parts = {own: made for base in item.__mro__[::-1] for own, made in vars(base).items()}
            methods = {own: made for own, made in parts.items() if not own.startswith("_")}
            found |= {f"{name}.{own}": made for own, made in methods.items() if inspect.isfunction(made)}
    for kind in (Convergence, Sweep):
        methods = {own: made for own, made in vars(kind).items() if inspect.isfunction(made) and own[0] != "_"}
        found |= {f"{kind.__name__}.{own}": made for own, made in methods.items()}
    return found


def first_keyword(item):
    named = [each for each in inspect.signature(item).parameters.values() if each.name != "self"]
    return next((each.name for each in named if each.kind in (each.POSITIONAL_OR_KEYWORD, each.KEYWORD_ONLY)), None)


CHECKED = checked()


@pytest.mark.parametrize("name", CHECKED)
def test_a_misspelt_keyword_is_named_with_the_nearest(name):
    item, right = CHECKED[name], first_keyword(CHECKED[name])
    if name in ("sweep", "converge"):  # whose keywords are those of a function
        right = {"sweep": "executor", "converge": "until"}[name]
        with pytest.raises(bf.InputError, match=f"did you mean {right}"):
            item(lambda x: x, **({"refine": "x"} if name == "converge" else {}), x=[1], **{f"{right}_": None})
        return
    arguments = [SOLUTION] if name.startswith("Solution.") else [None] if "." in name else []
    with pytest.raises(bf.InputError) as caught:
        item(*arguments, **{f"{right}_": None} if right else {"anything": None})
    assert isinstance(caught.value, TypeError)
    title, _, last = name.rpartition(".")
    assert f"{last} has no parameter" in str(caught.value)
    defined_by = item.__qualname__.split(".")[0]  # of an object of a derived class it would be that
    assert title.split(".")[0] in str(caught.value) or defined_by in str(caught.value)
    assert (f"did you mean {right}" if right else "it takes none") in str(caught.value)


def test_the_sentence_has_all_that_is_known():
    right = "did you mean poisson_ratio? Known are youngs_modulus, poisson_ratio, density, retardation_time, "
    with pytest.raises(
        UnknownKeywordError, match="^Material has no parameter 'poison_ratio'; " + right.replace("?", r"\?")
    ):
        bf.Material(1, poison_ratio=0.3, density=1)
    with pytest.raises(UnknownKeywordError, match=r"^Section\.from_stiffness has .* did you mean axial"):
        bf.Section.from_stiffness(axail=1.0)


def test_surplus_arguments_are_counted_with_what_there_is():
    for call, said in (
        (
            lambda: bf.Interpolated((0, 0.1), (0, 1)),
            "Interpolated got 2 arguments by position, but it takes 1 at most: po",
        ),
        (
            lambda: bf.CRBF(3, None, "full", 1),
            "CRBF got 4 arguments by position, but it takes 3 at most: order, forces, ",
        ),
        (lambda: SOLUTION.energy(1, 2, 3), r"Solution\.energy got 3 arguments by position, but it takes "),
    ):
        with pytest.raises(UnknownKeywordError, match=f"^{said}"):
            call()
    with pytest.raises(UnknownKeywordError, match="has no parameter 'wrong'"):
        bf.Interpolated(1, 2, wrong=3)
    with pytest.raises(TypeError, match="multiple values") as caught:
        bf.Interpolated([(0, 0), (1, 1)], points=[(0, 0), (1, 1)])
    assert not isinstance(caught.value, bf.InputError)


def test_other_type_errors_stay_what_they_are():
    """Of a user's function inside, and of a call with too few arguments."""

    def until(state):
        return inner(wrong=state)

    def inner():
        return True

    model = bf.Model([BEAM], [bf.Clamp(BEAM.start)], [bf.PointForce(BEAM.end, (0, 1.0))])
    with pytest.raises(TypeError, match=r"inner\(\) got an unexpected keyword") as caught:
        bf.trace_equilibrium(model, until=until)
    assert not isinstance(caught.value, bf.InputError)
    with pytest.raises(TypeError, match="missing 2 required") as caught:
        bf.Material(youngs_modulus=1.0)
    assert not isinstance(caught.value, bf.InputError)


def test_what_is_checked_keeps_its_name_signature_and_place():
    for name in bf.__all__:
        item = getattr(bf, name)
        assert pickle.loads(pickle.dumps(item)) is item
    assert list(inspect.signature(bf.solve_static).parameters) == ["model", "steps", "newton", "at", "snap", "unstable"]
    assert list(inspect.signature(bf.Material).parameters)[:3] == ["youngs_modulus", "poisson_ratio", "density"]
    assert list(inspect.signature(bf.Solution.save).parameters) == ["self", "path"]
    assert typing.get_type_hints(bf.Solution.save)["return"] is type(None)
    assert bf.solve_static.__module__ == "beamfem.solve.statics.statics"


@pytest.mark.parametrize("method", [bf.Solution.plot, bf.Solution.animate, bf.Solution.to_html, bf.Solution.show])
def test_options_of_drawings_are_in_signature_and_help(method):
    listed = inspect.signature(method).parameters.values()
    assert not [each for each in listed if each.kind == each.VAR_KEYWORD]
    assert any(each.kind == each.KEYWORD_ONLY and each.default is not each.empty for each in listed)
    assert "Options" not in str(inspect.signature(method))


def test_warnings_name_the_line_that_called_the_package():
    """However deep inside the package they arise."""
    column = bf.Beam(bf.Line((0, 0), (0, 1)), 4, bf.CRBF(3), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
    loads = [bf.PointForce(column.end, (0, -1000.0))]
    with pytest.warns(bf.UnstableWarning) as caught:
        bf.solve_static(bf.Model([column], supports=[bf.Clamp(column.start)], loads=loads), steps=3)
    assert {warning.filename for warning in caught} == {__file__}
