"""Conditions that depend on each other, solved with multipliers of least norm on request."""

import numpy as np
import pytest

import beamfem as bf

STEEL = bf.Material(2.1e11, 0.3, 7800.0, thermal_expansion=1.2e-5)
SQUARE = bf.Rectangle(0.01, 0.01)
CORNERS = ((0, 0), (1, 0), (1, 1), (0, 1))
PAIRS = ((0, 1), (1, 2), (2, 3), (0, 3), (0, 2), (1, 3))  # the last one is a link too many


def square(links, least_norm=False):
    """Return a square of links on the tips of four cantilevers, with the links and the tips."""
    beams = [
        bf.Beam(bf.Line((x, y), (1.7 * x - 0.7 * (1 - x), y - 0.3)), 2, bf.CRBF(3), SQUARE, STEEL) for x, y in CORNERS
    ]
    tips = [beam.start for beam in beams]
    bars = [bf.Link(tips[i], tips[j]) for i, j in PAIRS[:links]]
    loads = [bf.PointForce(tips[2], (20.0, 30.0)), bf.PointForce(tips[0], (-5.0, -30.0))]
    how = "least_norm" if least_norm else "error"
    model = bf.Model(beams, [bf.Clamp(beam.end) for beam in beams], loads, connectors=bars, redundant_conditions=how)
    return model, bars, tips


@pytest.mark.filterwarnings("ignore:accelerations in the rows:beamfem.TimeStepWarning")
def test_a_square_with_both_diagonals_moves_as_with_one_and_has_no_self_stress():
    """Statics, path, modes, buckling and motions; self-stress is the null vector of the tensions on the corners."""
    (one, bars, tips), (both, every, corners) = square(5), square(6, least_norm=True)
    analyses = [bf.solve_static, lambda model: bf.trace_equilibrium(model, until=1.0)]
    for integrator in (bf.GeneralizedAlpha(), bf.Gauss(2), bf.Bathe(), bf.HHT()):
        analyses.append(lambda model, by=integrator: bf.simulate(model, 0.004, 1e-3, integrator=by))
    for analyse in analyses:
        needed, redundant = analyse(one), analyse(both)
        for tip, corner in zip(tips, corners, strict=True):
            np.testing.assert_allclose(redundant.position(corner), needed.position(tip), rtol=0.0, atol=1e-11)
        tensions = np.array([redundant.multipliers(bar)[-1, 0] for bar in every])
        place = np.array([redundant.position(corner)[-1] for corner in corners])
        matrix = np.zeros((6, 8))
        for row, (i, j) in enumerate(PAIRS):
            matrix[row, 2 * i : 2 * i + 2] = -(place[j] - place[i]) / np.hypot(*np.subtract(CORNERS[j], CORNERS[i]))
            matrix[row, 2 * j : 2 * j + 2] = -matrix[row, 2 * i : 2 * i + 2]
        some = np.append([needed.multipliers(bar)[-1, 0] for bar in bars], 0.0)
        least = np.linalg.lstsq(matrix.T, matrix.T @ some, rcond=1e-9)[0]
        np.testing.assert_allclose(tensions, least, rtol=1e-6, atol=1e-6)
        np.testing.assert_allclose(redundant.energy().total, needed.energy().total, rtol=1e-9, atol=1e-10)
    about = [bf.solve_static(model) for model in (one, both)]
    modes = [bf.solve_modes(model, 4, about=state).frequencies for model, state in zip((one, both), about, strict=True)]
    np.testing.assert_allclose(modes[1], modes[0], rtol=1e-9)
    pushed = [bf.Temperature(model.beams[0], 1000.0) for model in (one, both)]
    loads = [bf.solve_buckling(m.with_loads([t]), 1).load_factors for m, t in zip((one, both), pushed, strict=True)]
    np.testing.assert_allclose(loads[1], loads[0], rtol=1e-9)
    systems = [bf.linearise(model) for model in (one, both)]
    assert len(systems[0]) == len(systems[1])


def test_two_links_side_by_side_share_the_tension_and_one_between_supports_has_none():
    one, two = (bf.Beam(bf.Line((x, 0), (x, 1)), 2, bf.CRBF(3), SQUARE, STEEL) for x in (0.0, 0.5))
    links = [bf.Link(one.end, two.end), bf.Link(one.end, two.end), bf.Link(one.start, two.start)]
    clamps, force = [bf.Clamp(one.start), bf.Clamp(two.start)], bf.PointForce(one.end, (10.0, 0.0))
    model = bf.Model([one, two], clamps, [force], connectors=links, redundant_conditions="least_norm")
    alone = bf.Model([one, two], clamps, [force], connectors=links[:1])
    (tension,) = bf.solve_static(alone).multipliers(links[0])[-1]
    found = bf.solve_static(model)
    np.testing.assert_allclose([found.multipliers(link)[-1, 0] for link in links], [tension / 2, tension / 2, 0.0])
    np.testing.assert_allclose(found.joint_force(links[1])[-1], bf.solve_static(alone).joint_force(links[0])[-1] / 2)


def test_moments_and_forces_of_two_welds_are_halved_in_any_unit():
    found = []
    for size in (1.0, 1e3):
        section, steel = bf.Rectangle(0.01 * size, 0.01 * size), bf.Material(2.1e11 / size**2, 0.3, 7.8e3 / size**3)
        one, two = (
            bf.Beam(bf.Line((x * size, 0), ((x + 1) * size, 0.2 * size)), 2, bf.CRBF(3), section, steel) for x in (0, 1)
        )
        welds = [bf.Weld(one.end, two.start) for _ in range(2)]
        parts = {"joints": welds, "redundant_conditions": "least_norm"}
        model = bf.Model([one, two], [bf.Clamp(one.start)], [bf.PointForce(two.end, (1.0, -3.0))], **parts)
        solution = bf.solve_static(model)
        once = bf.solve_static(bf.Model(model.beams, model.supports, model.loads, welds[:1])).multipliers(welds[0])[-1]
        for weld in welds:
            np.testing.assert_allclose(solution.multipliers(weld)[-1], once / 2, rtol=1e-6)
        found.append(solution.multipliers(welds[0])[-1] / (1.0, 1.0, size))
    np.testing.assert_allclose(found[1], found[0], rtol=1e-6)


def test_conditions_that_are_redundant_in_the_reference_only_are_refused():
    """Two links in a line hold a tip to first order; beside the line both are needed."""
    left, middle, right = (bf.Beam(bf.Line((x, 0), (x, 1)), 2, bf.CRBF(3), SQUARE, STEEL) for x in (-1.0, 0.0, 1.0))
    links = [bf.Link(left.end, middle.end), bf.Link(middle.end, right.end)]
    supports = [bf.Clamp(point) for beam in (left, right) for point in (beam.start, beam.end)]
    lists = [left, middle, right], [bf.Clamp(middle.start), *supports], [bf.Temperature(middle, 1000.0)]
    model = bf.Model(*lists, connectors=links, redundant_conditions="least_norm")
    with pytest.raises(bf.InputError, match="redundant in the reference, but not at load factor 1"):
        bf.solve_static(model)


def test_the_choice_is_saved_and_goes_with_copies(tmp_path):
    model, bars, _ = square(6, least_norm=True)
    solution = bf.solve_static(model)
    solution.save(tmp_path / "square.h5")
    loaded = bf.load(tmp_path / "square.h5")
    assert loaded.model.redundant_conditions == "least_norm"
    assert bf.solve_static(loaded.model).multipliers(loaded.model.connectors[5])[-1, 0] == pytest.approx(
        solution.multipliers(bars[5])[-1, 0], rel=1e-9
    )
    assert model.with_loads([]).redundant_conditions == "least_norm"
    with pytest.raises(bf.InputError, match="redundant_conditions"):
        bf.Model(model.beams, redundant_conditions="ignore")
