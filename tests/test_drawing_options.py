"""What editors complete of pictures, films and pages is what they take."""

import typing

import pytest

import beamfem as bf
from beamfem.registry import offered
from beamfem.solve.modes.modes import Modes
from beamfem.solve.stability.buckling import Buckling

METHODS = [
    *(getattr(bf.Solution, name) for name in ("plot", "animate", "to_html", "show", "picture")),
    *(Modes.plot, Buckling.plot),
]


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.__qualname__)
def test_options_are_those_of_the_function(method):
    (options,) = typing.get_args(typing.get_type_hints(method)["options"])
    known = typing.get_type_hints(offered(method).__wrapped__, localns={"Modes": Modes, "Buckling": Buckling})
    first, *_ = known
    taken = {name: kind for name, kind in known.items() if name not in (first, "path", "return")}
    assert typing.get_type_hints(options) == taken
