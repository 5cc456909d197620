"""Memory that one solve leaves for the next, of whatever model: nothing that it holds counts."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

import beamfem as bf
from beamfem.equations import assembler, band_workspace

STEEL = bf.Material(2e11, 0.3, 7800.0)


def cantilever(element, height, elements=5):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, bf.Rectangle(0.01, height), STEEL)
    return bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, 4e10 * height**3))])


MODELS = [
    (element, height)
    for element in (bf.CRBF(2), bf.CRBF(4), bf.ANCF(), bf.ShearRigid(), bf.CRBF(2, bf.SplitContinuum()))
    for height in (0.01, 0.02)
]


@pytest.fixture
def empty(monkeypatch):
    monkeypatch.setattr(assembler, "_kept", [])


def test_models_that_are_solved_in_turns_do_not_see_each_other(empty):
    alone = []
    for element, height in MODELS:
        alone.append(bf.solve_static(cantilever(element, height)).p[-1])
        assembler._kept.clear()
    models = [cantilever(element, height) for element, height in MODELS]
    for _ in range(3):
        for model, expected in zip(models, alone, strict=True):
            np.testing.assert_array_equal(bf.solve_static(model).p[-1], expected)


@pytest.mark.parametrize(("element", "height"), MODELS)
def test_what_the_memory_holds_does_not_count(element, height, empty, monkeypatch):
    model = cantilever(element, height)
    expected = bf.solve_static(model).p[-1]

    def spoilt(size):
        found = assembler.new_scratch(size)
        found.memory[:] = np.nan
        return found

    monkeypatch.setattr(band_workspace, "lend_scratch", spoilt)
    for _ in range(2):
        np.testing.assert_array_equal(bf.solve_static(model).p[-1], expected)
    np.testing.assert_array_equal(bf.solve_static(cantilever(element, height)).p[-1], expected)


@pytest.mark.slow
def test_threads_do_not_share_memory(empty):
    expected = {case: bf.solve_static(cantilever(*case)).p[-1] for case in MODELS}
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(lambda case: bf.solve_static(cantilever(*case)).p[-1], MODELS * 20))
    for case, p in zip(MODELS * 20, found, strict=True):
        np.testing.assert_array_equal(p, expected[case])


def test_only_a_little_memory_is_kept(empty):
    for _ in range(10):
        assembler.take_back_scratch(assembler.new_scratch(100))
    assert len(assembler._kept) == 4
    assembler._kept.clear()
    assembler.take_back_scratch(assembler.new_scratch(1_000_001))
    assert not assembler._kept
    assert len(assembler.lend_scratch(7).memory) >= 7
