"""Springs with laws of the elongation: nonlinear, preloaded, only in tension."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.special import ellipk

import beamfem as bf
from beamfem.testing import check_connector

SQUARE, STEEL = bf.Rectangle(0.01, 0.01), bf.Material(2.1e11, 0.3, 7850.0)
STIFF = bf.Material(2.1e15, 0.3, 1e-3)


def cubic(e, f):
    return 100.0 * e + 4e4 * e**3


@dataclass(frozen=True)
class Cubic:
    stiffness: float

    def __call__(self, e, f):
        return self.stiffness * e**3


def hung(law, length=None, damping=0.0):
    """A mass of 2 kg on a spring along y to the ground below, held by a roller."""
    beam = bf.Beam(bf.Line((0, 0), (0.1, 0)), 1, bf.CRBF(2), SQUARE, STIFF)
    spring = bf.SpringDamper(beam.start, (0.0, -1.0), law, damping, length)
    supports = [bf.Prescribed(beam.start, ux=0.0, rotation=0.0)]
    return bf.Model([beam], supports, connectors=[spring], masses=[bf.PointMass(beam.start, 2.0)]), beam, spring


def test_force_and_energy_belong_together():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), SQUARE, STEEL)
    check_connector(bf.SpringDamper(beam.end, (2.0, 1.0), cubic, 3.0))
    check_connector(bf.SpringDamper(beam.end, beam.start, lambda e, f: 10.0 + f.sqrt(1.0 + e * e), length=0.8))


def test_a_mass_on_a_cubic_spring_has_the_period_of_duffing():
    """x'' + (100 x + 4e4 x^3) / 2 = 0 from 0.1 m: T = 4 K(m) / w, w^2 = (100 + 400) / 2, m = 200 / 500."""
    model, beam, spring = hung(cubic)
    push = bf.Prescribed(beam.start, ux=0.0, uy=0.1, rotation=0.0)
    pulled = bf.solve_static(model.with_(supports=[push]))
    assert -pulled.reaction(beam.start)[-1, 1] == pytest.approx(-50.0, rel=1e-9)
    period = 4.0 * ellipk(0.4) / np.sqrt(250.0)
    motion = bf.simulate(model, period, step=period / 400, start=pulled, integrator=bf.Gauss(stages=3))
    assert motion.displacement(beam.start)[-1, 1] == pytest.approx(0.1, abs=1e-8)
    assert np.ptp(motion.energy().total) < 1e-6 * motion.energy().total[0]
    assert motion.connector_force(spring)[0, 0, 1] == pytest.approx(-50.0, rel=1e-9)


def test_a_law_without_compression_is_a_cable_and_a_linear_one_a_spring():
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), SQUARE, STEEL)
    ends = beam.end, (1.0, 1.0)
    pairs = (
        (bf.SpringDamper(*ends, lambda e, f: 500.0 * f.positive(e)), bf.Cable(*ends, 500.0)),
        (bf.SpringDamper(*ends, lambda e, f: 500.0 * e), bf.SpringDamper(*ends, 500.0)),
    )
    for force in (-40.0, 40.0):
        loads = [bf.PointForce(beam.end, (0.0, force))]
        for pair in pairs:
            models = [bf.Model([beam], [bf.Clamp(beam.start)], loads, connectors=[part]) for part in pair]
            bent = [bf.solve_static(model) for model in models]
            assert bent[0].displacement(beam.end)[-1] == pytest.approx(bent[1].displacement(beam.end)[-1], rel=1e-9)
            tones = [bf.solve_modes(model, 2, about=own).frequencies for model, own in zip(models, bent, strict=True)]
            assert tones[0] == pytest.approx(tones[1], rel=1e-9)


def test_a_preloaded_spring_pulls_in_the_reference():
    model, beam, _ = hung(lambda e, f: 30.0 + 1e3 * e)
    held = bf.solve_static(model.with_(supports=[bf.Clamp(beam.start)]))
    assert held.reaction(beam.start)[-1] == pytest.approx([0.0, 30.0, 0.0], abs=1e-9)
    assert bf.solve_static(model).displacement(beam.start)[-1, 1] == pytest.approx(-0.03, rel=1e-9)


def test_a_law_of_a_class_is_saved_and_others_are_refused(tmp_path):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), SQUARE, STEEL)
    loads = [bf.PointForce(beam.end, (0.0, -10.0))]
    for law in (Cubic(1e4), lambda e, f: 1e4 * e**3):
        spring = bf.SpringDamper(beam.end, (1.0, 1.0), law)
        solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], loads, connectors=[spring]))
        if isinstance(law, Cubic):
            solution.save(tmp_path / "law.h5")
            assert bf.solve_static(bf.load(tmp_path / "law.h5").model).p == pytest.approx(solution.p, abs=1e-12)
        else:
            with pytest.raises(bf.InputError, match="make it a dataclass"):
                solution.save(tmp_path / "function.h5")
    with pytest.raises(bf.InputError, match="function of the elongation"):
        bf.SpringDamper(beam.end, (1.0, 1.0), lambda e: 2.0 * e)
    bad = bf.SpringDamper(beam.end, (1.0, 1.0), lambda e, f: max(e, 0.0))
    with pytest.raises(bf.InputError, match="cannot be derived from its energies"):
        bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], loads, connectors=[bad]))


def test_a_table_is_a_law_that_files_hold(tmp_path):
    """Preloaded by 10 N, constant below -0.02 m, softer from 0.01 m on; the energy is the area under it."""
    model, beam, spring = hung(bf.Interpolated([(-0.02, -10.0), (0.01, 20.0), (0.03, 30.0)]))
    for force, stretch in ((-5.0, -0.015), (15.0, 0.005), (27.5, 0.025)):
        loaded = model.with_(loads=[bf.PointForce(beam.start, (0.0, force))])
        solution = bf.solve_static(loaded)
        assert solution.displacement(beam.start)[-1, 1] == pytest.approx(stretch, rel=1e-9)
    assert solution.energy().potential[-1] + 27.5 * 0.025 == pytest.approx(0.50625, rel=1e-5)
    assert solution.connector_force(spring)[-1, 0, 1] == pytest.approx(-27.5, rel=1e-9)
    solution.save(tmp_path / "table.h5")
    again = bf.load(tmp_path / "table.h5").model
    assert bf.solve_static(again).p[-1] == pytest.approx(solution.p[-1], abs=1e-12)


@pytest.mark.parametrize(
    ("law", "message"),
    [
        (lambda e, f: np.nan * e, "the constant nan is not finite"),
        (lambda e, f: 1.0 / e, "force of SpringDamper or its derivative is not finite in the reference"),
        (lambda e, f: 100.0 * f.sqrt(f.positive(e)) * e, "is not finite in the reference"),
    ],
    ids=["nan", "reciprocal", "root"],
)
@pytest.mark.parametrize("solve", [bf.solve_static, lambda model: bf.simulate(model, 0.01, step=1e-3)])
def test_laws_that_are_not_finite_in_the_reference_are_refused(law, message, solve):
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), SQUARE, STEEL)
    spring = bf.SpringDamper(beam.end, (1.0, 1.0), law)
    with pytest.raises(bf.InputError, match=message):
        solve(bf.Model([beam], [bf.Clamp(beam.start)], connectors=[spring]))
