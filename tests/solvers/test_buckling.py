"""Critical loads against the Reissner column in closed form, and the ways a search for them ends."""

from contextlib import nullcontext

import numpy as np
import pytest
from scipy.optimize import brentq

import beamfem as bf

STEEL = bf.Material(2e11, 0.3, 7800.0)
SUPPORTS = {
    "cantilever": lambda b: [bf.Clamp(b.start)],
    "hinged-hinged": lambda b: [bf.Pin(b.start), bf.Roller(b.end)],
    "clamped-hinged": lambda b: [bf.Clamp(b.start), bf.Roller(b.end)],
    "clamped-clamped": lambda b: [bf.Clamp(b.start), bf.Prescribed(b.end, uy=0.0, rotation=0.0)],
}


def reissner(condition, low, high, slenderness, shear_factor=5.0 / 6.0):
    """Return P L^2/EI of a column of length L = slenderness h that is compressed by P and then bends.

    With the axial stretch 1 - P/EA and V the transverse force, linearised: EI t'' + P eta t = -V eta,
    y' = eta t + V/GA, eta = 1 - P/EA + P/GA; condition(u, q) = 0 with u = L sqrt(P eta/EI), q = P/(eta GA).
    """
    axial = 12.0 * slenderness**2
    shear = axial * shear_factor / 2.6

    def value(load):
        eta = 1.0 - load / axial + load / shear
        return condition(np.sqrt(load * eta), load / (eta * shear))

    return brentq(value, low, high, xtol=1e-13, rtol=1e-14)


def column(supports, slenderness, elements, element=None, direction=(1.0, 0.0), load=-1.0, shear_factor=5.0 / 6.0):
    """A column of length 1 and its critical load in units of EI/L^2."""
    end = np.array(direction) / np.hypot(*direction)
    section = bf.Rectangle(0.1, 1.0 / slenderness, shear_factor)
    beam = bf.Beam(bf.Line((0, 0), tuple(end)), elements, element or bf.CRBF(4), section, STEEL)
    force = load * STEEL.youngs_modulus * section.second_moment
    return bf.Model([beam], supports(beam), [bf.PointForce(beam.end, tuple(force * end))])


@pytest.mark.parametrize(
    ("name", "slenderness", "exact"),
    [
        ("hinged-hinged", 20, 9.8269530896528),  # 8.buckling.hinged-hinged.L/h=20.ks=5/6
        ("cantilever", 10, 2.4567382724132),  # 8.buckling.cantilever.L/h=10.ks=5/6
    ],
)
def test_columns_buckle_at_the_reference_load(name, slenderness, exact):
    found = bf.solve_buckling(column(SUPPORTS[name], slenderness, 12))
    assert found.load_factors == pytest.approx([exact], rel=1e-10)
    # without its compression before, a column is stiffer or softer by about P/EA + P/GA
    assert found.linearised == pytest.approx([exact], rel=5e-3)
    assert abs(found.linearised[0] / exact - 1.0) > 1e-4


@pytest.mark.parametrize(("slenderness", "shear_factor"), [(10, 5 / 6), (10, 0.3), (60, 5 / 6), (5000, 1.0)])
@pytest.mark.parametrize(
    ("name", "conditions"),
    [
        ("cantilever", [(lambda u, q: np.cos(u), 1.5, 4.0), (lambda u, q: np.cos(u), 15.0, 30.0)]),
        ("hinged-hinged", [(lambda u, q, n=n: u - n * np.pi, 8.0 * n, 11.0 * n**2) for n in (1, 2, 3)]),
        ("clamped-hinged", [(lambda u, q: np.sin(u) - u * (1.0 - q) * np.cos(u), 15.0, 25.0)]),
        (
            "clamped-clamped",
            [
                (lambda u, q: u - 2.0 * np.pi, 20.0, 60.0),
                (lambda u, q: np.sin(u / 2) - u / 2 * (1.0 - q) * np.cos(u / 2), 45.0, 90.0),
            ],
        ),
    ],
)
def test_columns_of_every_end_buckle_at_the_root_of_their_equation(name, conditions, slenderness, shear_factor):
    exact = [reissner(*condition, slenderness, shear_factor) for condition in conditions]
    model = column(SUPPORTS[name], slenderness, 24, shear_factor=shear_factor)
    found = bf.solve_buckling(model, len(exact))
    # the error of order 8 of a third mode over 24 elements, and round-off that grows with the slenderness squared
    assert found.load_factors == pytest.approx(exact, rel=4e-9 if slenderness < 5000 else 3e-7)


def test_an_inclined_column_buckles_at_the_same_load():
    def supports(beam):
        return [bf.Pin(beam.start), bf.Roller(beam.end, (-0.5, 1.0))]

    found = bf.solve_buckling(column(supports, 20, 12, direction=(1.0, 0.5)))
    assert found.load_factors == pytest.approx([9.8269530896528], rel=1e-9)


def test_every_element_finds_load_and_shape(element):
    """Elements that lock or whose bending stiffness is not EI agree with their own vibration: no frequency is left."""
    model = column(SUPPORTS["cantilever"], 10, max(8 // element.field.degree, 3), element)
    found = bf.solve_buckling(model)
    shape = found.solution(amplitude=0.1)
    beam = model.beams[0]
    along = [shape.displacement(beam.at(x))[1, 1] / shape.displacement(beam.end)[1, 1] for x in (0.25, 0.5, 0.75)]
    # three cubic elements are off by 1e-3
    assert along == pytest.approx(1.0 - np.cos(0.5 * np.pi * np.array([0.25, 0.5, 0.75])), abs=1.5e-3)
    assert np.abs(shape.displacement(beam.end)[1, 1]) == pytest.approx(0.1)
    for load, stable in ((0.999, True), (1.001, False)):
        loaded = bf.Model([beam], model.supports, [_times(model.loads[0], load * found.load_factors[0])])
        with nullcontext() if stable else pytest.warns(bf.UnstableWarning):
            solution = bf.solve_static(loaded)
        modes = bf.solve_modes(loaded, 1, about=solution)
        assert (modes.growth[0] == 0.0) == stable


def _times(load, factor):
    return bf.PointForce(load.point, tuple(factor * np.array(load.vector)))


def toggle(slenderness):
    """Half of a shallow two-bar truss, of length l0 = sqrt(1.01) and rise 0.1; load in units of EA/1000."""
    length = np.hypot(1.0, 0.1)
    section = bf.Rectangle(0.1, length / slenderness)
    bar = bf.Beam(bf.Line((0, 0), (1, 0.1)), 8, bf.CRBF(4), section, STEEL)
    load = bf.PointForce(bar.end, (0.0, -1e-3 * STEEL.youngs_modulus * section.area))
    return bf.Model([bar], [bf.Pin(bar.start), bf.Roller(bar.end, (1, 0))], [load]), length


def test_a_slender_toggle_buckles_on_its_way_down():
    """The bar of length l carries N = P l / y and buckles at N_cr of the Reissner column, where P = N_cr y / l."""
    model, length = toggle(50)
    found = bf.solve_buckling(model)
    strain = reissner(lambda u, q: u - np.pi, 8.0, 11.0, 50) / (12.0 * 50**2)
    shortened = length * (1.0 - strain)
    exact = 1e3 * strain * np.sqrt(shortened**2 - 1.0) / shortened
    assert found.load_factors == pytest.approx([exact], rel=1e-8)
    assert found.linearised[0] > 1.002 * exact
    assert np.hypot(*(found.states[0].reshape(-1, 3)[-1, :2])) == pytest.approx(shortened, rel=1e-9)


def test_a_stocky_toggle_ends_in_a_limit_point():
    """P = EA (1 - l/l0) y/l is largest at l^3 = l0, before the bar buckles."""
    model, length = toggle(5)
    at = length ** (1 / 3)
    exact = 1e3 * (1.0 - at / length) * np.sqrt(at**2 - 1.0) / at
    found = bf.solve_buckling(model, 3)
    assert found.kinds == ("limit point",)
    assert found.load_factors == pytest.approx([exact], rel=1e-9)
    assert len(found.linearised) == 3
    assert repr(found).startswith("Buckling(limit point at load factor ")


def test_loads_that_do_not_scale_come_first():
    """A constant part of the force is a start from which less is missing."""
    model = column(SUPPORTS["cantilever"], 10, 12)
    force = model.loads[0]
    constant = bf.PointForce(force.point, force.vector, scale=False)
    found = bf.solve_buckling(bf.Model(model.beams, model.supports, [force, constant]))
    assert found.load_factors == pytest.approx([2.4567382724132 - 1.0], rel=1e-9)
    state = bf.solve_static(model)
    later = bf.solve_buckling(model, about=state)
    assert later.load_factors == pytest.approx([2.4567382724132], rel=1e-9)
    exact = 2.4567382724132
    assert abs(later.linearised[0] - exact) < abs(bf.solve_buckling(model).linearised[0] - exact)


def test_many_unknowns_take_the_sparse_way():
    found = bf.solve_buckling(column(SUPPORTS["hinged-hinged"], 20, 60), 3)
    few = bf.solve_buckling(column(SUPPORTS["hinged-hinged"], 20, 16), 3)
    assert found.load_factors == pytest.approx(few.load_factors, rel=2e-8)


def test_bad_input_is_named():
    model = column(SUPPORTS["hinged-hinged"], 10, 2, bf.CRBF(1))
    with pytest.raises(bf.InputError, match="count must be at least 1"):
        bf.solve_buckling(model, 0)
    with pytest.raises(bf.InputError, match="only 6 unknown"):
        bf.solve_buckling(model, 7)
    with pytest.raises(bf.FreeMotionError, match=r"turns about \(0, 0\)"):
        bf.solve_buckling(bf.Model(model.beams, [bf.Pin(model.beams[0].start)], model.loads))
    with pytest.raises(bf.InputError, match="no load grows"):
        bf.solve_buckling(bf.Model(model.beams, model.supports))
    with pytest.raises(bf.InputError, match=r"no load is critical at strains below 20%"):  # shear buckling in tension
        bf.solve_buckling(column(SUPPORTS["hinged-hinged"], 10, 8, load=1.0))
    pulled = column(SUPPORTS["hinged-hinged"], 10, 8, bf.CRBF(4, bf.SplitContinuum()), load=1.0)
    with pytest.raises(bf.InputError, match=r"no positive load factor is critical .* the loads stiffen the model"):
        bf.solve_buckling(pulled)
    unstable = column(SUPPORTS["cantilever"], 10, 6, load=-3.0)
    with pytest.warns(bf.UnstableWarning):
        loaded = bf.solve_static(unstable)
    with pytest.raises(bf.InputError, match="unstable already"):
        bf.solve_buckling(unstable, about=loaded)
    with pytest.raises(bf.InputError, match="mode must be between 0 and 0"):
        bf.solve_buckling(column(SUPPORTS["cantilever"], 10, 6)).solution(1)


@pytest.mark.parametrize("unit", [1e-6, 1e-3, 1.0, 1e3, 1e6])
def test_a_following_load_is_refused_in_any_unit_of_length(unit):
    """In a model of a micrometre its moments seemed as small as round-off beside forces, and it was taken for dead."""
    section, material = bf.Rectangle(0.03 * unit, 0.03 * unit), bf.Material(7e10, 0.3, 2000.0)
    beam = bf.Beam(bf.Arc((0.0, 0.0), unit, 0.0, 1.5), 8, bf.CRBF(3), section, material)
    size = 7e10 * (0.03 * unit) ** 4 / 12.0 / unit**3
    loads = [bf.DistributedLoad(beam, (0.1 * size, 0.9 * size), follower=True)]
    with pytest.raises(bf.InputError, match="some load follows the beam"):
        bf.solve_buckling(bf.Model([beam], [bf.Clamp(beam.start)], loads))


def test_a_column_that_buckles_at_large_strains_is_not_said_to_be_stiffened():
    """It has a critical load, as paths find it: (P / E I) (1 + P / G A - P / E A) = (pi / L)^2, Reissner's column."""
    section, material = bf.Rectangle(1.0 / 1.5, 1.0 / 1.5), bf.Material(1e6, 0.0, 1.0)
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(3), section, material)
    axial = 1e6 * section.area
    load = bf.PointForce(beam.end, (-axial, 0.0))
    model = bf.Model([beam], [bf.Pin(beam.start), bf.Roller(beam.end, (0, 1))], [load])
    with pytest.raises(bf.InputError, match=r"lowest critical load strains the model by 23%\. trace_equilibrium finds"):
        bf.solve_buckling(model, 1)
    bending, shear = 1e6 * section.second_moment, section.shear_factor * 0.5e6 * section.area
    exact = np.roots([(1.0 / shear - 1.0 / axial) / bending, 1.0 / bending, -(np.pi**2)]).max() / axial
    with pytest.warns(bf.LargeStrainWarning):
        path = bf.trace_equilibrium(model, 0.3)
    assert [point.load_factor for point in path.bifurcations] == pytest.approx([exact], rel=1e-6)


def test_a_path_that_bends_where_linearised_stability_predicts_buckling_is_warned_of():
    """The critical points of its bent path are far above the load that the structure bears upright."""
    steel = bf.Material(2.1e11, 0.3, 7850.0)
    strut = bf.Beam(bf.Line((0, 0), (5, 0)), 6, bf.CRBF(4), bf.Profile("IPE 200"), steel)
    loads = [bf.Gravity((0.0, -9.81), scale=False), bf.PointForce(strut.end, (-1e3, 0.0))]
    model = bf.Model([strut], [bf.Pin(strut.start), bf.Roller(strut.end)], loads)
    with pytest.warns(UserWarning, match="linearised stability predicts a critical load factor of 158"):
        buckling = bf.solve_buckling(model)
    assert buckling.load_factors[0] > 2.0 * buckling.linearised[0]
