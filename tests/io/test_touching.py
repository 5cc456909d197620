"""Ends that meet but for rounding, and lines that end inside others: joined, or named."""

import numpy as np
import pytest
from mesh_parts import SECTION, STEEL, frame, written

import beamfem as bf

FORCE = 0.1  # small: the references are linear
BENDING, AXIAL = 2e11 * 0.1**4 / 12, 2e11 * 0.1**2


def post_under_a_beam(folder, at=1.0, off=0.0, members="cells"):
    """A cantilever of 2 m, loaded at its end, and a post of 1 m under it that is no node of the line in the file."""
    points = [(0, 0, 0), (2, 0, 0), (at, off, 0), (at, -1, 0)]
    cell_data = {"profile": [np.array([1, 2])]}
    mesh = written(folder / "post.vtu", points, [("line", [[0, 1], [3, 2]])], cell_data=cell_data)
    return mesh, frame(mesh, 4, bf.CRBF(3), members=members)


@pytest.mark.parametrize("off", [0.0, 1e-8, 9e-6])
@pytest.mark.parametrize("members", ["cells", "chains"])
def test_a_post_that_ends_inside_a_beam_carries_it(tmp_path, off, members):
    """Slender and linear: the force X of the hinged foot's post from equal deflections, sway and rotation free.

    The post's foot is on a roller, so that it only pushes: w of the beam under it is X times the post's flexibility.
    """
    mesh, found = post_under_a_beam(tmp_path, off=off, members=members)
    assert len(mesh.cells) == 3
    assert {name: cells.tolist() for name, cells in mesh.member_sets.items() if "=" in name} == {
        "profile=1": [0, 1],
        "profile=2": [2],
    }
    tip, foot = found.at(2.0, 0.0), found.at(1.0, -1.0)
    supports = [bf.Clamp(found.at(0.0, 0.0)), bf.Roller(foot, (0.0, 1.0))]
    model = bf.Model(found.beams, supports, [bf.PointForce(tip, (0.0, -FORCE))], found.joints)
    solution = bf.solve_static(model)
    shear = 5 / 6 * 2e11 / 2.6 * 0.1**2
    # under the post, of a force at the tip and of one there
    of_tip, of_post = 1.0 * (3 * 2.0 - 1.0) / (6 * BENDING) + 1 / shear, 1 / (3 * BENDING) + 1 / shear
    push = FORCE * of_tip / (of_post + 1.0 / AXIAL)
    assert solution.reaction(foot)[-1][1] == pytest.approx(push, rel=1e-5 if off else 1e-6)
    whole = 8.0 / (3 * BENDING) + 2 / shear
    assert solution.displacement(tip)[-1, 1] == pytest.approx(push * of_tip - FORCE * whole, rel=1e-5)


@pytest.mark.parametrize("off", [-1e-4, 2e-4])
def test_a_post_that_ends_just_beside_a_beam_is_named(tmp_path, off):
    """A gap of 1e-4 m carries nothing, and is hardly meant."""
    with pytest.warns(bf.NotJoinedWarning, match=r"the end at \(1, [-+0-9.e]+\) is within 0.0006 of another line"):
        mesh, _ = post_under_a_beam(tmp_path, off=off)
    assert len(mesh.cells) == 2


def test_two_ends_that_nearly_meet_are_named(tmp_path):
    points = [(0, 0, 0), (1, 0, 0), (1, 1e-4, 0), (1, 1, 0)]
    with pytest.warns(bf.NotJoinedWarning, match=r"the end at \(1, .*\) is within 0.0003"):
        written(tmp_path / "corner.vtu", points, [("line", [[0, 1], [2, 3]])])


def test_several_ends_divide_one_line(tmp_path):
    points = [(0, 0, 0), (3, 3, 0), (2, 2, 0), (2, 0, 0), (1, 1, 0), (0, 1, 0), (1, 2, 0)]
    mesh = written(tmp_path / "comb.vtu", points, [("line", [[0, 1], [3, 2], [5, 4], [4, 6]])])
    assert mesh.cells[:, :2].tolist() == [[0, 4], [4, 2], [2, 1], [3, 2], [5, 4], [4, 6]]
    assert len(frame(mesh).joints) == 6 - 1 + 1 - 1  # 4 lines at (1, 1), 3 at (2, 2)


def test_lines_that_lie_on_each_other_are_named(tmp_path):
    points = [(0, 0, 0), (2, 0, 0), (1, 0, 0), (3, 0, 0)]
    with pytest.raises(bf.InputError, match=r"lines 0 and 1 .* are the same line from \(1, 0\) to \(2, 0\)"):
        written(tmp_path / "over.vtu", points, [("line", [[0, 1], [2, 3]])])


def test_a_line_that_crosses_another_is_not_joined(tmp_path):
    points = [(0, 0, 0), (1, 1, 0), (0, 1, 0), (1, 0, 0)]
    assert len(written(tmp_path / "cross.vtu", points, [("line", [[0, 1], [2, 3]])]).cells) == 2


def test_an_end_inside_a_line3_is_named(tmp_path):
    """On the parabola y = 0.3 (1 - (x - 1)^2), beside its chord; a point on the chord does not touch it."""
    for y, touches in ((0.225, True), (0.0, False)):
        points = [(0, 0, 0), (2, 0, 0), (1, 0.3, 0), (0.5, y, 0), (0.5, -1, 0)]
        cells = [("line3", [[0, 1, 2]]), ("line", [[3, 4]])]
        if touches:
            with pytest.raises(bf.InputError, match=r"inside line 0, a line3, at \(0\.5, 0\.225\); split"):
                written(tmp_path / "arch.vtu", points, cells)
        else:
            assert len(written(tmp_path / "arch.vtu", points, cells).cells) == 2


def test_nodes_that_rounding_has_parted_are_named(tmp_path):
    points = [(0, 0, 0), (1, 0, 0), (1 + 1e-8, 0, 0), (1, 1, 0)]
    with pytest.raises(bf.InputError, match=r"two nodes are at \(1, 0\), 1e-08 apart"):
        written(tmp_path / "parted.vtu", points, [("line", [[0, 1], [2, 3]])])


@pytest.mark.parametrize("gap", [(1e-8, 0.0), (0.0, 1e-8), (8e-6, -5e-6)])
@pytest.mark.parametrize("element", [bf.CRBF(3), bf.ANCF(bf.Structural()), bf.CRBF(2, bf.ContinuumMechanics())])
def test_a_gap_is_closed_without_stress(gap, element):
    """Clamped at both ends, unloaded but for a small force: with the gap as strain it carries up to 160 N."""
    common = {"elements": 4, "element": element, "section": SECTION, "material": STEEL}
    found = []
    for x, y in ((0.0, 0.0), gap):
        one, other = bf.Beam(bf.Line((0, 0), (1, 0)), **common), bf.Beam(bf.Line((1 + x, y), (2, 0)), **common)
        supports = [bf.Clamp(one.start), bf.Clamp(other.end)]
        model = bf.Model([one, other], supports, [bf.PointForce(one.end, (0, -1.0))], [bf.Rigid(one.end, other.start)])
        solution = bf.solve_static(model)
        assert solution.displacement(one.end)[0] == pytest.approx([0, 0], abs=1e-15)
        found.append((solution.reaction(one.start)[-1], solution.displacement(other.start)[-1]))
    (exact, moved), (reaction, closed) = found
    # the axis has a kink of a gap over the length of an element, 4e-5
    assert reaction == pytest.approx(exact, abs=2e-4)
    assert closed == pytest.approx(moved, rel=1e-4, abs=1e-12)


def test_a_gap_beyond_the_tolerance_is_refused():
    common = {"elements": 1, "element": bf.CRBF(2), "section": SECTION, "material": STEEL}
    one, other = bf.Beam(bf.Line((0, 0), (1, 0)), **common), bf.Beam(bf.Line((1.0001, 0), (2, 0)), **common)
    with pytest.raises(bf.InputError, match=r"0\.0001 m apart; a joint needs points that coincide, to 1e-05"):
        bf.Model([one, other], [bf.Clamp(one.start)], [], [bf.Rigid(one.end, other.start)])


@pytest.mark.parametrize("size", [0.5, 1.0, 30.0])
def test_a_line_and_an_arc_of_six_decimals_make_a_chain(tmp_path, size):
    """A drawing whose numbers are rounded: line, quarter arc and line, at an angle; smooth and without gaps then."""
    ezdxf = pytest.importorskip("ezdxf")
    angle, radius = 0.3, size / 3
    along, across = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
    start = size * np.array([1 / 7, 1 / 3])
    corner = start + size * along
    center = corner + radius * across
    end = center + radius * along
    drawing = ezdxf.new()
    space = drawing.modelspace()
    space.add_line(start.round(6), corner.round(6))
    degrees = np.degrees([angle - np.pi / 2, angle]).round(6)
    space.add_arc(center.round(6), round(radius, 6), *degrees)
    space.add_line(end.round(6), (end + size * across).round(6))
    drawing.saveas(tmp_path / "drawing.dxf")
    chain = bf.Chain(bf.read_dxf(tmp_path / "drawing.dxf"))
    exact = 2 * size + radius * np.pi / 2
    assert chain.length == pytest.approx(exact, abs=3e-6)
    assert chain.position(np.array([chain.length]))[0] == pytest.approx(end + size * across, abs=6e-6)
    joints = size * np.array([1.0, 1.0 + np.pi / 6])
    before, after = chain.position(joints - 1e-5), chain.position(joints + 1e-5)
    assert np.linalg.norm(after - before, axis=1) == pytest.approx(2e-5, rel=1e-3)
    beam = bf.Beam(chain, 12, bf.CRBF(3), bf.Rectangle(0.01, 0.01), STEEL)
    tip = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (1e-6, 0.0))]))
    assert np.abs(tip.section_forces(beam).normal).max() < 1e-5
