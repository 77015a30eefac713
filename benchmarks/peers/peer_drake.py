# SPDX-License-Identifier: BSD-3-Clause
"""Drake's continuous MultibodyPlant. Settings: "SCHEME:ACCURACY", schemes as SimulatorConfig names them."""
import numpy as np
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import (BallRpyJoint, FixedOffsetFrame, PrismaticJoint, PrismaticSpring, RevoluteJoint,
                                    RevoluteSpring, RotationalInertia, SpatialInertia)
from pydrake.systems.analysis import ApplySimulatorConfig, Simulator, SimulatorConfig

from serve import of_kind, serve, tree


def add_joint(plant, name, b, frame, body):
    if b.kind == "ball":
        return plant.AddJoint(BallRpyJoint(name, frame, body))
    kind, spring = (RevoluteJoint, RevoluteSpring) if b.kind == "hinge" else (PrismaticJoint, PrismaticSpring)
    joint = plant.AddJoint(kind(name, frame, body, b.axis, damping=b.load.damping))
    if b.load.stiffness:
        plant.AddForceElement(spring(joint, b.load.push / b.load.stiffness, b.load.stiffness))
    return joint


def plant_of(m):
    branches, rest = tree(m)
    if rest:
        raise ValueError("its continuous plants have neither closed loops nor rods")
    if of_kind(m, "gear"):
        raise ValueError("its continuous plants have no gears")
    if of_kind(m, "bushing"):
        raise ValueError("its bushing has another law")
    plant, bodies, joints = MultibodyPlant(0.0), [], []
    for i, b in enumerate(branches):
        J = np.maximum(b.body.inertia, 1e-12)   # zero is refused
        body = plant.AddRigidBody(f"b{i}", SpatialInertia.MakeFromCentralInertia(
            b.body.mass, b.body.center, RotationalInertia(*J)) if b.body.mass else SpatialInertia.Zero())
        parent = plant.world_frame() if b.parent == -1 else bodies[b.parent].body_frame()
        at = RigidTransform(RotationMatrix.ProjectToRotationMatrix(b.R), b.place)
        frame = plant.AddFrame(FixedOffsetFrame(f"f{i}", parent, at))
        joints.append(add_joint(plant, f"j{i}", b, frame, body.body_frame()))
        bodies.append(body)
    plant.mutable_gravity_field().set_gravity_vector(m.gravity)
    plant.Finalize()
    return plant, bodies, joints, branches


def prepare(m, setting):
    plant, bodies, joints, branches = plant_of(m)
    simulator = Simulator(plant)
    ApplySimulatorConfig(SimulatorConfig(integration_scheme=setting[0], accuracy=float(setting[1]),
                                         max_step_size=0.1, use_error_control=True), simulator)
    for b, joint in zip(branches, joints):
        if b.kind == "hinge":
            joint.set_angular_rate(simulator.get_mutable_context(), b.rate @ b.axis)
    simulator.Initialize()

    def points():
        context = simulator.get_context()
        return [plant.EvalBodyPoseInWorld(context, bodies[i]) @ at for i, at in m.points]

    def solve():
        simulator.AdvanceTo(m.end)
        return points
    return solve


if __name__ == "__main__":
    serve(prepare)
