"""The part of the page on equilibrium paths, stability and vibration: each study against its literature."""

import os
from pathlib import Path

import numpy as np

from beamfem.view.html_page import Entry, Part, Table
from studies.stability import becks_column, column, deep_arches, follower_cantilever, lee_frame, williams_toggle


def part(folder: str | os.PathLike[str]) -> Part:
    """Run the studies, draw them into `folder` and say what they found."""
    place = Path(folder)
    found = [_lee(place), _arches(place), _toggle(place), _follower(place), _column(place), _beck(place)]
    rows = [row for rows, _ in found for row in rows]
    table = Table(
        "Loads against independent values",
        ["case", "computed", "reference", "relative difference"],
        [[name, f"{value:.8g}", f"{exact:.8g}", f"{value / exact - 1.0:+.0e}"] for name, value, exact in rows],
        "References by collocation, shooting and elliptic integrals. The arches' are of the inextensible elastica; "
        "at R/h = 5000 stretch alone changes their loads by some 1e-6.",
    )
    text = "Paths are traced by arc length through limit points in load and displacement, without a hint from the user."
    return Part("Paths, stability and vibration of frames", text, [entry for _, entry in found], [table])


Row = tuple[str, float, float]


def _lee(folder: Path) -> tuple[list[Row], Entry]:
    paths = lee_frame.main()
    lee_frame.draw(paths, folder / "lee_frame")
    finest = list(paths.values())[-1]
    rows = [
        (f"Lee's frame, limit {i + 1} [N]", point.load_factor, limit[0])
        for i, (point, limit) in enumerate(zip(finest.limit_points, lee_frame.LIMITS, strict=True))
    ]
    text = (
        f"Snap-through and snap-back of two rigidly joined beams: {len(finest)} points, {finest.iterations} iterations."
    )
    return rows, Entry("Lee's frame", folder / "lee_frame" / "path.svg", "", text)


def _arches(folder: Path) -> tuple[list[Row], Entry]:
    runs = deep_arches.main()
    deep_arches.draw(runs, folder / "deep_arches")
    rows = [
        (f"215 degree arch, {ends}, limit P R^2/EI", run.path.limit_points[0].load_factor, deep_arches.LIMITS[ends])
        for ends, run in runs.items()
    ]
    for run in runs.values():
        for point in run.path.bifurcations[:1]:
            if abs(point.load_factor - deep_arches.SIDESWAY) < 0.1:
                rows.append(("the same, hinged-hinged, sidesway", point.load_factor, deep_arches.SIDESWAY))
    text = "The hinged arch sways before its limit point; both branches of the sidesway are followed."
    return rows, Entry("Deep arches", folder / "deep_arches" / "paths.svg", "", text)


def _toggle(folder: Path) -> tuple[list[Row], Entry]:
    path, _ = williams_toggle.main()
    williams_toggle.draw(path, folder / "williams_toggle")
    rows = [
        (f"Williams' toggle, limit {i + 1} [lb]", point.load_factor, limit[0])
        for i, (point, limit) in enumerate(zip(path.limit_points, williams_toggle.LIMITS, strict=True))
    ]
    return rows, Entry("Williams' toggle", folder / "williams_toggle" / "shapes.svg", "", "Shapes up to 90 lb.")


def _follower(folder: Path) -> tuple[list[Row], Entry]:
    path = follower_cantilever.main()
    follower_cantilever.draw(path, folder / "follower_cantilever")
    tip = follower_cantilever.tip(follower_cantilever.main(5.0))[-1]
    names = ("x / L", "y / L", "angle")
    rows = [
        (f"follower force, P L^2/EI = 5, tip {name}", float(value), exact)
        for name, value, exact in zip(names, tip, follower_cantilever.PRINTED, strict=True)
    ]
    text = "A force that stays across the end section winds the cantilever up; no load is conservative here."
    return rows, Entry("Follower force", folder / "follower_cantilever" / "shapes.svg", "", text)


def _column(folder: Path) -> tuple[list[Row], Entry]:
    rows = [
        (f"column {ends}, L/h = {slenderness:.0f}, P L^2/EI", load, column.reissner(ends, slenderness))
        for (ends, slenderness), load in column.main((20.0,)).items()
    ]
    _, branch = column.buckled()
    column.draw(branch, folder / "column")
    angle = float(np.abs(branch.rotation(branch.model.beams[0].end))[-1])
    text = f"After the switch to the branch at the critical load the tip turns by {angle:.2f} rad along the elastica."
    return rows, Entry("Buckling and post-buckling", folder / "column" / "post-buckling.svg", "", text)


def _beck(folder: Path) -> tuple[list[Row], Entry]:
    branches = becks_column.main((1000.0,))
    becks_column.draw(branches, folder / "becks_column")
    rows = [("Beck's column, L/h = 1000, flutter P L^2/EI", branches[1000.0].flutter, becks_column.BECK)]
    text = "Two frequencies meet under a follower load; beyond, the growth is positive: flutter."
    return rows, Entry("Beck's column", folder / "becks_column" / "frequencies.svg", "", text)
