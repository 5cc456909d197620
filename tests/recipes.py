"""Models as plain data, which can be built in many ways that mean the same: turned, mirrored, split, in other units."""

from dataclasses import dataclass, replace

import numpy as np

import beamfem as bf
from beamfem.results.axis_points import axis_at

KINDS = {
    "ANCF": bf.ANCF(),
    "ANCF line": bf.ANCF(bf.ElasticLine()),
    "ANCF structural": bf.ANCF(bf.Structural()),
    "ANCF-CRBF": bf.ANCFCRBF(),
    "ANCF-CRBF structural": bf.ANCFCRBF(bf.Structural()),
    "ANCF-CRBF line": bf.ANCFCRBF(bf.ElasticLine()),
    "bilinear ANCF": bf.BilinearANCF(),
    "bilinear ANCF split": bf.BilinearANCF(bf.SplitContinuum(), "reduced"),
    "bilinear CRBF": bf.BilinearCRBF(),
    "bilinear CRBF reduced": bf.BilinearCRBF(integration="reduced"),
    "CRBF(1)": bf.CRBF(1),
    "CRBF(2)": bf.CRBF(2),
    "CRBF(2) plane stress": bf.CRBF(2, bf.ContinuumMechanics(plane_stress=True)),
    "CRBF(3)": bf.CRBF(3),
    "CRBF(3) split": bf.CRBF(3, bf.SplitContinuum()),
    "CRBF(4)": bf.CRBF(4),
    "quadratic gradients": bf.Element(bf.Lagrange(2), bf.Gradients(), bf.Structural(), "reduced"),
    "shear-rigid": bf.ShearRigid(),
    "shear-rigid 3": bf.ShearRigid(stretchable=False),
}

# more of them, which `random_models` does not draw: those of high order, and with fewer elements the same limits
HIGH = {f"CRBF({order})": bf.CRBF(order) for order in (5, 6, 7, 8)}
FINE = {
    f"fine {name}": replace(element, field=bf.Lagrange(6), label=None)
    for name, element in (KINDS | HIGH).items()
    if isinstance(element.field, bf.Lagrange) and element.integration == "reduced"
}
ALL_KINDS = KINDS | HIGH | FINE

Pair = tuple[float, float]
Place = tuple[int, float]  # which bar, and the fraction of its length


@dataclass(frozen=True)
class View:
    """How a recipe is built: what it is turned by, drawn in, cut into and listed as.

    angle [rad] about the origin, after mirrored: y to -y; shift: added in the end; length and force: user's units in a
    metre and a newton; split: each bar in two halves joined rigidly; reordered: the last bar first; backwards: each bar
    from its end to its start; finer: so many times the elements.
    """

    angle: float = 0.0
    mirrored: bool = False
    shift: Pair = (0.0, 0.0)
    length: float = 1.0
    force: float = 1.0
    split: bool = False
    reordered: bool = False
    backwards: bool = False
    finer: int = 1

    @property
    def sense(self) -> float:
        """What angles and moments are multiplied by."""
        return -1.0 if self.mirrored else 1.0

    @property
    def matrix(self) -> np.ndarray:
        """What vectors (2,) are multiplied by."""
        c, s = np.cos(self.angle), np.sin(self.angle)
        return np.array([[c, -s], [s, c]]) @ np.diag([1.0, self.sense])

    def vector(self, values: Pair, unit: float = 1.0) -> Pair:
        return tuple((unit * self.matrix @ values).tolist())

    def point(self, values: Pair) -> Pair:
        return self.vector(np.add(values, 0.0) + self.matrix.T @ self.shift, self.length)

    def back(self, values: np.ndarray) -> np.ndarray:
        """Return positions (n, 2) as those of the plain view."""
        return (values / self.length - self.shift) @ self.matrix

    def back_turned(self, values: np.ndarray) -> np.ndarray:
        """Return vectors (n, 2) without length unit as those of the plain view."""
        return values @ self.matrix


@dataclass(frozen=True)
class Axis:
    """Axis of a bar: "line" start, end; "arc" center, (radius, 0), (angle, angle); "wave" start, end, (rise, waves).

    Also "polyline" and "spline", a cubic one, by three and four points, which have no halves. A wave is the line with a
    sine of so many half waves and a rise, as a share of its length, to the left.
    """

    kind: str
    data: tuple[Pair, ...]

    def curve(self, view: View, part: Pair = (0.0, 1.0)) -> bf.Curve:
        """Return the curve of a part of it; halves of a wave are those of its parameter."""
        if self.kind == "line":
            start, end = np.array(self.data)
            return bf.Line(*(view.point(start + share * (end - start)) for share in part))
        if self.kind == "arc":
            center, (radius, _), angles = self.data
            first, last = (angles[0] + share * (angles[1] - angles[0]) for share in part)
            first, last = (view.angle + view.sense * angle for angle in (first, last))
            return bf.Arc(view.point(center), view.length * radius, first, last)
        if self.kind in ("polyline", "spline"):
            points = tuple(view.point(value) for value in (self.data if part[0] < part[1] else self.data[::-1]))
            return bf.Polyline(points) if self.kind == "polyline" else bf.BSpline(3, (0.0,) * 4 + (1.0,) * 4, points)
        (start, end, (rise, waves)), matrix = np.array(self.data), view.matrix
        span = end - start
        left = rise * np.array([-span[1], span[0]])

        def at(u):
            r = start + np.multiply.outer(u, span) + np.multiply.outer(np.sin(waves * np.pi * u), left)
            x, y = np.moveaxis(view.length * ((r @ matrix.T) + view.shift), -1, 0)
            return x, y

        return bf.Parametric(at, *part)

    @property
    def ends(self) -> tuple[np.ndarray, np.ndarray]:
        plain = self.curve(View())
        return plain.position(np.array([0.0]))[0], plain.position(np.array([plain.length]))[0]


@dataclass(frozen=True)
class Bar:
    """A beam: its axis, its number of elements, its kind (a key of ALL_KINDS), width and height [m]."""

    axis: Axis
    elements: int
    kind: str
    width: float
    height: float


@dataclass(frozen=True)
class Support:
    """ "clamp", "pin"; "roller" (normal); "lead" (ux, uy) and, if given, turn [rad]; "turn" alone; "spring" (k, kr).

    "foundation" (k, 0) along the whole bar.
    """

    kind: str
    place: Place
    values: Pair = (0.0, 0.0)
    turn: float | None = None


@dataclass(frozen=True)
class Load:
    """ "force" (fx, fy), "moment" (m, 0) at a place, "line" (qx, qy), "pressure" (p, 0) on a bar; "gravity".

    "muscle" (curvature, stretch) of a bar.
    """

    kind: str
    place: Place
    values: Pair
    follower: bool = False
    scale: bool = True


@dataclass(frozen=True)
class Recipe:
    """A model as plain data; modulus [Pa], density [kg/m^3]; joints: ("rigid" or "hinge", place, place)."""

    name: str
    bars: tuple[Bar, ...]
    supports: tuple[Support, ...]
    loads: tuple[Load, ...]
    joints: tuple[tuple[str, Place, Place], ...] = ()
    modulus: float = 2e11
    density: float = 7800.0

    def __str__(self) -> str:
        bars = ", ".join(f"{bar.axis.kind} {bar.elements} x {bar.kind} h {bar.height:.3g}" for bar in self.bars)
        held = ", ".join(f"{support.kind} {_short(support.values, support.turn)}" for support in self.supports)
        joints = "".join(f", {kind}" for kind, _, _ in self.joints)
        loads = ", ".join(
            f"{'follower ' * load.follower}{'standing ' * (not load.scale)}{load.kind} {_short(load.values)}"
            for load in self.loads
        )
        return f"{self.name}: [{bars}{joints}] on [{held}] under [{loads}], E {self.modulus:.3g}"

    @property
    def reach(self) -> float:
        """Diagonal of the box around the ends of all bars, or the longest bar [m]."""
        ends = np.concatenate([bar.axis.ends for bar in self.bars])
        lengths = [bar.axis.curve(View()).length for bar in self.bars]
        return float(max(np.hypot(*np.ptp(ends, axis=0)), *lengths, 0.0))

    def build(self, view: View | None = None) -> "Built":
        return _build(self, view or View())


@dataclass(frozen=True, eq=False)
class Built:
    """A recipe as a model; places: from a place of the recipe to the point of the model."""

    recipe: Recipe
    view: View
    model: bf.Model
    parts: tuple[tuple[bf.Beam, ...], ...]

    def point(self, place: Place) -> bf.Point:
        return _point(self.parts, self.view, place)

    def positions(self, p: np.ndarray) -> np.ndarray:
        """Return the positions (n, 2) of the ends of all elements of the recipe in the plain view, of a state p."""
        found = []
        for number, bar in enumerate(self.recipe.bars):
            points = [self.point((number, k / bar.elements)) for k in range(bar.elements + 1)]
            for beam in dict.fromkeys(point.beam for point in points):
                mesh = self.model.mesh_of(beam.start)
                element, xi = mesh.locate(np.array([point.fraction for point in points if point.beam is beam]))
                found.append(axis_at(mesh, p[None], element, xi).r[0])
        return self.view.back(np.concatenate(found))


def _short(values: Pair, turn: float | None = None) -> str:
    parts = [f"{value:.3g}" for value in values] + ([f"turn {turn:.3g}"] if turn is not None else [])
    return f"({', '.join(parts)})" if any(values) or turn is not None else ""


def _build(recipe: Recipe, view: View) -> Built:
    parts = []
    material = bf.Material(
        recipe.modulus * view.force / view.length**2, 0.3, recipe.density * view.force / view.length**4
    )
    for bar in recipe.bars:
        count = view.finer * bar.elements
        section = bf.Rectangle(view.length * bar.width, view.length * bar.height)
        pieces = [(0.0, 0.5), (0.5, 1.0)] if view.split else [(0.0, 1.0)]
        parts.append(
            tuple(
                bf.Beam(
                    bar.axis.curve(view, piece[::-1] if view.backwards else piece),
                    count // len(pieces),
                    ALL_KINDS[bar.kind],
                    section,
                    material,
                )
                for piece in pieces
            )
        )

    def point(place: Place) -> bf.Point:
        return _point(parts, view, place)

    make = {"rigid": bf.Rigid, "hinge": bf.Hinge}
    joints = [make[kind](point(a), point(b)) for kind, a, b in recipe.joints]
    if view.split:
        joints += [
            bf.Rigid(point((number, 0.5)), bf.Point(last, 1.0 if view.backwards else 0.0))
            for number, (_, last) in enumerate(parts)
        ]
    beams = [beam for pieces in parts for beam in pieces]
    supports = []
    for support in recipe.supports:
        if support.kind == "foundation":
            stiffness = support.values[0] * view.force / view.length**2
            supports += [bf.Foundation(beam, (stiffness, stiffness)) for beam in parts[support.place[0]]]
        else:
            supports.append(_support(support, view, point(support.place)))
    loads = [made for load in recipe.loads for made in _loads(load, view, point(load.place), parts)]
    model = bf.Model(beams[::-1] if view.reordered else beams, supports, loads, joints)
    return Built(recipe, view, model, tuple(parts))


def _point(parts, view: View, place: Place) -> bf.Point:
    number, fraction = place
    pieces = parts[number]
    beam = pieces[0]
    if view.split:
        beam = pieces[0] if fraction <= 0.5 else pieces[1]
        fraction = 2.0 * fraction - (fraction > 0.5)
    return bf.Point(beam, 1.0 - fraction if view.backwards else fraction)


def _support(support: Support, view: View, at: bf.Point) -> bf.model.supports.Support:
    if support.kind == "clamp":
        return bf.Clamp(at)
    if support.kind == "pin":
        return bf.Pin(at)
    if support.kind == "roller":
        return bf.Roller(at, view.vector(support.values))
    if support.kind == "spring":
        stiffness, rotational = support.values
        translational = stiffness * view.force / view.length
        return bf.Spring(at, (translational, translational), rotational * view.force * view.length)
    turn = None if support.turn is None else view.sense * support.turn
    if support.kind == "turn":
        return bf.Prescribed(at, rotation=turn)
    ux, uy = view.vector(support.values, view.length)
    return bf.Prescribed(at, ux, uy, turn)


def _loads(load: Load, view: View, at: bf.Point, parts) -> list[bf.model.load_base.Load]:
    how = {"scale": load.scale}
    if load.kind == "gravity":
        return [bf.Gravity(view.vector(load.values, view.length), **how)]
    if load.kind == "moment":
        return [bf.PointMoment(at, view.sense * view.force * view.length * load.values[0], **how)]
    if load.kind == "pressure":
        size = (-1.0 if view.backwards else 1.0) * view.sense * load.values[0] * view.force / view.length
        return [bf.Pressure(beam, size, **how) for beam in parts[load.place[0]]]
    if load.kind == "muscle":
        curvature = (-1.0 if view.backwards else 1.0) * view.sense * load.values[0] / view.length
        beams = parts[load.place[0]]
        stretches = getattr(beams[0].element.coordinates, "stretchable", True)
        return [bf.Actuation(beam, curvature, load.values[1] * stretches, **how) for beam in beams]
    how["follower"] = load.follower
    if load.kind == "force":
        return [bf.PointForce(at, view.vector(load.values, view.force), **how)]
    pieces = parts[load.place[0]]
    return [bf.DistributedLoad(beam, view.vector(load.values, view.force / view.length), **how) for beam in pieces]
