"""Whole models in Abaqus input files, against closed forms and the literature."""

import numpy as np
import pytest

import beamfem as bf

NODES = """*Heading
A cantilever of four elements, 1 m long
*Node, nset=All
1, 0., 0.
2, 0.25, 0.
3, 0.5, 0.
4, 0.75, 0.
5, 1., 0.
*Element, type=B21, elset=Arm
1, 1, 2
2, 2, 3
3, 3, 4
4, 4, 5
*Nset, nset=Tip
5
"""
SECTION = """*Beam Section, section=RECT, elset=ARM, material=steel
0.01, 0.002
0., 0., -1.
*Material, name=Steel
*Elastic
2.1e11, 0.3
*Density
7850.
*Boundary
1, Encastre
"""
STEP = """*Step, nlgeom=YES
*Static
0.1, 1.
*Cload
Tip, 2, -7.
*Output, field
*Node Output
U
*End Step
"""
RIGIDITY = 2.1e11 * 0.01 * 0.002**3 / 12


def read(tmp_path, text, elements=2):
    path = tmp_path / "model.inp"
    path.write_text(text)
    return bf.read_abaqus_model(path, elements=elements)


def tip(file, load=None):
    solution = bf.solve_static(file.model if load is None else file.model.with_loads(load))
    return solution.displacement(file.frame.points("Tip")[0])[-1]


def test_a_cantilever_bends_as_the_elastica(tmp_path):
    """P L^2 / EI = 5: Mattiasson's table has 0.38763 and 0.71379 of the length."""
    file = read(tmp_path, NODES + SECTION + STEP)
    assert len(file.frame.members("Arm")) == 1
    assert file.procedures == ("STATIC",)
    assert tip(file) == pytest.approx([-0.38763, -0.71379], abs=2e-4)
    (beam,) = file.model.beams
    assert beam.section == bf.Rectangle(0.01, 0.002, 0.85)
    assert beam.material == bf.Material(2.1e11, 0.3, 7850.0)


def test_lees_frame_with_a_general_section_meets_its_limit_load(tmp_path):
    """Hinged at both ends, 120 long, loaded at 24: 18544.52709 (as from a mesh file in test_mesh.py)."""
    nodes = [(0.0, 12.0 * n) for n in range(11)] + [(12.0 * n, 120.0) for n in range(1, 11)]
    lines = [f"{n}, {x}, {y}" for n, (x, y) in enumerate(nodes, 1)]
    cells = [f"{n}, {n}, {n + 1}" for n in range(1, 21)]
    text = ["*NODE", *lines, "*ELEMENT, TYPE=B21H, ELSET=FRAME", *cells]
    text += ["*BEAM GENERAL SECTION, ELSET=FRAME, DENSITY=1.", "6., 2., 0., 2., 1.", "", "7.2e6, 2769230.769230769"]
    text += [
        "*BOUNDARY",
        "1, PINNED",
        "21, 1, 2",
        "*STEP, NLGEOM",
        "*STATIC, RIKS",
        "*CLOAD",
        "13, 2, -1.",
        "*END STEP",
    ]
    file = read(tmp_path, "\n".join(text), elements=6)
    assert file.procedures == ("STATIC, RIKS",)
    load = file.model.loads[0].point
    path = bf.trace_equilibrium(file.model, until=lambda state: state.displacement(load)[1] < -55.0)
    # k_s is 1 here and 5/6 in that test: shear changes the fourth digit
    assert path.limit_points[0].load_factor == pytest.approx(18544.5, rel=5e-4)


def test_trusses_are_hinged_bars_that_share_a_load_with_a_beam(tmp_path):
    """A beam of 2 m on a king post: 48 EI / L^3 beside the stiffness of the truss, by its energy."""
    text = """*NODE
1, 0., 0.
2, 1., 0.
3, 2., 0.
4, 1., 1.
*NSET, NSET=Tip
2
*ELEMENT, TYPE=B21, ELSET=BEAM
1, 1, 2
2, 2, 3
*ELEMENT, TYPE=T2D2, ELSET=BARS
3, 1, 4
4, 4, 2
5, 4, 3
*BEAM SECTION, SECTION=RECT, ELSET=BEAM, MATERIAL=STEEL
0.02, 0.02
*SOLID SECTION, ELSET=BARS, MATERIAL=STEEL
1e-5
*MATERIAL, NAME=STEEL
*ELASTIC
2.1e11, 0.3
*DENSITY
7850.
*BOUNDARY
1, 1, 2
3, 2
*STEP, NLGEOM=YES
*STATIC
*CLOAD
TIP, 2, -1.
*END STEP
"""
    file = read(tmp_path, text, elements=4)
    kinds = [type(joint).__name__ for joint in file.model.joints]
    assert sorted(kinds) == ["Hinge"] * 5 + ["Rigid"]
    e, bar, chord, inertia = 2.1e11, 1e-5, 4e-4, 0.02**4 / 12
    flexible = 1 / (e * bar) + 2 * 0.5 * np.sqrt(2) / (e * bar) + 2 * 0.25 / (e * chord)
    expected = 1 / (1 / flexible + 48 * e * inertia / 8)
    assert tip(file)[1] == pytest.approx(-expected, rel=1e-3)
    thousand = bf.solve_static(file.model.with_loads([bf.PointForce(file.frame.points("Tip")[0], (0.0, -1000.0))]))
    assert thousand.stable.all()  # trusses do not buckle


@pytest.mark.parametrize(
    ("lines", "expected"),
    [
        ("*DLOAD\nArm, PY, -0.01", (0.0, -0.01 / (8 * RIGIDITY))),
        ("*DLOAD\nARM, P2, 0.01", (0.0, 0.01 / (8 * RIGIDITY))),
        ("*DLOAD\nArm, PX, 100.", (100 / (2 * 2.1e11 * 2e-5), 0.0)),
        ("*DLOAD\n, GRAV, 0.01, 0., -1., 0.", (0.0, -7850 * 2e-5 * 0.01 / (8 * RIGIDITY))),
        ("*CLOAD\n5, 6, 0.001", (0.0, 0.001 / (2 * RIGIDITY))),
        ("*CLOAD\nPart-1-1.5, 1, 50.", (50 / (2.1e11 * 2e-5), 0.0)),
        ("*CLOAD\n5, 2, 9.\n*CLOAD\nTip, 2, 0.001\n5, 2, 0.", (0.0, 0.001 / (3 * RIGIDITY))),
        ("*CLOAD\n5, 2, 9.\n*CLOAD, OP=NEW\n5, 2, 0.001", (0.0, 0.001 / (3 * RIGIDITY))),
        ("*BOUNDARY\n5, 2, 2, 1e-4", (0.0, 1e-4)),
        ("*DLOAD\n4, PY, -0.01", (0.0, -0.01 * (1 / 8 - (0.75**3 / 6 - 0.75**4 / 24)) / RIGIDITY)),
    ],
)
def test_loads_and_displacements(tmp_path, lines, expected):
    file = read(tmp_path, NODES + SECTION + f"*STEP, NLGEOM=YES\n*STATIC\n{lines}\n*END STEP\n")
    assert tip(file) == pytest.approx(expected, rel=2e-4, abs=6e-7)  # shortening of the second order


@pytest.mark.parametrize(
    ("shape", "sizes", "area", "second"),
    [
        ("RECT", "0.02, 0.03", 6e-4, 0.02 * 0.03**3 / 12),
        ("CIRC", "0.01", np.pi * 1e-4, np.pi * 1e-8 / 4),
        ("PIPE", "0.02, 0.002", np.pi * (0.02**2 - 0.018**2), np.pi * (0.02**4 - 0.018**4) / 4),
        (
            "BOX",
            "0.05, 0.1, 4e-3, 4e-3, 4e-3, 4e-3",
            0.05 * 0.1 - 0.042 * 0.092,
            (0.05 * 0.1**3 - 0.042 * 0.092**3) / 12,
        ),
        ("I", "0.1, 0.2, 0.1, 0.1, 0.01, 0.01, 0.006", 2e-3 + 0.18 * 0.006, (0.1 * 0.2**3 - 0.094 * 0.18**3) / 12),
    ],
)
def test_sections(tmp_path, shape, sizes, area, second):
    text = NODES + SECTION.replace("section=RECT", f"section={shape}").replace("0.01, 0.002", sizes) + STEP
    (beam,) = read(tmp_path, text).model.beams
    assert beam.section.area == pytest.approx(area, rel=1e-12)
    assert beam.section.second_moment == pytest.approx(second, rel=1e-12)


def test_a_section_turned_by_its_first_axis_and_one_with_its_own_elasticity(tmp_path):
    (beam,) = read(tmp_path, NODES + SECTION.replace("0., 0., -1.", "0., 1., 0.") + STEP).model.beams
    assert beam.section == bf.Rectangle(0.002, 0.01, 0.85)
    general = "*BEAM GENERAL SECTION, SECTION=CIRC, ELSET=Arm, DENSITY=7850.\n0.01\n0., 0., -1.\n2.6e11, 1e11\n"
    (beam,) = read(tmp_path, NODES + general.replace("2.6e11", "2.6D11") + "*BOUNDARY\n1, ENCASTRE\n").model.beams
    assert beam.section == bf.Circle(0.02, 0.89)
    assert beam.material.poisson_ratio == pytest.approx(0.3)
    (same,) = read(tmp_path, NODES + SECTION.replace("Beam Section", "Beam General Section") + STEP).model.beams
    assert same.section == bf.Rectangle(0.01, 0.002, 0.85)


@pytest.mark.parametrize(
    ("axes", "across", "about", "sense"), [("xzy", "0., 1., -0.", 5, -1.0), ("yzx", "1., 0., 0.", 4, 1.0)]
)
def test_a_beam_in_another_plane_as_freecad_writes_it(tmp_path, axes, across, about, sense):
    """8 m of 0.4 by 1.25 m: P L^3 / (3 EI) + P L / (k_s G A), and the angle of a moment about the third axis."""
    order = ["xyz".index(axis) for axis in axes]

    def point(*along):
        return ", ".join(f"{along[order.index(axis)]:g}" for axis in range(3))

    nodes = [f"{n}, {point(x, 500.0, 300.0)}" for n, x in ((1, 0.0), (2, 8000.0), (3, 4000.0))]
    lines = ["*Node, NSET=Nall", *nodes, "*Element, TYPE=B32R, ELSET=Eedges", "1, 1, 3, 2", "*ELSET,ELSET=M0", "1,"]
    lines += ["*NSET,NSET=Fixed", "1,", "*NSET,NSET=Tip", "2,", "*MATERIAL, NAME=Steel", "*ELASTIC", "210000,0.3"]
    lines += ["*DENSITY", "7.85e-9", "*BEAM SECTION, ELSET=M0, MATERIAL=Steel, SECTION=RECT", "400,1250", across]
    lines += ["*STEP, NLGEOM", "*STATIC", "*BOUNDARY", *(f"Fixed,{direction}" for direction in range(1, 7))]
    force = ["*CLOAD", f"2,{order[1] + 1},-9.0E+04", "*END STEP"]
    file = read(tmp_path, "\n".join(lines + force), elements=4)
    assert [type(support) for support in file.model.supports] == [bf.Clamp]
    bending, shear = 2.1e5 * 400.0 * 1250.0**3 / 12.0, 0.85 * 2.1e5 / 2.6 * 400.0 * 1250.0
    assert tip(file)[1] == pytest.approx(-9e4 * (8000.0**3 / (3.0 * bending) + 8000.0 / shear), rel=1e-5)
    file = read(tmp_path, "\n".join([*lines, "*CLOAD", f"2,{about},1e6", "*END STEP"]), elements=4)
    turned = bf.solve_static(file.model).rotation(file.frame.points("Tip")[0])[-1]
    assert turned == pytest.approx(sense * 1e6 * 8000.0 / bending, rel=1e-6)


def test_forces_at_the_middle_of_quadratic_elements(tmp_path):
    """Consistent forces of 0.01 N/m on one element from 0 to 0.5 m: P x^2 (3 L - x) / (6 EI), by Simpson's rule."""
    halves = "1, 1, 2, 3\n2, 3, 4, 5"
    lines = NODES.replace("type=B21", "type=B22").replace("1, 1, 2\n2, 2, 3\n3, 3, 4\n4, 4, 5", halves)
    step = STEP.replace("Tip, 2, -7.", "2, 2, 0.02\n3, 2, 0.005\n1, 2, 0.005")
    expected = sum(p * x**2 * (3.0 - x) for x, p in ((0.25, 0.02), (0.5, 0.005))) / (6.0 * RIGIDITY)
    file = read(tmp_path, lines + SECTION + step)
    assert [load.point.fraction for load in file.model.loads] == [0.25, 0.5, 0.0]
    assert tip(file)[1] == pytest.approx(expected, rel=2e-4)


def test_a_straight_beam_is_in_the_plane_of_its_loads(tmp_path):
    text = (NODES + SECTION + STEP).replace("Tip, 2, -7.", "Tip, 3, -7.").replace("type=B21", "type=B31")
    turned = read(tmp_path, text)  # a width of 2 mm, 10 mm high
    assert turned.model.beams[0].section == bf.Rectangle(0.002, 0.01, 0.85)
    assert tip(turned)[1] == pytest.approx(-7.0 / (3.0 * 25.0 * RIGIDITY), rel=1e-2)
    spread = text.replace("*Cload\nTip, 3, -7.", "*Dload\nArm, PZ, -7.\n, GRAV, 9.81, 0., 0., -1.")
    weight = 7.0 + 7850.0 * 9.81 * 2e-5
    assert tip(read(tmp_path, spread))[1] == pytest.approx(-weight / (8.0 * 25.0 * RIGIDITY), rel=1e-2)


def test_sets_of_a_part_and_of_the_assembly_may_have_the_same_name(tmp_path):
    """Abaqus/CAE names both Set-1; the clamp was at all nodes."""
    sets = "*Nset, nset=Set-1, generate\n1, 5, 1\n*Elset, elset=Set-1, generate\n1, 4, 1\n"
    section, others = SECTION.replace("ARM", "Set-1").split("*Material")
    assembly = "*End Part\n*Assembly, name=Assembly\n*Instance, name=Part-1-1, part=Part-1\n*End Instance\n"
    assembly += "*Nset, nset=Set-1, instance=Part-1-1\n1,\n*Elset, elset=Set-1, instance=Part-1-1\n4,\n*End Assembly\n"
    mesh = "*Heading\n*Part, name=Part-1\n" + NODES.partition("long\n")[2]
    loads = STEP.replace("*Cload\nTip, 2, -7.", "*Dload\nSet-1, PY, -0.01")
    held = others.replace("1, Encastre", "Set-1, ENCASTRE")
    file = read(tmp_path, f"{mesh}{sets}{section}{assembly}*Material{held}{loads}")
    assert len(file.model.supports) == 1
    last = 0.01 * (1.0 / 8.0 - (0.75**3 / 6.0 - 0.75**4 / 24.0)) / RIGIDITY
    assert tip(file)[1] == pytest.approx(-last, rel=2e-4)


def test_the_size_of_a_circle_is_a_diameter_with_elements_of_calculix(tmp_path):
    text = (NODES + SECTION + STEP).replace("section=RECT", "section=CIRC").replace("0.01, 0.002", "0.02")
    assert read(tmp_path, text).model.beams[0].section == bf.Circle(0.04, 0.89)
    with pytest.warns(bf.NotReadWarning, match="diameter, as in CalculiX"):
        (beam,) = read(tmp_path, text.replace("type=B21", "type=B31R")).model.beams
    assert beam.section == bf.Circle(0.02, 0.89)


def test_supports_in_directions_of_the_plane_only(tmp_path):
    held = SECTION.partition("*Boundary")[0] + "*Boundary\n1, PINNED\n5, 2, 4\n3, XSYMM\n2, 6\n"
    kinds = read(tmp_path, NODES + held).model.supports
    assert [type(support).__name__ for support in kinds] == ["Pin", "Prescribed", "Prescribed", "Prescribed"]
    assert [list(support.prescribed()) for support in kinds] == [["ux", "uy"], ["uy"], ["ux", "rotation"], ["rotation"]]


def test_what_is_left_out_is_named(tmp_path):
    more = "*Amplitude, name=Ramp\n0., 0., 1., 1.\n*MPC\nPIN, 1, 2\n*Plastic\n2.35e8, 0.\n"
    text = NODES + SECTION.replace("*Density\n7850.\n", "") + more + STEP.replace(", nlgeom=YES", "")
    text = text.replace("*Cload", "*Dload\nArm, P1, 3.\n*Cload\nTip, 3, 1.\n*Cload") + STEP
    with pytest.warns(bf.NotReadWarning) as caught:
        file = read(tmp_path, text)
    sentence = str(caught[0].message)
    for part in (
        "*AMPLITUDE",
        "*MPC",
        "*PLASTIC (its first",
        "without NLGEOM",
        "*DLOAD P1",
        "in direction 3",
        "no *DENSITY of STEEL",
        "steps",
    ):
        assert part in sentence
    assert "OUTPUT" not in sentence
    assert file.model.beams[0].material.strength == 2.35e8


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("section=RECT", "section=HEX", "line 16: SECTION=HEX cannot be read; RECT, CIRC"),
        (
            "section=RECT, elset=ARM, material=steel\n0.01, 0.002",
            "section=BOX, elset=ARM, material=steel\n1,1,.1,.1,.1,.2",
            "equal",
        ),
        (
            "section=RECT, elset=ARM, material=steel\n0.01, 0.002",
            "section=I, elset=ARM, material=steel\n0,1,1,1,.1,.1,.1",
            "centroid",
        ),
        ("0.01, 0.002", "0.01", "line 17: SECTION=RECT needs 2 sizes, got 1"),
        ("material=steel", "material=brass", r"no \*MATERIAL BRASS"),
        ("elset=ARM, mat", "elset=LEG, mat", "no elset LEG"),
        ("2.1e11, 0.3", "2.1e11, 0.7", "bulk modulus"),
        ("2.1e11, 0.3", "steel", r"line 21: this line below \*ELASTIC cannot be read"),
        ("Tip, 2", "Top, 2", "no nset TOP"),
        ("Tip, 2", "77, 2", "77, which the file does not give"),
        ("Tip, 2, -7.", "Tip", r"line \d+: this line below \*CLOAD"),
        ("4, 4, 5", "5, 5, 4", "opposite directions"),
    ],
)
def test_what_cannot_be_read_is_refused_by_name_and_line(tmp_path, old, new, message):
    text = NODES + SECTION + STEP
    assert old in text
    with pytest.raises(bf.InputError, match=message):
        read(tmp_path, text.replace(old, new).replace("*Cload", "*Dload\nArm, P2, 1.\n*Cload"))


def test_units_are_those_that_are_named(tmp_path):
    """They name what numbers are and change none, as those of a Model; a steel of 2.1e11 N/mm^2 is warned of."""
    assert read(tmp_path, NODES + SECTION + STEP).model.units == "N, m, s"
    path = tmp_path / "millimetres.inp"
    path.write_text((NODES + SECTION + STEP).replace("2.1e11", "2.1e5").replace("7850.", "7.85e-9"))
    named = bf.read_abaqus_model(path, units="N, mm").model
    assert (named.unit("Pa"), named.beams[0].material.youngs_modulus) == ("MPa", 2.1e5)
    with pytest.warns(bf.UnitsWarning, match="youngs_modulus"):
        bf.read_abaqus_model(tmp_path / "model.inp", units="N, mm")
    with pytest.raises(bf.InputError, match="units"):
        bf.read_abaqus_model(path, units="N, feet")


@pytest.mark.parametrize(("axis", "second"), [("0., 0., -1.", 1e-8), ("0., 1., 0.", 4e-8)])
def test_a_general_section_bends_about_the_axis_that_is_normal_to_the_plane(axis, second, tmp_path):
    """It took the moment of inertia about the first axis, wherever that was."""
    general = f"*Beam General Section, section=GENERAL, elset=ARM, density=7800.\n1e-3, 1e-8, 0., 4e-8, 1e-9\n{axis}\n"
    nodes = "*Node\n1, 0., 0.\n2, 1., 0.\n*Element, type=B21, elset=ARM\n1, 1, 2\n"
    file = read(tmp_path, f"{nodes}{general}2e11, 7.7e10\n*Boundary\n1, ENCASTRE\n")
    beam = file.model.beams[0]
    assert beam.section_at(0.0).rigidity(beam.material).bending == pytest.approx(2e11 * second)


def test_what_a_general_or_moved_section_leaves_out_is_named(tmp_path):
    nodes = "*Node\n1, 0., 0.\n2, 1., 0.\n*Element, type=B21, elset=ARM\n1, 1, 2\n"
    general = "*Beam General Section, section=GENERAL, elset=ARM\n1e-3, 1e-8, 2e-9, 4e-8, 1e-9\n\n2e11, 7.7e10\n"
    with pytest.warns(bf.NotReadWarning, match="product of inertia I12"):
        read(tmp_path, nodes + general)
    moved = "*Beam Section, section=RECT, elset=ARM, material=S, OFFSET2=0.5\n0.01, 0.02\n0., 0., -1.\n"
    steel = "*Material, name=S\n*Elastic\n2e11, 0.3\n*Density\n7800.\n"
    with pytest.warns(bf.NotReadWarning, match=r"the offset of \*BEAM SECTION"):
        read(tmp_path, nodes + moved + steel)
