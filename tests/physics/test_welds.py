"""A weld of two sections that are apart, against a stiff bar between them and a rigid body that it carries."""

import numpy as np
import pytest

import beamfem as bf

SQUARE, STEEL = bf.Rectangle(0.01, 0.01), bf.Material(2.1e11, 0.3, 7850.0)
BAR = bf.Material(2.1e16, 0.3, 1e-6)


def stepped(welded):
    """Two beams side by side with a rigid step between them, and a body on it."""
    one, two = (
        bf.Beam(bf.Line((x, y), (x + 0.5, y)), 3, bf.CRBF(3), SQUARE, STEEL) for x, y in ((0.0, 0.0), (0.55, 0.1))
    )
    step = bf.Beam(bf.Line((0.5, 0.0), (0.55, 0.1)), 1, bf.CRBF(3), SQUARE, BAR)
    weld = bf.Weld(one.end, two.start)
    return bf.Model(
        [one, two] if welded else [one, two, step],
        [bf.Clamp(one.start)],
        [bf.PointForce(two.end, (-20.0, 60.0))],
        [] if welded else [bf.Rigid(one.end, step.start), bf.Rigid(step.end, two.start)],
        connectors=[weld] if welded else [],
        masses=[bf.RigidBody(one.end, 0.2, 1e-4, offset=(0.025, 0.05))],
    )


def test_a_weld_is_a_stiff_bar_in_statics_modes_and_motion():
    found = []
    for model in (stepped(True), stepped(False)):
        tip = model.beams[1].end
        static, motion = bf.solve_static(model), bf.simulate(model, 0.05, 1.25e-4)
        frequencies = bf.solve_modes(model, 4, about=static).frequencies
        found.append((static.displacement(tip)[-1], frequencies, motion.displacement(tip)[-1]))
    assert np.abs(found[0][0]).max() > 0.1
    for welded, barred in zip(*found, strict=True):
        assert welded == pytest.approx(barred, rel=2e-5, abs=1e-7)


def test_a_weld_transmits_the_load_and_its_moment():
    """To the second beam, the opposite of the load."""
    model = stepped(True)
    solution, weld = bf.solve_static(model), model.connectors[0]
    tip, start = (solution.position(point)[-1] for point in (model.beams[1].end, model.beams[1].start))
    x, y = tip - start
    assert solution.joint_force(weld)[-1] == pytest.approx([20.0, -60.0, -60.0 * x - 20.0 * y], rel=1e-6)
