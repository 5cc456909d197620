"""Tables of what varies along a beam: their values are those that are asked of points."""

import numpy as np
import pytest
from drawn import pendulum

import beamfem as bf
from beamfem.io.table import arrays
from beamfem.tables import cell


def test_a_table_of_a_motion_has_the_values_of_its_points():
    """A falling pendulum, its first row left out, so that no row is the reference."""
    motion = pendulum()[20:]
    (beam,) = motion.model.beams
    data, coordinates = arrays(motion, beam)
    shares = coordinates["arc_length"][1] / beam.curve.length
    for station in (0, 3, len(shares) - 1):
        at = beam.at(shares[station])
        for axis, name in enumerate("xy"):
            for column, values in ((name, motion.position), (f"u{name}", motion.displacement)):
                np.testing.assert_allclose(data[column][1][:, station], values(at)[:, axis], atol=1e-12)
            np.testing.assert_allclose(data[f"v{name}"][1][:, station], motion.velocity(at)[:, axis], atol=1e-12)
        np.testing.assert_allclose(data["rotation"][1][:, station], motion.rotation(at), atol=1e-12)
    assert data["vy"][1][:, -1].max() < -0.1  # it falls
    units = {name: about["units"] for name, (_, _, about) in (data | coordinates).items()}
    assert units == {
        **dict.fromkeys(("x", "y", "ux", "uy", "arc_length", "x0", "y0"), "m"),
        **dict.fromkeys(("vx", "vy"), "m/s"),
        **dict.fromkeys(("rotation", "shear_angle"), "rad"),
        **dict.fromkeys(("normal", "shear"), "N"),
        **dict.fromkeys(("kinetic_energy", "strain_energy", "potential_energy"), "J"),
        **{f"stress_{name}": "Pa" for name in ("lower", "upper", "shear", "von_mises")},
        "moment": "N m",
        "axial_strain": "1",
        "beam": "1",
        "time": "s",
    }


def test_section_forces_of_a_table_are_statics():
    """A cantilever under 3 N along and -2 N across at its end: N = 3, M = -2 (1 - s) but for its small deflection."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 3, bf.BilinearCRBF(), bf.Rectangle(0.1, 0.1), bf.Material(2e11, 0.3, 1.0))
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (3.0, -2.0))]))
    data, coordinates = arrays(solution, beam)
    s = coordinates["arc_length"][1]
    for name, expected in (("normal", 3.0 + 0.0 * s), ("shear", -2.0 + 0.0 * s), ("moment", -2.0 * (1.0 - s))):
        np.testing.assert_allclose(data[name][1][-1], expected, atol=1e-5)
    assert coordinates["load_factor"][1][-1] == pytest.approx(1.0)


def test_what_is_missing_is_an_empty_cell():
    assert [cell(value) for value in (None, float("nan"), np.float64("nan"), 0.0, 1.25, 3, "a")] == [
        *[""] * 3,
        *("0", "1.25", "3", "a"),
    ]
    assert cell(np.ones((2, 3))) == "array (2, 3)"
