"""Mechanisms of the page against closed forms and rigid-body equations."""

import pytest

from studies.mechanisms import page

LIMITS = {
    "slider-crank, torque": 1e-5,
    "four-bar, torque of the crank": 1e-7,
    "four-bar, bending of the rocker": 2e-4,
    "double pendulum, position of the tip": 1e-5,
    "arm, stretch when it turns steadily": 1e-5,
    "Scott-Russell pair, height": 5e-5,
    "Scott-Russell pair, torque": 2e-5,
    "Scott-Russell pair, telescope": 5e-6,
    "gripper, force on the object": 1e-8,
    "gripper, torque": 1e-8,
    "scissor lift, force at the foot": 1e-5,
}


@pytest.mark.slow
def test_mechanisms_agree_with_rigid_bodies_and_closed_forms(tmp_path):
    """Deflection of second order leaves 2e-4 of the rocker's bending."""
    rows, entries = page.compared(tmp_path)
    assert len(entries) == 2 * len(page.STUDIES)
    assert sorted(tmp_path.glob("*/*.*")) == sorted(entry.picture for entry in entries)
    found = dict(rows)
    assert set(found) == set(LIMITS)
    for name, limit in LIMITS.items():
        assert found[name] < limit, name
