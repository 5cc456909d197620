"""Gather of nodal data and tables into the workspace of a batch, and scatter of its forces to the nodes."""

from beamfem.kernels.batch import rows_of
from beamfem.kernels.compiling import inlined, routine
from beamfem.kernels.model_record import LANES, ROW, Group, System
from beamfem.kernels.nodes import put
from beamfem.kernels.pointers import at, given, small_code
from beamfem.kernels.simd import WIDTH, as_rows, merged, zeros


@inlined
def _run(own, count):
    """Return how many nodes of a batch, from the first one on, have consecutive lanes of a chunk.

    The remaining ones must have consecutive lanes too, in the next chunk; otherwise 0 is returned. own (count,):
    offsets of the nodes in the chunks.
    """
    if own[count - 1] - own[0] == count - 1:
        return count
    run = 1
    while run < count and own[run] - own[0] == run:
        run += 1
    if run < count and own[count - 1] - own[run] != count - 1 - run:
        run = 0
    return run


@inlined
def gather(nodes, count, first, stride, ordered, place, rows, chunks, e):
    """Copy the first `rows` rows of the nodes of a batch to e (nodes, rows, ROW).

    place (nodes, stride): offsets of nodes in the chunks, see `record.PLACE`; ordered: whether they increase from
    element to element, as along a chain.
    """
    for n in range(nodes):
        offsets, whole = at(place, n * stride + first), at(e, n * rows * ROW)
        run = _run(offsets, count) if ordered != 0 else 0
        if run > 0:
            put(rows, run, True, at(chunks, offsets[0]), whole)
            if run < count:
                put(rows, count - run, True, at(chunks, offsets[run]), at(whole, run))
        else:
            for row in range(rows):
                to, source = at(whole, row * ROW), at(chunks, row * ROW)
                for i in range(count):
                    to[i] = source[offsets[i]]


@inlined
def _bring_last(group, offsets, count, rows):
    """Copy the last node of a batch behind the lanes of the chunk of the others; return whether these are in a row."""
    chunk, last, before = group.node_rows * ROW, offsets[count - 1], offsets[count - 2]
    behind = count > 1 and before - offsets[0] == count - 2 and last % chunk == 0 and before % chunk == LANES - 1
    if behind:
        chunks = group.chunks
        for row in range(rows):
            chunks[before + 1 + row * ROW] = chunks[last + row * ROW]
    return behind


@inlined
def _fill_tables(group, first, count, part):
    """Copy the table of each element's class to the rows of a batch from `part` on, unless they contain it already.

    Elements of one class share a table, so the next batch of this class, or the next evaluation, need not copy it.
    """
    rows, classes, t = group.table_rows, at(group.classes, first), at(group.space, part * ROW)
    uniform = True
    for i in range(1, count):
        if classes[i] != classes[0]:
            uniform = False
    filled = classes[0] if uniform else -1 - first
    if group.filled_class == filled and group.filled_count >= count:
        return
    group.filled_class, group.filled_count = filled, count
    if uniform:
        table = at(group.tables, classes[0] * rows)
        lanes = as_rows(t)
        for row in range(rows):
            for i in range(0, count, WIDTH):
                lanes[row * ROW + i] = table[row]
        return
    for i in range(count):
        table = at(group.tables, classes[i] * rows)
        for row in range(rows):
            t[row * ROW + i] = table[row]


@inlined
def _fill_body(count, beams, body, rows):
    """Copy acceleration of gravity and load per length (beams, 4) of the beam of each element to rows (4, ROW)."""
    if beams[count - 1] == beams[0]:  # elements of a beam have consecutive numbers
        lanes, values = as_rows(rows), at(body, 4 * beams[0])
        for part in range(4):
            for i in range(part * ROW, part * ROW + count, WIDTH):
                lanes[i] = values[part]
        return
    for i in range(count):
        beam = 4 * beams[i]
        for part in range(4):
            rows[part * ROW + i] = body[beam + part]


@routine()
def collect(group: Group, system: System, first: int, count: int, rows: int, copied: int) -> int:
    """Fill the workspace of a batch: tables, body forces and the first `rows` rows of its nodes.

    system: None if body forces are not needed. Unless copies are needed (`copied`), nodes with consecutive lanes of one
    chunk are read there, the last one behind the lanes of the others: then the offset from one node of an element to
    the next is returned, otherwise 0.
    """
    small_code()
    nodes, elements, place, x = group.nodes_per_element, group.elements, group.place, group.space
    body, e, _, _, table, _, _, _, _, _, _ = rows_of(
        nodes, group.vectors, group.points, group.curvature, group.table_rows
    )
    _fill_tables(group, first, count, table)
    if given(system) and system.loaded != 0:
        _fill_body(count, at(group.beam, first), system.body, at(x, body * ROW))
    if copied == 0 and group.ordered != 0:
        apart, begin = place[elements + first] - place[first], place[first]
        for n in range(nodes):
            offsets = at(place, n * elements + first)
            if offsets[0] - begin != n * apart:
                apart = 0
            elif offsets[count - 1] - offsets[0] != count - 1:
                apart = apart if _bring_last(group, offsets, count, rows) else 0
        if apart != 0:
            return apart
    gather(nodes, count, first, elements, group.ordered, place, rows, group.chunks, at(x, e * ROW))
    return 0


@inlined
def _add_run(rows, count, source, to):
    lanes, added = as_rows(source), as_rows(to)
    for row in range(rows):
        for i in range(0, count, WIDTH):
            added[row * ROW + i] += merged(lanes[row * ROW + i], zeros(), count - i)


@routine("iiiiiniirr")
def scatter(nodes, count, first, stride, ordered, place, size, row, f, chunks):
    """Add the forces f (nodes, size, ROW) of a batch to the rows of its nodes in the chunks, from `row` on."""
    small_code()
    for n in range(nodes):
        offsets, forces, sums = at(place, n * stride + first), at(f, n * size * ROW), at(chunks, row * ROW)
        run = _run(offsets, count) if ordered != 0 else 0
        if run > 0:
            _add_run(size, run, forces, at(sums, offsets[0]))
            if run < count:
                _add_run(size, count - run, at(forces, run), at(sums, offsets[run]))
        else:
            for part in range(size):
                source, to = at(forces, part * ROW), at(sums, part * ROW)
                for i in range(count):
                    to[offsets[i]] += source[i]
