"""Nodes of a chunk: from coordinates to nodal vectors; `record` defines the rows of a chunk."""

import numpy as np

from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.model_record import ROW
from beamfem.kernels.pointers import at, small_code
from beamfem.kernels.simd import WIDTH, as_rows, gathered

# pi / 2 as a sum of three parts, the first two with few digits, so that their products with integers are exact
_PART_1, _PART_2, _PART_3 = 1.57079632673412561417, 6.07710050630396597660e-11, 2.02226624879595063154e-21


@inlined
def cosine_sine(angle):
    """Return cosine and sine without a branch, so that it also works on lanes; Cody and Waite 1980."""
    quarters = np.floor(angle * 0.63661977236758134308 + 0.5)
    x = (angle - quarters * _PART_1) - quarters * _PART_2
    x = x - quarters * _PART_3
    z = x * x
    s = 1.58962301576546568060e-10
    s = -2.50507477628578072866e-8 + z * s
    s = 2.75573136213857245213e-6 + z * s
    s = -1.98412698295895385996e-4 + z * s
    s = 8.33333333332211858878e-3 + z * s
    s = -1.66666666666666307295e-1 + z * s
    sine = x + x * z * s
    c = -1.13585365213876817300e-11
    c = 2.08757008419747316778e-9 + z * c
    c = -2.75573141792967388112e-7 + z * c
    c = 2.48015872888517045348e-5 + z * c
    c = -1.38888888888730564116e-3 + z * c
    c = 4.16666666666665929218e-2 + z * c
    cosine = 1.0 - 0.5 * z + z * z * c
    # of the number of quarter turns: `half` if it is two or three, `odd` if it is one or three
    half = np.floor(0.5 * quarters) - 2.0 * np.floor(0.25 * quarters)
    odd = quarters - 2.0 * np.floor(0.5 * quarters)
    even, minus = 1.0 - odd, 1.0 - 2.0 * half
    return minus * (even * cosine - odd * sine), minus * (even * sine + odd * cosine)


@inlined
def take(first, count, coordinates, stride, source, values, last, rows):
    """Copy the values (n,) of the coordinates of nodes to rows.

    source (coordinates, stride): numbers of the coordinates, see `record.SOURCE`; last: no other nodes follow in these
    rows, so that whole lanes may be written.
    """
    for row in range(coordinates):
        numbers, to = at(source, row * stride + first), at(rows, row * ROW)
        if last:
            lanes = as_rows(to)
            for i in range(0, count, WIDTH):
                lanes[i] = gathered(values, at(numbers, i))
        else:
            for i in range(count):
                to[i] = values[numbers[i]]


@inlined
def put(rows, count, last, source, to):
    """Copy rows to a chunk; last: no other nodes follow in its rows, so that whole lanes may be written."""
    if last:
        lanes, filled = as_rows(source), as_rows(to)
        for i in range(0, count, WIDTH):
            for row in range(i, i + rows * ROW, ROW):
                filled[row] = lanes[row]
    else:
        for row in range(rows):
            for i in range(row * ROW, row * ROW + count):
                to[i] = source[i]


@routine("iivvv", fastmath={"contract"})
def rotate_frame(count, stride, angle, frame, rows):
    """Fill rows (3, ROW) with the cosine and sine of the reference angle plus `angle`, and with |r_x|.

    frame (3, stride): cosine and sine of the reference angle, and |r_x|.
    """
    small_code()
    c, s, length = frame, at(frame, stride), at(frame, 2 * stride)
    for i in range(0, count, WIDTH):
        cosine, sine = cosine_sine(angle[i])
        rows[i] = cosine * c[i] - sine * s[i]
        rows[ROW + i] = sine * c[i] + cosine * s[i]
        rows[2 * ROW + i] = length[i]


@routine("irrr", fastmath={"contract"})
def rotate(count, c, s, vector):
    """Rotate the vectors in two rows by angles with cosines c and sines s."""
    for i in range(count):
        x, y = vector[i], vector[ROW + i]
        vector[i] = c[i] * x - s[i] * y
        vector[ROW + i] = s[i] * x + c[i] * y


@routine("iivv")
def copy_rows(rows, count, source, to):
    """Copy rows."""
    small_code()
    for i in range(0, count, WIDTH):
        for row in range(i, i + rows * ROW, ROW):
            to[row] = source[row]


@routine("iiv")
def clear(rows, count, to):
    """Set rows to zero."""
    small_code()
    for i in range(0, count, WIDTH):
        for row in range(i, i + rows * ROW, ROW):
            to[row] = 0.0
