"""The part of the page on mechanisms: each study against its closed form or rigid-body equation."""

import os
from collections.abc import Callable
from pathlib import Path

import numpy as np

import beamfem as bf
from beamfem.view.html_page import Entry, Part, Table
from studies.mechanisms import (
    double_pendulum,
    four_bar,
    gripper,
    scissor_lift,
    scott_russell,
    slider_crank,
    spin_up,
)

Row = tuple[str, float]
Study = tuple[list[Row], bf.Solution, Entry]


def part(folder: str | os.PathLike[str]) -> Part:
    """Run the studies, draw them into `folder` and say what they found."""
    rows, entries = compared(Path(folder))
    table = Table(
        "Largest relative differences from closed forms and rigid bodies",
        ["case", "difference"],
        [[name, f"{value:.0e}"] for name, value in rows],
        "Small forces are taken where a closed form is of small deflections.",
    )
    text = "Beams with hinges, sliders, gears, motors and masses; a rigid part is a beam of a stiff material."
    return Part("Mechanisms", text, entries, [table])


def compared(folder: Path) -> tuple[list[Row], list[Entry]]:
    """Return the differences of all studies, and a picture and an animation of each."""
    rows: list[Row] = []
    entries: list[Entry] = []
    for study in STUDIES:
        found, solution, entry = study(folder)
        film = solution.animate(entry.picture.parent / "motion.gif", seconds=3.0, loads=False)
        rows += found
        entries += [entry, Entry(f"{entry.title}, animation", film, "", "")]
    return rows, entries


def _slider_crank(folder: Path) -> Study:
    runs = slider_crank.main()
    rigid = slider_crank.rigid_torque(runs["stiff rod"].motion.time)
    apart = {name: float(np.abs(run.torque - rigid).max() / np.abs(rigid).max()) for name, run in runs.items()}
    text = f"A flexible rod changes the torque of the motor by up to {apart['flexible rod']:.0%}."
    picture = slider_crank.draw(runs, folder / "slider_crank")
    rows = [("slider-crank, torque", apart["stiff rod"])]
    return rows, runs["flexible rod"].motion, Entry("Slider-crank", picture, "", text)


def _four_bar(folder: Path) -> Study:
    turned, motor = four_bar.main()
    torque, bent = four_bar.differences(turned, motor)
    rows = [("four-bar, torque of the crank", torque), ("four-bar, bending of the rocker", bent)]
    picture = four_bar.draw(turned, folder / "four_bar")
    return rows, turned, Entry("Four-bar linkage", picture, "", "One turn of the crank.")


def _double_pendulum(folder: Path) -> Study:
    motion = double_pendulum.main()
    picture = double_pendulum.draw(motion, folder / "double_pendulum")
    rows = [("double pendulum, position of the tip", double_pendulum.difference(motion))]
    return rows, motion, Entry("Double pendulum", picture, "", "It falls from rest along x for one second.")


def _spin_up(folder: Path) -> Study:
    motion = spin_up.main()
    stretch = np.hypot(*motion.position(motion.model.beams[0].end)[-1]) - spin_up.LENGTH
    rows = [("arm, stretch when it turns steadily", float(abs(stretch / (spin_up.radius() - spin_up.LENGTH) - 1.0)))]
    text = f"The tip lags by up to {-spin_up.lag(motion).min():.3f} m behind a straight arm while it speeds up."
    return rows, motion, Entry("Spin-up of an arm", spin_up.draw(motion, folder / "spin_up"), "", text)


def _scott_russell(folder: Path) -> Study:
    lifted, motors = scott_russell.main()
    unloaded, _ = scott_russell.main(0.0)
    rows = [
        (f"Scott-Russell pair, {name}", value)
        for name, value in scott_russell.differences(lifted, unloaded, motors).items()
    ]
    text = "Both heads move straight up; the telescope between them slides."
    return rows, lifted, Entry("Scott-Russell pair", scott_russell.draw(lifted, folder / "scott_russell"), "", text)


def _gripper(folder: Path) -> Study:
    gripped, motor = gripper.main()
    force, torque = gripper.reference(gripper.TURN)
    rows = [
        ("gripper, force on the object", float(abs(gripper.force(gripped)[-1] / force - 1.0))),
        ("gripper, torque", float(abs(gripped.joint_force(motor)[-1, 2] / torque + 1.0))),
    ]
    text = f"Fingers of large deflection press on a spring with {force:.2f} N."
    return rows, gripped, Entry("Compliant gripper", gripper.draw(gripped, folder / "gripper"), "", text)


def _scissor_lift(folder: Path) -> Study:
    raised = scissor_lift.main()
    rows = [("scissor lift, force at the foot", scissor_lift.difference(raised))]
    text = f"{scissor_lift.STAGES} stages, {len(raised.model.beams)} bars, {len(raised.model.joints)} hinges."
    return rows, raised, Entry("Scissor lift", scissor_lift.draw(raised, folder / "scissor_lift"), "", text)


STUDIES: tuple[Callable[[Path], Study], ...] = (
    _slider_crank,
    _four_bar,
    _double_pendulum,
    _spin_up,
    _scott_russell,
    _gripper,
    _scissor_lift,
)
