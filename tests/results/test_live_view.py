"""A motion that is watched: a dummy of a notebook, of a window, and nothing at all."""

import numpy as np
import pytest
from matplotlib import pyplot

import beamfem as bf
from beamfem.view import live_view


@pytest.fixture
def model():
    beam = bf.Beam(bf.Line((0, 0), (1.2, 0)), 4, bf.CRBF(2), bf.Rectangle(0.04, 0.04), bf.Material(0.7e6, 0.3, 5540.0))
    return bf.Model([beam], [bf.Pin(beam.start)], [bf.Gravity((0, -9.81))])


class Handle:
    """What IPython's display returns; keeps the pictures and what they say."""

    def __init__(self):
        self.titles, self.pictures = [], []

    def update(self, picture, raw):
        self.pictures.append(picture["image/png"])
        self.titles.append(picture["text/plain"])


@pytest.fixture
def handle(monkeypatch):
    """A notebook whose pictures are kept."""
    pytest.importorskip("IPython")
    shown = Handle()
    monkeypatch.setattr(live_view, "in_notebook", lambda: True)
    monkeypatch.setattr("IPython.display.display", lambda picture, raw, display_id: shown)
    return shown


@pytest.mark.parametrize("how", [{"step": 1e-3}, {"tolerance": 1e-4}, {"step": 1e-3, "file": "motion.h5"}])
def test_a_picture_of_a_notebook_renews_itself_and_changes_no_number(model, handle, how, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(live_view, "_SHARE", 1.0)
    monkeypatch.setattr("beamfem.solve.motion.time_marching._FIRST_CHUNK", 1000)
    monkeypatch.setattr("beamfem.solve.motion.long_runs._STEPS", 64)
    seen = bf.simulate(model, 1.0, **how, watch=True)
    assert len(handle.pictures) > 1
    assert len({hash(picture) for picture in handle.pictures}) == len(handle.pictures)
    moments = [float(title.split()[2]) for title in handle.titles]
    assert moments == sorted(moments)
    blind = bf.simulate(model, 1.0, **(how | ({"file": "blind.h5"} if "file" in how else {})))
    np.testing.assert_array_equal(seen.p, blind.p)
    if "file" in how:
        bf.resume("motion.h5", duration=1.2, watch=True)
        assert handle.titles[-1] > handle.titles[len(moments) - 1]


def test_a_notebook_renews_one_picture(model, monkeypatch):
    """Found in a notebook: each picture was displayed below the one before."""
    shell = pytest.importorskip("IPython.core.interactiveshell").InteractiveShell
    from IPython.utils.capture import capture_output

    monkeypatch.setattr(live_view, "in_notebook", lambda: True)
    monkeypatch.setattr(live_view, "_SHARE", np.inf)
    show, state = live_view.live_view(model), bf.simulate(model, 0.1, 0.1)[-1]
    shell.instance()
    try:
        with capture_output() as shown:
            for at in (0.0, 0.1):
                show(at, np.array([state.p, state.v, np.zeros_like(state.p)]))
    finally:
        shell.clear_instance()
    assert [output.update for output in shown.outputs] == [False, True, True]
    assert len({output.transient["display_id"] for output in shown.outputs}) == 1


def test_drawing_takes_a_twentieth_of_the_time(model, monkeypatch):
    """By a clock that goes on by 10 ms for a picture and by 1 ms for a step."""
    now, pictures = [0.0], []
    monkeypatch.setattr(live_view.clock, "perf_counter", lambda: now[0])

    def present(figure):
        pictures.append(now[0])
        now[0] += 0.01
        return True

    view = live_view.LiveView(model, live_view.empty_figure(4, 3, layout=None), present)
    start = bf.simulate(model, 0.1, 0.1)[-1]
    while now[0] < 10.0:
        view.show(now[0], np.array([start.p, start.v, start.v]))
        now[0] += 1e-3
    assert len(pictures) == pytest.approx(0.05 * now[0] / 0.01, abs=2.0)


def test_a_window_is_drawn_until_it_is_closed(model, monkeypatch):
    canvas = type(pyplot.figure().canvas)
    drawn = []
    monkeypatch.setattr(live_view, "in_notebook", lambda: False)
    monkeypatch.setattr(live_view, "has_display", lambda: True)
    monkeypatch.setattr(live_view, "_SHARE", np.inf)
    monkeypatch.setattr(canvas, "required_interactive_framework", "dummy", raising=False)
    monkeypatch.setattr(canvas, "flush_events", lambda self: drawn.append(self.draw()))
    monkeypatch.setattr(pyplot, "show", lambda block: None)
    show, state = live_view.live_view(model), bf.simulate(model, 0.1, 0.1)[-1]
    rows = np.array([state.p, state.v, np.zeros_like(state.p)])
    for at in (0.0, 0.1, 0.2):
        show(at, rows)
    assert len(drawn) == 4  # an empty one first
    pyplot.close("all")
    show(0.3, rows)
    show(0.4, rows)
    assert len(drawn) == 4


def test_nothing_is_shown_without_a_display_and_a_notebook(model, monkeypatch):
    for name in ("in_notebook", "has_display"):
        monkeypatch.setattr(live_view, name, lambda: False)
    monkeypatch.setattr(live_view, "LiveView", None)
    assert len(bf.simulate(model, 0.01, 1e-3, watch=True)) == 11
    monkeypatch.setattr(live_view, "has_display", lambda: True)  # but the backend of matplotlib has no windows
    assert len(bf.simulate(model, 0.01, 1e-3, watch=True)) == 11
    with pytest.raises(bf.InputError, match="watch"):
        bf.simulate(model, 0.01, 1e-3, watch="yes")
