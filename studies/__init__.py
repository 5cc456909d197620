"""Studies, one file each: `main(**parameters)` returns its result; `python -m studies.paper.rollup` prints it."""
