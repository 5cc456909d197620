"""Any two quantities of a solution against each other."""

import numpy as np
import pytest

import beamfem as bf

OWN = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), 4, bf.CRBF(3), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
PUSHED = bf.Model([OWN], [bf.Clamp(OWN.start), bf.Prescribed(OWN.end, ux=-0.1, uy=0.05)])


def drawn(figure):
    return figure.axes[0].lines[0].get_xydata()


def test_a_reaction_is_drawn_over_a_displacement():
    solution = bf.solve_static(PUSHED, steps=8)
    figure = solution.plot_curve(("ux", OWN.end), ("fx", OWN.start))
    expected = np.column_stack([solution.displacement(OWN.end)[:, 0], solution.reaction(OWN.start)[:, 0]])
    assert drawn(figure) == pytest.approx(expected)
    axes = figure.axes[0]
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("displacement ux at (1, 0) [m]", "reaction fx at (0, 0) [N]")


def test_load_factors_times_and_numbers_of_ones_own_too(tmp_path):
    solution = bf.solve_static(PUSHED, steps=8)
    energy = solution.energy().strain
    figure = solution.plot_curve("load_factor", ("strain energy [J]", energy), tmp_path / "energy.png")
    assert drawn(figure) == pytest.approx(np.column_stack([solution.load_factor, energy]))
    assert figure.axes[0].get_xlabel() == "load factor [-]"
    assert (tmp_path / "energy.png").stat().st_size > 5000
    hanging = bf.Model([OWN], [bf.Pin(OWN.start)], [bf.Gravity((0.0, -9.81))])
    motion = bf.simulate(hanging, duration=0.1, step=1e-2)
    assert drawn(motion.plot_curve(("x", OWN.end), ("vy", OWN.end))).shape == (len(motion), 2)
    assert motion.plot_curve("time", motion.rotation(OWN.end)).axes[0].get_xlabel() == "time [s]"


@pytest.mark.parametrize(
    ("x", "said"),
    [
        (("uz", OWN.end), "x of a curve is no 'uz' of a point"),
        ("time", "x of a curve is no 'time'"),
        (np.zeros(3), "numbers, one a row"),
        (OWN.end, "numbers, one a row"),
        (("both", np.zeros(2, dtype=complex)), "numbers, one a row"),
        (("ux", 3), "numbers, one a row"),
    ],
)
def test_what_is_no_quantity_is_refused(x, said):
    solution = bf.solve_static(PUSHED)
    with pytest.raises(bf.InputError, match=said):
        solution.plot_curve(x, ("fx", OWN.start))


STIFF = bf.Model([OWN], [bf.Clamp(OWN.start)], [bf.PointForce(OWN.at(0.5), (0.0, -30.0))])
SOLVED = {
    "statics": lambda: bf.solve_static(STIFF, steps=3),
    "path": lambda: bf.trace_equilibrium(STIFF, until=1.0),
    "motion": lambda: bf.simulate(STIFF, duration=0.01, step=1e-3),
}


@pytest.mark.parametrize("kind", SOLVED)
def test_section_forces_stresses_and_energies_are_drawn(kind):
    solution = SOLVED[kind]()
    over = "time" if kind == "motion" else "load_factor"
    forces, stress, energy = solution.section_forces(OWN), solution.stresses(OWN), solution.energy()
    middle = int(np.flatnonzero(np.isclose(forces.arc_length, 0.5))[-1])  # just after the load
    for point, station in ((OWN.start, 0), (OWN.at(0.5), middle), (OWN.end, -1)):
        for name in ("moment", "normal", "shear"):
            expected = getattr(forces, name)[:, station]
            found = drawn(solution.plot_curve(over, (name, point)))[:, 1]
            assert found == pytest.approx(expected, rel=1e-9, abs=1e-9 * np.abs(getattr(forces, name)).max())
        figure = solution.plot_curve(over, ("stress", point))
        scale = 1e-6 if "[MPa]" in figure.axes[0].get_ylabel() else 1.0
        expected = scale * stress.von_mises[:, station]
        assert drawn(figure)[:, 1] == pytest.approx(expected, rel=1e-9, abs=1e-9 * scale * stress.von_mises.max())
    for name in ("kinetic", "strain", "potential", "total"):
        figure = solution.plot_curve(over, name)
        assert np.array_equal(drawn(figure)[:, 1], getattr(energy, name))
        assert figure.axes[0].get_ylabel() == f"{name} energy [J]"


def test_the_moment_at_a_clamp_is_force_times_arm():
    small = bf.Model([OWN], [bf.Clamp(OWN.start)], [bf.PointForce(OWN.end, (0.0, -1e-3))])
    figure = bf.solve_static(small).plot_curve("load_factor", ("moment", OWN.start))
    assert drawn(figure)[-1, 1] == pytest.approx(-1e-3, rel=1e-6)
    assert figure.axes[0].get_ylabel() == "bending moment at (0, 0) [N m]"


def test_a_section_without_stress_is_named():
    plain = bf.Beam(OWN.curve, 4, bf.CRBF(3), bf.Section.from_stiffness(1e6, 1e6, 1e2, 1.0, 1.0))
    solution = bf.solve_static(bf.Model([plain], [bf.Clamp(plain.start)], [bf.PointForce(plain.end, (0.0, 1.0))]))
    with pytest.raises(bf.InputError, match="no von Mises stress to draw: stresses need sections"):
        solution.plot_curve("load_factor", ("stress", plain.start))
    with pytest.raises(bf.InputError, match="did you mean moment"):
        solution.plot_curve("load_factor", ("momentum", plain.start))
    with pytest.raises(bf.InputError, match="did you mean strain"):
        solution.plot_curve("load_factor", "strains")


def test_the_moment_along_a_cantilever_is_a_parabola():
    loaded = bf.Model([OWN], [bf.Clamp(OWN.start)], [bf.DistributedLoad(OWN, (0.0, -1e-3))])
    figure = bf.solve_static(loaded).plot_along(OWN)
    s, moment = figure.axes[0].lines[1].get_xydata().T
    assert moment == pytest.approx(-0.5e-3 * (1.0 - s) ** 2, abs=1e-9)
    with pytest.raises(bf.InputError, match="no quantity 'momentum' along a beam; did you mean moment"):
        bf.solve_static(loaded).plot_along(OWN, "momentum")


def test_large_stresses_are_drawn_in_megapascals():
    solution = bf.solve_static(STIFF)
    figure = solution.plot_along(OWN, "von_mises")
    assert figure.axes[0].get_ylabel() == "von Mises stress [MPa]"
    peak = solution.stresses(OWN).peak()
    assert figure.axes[0].lines[1].get_ydata()[0] == pytest.approx(1e-6 * peak.value)
    assert f"von_mises {1e-6 * peak.value:.4g} MPa at 0 m" in repr(peak)
    bar = solution.plot(colour="stress").axes[1]
    assert bar.get_ylabel() == "von Mises stress [MPa]"
    assert bar.get_ylim()[1] == pytest.approx(1e-6 * peak.value, rel=0.05)


@pytest.mark.parametrize("moment", [0.02, -0.02])
def test_the_outer_stress_of_pure_bending_keeps_its_sign(moment):
    """M / W at the upper face, where both faces have the same size up to round-off."""
    bent = bf.solve_static(bf.Model([OWN], [bf.Clamp(OWN.start)], [bf.PointMoment(OWN.end, moment)]))
    stress = bent.plot_along(OWN, "outer").axes[0].lines[1].get_ydata()
    assert stress == pytest.approx(1e-6 * -moment * 6.0 / 0.01**3, rel=1e-6)


@pytest.mark.parametrize("follower", [False, True])
def test_the_applied_force_is_drawn_over_a_displacement(follower):
    push = bf.PointForce(OWN.end, (0.0, -30.0), amplitude=lambda at: 4.0 * at * (1.0 - at), follower=follower)
    solution = bf.solve_static(bf.Model([OWN], [bf.Clamp(OWN.start)], [push]), at=[0.0, 0.25, 0.5, 1.0])
    figure = solution.plot_curve(("uy", OWN.end), ("fy", push))
    assert drawn(figure)[:, 1] == pytest.approx(-solution.reaction(OWN.start)[:, 1], abs=1e-6)
    assert figure.axes[0].get_ylabel() == "applied fy [N]"
    with pytest.raises(bf.InputError, match="'ux' of a load"):
        solution.plot_curve(("ux", push), ("fy", push))
