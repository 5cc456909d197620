"""Growth, roofline and compile budget: what is counted is what closed forms say."""

import numpy as np
import pytest

import beamfem as bf
from studies.benchmarks import chain_growth, flop_counts, fresh_models, part_costs, roofline, roofline_cases


def test_operations_of_plain_numbers():
    tally = flop_counts.Tally()
    x, y = (flop_counts.Counted(value, tally) for value in (3.0, 4.0))
    assert float(np.sqrt(float(x * x + y * y))) == 5.0
    assert (tally.operations, tally.slow) == (4, 1)  # two products, a sum and a root
    assert (1.0 / x + -y).value == pytest.approx(1 / 3 - 4)
    assert (tally.operations, tally.slow) == (6, 2)
    assert 2.0 < x < y
    assert abs(-x) == 3.0


def test_operations_of_the_kernels():
    """Solution: each of the 2 w neighbours and the pivot; the tangent costs more than the residual it contains."""
    counts = flop_counts.count_all()
    for form, element in roofline_cases.FORMS.items():
        found = counts[form]
        system, one = roofline_cases.case(form, 4)
        half = one.band.shape[1] // 2
        assert half == system.layouts[0].half_width
        unknown = element.field.degree * 3 if form != "ANCF, continuum" else 6
        assert found[roofline_cases.SOLVE][0] == pytest.approx(unknown * (4 * half + 1), rel=0.02)
        # a full band: elimination, scaling of the row, pivot and its ratio to the diagonal; blocks leave zeros
        row = half * (2 * half + 1) + half + 2
        assert 0.4 < found[roofline_cases.FACTOR][0] / (unknown * row) <= 1.02
        assert found[roofline_cases.TANGENT][0] > 3 * found[roofline_cases.RESIDUAL][0]


def test_bytes_of_the_band():
    _, one = roofline_cases.case("bilinear, structural", 10)
    system, _ = roofline_cases.case("bilinear, structural", 10)
    traffic = roofline_cases.least_traffic(system, one)
    unknown, width = one.band.shape
    assert traffic[roofline_cases.FACTOR] == 16 * unknown * width
    assert traffic[roofline_cases.SOLVE] == 8 * unknown * (width + 4)


@pytest.mark.slow
def test_the_roofline_has_a_line_for_each_kernel():
    top = roofline.Ceilings(memory=40.0, cache=200.0, peak=100.0, scalar=16.0, chain=2.0)
    counts = dict.fromkeys(roofline_cases.KERNELS, (100.0, 2.0))
    rows = roofline.rows_of("bilinear, structural", 20, counts, top)
    assert [line[2] for line in rows] == list(roofline_cases.KERNELS)
    assert all(len(line) == len(roofline.HEADER) for line in rows)
    assert all(line[3] > 0.0 for line in rows)


@pytest.mark.parametrize("analysis", ["statics", "motion"])
def test_growth_measures_a_chain(analysis):
    found = chain_growth.measure(analysis, "order 2", 40)
    steps, iterations, each, _, error, peak, _, remark = found
    assert (steps, remark) == (1 if analysis == "statics" else chain_growth.STEPS, "")
    assert iterations >= steps
    assert each > 0.0
    assert peak > 50.0
    assert np.isnan(error) if analysis == "motion" else error < 1e-6
    assert len(found) + 4 == len(chain_growth.HEADER)


@pytest.mark.slow
def test_costs_of_parts_are_those_of_the_table(tmp_path, capsys):
    """The bound is what a model that leaves compiled code takes; times beside other work are not judged further."""
    rows = part_costs.main(rounds=1, folder=tmp_path, parts=("rigid link", "between two states, Python"))
    assert [row[:2] for row in rows] == [("rigid link", 1), ("between two states, Python", 1)]
    assert all(0.0 < row[3] < 1e3 for row in rows)
    assert "each place" in capsys.readouterr().out


def test_fresh_models_are_those_of_the_table(tmp_path, capsys):
    rows = fresh_models.main((2,), rounds=1, folder=tmp_path)
    assert [row[:2] for row in rows] == [(name, 2) for name in fresh_models.ELEMENTS]
    assert all(time > 0.0 for row in rows for time in row[2:])
    assert "solved again" in capsys.readouterr().out
    # P L^3 / 3 E I of a small load, whatever the measures
    for size in (1.0, 1.5):
        moved = fresh_models.tip(fresh_models.model(bf.CRBF(4), 2, 1e-3, size))
        assert moved == pytest.approx(1e-3 * size**3 / (3.0 * 2e11 * size * (0.01 * size) ** 4 / 12.0), rel=1e-4)
