"""Many features at once against numbers of an independent solver of Reissner's beam.

It was written apart from beamfem: positions and the angle of the section itself are interpolated by polynomials of
degree 8 to 14 in a few long spectral elements (Legendre-Gauss-Lobatto nodes, Gauss quadrature with 8 points more than
nodes), the weak form is that of Simo and Vu-Quoc (1986) with the tangent by complex steps, time steps are those of the
Gauss method with three stages (order 6). Numbers are given to the digits in which two resolutions agree.
"""

from dataclasses import dataclass

import numpy as np
import pytest
from connectors import PointMass, SpringDamper

import beamfem as bf
from beamfem.section import StiffnessSection


@dataclass(frozen=True)
class Body(PointMass):
    """A mass with a moment of inertia [kg m^2]."""

    inertia: float = 0.0

    def force(self, at):
        return super().force(at) + np.array([0.0, 0.0, 1.0]) * self.inertia * at.a[0, 2]

    def energy(self, at):
        kinetic, potential = super().energy(at)
        return kinetic + 0.5 * self.inertia * at.v[0, 2] ** 2, potential


LOWER = bf.Material(2e9, 0.3, 3000.0, thermal_expansion=2e-4)
UPPER = bf.Material(7e8, 0.35, 1000.0, thermal_expansion=5e-4)


def tapered_layers(s):
    return bf.Layered([bf.Layer(LOWER, 0.04 * (1 - 0.2 * s)), bf.Layer(UPPER, 0.03 * (1 - 0.1 * s))], width=0.05)


def loaded_arc():
    """A layered, tapered arc of radius 1 and length 1.7 under every kind of load, on every kind of support."""
    arc = bf.Beam(bf.Arc((0, 0), 1.0, 0.3, 2.0), 8, bf.CRBF(order=6), tapered_layers)
    loads = [
        bf.PointForce(arc.at(0.5), (300.0, -400.0), follower=True),
        bf.PointMoment(arc.at(0.75), 60.0),
        bf.DistributedLoad(arc, lambda s: (50 * s**2, -150 * (1 + s))),
        bf.DistributedLoad(arc, lambda s: (100 * np.sin(s), -200 * s), follower=True),
        bf.Pressure(arc, lambda s: 120 * (1 + s)),
        bf.Gravity((3.0, -9.81)),
        bf.Temperature(arc, change=30.0, gradient=200.0),
        bf.Actuation(
            arc,
            curvature=lambda s: 0.1 * np.cos(s),
            stretch=lambda s: 0.002 * s,
            shear=lambda s: 0.003 * np.sin(s),
        ),
    ]
    supports = [
        bf.Clamp(arc.start),
        bf.Prescribed(arc.end, ux=0.1, rotation=-0.6),
        bf.Spring(arc.at(0.25), stiffness=(500.0, 800.0), rotational=40.0),
        bf.Foundation(arc, (200.0, 300.0)),
    ]
    return arc, bf.Model([arc], supports, loads)


def test_an_arc_of_layers_under_every_load_at_once():
    """The free strains of layers are those of their straight section; mass and its first moment lie on the axis."""
    arc, model = loaded_arc()
    solution = bf.solve_static(model)
    middle = [*solution.displacement(arc.at(0.5))[-1], solution.rotation(arc.at(0.5))[-1]]
    assert middle == pytest.approx([0.06447042363247, 0.07681657037284, -0.23279581621257], rel=1e-11)
    assert solution.displacement(arc.end)[-1] == pytest.approx([0.1, 0.40390115059222], rel=1e-11)
    assert solution.reaction(arc.start)[-1] == pytest.approx([-1338.862431519, 1718.290892197, 362.545556774], rel=1e-9)
    assert solution.reaction(arc.end)[-1] == pytest.approx([1249.88449806, 0.0, -145.936686611], rel=1e-9, abs=1e-6)
    spring = [-10.440625444563, -14.173567316666, 4.793259263740]
    assert solution.reaction(arc.at(0.25))[-1] == pytest.approx(spring, rel=1e-11)
    assert solution.energy().strain[-1] == pytest.approx(21.61108409735, rel=1e-11)
    forces = solution.section_forces(arc)
    expected = {
        1: (-2077.75547626, -509.33157044, -224.55158965),
        3: (-2008.87933619, -20.40472290, -120.01121550),
        5: (-1401.02747196, -18.20516442, -129.02004778),
        7: (-1266.11295268, -91.04050753, -177.21868605),
    }
    for eighth, values in expected.items():
        here = np.argmin(np.abs(forces.arc_length - eighth * 1.7 / 8))  # where two elements meet
        found = [part[-1, here] for part in (forces.normal, forces.shear, forces.moment)]
        assert found == pytest.approx(values, rel=1e-7, abs=1e-6)
    frequencies = [17.328846895, 42.501338747, 88.962080838, 95.457638629, 150.298355113]
    assert bf.solve_modes(model, count=5, about=solution).frequencies == pytest.approx(frequencies, rel=1e-8)


RUBBER = bf.Material(5e7, 0.3, 1200.0, retardation_time=5e-3)
NORMAL = (np.sin(0.5), np.cos(0.5))


def pulse(rate):
    return lambda t: np.sin(rate * t) ** 4


def driven_linkage():
    """A tapered arm with a driven hub, a link hinged to it, a body on an inclined roller, a spring and a damper."""
    arm = bf.Beam(
        bf.Line((0, 0), (0.6, 0.2)), 4, bf.CRBF(order=5), lambda s: bf.Rectangle(0.03, 0.04 - 0.01 * s), RUBBER
    )
    link = bf.Beam(bf.Line((0.6, 0.2), (1.2, -0.3)), 4, bf.CRBF(order=5), bf.Rectangle(0.03, 0.03), RUBBER)
    hub, way = pulse(3.0), pulse(4.0)
    supports = [
        bf.Prescribed(arm.start, ux=lambda t: 0.05 * way(t), uy=0.0, rotation=lambda t: 0.6 * hub(t)),
        bf.Roller(link.end, NORMAL),
        bf.Spring(link.at(0.5), stiffness=(20.0, 30.0), rotational=0.5),
    ]
    loads = [
        bf.Gravity((0, -9.81), amplitude=pulse(3.0)),
        bf.PointForce(link.at(0.5), (0, 5.0), follower=True, amplitude=pulse(5.0)),
        bf.PointMoment(link.start, 1.0, amplitude=pulse(5.0)),
    ]
    connectors = [Body(link.end, 0.3, 0.002), SpringDamper(arm.at(0.5), link.at(0.5), 300.0, 8.0)]
    return arm, link, bf.Model([arm, link], supports, loads, [bf.Hinge(arm.end, link.start)], connectors=connectors)


def linkage_at_the_end(step):
    """What is looked at after 0.3 s, one number each."""
    arm, link, model = driven_linkage()
    motion = bf.simulate(model, duration=0.3, step=step, save_every=round(0.3 / step))
    found = [*motion.displacement(arm.end)[-1], motion.rotation(arm.end)[-1], motion.rotation(link.start)[-1]]
    found += [*motion.displacement(link.end)[-1], *motion.velocity(link.at(0.5))[-1]]
    for point in (arm.start, link.end, link.at(0.5)):
        found += [*motion.reaction(point)[-1]]
    for beam in (arm, link):
        forces = motion.section_forces(beam)
        last = [part[-1] for part in (forces.normal, forces.shear, forces.moment)]
        found += [np.interp(0.25 * beam.curve.length, forces.arc_length, part) for part in last]
    energy = motion.energy()
    return np.array([*found, energy.kinetic[-1], energy.strain[-1]])


def test_a_driven_linkage_with_damping_and_a_body():
    """Extrapolated from two steps by their order, two. Accelerations of the stiffest modes limit the reactions."""
    coarse, fine = linkage_at_the_end(2e-3), linkage_at_the_end(1e-3)
    found = fine + (fine - coarse) / 3
    moved = [0.019395292513, 0.044524723231, -0.003260803795, 0.045342851143, -0.014731991739, 0.008048123767]
    velocity = [-0.0819073978, 0.3919188466]
    assert found[:8] == pytest.approx([*moved, *velocity], rel=2e-7)
    hub, roller, spring = (
        [-5.83949, 8.62618, 5.470138],
        [-1.26832692, -2.32165686, 0.0],
        [-0.32571425, -1.2329385, 0.03592717],
    )
    assert found[8:11] == pytest.approx(hub, rel=2e-6)
    assert found[11:17] == pytest.approx([*roller, *spring], rel=2e-7, abs=1e-9)
    arm, link = [1.494112, -9.3219752, -3.9066199], [6.457704, 0.459887, -1.01481701]
    assert found[17:23] == pytest.approx([*arm, *link], rel=1e-6)
    assert found[23:] == pytest.approx([0.1492368238, 0.4587775362], rel=1e-8)


@dataclass(frozen=True)
class Coupled(StiffnessSection):
    """All strains stiffen or soften each other:

    W = EA e^2 (1 + 1.5 e) / 2 + GA g^2 (1 - 2 e) / 2 + EI k^2 (1 + 0.4 k^2) / 2 + 300 e k^2 + 80 e k.
    """

    def energy(self, strain, material):
        e, g, k = strain.T
        stretched, sheared = self.axial * e**2 * (1 + 1.5 * e) / 2, self.shear * g**2 * (1 - 2 * e) / 2
        return stretched + sheared + self.bending * k**2 * (1 + 0.4 * k**2) / 2 + 300 * e * k**2 + self.coupling * e * k

    def resultants(self, strain, material):
        e, g, k = strain.T
        normal = self.axial * e * (1 + 2.25 * e) - self.shear * g**2 + 300 * k**2 + self.coupling * k
        moment = self.bending * k * (1 + 0.8 * k**2) + 600 * e * k + self.coupling * e
        return np.stack([normal, self.shear * g * (1 - 2 * e), moment], axis=-1)


def test_an_arc_whose_law_couples_all_strains():
    """Pinned, on an inclined roller, under a force, weight, a pressure that follows, and imposed strains."""
    law = Coupled(axial=1e5, shear=3e4, bending=50.0, mass=2.0, rotary_inertia=0.01, coupling=80.0)
    arc = bf.Beam(bf.Arc((0, 0), 1.0, 0.3, 2.0), 12, bf.CRBF(order=6), law)
    strains = bf.Actuation(
        arc, curvature=lambda s: 0.5 * np.cos(s), stretch=lambda s: 0.01 * s, shear=lambda s: 0.01 * (1 - s)
    )
    loads = [bf.PointForce(arc.end, (40.0, -60.0)), bf.Pressure(arc, lambda s: 60 * s), bf.Gravity((0, -9.81)), strains]
    model = bf.Model([arc], [bf.Pin(arc.start), bf.Roller(arc.end, (0.6, 0.8))], loads)
    solution = bf.solve_static(model, steps=4)
    end = [*solution.displacement(arc.end)[-1], solution.rotation(arc.end)[-1], solution.rotation(arc.start)[-1]]
    assert end == pytest.approx([0.4210582012889, -0.3157936509667, 0.714949868468, -0.765288185282], rel=1e-9)
    assert solution.reaction(arc.start)[-1] == pytest.approx([-110.735055257, 86.744192691, 0.0], rel=1e-9, abs=1e-8)
    assert solution.reaction(arc.end)[-1] == pytest.approx([51.6060734895, 68.8080979862, 0.0], rel=1e-9, abs=1e-8)
    assert solution.energy().strain[-1] == pytest.approx(20.4885023714, rel=1e-9)
    forces = solution.section_forces(arc)
    middle = np.argmin(np.abs(forces.arc_length - 0.85))
    found = [part[-1, middle] for part in (forces.normal, forces.shear, forces.moment)]
    assert found == pytest.approx([-137.12702004, 20.452358138, 62.359203394], rel=1e-7)
    frequencies = [2.952729248, 10.783921974, 24.959157186, 44.490873359]
    assert bf.solve_modes(model, count=4, about=solution).frequencies == pytest.approx(frequencies, rel=1e-7)
