"""Random models, from everyday to absurd: each ends right, by balances of its own, or in a named error."""

import pytest
from fuzz import FEW, judged, run, summary
from fuzz_judged import Outcome

from beamfem.solve.continuation import bifurcations, steps

QUICK, MANY, STRAINED = 5, 10_000, 2_000


def unexplained(outcomes):
    return "\n".join(f"seed {found.seed}: {found.verdict}: {found.said}" for found in outcomes if found.unexplained)


@pytest.mark.slow
def test_a_few_random_models_end_right_or_in_a_named_error():
    outcomes = [judged(seed, FEW) for seed in (*range(QUICK), *range(MANY, MANY + QUICK))]
    assert not unexplained(outcomes), unexplained(outcomes)
    verdicts = [found.verdict for found in outcomes]
    assert verdicts.count("right") > QUICK
    assert len({found.analysis for found in outcomes if found.verdict == "right"}) == 5


ONCE_WRONG = {
    4269: ("right", "an iteration that crept along a path of prescribed motions, taken for round-off"),
    4380: ("right", "the lowest mode of a loaded wire of L/h = 1e5, 10 % off"),
    8365: ("right", "the same as 4269 on a curved wire"),
    10340: ("right", "a limit point beside a bifurcation, out of balance"),
    10892: ("right", "squares of small imposed strains, which differences gave no digits"),
    11681: ("right", "a count of negative eigenvalues below zero, where round-off hid those of the stiffness"),
}


LONG = {11681: pytest.mark.slow}


@pytest.mark.parametrize("seed", [pytest.param(seed, marks=LONG.get(seed, ())) for seed in ONCE_WRONG])
def test_random_models_that_once_were_wrong(seed):
    verdict, was = ONCE_WRONG[seed]
    assert judged(seed).verdict == verdict, was


@pytest.mark.slow
def test_the_search_for_bifurcations_ends_where_round_off_decides(monkeypatch):
    """Seed 919, stiffnesses 1e30 apart: a step was divided to a hundred-thousandth, by thousands of tangents."""
    asked, searched, condensed, search = [], [], bifurcations.condensed, steps.bifurcations

    def counted(line, point, directions):
        asked.append(point)
        return condensed(line, point, directions)

    def searching(segment, limits):
        before = len(asked)
        try:
            return search(segment, limits)
        finally:
            searched.append(len(asked) - before)

    monkeypatch.setattr(bifurcations, "condensed", counted)
    monkeypatch.setattr(steps, "bifurcations", searching)
    assert judged(919).verdict == "ConvergenceError"
    assert 0 < max(searched) < 250


@pytest.mark.slow
def test_12_000_random_models_end_right_or_in_a_named_error(capsys):
    """From seed 10,000 on they have loads that impose strains."""
    outcomes = run(range(MANY + STRAINED))
    with capsys.disabled():
        print("\n" + summary(outcomes))
    assert len(outcomes) == MANY + STRAINED
    assert not unexplained(outcomes), unexplained(outcomes)


def test_the_summary_counts_each_analysis_and_names_the_seeds_of_what_is_wrong():
    found = summary([Outcome(3, "static", "right"), Outcome(4, "modes", "wrong", "too soft")])
    assert found.splitlines()[0] == "2 random models"
    assert found.splitlines()[-1] == "seed 4: wrong: too soft"
