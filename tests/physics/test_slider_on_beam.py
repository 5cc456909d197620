"""A point that slides along a beam: an inclined plane, deflections by hand, balance and energy of large motions."""

import numpy as np
import pytest
from slow_values import mostly_slow

import beamfem as bf

SQUARE, STEEL = bf.Rectangle(0.01, 0.01), bf.Material(2.1e11, 0.3, 7850.0)
STIFF, LIGHT = bf.Material(2.1e13, 0.3, 1e-3), bf.Material(2.1e11, 0.3, 1e-6)
ELEMENTS = bf.CRBF(3), bf.CRBF(1), bf.ANCFCRBF(bf.Structural()), bf.ANCF(bf.Structural())


@pytest.mark.parametrize("element", ELEMENTS[::2], ids=lambda element: element.name)
def test_a_mass_slides_down_an_inclined_plane(element):
    along = np.array([np.cos(0.5), -np.sin(0.5)])
    plane = bf.Beam(bf.Line((0, 0), tuple(along)), 6, element, bf.Rectangle(0.1, 0.1), STIFF)
    place = 0.1 * along
    carriage = bf.Beam(bf.Line(tuple(place), (place[0], place[1] + 0.1)), 1, bf.CRBF(2), SQUARE, LIGHT)
    slider = bf.SliderOnBeam(plane, carriage.start)
    ball = bf.PointMass(carriage.start, 2.0)
    ends = [bf.Clamp(plane.start), bf.Clamp(plane.end)]
    model = bf.Model([plane, carriage], ends, [bf.Gravity((0, -9.81))], connectors=[slider], masses=[ball])
    motion = bf.simulate(model, duration=0.55, step=5e-3)
    distance = motion.position(carriage.start) @ along - 0.1
    assert distance[-1] > 0.7
    assert distance == pytest.approx(0.5 * 9.81 * np.sin(0.5) * motion.at**2, abs=1e-6)
    weight = 2.0 * 9.81 * np.cos(0.5) * np.array([-along[1], along[0]])
    assert motion.joint_force(slider)[-1, :2] == pytest.approx(weight, rel=1e-2)


def pushed(element, down, elements=8, steps=40):
    """A rod whose foot slides along a cantilever, from 0.3 m to 0.75 m of it, while it is pushed down."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), elements, element, SQUARE, STEEL)
    rod = bf.Beam(bf.Line((0.3, 0.5), (0.3, 0)), 1, bf.CRBF(3), bf.Rectangle(0.1, 0.1), STIFF)
    hand = bf.Prescribed(
        rod.start, ux=lambda time: 0.45 * time, uy=lambda time: -down * min(10 * time, 1.0), rotation=0
    )
    slider = bf.SliderOnBeam(beam, rod.end)
    model = bf.Model([beam, rod], [bf.Clamp(beam.start), hand], connectors=[slider])
    return slider, bf.solve_static(model, steps=steps)


@pytest.mark.parametrize("element", ELEMENTS, ids=lambda element: element.name)
def test_small_deflections_of_a_cantilever_under_the_slider(element):
    """F = 3 EI d / a^3, with the shear and the axial terms of second order left out."""
    slider, found = pushed(element, 1e-4, elements=8 if element.name == "CRBF-3" else 64)
    place = found.position(slider.point)
    later = found.at > 0.15
    by_hand = 3 * 2.1e11 * 0.01**4 / 12 * 1e-4 / place[:, 0] ** 3
    assert found.joint_force(slider)[later, 1] == pytest.approx(by_hand[later], rel=1e-3)
    assert np.ptp(place[:, 0]) > 0.4


@pytest.mark.slow
@mostly_slow("element", ELEMENTS[::2], ids=lambda element: element.name)
def test_large_deflections_do_not_depend_on_elements_and_are_in_balance(element):
    slider, fine = pushed(bf.CRBF(6), 0.2)
    own, found = pushed(element, 0.2, elements=16 if element.name == "CRBF-3" else 64)
    exact, forces = fine.joint_force(slider), found.joint_force(own)
    assert np.abs(exact).max() > 1000.0
    assert forces == pytest.approx(exact, abs=1e-3 * np.abs(exact).max())
    later = exact[found.at > 0.2, :2]
    assert np.abs(np.diff(later, 2, axis=0)).max() < 0.01 * np.abs(later).max()
    on_all = found.connector_force(own)[:, :, :2].sum(axis=1)
    assert on_all == pytest.approx(np.zeros_like(on_all), abs=1e-9 * np.abs(exact).max())
    (x, y), (fx, fy) = found.position(own.point)[-1], forces[-1, :2]
    assert found.reaction(found.model.supports[0].point)[-1] == pytest.approx([fx, fy, x * fy - y * fx], rel=1e-6)


def test_the_work_of_the_slider_is_the_energy_of_the_beam():
    """Work by the trapezoid rule, extrapolated."""
    work = []
    for steps in (40, 80):
        slider, found = pushed(bf.CRBF(3), 0.2, steps=steps)
        force, place = found.joint_force(slider)[:, :2], found.position(slider.point)
        work.append(-0.5 * np.sum((force[1:] + force[:-1]) * np.diff(place, axis=0)))
    assert (4 * work[1] - work[0]) / 3 == pytest.approx(found.energy().strain[-1], rel=3e-4)


def test_a_mass_slides_along_a_bending_cantilever_without_loss():
    beam = bf.Beam(bf.Line((0, 0), (1, -0.5)), 4, bf.CRBF(4), SQUARE, STEEL)
    carriage = bf.Beam(bf.Line((0.4, -0.2), (0.4, 0.1)), 1, bf.CRBF(2), SQUARE, LIGHT)
    slider = bf.SliderOnBeam(beam, carriage.start)
    mass, clamp, weight = bf.PointMass(carriage.start, 2.0), bf.Clamp(beam.start), bf.Gravity((0, -9.81))
    model = bf.Model([beam, carriage], [clamp], [weight], connectors=[slider], masses=[mass])
    motion = bf.simulate(model, duration=0.5, step=2e-3)
    energy = motion.energy()
    assert energy.total == pytest.approx(energy.total[0], abs=1e-4 * energy.kinetic.max())
    assert motion.position(carriage.start)[-1, 0] > 0.8
    assert motion.displacement(beam.end)[-1, 1] < -0.02


def test_it_is_saved_loaded_and_drawn_and_refuses_what_it_cannot_slide_on(tmp_path):
    slider, found = pushed(bf.CRBF(3), 0.01, steps=2)
    found.save(tmp_path / "a.h5")
    loaded = bf.load(tmp_path / "a.h5")
    assert loaded.multipliers(loaded.model.connectors[0]) == pytest.approx(found.multipliers(slider))
    found.plot(tmp_path / "a.png")
    table = found.to_pandas(forces=True)
    assert table[table["kind"] == "SliderOnBeam"]["fy"].to_numpy() == pytest.approx(found.joint_force(slider)[:, 1])
    with pytest.raises(bf.InputError, match="must be on another beam"):
        bf.SliderOnBeam(slider.beam, slider.beam.end)
    with pytest.raises(bf.InputError, match="SliderOnBeam needs r_x as a coordinate"):
        pushed(bf.ShearRigid(), 0.01, steps=2)
    twice = found.model.with_(connectors=[slider, bf.SliderOnBeam(slider.beam, slider.point)])
    with pytest.raises(bf.InputError, match=r"SliderOnBeam at .* are redundant"):
        bf.solve_static(twice)


def test_a_mass_vibrates_with_the_beam_and_along_it():
    """As one fixed to the middle of the beam, and on the spring that holds it there; the carriage turns freely."""
    beam = bf.Beam(bf.Line((0, 0), (1, 0)), 8, bf.CRBF(3), bf.Rectangle(0.02, 0.02), STEEL)
    carriage = bf.Beam(bf.Line((0.5, 0), (0.5, 0.2)), 2, bf.CRBF(3), SQUARE, LIGHT)
    clamps = [bf.Clamp(beam.start), bf.Clamp(beam.end)]
    slider, ball = bf.SliderOnBeam(beam, carriage.start), bf.PointMass(carriage.start, 5.0)
    spring = bf.Spring(carriage.start, (1e3, 0.0))
    riding = bf.Model([beam, carriage], [*clamps, spring], connectors=[slider], masses=[ball])
    fixed = bf.Model([beam], clamps, masses=[bf.PointMass(beam.at(0.5), 5.0)])
    _, along, across = bf.solve_modes(riding, 3).frequencies
    assert along == pytest.approx(np.sqrt(1e3 / 5.0) / (2 * np.pi), rel=1e-6)
    assert across == pytest.approx(bf.solve_modes(fixed, 1).frequencies[0], rel=1e-6)
