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


def test_an_option_that_is_misspelt_is_named_with_the_right_one():
    solution = bf.solve_static(PUSHED)
    with pytest.raises(bf.InputError, match=r"Solution\.plot has no parameter 'color'; did you mean colour"):
        solution.plot(color="moment")
    with pytest.raises(bf.InputError, match="animate has no parameter 'fsp'"):
        solution.animate("film.gif", fsp=3)
