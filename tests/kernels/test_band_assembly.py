"""Matrices of elements in a band: sums over all entries, whatever is prescribed and however nodes are numbered."""

import numpy as np
import pytest

from beamfem.kernels import band_assembly
from beamfem.kernels.compiling import Routine
from beamfem.kernels.model_record import LANES, ROW

ELEMENTS = (1, 2, 7, 8, 9, 17, LANES)


def numbers_of(nodes, coordinates, elements, kind):
    """Return the numbers (nodes * coordinates, elements) of a chain, -1 if prescribed, and how many there are."""
    between = (nodes - 1) * coordinates
    each = np.arange(nodes * coordinates)[:, None] + between * np.arange(elements)
    count = between * elements + coordinates
    if kind == "backwards":  # nodes are numbered from the far end, their coordinates in order
        node, own = np.divmod(each, coordinates)
        each = (count // coordinates - 1 - node) * coordinates + own
    elif kind == "clamped":
        each = each - coordinates
    elif kind == "supported":  # at both ends, and a coordinate in the middle
        each = each - 1
        each[-1, -1] = -1
        each[0, elements // 2] = -1
    elif kind == "mixed":  # coordinates of a node are not in a row
        each = count - 1 - each
    return np.where(each < 0, -1, each), count


def added(routine, nodes, coordinates, size, number, count, k):
    half = nodes * coordinates - 1
    matrix = np.full((count + 4, 2 * half + 1), 0.5)
    inside = matrix[2:-2]
    routine(nodes, size, coordinates, number.shape[1], number.shape[1], number, half, k, inside)
    assert (matrix[:2] == 0.5).all()
    assert (matrix[-2:] == 0.5).all()
    return inside


def expected(nodes, coordinates, size, number, count, k):
    half = nodes * coordinates - 1
    rows = [n * size + dof for n in range(nodes) for dof in range(coordinates)]
    matrix = np.full((count, 2 * half + 1), 0.5)
    for i in range(number.shape[1]):
        for column, c in zip(number[:, i], rows, strict=True):
            for row, r in zip(number[:, i], rows, strict=True):
                if row >= 0 and column >= 0:
                    matrix[row, half + column - row] += k[c, r, i]
    return matrix


@pytest.fixture(scope="module")
def without_parts():
    """The routine of processors that write parts of vectors slowly."""
    whole = band_assembly.add_to_band
    routine = Routine(whole.function, whole.signature, whole.fastmath)
    routine.__module__ = __name__  # not from the cache
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(band_assembly, "WRITES_PARTS", False)
        assert routine.address
    return routine


@pytest.mark.parametrize("kind", ["free", "clamped", "supported", "backwards", "mixed"])
@pytest.mark.parametrize(("nodes", "coordinates"), [(2, 3), (2, 4), (2, 5), (2, 6), (3, 3), (5, 3)])
def test_matrices_in_a_band_are_the_sum_of_their_entries(nodes, coordinates, kind, rng, without_parts):
    routines = band_assembly.add_to_band, without_parts
    for elements in ELEMENTS:
        number, count = numbers_of(nodes, coordinates, elements, kind)
        number = np.ascontiguousarray(number, dtype=np.int64)
        size = coordinates + 1  # rows of k that are not added lie between those of two nodes
        k = rng.standard_normal((nodes * size, nodes * size, ROW))
        wanted = expected(nodes, coordinates, size, number, count, k)
        for routine in routines:
            found = added(routine, nodes, coordinates, size, number, count, k)
            np.testing.assert_allclose(found, wanted, rtol=1e-14, atol=1e-14)
