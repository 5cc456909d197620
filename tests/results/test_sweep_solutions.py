"""Sweeps that keep whole solutions: in memory, from other processes and on disk."""

from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial

import numpy as np
import pytest
from conftest import beam
from section_laws import RambergOsgood

import beamfem as bf


def bent(force):
    arm = beam(bf.CRBF(3), elements=2)
    model = bf.Model([arm], [bf.Clamp(arm.start)], [bf.PointForce(arm.end, (0.0, force))])
    return bf.solve_static(model, steps=3)


def named(force):
    if force == 3.0:
        raise ValueError("three is refused")
    solution = bent(force)
    return {"solution": solution, "tip": float(solution.p[-1].max()), "again": solution}


def whole(force):
    return bent(force)


def neither(force):
    return {"model": object()}


def require_same(found, expected):
    assert isinstance(found, bf.Solution)
    for part in ("at", "p", "v", "a"):
        np.testing.assert_array_equal(getattr(found, part), getattr(expected, part))
    arm = found.model.beams[0]
    np.testing.assert_array_equal(found.displacement(arm.end), expected.displacement(expected.model.beams[0].end))


@pytest.mark.parametrize("executor", [None, partial(ProcessPoolExecutor, 2)], ids=["here", "processes"])
def test_solutions_are_kept_whole_and_numbers_in_tables(tmp_path, executor):
    found = bf.sweep(named, force=[1.0, 2.0, 3.0], executor=executor)
    column = found["solution"]
    assert column.shape == (3,)
    require_same(column[0], bent(1.0))
    require_same(column[1], bent(2.0))
    assert column[2] is None
    found.to_csv(tmp_path / "table.csv")
    assert (tmp_path / "table.csv").read_text().splitlines()[0] == "force,tip,seconds"
    assert "Solution" not in str(found)
    assert list(found.to_pandas().columns) == ["force", "tip", "seconds"]
    assert list(found.to_xarray().data_vars) == ["tip", "seconds"]
    assert found.plot() is not None


@pytest.mark.slow
def test_a_store_keeps_solutions_as_files_and_computes_again_what_is_lost(tmp_path):
    store = tmp_path / "sweep.jsonl"
    for function in (named, whole):
        first = bf.sweep(function, force=[1.0, 2.0], store=store)
        again = bf.sweep(function, force=[1.0, 2.0], store=store)
        assert (first.computed, again.computed) == (2, 0)
        column = "solution" if function is named else "whole"
        for number in (0, 1):
            require_same(again[column][number], first[column][number])
    files = sorted((tmp_path / "sweep").glob("*.h5"))
    assert len(files) == 2 * 2 + 2
    require_same(bf.load(files[0]), bf.load(files[0]))
    for file in files:
        file.write_bytes(file.read_bytes()[:200])
    mended = bf.sweep(whole, force=[1.0, 2.0], store=store)
    assert mended.computed == 2
    assert bf.sweep(whole, force=[1.0, 2.0], store=store).computed == 0


def test_what_is_neither_number_nor_solution_is_refused():
    found = bf.sweep(neither, force=[1.0])
    assert "a number, an array, a Solution or a mapping" in found.failures[0].error


def of_an_own_law(force):
    @dataclass(frozen=True)
    class Local(RambergOsgood):
        """A class that no module holds."""

    law = Local(axial=1e6, shear=1e5, bending=100.0, mass=1.0, rotary_inertia=1e-4, knee=30.0)
    arm = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(order=2), law)
    solution = bf.solve_static(bf.Model([arm], [bf.Clamp(arm.start)], [bf.PointForce(arm.end, (0.0, force))]))
    return {"solution": solution, "tip": float(solution.p[-1].max())}


def test_a_solution_that_cannot_be_saved_is_in_the_result_and_named(tmp_path):
    for _ in range(2):
        with pytest.warns(bf.NotStoredWarning, match=r"not kept in the store .*Local cannot be saved"):
            found = bf.sweep(of_an_own_law, force=[10.0], store=tmp_path)
        assert found.computed == 1
        assert isinstance(found["solution"][0], bf.Solution)
