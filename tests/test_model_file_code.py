"""Python beside a model file: connectors, sections, curves, functions and integrators of the user's."""

import inspect

import integrators
import numpy as np
import pytest
import section_laws
from connectors import Barrier, RigidLink, SpringDamper
from model_file_pairs import ARM, LIFT, STEEL, arm, from_file, held, require_same
from test_cli import invoke
from test_model_file_alike import require_refused

import beamfem as bf
from beamfem.cli.modelfile import read_model_file

OWN = '''
import numpy as np
import beamfem as bf
from dataclasses import dataclass
from collections.abc import Callable, Sequence

@dataclass(frozen=True)
class Several:
    points: tuple[bf.Point, ...]
    stiffness: float
    unknowns = 0
    conservative = True

    def force(self, at):
        return (self.stiffness * (at.q - at.reference)).ravel()

    def energy(self, at):
        return 0.0, 0.5 * self.stiffness * float(((at.q - at.reference) ** 2).sum())

def spiral(u):
    return np.array([np.cos(u), np.sin(u)]).T * (1 + 0.1 * u)

def spiral_rate(u):
    round = np.array([-np.sin(u), np.cos(u)]).T
    return round * (1 + 0.1 * u) + 0.1 * np.array([np.cos(u), np.sin(u)]).T

@dataclass(frozen=True)
class Gust:
    strength: float
    course: Callable[[float], float] | None = None

    def __call__(self, time):
        return self.strength * (self.course(time) if self.course else time**2)

def flow(arc_length):
    return (0.0, -100.0 * arc_length)

@dataclass(frozen=True)
class Flow:
    def __call__(self, arc_length):
        return flow(arc_length)

def shape(arc_length):
    return 0.01 if arc_length < 0.5 else 0.008

@dataclass(frozen=True)
class Taper:
    width: float
    def __call__(self, arc_length):
        return bf.Rectangle(self.width, 0.01 - 0.002 * arc_length)

def layered(inner: bf.Material, thickness: float):
    return bf.Layered([bf.Layer(inner, thickness)] * 2, 0.01)

def spin(position):
    return (-2.0 * position[1], 2.0 * position[0])

def bent(state):
    return state.displacement(state.model.beams[0].end)[1] > 0.3

@dataclass(frozen=True)
class Straight:
    def __call__(self):
        pass

def broken(size: float):
    return 1 / 0
'''


@pytest.fixture
def written(tmp_path):
    """Return a place for a model file beside `own.py`."""
    (tmp_path / "own.py").write_text(
        OWN
        + "".join(inspect.getsource(part) for part in (RigidLink, SpringDamper, Barrier, integrators.RadauIIA))
        + inspect.getsource(section_laws).split("from beamfem.section.stiffness")[0].split('"""', 2)[2]
        + "from beamfem.section.stiffness import StiffnessSection\n_ITERATIONS = 60\n"
        + inspect.getsource(section_laws.RambergOsgood)
    )
    return tmp_path / "a.toml"


CODE = 'code = "own.py"\n'
