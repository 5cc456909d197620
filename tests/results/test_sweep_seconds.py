"""The duration of a point of a sweep is that of its call: nobody's compilation, and that of a failed call too."""

import json
import os
import subprocess
import sys
import textwrap
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial

import numpy as np
import pytest
from slow_values import mostly_slow

import beamfem as bf

SCRIPT = """
    import json
    import sys
    from concurrent.futures import ProcessPoolExecutor
    from functools import partial
    from time import perf_counter

    import beamfem as bf

    def tip(load):
        beam = bf.Beam(bf.Line((0, 0), (1, 0)), 4, bf.CRBF(2), bf.Rectangle(0.01, 0.01), bf.Material(2e11, 0.3, 7800.0))
        model = bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, load))])
        return bf.solve_static(model).displacement(beam.end)[-1, 1]

    if __name__ == "__main__":
        executor = partial(ProcessPoolExecutor, 1) if sys.argv[1] == "pool" else None
        begun = perf_counter()
        found = bf.sweep(tip, load=[1.0, 1.1, 1.2, 1.3], executor=executor)
        print(json.dumps([found.seconds.tolist(), perf_counter() - begun]))
"""


@pytest.mark.slow
@mostly_slow("where", ["here", "pool"], quick=(1,))
def test_the_first_point_does_not_count_what_is_compiled_for_it(where, tmp_path):
    (tmp_path / "swept.py").write_text(textwrap.dedent(SCRIPT))
    root = os.path.dirname(os.path.dirname(bf.__file__))
    about = os.environ | {"BEAMFEM_CACHE_DIR": str(tmp_path / "empty"), "PYTHONPATH": root}
    run = subprocess.run(
        [sys.executable, tmp_path / "swept.py", where], capture_output=True, text=True, check=True, env=about
    )
    seconds, whole = json.loads(run.stdout)
    assert seconds[0] < 0.25 * whole, (seconds, whole)
    assert sum(seconds[1:]) < 0.25 * whole


def slowly_wrong(x):
    time.sleep(0.05)
    if x == 2:
        os._exit(3)
    raise ValueError("never right")


@pytest.mark.slow
def test_failed_points_tell_how_long_they_took():
    found = bf.sweep(slowly_wrong, x=[1, 2, 3], executor=partial(ProcessPoolExecutor, 1))
    assert len(found.failures) == 3
    assert np.all(found.seconds >= 0.05)


def test_points_that_were_not_reached_have_no_duration():
    def interrupted(x):
        if x == 2:
            raise KeyboardInterrupt
        return x

    with pytest.raises(KeyboardInterrupt) as caught:
        bf.sweep(interrupted, x=[1, 2, 3])
    assert np.isnan(caught.value.sweep.seconds).tolist() == [False, True, True]
