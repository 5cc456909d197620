"""What convergence studies say of their error against known errors: a thousand studies, accidents among them."""

from functools import cache

import numpy as np
import pytest

import beamfem as bf
from beamfem.convergence.refinement_curve import chance_hits, extrapolate, fit_order, highest_order, scale_of

TOO_SMALL = 3.0


def estimate(h, q, highest=16.0):
    """Absolute estimated error of the finest value; nan where it says that it is none."""
    found = extrapolate(h, q, highest)
    return found.error * scale_of(found.limit, q)


def understated(study, limit):
    (curve,) = study.curves
    true = abs(curve.value[-1] - limit) / scale_of(curve.limit, curve.value)
    return true / curve.estimated_error


# Synthetic studies: errors over sizes h (n,) of n elements; the limit is added to them


def one_power(random, n, h):
    return random.normal() * h ** random.choice([0.5, 1, 1.5, 2, 3, 4, 6, 8])


def sum_of_powers(random, n, h):
    orders = random.choice([1, 2, 3, 4, 6, 8], random.integers(2, 4), replace=False)
    return sum(random.normal() * 10 ** random.uniform(-2, 2) * h**p for p in orders)


def smooth(random, n, h):
    p = random.choice([2, 4, 6, 8])
    return sum(random.normal() * 10 ** random.uniform(-1, 1) * h ** (p + 2 * i) for i in range(3))


def hits_the_limit(random, n, h):
    """Two powers that cancel at one of the last levels, or nearly."""
    p, i = random.choice([2, 4]), random.integers(1, 3)
    return random.normal() * h**p * (1.0 - (h / h[-i]) ** 2 * (1.0 + 1e-3 * random.normal()))


def oscillating(random, n, h):
    return (-1.0) ** np.arange(len(h)) * h ** random.choice([1, 2, 4])


def odd_and_even(random, n, h):
    p = random.choice([1, 2, 4])
    return (-1.0) ** n * h**p + random.normal() * h ** (p + random.integers(0, 3))


def wave(random, n, h):
    return h ** random.choice([1, 2, 4]) * np.cos(random.uniform(0, 6) * np.log(h) + random.uniform(0, 6))


def locking(random, n, h):
    c = 10 ** random.uniform(-1, 5)
    return -c / (n**2 + c)


def at_round_off(random, n, h):
    noise = 10 ** random.uniform(-16, -13) * random.normal(size=len(h))
    return random.normal() * h ** random.choice([2, 4, 8]) + noise


def load_inside_elements(random, n, h):
    """A kink at a point that is no node: its error goes with its place in the element."""
    place = (n * random.uniform()) % 1.0
    return place * (1.0 - place) * h ** random.choice([1, 2]) + random.normal() * 0.3 * h**2


FAMILIES = {
    one_power: 100,
    sum_of_powers: 150,
    smooth: 150,
    hits_the_limit: 100,
    oscillating: 60,
    odd_and_even: 80,
    wave: 80,
    locking: 80,
    at_round_off: 80,
    load_inside_elements: 60,
}


def levels(random):
    """3 to 7 numbers of elements: doubled, by half as many more, by equal steps, or by any."""
    count, first = random.integers(3, 8), random.integers(1, 5)
    return [
        first * 2 ** np.arange(count),
        np.unique(np.round((first + 1) * 1.5 ** np.arange(count)).astype(int)),
        first + random.integers(1, 4) * np.arange(count),
        np.cumsum(random.integers(1, 6, count)),
    ][random.integers(4)]


@cache
def studies():
    """Estimate over true error of each study, nan where there is none, by family."""
    random = np.random.default_rng(12)
    found = {}
    for family, count in FAMILIES.items():
        ratios = []
        while len(ratios) < count:
            n = levels(random)
            limit = random.choice([0.0, 1.0, -3.0])
            q = limit + family(random, n, 1.0 / n)
            true = abs(q[-1] - limit)
            if len(n) >= 3:
                ratios.append(estimate(1.0 / n, q) / true if true > 0.0 else np.inf)
        found[family] = np.array(ratios)
    return found


@pytest.mark.parametrize("family", FAMILIES, ids=lambda family: family.__name__)
def test_no_estimate_is_more_than_three_times_too_small(family):
    """Three finite values cannot rule out every accident: with 25 other seeds it happens in 15 studies of 23,500."""
    ratios = studies()[family]
    assert not (ratios < 1.0 / TOO_SMALL).any()


@pytest.mark.parametrize("family", [one_power, sum_of_powers, smooth, oscillating, at_round_off])
def test_estimates_of_regular_studies_are_of_the_size_of_the_error(family):
    """Half of them are within 6 times the error, and 7 of 10 studies have one: careful is not useless."""
    ratios = studies()[family]
    given = ratios[~np.isnan(ratios)]
    assert len(given) > 0.7 * len(ratios)
    assert np.median(given) < 6.0


# Real beams with few elements


def cantilever(element, elements, load=1.0, at=1.0):
    """Deflection w of the tip under a small force at x: exact w = F x^2 (3 - x) / (6 E I) + F x / (k G A), linear."""
    section, material = bf.Rectangle(0.1, 0.1), bf.Material(2e11, 0.3, 7800.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, section, material)
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.at(at), (0, load))])
    return bf.solve_static(model).displacement(beam.end)[-1, 1]


def exact_tip(at, load=1.0):
    bending, shear = 2e11 * 0.1**4 / 12, 5 / 6 * 2e11 / 2.6 * 0.1**2
    return load * at**2 * (3 - at) / (6 * bending) + load * at / shear


CUBIC = bf.ANCF(bf.Structural())
LARGE = 5 * 2e11 * 0.1**4 / 12
BENT = 0.72054526137677  # Reissner's beam, P L^2 / (E I) = 5, L/h = 10: collocation, 12 digits
MESHES = ([2, 4, 8], [1, 2, 4, 8], [2, 4, 8, 16], [3, 4, 5, 7], [2, 3, 5, 8])


@pytest.mark.parametrize(
    "element", [bf.CRBF(1), bf.CRBF(2), bf.CRBF(3), bf.ANCF(bf.Structural())], ids=lambda e: e.name
)
@pytest.mark.parametrize("at", [1.0, 0.3])
def test_beams_do_not_understate_their_error(element, at):
    """A small force at the tip and at a point that is a node of few meshes; its deflection has a closed form."""
    for elements in MESHES:
        study = bf.converge(cantilever, refine="elements", element=element, elements=elements, at=at, load=1.0)
        # the static solve is nonlinear and right to some 1e-9 of the linear deflection
        if abs(study.curves[0].value[-1] / exact_tip(at) - 1.0) > 1e-8:
            assert not understated(study, exact_tip(at)) > TOO_SMALL


@pytest.mark.parametrize(
    "element", [bf.CRBF(1), bf.CRBF(2), bf.CRBF(4), bf.ANCF(bf.Structural())], ids=lambda e: e.name
)
def test_bent_beams_do_not_understate_their_error(element):
    for elements in MESHES:
        study = bf.converge(cantilever, refine="elements", element=element, elements=elements, load=LARGE)
        assert not understated(study, BENT) > TOO_SMALL


# Named cases


def from_table(elements, table):
    return table[elements]


def of_table(values):
    """A study of 2, 4, 8, ... elements with these values."""
    given = {2 << i: value for i, value in enumerate(values)}
    return bf.converge(from_table, refine="elements", elements=list(given), table=given)


@pytest.mark.parametrize(
    ("values", "error"),
    [
        ((1.0 + 1.985e-2, 1.0 + 1.02e-2, 1.0 + 1.0e-2), 1e-2),  # order 5.6
        ((1.0 + 2.38e-2, 1.0 + 1.9e-4, 1.0 + 1.7e-4), 1.7e-4),  # order 10.2
        ((2.0, 1.1, 1.099999), 0.1),  # order 19.8
        ((2.0, 1.1, 1.1), 0.1),  # no order at all
    ],
    ids=["order 5.6", "order 10.2", "order 19.8", "stands still"],
)
def test_three_levels_with_an_accidental_order(values, error):
    """The limit is 1."""
    (curve,) = of_table(values).curves
    assert curve.estimated_error * abs(curve.limit) > error / TOO_SMALL
    assert "estimate is" in curve.notes[0]


def test_the_highest_order_is_that_of_the_elements_of_the_curve():
    assert highest_order({"element": bf.CRBF(2), "height": 1.0}) == 4.0
    assert highest_order({"first": bf.CRBF(1), "second": bf.ANCF()}) == 6.0
    assert highest_order({"height": 1.0}) == 16.0


def test_an_order_above_that_of_the_elements_is_not_believed():
    """Values that fall with order 8, which linear elements cannot have and order 4 can."""
    h = 0.5 ** np.arange(4)
    q = 1.0 + h**8
    assert extrapolate(h, q, highest=8.0).error == pytest.approx(h[-1] ** 8, rel=1e-6)
    doubted = extrapolate(h, q, highest=2.0)
    assert doubted.error > 100 * h[-1] ** 8
    assert not doubted.settled
    assert "too small for an order up to 2" in doubted.note


def test_a_slow_part_behind_a_fast_one_is_not_overlooked():
    """h^8 hides 20 times as much of h^2 at the finest level: the orders 8.0 and 7.7 agree and are both wrong."""
    for h, sign in ((0.5 ** np.arange(4), 1.0), (0.5 ** np.arange(4), -1.0)):
        x = h / h[-1]
        q = 1.0 + 1e-6 * (20.0 * x**2 + sign * x**8)
        assert estimate(h, q) > abs(q[-1] - 1.0) / TOO_SMALL


def bracketing(elements):
    return 1.0 + (-1) ** round(np.log2(elements)) * elements**-4.0


def test_values_that_bracket_their_limit_stop_when_they_are_there():
    """1 + (-1)^k n^-4 at n = 2^k: the last change is below 1e-6 from 64 elements on."""
    (curve,) = bf.converge(bracketing, refine="elements", elements=[2, 4, 8], until=1e-6).curves
    assert curve.refinement[-1] == 64 or curve.refinement[-1] == 128
    assert curve.limit == pytest.approx(1.0, abs=1e-12)
    assert curve.fit.order == pytest.approx(4.0, abs=1e-9)  # there is no other term
    assert "bracket" in curve.notes[0]


def test_values_that_run_away_have_no_estimate():
    for values in ((1.0, 1.001, 1.004), (1.0, 1.5, 1.2), (1.0, 1.0 + 1e-9, 1.0 + 4e-9, 1.0 + 16e-9)):
        (curve,) = of_table(values).curves
        assert np.isnan(curve.estimated_error)
        assert "no estimate" in curve.notes[0]


def second_order(elements):
    return 2.5 + 0.3 * elements**-2.0


@pytest.mark.parametrize("elements", [[2, 3, 4, 7], [2, 3, 4, 7, 10], [3, 4, 7, 10]])
def test_locked_values_that_creep_are_no_round_off(elements):
    """A locked element: 2 - 1e-3 / (1 + 1e-6 n^2). Its changes of 1e-8 rise and fall with n, the error stays 1e-3."""
    h = 1.0 / np.array(elements)
    q = 2.0 - 1e-3 / (1.0 + 1e-6 / h**2)
    found = extrapolate(h, q)
    assert np.isnan(found.error)
    assert "do not close in" in found.note


def test_whole_numbers_are_counts_in_whatever_order():
    """Read as step sizes they would fall from fine to coarse."""
    for elements in ([32, 16, 8, 4], [8, 32, 4, 16]):
        (curve,) = bf.converge(second_order, refine="elements", elements=elements).curves
        assert curve.refinement == (4, 8, 16, 32)
        assert curve.limit == pytest.approx(2.5, rel=1e-12)
        assert curve.fit.order == pytest.approx(2.0, abs=1e-6)
    with pytest.raises(bf.InputError, match=r"falling step sizes, got 0\.1, 0\.2"):
        bf.converge(second_order, refine="elements", elements=[0.1, 0.2])


@pytest.mark.parametrize("place", [1, 2, 4])
def test_a_level_that_hits_the_reference_by_chance_is_no_round_off(place):
    """Order 2 with one error that is zero: in between, and the last."""
    n = 2 ** np.arange(1, 6)
    values = 1.0 + 0.3 / n**2.0
    values[place] = 1.0
    table = dict(zip(n.tolist(), values.tolist(), strict=True))
    study = bf.converge(from_table, refine="elements", elements=n.tolist(), table=table, reference=1.0)
    (curve,) = study.curves
    assert curve.fit.order == pytest.approx(2.0, abs=1e-9)
    assert f"the error at {n[place]} is small by chance" in curve.notes[0]
    assert "round-off" not in " ".join(curve.notes)


def test_errors_at_round_off_are_no_chance():
    h = 0.5 ** np.arange(6)
    error = np.array([1e-2, 4e-5, 1.5e-7, 6e-10, 2e-16, 0.0])
    assert not chance_hits(h, error, 8.0).any()
    assert fit_order(h, error, 8.0).last == 3


def test_large_values_of_coarse_levels_do_not_hide_the_changes_of_fine_ones_in_round_off():
    """1000 on the coarsest level, then 1 + 1e-12 (h / h_last)^2, less than the round-off of 1000."""
    h = np.array([1.0, 0.5, 0.25, 0.125])
    q = np.array([1000.0, *(1.0 + 1e-12 * np.array([16.0, 4.0, 1.0]))])
    found = extrapolate(h, q)
    assert not found.settled
    assert "round-off" not in found.note
