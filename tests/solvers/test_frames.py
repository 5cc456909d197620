"""Frames and arches followed through limit points and bifurcations; references without finite elements."""

import numpy as np
import pytest
from scipy.optimize import brentq
from shooting import Member, solved

import beamfem as bf


def vertex(load, at, width):
    """Extremum of load(w) near w = at: of the parabola of fourth order through five points."""
    points = at + width * np.arange(-2.0, 3.0)
    quartic = np.polynomial.Polynomial.fit(points, [load(w) for w in points], 4)
    place = min(quartic.deriv().roots(), key=lambda root: abs(root - at)).real
    return quartic(place), place


# Lee's frame -------------------------------------------------------------------------------------------------------


def lee(section, material, element=None, elements=10):
    common = {"element": element or bf.CRBF(4), "section": section, "material": material}
    column = bf.Beam(bf.Line((0, 0), (0, 120)), elements, **common)
    beam = bf.Beam(bf.Line((0, 120), (120, 120)), elements, **common)
    load = bf.PointForce(beam.at(0.2), (0, -1.0))
    supports = [bf.Pin(column.start), bf.Pin(beam.end)]
    model = bf.Model([column, beam], supports, [load], [bf.Rigid(column.end, beam.start)])
    path = bf.trace_equilibrium(model, lambda state: state.displacement(beam.at(0.2))[1] < -95.0)
    return column, beam, path


LEE = ((18.5445270944, 0.223986063846, 0.406285336485), (-9.39248964035, 0.751475005064, 0.485207983714))


@pytest.mark.parametrize("youngs_modulus", [7.2e6, 7.06e6])
def test_lees_frame_has_the_limit_points_of_the_reference(youngs_modulus):
    _, beam, path = lee(bf.Section(6.0, 2.0), bf.Material(youngs_modulus, 0.3, 1.0))
    assert len(path.limit_points) == 2
    for found, (load, u, w) in zip(path.limit_points, LEE, strict=True):
        assert found.load_factor * 120.0**2 / (2.0 * youngs_modulus) == pytest.approx(
            load, rel=1e-7 if load > 0 else 3e-7
        )
        assert found.displacement(beam.at(0.2)) / 120.0 == pytest.approx((u, -w), abs=1e-7)
    assert path.bifurcations == ()
    # it snaps back: the load point rises while the load falls behind the first limit point
    assert np.any(np.diff(path.displacement(beam.at(0.2))[:, 1]) > 0.0)
    assert path.statistics.cuts <= 2
    assert path.iterations < 250


@pytest.mark.parametrize(
    ("axial", "shear"),
    [
        (2 / 6 / 120**2, 2 / 6 / 120**2 * 2.6 / 0.3),  # k_s = 0.3
        (1e-3, 2e-3),  # a stocky frame, h / L = 0.1
        (1e-7, 3e-7),  # all but inextensible
    ],
    ids=["ks=0.3", "stocky", "slender"],
)
def test_lees_frame_with_other_stiffnesses_agrees_with_shooting(axial, shear):
    """Both limit loads; the shooting starts from what elements found, but ends where its own conditions hold."""
    section = bf.Section.from_stiffness(120.0**-2 / axial, 120.0**-2 / shear, 1.0, 1.0, 1.0)
    column, beam, path = lee(section, None)
    first, second = Member(1.0, 0.5 * np.pi, axial=axial, shear=shear), Member(1.0, 0.0, axial=axial, shear=shear)

    def run(turn, nx, ny, load):
        """Displacement of the load point and the end state from turn and force at the lower hinge."""
        corner = first.run((0.0, 0.0, turn, nx, ny, 0.0))
        below = second.run(corner, 0.2)
        return below[:2] - (0.2, 1.0), second.after(0.2).run(below + np.array([0, 0, 0, 0, load, 0]))

    assert len(path.limit_points) == 2
    for found in path.limit_points:
        reaction = found.reaction(column.start) * 120.0**2
        known = [np.array([found.rotation(column.start), -reaction[0], -reaction[1], found.load_factor * 120.0**2])]

        def load_at(w, known=known):
            def left(v):
                at, end = run(*v)
                return (end[0] - 1.0, end[1] - 1.0, end[5], at[1] + w)

            known[0] = solved(left, known[0])
            return known[0][3]

        here = -found.displacement(beam.at(0.2))[1] / 120.0
        load, w = vertex(load_at, here, 2e-4)
        assert found.load_factor * 120.0**2 == pytest.approx(load, rel=3e-7)
        assert here == pytest.approx(w, abs=1e-6)


STRUCTURAL = bf.Structural()


@pytest.mark.parametrize(
    ("element", "elements", "within"),
    [
        (bf.CRBF(1), 20, 2e-2),
        (bf.CRBF(1), 60, 2e-3),
        (bf.CRBF(2), 8, 2e-3),
        (bf.CRBF(8), 5, 1e-7),
        (bf.ANCF(STRUCTURAL), 20, 1e-2),
        (bf.ANCF(bf.SplitContinuum()), 20, 1e-2),
        (bf.ANCF(bf.ElasticLine()), 20, 1e-1),
        (bf.ANCFCRBF(STRUCTURAL), 20, 2e-3),
        (bf.ANCFCRBF(bf.ElasticLine()), 20, 2e-3),
        (bf.BilinearCRBF(STRUCTURAL, "reduced"), 40, 4e-3),
        (bf.ShearRigid(), 20, 4e-3),
        (bf.BilinearCRBF(integration="reduced"), 40, None),
        (bf.ANCF(), 20, None),
        (bf.ANCFCRBF(), 20, None),
    ],
    ids=lambda value: getattr(value, "name", None),
)
def test_every_element_is_traced_through_lees_frame_without_a_hint(element, elements, within):
    """Continuum forces bend with (1 - nu) / (1 + nu) / (1 - 2 nu) times EI = 1.346 and have a frame of their own."""
    _, _, path = lee(bf.Section(6.0, 2.0, fourth_moment=1.2), bf.Material(7.2e6, 0.3, 1.0), element, elements)
    loads = [found.load_factor / 1000.0 for found in path.limit_points]
    assert len(loads) == 2
    assert path.bifurcations == ()
    assert path.iterations < 260
    if within is None:
        assert loads[0] == pytest.approx(1.36 * 18.5445, rel=0.04)
    else:
        assert loads[0] == pytest.approx(18.544527, rel=within)
        assert loads[1] == pytest.approx(-9.3924896, rel=5 * within)


# Williams' toggle --------------------------------------------------------------------------------------------------

WILLIAMS_LIMITS = ((33.8491411685, 0.231963322934, 631.491699114), (31.2444502955, 0.39174738873, 630.387539125))
WILLIAMS_CURVE = (
    (0.05, 15.180174658, 199.846554117),
    (0.2, 33.4816833462, 589.72752748),
    (0.35, 31.6741609867, 663.231139723),
    (0.5, 36.0440798889, 446.506386108),
    (0.7, 87.9957585627, -233.970160729),
)


def toggle(crown=()):
    common = {
        "element": bf.CRBF(4),
        "section": bf.Section(0.1885, 9.274e-4),
        "material": bf.Material(1e7, 0.3, 1.0),
    }
    left = bf.Beam(bf.Line((0, 0), (12.943, 0.386)), 6, **common)
    right = bf.Beam(bf.Line((12.943, 0.386), (25.886, 0)), 6, **common)
    supports = [bf.Clamp(left.start), bf.Clamp(right.end), *(make(left.end) for make in crown)]
    loads = [] if crown else [bf.PointForce(left.end, (0.0, -1.0))]
    return left, bf.Model([left, right], supports, loads, [bf.Rigid(left.end, right.start)])


def test_williams_toggle_in_full_has_the_limit_points_of_the_reference():
    left, model = toggle()
    path = bf.trace_equilibrium(model, 80.0)
    for found, (load, w, thrust) in zip(path.limit_points, WILLIAMS_LIMITS, strict=True):
        assert found.load_factor == pytest.approx(load, rel=2e-9)
        assert -found.displacement(left.end)[1] == pytest.approx(w, rel=1e-7)
        assert found.reaction(left.start)[0] == pytest.approx(thrust, rel=1e-7)
    assert path.bifurcations == ()


@pytest.mark.parametrize(("w", "load", "thrust"), WILLIAMS_CURVE)
def test_williams_toggle_under_displacement_control_meets_the_curve(w, load, thrust):
    left, model = toggle([lambda crown: bf.Prescribed(crown, uy=-w)])
    for solution in (bf.solve_static(model), bf.trace_equilibrium(model, 1.0)):
        assert -solution.reaction(left.end)[-1, 1] == pytest.approx(load, rel=1e-7)
        assert solution.reaction(left.start)[-1, 0] == pytest.approx(thrust, rel=1e-7)


# Deep arches -------------------------------------------------------------------------------------------------------

HALF = np.deg2rad(107.5)


def arch(first, last, flexibility=1 / 2.2e7, elements=24):
    """An arch of 215 degrees, R = EI = 1; the flexibility 1 / EA = 1 / kGA is that of L / h = 5000."""
    section = bf.Section.from_stiffness(1 / flexibility, 1 / flexibility, 1.0, 1.0, 1.0)
    beam = bf.Beam(bf.Arc((0, 0), 1.0, 0.5 * np.pi + HALF, 0.5 * np.pi - HALF), elements, bf.CRBF(4), section)
    return beam, bf.Model([beam], [first(beam.start), last(beam.end)], [bf.PointForce(beam.at(0.5), (0.0, -1.0))])


def lowered(beam, by):
    return lambda state: state.displacement(beam.at(0.5))[1] < -by


def test_the_clamped_hinged_arch_snaps_at_the_reference_load_and_the_path_goes_on():
    beam, model = arch(bf.Clamp, bf.Pin)
    path = bf.trace_equilibrium(model, lowered(beam, 1.6))
    found = path.limit_points[0]
    assert found.load_factor == pytest.approx(8.97308996972, rel=1e-6)
    # the place of an extremum is found to the root of the round-off in strains at such slenderness
    assert found.displacement(beam.at(0.5)) == pytest.approx((0.61141465795, -1.13732063125), abs=1e-5)
    assert found.rotation(beam.at(0.5)) == pytest.approx(0.0498860774865, abs=1e-5)
    assert path.bifurcations == ()
    second = path.limit_points[1]
    assert second.load_factor == pytest.approx(-0.73055, rel=1e-4)
    assert path.load_factor[-1] > second.load_factor
    assert "reached the end that was asked for" in path.statistics.ended


def symmetric_half(load, guess, flexibility):
    """Turn and thrust at the left hinge of the symmetric state under a load, by shooting to the crown."""
    member = Member(2 * HALF, HALF, -1.0, axial=flexibility, shear=flexibility)

    def left(v):
        return member.run((-np.sin(HALF), np.cos(HALF), v[0], v[1], -0.5 * load, 0.0), HALF)[[0, 2]]

    return solved(left, guess)


def sidesway(load, guess, flexibility):
    """Determinant of what misses the right hinge by what starts at the left: 0 where the hinged arch can sway."""
    member = Member(2 * HALF, HALF, -1.0, axial=flexibility, shear=flexibility)
    turn, thrust = symmetric_half(load, guess, flexibility)
    start = np.array([turn, thrust, -0.5 * load])

    def missed(u):
        crown = member.run((-np.sin(HALF), np.cos(HALF), *u, 0.0), HALF)
        return member.after(HALF).run(crown + np.array([0, 0, 0, 0, load, 0]))[[0, 1, 5]]

    columns = [missed(start + 1e-30j * unit).imag / 1e-30 for unit in np.eye(3)]
    return np.linalg.det(np.array(columns).T)


@pytest.mark.parametrize("flexibility", [1e-6, 1 / 2.2e7, 1e-9])
def test_the_hinged_arch_sways_before_its_limit_point(flexibility):
    """Sidesway and limit load against shooting; 3.2762821 and 9.4631089 where it is inextensible."""
    beam, model = arch(bf.Pin, bf.Pin, flexibility)
    path = bf.trace_equilibrium(model, lowered(beam, 1.3))
    (crossing,), (limit,) = path.bifurcations, path.limit_points
    assert crossing.load_factor < limit.load_factor
    guess = np.zeros(2)
    for load in (1.0, 2.0, 3.0):
        guess = symmetric_half(load, guess, flexibility)
    exact = brentq(lambda load: sidesway(load, guess, flexibility), 3.2, 3.35, xtol=1e-10)
    assert exact == pytest.approx(3.2762821409, rel=1e-5)
    assert crossing.load_factor == pytest.approx(exact, rel=3e-8 if flexibility > 1e-9 else 3e-6)
    assert limit.load_factor == pytest.approx(9.463108888550, rel=1e-5)
    assert np.abs(path.displacement(beam.at(0.5))[:, 0]).max() < 1e-5


@pytest.mark.parametrize("direction", [1, -1])
def test_the_sidesway_of_the_hinged_arch_is_followed(direction):
    """The branch rises slowly to the side of its mode; its last point obeys the arch by shooting."""
    flexibility = 1e-6
    beam, model = arch(bf.Pin, bf.Pin, flexibility)
    crossing = bf.trace_equilibrium(model, lowered(beam, 0.2)).bifurcations[0]
    branch = bf.trace_equilibrium(model, lowered(beam, 0.8), start=crossing, direction=direction)
    crown = branch.displacement(beam.at(0.5))
    assert abs(crown[-1, 0]) > 0.3
    assert np.all(np.sign(crown[1:, 0]) == np.sign(crown[-1, 0]))
    assert branch.load_factor[:2] == pytest.approx(crossing.load_factor, rel=1e-2)
    member = Member(2 * HALF, HALF, -1.0, axial=flexibility, shear=flexibility)

    def run(turn, nx, ny, load):
        at = member.run((-np.sin(HALF), np.cos(HALF), turn, nx, ny, 0.0), HALF)
        return at, member.after(HALF).run(at + np.array([0, 0, 0, 0, load, 0]))

    def left(v):
        at, end = run(*v)
        return (end[0] - np.sin(HALF), end[1] - np.cos(HALF), end[5], at[1] - 1.0 - crown[-1, 1])

    reaction = branch.reaction(beam.start)[-1]
    found = solved(left, [branch.rotation(beam.start)[-1], -reaction[0], -reaction[1], branch.load_factor[-1]])
    assert branch.load_factor[-1] == pytest.approx(found[3], rel=1e-6)
    assert crown[-1, 0] == pytest.approx(run(*found)[0][0], abs=1e-6)


def test_the_clamped_arch_is_symmetric_up_to_its_limit_point():
    beam, model = arch(bf.Clamp, bf.Clamp)
    path = bf.trace_equilibrium(model, lowered(beam, 1.0))
    member = Member(2 * HALF, HALF, -1.0)
    known = [np.array([0.0, 0.0, 0.0])]

    def load_at(w):
        def left(v):
            crown = member.run((-np.sin(HALF), np.cos(HALF), 0.0, v[0], -0.5 * v[1], v[2]), HALF)
            return (crown[0], crown[2], crown[1] - 1.0 + w)

        known[0] = solved(left, known[0])
        return known[0][1]

    for w in (0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7):
        load_at(w)
    exact, _ = vertex(load_at, 0.73, 4e-3)
    (limit,) = path.limit_points
    assert limit.load_factor == pytest.approx(exact, rel=1e-6)
    assert path.bifurcations == ()
