"""Random loads that impose strains, of everyday sizes or absurd ones."""

from dataclasses import dataclass

import numpy as np

import beamfem as bf
from beamfem.element.coordinates import ShearFree

EXPANSION = 1.2e-5
Random = np.random.Generator


def imposed(rng: Random, beams, analysis: str) -> list[object]:
    """Return one to three loads."""
    found: list[object] = []
    absurd = rng.random() < 0.25
    for _ in range(int(rng.choice([1, 1, 2, 3]))):
        beam = beams[rng.integers(len(beams))]
        size = float(10.0 ** rng.uniform(-7.0, 2.0) if absurd else 10.0 ** rng.uniform(-1.5, 0.8))
        length, bounds = beam.curve.length, beam.section_at(0.0).bounds
        how: dict[str, object] = {"scale": bool(rng.random() < 0.8)}
        if analysis == "motion" and rng.random() < 0.4:
            how["amplitude"] = Wave(float(rng.uniform(0.1, 10.0)))
        curvature: object = float(rng.choice([-1.0, 1.0])) * size / length
        if rng.random() < 0.3:
            curvature = _Curl(float(curvature), length)
        coordinates = beam.element.coordinates
        stretches = not isinstance(coordinates, ShearFree) or coordinates.stretchable
        stretch = float(np.clip(0.02 * size * rng.uniform(-1.0, 1.0), -0.5, 2.0)) if stretches else 0.0
        shear = (
            0.0 if isinstance(coordinates, ShearFree) else float(np.clip(0.02 * size * rng.uniform(-1, 1), -0.5, 0.5))
        )
        if rng.random() < 0.6:
            found.append(bf.Actuation(beam, curvature, stretch, shear * (rng.random() < 0.3), **how))
            continue
        change = stretch / EXPANSION
        try:
            found.append(bf.Temperature(beam, change, 0.2 * stretch / EXPANSION / (bounds[1] - bounds[0]), **how))
        except bf.InputError:  # of a section without a material, or layers of a continuum
            found.append(bf.Actuation(beam, curvature, **how))
    return found


@dataclass(frozen=True)
class Wave:
    rate: float

    def __call__(self, time: float) -> float:
        return float(np.sin(self.rate * time))


@dataclass(frozen=True)
class _Curl:
    size: float
    length: float

    def __call__(self, arc_length: float) -> float:
        return float(self.size * np.cos(3.0 * arc_length / self.length))
