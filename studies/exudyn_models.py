"""The cases of `peers` in Exudyn: beams along x, pinned under gravity or clamped with a tip force."""

from typing import Any

import exudyn as exu
from exudyn import itemInterface as items

TWO_NODES, THREE_NODES, CABLE = "geometrically exact, 2 nodes", "geometrically exact, 3 nodes", "ANCF cable"


class Peer:
    """A beam in Exudyn.

    stiffness: E A, k_s G A, E I; mass: per length [kg/m], rotary [kg m]; clamped: else pinned; gravity [m/s^2]; force
    (fy) [N] at the tip.
    """

    def __init__(
        self,
        kind: str,
        elements: int,
        length: float,
        stiffness: tuple[float, float, float],
        mass: tuple[float, float],
        clamped: bool,
        gravity: float = 0.0,
        force: float = 0.0,
    ) -> None:
        self.container = exu.SystemContainer()
        self.system = self.container.AddSystem()
        add = self.system
        inner = 2 if kind == THREE_NODES else 1
        axial, shear, bending = stiffness
        nodes = []
        for i in range(inner * elements + 1):
            x = length * i / (inner * elements)
            if kind == CABLE:
                nodes.append(add.AddNode(items.NodePoint2DSlope1(referenceCoordinates=[x, 0.0, 1.0, 0.0])))
            else:
                nodes.append(add.AddNode(items.NodeRigidBody2D(referenceCoordinates=[x, 0.0, 0.0])))
        own: dict[str, Any] = {
            "length": length / elements,
            "massPerLength": mass[0],
            "bendingStiffness": bending,
            "axialStiffness": axial,
        }
        for i in range(elements):
            chosen = nodes[inner * i : inner * (i + 1) + 1]
            if kind == CABLE:
                body = add.AddObject(items.ObjectANCFCable2D(nodeNumbers=chosen, **own))
            else:
                rest = {"crossSectionInertia": mass[1], "shearStiffness": shear}
                body = add.AddObject(items.ObjectBeamGeometricallyExact2D(nodeNumbers=chosen, **own, **rest))
            if gravity:
                marker = add.AddMarker(items.MarkerBodyMass(bodyNumber=body))
                add.AddLoad(items.LoadMassProportional(markerNumber=marker, loadVector=[0.0, -gravity, 0.0]))
        ground = add.AddMarker(
            items.MarkerNodeCoordinate(nodeNumber=add.AddNode(items.NodePointGround()), coordinate=0)
        )
        for coordinate in (0, 1, 3 if kind == CABLE else 2) if clamped else (0, 1):
            held = add.AddMarker(items.MarkerNodeCoordinate(nodeNumber=nodes[0], coordinate=coordinate))
            add.AddObject(items.CoordinateConstraint(markerNumbers=[ground, held]))
        self.tip = nodes[-1]
        if force:
            marker = add.AddMarker(items.MarkerNodePosition(nodeNumber=self.tip))
            add.AddLoad(items.Force(markerNumber=marker, loadVector=[0.0, force, 0.0]))
        self.system.Assemble()

    def motion(self, steps: int, duration: float, sparse: bool) -> None:
        """March with the trapezoidal rule and Exudyn's own modified Newton iteration."""
        settings = _settings(sparse)
        settings.timeIntegration.numberOfSteps = steps
        settings.timeIntegration.endTime = duration
        settings.timeIntegration.verboseMode = 0
        self.system.SolveDynamic(settings, solverType=exu.DynamicSolverType.TrapezoidalIndex2)

    def equilibrium(self, load_steps: int, sparse: bool) -> None:
        """Find the equilibrium in load steps."""
        settings = _settings(sparse)
        settings.staticSolver.numberOfLoadSteps = load_steps
        settings.staticSolver.verboseMode = 0
        self.system.SolveStatic(settings)

    def tangents(self) -> int:
        """Return how many tangents the last motion took; many a step mean that the solver struggles."""
        return int(self.system.sys["dynamicSolver"].it.newtonJacobiCount)

    def tip_position(self) -> tuple[float, float]:
        """Return where the tip is after the last solve [m]."""
        x, y, _ = self.system.GetNodeOutput(self.tip, exu.OutputVariableType.Position)
        return x, y


def _settings(sparse: bool) -> Any:
    settings = exu.SimulationSettings()
    settings.solutionSettings.writeSolutionToFile = False
    settings.parallel.numberOfThreads = 1
    settings.linearSolverType = exu.LinearSolverType.EigenSparse if sparse else exu.LinearSolverType.EXUdense
    return settings
