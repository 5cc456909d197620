"""The same model turned, mirrored, split, in other units and in another order has the same answers."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest
from judged import NoReference, followed, outcome
from random_models import random_recipe
from recipes import KINDS, Recipe, View
from slow_values import mostly_slow

import beamfem as bf

VIEWS = {
    "turned": View(angle=0.7),
    "upside down": View(angle=np.pi, shift=(3.0, -2.0)),
    "turned slightly": View(angle=1e-4),
    "mirrored": View(mirrored=True),
    "split": View(split=True),
    "mm": View(length=1e3),
    "um, uN": View(length=1e6, force=1e6),
    "reordered": View(reordered=True),
    "backwards": View(backwards=True),
    "all": View(2.0, True, (1.0, 5.0), 1e3, 1.0, True, True, True),
}
LED = ("lead", "turn")
QUICK = (0, 6, 12, 19, 33)
QUICK_VIEWS = ("turned", "split", "mm", "all")
MANY = range(500, 700)


def in_views(recipe: Recipe, names: Sequence[str]):
    """Name and model of every view that does not change the mesh; halves of fields with r_x share none."""
    cut = all("r_x" not in KINDS[bar.kind].field.vectors for bar in recipe.bars)
    for name in names:
        view = VIEWS[name]
        if cut or not view.split:
            yield name, recipe.build(view)


def statics(recipe: Recipe, names: Sequence[str]):
    expected = followed(recipe.build())
    if isinstance(expected, NoReference):
        return
    for name, built in in_views(recipe, names):
        for steps in (1, 10):
            found = outcome(built, expected, steps)
            assert found.right, f"{name}, steps={steps}: {found.verdict}, {found.said}\n{recipe}"


def paths(recipe: Recipe, names: Sequence[str]):
    expected = followed(recipe.build())
    if isinstance(expected, NoReference):
        return
    for name, built in in_views(recipe, names):
        found = followed(built)
        where = f"{name}: {found}\n{recipe}"
        assert not isinstance(found, NoReference), where
        assert found.limit == (expected.limit and pytest.approx(expected.limit, rel=1e-6)), where
        assert found.crossed == pytest.approx(expected.crossed, rel=1e-5), where
        if expected.end is not None:
            assert np.abs(found.end - expected.end).max() < 1e-6 * recipe.reach, where


def answer(ask, built):
    """What a model answers, or the kind of error."""
    try:
        return ask(built)
    except (bf.InputError, bf.ConvergenceError) as error:
        return type(error)


def agree(recipe: Recipe, names: Sequence[str], ask, same):
    """Assert that `same` holds between the answers of every view and of the plain one, or that they refuse alike."""
    expected = answer(ask, recipe.build())
    for name, built in in_views(recipe, names):
        found = answer(ask, built)
        where = f"{name}: {found} instead of {expected}\n{recipe}"
        if isinstance(expected, type) or isinstance(found, type):
            assert found is expected, where
        else:
            same(found, expected, where)


def modes(recipe: Recipe, names: Sequence[str]):
    """Frequencies about the first state and under a tenth of the load."""

    def ask(built):
        path = bf.trace_equilibrium(built.model, 0.1)
        return [bf.solve_modes(built.model, 5, about=path[row]) for row in (0, -1)]

    def same(found, expected, where):
        for a, b in zip(found, expected, strict=True):
            largest = b.frequencies.max()
            assert a.frequencies == pytest.approx(b.frequencies, rel=1e-6, abs=1e-6 * largest), where
            assert a.growth == pytest.approx(b.growth, rel=1e-5, abs=1e-5 * largest), where

    agree(recipe, names, ask, same)


def buckling(recipe: Recipe, names: Sequence[str]):
    def ask(built):
        return bf.solve_buckling(built.model, 1).load_factors

    def same(found, expected, where):
        assert found == pytest.approx(expected, rel=1e-6), where

    agree(recipe, names, ask, same)


def motion(recipe: Recipe, names: Sequence[str]):
    """Thirty steps from rest under a twentieth of the loads that is suddenly there."""
    height = min(bar.height for bar in recipe.bars)
    time = recipe.reach**2 * np.sqrt(12.0 * recipe.density / recipe.modulus) / height
    small = tuple(replace(load, values=tuple(0.05 * value for value in load.values)) for load in recipe.loads)

    def ask(built):
        found = bf.simulate(built.model, 0.1 * time, time / 300.0)
        return np.concatenate([built.positions(p) for p in (found.p[1], found.p[-1])])

    def same(found, expected, where):
        assert np.abs(found - expected).max() < 1e-7 * recipe.reach, where

    agree(replace(recipe, loads=small), names, ask, same)


CHECKS = {check.__name__: check for check in (statics, paths, modes, buckling, motion)}


def applies(check: str, recipe: Recipe) -> bool:
    """Supports that are led are where they end at the start of a motion; loads that follow have no buckling."""
    led = any(support.kind in LED for support in recipe.supports)
    return not ((check == "motion" and led) or (check == "buckling" and any(load.follower for load in recipe.loads)))


@mostly_slow("seed", QUICK, quick=(0, 2))
@pytest.mark.parametrize("check", CHECKS)
def test_a_random_model_has_the_same_answers_in_every_view(check, seed):
    recipe = random_recipe(seed)
    if applies(check, recipe):
        CHECKS[check](recipe, QUICK_VIEWS)


@pytest.mark.slow
@mostly_slow("name", VIEWS, quick=(3,))
def test_a_tie_pulled_to_twice_its_length_has_one_limit_point_in_every_view(name):
    """Its load is 230 times what bends it by its length: changes of direction were lost beside those of the load."""
    buckling(random_recipe(582), (name,))
    assert bf.solve_buckling(random_recipe(582).build().model).kinds == ("limit point",)


@pytest.mark.slow
@pytest.mark.parametrize("check", CHECKS)
@pytest.mark.parametrize("seed", MANY)
def test_many_random_models_have_the_same_answers_in_every_view(check, seed):
    recipe = random_recipe(seed)
    if applies(check, recipe):
        CHECKS[check](recipe, tuple(VIEWS))
