"""The elements that every test of all combinations runs over, and a small model of each."""

import os
from collections import defaultdict
from itertools import product
from zlib import crc32

import numpy as np
import pytest
from hypothesis import HealthCheck, settings

import beamfem as bf
from beamfem.element.coordinates import Gradients, Rotation, ShearFree
from beamfem.element.fields import Cubic, Lagrange
from beamfem.equations import equation_numbering as layout

FIELDS = (Cubic(), *(Lagrange(order) for order in (1, 2, 3, 5)))
COORDINATES = (Gradients(), Rotation(), ShearFree(True), ShearFree(False))
FORCES = (bf.ContinuumMechanics(), bf.ContinuumMechanics(True), bf.SplitContinuum(), bf.ElasticLine(), bf.Structural())


_MANY = 4  # cases of a test

# the same examples every time: few of them, many in the slow verification
_ALWAYS = {"derandomize": True, "deadline": None, "database": None, "suppress_health_check": tuple(HealthCheck)}
settings.register_profile("few", max_examples=8, **_ALWAYS)
settings.register_profile("many", max_examples=300, **_ALWAYS)


def pytest_configure(config):
    for display in ("DISPLAY", "WAYLAND_DISPLAY"):
        os.environ.pop(display, None)  # plots of tests are not windows
    settings.load_profile("few" if config.option.markexpr == "not slow" else "many")


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Leave cases of tests with many cases to the slow verification: other ones in each test.

    Of tests over all elements a quarter of these stays, of others with four cases or more a half; all cases stay where
    tangents are compared with differences, in tests of pages and commands, and where some are marked as slow already.
    """
    cases = defaultdict(list)
    for item in items:
        if hasattr(item, "callspec") and item.path.name != "test_kernels.py":
            cases[item.function].append(item)
    for function, of_function in cases.items():
        elements = {
            item: item.callspec.indices["element"] for item in of_function if "element" in item.callspec.indices
        }
        over_elements = len(set(elements.values())) >= len(USUAL)
        few = len(of_function) < _MANY or of_function[0].path.parent.name == "cli"
        if not over_elements and (few or any(item.get_closest_marker("slow") for item in of_function)):
            continue
        number = elements if over_elements else {item: place for place, item in enumerate(of_function)}
        for item in of_function:
            if (number[item] + crc32(function.__name__.encode())) % (4 if over_elements else 2):
                item.add_marker(pytest.mark.slow)


def combinations():
    """Every combination of field, coordinates, forces and integration that is not refused."""
    for parts in product(FIELDS, COORDINATES, FORCES, ("full", "reduced", "lobatto")):
        try:
            yield bf.Element(*parts)
        except bf.InputError:
            continue


ELEMENTS = tuple(combinations())
# the same kernels with other tables: every integration is tested where strains and forces are, one where models are
USUAL = tuple(e for e in ELEMENTS if e.integration == bf.Element(e.field, e.coordinates, e.forces).integration)


def identify(element):
    flag = "-plane-stress" if getattr(element.forces, "plane_stress", False) else ""
    return f"{element.name}-{element.forces.name}{flag}-{element.integration}"


@pytest.fixture(params=USUAL, ids=identify)
def element(request):
    return request.param


@pytest.fixture
def widest_band(monkeypatch):
    """Return a function that sets the widest half width for which a model gets a band."""
    monkeypatch.setattr(layout, "_cached_order", layout._cached_order.__wrapped__)
    return lambda half_width: monkeypatch.setattr(layout, "_WIDEST_BAND", half_width)


@pytest.fixture
def rng():
    return np.random.default_rng(20160101)


def beam(element, elements=3, start=(0.0, 0.0), end=(1.0, 0.5)):
    section = bf.Section(area=1.6e-3, second_moment=8.533e-6)
    return bf.Beam(bf.Line(start, end), elements, element, section, bf.Material(0.7e6, 0.3, 5540.0))


@pytest.fixture
def written(tmp_path):
    """Write a text as a model file."""

    def write(text):
        file = tmp_path / "model.toml"
        file.write_text(text)
        return file

    return write


@pytest.fixture
def uncut_steps(monkeypatch):
    """Take steps as they are, however much energy they gain, and do not redo those that fail."""
    monkeypatch.setattr("beamfem.solve.motion.cut_steps.MOST_CUTS", 0)
    accept = "beamfem.solve.motion.energy_judgement.EnergyJudge.accept"
    monkeypatch.setattr(accept, lambda judge, times, *rest: len(times) - 1)
