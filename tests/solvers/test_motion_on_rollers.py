"""Motions of points that inclined rollers guide: they stay on their planes, however many steps there are."""

import numpy as np
import pytest

import beamfem as bf

SECTION, SOFT = bf.Rectangle(0.02, 0.0625), bf.Material(1e9, 0.3, 1000.0)
NORMAL = np.array([-0.9998623450816866, 0.016591892229347906])


def rotated(vector, angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]]) @ vector


def pushed(element, angle):
    """A clamped beam whose end leans on a plane, pushed against it in the middle; all of it rotated."""
    beam = bf.Beam(bf.Line((0.0, 0.0), rotated((1.0, 0.0), angle)), 2, element, SECTION, SOFT)
    supports = [bf.Clamp(beam.start), bf.Roller(beam.end, rotated(NORMAL, angle))]
    return bf.Model([beam], supports, [bf.PointForce(beam.at(0.5), rotated((200.0, 0.0), angle))])


def star(angle):
    """So many beams that meet in a point that the tangent is no band; the end of the first one leans on a plane."""
    directions = angle + 2.0 * np.pi * np.arange(24) / 24.0
    lines = [bf.Line((0.0, 0.0), (np.cos(turn), np.sin(turn))) for turn in directions]
    beams = [bf.Beam(line, 2, bf.CRBF(2), SECTION, SOFT) for line in lines]
    joints = [bf.Rigid(beams[0].start, other.start) for other in beams[1:]]
    supports = [bf.Clamp(beams[12].end), bf.Roller(beams[0].end, rotated(NORMAL, angle))]
    return bf.Model(beams, supports, [bf.PointForce(beams[0].at(0.5), rotated((200.0, 0.0), angle))], joints)


def guided(model, duration, steps):
    """Return the displacement of the guided end, and the drift of the energy, of a motion without damping."""
    motion = bf.simulate(model, duration, duration / steps, bf.GeneralizedAlpha(1.0))
    energy = motion.energy()
    size = max(energy.kinetic.max(), np.ptp(energy.potential), np.ptp(energy.strain))
    return motion.displacement(model.beams[0].end), float(np.abs(energy.total - energy.total[0]).max() / size)


@pytest.mark.parametrize("element", [bf.CRBF(4), bf.CRBF(2), bf.ANCF(), bf.BilinearCRBF()], ids=lambda e: e.name)
@pytest.mark.parametrize("steps", [100, 200, 1000])
def test_a_beam_stays_on_the_plane_it_leans_on(element, steps):
    """Round-off along the normal once doubled every few steps, until there was more energy than anything put in."""
    moved, drift = guided(pushed(element, 0.4), 0.0437, steps)
    assert np.abs(moved @ rotated(NORMAL, 0.4)).max() < 1e-14
    assert np.abs(moved).max() > 5e-5
    assert drift < 5e-3


@pytest.mark.parametrize("made", [lambda angle: pushed(bf.CRBF(4), angle), star], ids=["band", "sparse"])
def test_an_inclined_plane_and_one_along_an_axis_guide_alike(made):
    """Along an axis the plane prescribes a coordinate."""
    along_axis = np.pi - np.arctan2(NORMAL[1], NORMAL[0])
    angle = 0.7
    inclined, drift = guided(made(along_axis + angle), 0.0437, 200)
    prescribed, _ = guided(made(along_axis), 0.0437, 200)
    expected = np.array([rotated(row, angle) for row in prescribed])
    assert np.abs(expected).max() > 1e-4
    assert np.abs(inclined - expected).max() < 1e-6 * np.abs(expected).max()
    assert drift < 5e-3
