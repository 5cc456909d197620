"""Convergence studies: a function called along one refinement, for every combination of its other parameters."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from beamfem import validation
from beamfem.convergence.convergence_result import WORK, Convergence
from beamfem.convergence.refinement_curve import Curve, highest_order, judge, scale_of
from beamfem.errors import InputError
from beamfem.progress import progress
from beamfem.sweeps.parameters import assignments, check_call, combinations, labels, name_of, split
from beamfem.sweeps.workers import ExecutorFactory, Failure, Outcome, TaskRunner
from beamfem.validation import finite, optional, positive, require_known, shown

MOST_DOUBLINGS = 8


@dataclass
class _Line:
    """A curve during the study; ended: why it is not refined further."""

    label: str
    texts: dict[str, str]
    parameters: dict[str, Any]
    found: dict[Any, Outcome] = field(default_factory=dict)
    ended: str = ""


def converge(
    function: Callable[..., Any],
    /,
    quantity: str | None = None,
    *,
    refine: str,
    reference: float | None = None,
    until: float | None = None,
    executor: ExecutorFactory | None = None,
    **parameters: Any,
) -> Convergence:
    """Call a function along one refinement and assess the convergence of its value.

    Parameters
    ----------
    function : callable
        Returns a number or a mapping of named numbers. A number named like the quantity with the suffix `_error`, such
        as "deflection_error", is an estimate of its error, to be added to it, as returned by `Solution.error`: the
        table shows its effectivity, and it serves as the estimated error of a curve that has no other.
    quantity : str, optional
        Name of the number whose error is studied; the others become columns.
    refine : str
        Name of the parameter of refinement, whose values are counts (whole numbers, h = 1/n) or decreasing step sizes
        (h). With "accuracy" and a list of `elements` there are two curves for each element kind, to compare their work:
        fixed meshes, with accuracy=None, and adaptive ones, with elements="auto".
    reference : float, optional
        The limit, if known; otherwise each curve is extrapolated (Richardson). Errors are relative to the limit unless
        it is zero.
    until : float, optional
        Double the last count (or halve the last step) of each curve until its estimated error is below this value, at
        most 8 times.
    executor : callable, optional
        Creates a `concurrent.futures.Executor`, as in `sweep`.
    **parameters
        Arguments of the function. Besides the parameter of refinement, every list, tuple, range or one-dimensional
        array gives one curve for each of its values; anything else is passed on unchanged.

    Raises
    ------
    InputError
        If the parameters do not describe a study.
    BeamfemError
        If no worker starts.

    Notes
    -----
    An order is accepted if the last four values agree on it and it does not exceed twice the degree of an `Element`
    among the parameters (16 without one). Otherwise the changes between levels give the estimate, or there is none
    (nan), as the notes of the curve say. A call that fails is listed in `failures` and the study continues.

    Examples
    --------
    >>> study = bf.converge(lambda n: 1.0 + 1.0 / n**2, refine="n", n=[4, 8, 16, 32], reference=1.0)
    >>> round(float(study.curves[0].order[-1]), 3)
    2.0
    """
    varied, fixed = split(parameters)
    require_known(
        f"refine names the parameter {shown(refine)}, which must be given as a list of values", refine, varied
    )
    optional(validation.text)("quantity", quantity)
    if refine == "accuracy" and "elements" in varied:
        shared: Any = {"quantity": quantity, "reference": reference, "until": until, "executor": executor}
        return _side_by_side(
            converge(function, **shared, refine="elements", **(parameters | {"accuracy": None})),
            converge(function, **shared, refine="accuracy", **(parameters | {"elements": "auto"})),
        )
    refinement, counts = _from_coarse_to_fine(refine, varied.pop(refine))
    reference, goal = optional(finite)("reference", reference), optional(positive)("until", until)
    lines = _lines(function, varied, fixed)
    first_point = lines[0].parameters | {refine: refinement[0]}
    check_call(function, first_point, ("quantity", "refine", "reference", "until", "executor"))
    with TaskRunner(function, executor) as runner:
        quantity = _call(runner, [(line, value) for line in lines for value in refinement], refine, quantity)
        last, doublings = refinement[-1], 0
        while goal is not None:
            for line in lines:
                line.ended = line.ended or _ended(line, _curve(line, quantity, counts, reference), last, goal, refine)
            going = [line for line in lines if not line.ended]
            if not going or doublings == MOST_DOUBLINGS:
                for line in going:
                    line.ended = f"error {goal:.0e} not reached after {doublings} doublings, the most that are tried"
                break
            last, doublings = last * 2 if counts else last / 2, doublings + 1
            quantity = _call(runner, [(line, last) for line in going], refine, quantity)
    curves = [curve for line in lines if (curve := _curve(line, quantity, counts, reference))]
    failures = [failure for line in lines for failure in _failures(line, refine)]
    name = name_of(function)
    return Convergence(name, quantity or name, refine, reference, tuple(curves), tuple(failures))


def _side_by_side(fixed: Convergence, adaptive: Convergence) -> Convergence:
    """Return the studies of fixed and adaptive meshes as one."""
    curves = [
        replace(curve, label=f"{mesh}, {curve.label}", texts={"mesh": mesh, **curve.texts})
        for mesh, study in (("fixed", fixed), ("adaptive", adaptive))
        for curve in study.curves
    ]
    return replace(fixed, refine=WORK, curves=tuple(curves), failures=fixed.failures + adaptive.failures)


def _from_coarse_to_fine(refine: str, values: Sequence[Any]) -> tuple[tuple[Any, ...], bool]:
    """Return the refinement in order, and whether it consists of counts; whole numbers are counts in any order.

    Raises InputError unless it is increasing counts or decreasing step sizes.
    """
    numbers = np.array([positive(refine, value) for value in values])
    integers = all(isinstance(value, int | np.integer) for value in values)
    steps = np.diff(np.sort(numbers) if integers else numbers)
    if integers and (steps > 0).all():
        return tuple(sorted(values)), True
    if not integers and (steps < 0).all():
        return tuple(values), False
    if not integers and (steps > 0).all() and (numbers % 1.0 == 0.0).all():
        return tuple(values), True
    raise InputError(
        f"{refine} must be counts (whole numbers, each once) or falling step sizes, got {', '.join(map(str, values))}"
    )


def _lines(function: Callable[..., Any], varied: Mapping[str, Sequence[Any]], fixed: Mapping[str, Any]) -> list[_Line]:
    """Return one line for each combination, named after the parameters that have more than one value."""
    several = {name: values for name, values in varied.items() if len(values) > 1}
    texts = combinations({name: labels(values) for name, values in several.items()}, {})
    lines = []
    for point, text in zip(combinations(varied, fixed), texts, strict=True):
        parts = [f"{n}={t}" if isinstance(point[n], bool | int | float) else t for n, t in text.items()]
        lines.append(_Line(", ".join(parts) or getattr(function, "__name__", "all"), text, point))
    return lines


def _call(runner: TaskRunner, tasks: Sequence[tuple[_Line, Any]], refine: str, quantity: str | None) -> str | None:
    """Call the function at every line and refinement; return the quantity, which is known after the first call."""
    points = [line.parameters | {refine: value} for line, value in tasks]
    with progress("calls", len(points)) as report:
        for done, (i, outcome) in enumerate(runner.run(points), 1):
            if outcome.error is None:
                quantity = _quantity(outcome.value, quantity)
            line, value = tasks[i]
            line.found[value] = _refuse_arrays(outcome, quantity)
            report(done)
    return quantity


def _quantity(value: Any, quantity: str | None) -> str | None:
    """Return the name of the quantity; None for a function that returns a bare number."""
    if not isinstance(value, Mapping):
        if quantity is not None:
            raise InputError(f"the function returns a number, not a mapping: leave quantity={quantity!r} out")
        return None
    if quantity is None and len(value) == 1:
        return str(next(iter(value)))
    require_known(f"quantity must be one that the function returns, got {quantity!r}", quantity, value)
    return quantity


def _refuse_arrays(outcome: Outcome, quantity: str | None) -> Outcome:
    """Return a failure for a value that is not a finite number, since it has no error."""
    if outcome.error is not None:
        return outcome
    number = outcome.value if quantity is None else outcome.value[quantity]
    if isinstance(number, np.ndarray) or not np.isfinite(number):
        return Outcome(seconds=outcome.seconds, error=f"{quantity or 'the value'} is {number}, not a finite number")
    return outcome


def _curve(line: _Line, quantity: str | None, counts: bool, reference: float | None) -> Curve | None:
    """Assess the values found so far; None if every call failed."""
    by_value = {value: outcome for value, outcome in line.found.items() if outcome.error is None}
    if not by_value:
        return None
    # workers answer in any order
    by_value = dict(sorted(by_value.items(), key=lambda item: item[0], reverse=not counts))
    sizes = np.array([1.0 / value if counts else value for value in by_value], dtype=float)
    outcomes = list(by_value.values())
    names = [] if quantity is None else [name for name in outcomes[0].value if name != quantity]
    curve = judge(
        refinement=tuple(by_value),
        size=sizes,
        value=np.array([o.value if quantity is None else o.value[quantity] for o in outcomes], dtype=float),
        reference=reference,
        highest=highest_order(line.parameters),
    )
    estimate = curve.estimated_error
    if (
        np.isnan(estimate)
        and quantity is not None
        and (found := outcomes[-1].value.get(f"{quantity}_error")) is not None
    ):
        estimate = abs(float(found)) / scale_of(curve.limit, curve.value)
    return replace(
        curve,
        estimated_error=estimate,
        label=line.label,
        parameters=line.parameters,
        texts=line.texts,
        others={name: tuple(outcome.value.get(name) for outcome in outcomes) for name in names},
        seconds=np.array([outcome.seconds for outcome in outcomes]),
        notes=(*curve.notes, line.ended) if line.ended else curve.notes,
    )


def _ended(line: _Line, curve: Curve | None, last: Any, goal: float, refine: str) -> str:
    """Return why a curve is not refined further, an empty text if it is."""
    if curve is None or line.found[last].error is not None:
        return f"refined no further: {refine}={last} failed"
    if curve.estimated_error <= goal:
        return f"error {goal:.0e} reached at {refine}={last}"
    return ""


def _failures(line: _Line, refine: str) -> list[Failure]:
    return [
        Failure(
            line.parameters | {refine: value},
            assignments(line.texts | {refine: value}),
            outcome.error,
            outcome.traceback,
        )
        for value, outcome in line.found.items()
        if outcome.error is not None
    ]
