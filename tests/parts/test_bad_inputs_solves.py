"""Bad questions to the solvers and to their results get an error that names them before the work."""

import numpy as np
import pytest
from bad_inputs import BEAM, CANTILEVER, END, NAN, a_beam, require_named
from slow_values import mostly_slow

import beamfem as bf

BAD = bf.InputError
FREE = bf.Model([BEAM])
SECTION, STEEL = bf.Rectangle(0.01, 0.01), bf.Material(2.1e11, 0.3, 7850.0)


def double(x):
    return 2.0 * x


def leaning():
    """Nine unknown coordinates, two of which an inclined roller lets move together only."""
    beam = a_beam(elements=1)
    return bf.Model([beam], [bf.Roller(beam.end, (1, 1))])


def feather():
    """A cantilever that its load would move by 1e165 of its length."""
    beam = a_beam(material=bf.Material(1e-6, 0.3, 1.0))
    return bf.Model([beam], [bf.Clamp(beam.start)], [bf.PointForce(beam.end, (0, 1e150))])


SOLVES = {
    "statics of a beam": (lambda: bf.solve_static(BEAM), BAD, "a Model is asked for"),
    "statics of a class": (lambda: bf.solve_static(bf.Model), BAD, "a Model is asked for"),
    "no load steps": (lambda: bf.solve_static(CANTILEVER, steps=0), BAD, "steps must be at least 1"),
    "newton as a mapping": (lambda: bf.solve_static(CANTILEVER, newton={}), BAD, "newton must be a Newton"),
    "newton as a class": (lambda: bf.solve_static(CANTILEVER, newton=bf.Newton), BAD, "newton must be a Newton"),
    "a misspelt snap": (lambda: bf.solve_static(CANTILEVER, snap="jumb"), BAD, 'did you mean "jump"'),
    "statics of a free beam": (lambda: bf.solve_static(FREE), bf.FreeMotionError, "can move freely"),
    "negative tolerance": (lambda: bf.Newton(tolerance=-1e-9), BAD, "tolerance of Newton must be greater"),
    "tolerance of the model": (lambda: bf.Newton(tolerance=1.0), BAD, "below 1"),
    "negative residual tolerance": (lambda: bf.Newton(residual_tolerance=-1.0), BAD, "residual_tolerance"),
    "no iterations": (lambda: bf.Newton(iterations=0), BAD, "iterations of Newton must be at least 1"),
    "half an iteration": (lambda: bf.Newton(iterations=2.5), BAD, "iterations of Newton must be a whole"),
    "stresses of words": (lambda: bf.Newton(independent_stresses="no"), BAD, "independent_stresses"),
    "rho beyond one": (lambda: bf.GeneralizedAlpha(1.1), BAD, "lies between 0 and 1"),
    "rho as text": (lambda: bf.GeneralizedAlpha("0.9"), BAD, "rho_inf of GeneralizedAlpha must be a number"),
    "velocity of text": (lambda: bf.RigidVelocity("ab"), BAD, "vector of RigidVelocity"),
    "spin of nan": (lambda: bf.RigidVelocity(angular=NAN), BAD, "angular of RigidVelocity"),
    "negative duration": (lambda: bf.simulate(FREE, -1.0, 1e-3), BAD, "duration must be greater"),
    "duration as text": (lambda: bf.simulate(FREE, "1", 1e-3), BAD, "duration must be a number"),
    "zero step": (lambda: bf.simulate(FREE, 1.0, 0.0), BAD, "step must be greater"),
    "step beyond duration": (lambda: bf.simulate(FREE, 1.0, 2.0), BAD, "must not exceed"),
    "step of 1e-300": (lambda: bf.simulate(FREE, 1.0, 1e-300), BAD, "this computer has"),
    "save every half step": (lambda: bf.simulate(FREE, 1.0, 0.1, save_every=0.5), BAD, "save_every must be a whole"),
    "save beyond floats": (lambda: bf.simulate(FREE, 1.0, 0.1, save_every=10**400), BAD, "save_every must be at most"),
    "integrator by name": (lambda: bf.simulate(FREE, 1.0, 0.1, integrator="newmark"), BAD, "GeneralizedAlpha"),
    "integrator as a class": (lambda: bf.simulate(FREE, 1.0, 0.1, bf.GeneralizedAlpha), BAD, "GeneralizedAlpha"),
    "spin of 1e300": (lambda: bf.RigidVelocity(angular=1e300), BAD, "cannot square"),
    "start from text": (lambda: bf.simulate(FREE, 1.0, 0.1, start="a"), BAD, "start must be a state"),
    "velocity of numbers": (lambda: bf.simulate(FREE, 1.0, 0.1, velocity=(1, 0)), BAD, "velocity must be a Rigid"),
    "velocity of nothing": (lambda: bf.simulate(FREE, 1.0, 0.1, velocity=lambda x: None), BAD, "must be two numbers"),
    "path of a class": (lambda: bf.trace_equilibrium(bf.Model), BAD, "a Model is asked for"),
    "path until text": (lambda: bf.trace_equilibrium(CANTILEVER, "1"), BAD, "until must be a number"),
    "path until nothing": (lambda: bf.trace_equilibrium(CANTILEVER, lambda: True), BAD, "until .* state of the path"),
    "path until a number": (lambda: bf.trace_equilibrium(CANTILEVER, lambda s: 1), BAD, "until must return True or"),
    "path to the side": (lambda: bf.trace_equilibrium(CANTILEVER, direction=0), BAD, "direction must be 1 or -1"),
    "path towards True": (lambda: bf.trace_equilibrium(CANTILEVER, direction=True), BAD, "direction must be 1 or -1"),
    "path of arrays": (lambda: bf.trace_equilibrium(CANTILEVER, direction=np.ones(2)), BAD, "direction must be"),
    "path of no step": (lambda: bf.trace_equilibrium(CANTILEVER, step=0.0), BAD, "step must be greater"),
    "path of steps of round-off": (lambda: bf.trace_equilibrium(CANTILEVER, step=1e-300), BAD, "round-off only"),
    "path of no points": (lambda: bf.trace_equilibrium(CANTILEVER, points=0), BAD, "points must be at least 1"),
    "path of a feather": (lambda: bf.trace_equilibrium(feather()), bf.ConvergenceError, "loads closer to its stiff"),
    "buckling of a feather": (lambda: bf.solve_buckling(feather()), bf.ConvergenceError, "loads closer to its stiff"),
    "path from a point": (lambda: bf.trace_equilibrium(CANTILEVER, start=END), BAD, "start must be a bifurcation"),
    "no modes": (lambda: bf.solve_modes(CANTILEVER, 0), BAD, "count must be at least 1"),
    "too many modes": (lambda: bf.solve_modes(CANTILEVER, 10**6), BAD, "only .* unknown coordinates"),
    "modes about text": (lambda: bf.solve_modes(CANTILEVER, 1, "start"), BAD, "about must be a state"),
    "half a buckling load": (lambda: bf.solve_buckling(CANTILEVER, 0.5), BAD, "count must be a whole number"),
    "buckling about a number": (lambda: bf.solve_buckling(CANTILEVER, 1, 1.0), BAD, "about must be a state"),
    "a study of no parameter": (lambda: bf.converge(lambda n: n, refine="m", n=[1, 2]), BAD, "refine names"),
    "a study of a list": (lambda: bf.converge(lambda n: n, refine=["n"], n=[1, 2]), BAD, "refine names"),
    "a study of a number": (lambda: bf.converge(lambda n: n, 3, refine="n", n=[1, 2]), BAD, "must be a text"),
    "a study until zero": (lambda: bf.converge(lambda n: n, refine="n", n=[1, 2], until=0.0), BAD, "greater than zero"),
    "a study of nan": (lambda: bf.converge(lambda n: n, refine="n", n=[1, 2], reference=NAN), BAD, "must be finite"),
    "a study of a number's quantity": (lambda: bf.converge(double, "tip", refine="x", x=[1, 2]), BAD, "leave quantity"),
    "a sweep of a number": (lambda: bf.sweep(3, x=[1]), BAD, "the first argument must be a function"),
    "a column of unequal arrays": (lambda: bf.sweep(np.ones, shape=[1, 2])["ones"], BAD, "have different shapes"),
    "stability of a motion": (lambda: bf.simulate(FREE, 0.1, 0.1).stable, BAD, "this one is a motion"),
    "as many modes as unknowns on an inclined roller": (lambda: bf.solve_modes(leaning(), 9), BAD, "only 8 modes"),
    "stale results by words": (lambda: bf.sweep(abs, keep_stale="no", x=[1]), BAD, "keep_stale must be True or False"),
    "stale results by number": (lambda: bf.sweep(abs, keep_stale=0, x=[1]), BAD, "keep_stale must be True or False"),
    "a column of two names": (lambda: bf.sweep(double, x=[1, 2])[["x"]], BAD, r"no \['x'\]; known are x, double"),
    "a misspelt column": (lambda: bf.sweep(double, x=[1, 2])["doubel"], BAD, "did you mean double"),
    "steps as True": (lambda: bf.solve_static(CANTILEVER, steps=True), BAD, "steps must be a whole number"),
    "count of modes as True": (lambda: bf.solve_modes(CANTILEVER, True), BAD, "count must be a whole number"),
    "count of loads as True": (lambda: bf.solve_buckling(CANTILEVER, True), BAD, "count must be a whole number"),
    "points as True": (lambda: bf.trace_equilibrium(CANTILEVER, points=True), BAD, "points must be a whole number"),
    "save every True": (lambda: bf.simulate(FREE, 1.0, 0.1, save_every=True), BAD, "save_every must be a whole"),
    "iterations as True": (lambda: bf.Newton(iterations=True), BAD, "iterations of Newton must be a whole"),
    "a study of equal counts": (lambda: bf.converge(lambda n: n, refine="n", n=[2, 2]), BAD, "each once"),
}

# each takes a static solution of CANTILEVER and a folder
RESULTS = {
    "position of text": (lambda s, out: s.position("tip"), BAD, "a point is asked for"),
    "fields of a beam": (lambda s, out: s.fields(BEAM), BAD, "a point is asked for"),
    "a foreign point": (lambda s, out: s.rotation(a_beam().end), bf.UnknownPointError, "not in this model"),
    "reaction at a free end": (lambda s, out: s.reaction(END), BAD, "no support"),
    "forces of a point": (lambda s, out: s.section_forces(END), BAD, "a beam is asked for"),
    "spline of a point": (lambda s, out: s.spline(END), BAD, "a beam is asked for"),
    "spline of a polynomial": (lambda s, out: s.spline(BEAM), BAD, "no cubic spline"),
    "row as True": (lambda s, out: s[True], BAD, "a row of a solution"),
    "row as text": (lambda s, out: s["last"], BAD, "a row of a solution"),
    "every 0th row": (lambda s, out: s[::0], BAD, "rows of a solution are selected by whole numbers"),
    "rows from a half": (lambda s, out: s[0.5:], BAD, "rows of a solution are selected by whole numbers"),
    "no rows": (lambda s, out: s[5:4], BAD, "selects no row"),
    "time of statics": (lambda s, out: s.time, BAD, "use load_factor"),
    "a misspelt colour": (lambda s, out: s.plot(colour="momnt"), BAD, "did you mean moment"),
    "colour as a list": (lambda s, out: s.plot(colour=["moment"]), BAD, "no quantity"),
    "no shapes": (lambda s, out: s.plot(shapes=0), BAD, "shapes must be at least 1"),
    "supports by words": (lambda s, out: s.plot(supports="no"), BAD, "supports must be True or False"),
    "loads as a number": (lambda s, out: s.plot(loads=0), BAD, "loads must be True or False"),
    "picture of an unknown kind": (lambda s, out: s.plot(out / "x.xyz"), BAD, "a picture is a .png"),
    "picture at a number": (lambda s, out: s.plot(3.0), BAD, "a path is a text"),
    "picture at nothing": (lambda s, out: s.plot(""), BAD, "a path is a text"),
    "picture at bytes": (lambda s, out: s.plot(b"x.png"), BAD, "a path is a text"),
    "a history of a beam": (lambda s, out: s.plot_history(BEAM), BAD, "point must be a list"),
    "a history of no point": (lambda s, out: s.plot_history(), BAD, "needs a point"),
    "a history of numbers": (lambda s, out: s.plot_history([1, 2]), BAD, "needs a point"),
    "a misspelt history": (lambda s, out: s.plot_history(END, "rotatoin"), BAD, "did you mean rotation"),
    "a history of a list": (lambda s, out: s.plot_history(END, ["ux"]), BAD, "no history"),
    "load over time": (lambda s, out: s.plot_load_displacement(END, "uz"), BAD, "what the load is drawn over"),
    "film of no seconds": (lambda s, out: s.animate(out / "x.gif", seconds=0.0), BAD, "seconds must be greater"),
    "film of a million dots": (lambda s, out: s.animate(out / "x.gif", dpi=10**6), BAD, "dpi must be at most"),
    "film of another kind": (lambda s, out: s.animate(out / "x.avi"), BAD, "would be right"),
    "film without words": (lambda s, out: s.animate(out / "x.gif", loads=None), BAD, "loads must be True or False"),
    "body of a row beyond": (lambda s, out: s.picture(out / "x.png", row=9), BAD, "row must be between -2 and 1"),
    "body of a row of text": (lambda s, out: s.picture(out / "x.png", row="last"), BAD, "row must be a whole"),
    "body of one side": (lambda s, out: s.picture(out / "x.png", size=(100,)), BAD, "a width and a height"),
    "body of a huge side": (lambda s, out: s.picture(out / "x.png", size=(10**6, 10)), BAD, "at most 16384"),
    "window of text": (lambda s, out: s.show(size="big"), BAD, "size must be a list"),
    "page of another kind": (lambda s, out: s.to_html(out / "x.png"), BAD, "a page is a .html"),
    "page with a title of numbers": (lambda s, out: s.to_html(out / "x.html", title=3), BAD, "title must be a text"),
    "page of no frames": (lambda s, out: s.to_html(out / "x.html", frames=0), BAD, "frames must be at least 1"),
    "ParaView at nothing": (lambda s, out: s.to_vtk(None), BAD, "a path is a text"),
    "ParaView of another kind": (lambda s, out: s.to_vtk(out / "x.vtu"), BAD, "would be right"),
    "saved at a number": (lambda s, out: s.save(5), BAD, "a path is a text"),
    "saved at a zero byte": (lambda s, out: s.save("a\0b.h5"), BAD, "a path is a text"),
    "saved in place of a folder": (lambda s, out: s.save(out), bf.FileError, "is a folder; give the name"),
    "saved below a file": (lambda s, out: s.save(a_file(out) / "x.h5"), bf.FileError, "cannot be written"),
    "ParaView below a file": (lambda s, out: s.to_vtk(a_file(out) / "x.pvd"), bf.FileError, "cannot be made"),
    "mode beyond": (lambda s, out: bf.solve_modes(CANTILEVER, 1).solution(1), BAD, "mode must be between 0 and 0"),
    "mode as True": (lambda s, out: bf.solve_modes(CANTILEVER, 1).solution(True), BAD, "mode must be a whole"),
    "mode of no size": (lambda s, out: bf.solve_modes(CANTILEVER, 1).solution(0, 0.0), BAD, "amplitude must be"),
    "mode of 1e300 m": (lambda s, out: bf.solve_modes(CANTILEVER, 1).solution(0, 1e300), BAD, "cannot square"),
    "mode of one frame": (lambda s, out: bf.solve_modes(CANTILEVER, 1).solution(frames=1), BAD, "at least 2"),
}


def a_file(folder):
    file = folder / "file"
    file.write_text("")
    return file


@pytest.fixture(scope="module")
def solution():
    return bf.solve_static(CANTILEVER)


@pytest.mark.parametrize("case", SOLVES)
def test_bad_solves_are_named(case):
    require_named(*SOLVES[case])


@pytest.mark.parametrize("case", RESULTS)
def test_bad_questions_are_named(case, solution, tmp_path):
    ask, kind, words = RESULTS[case]
    require_named(lambda: ask(solution, tmp_path), kind, words)


def test_rows_beyond_the_last_end_a_loop(solution):
    with pytest.raises(IndexError, match="has 2 rows, so there is no row 1000"):
        solution[10**3]
    assert len(list(solution)) == 2


@pytest.mark.slow
@mostly_slow("modulus", [2e15, 2e31], quick=(1,))
def test_stiffnesses_too_far_apart_are_named_or_do_no_harm(modulus):
    """A bent cantilever with a rigid end has no critical load; 1e20 to 1 may leave the tangent no digits to tell."""
    arm, stiff = bf.Line((0, 0), (1, 0)), bf.Material(modulus, 0.3, 7800.0)
    beams = [a_beam(curve=arm, elements=3), a_beam(curve=bf.Line((1, 0), (2, 0)), elements=3, material=stiff)]
    loads = [bf.PointForce(beams[1].end, (-1.0, 1.0))]
    model = bf.Model(beams, [bf.Clamp(beams[0].start)], loads, [bf.Rigid(beams[0].end, beams[1].start)])
    try:
        found = bf.solve_buckling(model, 2)
    except bf.ConvergenceError as error:
        said, loads = str(error), []
    else:
        said, loads = found.ended, found.load_factors
    assert len(loads) == 0
    assert "no further" in said or (modulus > 1e20 and "the loading path was lost" in said)


def test_a_body_that_a_part_leaves_free_is_not_told_to_be_joined():
    """It was advised to add a joint between what a slider connects, which makes its conditions redundant."""
    bars = [bf.Beam(bf.Line((x, 0), (x + 1.0, 0)), 2, bf.CRBF(3), SECTION, STEEL) for x in (0.0, 1.0)]
    pull = [bf.PointForce(bars[1].end, (1.0, 0.0))]
    for part in (
        bf.Slider(bars[0].end, bars[1].start, (1, 0)),
        bf.Bushing(bars[0].end, bars[1].start, (0.0, 1e3, 10.0)),
    ):
        model = bf.Model(bars, [bf.Clamp(bars[0].start)], pull, connectors=[part])
        with pytest.raises(bf.FreeMotionError, match="beam 1 can move freely: it translates along x") as error:
            bf.solve_static(model)
        assert "no joint connects" not in str(error.value)


def test_a_law_that_is_not_defined_everywhere_ends_a_motion_with_what_was_found():
    """A raw error of linear algebra came from a place far away, at which its damping was looked for."""
    bar = bf.Beam(bf.Line((0, 0), (1, 0)), 2, bf.CRBF(3), SECTION, STEEL)
    spring = bf.SpringDamper(bar.end, (1.0, 1.0), lambda stretch, f: f.sqrt(1e-3 + stretch))
    model = bf.Model([bar], [bf.Clamp(bar.start)], [bf.PointForce(bar.end, (0.0, 5.0))], connectors=[spring])
    with pytest.raises(bf.ConvergenceError, match="did not converge") as error:
        bf.simulate(model, 0.2, 1e-3)
    assert len(error.value.solution) > 1


def test_a_clamped_guide_without_slopes_there_is_named_with_the_place():
    guide = bf.Beam(bf.Line((-0.5, 1.0), (0.5, 1.0)), 4, bf.ANCF(bf.ElasticLine()), SECTION, STEEL)
    post = bf.Beam(bf.Line((0.0, 0.0), (0.0, 1.0)), 2, bf.CRBF(3), SECTION, STEEL)
    supports = [bf.Clamp(post.start), bf.Clamp(guide.start), bf.Clamp(guide.end)]
    push, slider = bf.PointForce(post.end, (100.0, 0.0)), bf.SliderOnBeam(guide, post.end)
    with pytest.raises(
        bf.InputError, match=r"which the node of ANCF at \(-0.5, 1\) does not have, .* as its rotation is fixed"
    ):
        bf.solve_static(bf.Model([post, guide], supports, [push], connectors=[slider]))
