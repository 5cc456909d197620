"""States and solutions made by hand are asked whether they fit their model, before a solve starts from them."""

from dataclasses import replace

import numpy as np
import pytest
from bad_inputs import BEAM, CANTILEVER, END, INF, NAN, a_beam, require_named

import beamfem as bf
from beamfem.linalg.eigenpairs import digits_for
from beamfem.linalg.lapack import LinAlgError, eigh, solve_banded

BAD = bf.InputError
OTHER = bf.Model([a_beam(elements=5)])
COLUMN = bf.Model([BEAM], [bf.Clamp(BEAM.start)], [bf.PointForce(END, (-1.0, 0.0))])
GRADIENTS = bf.Model([a_beam(element=bf.ANCF())])


@pytest.fixture(scope="module")
def solution():
    return bf.solve_static(CANTILEVER)


SHAPES = {
    "short p": ({"p": np.zeros(3)}, r"p of State must be an array \(15,\) of numbers, .* got shape \(3,\)"),
    "p of rows": ({"p": np.zeros((1, 15))}, "p of State must be an array"),
    "p as text": ({"p": "abc"}, "p of State must be an array"),
    "no p": ({"p": None}, "p of State must be an array"),
    "complex p": ({"p": np.zeros(15, complex)}, "p of State must be an array"),
    "ragged p": ({"p": [[0.0], [1.0, 2.0]]}, "p of State must be an array"),
    "short v": ({"v": np.zeros(3)}, "v of State must be an array"),
    "no v": ({"v": None}, "v of State must be an array"),
    "short a": ({"a": np.zeros(3)}, "a of State must be an array"),
    "truth values for a": ({"a": np.zeros(15, bool)}, "a of State must be an array"),
    "at as text": ({"at": "1"}, "at of State must be a number"),
    "at as nan": ({"at": NAN}, "at of State must be finite"),
    "no model": ({"model": None}, "model of State must be the Model"),
    "a class for a model": ({"model": bf.Model}, "model of State must be the Model"),
    "another model": ({"model": OTHER}, r"p of State must be an array \(33,\)"),
    "turned of no beam": ({"turned": np.zeros(2)}, r"turned of State must be an array \(0,\)"),
}


@pytest.mark.parametrize("case", SHAPES)
def test_states_that_do_not_fit_their_model_are_named(case, solution):
    changes, words = SHAPES[case]
    require_named(lambda: replace(solution[-1], **changes), BAD, words)


VERBS = {
    "start": lambda state: bf.simulate(CANTILEVER, 0.002, 0.001, start=state),
    "start of another model": lambda state: bf.simulate(bf.Model([BEAM]), 0.002, 0.001, start=state),
    "about of modes": lambda state: bf.solve_modes(CANTILEVER, 1, about=state),
    "about of buckling": lambda state: bf.solve_buckling(COLUMN, 1, about=state),
}


@pytest.mark.parametrize("verb", VERBS)
@pytest.mark.parametrize("part", ["p", "v", "a"])
@pytest.mark.parametrize("value", [NAN, INF])
def test_states_that_are_not_finite_are_named_before_a_solve(verb, part, value, solution):
    state = replace(solution[-1], **{part: np.full(15, value)})
    require_named(lambda: VERBS[verb](state), BAD, f"{part} of {verb.split()[0]} must be finite")


ROWS = {
    "fewer rows of p": ({"p": np.zeros((1, 15))}, r"p of Solution must be an array \(2, 15\)"),
    "p without rows": ({"p": np.zeros(15)}, "p of Solution must be an array"),
    "p of nan": ({"p": np.full((2, 15), NAN)}, "p of Solution must be finite"),
    "no v": ({"v": None}, "v of Solution must be an array"),
    "short a": ({"a": np.zeros((2, 3))}, "a of Solution must be an array"),
    "more load factors": ({"at": np.arange(5.0)}, r"p of Solution must be an array \(5, 15\)"),
    "load factors of nan": ({"at": np.full(2, NAN)}, "at of Solution must be finite"),
    "load factors as text": ({"at": "ab"}, "at of Solution must be a list"),
    "one load factor": ({"at": 1.0}, "at of Solution must be a list"),
    "static by words": ({"static": "yes"}, "static of Solution must be True or False"),
    "no model": ({"model": None}, "model of Solution must be the Model"),
    "stability of one row": ({"stability": np.array([True])}, r"stability of Solution must be an array \(2,\)"),
    "stability as numbers": ({"stability": np.ones(2)}, "truth values"),
    "turned of no beam": ({"turned": np.zeros((2, 9))}, r"turned of Solution must be an array \(2, 0\)"),
    "loads of one row": ({"loaded": np.zeros(1)}, r"loaded of Solution must be an array \(2,\)"),
}


@pytest.mark.parametrize("case", ROWS)
def test_solutions_that_do_not_fit_their_model_are_named(case, solution):
    changes, words = ROWS[case]
    require_named(lambda: replace(solution, **changes), BAD, words)


def test_a_bifurcation_has_directions_of_its_model():
    rest = np.zeros(COLUMN.size)
    parts = {"p": rest, "v": rest, "a": rest, "at": 1.0, "model": COLUMN, "mode": rest, "tangent": np.zeros(16)}
    bf.Bifurcation(**parts)
    require_named(lambda: bf.Bifurcation(**parts | {"mode": rest[1:]}), BAD, "mode of Bifurcation must be an array")
    require_named(lambda: bf.Bifurcation(**parts | {"tangent": rest}), BAD, r"tangent of .* an array \(16,\)")
    require_named(lambda: bf.Bifurcation(**parts | {"mode": rest + NAN}), BAD, "mode of Bifurcation must be finite")


def test_an_empty_solution_is_no_state_to_start_from(solution):
    empty = replace(solution, at=solution.at[:0], p=solution.p[:0], v=solution.v[:0], a=solution.a[:0], stability=None)
    require_named(lambda: bf.solve_modes(CANTILEVER, 1, about=empty), BAD, "has no rows")


def test_states_of_lists_and_of_other_real_types_are_taken(solution):
    last = solution[-1]
    same = replace(last, p=last.p.tolist(), v=np.zeros(15, int), at=np.float32(1.0))
    assert (same.p.dtype, same.v.dtype, type(same.at)) == (np.float64, np.float64, float)
    np.testing.assert_array_equal(same.p, last.p)
    moved = bf.simulate(CANTILEVER, 0.002, 0.001, start=same)
    np.testing.assert_array_equal(moved.p, bf.simulate(CANTILEVER, 0.002, 0.001, start=last).p)


def test_lost_digits_are_told_from_mistakes_of_ours():
    """scipy raises a ValueError for numbers that are not finite, and for matrices of a wrong shape."""
    with pytest.raises(bf.ConvergenceError, match="modes of this model cannot be found"), digits_for("modes"):
        eigh(np.array([[NAN, 0.0], [0.0, 1.0]]))
    with pytest.raises(LinAlgError, match="not finite"):
        solve_banded((0, 0), np.array([[1.0, INF]]), np.ones(2))
    with pytest.raises(ValueError, match="square") as caught, digits_for("modes"):
        eigh(np.ones((2, 3)))
    assert not isinstance(caught.value, bf.BeamfemError)


@pytest.mark.parametrize("name", ["at", "p", "v", "a"])
def test_rows_cannot_be_overwritten_behind_what_was_computed_from_them(name, solution):
    """Section forces that were asked for before would be those of the states of before."""
    with pytest.raises(ValueError, match="read-only"):
        getattr(solution, name)[-1] += 1.0
    with pytest.raises(ValueError, match="read-only"):
        solution[-1].p[0] = 1.0
    own = solution.p.copy()
    changed = replace(solution, p=own)
    own[:] = own  # what was given stays as it was
    assert np.shares_memory(changed.p, own)
    assert bf.simulate(CANTILEVER, 0.01, 0.01, start=changed[-1]).p.shape[0] == 2
