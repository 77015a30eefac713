# SPDX-License-Identifier: BSD-3-Clause
"""Exudyn. Settings: "alpha:STEPS" and "trapezoid:STEPS" on bodies and joints (in the plane, where all hinges are
parallel: loops have no redundant conditions there; with loads and without loops on the tree, too), "RK44:STEPS",
"RK67:STEPS" and "DOPRI5:TOLERANCE" on a tree of minimal coordinates, whose balls are three hinges. Springs and dampers of
joints are what its tree has for controllers; gears are conditions on coordinates, for the first two."""
import math

import exudyn as exu
import numpy as np
from exudyn.itemInterface import (CoordinateConstraint, Force, MarkerBodyPosition, MarkerBodyRigid, MarkerNodeCoordinate,
                                  MassPoint2D, NodeGenericODE2, NodePoint2D, NodePointGround, ObjectKinematicTree,
                                  PrismaticJoint2D, RevoluteJoint2D, Rigid2D, RigidBody2D, SpringDamper)
from exudyn.utilities import RigidBodyInertia

from serve import JointLoad, inside, of_kind, place_of, serve, tree, turn_of

HINGES = [exu.JointType.RevoluteX, exu.JointType.RevoluteY, exu.JointType.RevoluteZ]
SLIDES = [exu.JointType.PrismaticX, exu.JointType.PrismaticY, exu.JointType.PrismaticZ]


def about(axis, angle):
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R = np.eye(3)
    R[i, i] = R[j, j] = np.cos(angle)
    R[j, i] = np.sin(angle)
    R[i, j] = -R[j, i]
    return R


def coordinates_of(branches):
    """(kind, axis, parent coordinate, orientation, place, body or None, rate, load): one for a hinge or slide, three for
    a ball."""
    found, last = [], {-1: -1}
    for i, b in enumerate(branches):
        if b.parent is None:
            raise ValueError("a tree has no free bodies")
        axes = [2, 1, 0] if b.kind == "ball" else [int(np.argmax(np.abs(b.axis)))]
        if b.kind != "ball" and not b.axis[axes[0]] > 1 - 1e-12:
            raise ValueError("axes of a tree are those of bodies")
        rates = [0 if b.kind == "slide" else b.rate[a] for a in axes]
        for k, axis in enumerate(axes):
            first, end = k == 0, k == len(axes) - 1
            found.append(((SLIDES if b.kind == "slide" else HINGES)[axis], axis, last[b.parent] if first else len(found) - 1,
                          b.R if first else np.eye(3), b.place if first else np.zeros(3), b.body if end else None,
                          rates[k], JointLoad() if b.kind == "ball" else b.load))
        last[i] = len(found) - 1
    return found, last


def moved(frames, coordinate, q):
    """Place and orientation of what hangs on a coordinate."""
    kind, axis, parent, R, place, *_ = coordinate
    x, A = frames[parent]
    x, A = x + A @ place, A @ R
    return (x + A[:, axis] * q, A) if kind in SLIDES else (x, A @ about(axis, q))


def add_tree(mbs, m):
    branches, rest = tree(m)
    if rest:
        raise ValueError("a tree has neither closed loops nor rods")
    if of_kind(m, "bushing") or of_kind(m, "spring"):
        raise ValueError("a tree has no springs between points")
    coordinates, last = coordinates_of(branches)
    n = len(coordinates)
    node = mbs.AddNode(NodeGenericODE2(referenceCoordinates=[0.0] * n, initialCoordinates=[0.0] * n,
                                       initialCoordinates_t=[float(c[6]) for c in coordinates],
                                       numberOfODE2Coordinates=n))
    turns, inertias = exu.Matrix3DList(), exu.Matrix3DList()
    places, centers = exu.Vector3DList(), exu.Vector3DList()
    for _, _, _, R, place, body, *_ in coordinates:
        turns.Append(np.array(R))
        places.Append(np.array(place))
        inertias.Append(np.diag(body.inertia) if body else np.zeros((3, 3)))
        centers.Append(np.array(body.center) if body else np.zeros(3))
    loads = [c[7] for c in coordinates]
    mbs.AddObject(ObjectKinematicTree(
        nodeNumber=node, jointTypes=[c[0] for c in coordinates], linkParents=np.array([c[2] for c in coordinates]),
        jointTransformations=turns, jointOffsets=places, linkInertiasCOM=inertias, linkCOMs=centers,
        linkMasses=np.array([c[5].mass if c[5] else 0.0 for c in coordinates]), gravity=list(m.gravity),
        **({"jointPControlVector": [load.stiffness for load in loads], "jointDControlVector": [load.damping for load in loads],
            "jointPositionOffsetVector": [0.0] * n, "jointVelocityOffsetVector": [0.0] * n,
            "jointForceVector": [load.push for load in loads]} if m.loads else {})))
    for first, second, ratio in of_kind(m, "gear"):
        markers = [mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=last[m.joints[int(j)][2]]))
                   for j in (second, first)]
        mbs.AddObject(CoordinateConstraint(markerNumbers=markers, factorValue1=ratio))

    def points():
        q, frames = mbs.systemData.GetODE2Coordinates(), {-1: (np.zeros(3), np.eye(3))}
        for i, coordinate in enumerate(coordinates):
            frames[i] = moved(frames, coordinate, q[i])
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
    across = [numbers[3:6] for kind, _, _, numbers in m.joints if kind == "slide"]
    if not axes or any(abs(a @ axes[0]) < 1 - 1e-12 for a in axes) or any(abs(a @ axes[0]) > 1e-12 for a in across):
        return None
    if any(kind == "rod" for kind, *_ in m.joints) or m.joints[0][0] == "ball":
        return None
    k = int(np.argmax(axes[0]))
    return np.array([np.eye(3)[(k + 1) % 3], np.eye(3)[(k + 2) % 3]])


class Plane:
    """Bodies that move in a plane, their coordinates in it from their centres of mass, along axes that are those of the
    plane at the start."""

    def __init__(self, mbs, m, axes):
        self.mbs, self.m, self.axes, self.normal = mbs, m, axes, np.cross(*axes)
        self.ground, self.bodies = mbs.CreateGround(), [self.add_body(i) for i in range(len(m.bodies))]
        for joint in m.joints:
            self.add_joint(*joint)
        for spring in of_kind(m, "spring"):
            self.add_spring(*spring)

    def center(self, i):
        return self.axes @ (place_of(self.m, i) + turn_of(self.m, i) @ self.m.bodies[i].center)

    def add_body(self, i):
        b, mbs = self.m.bodies[i], self.mbs
        v = self.axes @ (np.array(b.v) + np.cross(b.w, turn_of(self.m, i) @ b.center))
        node = mbs.AddNode(Rigid2D(referenceCoordinates=[*self.center(i), 0],
                                   initialVelocities=[*v, float(self.normal @ b.w)]))
        inertia = float(np.abs(turn_of(self.m, i).T @ self.normal) @ b.inertia)
        body = mbs.AddObject(RigidBody2D(mass=b.mass, inertia=inertia, nodeNumber=node))
        marker = mbs.AddMarker(MarkerBodyPosition(bodyNumber=body, localPosition=[0, 0, 0]))
        mbs.AddLoad(Force(markerNumber=marker, loadVector=[*(b.mass * (self.axes @ self.m.gravity)), 0]))
        return body

    def inside(self, i, at):
        """Of a point in coordinates of a body."""
        return [*(self.axes @ at), 0] if i < 0 else [*(self.axes @ (turn_of(self.m, i) @ (at - self.m.bodies[i].center))), 0]

    def marker(self, i, at, kind=MarkerBodyPosition):
        return self.mbs.AddMarker(kind(bodyNumber=self.ground if i < 0 else self.bodies[i],
                                       localPosition=self.inside(i, np.array(at))))

    def add_joint(self, kind, first, second, numbers):
        places = [(i, inside(self.m, i, numbers[:3])) for i in (first, second)]
        if kind == "slide":
            axis = self.axes @ numbers[3:6]
            self.mbs.AddObject(PrismaticJoint2D(markerNumbers=[self.marker(*p, MarkerBodyRigid) for p in places],
                                                axisMarker0=[*axis, 0], normalMarker1=[-axis[1], axis[0], 0],
                                                constrainRotation=True))
        else:
            self.mbs.AddObject(RevoluteJoint2D(markerNumbers=[self.marker(*p) for p in places]))

    def add_spring(self, first, second, *numbers):
        p, q, (stiffness, damping, length, amplitude, omega) = numbers[:3], numbers[3:6], numbers[6:]
        from_marker = self.road(p, amplitude, omega) if amplitude else self.marker(int(first), p)
        self.mbs.AddObject(SpringDamper(markerNumbers=[from_marker, self.marker(int(second), q)], stiffness=stiffness,
                                        damping=damping, referenceLength=length))

    def road(self, p, amplitude, omega):
        """A point that is led along z."""
        mbs, up = self.mbs, self.axes @ [0, 0, 1]
        node = mbs.AddNode(NodePoint2D(referenceCoordinates=list(self.axes @ p), initialVelocities=list(amplitude * omega * up)))
        body = mbs.AddObject(MassPoint2D(physicsMass=1, nodeNumber=node))
        still = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=mbs.AddNode(NodePointGround()), coordinate=0))
        for k in range(2):
            led = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=k))
            share = amplitude * up[k]
            mbs.AddObject(CoordinateConstraint(markerNumbers=[still, led], **(
                {"offsetUserFunction": lambda mbs, t, item, offset: share * math.sin(omega * t)} if share else {})))
        return mbs.AddMarker(MarkerBodyPosition(bodyNumber=body, localPosition=[0, 0, 0]))

    def points(self):
        found = []
        for body, at in self.m.points:
            p = self.mbs.GetObjectOutputBody(self.bodies[body], exu.OutputVariableType.Position,
                                             localPosition=self.inside(body, at),
                                             configuration=exu.ConfigurationType.Current)
            start = place_of(self.m, body) + turn_of(self.m, body) @ at
            found.append(p[:2] @ self.axes + self.normal * (self.normal @ start))
        return found


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
    if kind in ("alpha", "trapezoid") and not (m.loads and not tree(m)[1]):
        plane = plane_of(m)
        points = add_in_space(mbs, m) if plane is None else Plane(mbs, m, plane).points
    else:
        if of_kind(m, "gear") and kind not in ("alpha", "trapezoid"):
            raise ValueError("explicit solvers have no conditions")
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
