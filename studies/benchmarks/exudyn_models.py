"""The cases of `peers` in Exudyn: beams along x, pinned under gravity or clamped with a tip force, and linkages."""

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import exudyn as exu
import numpy as np
from exudyn import itemInterface as items

from studies.benchmarks.peer_cases import CABLE, INSTANTS, LINEAR_SOLVERS, SPARSE, THREE_NODES, Chain, Linkage


class Peer:
    """Beams in Exudyn; instants: how often what is watched in a motion is written down [s]."""

    def __init__(self, instants: float) -> None:
        self.container = exu.SystemContainer()
        self.system = self.container.AddSystem()
        self.instants, self.tip, self.watched = instants, None, list[Any]()

    def beam(self, kind: str, elements: int, bar: Chain, *ends: tuple[float, float]) -> tuple[list[Any], list[Any]]:
        """Add a straight beam between two points and return its nodes and elements."""
        add, inner = self.system, 2 if kind == THREE_NODES else 1
        along = np.subtract(ends[1], ends[0]) / bar.length
        nodes, bodies = [], []
        for place in np.linspace(*ends, inner * elements + 1).tolist():
            if kind == CABLE:
                nodes.append(add.AddNode(items.NodePoint2DSlope1(referenceCoordinates=[*place, *along])))
            else:
                angle = np.arctan2(along[1], along[0])
                nodes.append(add.AddNode(items.NodeRigidBody2D(referenceCoordinates=[*place, angle])))
        own: dict[str, Any] = {
            "length": bar.length / elements,
            "massPerLength": bar.mass,
            "bendingStiffness": bar.bending,
            "axialStiffness": bar.axial,
        }
        for i in range(elements):
            chosen = nodes[inner * i : inner * (i + 1) + 1]
            if kind == CABLE:
                bodies.append(add.AddObject(items.ObjectANCFCable2D(nodeNumbers=chosen, **own)))
            else:
                rest = {"crossSectionInertia": bar.rotary, "shearStiffness": bar.shear}
                beam = items.ObjectBeamGeometricallyExact2D(nodeNumbers=chosen, **own, **rest)
                beam.includeReferenceRotations = True  # those of a straight beam that is inclined
                bodies.append(add.AddObject(beam))
            self.weigh(bodies[-1], bar)
        return nodes, bodies

    def weigh(self, body: Any, bar: Chain) -> None:
        """Let gravity act on a body."""
        if bar.gravity:
            marker = self.system.AddMarker(items.MarkerBodyMass(bodyNumber=body))
            load = items.LoadMassProportional(markerNumber=marker, loadVector=[0.0, -bar.gravity, 0.0])
            self.system.AddLoad(load)

    def tie(self, node: Any, coordinates: Sequence[int], other: Any = None) -> None:
        """Tie displacements of a node to those of another one, or to the ground."""
        add, ground = self.system, items.NodePointGround() if other is None else None
        fixed = add.AddNode(ground) if other is None else other
        for coordinate in coordinates:
            pair = (fixed, 0 if other is None else coordinate), (node, coordinate)
            markers = [add.AddMarker(items.MarkerNodeCoordinate(nodeNumber=n, coordinate=c)) for n, c in pair]
            add.AddObject(items.CoordinateConstraint(markerNumbers=markers))

    def watch(self, node: Any) -> None:
        """Write down where a node is in motions."""
        position = {"nodeNumber": node, "outputVariableType": exu.OutputVariableType.Position}
        sensor = items.SensorNode(**position, storeInternal=True, writeToFile=False)
        self.watched.append(self.system.AddSensor(sensor))

    def motion(
        self, steps: int, duration: float, linear_solver: str, threads: int = 1, method: str = "TrapezoidalIndex2"
    ) -> None:
        """March with a method of Exudyn, implicit ones with its own modified Newton iteration."""
        settings = _settings(linear_solver, threads)
        settings.solution.sensors.writePeriod = self.instants
        settings.timeIntegration.numberOfSteps = steps
        settings.timeIntegration.endTime = duration
        settings.timeIntegration.verboseMode = 0
        self.system.SolveDynamic(settings, solverType=getattr(exu.DynamicSolverType, method))

    def equilibrium(self, load_steps: int, linear_solver: str, threads: int = 1) -> None:
        """Find the equilibrium in load steps."""
        settings = _settings(linear_solver, threads)
        settings.staticSolver.numberOfLoadSteps = load_steps
        settings.staticSolver.verboseMode = 0
        self.system.SolveStatic(settings)

    def tangents(self) -> int:
        """Return how many tangents the last motion took; many a step mean that the solver struggles."""
        return int(self.system.sys["dynamicSolver"].it.newtonJacobiCount)

    def tip_position(self) -> np.ndarray:
        """Return where the tip is after the last solve (2,) [m]."""
        return np.array(self.system.GetNodeOutput(self.tip, exu.OutputVariableType.Position)[:2])

    def positions(self) -> np.ndarray:
        """Return where what is watched was at the instants of the last motion, without the start (times, 2 n) [m]."""
        return np.hstack([np.array(self.system.GetSensorStoredData(each))[1:, 1:3] for each in self.watched])


def chain(kind: str, elements: int, beam: Chain, instants: float, released: bool = False) -> Peer:
    """Return a beam along x, pinned under gravity or clamped with a tip force; released: bent by it and let go."""
    peer = Peer(instants)
    nodes, _ = peer.beam(kind, elements, beam, (0.0, 0.0), (beam.length, 0.0))
    peer.tie(nodes[0], (0, 1, 3 if kind == CABLE else 2) if beam.clamped else (0, 1))
    peer.tip = nodes[-1]
    if beam.force:
        marker = peer.system.AddMarker(items.MarkerNodePosition(nodeNumber=peer.tip))
        load = peer.system.AddLoad(items.Force(markerNumber=marker, loadVector=[0.0, beam.force, 0.0]))
    if released or not beam.force:
        peer.watch(peer.tip)
    peer.system.Assemble()
    if released:
        peer.equilibrium(10, SPARSE)
        bent = peer.system.systemData.GetODE2Coordinates()
        peer.system.systemData.SetODE2Coordinates(bent, configuration=exu.ConfigurationType.Initial)
        peer.system.SetLoadParameter(load, "loadVector", [0.0, 0.0, 0.0])
    return peer


def thrown(
    elements: int, beam: Chain, ends: Sequence[tuple[float, float]], pulse: Callable[[float], float], instants: float
) -> Peer:
    """Return the free beam of Simo and Vu-Quoc; pulse: of the force and moment at its first end, over time [s]."""
    peer = Peer(instants)
    nodes, _ = peer.beam(THREE_NODES, elements, beam, *ends)
    marker = peer.system.AddMarker(items.MarkerNodeRigid(nodeNumber=nodes[0]))
    for kind, vector in ((items.Force, np.array([8.0, 0.0, 0.0])), (items.Torque, np.array([0.0, 0.0, -80.0]))):
        acting = kind(markerNumber=marker, loadVector=vector.tolist())
        acting.loadVectorUserFunction = lambda system, time, load: [pulse(time) * each for each in load]
        peer.system.AddLoad(acting)
    peer.watch(nodes[-1])
    peer.system.Assemble()
    return peer


def linkage(kind: str, case: Linkage, elements: Sequence[int], rigid: bool) -> Peer:
    """Return a linkage; rigid: whether its first bar is a rigid body, and not a beam."""
    peer = Peer(case.duration / len(INSTANTS))
    add, chains, first = peer.system, [], None
    for number, (bar, count) in enumerate(zip(case.bars, elements, strict=True)):
        ends = case.points[number], case.points[number + 1]
        if rigid and not chains and first is None:
            first = _rigid_bar(peer, bar, *ends)
        else:
            chains.append(peer.beam(kind, count, bar, *ends))
    (nodes, bodies), last = chains[0], chains[-1][0]
    if first is None:
        peer.tie(nodes[0], (0, 1))
        turned = (
            items.MarkerBodyRigid(bodyNumber=bodies[0]) if kind == CABLE else items.MarkerNodeRigid(nodeNumber=nodes[0])
        )
    else:
        half = [0.5 * case.bars[0].length, 0.0, 0.0]
        ground = add.AddObject(items.ObjectGround())
        at = (ground, [0.0, 0.0, 0.0]), (first, [-half[0], 0.0, 0.0]), (first, half)
        markers = [add.AddMarker(items.MarkerBodyPosition(bodyNumber=b, localPosition=p)) for b, p in at]
        markers.append(add.AddMarker(items.MarkerNodePosition(nodeNumber=nodes[0])))
        for pair in (markers[:2], markers[2:]):
            add.AddObject(items.RevoluteJoint2D(markerNumbers=pair))
        turned = items.MarkerBodyRigid(bodyNumber=first)
    add.AddLoad(items.Torque(markerNumber=add.AddMarker(turned), loadVector=[0.0, 0.0, case.torque]))
    for (before, _), (after, _) in pairwise(chains):
        peer.tie(after[0], (0, 1), before[-1])
    peer.tie(last[-1], (1,) if case.slider else (0, 1))
    if case.slider:
        own = add.AddNode(items.Node1D(referenceCoordinates=[0.0]))
        add.AddObject(items.Mass1D(nodeNumber=own, mass=case.slider))
        peer.tie(last[-1], (0,), own)
    peer.watch(last[-1])
    peer.watch(last[len(last) // 2])
    add.Assemble()
    return peer


def _rigid_bar(peer: Peer, bar: Chain, start: tuple[float, float], end: tuple[float, float]) -> Any:
    middle, (x, y) = 0.5 * np.add(start, end), np.subtract(end, start)
    node = peer.system.AddNode(items.NodeRigidBody2D(referenceCoordinates=[*middle, np.arctan2(y, x)]))
    mass = bar.mass * bar.length
    inertia = mass * bar.length**2 / 12.0 + bar.rotary * bar.length
    body = peer.system.AddObject(items.RigidBody2D(mass=mass, inertia=inertia, nodeNumber=node))
    peer.weigh(body, bar)
    return body


def _settings(linear_solver: str, threads: int) -> Any:
    assert linear_solver in LINEAR_SOLVERS, linear_solver
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.parallel.numberOfThreads = threads
    settings.linearSolver.solverType = getattr(exu.LinearSolverType, linear_solver)
    return settings
