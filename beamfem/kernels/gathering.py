"""Between nodes and batches: what elements need of their nodes and tables, and what they give back."""

from beamfem.kernels.compiling import routine
from beamfem.kernels.pointers import at
from beamfem.kernels.record import ROW


@routine("iiiinirr")
def gather(nodes, count, first, stride, place, rows, chunks, e):
    """Copy the first rows of the nodes of a batch to e (nodes, rows, ROW); place (nodes, stride): see `record`."""
    for n in range(nodes):
        own = at(place, n * stride + first)
        for row in range(rows):
            to, source = at(e, (n * rows + row) * ROW), at(chunks, row * ROW)
            for i in range(count):
                to[i] = source[own[i]]


@routine("iiiiniirr")
def scatter(nodes, count, first, stride, place, size, row, f, chunks):
    """Add forces f (nodes, size, ROW) of a batch to those of its nodes, which begin at a row."""
    for n in range(nodes):
        own = at(place, n * stride + first)
        for part in range(size):
            source, to = at(f, (n * size + part) * ROW), at(chunks, (row + part) * ROW)
            for i in range(count):
                to[own[i]] += source[i]


@routine("iinirr")
def fill_tables(count, rows, classes, uniform, tables, t):
    """Copy rows of tables of each element's class to t (rows, ROW); uniform: all are of the first one's class."""
    if uniform != 0:
        own = at(tables, classes[0] * rows)
        for row in range(rows):
            to, value = at(t, row * ROW), own[row]
            for i in range(count):
                to[i] = value
        return
    for i in range(count):
        own = at(tables, classes[i] * rows)
        for row in range(rows):
            t[row * ROW + i] = own[row]


@routine("iinrr")
def fill_body(count, own, beams, body, rows):
    """Copy acceleration of gravity and load per length (beams, 4) of each element's beam to rows (4, ROW)."""
    for i in range(count):
        beam = 4 * beams[i]
        for part in range(4):
            rows[part * ROW + i] = body[beam + part]
