# SPDX-License-Identifier: BSD-3-Clause
"""Exudyn. Settings: "alpha:STEPS" and "trapezoid:STEPS" on bodies and joints (in the plane, where all hinges are
parallel: loops have no redundant conditions there), "RK44:STEPS", "RK67:STEPS" and "DOPRI5:TOLERANCE" on a tree of
minimal coordinates, whose balls are three hinges."""
import exudyn as exu
import numpy as np
from exudyn.itemInterface import (Force, MarkerBodyPosition, NodeGenericODE2, ObjectKinematicTree, RevoluteJoint2D,
                                  Rigid2D, RigidBody2D)
from exudyn.utilities import RigidBodyInertia

from serve import inside, place_of, serve, tree, turn_of

KINDS = [exu.JointType.RevoluteX, exu.JointType.RevoluteY, exu.JointType.RevoluteZ]


def about(axis, angle):
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R = np.eye(3)
    R[i, i] = R[j, j] = np.cos(angle)
    R[j, i] = np.sin(angle)
    R[i, j] = -R[j, i]
    return R


def hinges_of(branches):
    """(axis, parent hinge, orientation, place, body or None, rate): one for a hinge, three for a ball."""
    hinges, last = [], {-1: -1}
    for i, b in enumerate(branches):
        if b.parent is None:
            raise ValueError("a tree has no free bodies")
        axes = [2, 1, 0] if b.kind == "ball" else [int(np.argmax(np.abs(b.axis)))]
        rates = [b.rate[a] for a in axes]
        for k, axis in enumerate(axes):
            first, end = k == 0, k == len(axes) - 1
            hinges.append((axis, last[b.parent] if first else len(hinges) - 1, b.R if first else np.eye(3),
                           b.place if first else np.zeros(3), b.body if end else None, rates[k]))
        last[i] = len(hinges) - 1
    return hinges, last


def add_tree(mbs, m):
    branches, rest = tree(m)
    if rest:
        raise ValueError("a tree has neither closed loops nor rods")
    hinges, last = hinges_of(branches)
    n = len(hinges)
    node = mbs.AddNode(NodeGenericODE2(referenceCoordinates=[0.0] * n, initialCoordinates=[0.0] * n,
                                       initialCoordinates_t=[float(h[5]) for h in hinges],
                                       numberOfODE2Coordinates=n))
    turns, inertias = exu.Matrix3DList(), exu.Matrix3DList()
    places, centers = exu.Vector3DList(), exu.Vector3DList()
    for _, _, R, place, body, _ in hinges:
        turns.Append(np.array(R))
        places.Append(np.array(place))
        inertias.Append(np.diag(body.inertia) if body else np.zeros((3, 3)))
        centers.Append(np.array(body.center) if body else np.zeros(3))
    mbs.AddObject(ObjectKinematicTree(
        nodeNumber=node, jointTypes=[KINDS[h[0]] for h in hinges], linkParents=np.array([h[1] for h in hinges]),
        jointTransformations=turns, jointOffsets=places, linkInertiasCOM=inertias, linkCOMs=centers,
        linkMasses=np.array([h[4].mass if h[4] else 0.0 for h in hinges]), gravity=list(m.gravity)))

    def points():
        q, frames = mbs.systemData.GetODE2Coordinates(), {-1: (np.zeros(3), np.eye(3))}
        for i, (axis, parent, R, place, _, _) in enumerate(hinges):
            x, A = frames[parent]
            frames[i] = x + A @ place, A @ R @ about(axis, q[i])
        return [frames[last[body]][0] + frames[last[body]][1] @ at for body, at in m.points]
    return points


def add_in_space(mbs, m):
    ground = mbs.CreateGround()
    bodies = [mbs.CreateRigidBody(
        inertia=RigidBodyInertia(b.mass, np.diag(b.inertia)), gravity=list(m.gravity),
        referencePosition=list(np.array(b.x) + turn_of(m, i) @ b.center), referenceRotationMatrix=turn_of(m, i),
        initialVelocity=list(np.array(b.v) + np.cross(b.w, turn_of(m, i) @ b.center)),
        initialAngularVelocity=list(b.w)) for i, b in enumerate(m.bodies)]

    def from_center(body, at):
        return list(np.array(at) - m.bodies[body].center) if body >= 0 else list(at)
    for kind, first, second, numbers in m.joints:
        pair = [ground if first < 0 else bodies[first], bodies[second]]
        if kind == "rod":
            mbs.CreateDistanceConstraint(bodyNumbers=pair, localPosition0=from_center(first, numbers[:3]),
                                         localPosition1=from_center(second, numbers[3:6]), distance=numbers[6])
        elif kind == "ball":
            mbs.CreateSphericalJoint(bodyNumbers=pair, position=list(numbers[:3]))
        else:
            mbs.CreateRevoluteJoint(bodyNumbers=pair, position=list(numbers[:3]), axis=list(numbers[3:6]))
    return lambda: [mbs.GetObjectOutputBody(
        bodies[body], exu.OutputVariableType.Position, localPosition=from_center(body, at),
        configuration=exu.ConfigurationType.Current) for body, at in m.points]


def plane_of(m):
    """Two axes of the plane that all hinges are upright on, or None."""
    axes = [numbers[3:6] for kind, _, _, numbers in m.joints if kind == "hinge"]
    if len(axes) < len(m.joints) or any(abs(a @ axes[0]) < 1 - 1e-12 for a in axes):
        return None
    k = int(np.argmax(axes[0]))
    return np.array([np.eye(3)[(k + 1) % 3], np.eye(3)[(k + 2) % 3]])


def add_in_plane(mbs, m, plane):
    normal = np.cross(*plane)
    ground, bodies = mbs.CreateGround(), []
    for i, b in enumerate(m.bodies):
        d = plane @ turn_of(m, i) @ [1, 0, 0]
        x = plane @ (np.array(b.x) + turn_of(m, i) @ b.center)
        v = plane @ (np.array(b.v) + np.cross(b.w, turn_of(m, i) @ b.center))
        node = mbs.AddNode(Rigid2D(referenceCoordinates=[*x, np.arctan2(d[1], d[0])],
                                   initialVelocities=[*v, float(normal @ b.w)]))
        inertia = float(np.abs(turn_of(m, i).T @ normal) @ b.inertia)
        bodies.append(mbs.AddObject(RigidBody2D(mass=b.mass, inertia=inertia, nodeNumber=node)))
        marker = mbs.AddMarker(MarkerBodyPosition(bodyNumber=bodies[i], localPosition=[0, 0, 0]))
        mbs.AddLoad(Force(markerNumber=marker, loadVector=[*(b.mass * (plane @ m.gravity)), 0]))

    def in_body(i, at):   # along the body's x axis and across it, from its centre of mass
        if i < 0:
            return [*(plane @ at), 0]
        from_center = turn_of(m, i) @ (np.array(at) - m.bodies[i].center)
        d = plane @ turn_of(m, i) @ [1, 0, 0]
        p = plane @ from_center
        return [d @ p, d[0] * p[1] - d[1] * p[0], 0]

    def marker(i, at):
        return mbs.AddMarker(MarkerBodyPosition(bodyNumber=ground if i < 0 else bodies[i],
                                                localPosition=in_body(i, at)))
    for _, first, second, numbers in m.joints:
        mbs.AddObject(RevoluteJoint2D(markerNumbers=[marker(i, inside(m, i, numbers[:3])) for i in (first, second)]))

    def points():
        found = []
        for body, at in m.points:
            p = mbs.GetObjectOutputBody(bodies[body], exu.OutputVariableType.Position,
                                        localPosition=in_body(body, at),
                                        configuration=exu.ConfigurationType.Current)
            found.append(p[:2] @ plane + normal * (normal @ (place_of(m, body) + turn_of(m, body) @ at)))
        return found
    return points


SOLVERS = {"alpha": exu.DynamicSolverType.GeneralizedAlpha, "trapezoid": exu.DynamicSolverType.TrapezoidalIndex2,
           "RK44": exu.DynamicSolverType.RK44, "RK67": exu.DynamicSolverType.RK67,
           "DOPRI5": exu.DynamicSolverType.DOPRI5}


def settings_of(m, kind, value):
    settings = exu.SimulationSettings()
    time = settings.timeIntegration
    time.endTime = m.end
    time.verboseMode = 0
    settings.solution.file.write = False
    settings.show.computationTime = settings.show.statistics = False
    settings.parallel.numberOfThreads = 1
    if kind == "DOPRI5":
        time.automaticStepSize = True
        time.absoluteTolerance = time.relativeTolerance = float(value)
        time.numberOfSteps, time.initialStepSize, time.minimumStepSize = 100, 1e-3, 1e-9
    else:
        time.numberOfSteps = int(value)
    time.generalizedAlpha.spectralRadius = 1 if kind == "trapezoid" else 0.9
    time.newton.useModifiedNewton = True
    time.newton.relativeTolerance, time.newton.absoluteTolerance = 1e-10, 1e-12
    if m.name == "parallelograms":   # it passes singular positions
        settings.linearSolver.ignoreSingularJacobian = True
        settings.linearSolver.solverType = exu.LinearSolverType.EigenDense
    return settings


def prepare(m, setting):
    kind, value = setting
    mbs = exu.SystemContainer().AddSystem()
    if kind in ("alpha", "trapezoid"):
        plane = plane_of(m)
        points = add_in_space(mbs, m) if plane is None else add_in_plane(mbs, m, plane)
    else:
        points = add_tree(mbs, m)
    mbs.Assemble()
    settings = settings_of(m, kind, value)

    def solve():
        if mbs.SolveDynamic(settings, solverType=SOLVERS[kind]) is False:
            raise RuntimeError("not solved")
        return points
    return solve


if __name__ == "__main__":
    serve(prepare)
