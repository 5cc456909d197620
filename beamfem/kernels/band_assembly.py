"""Addition of the matrices of a batch of elements to a band matrix.

In most of a chain the numbers of an element are those of the element before plus a step. Between the elements at the
ends that have prescribed coordinates, entries are not looked up then but added several at a time.
"""

from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.model_record import ROW
from beamfem.kernels.pointers import at
from beamfem.kernels.simd import COLUMNS, WIDTH, WRITES_PARTS, add_columns


@inlined
def _lacking(rows, stride, number):
    """Return how many coordinates of an element lack an equation; number (rows, stride): from this element on."""
    lacking = 0
    for row in range(rows):
        lacking += number[row * stride] < 0
    return lacking


@inlined
def _are_regular(nodes, coordinates, count, stride, number, step):
    """Return whether coordinates of a node have consecutive numbers, which grow by a step from element to element."""
    wrong = 0
    for row in range(nodes * coordinates):
        numbers = at(number, row * stride)
        wrong += abs(numbers[0] - number[row // coordinates * coordinates * stride] - row % coordinates)
        for i in range(count):
            wrong += abs(numbers[i] - numbers[0] - i * step)
    return wrong == 0


@inlined
def _add_one_by_one(begin, end, nodes, size, coordinates, stride, number, half, k, matrix):
    """Add the matrices of some elements without the rows and columns of prescribed coordinates."""
    rows, width = nodes * size, 2 * half
    for i in range(begin, end):
        for m in range(nodes):
            for column_dof in range(coordinates):
                column = number[(m * coordinates + column_dof) * stride + i]
                if column < 0:
                    continue
                for n in range(nodes):
                    for row_dof in range(coordinates):
                        row = number[(n * coordinates + row_dof) * stride + i]
                        if row >= 0:
                            value = k[(rows * (m * size + column_dof) + n * size + row_dof) * ROW + i]
                            matrix[width * row + half + column] += value


@routine("iiiiinirr")
def add_to_band(nodes, size, coordinates, count, stride, number, half, k, matrix):
    """Add the reduced matrices k of a batch to a band matrix (n, 2 half + 1); number (nodes * coordinates, stride)."""
    rows, width, begin, end, step = nodes * size, 2 * half, 0, count, 0
    while begin < end and _lacking(nodes * coordinates, stride, at(number, begin)) > 0:
        begin += 1
    while begin < end and _lacking(nodes * coordinates, stride, at(number, end - 1)) > 0:
        end -= 1
    if end - begin > 1:
        step = number[begin + 1] - number[begin]
    if begin < end and not _are_regular(nodes, coordinates, end - begin, stride, at(number, begin), step):
        begin, end = count, count
    shift = (width + 1) * step
    _add_one_by_one(0, begin, nodes, size, coordinates, stride, number, half, k, matrix)
    for n in range(nodes):
        for row_dof in range(coordinates):
            numbers = at(number, (n * coordinates + row_dof) * stride)
            for m in range(nodes):
                for column_dof in range(0, coordinates, COLUMNS):
                    columns = min(COLUMNS, coordinates - column_dof)
                    value = at(k, (rows * (m * size + column_dof) + n * size + row_dof) * ROW)
                    for i in range(begin, end, WIDTH):
                        column = number[m * coordinates * stride + i] + column_dof
                        own, entry = at(value, i), at(matrix, width * numbers[i] + half + column)
                        if WRITES_PARTS:
                            add_columns(columns, end - i, rows * ROW, own, shift, entry)
                        else:
                            for j in range(columns):
                                for lane in range(min(WIDTH, end - i)):
                                    entry[lane * shift + j] += own[j * rows * ROW + lane]
    _add_one_by_one(end, count, nodes, size, coordinates, stride, number, half, k, matrix)
