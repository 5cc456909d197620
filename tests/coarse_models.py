"""Random models with few elements of any kind, the same for the same seed, and with very fine meshes."""

from dataclasses import replace

import numpy as np
from random_models import random_recipe
from recipes import FINE, Built, Recipe

import beamfem as bf

MOST, FEWEST = 1.5, 1.0 / 16.0  # of the elements of `random_models`


def coarse_recipe(seed: int) -> Recipe:
    """Return a random model with a sixteenth to one and a half of the elements that it has in `random_models`."""
    rng, recipe = np.random.default_rng(10_000 + seed), random_recipe(seed)
    bars = []
    for bar in recipe.bars:
        kind, count = bar.kind, round(bar.elements * 2.0 ** rng.uniform(np.log2(FEWEST), np.log2(MOST)))
        if rng.random() < 0.15:
            kind, count = f"CRBF({rng.integers(5, 9)})", int(rng.integers(1, 4))
        bars.append(replace(bar, elements=max(count, 1), kind=kind))
    return replace(recipe, bars=tuple(bars))


def fine_recipe(recipe: Recipe, elements: int) -> Recipe:
    """Return it with at least so many elements a bar, or a sixth of that of order 6, and a node where it had one."""
    bars = []
    for bar in recipe.bars:
        fine = f"fine {bar.kind}" in FINE
        times = -(-(elements // 6 if fine else elements) // bar.elements)
        bars.append(replace(bar, elements=times * bar.elements, kind=f"fine {bar.kind}" if fine else bar.kind))
    return replace(recipe, bars=tuple(bars))


def displacements(built: Built, solution: bf.Solution) -> np.ndarray:
    """Return the displacements (n, 2) in the last row of points along all bars."""
    places = [(number, at) for number in range(len(built.recipe.bars)) for at in (0.25, 0.5, 0.75, 1.0)]
    return np.array([solution.displacement(built.point(place))[-1] for place in places])
