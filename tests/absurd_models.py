"""Random models from seeds, from everyday to absurd, held or not, and what is asked of each."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from absurd_strains import EXPANSION, Wave, imposed

import beamfem as bf

ANALYSES = ("static", "path", "modes", "buckling", "motion")
SHARES = (0.36, 0.16, 0.16, 0.14, 0.18)
CORNER = 0.25  # share of the size of the model within which the corners of frames are not drawn
STRAINED = 10_000  # seeds from here on have loads that impose strains besides
Random = np.random.Generator


@dataclass(frozen=True, eq=False)
class Case:
    """A model and an analysis of it: `run` makes what `analysis` names, with options."""

    seed: int
    analysis: str
    model: bf.Model
    run: Callable[[], object]
    options: dict[str, object]
    said: str


def draw(seed: int, elements: Sequence[bf.Element]) -> Case:
    """Return the case of a seed; its beams are of some of the given elements."""
    rng = np.random.default_rng([20261122, seed])
    analysis = str(rng.choice(ANALYSES, p=SHARES))
    beams, joints = _frame(rng, elements)
    supports = _supports(rng, beams)
    loads = _loads(rng, beams, analysis)
    if seed >= STRAINED:
        loads += imposed(np.random.default_rng([seed, 1]), beams, analysis)
    if analysis == "motion":
        supports = [_led(rng, support) for support in supports]
    model = bf.Model(beams, supports, loads, joints)
    run, options = _analysis(rng, analysis, model)
    names = ", ".join(f"{type(beam.curve).__name__} {beam.element.name} {beam.element.forces.name}" for beam in beams)
    said = f"{analysis} {options}: {model!r} of [{names}]"
    return Case(seed, analysis, model, run, options, said)


def _analysis(rng: Random, analysis: str, model: bf.Model) -> tuple[Callable[[], object], dict[str, object]]:
    if analysis == "static":
        options = {"steps": int(rng.choice([1, 1, 1, 3, 10])), "snap": str(rng.choice(["error", "error", "jump"]))}
        return lambda: bf.solve_static(model, **options), options
    if analysis == "path":
        options = {"until": float(rng.choice([1.0, 1.0, 0.3, -1.0])), "points": int(rng.choice([10, 30]))}
        return lambda: bf.trace_equilibrium(model, **options), options
    if analysis == "modes":
        count, loaded = int(rng.integers(1, 7)), rng.random() < 0.4
        if loaded:
            return lambda: bf.solve_modes(model, count, bf.solve_static(model)), {"count": count, "about": "static"}
        return lambda: bf.solve_modes(model, count), {"count": count}
    if analysis == "buckling":
        options = {"count": int(rng.integers(1, 4))}
        return lambda: bf.solve_buckling(model, **options), options
    beam = model.beams[0]
    rigidity, inertia = (of(beam.material) for of in (beam.section_at(0.0).rigidity, beam.section_at(0.0).inertia))
    period = beam.curve.length**2 * np.sqrt(inertia.mass / rigidity.bending)
    step, steps = float(10.0 ** rng.uniform(-3.5, 0.0) * period), int(rng.integers(5, 40))
    velocity = None
    if rng.random() < 0.3:
        speed = 10.0 ** rng.uniform(-3.0, 1.0) * beam.curve.length / period
        velocity = bf.RigidVelocity(_pair(speed * _direction(rng)), float(rng.normal() / period))
    options = {
        "duration": steps * step,
        "step": step,
        "velocity": velocity,
        "save_every": int(rng.choice([1, 1, 3])),
        "integrator": bf.GeneralizedAlpha(float(rng.choice([0.9, 0.9, 0.0, 1.0, 0.5]))),
    }
    return lambda: bf.simulate(model, **options), options


def _frame(rng: Random, elements: Sequence[bf.Element]) -> tuple[list[bf.Beam], list[object]]:
    """Beams from corner to corner, joined where they meet; some close a ring, some branch."""
    count = int(rng.choice([1, 2, 3, 4], p=[0.5, 0.25, 0.15, 0.1]))
    size = 10.0 ** rng.choice([0.0, rng.uniform(-3.0, 3.0)])
    corners, ends = [size * rng.uniform(-1.0, 1.0, 2)], {}
    total = min(count * 10.0 ** rng.uniform(0.0, 1.2), 200.0) if rng.random() < 0.9 else 10.0 ** rng.uniform(1.5, 2.3)
    modulus = 10.0 ** (rng.uniform(5.0, 12.0) if rng.random() < 0.5 else 11.3)
    slenderness = 10.0 ** (rng.uniform(0.5, 3.0) if rng.random() < 0.7 else rng.uniform(0.0, 5.0))
    alike = rng.random() < 0.7
    # each number of kinds in a model is compiled anew
    kinds = [elements[rng.integers(len(elements))] for _ in range(1 if alike else 2)]
    beams, joints = [], []
    for number in range(count):
        start = len(corners) - 1 if rng.random() < 0.8 else int(rng.integers(len(corners)))
        if number > 1 and rng.random() < 0.2:
            end = int(rng.integers(len(corners)))
        else:
            corners.append(_corner(rng, corners, size))
            end = len(corners) - 1
        if end == start or (start, end) in ends.values():
            corners.append(_corner(rng, corners, size))
            end = len(corners) - 1
        stiffer = 10.0 ** (rng.uniform(-9.0, 9.0) if rng.random() < 0.15 else 0.0)
        own = kinds[rng.integers(len(kinds))]
        curve = _curve(rng, corners[start], corners[end])
        beam = _beam(rng, curve, max(round(total / count), 1), own, slenderness, modulus * min(stiffer, 1e16 / modulus))
        for corner, point in ((start, beam.start), (end, beam.end)):
            others = [other for other, where in ends.items() if where == corner]
            if others and rng.random() < 0.97:
                joints.append((bf.Hinge if rng.random() < 0.3 else bf.Rigid)(others[0], point))
            ends[point] = corner
        beams.append(beam)
    return beams, joints


def _corner(rng: Random, corners, size: float) -> np.ndarray:
    while True:
        found = corners[-1] + size * rng.uniform(0.4, 1.0) * _direction(rng)
        if min(np.hypot(*(found - other)) for other in corners) > CORNER * size:
            return found


def _curve(rng: Random, start, end) -> bf.Curve:
    """A line, an arc, a polyline, a spline or a wave from start to end."""
    kind = rng.choice(["line", "arc", "polyline", "spline", "wave"], p=[0.55, 0.15, 0.1, 0.1, 0.1])
    along = end - start
    left = np.array([-along[1], along[0]])
    if kind == "line":
        return bf.Line(_pair(start), _pair(end))
    if kind == "arc":
        half = float(rng.choice([-1.0, 1.0]) * rng.uniform(0.1, 2.5))
        center = 0.5 * (start + end) - 0.5 / np.tan(half) * left
        radius = 0.5 * np.hypot(*along) / abs(np.sin(half))
        first = float(np.arctan2(*(start - center)[::-1]))
        return bf.Arc(_pair(center), float(radius), first, first - 2.0 * half)
    shares = np.sort(rng.uniform(0.2, 0.8, 2))
    inner = [start + share * along + rng.uniform(-0.3, 0.3) * left for share in shares]
    if kind == "polyline":
        return bf.Polyline(tuple(_pair(point) for point in (start, *inner[: rng.integers(1, 3)], end)))
    if kind == "spline":
        return bf.BSpline(3, (0.0,) * 4 + (1.0,) * 4, tuple(_pair(point) for point in (start, *inner, end)))
    rise, waves = rng.uniform(-0.2, 0.2), int(rng.integers(1, 4))

    def at(u):
        r = start + np.multiply.outer(u, along) + np.multiply.outer(rise * np.sin(waves * np.pi * u), left)
        return r[..., 0], r[..., 1]

    return bf.Parametric(at, 0.0, 1.0)


def _beam(rng: Random, curve, count: int, element, slenderness: float, modulus: float) -> bf.Beam:
    height = curve.length / slenderness
    if not isinstance(curve, bf.Line):
        height = min(height, 0.1 * curve.length)
    ratio = float(rng.choice([0.3, 0.3, 0.0, 0.49, -0.3]))
    material = bf.Material(modulus, ratio, float(10.0 ** rng.uniform(0.0, 4.5)), thermal_expansion=EXPANSION)
    kind = rng.choice(
        ["rectangle", "tube", "taper", "layers", "moments", "stiffness"], p=[0.5, 0.1, 0.1, 0.1, 0.1, 0.1]
    )
    width = height * 10.0 ** rng.uniform(-1.0, 1.0)
    section: object = bf.Rectangle(width, height)
    if kind == "tube":
        section = bf.Tube(height, height * rng.uniform(0.05, 0.5))
    elif kind == "taper":
        slope = rng.uniform(-0.7, 1.0) * height / curve.length
        section = _Taper(width, height, slope)
    elif kind == "layers":
        other = bf.Material(
            modulus * 10.0 ** rng.uniform(-2.0, 0.0), ratio, material.density, thermal_expansion=2.0 * EXPANSION
        )
        section = bf.Layered([bf.Layer(material, 0.4 * height), bf.Layer(other, 0.6 * height)], width)
    elif kind == "moments":
        section = bf.Section(width * height, width * height**3 / 12.0, shear_factor=rng.uniform(0.3, 1.0))
    elif kind == "stiffness" and not element.forces.fills_body:
        area, second = width * height, width * height**3 / 12.0
        mass = material.density * area
        coupling = 0.3 * rng.choice([0.0, 1.0]) * modulus * np.sqrt(area * second)
        stiff = modulus * area, 0.4 * modulus * area, modulus * second
        section = bf.Section.from_stiffness(*stiff, mass, material.density * second, float(coupling))
    if rng.random() < 0.1 and count > 1:
        ends = np.concatenate([[0.0], np.sort(rng.uniform(0.01, 0.99, count - 1)), [1.0]])
        if np.diff(ends).min() > 1e-3:
            return bf.Beam(curve, tuple(ends.tolist()), element, section, material)
    return bf.Beam(curve, count, element, section, material)


@dataclass(frozen=True)
class _Taper:
    width: float
    height: float
    slope: float

    def __call__(self, s: float) -> bf.Section:
        return bf.Rectangle(self.width, self.height + self.slope * s)


def _supports(rng: Random, beams) -> list[object]:
    """Mostly enough of them, now and then none or too few."""
    style = rng.choice(["clamp", "pins", "any", "none"], p=[0.5, 0.25, 0.17, 0.08])
    first, last = beams[0].start, beams[-1].end
    unit = _stiffness(beams[0])
    length = beams[0].curve.length
    found: list[object] = []
    if style == "clamp":
        found.append(bf.Clamp(first))
    elif style == "pins":
        found += [bf.Pin(first), bf.Roller(last, _pair(_direction(rng))) if rng.random() < 0.5 else bf.Pin(last)]
    if style == "any" or rng.random() < 0.4:
        for _ in range(int(rng.integers(1, 3))):
            beam = beams[rng.integers(len(beams))]
            point = beam.at(float(rng.choice([0.3, 0.5, 0.77, rng.uniform(0.0, 1.0)])))
            kind = rng.choice(["roller", "pin", "clamp", "spring", "foundation", "led", "turned"])
            scale = 10.0 ** (rng.uniform(-2.0, 2.0) if rng.random() < 0.8 else rng.uniform(-9.0, 9.0)) * unit
            if kind == "roller":
                found.append(bf.Roller(point, _pair(_direction(rng))))
            elif kind == "pin":
                found.append(bf.Pin(point))
            elif kind == "clamp":
                found.append(bf.Clamp(point))
            elif kind == "spring":
                stiffness = rng.choice([[1.0, 0.0], [1.0, 0.5], [0.0, 2.0]]) * scale / length
                found.append(bf.Spring(point, _pair(stiffness), float(rng.choice([0.0, 1.0]) * scale * length)))
            elif kind == "foundation":
                found.append(bf.Foundation(beam, (0.0, float(scale / length**2))))
            elif kind == "led":
                found.append(bf.Prescribed(point, *_pair(0.1 * rng.uniform(0.0, 3.0) * length * _direction(rng))))
            else:
                found.append(bf.Prescribed(point, rotation=float(rng.uniform(-2.0, 2.0))))
    return found


def _led(rng: Random, support):
    """In motions what is led moves from zero, as a function of time."""
    if not isinstance(support, bf.Prescribed):
        return support
    values = {name: _Ramp(value) for name, value in support.prescribed().items()}
    return bf.Prescribed(support.point, **values)


@dataclass(frozen=True)
class _Ramp:
    value: float

    def __call__(self, time: float) -> float:
        return self.value * time**3 / (1.0 + abs(time) ** 3)


def _loads(rng: Random, beams, analysis: str) -> list[object]:
    found: list[object] = []
    absurd = rng.random() < 0.25
    for number in range(int(rng.choice([0, 1, 1, 1, 2, 3]))):
        beam = beams[rng.integers(len(beams))]
        exponent = rng.uniform(-7.0, 4.0) if absurd else rng.uniform(-1.5, 1.2)
        size = float(10.0**exponent * _stiffness(beam))
        length, away = beam.curve.length, _direction(rng)
        follower = analysis != "buckling" and bool(rng.random() < 0.25)
        how: dict[str, object] = {"scale": bool(rng.random() < 0.85 or number == 0)}
        if analysis == "motion" and rng.random() < 0.4:
            how["amplitude"] = rng.choice([Wave(float(rng.uniform(0.1, 10.0))), bf.Interpolated([(0, 0), (1, 1)])])
        point = beam.at(float(rng.choice([1.0, 1.0, 0.5, rng.uniform(0.0, 1.0)])))
        kind = rng.choice(
            ["force", "moment", "line", "along", "pressure", "gravity"], p=[0.4, 0.15, 0.15, 0.1, 0.1, 0.1]
        )
        if kind == "force":
            found.append(bf.PointForce(point, _pair(size * away), follower=follower, **how))
        elif kind == "moment":
            found.append(bf.PointMoment(point, float(size * length * rng.choice([-1.0, 1.0])), **how))
        elif kind == "line":
            found.append(bf.DistributedLoad(beam, _pair(size / length * away), follower=follower, **how))
        elif kind == "along":
            course = _Along(float(size / length), length, _pair(away))
            found.append(bf.DistributedLoad(beam, course, follower=follower, **how))
        elif kind == "pressure" and analysis != "buckling":
            found.append(bf.Pressure(beam, float(size / length), **how))
        elif kind == "gravity":
            mass = beam.section_at(0.0).inertia(beam.material).mass
            found.append(bf.Gravity(_pair(size / (mass * length) * away), **how))
    return found


@dataclass(frozen=True)
class _Along:
    size: float
    length: float
    away: tuple[float, float]

    def __call__(self, s: float) -> tuple[float, float]:
        weight = self.size * (1.0 - s / self.length) ** 2
        return weight * self.away[0], weight * self.away[1]


def _stiffness(beam: bf.Beam) -> float:
    """E I / L^2 [N]."""
    return beam.section_at(0.0).rigidity(beam.material).bending / beam.curve.length**2


def _direction(rng: Random) -> np.ndarray:
    angle = rng.uniform(0.0, 2.0 * np.pi)
    return np.array([np.cos(angle), np.sin(angle)])


def _pair(values) -> tuple[float, float]:
    return float(values[0]), float(values[1])
