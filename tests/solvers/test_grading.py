"""Meshes that are given, and graded ones."""

import numpy as np
import pytest
from skfem import MeshLine

import beamfem as bf


@pytest.mark.parametrize("ratio", [0.1, 1.0, 8.0])
def test_lengths_grow_geometrically(ratio):
    lengths = np.diff(bf.graded(7, ratio))
    assert lengths[-1] / lengths[0] == pytest.approx(ratio, rel=1e-12)
    assert lengths[1:] / lengths[:-1] == pytest.approx(np.full(6, ratio ** (1 / 6)), rel=1e-12)
    assert lengths.sum() == pytest.approx(1.0, abs=1e-15)


def test_a_beam_takes_them():
    beam = bf.Beam(bf.Line((0, 0), (2, 0)), bf.graded(3, 4.0), bf.CRBF(1), bf.Rectangle(0.1, 0.1), bf.Material(1, 0, 1))
    assert bf.Model([beam]).meshes[0].vertices == pytest.approx([0.0, 2 / 7, 6 / 7, 2.0], rel=1e-14)


@pytest.mark.parametrize(("elements", "ratio"), [(0, 1.0), (3, -1.0), (2.5, 1.0)])
def test_nonsense_is_refused(elements, ratio):
    with pytest.raises(bf.InputError):
        bf.graded(elements, ratio)


def bent(elements):
    """The tip of a tapered cantilever with elements as given, and the beam."""
    taper = bf.Interpolated([(0.0, 0.1), (2.0, 0.05)])
    beam = bf.Beam(
        bf.Line((0, 0), (2, 0)), elements, bf.CRBF(2), lambda s: bf.Rectangle(0.1, taper(s)), bf.Material(1e9, 0, 1)
    )
    model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, -2000.0))])
    return beam, bf.solve_static(model).displacement(beam.end)[-1]


def test_a_mesh_of_scikit_fem_gives_what_its_ends_give():
    """Refined where it is thin: scikit-fem appends vertices and turns elements round."""
    mesh = MeshLine(np.linspace(0.0, 2.0, 4)).refined(1).refined(np.array([4, 5]))
    assert np.any(np.diff(mesh.p[0]) < 0.0)
    beam, tip = bent(mesh)
    _, expected = bent(np.sort(mesh.p[0]) / 2.0)
    assert np.array_equal(tip, expected)
    assert np.array_equal(beam.mesh.p[0], np.sort(mesh.p[0]))
    assert beam.mesh.p[0, beam.mesh.facets[0, beam.mesh.boundaries["start"]]] == [0.0]
    assert beam.mesh.p[0, beam.mesh.facets[0, beam.mesh.boundaries["end"]]] == [2.0]
    assert beam.mesh.subdomains is None


def test_a_mesh_is_divided_where_the_section_jumps():
    section = bf.Piecewise(lambda s: 0.1 if s < 0.7 else 0.05, [0.7])
    beam = bf.Beam(
        bf.Line((0, 0), (2, 0)), 4, bf.CRBF(2), lambda s: bf.Rectangle(0.1, section(s)), bf.Material(1e9, 0, 1)
    )
    ends = beam.mesh.p[0]
    assert ends == pytest.approx([0.0, 0.5, 0.7, 1.0, 1.5, 2.0])
    for part, (start, end) in (("0", (0.0, 0.7)), ("1", (0.7, 2.0))):
        inside = ends[beam.mesh.t[:, beam.mesh.subdomains[part]]]
        assert (inside.min(), inside.max()) == pytest.approx((start, end))


@pytest.mark.parametrize(
    ("mesh", "words"),
    [
        (MeshLine([0.0, 1.0]), "must cover the arc length of the beam from 0 to 2, got 0 to 1"),
        (MeshLine([0.5, 2.0]), "got 0.5 to 2"),
        (MeshLine([[0.0, 0.5, 1.0, 2.0]], [[0, 2], [1, 3]]), "one chain of elements without gaps or overlaps"),
        (MeshLine([[0.0, 1.0, 2.0]], [[0, 0], [1, 2]]), "one chain of elements without gaps or overlaps"),
    ],
)
def test_a_mesh_that_is_no_division_of_the_axis_is_refused(mesh, words):
    with pytest.raises(bf.InputError, match=words):
        bent(mesh)
