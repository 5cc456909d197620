"""Searches for buckling of random everyday models, how they end and what they compute, and of two models at once."""

import pytest
from random_models import random_recipe
from recipes import View
from slow_values import mostly_slow

import beamfem as bf
from beamfem.linalg import eigenpairs
from beamfem.solve.stability import linearised


@pytest.mark.slow
@mostly_slow("seed", [107, 123, 147], quick=(2,))
def test_a_search_ends_where_the_beam_would_be_turned_inside_out(seed):
    """Arches that are led far away from their supports, whose stable path was said to be lost there."""
    found = bf.solve_buckling(random_recipe(seed).build().model, 3)
    assert len(found) == 0
    assert found.status is bf.Status.STOPPED
    assert "would be turned inside out" in found.ended
    with pytest.raises(bf.ConvergenceError, match="inside out") as caught:
        bf.trace_equilibrium(found.model, until=50.0)
    path = caught.value.solution
    assert path.stable.all()
    assert found.ended == f"beyond load factor {path.load_factor[-1]:.6g} the beam would be turned inside out"


@pytest.mark.slow
@pytest.mark.parametrize("seed", [179])
def test_a_search_that_is_lost_where_an_element_is_bent_by_half_a_turn_asks_for_more_elements(seed):
    model = random_recipe(seed).build().model
    with pytest.raises(bf.ConvergenceError, match=r"an element of beam 0 is bent by \d(\.\d)? rad there: use more"):
        bf.solve_buckling(model, 4)
    finer = bf.solve_buckling(random_recipe(seed).build(View(finer=2)).model, 4)
    assert "goes no further than 300 times" in finer.ended


def test_a_search_along_a_path_computes_a_few_modes_only(monkeypatch):
    """167 unknowns: threads of BLAS took minutes for all modes of each point on a busy computer."""
    solved = []

    def counted(solve):
        def called(matrix, *arguments, **options):
            solved.append(len(matrix))
            return solve(matrix, *arguments, **options)

        return called

    solvers = {
        eigenpairs: ("eig", "eigh", "cholesky"),
        linearised: ("eigh",),
    }
    for where, names in solvers.items():
        for name in names:
            monkeypatch.setattr(where, name, counted(getattr(where, name)))
    model = random_recipe(2).build().model
    found = bf.solve_buckling(model)
    path = bf.trace_equilibrium(model, until=lambda state: state.load_factor > found.load_factors[0], points=60)
    assert found.load_factors == pytest.approx([path.limit_points[0].load_factor], rel=1e-8)
    assert max(solved) < 20


@pytest.mark.parametrize("stiffer", [0.0, 1e-12])
def test_two_bars_that_snap_together_have_a_bifurcation_at_their_limit_point(stiffer):
    """Round-off decided whether it came before the limit point, behind which none are listed."""
    height, section = 0.1, bf.Rectangle(0.1, 0.2)
    bars, supports, loads = [], [], []
    for number in range(2):
        steel = bf.Material(2e11 * (1.0 + number * stiffer), 0.3, 7800.0)
        bars.append(bf.Beam(bf.Line((2.0 * number, 0), (2.0 * number + 1.0, height)), 4, bf.CRBF(2), section, steel))
        supports += [bf.Pin(bars[-1].start), bf.Roller(bars[-1].end, (1, 0))]
        loads.append(bf.PointForce(bars[-1].end, (0.0, -1e-3 * 2e11 * section.area)))
    found = bf.solve_buckling(bf.Model(bars, supports, loads), 3)
    assert found.kinds == ("bifurcation", "limit point")
    # P = E A (1/l - 1/l0) y is largest where l^3 = l0
    length = (1.0 + height**2) ** 0.5
    at = length ** (1.0 / 3.0)
    exact = 1e3 * (1.0 / at - 1.0 / length) * (at**2 - 1.0) ** 0.5
    assert found.load_factors == pytest.approx([exact, exact], rel=1e-9)
