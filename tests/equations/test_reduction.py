"""Models reduced to interfaces and modes, beside the full ones."""

import numpy as np
import pytest
from scipy.linalg import eigh

import beamfem as bf

STEEL = bf.Material(2.1e11, 0.3, 7850.0)
BEAM = bf.Beam(bf.Line((0, 0), (1, 0.3)), 16, bf.CRBF(3), bf.Rectangle(0.02, 0.02), STEEL)
CLAMPED = bf.Model([BEAM], [bf.Clamp(BEAM.start)], [bf.PointForce(BEAM.end, (-100.0, -300.0))])


@pytest.mark.parametrize("bent", [False, True])
def test_eight_modes_give_the_lowest_frequencies_of_the_full_model(bent):
    state = bf.solve_static(CLAMPED) if bent else None
    small, full = bf.reduce(CLAMPED, [BEAM.end], 8, about=state), bf.solve_modes(CLAMPED, 3, about=state)
    assert len(small) == 11
    found = small.modes(3)
    assert np.all(found.frequencies >= full.frequencies * (1.0 - 1e-9))  # by Rayleigh
    assert found.frequencies == pytest.approx(full.frequencies, rel=2e-4)
    assert found.modes == pytest.approx(full.modes, abs=5e-3 * np.abs(full.modes).max())


def test_all_modes_give_the_full_model():
    beam = bf.Beam(bf.Line((0, 0), (1, 0.3)), 2, bf.CRBF(3), bf.Rectangle(0.02, 0.02), STEEL)
    model = bf.Model([beam], [bf.Clamp(beam.start)])
    small = bf.reduce(model, [beam.end, beam.at(0.5)], 12)
    assert small.modes(18).frequencies == pytest.approx(bf.solve_modes(model, 18).frequencies, rel=1e-7)


def test_static_motions_are_exact_without_modes():
    small = bf.reduce(CLAMPED, [BEAM.end], 0)
    moved = np.linalg.solve(small.stiffness.toarray(), small.input_matrix[:, 0])
    full = bf.linearise(CLAMPED)
    whole = np.linalg.solve(full.stiffness.toarray(), full.input_matrix[:, 0])
    assert small.transformation @ moved == pytest.approx(full.transformation @ whole, rel=1e-7, abs=1e-12)
    for name in ("ux", "uy", "rotation"):
        assert small.output((name, BEAM.at(0.3))) @ moved == pytest.approx(full.output((name, BEAM.at(0.3))) @ whole)


def test_a_free_body_is_assembled_at_its_interfaces():
    """Clamped at one interface and with a mass at the other, it vibrates as the full model does."""
    small = bf.reduce(bf.Model([BEAM]), [BEAM.start, BEAM.end], 8)
    assert small.names[:2] == ("beam 0, node 0, r^x", "beam 0, node 0, r^y")
    assert small.names[-1] == "mode 7 with fixed interfaces"
    assert len(small.modes(4).rigid) == 3
    heavy = small.mass.toarray()
    for name in ("ux", "uy"):
        row = small.output((name, BEAM.end))
        heavy += 2.0 * np.outer(row, row)
    free = ~np.isin(np.arange(len(small)), [0, 1, 2])
    squares = eigh(small.stiffness.toarray()[free][:, free], heavy[free][:, free], eigvals_only=True)
    full = bf.solve_modes(bf.Model([BEAM], [bf.Clamp(BEAM.start)], masses=[bf.PointMass(BEAM.end, 2.0)]), 3)
    assert np.sqrt(squares[:3]) / (2.0 * np.pi) == pytest.approx(full.frequencies, rel=2e-4)


def test_dampers_are_reduced_with_the_rest():
    damped = CLAMPED.with_(connectors=[bf.SpringDamper(BEAM.end, (0.7, 1.3), 0.0, 20.0)])
    small, full = bf.reduce(damped, [BEAM.end], 8).modes(3), bf.linearise(damped).modes(3)
    assert small.ratios == pytest.approx(full.ratios, rel=2e-3)
    assert np.all(full.ratios > 1e-4)


def test_bad_input_is_named():
    with pytest.raises(bf.InputError, match="at no node of its beam"):
        bf.reduce(CLAMPED, [BEAM.at(0.123)], 2)
    with pytest.raises(bf.InputError, match="are one; list it once"):
        bf.reduce(CLAMPED, [BEAM.end, BEAM.at(1.0)], 2)
    with pytest.raises(bf.InputError, match="modes"):
        bf.reduce(CLAMPED, [BEAM.end], 1000)
    with pytest.raises(bf.InputError, match="moves rigidly"):
        bf.reduce(bf.Model([BEAM]), [], 2)


PAIR = [bf.Beam(bf.Line((0, y), (1, y)), 2, bf.CRBF(3), bf.Rectangle(0.02, 0.02), STEEL) for y in (0.0, 0.5)]
ENDS = [beam.end for beam in PAIR]
CLAMPS = [bf.Clamp(beam.start) for beam in PAIR]
JOINING = {
    "link": bf.Link(*ENDS),
    "weld": bf.Weld(*ENDS),
    "gear": bf.Gear(*ENDS, -2.0),
    "slider": bf.Slider(*ENDS, (1, 0)),
}


@pytest.mark.parametrize("name", JOINING)
@pytest.mark.parametrize("end", [0, 1])
def test_interfaces_may_have_conditions(name, end):
    """Either end of a joint is an interface: the conditions determine the other one."""
    model = bf.Model(PAIR, CLAMPS, connectors=[JOINING[name]])
    small = bf.reduce(model, [ENDS[end]], 12)
    at = model.mesh_of(ENDS[end])
    own = at.coordinates_of(at.node_at(1.0)).values()
    assert set(small.coordinates[:3].tolist()) == set(own)
    assert small.modes(3).frequencies == pytest.approx(bf.solve_modes(model, 3).frequencies, rel=2e-4)


@pytest.mark.parametrize("name", JOINING)
def test_interfaces_that_a_part_ties_to_each_other_are_named_with_it(name):
    kind = type(JOINING[name]).__name__
    with pytest.raises(bf.InputError, match=rf"not independent: conditions of {kind} at \(1, 0\) and \(1, 0.5\)"):
        bf.reduce(bf.Model(PAIR, CLAMPS, connectors=[JOINING[name]]), ENDS, 2)


@pytest.mark.parametrize("place", ["point", "arm"])
def test_interfaces_may_be_points_of_a_rigid_body(place):
    beam = PAIR[0]
    body = bf.RigidBody(beam.end, 0.5, 1e-3, (0.1, 0.0))
    tip = body.at(0.2, 0.1)
    model = bf.Model([beam], [bf.Clamp(beam.start)], masses=[body], connectors=[bf.SpringDamper(tip, (2, 1), 1e3)])
    small = bf.reduce(model, [{"point": beam.end, "arm": tip}[place]], 8)
    assert small.modes(3).frequencies == pytest.approx(bf.solve_modes(model, 3).frequencies, rel=2e-4)
    with pytest.raises(bf.InputError, match="conditions of Weld"):
        bf.reduce(model, [beam.end, tip], 2)


def test_an_interface_on_an_inclined_roller_is_named():
    other = bf.Beam(bf.Line((2, 0), (2, 1)), 2, bf.CRBF(3), bf.Rectangle(0.02, 0.02), STEEL)
    supports = [bf.Clamp(BEAM.start), bf.Roller(other.start, normal=(0.6, 0.8)), bf.Pin(other.end)]
    with pytest.raises(bf.InputError, match="conditions of an inclined roller"):
        bf.reduce(bf.Model([BEAM, other], supports), [other.start], 2)
