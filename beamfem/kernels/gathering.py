"""Between nodes and batches: what elements need of their nodes and tables, and what they give back."""

from beamfem.kernels import record as r
from beamfem.kernels.compiling import routine
from beamfem.kernels.pointers import at, reals, wholes
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


@routine("iiii")
def fill_tables(group, first, count, part):
    """Copy rows of the tables of each element's class to those of a batch that begin at `part`, if they are not there.

    Elements of one class share a table, so that the next batch of this class, or the next evaluation, finds it filled.
    """
    b = wholes(group)
    rows, own, t = b[r.TABLE_ROWS], at(wholes(b[r.CLASS]), first), at(reals(b[r.SPACE]), part * ROW)
    uniform = True
    for i in range(1, count):
        if own[i] != own[0]:
            uniform = False
    filled = own[0] if uniform else -1 - first
    if b[r.FILLED_WITH] == filled and b[r.FILLED] >= count:
        return
    b[r.FILLED_WITH], b[r.FILLED] = filled, count
    if uniform:
        table = at(reals(b[r.TABLES]), own[0] * rows)
        for row in range(rows):
            to, value = at(t, row * ROW), table[row]
            for i in range(count):
                to[i] = value
        return
    for i in range(count):
        table = at(reals(b[r.TABLES]), own[i] * rows)
        for row in range(rows):
            t[row * ROW + i] = table[row]


@routine("iinrr")
def fill_body(count, own, beams, body, rows):
    """Copy acceleration of gravity and load per length (beams, 4) of each element's beam to rows (4, ROW)."""
    for i in range(count):
        beam = 4 * beams[i]
        for part in range(4):
            rows[part * ROW + i] = body[beam + part]
