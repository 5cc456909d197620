"""Nodal vectors that rotate with their section, in runs."""

import numpy as np
import pytest
from conftest import USUAL, beam, identify

import beamfem as bf
from beamfem.equations.rotating_vectors import rotating_vectors, runs_of
from beamfem.equations.system import system_of


def spread(runs):
    """Return x, y and node of each vector of runs, by x."""
    rows = [(x + i * step, y + i * step, node + i) for x, y, node, step, count in runs.tolist() for i in range(count)]
    return np.array(sorted(rows), dtype=np.int64).reshape(-1, 3)


@pytest.mark.parametrize("element", USUAL, ids=identify)
def test_runs_hold_each_vector_of_a_chain_once_and_are_few(element):
    chain = beam(element, 20)
    pairs = system_of(bf.Model([chain], [bf.Clamp(chain.start)]), False).table(rotating_vectors)
    runs = runs_of(pairs)
    np.testing.assert_array_equal(spread(runs), pairs[:, :3])
    vectors = len(np.unique(pairs[:, 3]))
    assert len(pairs) >= 20
    # of each nodal vector at each node of an element; numbers of the first element are not like those of the others
    assert len(runs) <= 2 * vectors * (element.field.degree + 1)


def test_runs_of_a_frame_with_corners_and_supports_inside_hold_each_vector_once():
    element = bf.CRBF(2)
    angle, strut = bf.Polyline([(0, 0), (1, 0), (1, 1)]), bf.Line((0, 0), (1, 1))
    section, steel = bf.Section(area=1.6e-3, second_moment=8.533e-6), bf.Material(0.7e6, 0.3, 5540.0)
    bent, straight = (bf.Beam(curve, 6, element, section, steel) for curve in (angle, strut))
    joints = [bf.Hinge(bent.start, straight.start), bf.Rigid(bent.end, straight.end)]
    supports = [bf.Pin(bent.start), bf.Roller(bent.at(0.5), normal=(1.0, 1.0)), bf.Pin(straight.at(0.5))]
    pairs = system_of(bf.Model([bent, straight], supports, joints=joints), False).table(rotating_vectors)
    np.testing.assert_array_equal(spread(runs_of(pairs)), pairs[:, :3])


@pytest.mark.parametrize("steps", [[], [3], [3, 3, 3], [3, 4, 3, 3], [0, 0]])
def test_irregular_numbers_end_a_run(steps):
    x = np.cumsum([5, *steps])
    pairs = np.column_stack([x, x + 1, np.arange(len(x)), np.zeros(len(x), dtype=np.int64)])
    runs = runs_of(pairs)
    np.testing.assert_array_equal(spread(runs), pairs[np.argsort(x, kind="stable"), :3])
    assert len(runs) == {(): 1, (3,): 1, (3, 3, 3): 1, (3, 4, 3, 3): 3, (0, 0): 1}[tuple(steps)]


def test_no_vector_has_no_run():
    assert len(runs_of(np.empty((0, 4), dtype=np.int64))) == 0
