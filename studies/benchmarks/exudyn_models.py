"""The cases of `peers` in Exudyn: beams along x, pinned under gravity or clamped with a tip force."""

from typing import Any

import exudyn as exu
import numpy as np
from exudyn import itemInterface as items

from studies.benchmarks.peer_cases import CABLE, LINEAR_SOLVERS, THREE_NODES, Chain


class Peer:
    """A chain of beams in Exudyn; instants: how often the tip of a motion is written down [s]."""

    def __init__(self, kind: str, elements: int, chain: Chain, instants: float = 0.1) -> None:
        self.container = exu.SystemContainer()
        self.system = self.container.AddSystem()
        self.instants = instants
        nodes = self._add_beams(kind, elements, chain)
        self._hold(nodes[0], (0, 1, 3 if kind == CABLE else 2) if chain.clamped else (0, 1))
        self.tip, self.sensor = nodes[-1], None
        if chain.force:
            marker = self.system.AddMarker(items.MarkerNodePosition(nodeNumber=self.tip))
            self.system.AddLoad(items.Force(markerNumber=marker, loadVector=[0.0, chain.force, 0.0]))
        else:
            position = {"nodeNumber": self.tip, "outputVariableType": exu.OutputVariableType.Position}
            sensor = items.SensorNode(**position, storeInternal=True, writeToFile=False)
            self.sensor = self.system.AddSensor(sensor)
        self.system.Assemble()

    def _add_beams(self, kind: str, elements: int, chain: Chain) -> list[Any]:
        add, inner = self.system, 2 if kind == THREE_NODES else 1
        nodes = []
        for i in range(inner * elements + 1):
            x = chain.length * i / (inner * elements)
            if kind == CABLE:
                nodes.append(add.AddNode(items.NodePoint2DSlope1(referenceCoordinates=[x, 0.0, 1.0, 0.0])))
            else:
                nodes.append(add.AddNode(items.NodeRigidBody2D(referenceCoordinates=[x, 0.0, 0.0])))
        own: dict[str, Any] = {
            "length": chain.length / elements,
            "massPerLength": chain.mass,
            "bendingStiffness": chain.bending,
            "axialStiffness": chain.axial,
        }
        for i in range(elements):
            chosen = nodes[inner * i : inner * (i + 1) + 1]
            if kind == CABLE:
                body = add.AddObject(items.ObjectANCFCable2D(nodeNumbers=chosen, **own))
            else:
                rest = {"crossSectionInertia": chain.rotary, "shearStiffness": chain.shear}
                body = add.AddObject(items.ObjectBeamGeometricallyExact2D(nodeNumbers=chosen, **own, **rest))
            if chain.gravity:
                marker = add.AddMarker(items.MarkerBodyMass(bodyNumber=body))
                add.AddLoad(items.LoadMassProportional(markerNumber=marker, loadVector=[0.0, -chain.gravity, 0.0]))
        return nodes

    def _hold(self, node: Any, coordinates: tuple[int, ...]) -> None:
        add = self.system
        ground = add.AddNode(items.NodePointGround())
        fixed = add.AddMarker(items.MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
        for coordinate in coordinates:
            held = add.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
            add.AddObject(items.CoordinateConstraint(markerNumbers=[fixed, held]))

    def motion(self, steps: int, duration: float, linear_solver: str, threads: int = 1) -> None:
        """March with the trapezoidal rule and Exudyn's own modified Newton iteration."""
        settings = _settings(linear_solver, threads)
        settings.solution.sensors.writePeriod = self.instants
        settings.timeIntegration.numberOfSteps = steps
        settings.timeIntegration.endTime = duration
        settings.timeIntegration.verboseMode = 0
        self.system.SolveDynamic(settings, solverType=exu.DynamicSolverType.TrapezoidalIndex2)

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

    def tip_positions(self) -> np.ndarray:
        """Return where the tip was at the instants of the last motion, without the start (times, 2) [m]."""
        return np.array(self.system.GetSensorStoredData(self.sensor))[1:, 1:3]


def _settings(linear_solver: str, threads: int) -> Any:
    assert linear_solver in LINEAR_SOLVERS, linear_solver
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.parallel.numberOfThreads = threads
    settings.linearSolver.solverType = getattr(exu.LinearSolverType, linear_solver)
    return settings
