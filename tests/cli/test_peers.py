"""The comparison with Exudyn: what it says without it, what it takes for right, and how it chooses."""

import sys
from dataclasses import replace

import numpy as np
import pytest

import beamfem as bf
from studies.benchmarks import (
    integrators,
    peer_cases,
    peer_clock,
    peer_figures,
    peer_mechanisms,
    peer_precision,
    peers,
)
from studies.benchmarks.peer_precision import Run
from studies.benchmarks.peer_ratios import row


def test_without_exudyn_it_says_so_and_writes_nothing(monkeypatch, capsys, tmp_path):
    monkeypatch.setitem(sys.modules, "exudyn", None)
    assert peers.main(tmp_path) == 0
    assert list(tmp_path.iterdir()) == []
    said = capsys.readouterr().out
    assert said.count("\n") == 1
    assert said.startswith("Exudyn cannot be imported here")


def test_integrators_are_compared_by_what_an_error_costs(tmp_path):
    case = replace(integrators.soft(), steps={bf.Gauss(2): (20, 80), bf.Radau(3): (40, 80)}, exact=(bf.Gauss(4), 200))
    found = case.measured()
    for runs in found.values():
        assert (runs[0, 0] > 5.0 * runs[1, 0]) & (runs[:, 1] > 0.0).all()
        middle = float(np.sqrt(runs[0, 0] * runs[1, 0]))
        assert integrators.cost(runs, middle) == pytest.approx(np.sqrt(runs[0, 1] * runs[1, 1]))
        assert np.isnan(integrators.cost(runs, 0.5 * runs[1, 0]))
    integrators.draw({"pendulum": found, "again": found}, tmp_path / "integrators.svg")
    assert (tmp_path / "integrators.svg").stat().st_size > 0


def test_chains_have_the_stiffness_of_the_models():
    for chain, section, material in (
        (peer_cases.PENDULUM, peer_cases.PRINTED, peer_cases.RUBBER),
        (peer_cases.CANTILEVER, peer_cases.SQUARE, peer_cases.STEEL),
    ):
        rigidity = section.rigidity(material)
        assert (chain.axial, chain.shear, chain.bending) == pytest.approx(
            (rigidity.axial, rigidity.shear, rigidity.bending), rel=1e-14
        )
        assert chain.mass == pytest.approx(material.density * section.area, rel=1e-14)
        assert chain.rotary == pytest.approx(material.density * section.second_moment, rel=1e-14)
    assert peer_cases.CANTILEVER.force == pytest.approx(5.0 * peer_cases.CANTILEVER.bending)


def test_runs_converge_to_the_references():
    """Cases 1 and 10c; the motion is of second order in the step, with 2 ms off by some 1e-4 m."""
    model = peer_cases.cantilever(bf.CRBF(4), 8)
    assert peer_cases.static_error(bf.solve_static(model).position(model.beams[0].end)[-1]) < 2e-9
    tips = [peer_cases.tips_of(peer_cases.swing(peer_cases.pendulum(bf.CRBF(4), 8), steps)) for steps in (500, 1000)]
    errors = [peer_cases.motion_errors(one, peer_cases.REISSNER_TIPS)[0] for one in tips]
    assert errors[0] < 2e-4
    assert errors[1] < 0.6 * errors[0]


def test_a_short_motion_is_judged_at_the_instants_it_reaches():
    solution = peer_cases.swing(peer_cases.pendulum(bf.CRBF(2), 12), 200, 0.2)
    tips = peer_cases.tips_of(solution)
    assert len(tips) == 2
    largest, last = peer_cases.motion_errors(tips, peer_cases.REISSNER_TIPS)
    assert last <= largest < 1e-4
    assert np.isnan(peer_cases.motion_errors(tips, None)).all()


def test_tasks_take_turns_after_one_that_is_not_counted():
    called, clock = [], iter(np.arange(100.0))
    timings = peer_clock.in_turns([lambda: called.append("a"), lambda: called.append("b")], 3, lambda: next(clock))
    assert called[:4] == ["a", "a", "b", "b"]
    assert called.index("b", 4) < len(called) - 1 - called[::-1].index("a")
    assert all(timing.least <= timing.median for timing in timings)
    assert peer_clock.fastest(timings).least == min(timing.least for timing in timings)


def _runs():
    """An accident at 3 ms: nearly right at the end, wrong before."""
    values = [(1.0, 1e-2, 1e-2), (2.0, 2e-2, 2e-2), (3.0, 1e-3, 1e-9), (4.0, 1e-4, 1e-4), (9.0, 1e-5, 1e-5)]
    return [
        Run(
            of_peer, f"{'Exudyn' if of_peer else 'beamfem'}, a", 4, 10, ms * (1 + 4 * of_peer), *errors, bf.CRBF(1), int
        )
        for of_peer in (False, True)
        for ms, *errors in values
    ]


def test_accidents_at_the_end_do_not_win_over_all_instants():
    runs = _runs()
    assert peer_precision.cheapest(runs, False, 1e-4).milliseconds == 4.0
    assert peer_precision.cheapest(runs, False, 1e-4, at_end=True).milliseconds == 3.0
    assert peer_precision.cheapest(runs, True, 2e-5).milliseconds == 45.0


def test_the_envelope_keeps_what_no_cheaper_run_reaches():
    times, errors = peer_precision.envelope(run for run in _runs() if not run.peer)
    assert times.tolist() == [1.0, 3.0, 4.0, 9.0]
    assert errors.tolist() == [1e-2, 1e-3, 1e-4, 1e-5]


def test_a_peer_that_struggles_has_no_ratio():
    fast, slow = peer_clock.Timing(1.0, 1.1), peer_clock.Timing(5.0, 5.5)
    own, other = (bf.CRBF(2), 6, fast, 1e-3), ("cable", 6, slow, 1e-3)
    assert row("case", own, other, 0.2, tangents=0.01).ratio == pytest.approx(0.2)
    assert np.isnan(row("case", own, other, 0.2, tangents=13.0).ratio)


def test_figures_are_drawn(tmp_path):
    fast, slow = peer_clock.Timing(1.0, 1.1), peer_clock.Timing(5.0, 5.5)
    rows = [row("case", (bf.CRBF(2), n, fast, 1e-3), ("cable", n, slow, 1e-3), 0.2) for n in (6, 12)]
    peer_figures.draw_cost(rows, tmp_path / "cost.svg")
    peer_figures.draw_precision(_runs(), "title", "error [m]", tmp_path / "precision.svg")
    assert all((tmp_path / name).stat().st_size > 0 for name in ("cost.svg", "precision.svg"))


def test_exudyn_has_the_same_models():
    pytest.importorskip("exudyn")
    cable = peer_cases.peer(peer_cases.CABLE, 4, peer_cases.PENDULUM)
    cable.motion(20, 0.02, peer_cases.DENSE)
    assert cable.tip_position()[1] == pytest.approx(-0.5 * 9.81 * 0.02**2, rel=1e-2)
    other = peer_cases.peer(peer_cases.THREE_NODES, 12, peer_cases.PENDULUM)
    other.motion(1000, 1.0, peer_cases.SPARSE)
    assert peer_cases.motion_errors(other.positions(), peer_cases.REISSNER_TIPS)[0] < 3e-4
    assert other.positions()[-1] == pytest.approx(other.tip_position(), abs=1e-12)
    other = peer_cases.peer(peer_cases.THREE_NODES, 12, peer_cases.CANTILEVER)
    other.equilibrium(3, peer_cases.DENSE)
    assert peer_cases.static_error(other.tip_position()) < 1e-5


@pytest.mark.parametrize(("element", "kind"), peer_mechanisms.PAIRS)
@pytest.mark.parametrize("case", [peer_mechanisms.slider_crank(), peer_mechanisms.four_bar()])
def test_exudyn_has_the_same_linkages(case, element, kind):
    """Both codes in the same short motion; two bars of stiff beams differ from a rigid crank by their elasticity."""
    exudyn_models = pytest.importorskip("studies.benchmarks.exudyn_models", exc_type=ImportError)
    case = replace(case, duration=0.1)
    elements = (1,) * (len(case.bars) - 1) + (16,)
    found = peer_mechanisms.positions(peer_mechanisms.turn(peer_mechanisms.model(case, element, elements), case, 200))
    for rigid in (False, True):
        other = exudyn_models.linkage(kind, case, elements, rigid)
        other.motion(200, case.duration, peer_cases.SPARSE, method="GeneralizedAlpha")
        assert np.abs(other.positions() - found).max() < 1e-4


def test_exudyn_is_judged_by_its_own_limits():
    """Its implicit and explicit methods have limits that differ by 8e-5 m; each is of second order."""
    pytest.importorskip("exudyn")
    steps = {"TrapezoidalIndex2": (200, 1600, 12800), "ExplicitMidpoint": (800, 3200, 25600)}
    found = replace(integrators.soft(), peer_steps=steps).measured_peer()
    for (few, many, _), runs in zip(steps.values(), found.values(), strict=True):
        assert np.log(runs[0, 0] / runs[1, 0]) / np.log(many / few) == pytest.approx(2.0, abs=0.1)
