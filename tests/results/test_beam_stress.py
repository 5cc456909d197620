"""Extreme stresses along beams against closed forms, as numbers and as colours."""

import numpy as np
import pytest
from section_laws import LinearLaw

import beamfem as bf
from beamfem.io.vtk_cells import bodies

# the same numbers under the names of several units
pytestmark = pytest.mark.filterwarnings("ignore::beamfem.UnitsWarning")

STEEL = bf.Material(2e11, 0.3, 7800.0, strength=250e6)
FORCE = 30.0


def cantilever(section, material=STEEL, element=None, force=(0.0, -FORCE)):
    own = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), 4, element or bf.CRBF(3), section, material)
    return own, bf.solve_static(bf.Model([own], [bf.Clamp(own.start)], [bf.PointForce(own.end, force)]))


@pytest.mark.parametrize(
    "element", [bf.CRBF(3), bf.ANCF(forces=bf.Structural()), bf.BilinearCRBF()], ids=lambda own: own.name
)
def test_stresses_of_a_rectangle_are_those_of_the_textbook(element):
    width, height = 0.02, 0.04
    own, solution = cantilever(bf.Rectangle(width, height), element=element)
    found, forces = solution.stresses(own), solution.section_forces(own)
    assert found.arc_length == pytest.approx(forces.arc_length)
    bending = forces.moment * 0.5 * height / (width * height**3 / 12.0)
    mean = forces.normal / (width * height)
    assert found.upper == pytest.approx(mean - bending, abs=1e-6)
    assert found.lower == pytest.approx(mean + bending, abs=1e-6)
    assert found.tension == pytest.approx(np.maximum(found.upper, found.lower), abs=1e-6)
    assert found.compression == pytest.approx(np.minimum(found.upper, found.lower), abs=1e-6)
    assert found.shear == pytest.approx(1.5 * np.abs(forces.shear) / (width * height), rel=1e-9, abs=1e-6)
    # over the height bending is linear and shear a parabola
    faces, across = np.maximum(np.abs(found.upper), np.abs(found.lower)), np.linspace(-1.0, 1.0, 2001)[:, None, None]
    inside = np.hypot(mean - bending * across, np.sqrt(3.0) * found.shear * (1.0 - across**2))
    assert found.von_mises == pytest.approx(inside.max(axis=0), rel=1e-9)
    assert found.von_mises[-1, 0] == pytest.approx(faces[-1, 0], rel=1e-9)
    assert found.utilisation == pytest.approx(found.von_mises / 250e6)


def test_the_peak_says_where_and_when():
    own, solution = cantilever(bf.Rectangle(0.02, 0.04))
    peak = solution.stresses(own).peak()
    assert (peak.arc_length, peak.row) == (0.0, len(solution) - 1)
    assert peak.value == pytest.approx(FORCE * 0.02 / (0.02 * 0.04**3 / 12.0), rel=1e-4)
    assert solution.stresses(own).peak("compression").value == pytest.approx(-peak.value, rel=1e-4)
    assert solution.stresses(own).peak("utilisation").value == pytest.approx(peak.value / 250e6)
    with pytest.raises(bf.InputError, match="there is no stress 'mises'"):
        solution.stresses(own).peak("mises")
    with pytest.raises(bf.UnknownPointError):
        solution.stresses(bf.Beam(own.curve, 4, bf.CRBF(3), own.section, STEEL))


def test_a_peak_carries_its_time_and_a_stress_shows_its_peaks():
    own, solution = cantilever(bf.Rectangle(0.02, 0.04))
    found = solution.stresses(own)
    peak = found.peak()
    assert (peak.at, peak.beam) == (1.0, own)
    assert f"von_mises {1e-6 * peak.value:.4g} MPa at 0 m in row 1, load factor 1" in repr(found)
    table = found._repr_html_()
    for head in ("von_mises [Pa]", "utilisation [-]", "at arc length [m]", "load factor"):
        assert head in table
    push = bf.PointForce(own.end, (0.0, -FORCE), amplitude=lambda t: float(np.sin(np.pi * t / 1e-3)))
    motion = bf.simulate(bf.Model([own], [bf.Clamp(own.start)], [push], units="N, m, ms"), 4e-3, 1e-4)
    moved = motion.stresses(own)
    peak = moved.peak()
    assert peak.at == motion.time[peak.row]
    assert f"t = {peak.at:.4g} ms" in repr(moved)
    assert "time [ms]" in moved._repr_html_()


def test_the_peak_of_a_frame_is_in_the_weaker_of_two_beams():
    """A post under a bracket: M = F a in both at the corner, and W of the post is an eighth of the bracket's.

    Of the post, both faces: F a / W and F / A, which presses.
    """
    force, arm = 10.0, 0.5
    thin, thick = bf.Rectangle(0.02, 0.01), bf.Rectangle(0.02, 0.02 * np.sqrt(2.0))
    post = bf.Beam(bf.Line((0.0, 0.0), (0.0, 1.0)), 4, bf.CRBF(3), thin, STEEL)
    bracket = bf.Beam(bf.Line((0.0, 1.0), (arm, 1.0)), 4, bf.CRBF(3), thick, STEEL)
    # so small that the frame stays as it is
    loads = [bf.PointForce(bracket.end, (0.0, -1e-4 * force))]
    model = bf.Model([bracket, post], [bf.Clamp(post.start)], loads, [bf.Rigid(post.end, bracket.start)])
    solution = bf.solve_static(model)
    peak = solution.peak_stress()
    bending, pressing = 1e-4 * force * arm / (0.02 * 0.01**2 / 6.0), 1e-4 * force / (0.02 * 0.01)
    assert peak.beam is post
    assert peak.value == pytest.approx(bending + pressing, rel=1e-4)
    assert (peak.row, peak.at) == (len(solution) - 1, 1.0)
    assert solution.peak_stress("compression").value == pytest.approx(-bending - pressing, rel=1e-4)
    assert solution.peak_stress("tension").value == pytest.approx(bending - pressing, rel=1e-4)
    shear = solution.peak_stress("shear")
    assert shear.beam is bracket
    assert shear.value == pytest.approx(1.5 * 1e-4 * force / (0.02 * 0.02 * np.sqrt(2.0)), rel=1e-3)
    with pytest.raises(bf.InputError, match="there is no stress 'mises'; did you mean von_mises"):
        solution.peak_stress("mises")


def test_a_peak_that_leaves_beams_out_warns_of_them():
    """Moments without a height define no stress: the largest one of the model may be there."""
    known = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), bf.Rectangle(0.02, 0.01), STEEL)
    unknown = bf.Beam(bf.Line((1, 0), (2, 0)), 4, bf.CRBF(2), bf.Section(2e-4, 1e-9), STEEL, "arm")
    loads, joint = [bf.PointForce(unknown.end, (0.0, 1e-3))], [bf.Rigid(known.end, unknown.start)]
    both = bf.solve_static(bf.Model([known, unknown], [bf.Clamp(known.start)], loads, joint))
    with pytest.warns(bf.UnknownStressWarning, match=r"1 of 2 beams \(arm\) is not known and is left out: .*height"):
        peak = both.peak_stress("tension")
    assert peak.beam is known
    assert peak.value == pytest.approx(1e-3 * 2.0 / (0.02 * 0.01**2 / 6.0), rel=1e-3)
    alone = bf.solve_static(bf.Model([unknown], [bf.Clamp(unknown.start)], loads))
    with pytest.warns(bf.UnknownStressWarning, match="of 1 of 1 beams .* is not known and is nan"):
        assert np.isnan(alone.peak_stress().value)


def test_layers_have_strengths_of_their_own():
    """The stiff layer carries more stress, the weak one is used up first."""
    weak = bf.Material(2e10, 0.3, 1000.0, strength=1e6)
    strip = bf.Layered([bf.Layer(STEEL, 0.01), bf.Layer(weak, 0.02), bf.Layer(STEEL, 0.01)], 0.02)
    own, solution = cantilever(strip, material=None)
    found = solution.stresses(own)
    stations = bodies(solution.model)
    layers = [layer.arrays(solution, slice(-1, None)) for layer in stations]
    assert found.tension[-1].max() == pytest.approx(max(part["stress_xx"].max() for part in layers), rel=1e-9)
    used = [
        part["von_mises_stress"].max() / own.strength for part, own in zip(layers, (STEEL, weak, STEEL), strict=True)
    ]
    assert np.argmax(used) == 1
    assert found.utilisation[-1].max() == pytest.approx(max(used), rel=1e-9)


def test_heat_that_only_strains_layers_against_each_other_is_seen():
    warm = bf.Material(2e11, 0.3, 7800.0, thermal_expansion=1.2e-5)
    warmer = bf.Material(2e11, 0.3, 7800.0, thermal_expansion=2.4e-5)
    strip = bf.Layered([bf.Layer(warm, 0.001), bf.Layer(warmer, 0.002), bf.Layer(warm, 0.001)], 0.01)
    own = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), 4, bf.CRBF(3), strip)
    solution = bf.solve_static(bf.Model([own], [bf.Clamp(own.start)], [bf.Temperature(own, 100.0)]))
    found = solution.stresses(own)
    # half of the section expands by the mean, 0.6e-3 less or more than by itself
    assert found.tension[-1] == pytest.approx(0.6e-3 * 2e11, rel=1e-9)
    assert found.compression[-1] == pytest.approx(-0.6e-3 * 2e11, rel=1e-9)
    assert found.lower[-1] == pytest.approx(0.6e-3 * 2e11, rel=1e-9)


def test_faces_count_where_the_width_inside_is_not_known():
    """A rolled section by its height: no shear stress inside, but the faces have none."""
    tee = bf.Section(area=8e-4, second_moment=1e-7, height=0.04, centroid=0.015)
    own, solution = cantilever(tee)
    found = solution.stresses(own)
    forces = solution.section_forces(own)
    assert found.upper == pytest.approx(forces.normal / 8e-4 - forces.moment * 0.025 / 1e-7, rel=1e-9, abs=1e-6)
    assert found.lower == pytest.approx(forces.normal / 8e-4 + forces.moment * 0.015 / 1e-7, rel=1e-9, abs=1e-6)
    assert found.von_mises == pytest.approx(np.maximum(np.abs(found.lower), np.abs(found.upper)))
    assert np.isnan(found.shear).all()
    assert found.peak("utilisation").value == pytest.approx(found.von_mises.max() / 250e6)
    half = lambda s: bf.Rectangle(0.02, 0.04) if s < 0.5 else tee  # noqa: E731
    own, solution = cantilever(half)
    assert np.isfinite(solution.stresses(own).von_mises).all()
    assert solution.plot(colour="stress").axes[1].get_ylabel() == "von Mises stress [MPa]"


def test_the_peak_of_tension_is_no_compression():
    concrete = bf.Material(3e10, 0.2, 2400.0)
    own = bf.Beam(bf.Line((0, 0), (0, 4)), 8, bf.CRBF(3), bf.Rectangle(0.3, 0.3), concrete)
    loads = [bf.PointForce(own.end, (0, -9e5)), bf.PointForce(own.at(0.5), (6e4, 0))]
    solution = bf.solve_static(bf.Model([own], [bf.Pin(own.start), bf.Roller(own.end, (1, 0))], loads))
    found = solution.stresses(own)
    # M = P tan(k L / 2) / 2 k under the thrust N = k^2 EI of a beam without shear, which adds N / ks G A = 0.1 per cent
    k = np.sqrt(9e5 / (3e10 * 0.3**4 / 12))
    moment = 6e4 * np.tan(2.0 * k) / (2.0 * k)
    assert found.peak("tension").value == pytest.approx(moment / (0.3**3 / 6) - 9e5 / 0.09, rel=3e-3)
    assert found.peak("tension").arc_length == pytest.approx(2.0)
    assert found.peak("compression").value < -2e7


def test_what_is_not_known_is_no_number():
    shapeless = bf.Section(area=8e-4, second_moment=1e-7)
    shape = "stresses need sections with a material and a height"
    for section, material, why in (
        (shapeless, STEEL, shape),
        (LinearLaw(1e7, 1e6, 1e3, 1.0, 1e-4), None, "the section law LinearLaw tells resultants, but no stress"),
        (bf.Section.from_stiffness(1e7, 1e6, 1e3, 1.0, 1e-4), STEEL, shape),
    ):
        own, solution = cantilever(section, material)
        found = solution.stresses(own)
        assert np.isnan(found.von_mises).all()
        assert np.isnan(found.peak().value)
        with pytest.raises(bf.InputError, match=f"no beam has a von Mises stress to draw: {why}"):
            solution.plot(colour="stress")
        with pytest.raises(bf.InputError, match=f"the section at this point has no von Mises stress to draw: {why}"):
            solution.plot_curve("load_factor", ("stress", own.start))
    own, solution = cantilever(bf.Rectangle(0.02, 0.04), bf.Material(2e11, 0.3, 7800.0))
    assert np.isnan(solution.stresses(own).utilisation).all()
    with pytest.raises(bf.InputError, match="strength"):
        solution.plot(colour="utilisation")


def test_a_beam_without_stress_does_not_take_it_from_others():
    own = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), 4, bf.CRBF(3), bf.Rectangle(0.02, 0.04), STEEL)
    other = bf.Beam(bf.Line((1.0, 0.0), (2.0, 0.0)), 4, bf.CRBF(3), bf.Section(8e-4, 1e-7), STEEL)
    loads, joints = [bf.PointForce(other.end, (0.0, -FORCE))], [bf.Rigid(own.end, other.start)]
    solution = bf.solve_static(bf.Model([own, other], [bf.Clamp(own.start)], loads, joints))
    figure = solution.plot(colour="stress")
    assert figure.axes[1].get_ylabel() == "von Mises stress [MPa]"
    peak = solution.stresses(own).peak().value
    assert figure.axes[1].get_ylim()[1] == pytest.approx(1e-6 * peak, rel=1e-9)


def test_many_rows_are_worked_on_in_parts(monkeypatch):
    own, solution = cantilever(bf.Rectangle(0.02, 0.04))
    whole = solution.stresses(own)
    monkeypatch.setattr("beamfem.results.beam_stress._VALUES", 10)
    assert solution.stresses(own).von_mises == pytest.approx(whole.von_mises, rel=1e-12)


def test_a_strength_is_a_positive_number():
    with pytest.raises(bf.InputError, match="strength of Material"):
        bf.Material(2e11, 0.3, 7800.0, strength=-1.0)


def test_stations_of_stresses_are_exactly_those_of_section_forces(rng):
    """Both ends of an element were rounded apart: the arc length fell by a digit where two elements meet."""
    for length in rng.uniform(0.3, 3.0, 20).tolist():
        elements = [0.0, *np.sort(rng.uniform(size=6)).tolist(), 1.0]
        own = bf.Beam(bf.Line((0.0, 0.0), (length, 0.7)), elements, bf.CRBF(1), bf.Rectangle(0.02, 0.04), STEEL)
        solution = bf.solve_static(bf.Model([own], [bf.Clamp(own.start)]))
        arc = solution.stresses(own).arc_length
        assert np.array_equal(arc, solution.section_forces(own).arc_length)
        assert (np.diff(arc) >= 0.0).all()


def test_a_section_with_fewer_layers_has_the_strength_of_its_own_layers():
    """Three layers up to the middle, two behind it: in pure bending each half is used as if it were the whole beam."""
    weak = bf.Material(1e11, 0.3, 1000.0, strength=1e6)
    strong = bf.Material(2e11, 0.3, 1000.0, strength=1e9)
    three = bf.Layered([bf.Layer(weak, 0.01), bf.Layer(strong, 0.01), bf.Layer(weak, 0.01)], 0.02)
    two = bf.Layered([bf.Layer(weak, 0.015), bf.Layer(strong, 0.015)], 0.02)

    def used(section):
        own = bf.Beam(bf.Line((0.0, 0.0), (1.0, 0.0)), 4, bf.CRBF(3), section)
        model = bf.Model([own], [bf.Clamp(own.start)], [bf.PointMoment(own.end, 10.0)])
        return bf.solve_static(model).stresses(own).utilisation[-1]

    both = used(lambda s: three if s < 0.5 else two)
    half = len(both) // 2
    assert both[:half].max() == pytest.approx(used(three).max(), rel=1e-6)
    assert both[half + 1 :].max() == pytest.approx(used(two).max(), rel=1e-6)
