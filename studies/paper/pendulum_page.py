"""The part of the page on the falling pendulum: figures, computing times, and its motion for ParaView."""

from pathlib import Path

from beamfem.view.html_page import Entry, Part
from studies.paper import pendulum
from studies.paper.pendulum_figures import FIGURES, draw, table_of_times

CASES = {  # second moment of area [m^4], and what it means
    "printed": (
        pendulum.PRINTED,
        "I = 8.533e-6 m⁴ as printed: a rectangle 0.253 m deep. The thickness can change with ANCF coordinates, but "
        "not with rotations, so the two converge to different motions (x of the tip at 0.5 s: 0.324 and 0.301 m).",
    ),
    "thin": (
        pendulum.THIN,
        "I = 8.533e-9 m⁴: the 0.2 m x 0.008 m section of the same area. The paper did not compute this section; its "
        "claims are compared with it all the same.",
    ),
}
FILES = {".vtkhdf": 20, ".pvd": 160}  # steps of 0.5 ms from one state to the next; a .pvd has three files a state


def part(name: str, folder: Path) -> Part:
    """Run one case, draw its figures, write its ParaView files and return the part of the page."""
    second_moment, text = CASES[name]
    runs = pendulum.main(second_moment)
    entries = [draw(figure, runs, folder) for figure in FIGURES]
    holding = sum(bool(entry.holds) for entry in entries)
    film = runs["bilinear-CRBF", 12].solution.animate(folder / "fall.gif", seconds=3.0)
    fall = Entry("The pendulum falls", film, "", f"12 bilinear elements; {holding} of the {len(entries)} claims hold.")
    for element in pendulum.ELEMENTS:
        solution = runs[element.name, 12].solution
        for suffix, every in FILES.items():
            solution[::every].to_vtk(folder / "paraview" / f"{element.name}{suffix}")
        solution.plot(folder / f"shapes-{element.name}.png")
    return Part(f"Falling pendulum, {name} section", text, [fall, *entries], [table_of_times(runs, name)])
