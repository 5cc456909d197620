"""The independent balance that the fuzz judges by notices what is wrong: a state, a load factor, rates."""

from dataclasses import replace

import pytest
from independent_balance import balance

import beamfem as bf

SECTION, STEEL = bf.Rectangle(0.02, 0.02), bf.Material(2e11, 0.3, 7800.0)
EI = 2e11 * SECTION.second_moment
KINDS = (bf.CRBF(2), bf.ANCF(), bf.ANCF(bf.ElasticLine()), bf.ShearRigid())


def loaded(element):
    beam = bf.Beam(bf.Arc((0, 0), 1.0, 0.0, 1.2), 3, element, SECTION, STEEL)
    loads = [
        bf.PointForce(beam.at(0.4), (0.2 * EI, 0.1 * EI), follower=True),
        bf.PointMoment(beam.end, 0.1 * EI),
        bf.DistributedLoad(beam, (0.0, -0.1 * EI)),
        bf.Pressure(beam, 0.1 * EI),
    ]
    supports = [bf.Clamp(beam.start), bf.Spring(beam.end, (EI, 0.5 * EI), EI), bf.Foundation(beam, (0.0, EI))]
    return bf.Model([beam], supports, loads)


@pytest.mark.parametrize("element", KINDS, ids=lambda element: f"{element.name}-{element.forces.name}")
def test_it_holds_for_a_solution_and_not_beside_it(element):
    solution = bf.solve_static(loaded(element))
    assert balance(solution).holds
    assert not balance(replace(solution, p=solution.p + 1e-7)).holds
    assert not balance(replace(solution, at=solution.at + 1e-5)).holds


@pytest.mark.parametrize("element", KINDS, ids=lambda element: f"{element.name}-{element.forces.name}")
def test_it_holds_for_a_motion_and_not_with_other_rates(element):
    motion = bf.simulate(loaded(element), 2e-3, 1e-4)
    assert balance(motion).holds
    assert not balance(replace(motion, a=1.001 * motion.a)).holds
    if not isinstance(element.coordinates, bf.Gradients):  # their mass is constant: no force comes from rates
        assert not balance(replace(motion, v=motion.v + 1e4)).holds
