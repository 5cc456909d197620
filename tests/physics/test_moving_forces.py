"""Forces that move along beams: against forces at points, influence lines and the closed form of Fryba."""

import numpy as np
import pytest

import beamfem as bf

STEEL, SECTION = bf.Material(2.1e11, 0.3, 7850.0), bf.Rectangle(0.05, 0.05)
LENGTH, FORCE = 4.0, 500.0
EI, MASS = 2.1e11 * SECTION.second_moment, 7850.0 * SECTION.area


def bridge(element=None, elements=8):
    beam = bf.Beam(bf.Line((0, 0), (LENGTH, 0)), elements, element or bf.CRBF(4), SECTION, STEEL)
    return beam, bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end)])


def test_a_force_at_a_node_is_that_of_a_point_force(element):
    beam, model = bridge(element, 4)
    moving = bf.MovingForce(beam, lambda load: 0.25 * LENGTH, (0.3 * FORCE, -FORCE), scale=True)
    fixed = bf.PointForce(beam.at(0.25), (0.3 * FORCE, -FORCE))
    one, other = (bf.solve_static(model.with_loads([load])) for load in (moving, fixed))
    assert one.p[-1] == pytest.approx(other.p[-1], abs=1e-10)
    sections = [solution.section_forces(beam) for solution in (one, other)]
    at_end = [forces.shear[-1, -1] for forces in sections]
    assert at_end[0] == pytest.approx(at_end[1], rel=1e-6)


def test_between_nodes_it_balances_the_reactions():
    beam, model = bridge(elements=3)
    place = 0.41 * LENGTH
    wheel = bf.MovingForce(beam, lambda load: place, (0.0, -FORCE), amplitude=lambda load: load)
    solution = bf.solve_static(model.with_loads([wheel]))
    ends = solution.reaction(beam.start)[-1, 1], solution.reaction(beam.end)[-1, 1]
    sag = np.hypot(*(solution.position(beam.end)[-1] - solution.position(beam.start)[-1]))
    x = solution.position(beam.at(0.41))[-1, 0]
    assert ends == pytest.approx((FORCE * (sag - x) / sag, FORCE * x / sag), rel=1e-9)


def test_influence_line_of_the_deflection():
    beam, model = bridge()
    wheel = bf.MovingForce(beam, lambda load: LENGTH * load, (0.0, -0.01 * FORCE))
    solution = bf.solve_static(model.with_loads([wheel]), steps=40)
    s = np.minimum(LENGTH * solution.at, LENGTH * (1 - solution.at))
    shear = 5 / 6 * 2.1e11 / 2.6 * SECTION.area
    line = 0.01 * FORCE * s * ((3 * LENGTH**2 - 4 * s**2) / (48 * EI) + 1 / (2 * shear))
    assert -solution.displacement(beam.at(0.5))[:, 1] == pytest.approx(line, abs=2e-5 * line.max())


def test_a_force_that_crosses_a_bridge_at_a_speed():
    """Euler-Bernoulli beam, Fryba 1999, section 1.2."""
    beam, model = bridge()
    speed, duration = 30.0, LENGTH / 30.0
    wheel = bf.MovingForce(beam, lambda time: speed * time, (0.0, -0.01 * FORCE))
    motion = bf.simulate(model.with_loads([wheel]), duration, duration / 2000, save_every=20)
    n, t = np.arange(1, 60)[:, None], motion.time
    own, forced = (n * np.pi / LENGTH) ** 2 * np.sqrt(EI / MASS), n * np.pi * speed / LENGTH
    modes = (np.sin(forced * t) - forced / own * np.sin(own * t)) / (own**2 - forced**2)
    sag = 2 * 0.01 * FORCE / (MASS * LENGTH) * (np.sin(n * np.pi / 2) * modes).sum(axis=0)
    assert -motion.displacement(beam.at(0.5))[:, 1] == pytest.approx(sag, abs=2e-3 * sag.max())
    assert not motion.warnings


def test_off_the_beam_there_is_no_force_and_it_is_drawn_and_saved(tmp_path):
    beam, model = bridge(elements=4)
    wheel = bf.MovingForce(beam, lambda time: 40.0 * time - 1.0, (0.0, -FORCE))
    motion = bf.simulate(model.with_loads([wheel]), 0.15, 1e-3)
    early = motion.time < 0.02
    assert motion.displacement(beam.at(0.5))[early] == pytest.approx(0.0, abs=1e-13)
    assert motion.displacement(beam.at(0.5))[~early][-1].any()
    motion.plot(tmp_path / "wheel.svg")
    motion.to_html(tmp_path / "wheel.html")
    motion.to_vtk(tmp_path / "wheel.vtkhdf")
    motion.save(tmp_path / "wheel.h5")
    again = bf.load(tmp_path / "wheel.h5")
    assert again.model.loads[0].position(0.05) == pytest.approx(1.0)
    assert again.section_forces(again.model.beams[0]).moment[-1] == pytest.approx(
        motion.section_forces(beam).moment[-1]
    )


def test_work_of_a_moving_force():
    """It is what the bridge stores and moves with: no energy drifts away that a warning would name."""
    beam, model = bridge(elements=4)
    wheel = bf.MovingForce(beam, lambda time: LENGTH * np.sin(3.0 * time) ** 2, (0.0, -FORCE))
    motion = bf.simulate(model.with_loads([wheel]), 1.0, 1e-3)
    assert motion.energy_drift is None
    assert not motion.warnings


def test_refused_with_a_reason():
    beam, _ = bridge()
    with pytest.raises(bf.InputError, match="position of MovingForce must be a function of time"):
        bf.MovingForce(beam, 1.0, (0.0, -1.0))
    with pytest.raises(bf.InputError, match="vector of MovingForce"):
        bf.MovingForce(beam, lambda time: time, 1.0)


def test_a_path_crosses_a_bridge_from_outside_to_outside():
    beam, model = bridge(elements=4)
    wheel = bf.MovingForce(beam, lambda load: LENGTH * (1.2 * load - 0.1), (0.0, -FORCE))
    loaded = model.with_loads([wheel])
    path = bf.trace_equilibrium(loaded, until=0.5)
    static = bf.solve_static(loaded, at=[0.5])
    assert path.position(beam.at(0.5))[-1] == pytest.approx(static.position(beam.at(0.5))[-1], abs=1e-9)
    across = bf.trace_equilibrium(loaded, until=1.0)
    assert across.position(beam.at(0.5))[-1] == pytest.approx((0.5 * LENGTH, 0.0), abs=1e-9)


def test_a_path_ends_where_a_force_leaves_a_free_end():
    beam = bridge(elements=4)[0]
    wheel = bf.MovingForce(beam, lambda load: 2.0 * LENGTH * load, (0.0, -0.1 * FORCE))
    cantilever = bf.Model([beam], [bf.Clamp(beam.start)], [wheel])
    with pytest.raises(bf.ConvergenceError, match=r"at load factor 0.5, where presence of MovingForce .* from 1 to 0"):
        bf.trace_equilibrium(cantilever, until=1.0)
    solution = bf.solve_static(cantilever)
    assert solution.at == pytest.approx([0.0, 0.5, 0.5, 1.0])
    tip = solution.displacement(beam.end)[:, 1]
    alone = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, -0.1 * FORCE))]))
    assert tip == pytest.approx([0.0, alone.displacement(beam.end)[-1, 1], 0.0, 0.0], abs=1e-9)


@pytest.mark.parametrize("back", [False, True])
def test_a_force_that_goes_over_to_the_next_beam_acts_once_at_the_joint(back):
    """Both beams had it when it stood there: twice the force for a step."""
    whole, model = bridge()
    halves = [bf.Beam(bf.Line((x, 0), (x + 2.0, 0)), 4, bf.CRBF(4), SECTION, STEEL) for x in (0.0, 2.0)]
    place = (lambda t: LENGTH - 8.0 * t) if back else (lambda t: 8.0 * t)
    force = (0.0, -FORCE)
    wheels = [bf.MovingForce(halves[0], place, force), bf.MovingForce(halves[1], lambda t: place(t) - 2.0, force)]
    supports, joints = [bf.Pin(halves[0].start), bf.Roller(halves[1].end)], [bf.Rigid(halves[0].end, halves[1].start)]
    for loads in (wheels, wheels[::-1]):
        parted = bf.Model(halves, supports, loads, joints)
        one, other = (
            bf.simulate(m, 0.5, 0.0125) for m in (model.with_loads([bf.MovingForce(whole, place, force)]), parted)
        )
        assert place(one.time[20]) == 2.0
        sag = one.displacement(whole.at(0.5))
        assert other.displacement(halves[0].end) == pytest.approx(sag, abs=1e-9 * abs(sag).max())
        still = [bf.MovingForce(load.beam, lambda t, own=load: own.position(0.25), force, scale=True) for load in loads]
        static = bf.solve_static(bf.Model(halves, supports, still, joints))
        assert static.reaction(halves[0].start)[-1, 1] == pytest.approx(0.5 * FORCE, rel=1e-3)
