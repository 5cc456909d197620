"""Small models of all combinations, drawn by hypothesis: supported, under loads that bend them visibly, no more."""

from dataclasses import replace

import numpy as np
from hypothesis import strategies as st
from recipes import Axis, Bar, Load, Recipe, Support, View

MODULUS = 1e9
# those whose halves share everything across a rigid joint; other cubics have a stretch of their own at each side
SHARING = ("bilinear ANCF", "bilinear CRBF", "CRBF(1)", "CRBF(2)", "CRBF(3)", "CRBF(4)", "shear-rigid 3")
NAMED = (*SHARING, "ANCF", "ANCF line", "ANCF structural", "ANCF-CRBF", "ANCF-CRBF structural", "shear-rigid")
CONSERVATIVE = ("force", "moment", "line", "gravity", "muscle")

signs = st.sampled_from((-1.0, 1.0))


def between(low: float, high: float) -> st.SearchStrategy[float]:
    """Numbers of nine decimals: what is below 1e-154 is refused, and not zero."""
    return st.floats(low, high).map(lambda value: round(value, 9))


angles = between(-np.pi, np.pi)


def _pair(values) -> tuple[float, float]:
    return float(values[0]), float(values[1])


def _away(angle: float, size: float = 1.0) -> tuple[float, float]:
    return size * float(np.cos(angle)), size * float(np.sin(angle))


@st.composite
def axes(draw, start: tuple[float, float], kinds: tuple[str, ...]) -> Axis:
    """An axis that leaves a point in any direction and is about a metre long."""
    angle, length, kind = draw(angles), draw(between(0.5, 1.2)), draw(st.sampled_from(kinds))
    along = np.array(_away(angle, length))
    left = np.array([-along[1], along[0]])
    end = np.add(start, along)
    if kind == "line":
        return Axis("line", (start, _pair(end)))
    if kind == "wave":
        return Axis("wave", (start, _pair(end), (draw(between(-0.15, 0.15)), float(draw(st.integers(1, 2))))))
    if kind == "arc":
        turn, first = draw(signs) * draw(between(0.3, 2.5)), angle
        center = np.subtract(start, _away(first, length / abs(turn)))
        return Axis("arc", (_pair(center), (length / abs(turn), 0.0), (first, first + turn)))
    inner = [np.add(start, share * along + draw(between(-0.2, 0.2)) * left) for share in (0.4, 0.7)]
    corners = (start, *map(_pair, inner[: 1 if kind == "polyline" else 2]), _pair(end))
    return Axis(kind, corners)


@st.composite
def recipes(
    draw,
    *,
    kinds: tuple[str, ...] = NAMED,
    axis_kinds: tuple[str, ...] = ("line", "line", "arc", "wave", "polyline", "spline"),
    load_kinds: tuple[str, ...] = (*CONSERVATIVE, "pressure"),
    followers: bool = True,
    led: bool = True,
    most: int = 3,
    largest: float = 1.0,
    alike: bool | None = None,
) -> Recipe:
    """One to three bars one behind the other, rigidly joined or by hinges; clamped, so that nothing moves freely."""
    count = draw(st.integers(1, most))
    alike, kind = draw(st.booleans()) if alike is None else alike, draw(st.sampled_from(kinds))
    other = kind if alike else draw(st.sampled_from(kinds))  # each number of kinds in a model is compiled anew
    height = draw(between(0.01, 0.08))
    bars, start = [], (0.0, 0.0)
    for _ in range(count):
        axis = draw(axes(start, axis_kinds))
        own = other if bars and draw(st.booleans()) else kind
        bars.append(Bar(axis, 2 * draw(st.integers(1, 2)), own, 0.02, height))
        start = _pair(axis.ends[1])
    unit = MODULUS * 0.02 * height**3 / 12.0
    joints = []
    supports = [Support("clamp", (0, 0.0))]
    for number in range(count - 1):
        hinged = draw(st.booleans())
        joints.append(("hinge" if hinged else "rigid", (number, 1.0), (number + 1, 0.0)))
        if hinged:  # what is behind a hinge is held at its own end, and every second bar so that none is a mechanism
            supports.append(Support("clamp" if draw(st.booleans()) else "pin", (number + 1, 1.0)))
    last = (count - 1, 1.0)
    if all(support.place != last for support in supports):
        supports += draw(_ends(last, unit, led))
    if draw(st.integers(0, 4)) == 0:
        supports.append(
            Support("foundation", (draw(st.integers(0, count - 1)), 0.0), (draw(between(0.1, 20.0)) * unit, 0.0))
        )
    of_loads = _load(count, largest * unit, unit, load_kinds, followers)
    loads = tuple(draw(of_loads) for _ in range(draw(st.integers(1, 3))))
    if not any(load.scale for load in loads):
        loads = (replace(loads[0], scale=True), *loads[1:])
    return Recipe("drawn", tuple(bars), tuple(supports), loads, tuple(joints), MODULUS, 1000.0)


@st.composite
def _ends(draw, place: tuple[int, float], unit: float, led: bool) -> list[Support]:
    """What may hold the end of a beam whose start is clamped."""
    kind = draw(st.sampled_from(("free", "free", "roller", "spring", "pin", *(("lead", "turn") if led else ()))))
    if kind == "free":
        return []
    if kind == "roller":
        return [Support("roller", place, _away(draw(angles)))]
    if kind == "spring":
        return [Support("spring", place, (draw(between(0.1, 30.0)) * unit, draw(between(0.1, 3.0)) * unit))]
    if kind == "lead":
        return [Support("lead", place, _away(draw(angles), draw(between(0.01, 0.1))), draw(between(-0.3, 0.3)))]
    if kind == "turn":
        return [Support("turn", place, turn=draw(between(-0.5, 0.5)))]
    return [Support("pin", place)]


@st.composite
def _load(draw, count: int, unit: float, bending: float, kinds: tuple[str, ...], followers: bool) -> Load:
    """A load of up to a unit, on bars of a bending stiffness: inside an element or at an end, dead or following."""
    kind, bar, angle = draw(st.sampled_from(kinds)), draw(st.integers(0, count - 1)), draw(angles)
    size = draw(between(0.01, 1.0)) * unit
    place = bar, draw(st.sampled_from((0.5, 1.0, 0.35, 0.8)))
    scale = draw(st.integers(0, 3)) > 0
    if kind in ("moment", "pressure"):
        return Load(kind, place, (draw(signs) * size, 0.0), scale=scale)
    if kind == "muscle":  # what a moment of this size would bend it by
        curvature = draw(signs) * size / bending
        return Load(kind, place, (curvature, 0.01 * curvature * draw(signs)), scale=scale)
    if kind == "gravity":
        return Load(kind, place, _away(angle, size), scale=scale)
    return Load(kind, place, _away(angle, size), follower=followers and draw(st.booleans()), scale=scale)


@st.composite
def views(draw) -> View:
    """The same model turned, mirrored, shifted, listed in another order and drawn from end to start."""
    shift = draw(between(-3.0, 3.0)), draw(between(-3.0, 3.0))
    mirrored, reordered, backwards = (draw(st.booleans()) for _ in range(3))
    return View(draw(angles), mirrored, shift, reordered=reordered, backwards=backwards)
