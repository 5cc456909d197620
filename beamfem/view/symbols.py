"""Symbols of engineers as outlines, the point of the beam at the origin, the ground below; the unit is a symbol."""

import numpy as np


def _line(*points: tuple[float, float]) -> np.ndarray:
    return np.array(points, dtype=float)


def _hatched(level: float, half: float) -> list[np.ndarray]:
    """Ground at a level: a line and strokes below it."""
    strokes = [_line((x, level), (x - 0.16, level - 0.22)) for x in np.linspace(-half + 0.16, half, 6)]
    return [_line((-half, level), (half, level)), *strokes]


def circle(x: float, y: float, radius: float) -> np.ndarray:
    """Closed outline (25, 2)."""
    angle = np.linspace(0.0, 2.0 * np.pi, 25)
    return np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle)], axis=1)


_TRIANGLE = _line((0.0, 0.0), (-0.42, -0.75), (0.42, -0.75), (0.0, 0.0))


def _zigzag() -> np.ndarray:
    down = np.linspace(-0.2, -0.9, 8)
    side = np.array([0.0, *(0.18 * (-1.0) ** np.arange(6)), 0.0])
    return np.stack([np.array([0.0, *side, 0.0]), np.array([0.0, *down, -1.1])], axis=1)


def _spiral() -> np.ndarray:
    angle = np.linspace(0.0, 3.5 * np.pi, 60)
    radius = 0.08 + 0.5 * angle / angle[-1]
    return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)


# the clamp's beam goes up from its wall
CLAMP = _hatched(0.0, 0.62)
GROUND = _hatched(0.0, 0.42)
PIN = [_TRIANGLE, *_hatched(-0.75, 0.6)]
ROLLER = [_TRIANGLE, circle(-0.22, -0.87, 0.12), circle(0.22, -0.87, 0.12), *_hatched(-0.99, 0.6)]
SPRING = [_zigzag(), *_hatched(-1.1, 0.42)]
ROTATIONAL_SPRING = [_spiral()]
# a section that does not turn
NO_TURN = [_line((-0.26, -0.26), (0.26, -0.26), (0.26, 0.26), (-0.26, 0.26), (-0.26, -0.26))]
HINGE = circle(0.0, 0.0, 0.2)


def turn(angle: float, radius: float = 0.75, span: float = 1.5 * np.pi) -> tuple[np.ndarray, np.ndarray]:
    """Return the arc (n, 2) of a moment about the origin and its head (3, 2), counter-clockwise for span > 0."""
    end = angle + 0.5 * span
    arc = np.linspace(angle - 0.5 * span, end - np.sign(span) * 0.3, 40)
    tangent = np.sign(span) * np.array([-np.sin(end), np.cos(end)])
    out = np.array([np.cos(end), np.sin(end)])
    # tilted a little inwards, as the arc bends
    tip = radius * out + 0.02 * tangent
    base = radius * np.array([np.cos(end - np.sign(span) * 0.48), np.sin(end - np.sign(span) * 0.48)])
    across = 0.19 * np.array([np.cos(end - np.sign(span) * 0.25), np.sin(end - np.sign(span) * 0.25)])
    return radius * np.stack([np.cos(arc), np.sin(arc)], axis=1), np.stack([tip, base + across, base - across])


def turned(outline: np.ndarray, down: np.ndarray) -> np.ndarray:
    """Return an outline whose ground lies in the direction `down` (2,)."""
    size = np.hypot(*down)
    x, y = down / size
    return np.asarray(outline @ np.array([[-y, x], [-x, -y]]))


def coil(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Return a zigzag (n, 2) from one point (2,) [m] to another."""
    along = np.array([0.0, *np.linspace(0.2, 0.8, 18), 1.0])
    aside = np.array([0.0, 0.0, *(0.03 * (-1.0) ** np.arange(16)), 0.0, 0.0])
    x, y = np.asarray(end) - start
    return np.asarray(start + np.outer(along, (x, y)) + np.outer(aside, (-y, x)))
