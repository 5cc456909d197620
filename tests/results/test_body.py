"""The solid body: pictures without a window, and what happens where VTK cannot render."""

import numpy as np
import pytest
from drawn import cantilever, pendulum, share_of_ink
from matplotlib import image
from matplotlib.figure import Figure

import beamfem as bf
from beamfem.view import rendering
from beamfem.view import solid_pyvista as body
from beamfem.view.deformed_shapes import Shapes

renders = pytest.mark.skipif("not __import__('beamfem.view.rendering').view.rendering.can_render()")


@pytest.fixture(scope="module")
def bent():
    return cantilever()


def test_surface_encloses_the_volume_of_the_beam(bent):
    """Width, height and faces turned outwards: area 1e-4 m^2 times length 1 m."""
    pyvista = pytest.importorskip("pyvista")
    shapes = Shapes(bent, np.array([0]))
    scene = body._Scene.__new__(body._Scene)
    scene.shapes = shapes
    faces = body._faces(shapes.points, [len(parts) for parts in scene._parts(0)])
    surface = pyvista.PolyData(scene._points(0), faces).triangulate().clean()
    assert surface.n_open_edges == 0
    assert surface.volume == pytest.approx(1e-4, rel=1e-9)


def test_tapered_sections_are_as_wide_as_their_area_says():
    beam = bf.Beam(
        bf.Line((0, 0), (1, 0)), 2, bf.CRBF(2), lambda s: bf.Rectangle(0.05, 0.1 - 0.05 * s), bf.Material(1e9, 0.3, 1.0)
    )
    solution = bf.solve_static(bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0.0, 1.0))]))
    np.testing.assert_allclose(body._width(Shapes(solution, np.array([0])).points[0]), 0.05, rtol=1e-12)


@renders
def test_picture_of_the_body(bent, tmp_path):
    path = bent.picture(tmp_path / "new" / "body.png", colour="moment", size=(600, 400))
    found = image.imread(path) * 255
    assert found.shape[:2] == (400, 600)
    assert 0.01 < share_of_ink(found) < 0.5


@renders
def test_a_picture_without_a_display_is_silent_and_errors_are_not(bent, tmp_path, monkeypatch, capfd):
    """VTK looks for an X server first and complained on stderr that there is none."""
    for name in ("DISPLAY", "WAYLAND_DISPLAY"):
        monkeypatch.delenv(name, raising=False)
    logger = pytest.importorskip("vtkmodules.vtkCommonCore").vtkLogger
    before = logger.GetCurrentVerbosityCutoff()
    bent.picture(tmp_path / "body.png", size=(60, 40))
    assert capfd.readouterr().err == ""
    assert logger.GetCurrentVerbosityCutoff() == before
    with rendering.no_display_needed():
        logger.Log(logger.VERBOSITY_WARNING, "here", 1, "no display")
        logger.Log(logger.VERBOSITY_ERROR, "here", 1, "an error")
    said = capfd.readouterr().err
    assert "an error" in said
    assert "no display" not in said


@renders
def test_a_picture_leaves_no_window_behind(bent, tmp_path, monkeypatch):
    pyvista = pytest.importorskip("pyvista")
    made, begin = [], pyvista.Plotter.__init__

    def noted(plotter, *given, **named):
        made.append(plotter)
        begin(plotter, *given, **named)

    monkeypatch.setattr(pyvista.Plotter, "__init__", noted)
    bent.picture(tmp_path / "body.png", size=(60, 40))
    (plotter,) = made
    assert plotter.render_window is None


@renders
def test_slider_moves_the_body():
    solution = pendulum()
    plotter = body.slider_scene(solution, "moment", (300, 200), off_screen=True)
    (slider,) = plotter.widgets.slider_widgets
    (mesh,) = [mesh for mesh in plotter.meshes if "field" in mesh.array_names]
    end = solution.model.beams[0].end
    np.testing.assert_allclose(mesh.points[-4:, :2].mean(axis=0), solution.position(end)[-1], atol=1e-6)
    slider.GetRepresentation().SetValue(0.0)
    slider.InvokeEvent("InteractionEvent")
    np.testing.assert_allclose(mesh.points[-4:, :2].mean(axis=0), [1.0, 0.0], atol=1e-6)
    plotter.close()


def test_where_vtk_cannot_render_matplotlib_draws(bent, tmp_path, monkeypatch):
    monkeypatch.setattr(body, "can_render", lambda: False)
    with pytest.warns(UserWarning, match="VTK cannot render here, so .* is drawn flat by matplotlib; .*libegl1"):
        path = bent.picture(tmp_path / "body.png")
    assert share_of_ink(image.imread(path) * 255) > 0.003


def test_show_without_a_display_returns_a_figure(bent, monkeypatch):
    monkeypatch.setattr(body, "has_display", lambda: False)
    with pytest.warns(UserWarning, match="there is no display"):
        assert isinstance(bent.show(), Figure)


def test_a_renderer_that_kills_its_process_is_found_out(monkeypatch):
    rendering.can_render.cache_clear()
    monkeypatch.setattr(rendering, "_PROBE", "\nimport signal\nos.kill(os.getpid(), signal.SIGSEGV)")
    assert not rendering.can_render()
    rendering.can_render.cache_clear()


@pytest.mark.parametrize(
    ("options", "message"),
    [({"row": 7}, "row must be between"), ({"colour": "torsion"}, "no quantity")],
)
def test_what_cannot_be_shown_is_named(bent, tmp_path, monkeypatch, options, message):
    monkeypatch.setattr(body, "can_render", lambda: True)
    with pytest.raises(bf.InputError, match=message):
        bent.picture(tmp_path / "body.png", **options)
    with pytest.raises(bf.InputError, match=r"body\.png"):
        bent.picture(tmp_path / "body.jpg")
