"""What the tables of bad inputs share: good parts to spoil, and the test that a mistake is named."""

import math
from dataclasses import dataclass

import pytest

import beamfem as bf

NAN, INF = math.nan, math.inf
LINE = bf.Line((0, 0), (1, 0))
SECTION = bf.Rectangle(0.01, 0.01)
STEEL = bf.Material(2e11, 0.3, 7800.0)


def a_beam(**changes):
    arguments = {"curve": LINE, "elements": 2, "element": bf.CRBF(2), "section": SECTION, "material": STEEL}
    return bf.Beam(**{**arguments, **changes})


BEAM = a_beam()
END = BEAM.end
CANTILEVER = bf.Model([BEAM], [bf.Clamp(BEAM.start)], [bf.PointForce(END, (0, 1.0))])


@dataclass(frozen=True)
class Unreadable:
    """An object of no kind that is asked for."""

    def __repr__(self):
        raise RuntimeError("no text")


def require_named(make, kind, words):
    """Assert that a call raises an error of beamfem of one kind whose message has the words."""
    with pytest.raises(kind, match=words) as caught:
        make()
    assert isinstance(caught.value, bf.BeamfemError)
