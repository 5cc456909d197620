"""Random planar models of everyday shapes, each the same for the same seed, and told in one line."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
from recipes import KINDS, Axis, Bar, Load, Place, Recipe, Support

ELEMENTS = {"CRBF(1)": 16, "CRBF(2)": 8, "CRBF(2) plane stress": 8, "CRBF(3)": 6, "CRBF(3) split": 6, "CRBF(4)": 4}
MODULI = (2e11, 7e10, 2e9, 5e6)
DENSITY = 2000.0
LARGEST_LOAD = 40.0  # E I / L^2
SNAPPING = 160.0  # the same for half the span
Random = np.random.Generator


def random_recipe(seed: int, family: str | None = None) -> Recipe:
    """Return the model of a seed; the family is drawn where it is not given."""
    rng = np.random.default_rng(seed)
    names = sorted(FAMILIES)
    drawn = names[rng.integers(len(names))]
    name = family or drawn
    return replace(FAMILIES[name](rng), name=f"seed {seed}: {name}", density=DENSITY)


def cantilever(rng: Random) -> Recipe:
    bar = _bar(rng, _axis(rng, (0.0, 0.0), (1.0, 0.0)))
    modulus = _modulus(rng)
    loads = _loads(rng, [bar], modulus, [(0, 1.0)])
    return Recipe("", (bar,), (Support("clamp", (0, 0.0)),), loads, modulus=modulus)


def hook(rng: Random) -> Recipe:
    """An arc of a half to a full turn, clamped, with a load at its end."""
    start = rng.uniform(0.0, 2.0 * np.pi)
    turn = rng.choice([-1.0, 1.0]) * rng.uniform(0.8 * np.pi, 1.8 * np.pi)
    bar = _bar(rng, Axis("arc", ((0.0, 0.0), (1.0 / abs(turn), 0.0), (start, start + turn))), 1.5)
    modulus = _modulus(rng)
    loads = _loads(rng, [bar], modulus, [(0, 1.0)], 10.0)
    return Recipe("", (bar,), (Support("clamp", (0, 0.0)),), loads, modulus=modulus)


def led(rng: Random) -> Recipe:
    """A beam, straight or curved, whose far end is led aside, squeezed or turned, with a small standing load."""
    bar = _bar(rng, _axis(rng, (0.0, 0.0), (1.0, 0.0)), 1.5)
    modulus = _modulus(rng)
    aside = rng.uniform(0.05, 0.6) * _direction(rng, 0.6 * np.pi, 1.4 * np.pi)
    turn = rng.choice([0.0, 0.0, rng.uniform(-np.pi, np.pi)])
    start = Support(_one(rng, "clamp", "pin"), (0, 0.0))
    how = rng.integers(3)
    end = (
        Support("lead", (0, 1.0), _pair(aside), float(turn)),
        Support("lead", (0, 1.0), _pair(aside)),
        Support("lead", (0, 1.0), (0.0, 0.0), float(rng.uniform(-np.pi, np.pi))),
    )[how]
    small = 10.0 ** rng.uniform(-3.0, 0.0) * _stiffness(bar, modulus)
    load = Load("force", (0, float(rng.choice([0.25, 0.5, 0.6]))), _pair(small * _direction(rng)), scale=False)
    return Recipe("", (bar,), (start, end), (load,) if rng.random() < 0.7 else (), modulus=modulus)


def turned(rng: Random) -> Recipe:
    """A beam whose far end is turned while it may move, with a load."""
    bar = _bar(rng, _axis(rng, (0.0, 0.0), (1.0, 0.0)), 1.5)
    modulus = _modulus(rng)
    end = Support("turn", (0, 1.0), turn=float(rng.uniform(-2.0 * np.pi, 2.0 * np.pi)))
    loads = _loads(rng, [bar], modulus, [(0, 1.0)], 5.0) if rng.random() < 0.5 else ()
    return Recipe("", (bar,), (Support("clamp", (0, 0.0)), end), loads, modulus=modulus)


def pushed(rng: Random) -> Recipe:
    """A beam on a pin and a roller, pushed or pulled along, with a lateral load that breaks the symmetry."""
    bar = _bar(rng, _axis(rng, (0.0, 0.0), (1.0, 0.0)))
    modulus = _modulus(rng)
    unit = _stiffness(bar, modulus)
    push = Load("force", (0, 1.0), (float(rng.uniform(-LARGEST_LOAD, 10.0) * unit), 0.0))
    lateral = float(10.0 ** rng.uniform(-2.0, 0.7) * rng.choice([-1.0, 1.0]) * unit)
    aside = Load("force", (0, float(rng.choice([0.25, 0.5, 0.4]))), (0.0, lateral), scale=bool(rng.random() < 0.5))
    supports = (Support(rng.choice(["pin", "clamp"]), (0, 0.0)), Support("roller", (0, 1.0), (0.0, 1.0)))
    return Recipe("", (bar,), supports, (push, aside), modulus=modulus)


def arch(rng: Random) -> Recipe:
    """An arch between two supports, pressed by a force, by a pressure, or led down at a point."""
    rise = rng.uniform(0.03, 0.4)
    if rng.random() < 0.5:
        axis = Axis("wave", ((0.0, 0.0), (1.0, 0.0), (rise, 1.0)))
    else:
        radius = (0.25 + rise**2) / (2.0 * rise)
        half = np.arctan2(0.5, radius - rise)
        angles = (0.5 * np.pi + half, 0.5 * np.pi - half)
        axis = Axis("arc", ((0.5, rise - radius), (radius, 0.0), _pair(angles)))
    bar = _bar(rng, axis, 2.0)
    modulus = _modulus(rng)
    supports = [Support(_one(rng, "clamp", "pin"), (0, share)) for share in (0.0, 1.0)]
    loads = _loads(rng, [bar], modulus, [(0, float(rng.choice([0.25, 0.45, 0.5, 0.7])))], SNAPPING, down=True)
    if rng.random() < 0.3:
        supports.append(Support("lead", (0, 0.4), (0.0, -float(rng.uniform(0.5, 2.0) * rise))))
        loads = ()
    return Recipe("", (bar,), tuple(supports), loads, modulus=modulus)


def portal(rng: Random) -> Recipe:
    height, width = rng.uniform(0.4, 1.2), 1.0
    corners = [(0.0, 0.0), (0.0, height), (width, height * rng.uniform(0.7, 1.3)), (width, 0.0)]
    bases, joints = ([_one(rng, *kinds) for _ in range(2)] for kinds in (("clamp", "clamp", "pin"), ("rigid", "hinge")))
    if bases == ["pin", "pin"] and joints == ["hinge", "hinge"]:  # a mechanism
        joints[0] = "rigid"
    bars, modulus = _frame(rng, corners)
    loads = _loads(rng, bars, modulus, [(1, float(rng.uniform(0.0, 1.0)))], down=True)
    supports = Support(bases[0], (0, 0.0)), Support(bases[1], (2, 1.0))
    return Recipe("", bars, supports, loads, _chained(joints), modulus)


def toggle(rng: Random) -> Recipe:
    crown = (rng.uniform(0.3, 0.7), rng.uniform(0.05, 0.4))
    bars, modulus = _frame(rng, [(0.0, 0.0), crown, (1.0, 0.0)])
    supports = tuple(Support(_one(rng, "clamp", "pin"), place) for place in ((0, 0.0), (1, 1.0)))
    loads = _loads(rng, bars, modulus, [(0, 1.0)], SNAPPING, down=True)
    return Recipe("", bars, supports, loads, _chained([_one(rng, "rigid", "hinge")]), modulus)


def chain(rng: Random) -> Recipe:
    """Two to four bars one behind the other at angles, clamped at the start and held, led or free at the end."""
    count = int(rng.integers(2, 5))
    angles = np.cumsum(np.append(rng.uniform(-0.5, 0.5), rng.uniform(-1.5, 1.5, count - 1)))
    lengths = rng.uniform(0.3, 0.7, count)
    steps = lengths[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    corners = [(0.0, 0.0), *np.cumsum(steps, axis=0).tolist()]
    bars, modulus = _frame(rng, corners)
    end = (count - 1, 1.0)
    supports, kinds = [Support("clamp", (0, 0.0))], ["rigid"] * (count - 1)
    held = _one(rng, "free", "clamp", "pin", "roller", "spring", "lead")
    if held in ("clamp", "pin") and rng.random() < 0.6:
        kinds[rng.integers(count - 1)] = "hinge"
    if held == "roller":
        supports.append(Support("roller", end, _pair(_direction(rng))))
    elif held == "spring":
        unit = _stiffness(bars[-1], modulus)
        supports.append(Support("spring", end, _pair(10.0 ** rng.uniform(-1.0, 1.5, 2) * unit)))
    elif held == "lead":
        away = rng.uniform(0.05, 0.5) * _direction(rng)
        supports.append(Support("lead", end, _pair(away), float(rng.uniform(-1.5, 1.5))))
    elif held != "free":
        supports.append(Support(held, end))
    loads = _loads(rng, bars, modulus, [(count // 2, float(rng.choice([0.0, 0.5, 1.0])))], 10.0)
    return Recipe("", bars, tuple(supports), loads, _chained(kinds), modulus)


FAMILIES: dict[str, Callable[[Random], Recipe]] = {
    make.__name__: make for make in (cantilever, hook, led, turned, pushed, arch, portal, toggle, chain)
}


def _axis(rng: Random, start, end) -> Axis:
    """A line, an arc over it or a wave."""
    kind = _one(rng, "line", "line", "arc", "wave")
    if kind == "line":
        return Axis("line", (start, end))
    if kind == "wave":
        return Axis("wave", (start, end, (float(rng.uniform(-0.3, 0.3)), float(rng.integers(1, 4)))))
    half = rng.choice([-1.0, 1.0]) * rng.uniform(0.2, 1.2)
    along = np.subtract(end, start)
    middle = 0.5 * np.add(start, end)
    radius = 0.5 * np.hypot(*along) / np.sin(abs(half))
    left = np.array([-along[1], along[0]]) / np.hypot(*along)
    center = middle - np.sign(half) * radius * np.cos(half) * left
    up = np.arctan2(left[1], left[0]) + (0.0 if half > 0.0 else np.pi)
    return Axis("arc", (_pair(center), (float(radius), 0.0), _pair((up + half, up - half))))


def _bar(rng: Random, axis: Axis, finer: float = 1.0, kind: str | None = None, height: float | None = None) -> Bar:
    kind = kind or _one(rng, *sorted(KINDS))
    height = height or 10.0 ** -rng.uniform(1.0, 2.7)
    count = 2 * round(0.5 * finer * ELEMENTS.get(kind, 12))
    return Bar(axis, count, kind, float(height * rng.uniform(1.0, 10.0)), float(height))


def _frame(rng: Random, corners) -> tuple[tuple[Bar, ...], float]:
    """Bars from corner to corner, in half of the frames all of one kind and height."""
    kind, height = _one(rng, *sorted(KINDS)), 10.0 ** -rng.uniform(1.2, 2.5)
    alike = rng.random() < 0.5
    bars = []
    for start, end in pairwise(corners):
        axis = Axis("line", (_pair(start), _pair(end)))
        if rng.random() < 0.15:
            axis = _axis(rng, _pair(start), _pair(end))
        other = _one(rng, *sorted(KINDS)) if rng.random() < 0.3 else kind
        own = (kind, height) if alike else (other, height * rng.uniform(0.5, 2.0))
        bars.append(_bar(rng, axis, 1.0, *own))
    return tuple(bars), _modulus(rng)


def _chained(kinds) -> tuple[tuple[str, Place, Place], ...]:
    return tuple((kind, (number, 1.0), (number + 1, 0.0)) for number, kind in enumerate(kinds))


def _loads(rng: Random, bars, modulus, places, largest=LARGEST_LOAD, down=False) -> tuple[Load, ...]:
    """One to three loads; the first one is large or small and acts at one of the places."""
    found = []
    for number in range(int(rng.choice([1, 1, 2, 3]))):
        where, fraction = places[rng.integers(len(places))]
        unit = _stiffness(bars[where], modulus)
        size = 10.0 ** rng.uniform(-0.5, np.log10(largest)) * unit * (1.0 if number == 0 else 0.3)
        away = _direction(rng, 1.3 * np.pi, 1.7 * np.pi) if down else _direction(rng)
        follower = bool(rng.random() < 0.35)
        kind = _one(rng, "force", "force", "moment", "line", *["gravity"] * (number > 0))
        standing = number > 0 and rng.random() < 0.3
        if kind == "gravity":
            weight = (0.05 if standing else 0.3) * size / (DENSITY * bars[where].width * bars[where].height)
            found.append(Load("gravity", (0, 0.0), _pair(weight * away), scale=not standing))
        elif kind == "moment":
            value = (float(0.3 * size * rng.choice([-1.0, 1.0])), 0.0)
            found.append(Load("moment", (where, fraction), value, scale=not standing))
        else:
            reduced = 0.05 * size if standing else size
            at = (where, 0.0 if kind == "line" else fraction)
            found.append(Load(kind, at, _pair(reduced * away), follower, not standing))
    if not any(load.scale for load in found):
        found[0] = replace(found[0], scale=True)
    return tuple(found)


def _stiffness(bar: Bar, modulus: float) -> float:
    """E I / (1 m)^2 [N]."""
    return modulus * bar.width * bar.height**3 / 12.0


def _modulus(rng: Random) -> float:
    return float(rng.choice(MODULI))


def _direction(rng: Random, low: float = 0.0, high: float = 2.0 * np.pi) -> np.ndarray:
    angle = rng.uniform(low, high)
    return np.array([np.cos(angle), np.sin(angle)])


def _one(rng: Random, *choices: str) -> str:
    return choices[rng.integers(len(choices))]


def _pair(values) -> tuple[float, float]:
    return float(values[0]), float(values[1])
