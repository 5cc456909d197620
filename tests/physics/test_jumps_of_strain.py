"""Forces inside a beam, where the strains jump: fields with a continuous r_x need a joint there to keep their order."""

import numpy as np
import pytest

import beamfem as bf

STIFF = {"axial": 1e5, "shear": 3e4, "bending": 50.0}
PULL = 500.0


def stretched(element, elements, joined):
    """Displacement of the middle, where a bar of length 1 is pulled along its axis."""
    section = bf.Section.from_stiffness(**STIFF, mass=1.0, rotary_inertia=1e-3)
    if joined:
        first, second = (bf.Beam(bf.Line((x, 0), (x + 0.5, 0)), elements // 2, element, section) for x in (0.0, 0.5))
        beams, joints, middle = [first, second], [bf.Rigid(first.end, second.start)], first.end
    else:
        first = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, section)
        beams, joints, middle = [first], [], first.at(0.5)
    model = bf.Model(beams, [bf.Clamp(first.start)], [bf.PointForce(middle, (PULL, 0.0))], joints=joints)
    return bf.solve_static(model).displacement(middle)[-1, 0]


CUBIC = [bf.ANCF(bf.ElasticLine()), bf.ANCFCRBF(bf.Structural(), integration="lobatto"), bf.ShearRigid()]


@pytest.mark.parametrize("element", CUBIC, ids=lambda element: f"{element.name} {element.forces.name}")
def test_cubic_elements_see_a_jump_of_the_normal_force_only_at_a_joint(element):
    """u = N l / EA of the half that carries N: exact with a joint, of order 1 without (docs/theory/fields.md)."""
    exact = PULL * 0.5 / STIFF["axial"]
    assert stretched(element, 8, joined=True) == pytest.approx(exact, rel=1e-12)
    coarse, fine = (abs(stretched(element, elements, joined=False) / exact - 1.0) for elements in (32, 64))
    assert np.log2(coarse / fine) == pytest.approx(1.0, abs=0.05)


@pytest.mark.parametrize("order", [1, 3])
def test_the_other_elements_need_no_joint(order):
    exact = PULL * 0.5 / STIFF["axial"]
    assert stretched(bf.CRBF(order), 2, joined=False) == pytest.approx(exact, rel=1e-12)
