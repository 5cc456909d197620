"""Beam axes from drawings: the curves of a DXF file.

Source: Autodesk, DXF Reference (entities, object coordinate systems, bulges), read through ezdxf.
"""

from collections.abc import Callable, Iterator
from itertools import islice
from os import PathLike
from typing import Any

import numpy as np

from beamfem.atomic_write import readable
from beamfem.curves import Arc, BSpline, Chain, Curve, Line, Polyline, elliptic_arc
from beamfem.errors import InputError
from beamfem.extras import needed_for
from beamfem.validation import nearest, optional, text

# distance from the plane z = 0, tilt and length of a piece that count as zero, as a fraction of the coordinates
_FLAT = 1e-9
# below this bulge the center of an arc is so far away that a rational parabola is the more accurate circle
_SMALL_BULGE = 1e-4
# flag of a vertex (group code 70) that a smoothed polyline only remembers
_FRAME = 16
_MOST = 1_000_000  # entities: blocks of blocks may hold far more than a computer can
# what is written beside the curves of a drawing
_ANNOTATION = ("TEXT", "MTEXT", "ATTDEF", "DIMENSION", "ARC_DIMENSION", "LEADER", "MULTILEADER", "TOLERANCE", "HATCH")


def read_dxf(path: str | PathLike[str], layer: str | None = None) -> tuple[Curve, ...]:
    """Return the curves in the modelspace of a DXF file, in the units and order of the drawing.

    LINE, ARC, CIRCLE, LWPOLYLINE and POLYLINE (bulges as arcs of a Chain), SPLINE and ELLIPSE (rational splines) are
    exact, except a SPLINE with fit points only, which the file does not define: it is drawn as ezdxf draws it. Texts,
    dimensions, leaders, tolerances and hatches are skipped as annotation. Blocks are read where they are inserted.

    Coordinates are taken as they are drawn; the unit in the header ($INSUNITS) converts nothing. The model has to be in
    the units of the drawing, such as `Model(..., units="N, mm")` for one in millimetres.

    Parameters
    ----------
    path : path
        The DXF file.
    layer : str, optional
        Name of the layer to read; by default all layers are read.

    Raises
    ------
    FileError
        If the system refuses to read the file; FileNotFoundError if there is none.
    InputError
        For a file that is not DXF, an entity of another kind or off the plane z = 0, or a file without curves.
    MissingPackageError
        Without ezdxf.

    Examples
    --------
    >>> curves = bf.read_dxf("frame.dxf", layer="axes")  # doctest: +SKIP
    >>> beams = [bf.Beam(curve, 8, bf.CRBF(order=3), bf.Circle(0.02), steel) for curve in curves]  # doctest: +SKIP
    """
    with needed_for("reading drawings"):
        import ezdxf
    source = readable(path)
    optional(text)("layer", layer)
    try:
        entities = list(islice(_exploded(ezdxf.readfile(source).modelspace()), _MOST + 1))
    except Exception as error:  # ezdxf raises anything for a damaged file
        raise InputError(f"{source} is not a DXF file that can be read: {error}") from error
    if len(entities) > _MOST:
        raise InputError(f"{source}: it draws more than {_MOST} entities, blocks included")
    drawn = [entity for entity in entities if entity.dxftype() not in _ANNOTATION]
    chosen = [entity for entity in drawn if layer is None or entity.dxf.layer.lower() == layer.lower()]
    if not chosen:
        layers = sorted({entity.dxf.layer for entity in drawn})
        if layer is None:
            raise InputError(f"{source}: nothing is drawn in its modelspace{', only annotation' if entities else ''}")
        raise InputError(f"{source}: nothing is drawn in layer {layer!r}; {nearest(layer, layers)}")
    return tuple(_curve(entity) for entity in chosen)


def _exploded(entities: Any) -> Iterator[Any]:
    """Yield entities, in place of blocks those that they hold, where they are inserted."""
    for entity in entities:
        if entity.dxftype() != "INSERT":
            yield entity
            continue
        for single in entity.multi_insert() if entity.mcount > 1 else (entity,):
            for part in _exploded(single.virtual_entities()):
                if part.dxf.layer == "0":  # the layer of the block
                    part.dxf.layer = entity.dxf.layer
                yield part


def _curve(entity: Any) -> Curve:
    kind = entity.dxftype()
    name = f"{kind} on layer {entity.dxf.layer!r}, handle {entity.dxf.handle}"
    if kind not in _READERS:
        raise InputError(f"{name}, is no curve that can be read; those that can are {', '.join(_READERS)}")
    try:
        return _READERS[kind](entity)
    except (InputError, ValueError) as error:
        raise InputError(f"{name}: {error}") from error


def _flat(vector: Any) -> tuple[float, float]:
    """Return x and y of a point or direction in world coordinates."""
    x, y, z = map(float, vector)
    if abs(z) > _FLAT * max(abs(x), abs(y), 1.0):
        raise InputError(f"it must lie in the plane z = 0, but it reaches z = {z:g}")
    return x, y


def _side(entity: Any) -> float:
    """Return 1 if the entity is drawn in world coordinates, -1 if it is mirrored: seen from below, x = -x."""
    axis = entity.dxf.extrusion.normalize()
    if np.hypot(axis.x, axis.y) > _FLAT:
        raise InputError(f"it must lie in the plane z = 0, but its normal is ({axis.x:g}, {axis.y:g}, {axis.z:g})")
    return 1.0 if axis.z > 0 else -1.0


def _arc(entity: Any) -> Curve:
    side = _side(entity)
    x, y = _flat(entity.dxf.center)
    start, turn = 0.0, 360.0
    if entity.dxftype() == "ARC":
        start = entity.dxf.start_angle
        turn = _turn(start, entity.dxf.end_angle, 360.0)
    angles = np.radians([start, start + turn])
    begin, end = angles if side > 0 else np.pi - angles
    return Arc((side * x, y), entity.dxf.radius, begin, end)


def _turn(start: float, end: float, full: float) -> float:
    """Return the counter-clockwise angle from start to end; a full turn if both are the same direction."""
    turn = (end - start) % full
    return full if turn < _FLAT * full else turn


def _polyline(entity: Any) -> Curve:
    if entity.dxftype() == "LWPOLYLINE":
        _flat((0.0, 0.0, entity.dxf.elevation))
        return _pieces(entity.get_points("xyb"), entity.closed, _side(entity))
    if not (entity.is_2d_polyline or entity.is_3d_polyline):
        raise InputError(f"it is a {entity.get_mode()}, not a curve")
    side = _side(entity) if entity.is_2d_polyline else 1.0
    _flat(entity.dxf.elevation)
    # the control frame of a smoothed polyline is kept among its vertices
    vertices = [vertex for vertex in entity.vertices if not vertex.dxf.flags & _FRAME]
    table = [(*_flat(vertex.dxf.location), vertex.dxf.get("bulge", 0.0)) for vertex in vertices]
    return _pieces(table, entity.is_closed, side)


def _pieces(table: list[tuple[float, float, float]], closed: bool, side: float) -> Curve:
    """Return the curve through points (x, y, bulge of the piece that begins there)."""
    points = [np.array([side * x, y]) for x, y, _ in table]
    bulges = [side * bulge for *_, bulge in table]
    if closed:
        points.append(points[0])
    size = max(float(np.max(np.abs(points))), np.finfo(float).tiny)
    kept, between = [points[0]], []
    for point, bulge in zip(points[1:], bulges, strict=False):
        if np.hypot(*(point - kept[-1])) > _FLAT * size:  # drawings hold points twice
            kept.append(point)
            between.append(bulge)
    if not any(between):
        return Polyline(tuple((float(x), float(y)) for x, y in kept))
    curves = tuple(_piece(*part) for part in zip(kept, kept[1:], between, strict=False))
    return curves[0] if len(curves) == 1 else Chain(curves)


def _piece(start: np.ndarray, end: np.ndarray, bulge: float) -> Curve:
    """Return a piece of a polyline; bulge: tangent of a quarter of the included angle, > 0 to the left."""
    first, last = (tuple(point.tolist()) for point in (start, end))
    if bulge == 0.0:
        return Line(first, last)
    turn = 4.0 * np.arctan(bulge)
    middle, left = (start + end) / 2, np.array([start[1] - end[1], end[0] - start[0]]) / 2
    if abs(bulge) < _SMALL_BULGE:
        top = tuple((middle - left * np.tan(turn / 2)).tolist())
        return BSpline(2, (0.0, 0.0, 0.0, 1.0, 1.0, 1.0), (first, top, last), (1.0, float(np.cos(turn / 2)), 1.0))
    center = middle + left * (1.0 - bulge**2) / (2.0 * bulge)
    spoke = start - center
    begin = float(np.arctan2(spoke[1], spoke[0]))
    return Arc(tuple(center.tolist()), float(np.hypot(*spoke)), begin, begin + float(turn))


def _spline(entity: Any) -> Curve:
    control = tuple(map(_flat, entity.control_points if len(entity.control_points) else entity.fit_points))
    if len(entity.control_points) and len(entity.knots):
        weights = tuple(entity.weights) if len(entity.weights) else None
        return BSpline(entity.dxf.degree, tuple(entity.knots), control, weights)
    drawn = entity.construction_tool()
    control = tuple(_flat(point) for point in drawn.control_points)
    return BSpline(drawn.degree, tuple(drawn.knots()), control, tuple(drawn.weights()) or None)


def _ellipse(entity: Any) -> Curve:
    side = _side(entity)
    x, y = _flat(entity.dxf.major_axis)
    start, end = entity.dxf.start_param, entity.dxf.end_param
    ratio = side * entity.dxf.ratio
    turn = _turn(start, end, 2 * np.pi)
    return elliptic_arc(_flat(entity.dxf.center), (x, y), (-ratio * y, ratio * x), start, start + turn)


_READERS: dict[str, Callable[[Any], Curve]] = {
    "LINE": lambda entity: Line(_flat(entity.dxf.start), _flat(entity.dxf.end)),
    "ARC": _arc,
    "CIRCLE": _arc,
    "LWPOLYLINE": _polyline,
    "POLYLINE": _polyline,
    "SPLINE": _spline,
    "ELLIPSE": _ellipse,
}
