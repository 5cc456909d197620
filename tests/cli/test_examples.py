"""Every example runs as it stands, writes its files, and prints what closed forms, shooting and literature say."""

import contextlib
import io
import re
import runpy
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import eigh
from scipy.optimize import fsolve
from scipy.special import ellipk

import beamfem as bf
from studies.benchmarks.peer_cases import REISSNER_TIPS
from studies.paper.elastica import tip_displacement
from studies.stability import column, lee_frame

# users get no warning from what they copy
pytestmark = pytest.mark.filterwarnings("error::beamfem.LockingWarning", "error::beamfem.LargeStrainWarning")
FOLDER = Path(__file__).parents[2] / "examples"
NAMES = sorted(path.stem for path in FOLDER.glob("*.py"))
STEEL = bf.Material(2e11, 0.3, 7800.0)
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d*)?(?:e[-+]?\d+)?")


@pytest.fixture(scope="module")
def printed(tmp_path_factory):
    """Return what an example prints, line by line, and where it wrote its files."""

    @cache
    def run(name):
        folder, text = tmp_path_factory.mktemp(name), io.StringIO()
        with contextlib.chdir(folder), contextlib.redirect_stdout(text):
            runpy.run_path(str(FOLDER / f"{name}.py"), run_name="__main__")
        return text.getvalue().splitlines(), folder / "out" / "examples"

    return run


def numbers(line):
    """Return the numbers after the words of a line, which may hold some in names."""
    return [float(text) for text in _NUMBER.findall(line)]


def test_examples_are_short():
    assert len(NAMES) == 17
    assert all(len((FOLDER / f"{name}.py").read_text().splitlines()) < 40 for name in NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_an_example_writes_its_files(name, printed):
    _, folder = printed(name)
    named = re.findall(r'"out/examples/([\w.]+)"', (FOLDER / f"{name}.py").read_text())
    assert named
    for file in named:
        assert (folder / file).exists(), file


def test_the_cantilever_is_reissners(printed):
    """Tip by shooting; the clamp's moment is the force times its lever."""
    lines, _ = printed("cantilever")
    section = bf.Rectangle(0.01, 0.01)
    rigidity, force = section.rigidity(STEEL), 5.0 * STEEL.youngs_modulus * section.second_moment
    tip = tip_displacement(1.0, (0.0, force), rigidity.bending, rigidity.axial, rigidity.shear)
    assert numbers(lines[0]) == pytest.approx(tip, abs=1e-6)
    moment = force * (1.0 + tip[0])
    # forces and moments are printed with two decimals
    assert numbers(lines[1]) == pytest.approx([0.0, -force, -moment], abs=6e-3)
    assert numbers(lines[2]) == pytest.approx([moment], abs=6e-3)


def test_the_bracket_sinks_as_a_beam_column(printed):
    """The column carries P and, at its top, P L: it turns there by P L tan(k h) / (k EI) with k^2 = P / EI and moves by
    L (sec(k h) - 1); the bar bends by P L^3 / (3 EI), shear and stretch add P L / (k_s G A) and P h / EA."""
    lines, _ = printed("frame")
    rigidity = bf.Tube(0.1, 0.005).rigidity(bf.Material(2.1e11, 0.3, 7850.0))
    height, reach, weight = 3.0, 1.5, 50.0
    k = np.sqrt(weight / rigidity.bending)
    sag = reach * weight * reach * np.tan(k * height) / (k * rigidity.bending)
    sag += weight * (reach**3 / (3.0 * rigidity.bending) + height / rigidity.axial + reach / rigidity.shear)
    assert numbers(lines[0])[0] == pytest.approx(1e3 * sag, abs=2e-4)
    # printed with five digits
    assert numbers(lines[1]) == pytest.approx([0.0, weight, weight * reach / np.cos(k * height)], abs=6e-4)


def test_the_frame_snaps_where_collocation_says(printed):
    lines, _ = printed("snap_through")
    for line, (load, _, down) in zip(lines, lee_frame.LIMITS, strict=True):
        assert numbers(line) == pytest.approx([load, down], abs=6e-3)  # loads are printed with two decimals


def test_the_column_buckles_and_bends_as_reissner_and_the_elastica(printed):
    """Of L/h = 500; the elastica's column is hinged at both ends: P / Euler = (2 K(sin a/2) / pi)^2."""
    lines, _ = printed("buckling")
    assert numbers(lines[0])[0] == pytest.approx(column.reissner("hinged-hinged", 500.0) / np.pi**2, abs=6e-7)
    degrees, load = numbers(lines[1])
    assert 57.0 < degrees < 120.0
    # stretch and shear change the load of the elastica by as much as the critical one, 7e-6
    assert load == pytest.approx((2.0 / np.pi * ellipk(np.sin(np.radians(degrees) / 2.0) ** 2)) ** 2, rel=2e-5)


def test_the_modes_are_timoshenkos(printed):
    """Sines between two hinges: (k G A q^2 - m w^2)(E I q^2 + k G A - J w^2) = (k G A q)^2 with q = n pi / L."""
    lines, _ = printed("modes")
    section = bf.Rectangle(0.05, 0.05)
    rigidity, inertia = section.rigidity(STEEL), section.inertia(STEEL)
    expected = []
    for q in np.pi * np.arange(1, 4):
        sway, turn = rigidity.shear * q**2, rigidity.bending * q**2 + rigidity.shear
        product = [
            inertia.mass * inertia.rotary,
            -(inertia.mass * turn + inertia.rotary * sway),
            sway * turn - (rigidity.shear * q) ** 2,
        ]
        expected.append(np.sqrt(np.roots(product).min()) / (2.0 * np.pi))
    assert numbers(lines[0]) == pytest.approx(expected, abs=6e-4)
    slender = 0.5 * np.pi * np.arange(1, 4) ** 2 * np.sqrt(rigidity.bending / inertia.mass)
    assert numbers(lines[1]) == pytest.approx(slender, abs=6e-4)
    assert np.all((expected / slender > 0.96) & (expected / slender < 0.996))


def test_the_pendulum_falls_as_reissners_beam(printed):
    """Tip at 0.5 s by spectral elements in time; nothing dissipates."""
    lines, folder = printed("motion")
    assert numbers(lines[0].removeprefix("tip at 0.5 s")) == pytest.approx(REISSNER_TIPS[4], abs=1e-4)
    most, change = numbers(lines[1])
    assert most > 50.0
    assert change < 1e-4 * most
    kept = bf.load(folder / "pendulum.h5")
    assert kept.position(kept.model.beams[0].end)[25] == pytest.approx(REISSNER_TIPS[4], abs=1e-4)


@pytest.mark.slow
def test_the_sweep_is_reissners_beam(printed):
    lines, _ = printed("sweep")
    assert len(lines) == 6
    for line in lines:
        load, slenderness, found = (numbers(part)[-1] for part in re.split("[,:]", line))
        rigidity = bf.Rectangle(1.0 / slenderness, 1.0 / slenderness).rigidity(STEEL)
        force = (0.0, load * rigidity.bending)
        expected = tip_displacement(1.0, force, rigidity.bending, rigidity.axial, rigidity.shear)[1]
        assert found == pytest.approx(expected, abs=2e-6)


def test_the_portal_sways_as_slope_and_deflection_say(printed):
    """Half of the force on each column: 12 EI/h^3 u - 6 EI/h^2 t, and no moment is left at the corner, where the beam
    resists with 6 EI_b/L t. Stretch and shear add 0.2 %."""
    lines, _ = printed("own_mesh")
    height, width, force, modulus = 4.0, 6.0, 1000.0, 2.1e11
    post, beam = modulus * 0.1**4 / 12.0, modulus * 0.1 * 0.12**3 / 12.0
    matrix = [
        [12.0 * post / height**3, -6.0 * post / height**2],
        [-6.0 * post / height**2, 4.0 * post / height + 6.0 * beam / width],
    ]
    sway = 1e3 * np.linalg.solve(matrix, [0.5 * force, 0.0])[0]
    assert lines[0] == "member sets: columns, beam - point sets: feet, corners, midspan"
    assert numbers(lines[1])[0] == pytest.approx(sway, rel=2.5e-3)


def test_the_guide_is_as_stiff_as_two_leaf_springs(printed):
    """12 E I / L^3 each, which shear softens by 12 E I / (k_s G A L^2), and 3/5 u^2 / L for each that bends so."""
    lines, _ = printed("parallel_guide")
    rigidity = bf.Rectangle(10.0, 0.2).rigidity(bf.Material(2.0e5, 0.3, 7.85e-9))
    softer = 1.0 + 12.0 * rigidity.bending / (rigidity.shear * 50.0**2)
    # in parts of the stage's stiffness, which bends a little: (50 + 10 mm)^-1 of 125,000 times as much
    assert numbers(lines[0])[0] == pytest.approx(2.0 * 12.0 * rigidity.bending / 50.0**3 / softer, rel=5e-4)
    assert numbers(lines[1])[0] == pytest.approx(0.6 * 1.0**2 / 50.0, rel=1e-4)
    assert abs(numbers(lines[2])[0]) < 1e-5
    # normal forces of the leaves add 0.9 %: their stress, and their moment by the deflection
    assert numbers(lines[3])[0] == pytest.approx(1200.0 / (3.0 * 2.0e5 * 0.2 / 50.0**2), rel=1e-2)


def test_the_tapered_leaf_is_an_elastica_of_variable_stiffness(printed):
    """Shot from its tip, at which it turns by an angle and carries no moment; the clamp may not turn."""
    lines, _ = printed("tapered_leaf")

    def clamp(force, tip):
        def along(s, state):
            angle, away, _ = state
            stiffness = 2.06e5 * (60.0 - 0.135 * (400.0 - s)) * 6.0**3 / 12.0
            return force * away / stiffness, np.cos(angle), np.sin(angle)

        return solve_ivp(along, (0.0, 400.0), (tip, 0.0, 0.0), rtol=1e-10, atol=1e-10).y[:, -1]

    force, _ = fsolve(lambda at: (clamp(*at) - (0.0, 0.0, -120.0))[[0, 2]], (1000.0, -0.45))
    assert numbers(lines[0])[0] == pytest.approx(force, rel=5e-4)  # the elastica does not shear


def test_the_leaf_pack_shares_its_load_as_linear_beams_do(printed):
    """Forces between the tips of cantilevers and the leaves above them, by their flexibilities."""
    lines, _ = printed("leaf_pack")
    lengths, stiffness = np.array([600.0, 450.0, 300.0, 150.0]), 2.06e5 * 60.0 * 8.0**3 / 12.0

    def flexibility(at, where):
        near, far = min(at, where), max(at, where)
        return near**2 * (3.0 * far - near) / (6.0 * stiffness)

    # leaf i deflects at the tip of leaf i + 1 as far as that does
    matrix, right = np.zeros((3, 3)), np.zeros(3)
    for pad in range(3):
        at = lengths[pad + 1]
        matrix[pad, pad] = 2.0 * flexibility(at, at)
        if pad < 2:
            matrix[pad, pad + 1] = -flexibility(at, lengths[pad + 2])
        if pad > 0:
            matrix[pad, pad - 1] = -flexibility(at, lengths[pad])
        else:
            right[pad] = 300.0 * flexibility(at, lengths[0])
    forces = np.linalg.solve(matrix, right)
    tip = 300.0 * flexibility(600.0, 600.0) - forces[0] * flexibility(600.0, 450.0)
    assert numbers(lines[0])[0] == pytest.approx(tip, rel=3e-4)
    # shear, left out here, takes 0.23 % from the force on the shortest leaf
    assert numbers(lines[1]) == pytest.approx(forces, rel=2.5e-3)


def test_the_arch_takes_what_its_snaps_release(printed):
    """At a snap the force does more work than the arch stores; elsewhere the work of the loop adds up to nothing."""
    lines, folder = printed("arch_loop")
    with contextlib.chdir(folder.parents[1]), contextlib.redirect_stdout(io.StringIO()):
        made = runpy.run_path(str(FOLDER / "arch_loop.py"))
    loop, force, middle = made["loop"], made["force"], made["arch"].at(0.5)
    way, stored = loop.displacement(middle)[:, 1], loop.energy().strain
    snaps = np.flatnonzero(np.abs(np.diff(way)) > 0.02)
    assert len(snaps) == 2
    released = sum(force[i : i + 2].mean() * np.diff(way[i : i + 2]) - np.diff(stored[i : i + 2]) for i in snaps)
    assert numbers(lines[0])[0] == pytest.approx(released[0], rel=1e-4)  # printed with four digits
    assert abs(way[-1]) < 1e-8


def test_the_footbridge_hangs_and_swings_as_a_ritz_model_of_its_deck_and_mast(printed):
    """Eighty sines of the deck, shifts of its thirds, and the top of the mast, as members that only lengthen beside a
    bending stiffness. Found at rest first: the slopes there couple deflections and stays, 1.9 % of mode 3."""
    lines, _ = printed("footbridge")
    height, third, terms = 12.0, 12.0, 80
    timber, steel = bf.Material(1.2e10, 0.3, 500.0), bf.Material(2.1e11, 0.3, 7850.0)
    deck, deck_mass = bf.Rectangle(2.0, 0.18).rigidity(timber), bf.Rectangle(2.0, 0.18).inertia(timber)
    mast, mast_mass = bf.Profile("HEB 300").rigidity(steel), bf.Profile("HEB 300").inertia(steel).mass
    wave, size = np.arange(1, terms + 1) * np.pi / 36.0, terms + 5
    sines, sway, down = slice(terms), terms + 3, terms + 4
    places, weights = np.polynomial.legendre.leggauss(100)
    units = np.eye(size)
    shifts = np.vstack([np.zeros(size), units[terms:sway]])
    softer = 1.0 + deck.bending / deck.shear * wave**2
    bending = np.zeros(size)
    bending[sines], bending[sway] = 18.0 * deck.bending * wave**4 / softer, 3.0 * mast.bending / height**3
    inertia = np.diag(np.full(size, 18.0 * deck_mass.mass))
    inertia[sines, sines] += np.diag(18.0 * deck_mass.rotary * wave**2 / softer**2)
    inertia[terms:sway, terms:sway] = deck_mass.mass * third / 6.0 * np.array([[4, 1, 0], [1, 4, 1], [0, 1, 2]])
    inertia[sway, sway], inertia[down, down] = 33.0 / 140.0 * mast_mass * height, mast_mass * height / 3.0
    weight = -4.905 * mast_mass * height * units[down]
    weight[sines] = -9.81 * deck_mass.mass * (1.0 - np.cos(wave * 36.0)) / wave

    def members(at):
        """Yield stiffness, pretension, elongation and its first and second derivatives."""
        for i in range(3):
            slopes = wave[:, None] * np.cos(np.outer(wave, third * (i + 0.5 + 0.5 * places)))
            second = np.zeros((size, size))
            second[sines, sines] = 0.5 * third * (weights * slopes) @ slopes.T
            first = shifts[i + 1] - shifts[i]
            yield deck.axial / third, 0.0, first @ at + 0.5 * at @ second @ at, first + second @ at, second
        second = 1.2 / height * np.outer(units[sway], units[sway])
        first = units[down] + second @ at
        yield mast.axial / height, 0.0, at[down] + 0.5 * at @ second @ at, first, second
        for stiffness, tension, foot in ((1e7, 3e4, 1), (1e7, 3e4, 2), (2e7, 7e4, None)):
            moves = np.array([units[sway], units[down]])
            way = np.array([third if foot is None else -third * foot, height])
            if foot is not None:
                moves[0] -= shifts[foot]
                moves[1, sines] = -np.sin(wave * third * foot)
            long = np.hypot(*(way + moves @ at))
            unit = (way + moves @ at) / long
            second = moves.T @ (np.eye(2) - np.outer(unit, unit)) @ moves / long
            yield stiffness, tension, long - np.hypot(*way), unit @ moves, second

    at = np.zeros(size)
    for _ in range(6):
        residual, tangent, forces = bending * at - weight, np.diag(bending), []
        for stiffness, tension, longer, first, second in members(at):
            forces.append(tension + stiffness * longer)
            residual = residual + forces[-1] * first
            tangent = tangent + stiffness * np.outer(first, first) + forces[-1] * second
        at = at - np.linalg.solve(tangent, residual)
    assert numbers(lines[0]) == pytest.approx(forces[4:], rel=3e-5)  # printed in newtons
    found = np.sqrt(eigh(tangent, inertia, eigvals_only=True)[:3]) / (2.0 * np.pi)
    assert numbers(lines[1]) == pytest.approx(found, rel=2.5e-4)


def test_the_strip_is_rolled_up_into_two_circles(printed):
    lines, _ = printed("roll_up")
    assert numbers(lines[0]) == [0.0, 0.0]
    assert numbers(lines[1]) == [2.0]


def test_the_thermostat_is_timoshenkos(printed):
    """Timoshenko 1925, layers of equal height: 1 / r = 24 da dT / (h (14 + n + 1 / n)), n the ratio of moduli."""
    lines, _ = printed("thermostat")
    ratio = 2.1e11 / 1.05e11
    curvature = 24.0 * (19e-6 - 12e-6) * 100.0 / (1e-3 * (14.0 + ratio + 1.0 / ratio))
    assert numbers(lines[0])[0] == pytest.approx(1.0 / curvature, rel=1e-5)
    # strains of 1.5e-3 lengthen the strip
    assert numbers(lines[1])[0] == pytest.approx(1e3 * (1.0 - np.cos(0.1 * curvature)) / curvature, rel=2e-3)


def test_the_fishing_rod_is_an_elastica_and_keeps_its_energy(printed):
    """Tip by shooting; the energy stored is the work of a weight that grows, by Simpson's rule over such tips."""
    lines, _ = printed("fishing_rod")
    rigidity = bf.Circle(0.008).rigidity(bf.Material(9e10, 0.3, 1600.0))
    stiffness = rigidity.bending, rigidity.axial, rigidity.shear
    sag = [0.0] + [-tip_displacement(2.5, (0.0, -8.0 * part / 16), *stiffness)[1] for part in range(1, 17)]
    assert numbers(lines[0])[1] == pytest.approx(-sag[-1], abs=2e-5)
    simpson = np.array([1.0, *[4.0, 2.0] * 7, 4.0, 1.0]) * (8.0 / 16) / 3.0
    stored = 8.0 * sag[-1] - simpson @ np.array(sag)  # all of F u but what is under the curve u(F)
    assert numbers(lines[1])[0] == pytest.approx(stored, rel=1e-5)
    assert numbers(lines[2])[0] < 1e-3


def test_the_mast_sways_as_a_beam_column_with_the_stiffness_of_its_guys(printed):
    """The guys shorten the mast until its thrust is P; it then has the stiffness P / L / (tan(q) / q - 1) with
    q^2 = P L^2 / EI, and shear in series. Each guy of length l adds k c^2 + T s^2 / l; 33 / 140 of the mast sways."""
    lines, _ = printed("stayed_mast")
    section, aluminium = bf.Tube(diameter=0.06, thickness=0.003), bf.Material(7e10, 0.33, 2700.0)
    rigidity, mass = section.rigidity(aluminium), section.inertia(aluminium).mass
    height, length, stiffness, c, s = 6.0, 7.5, 1.5e4, 0.6, 0.8
    down = 2.0 * 400.0 * s / (rigidity.axial / height + 2.0 * (stiffness * s**2 + 400.0 / length * c**2))
    tension = 400.0 - stiffness * s * down
    thrust = 2.0 * tension * s
    q = np.sqrt(thrust / rigidity.bending) * height
    bent = 1.0 / (height * (np.tan(q) / q - 1.0) / thrust + height / rigidity.shear)
    total = bent + 2.0 * (stiffness * c**2 + tension / length * s**2)
    frequency = np.sqrt(total / (300.0 + 33.0 / 140.0 * mass * height)) / (2.0 * np.pi)
    assert numbers(lines[0]) == pytest.approx([frequency], abs=2e-4)
    moved = 150.0 / total
    share = stiffness * c * moved
    # of second order: guys turn, and the bent mast is lower
    both = stiffness * (0.5 * (s * moved) ** 2 / length - 0.6 * s * moved**2 / height)
    assert numbers(lines[1]) == pytest.approx([tension + share + both, tension - share + both], abs=0.01)
