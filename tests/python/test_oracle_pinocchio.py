"""Accelerations and joint forces against Pinocchio, which knows nothing of this mechanism.

There: three (revolute, prismatic) chains and a free-flying platform, 12 degrees of freedom, closed
by three point constraints (9 equations); rotor inertia as armature. Here: three generalized
coordinates and projected Newton-Euler equations.
"""

import numpy as np
import oracle
import pinocchio as pin
import pytest
from oracle import LATERAL, RADIAL, UP, Array, Configuration, Motors

PARAMETER_SETS = 20
STATES = 1000
TOLERANCE = 1e-8


class Mechanism:
    """The 3-RPS as Pinocchio's model."""

    def __init__(self, p: dict[str, float | bool]) -> None:
        self.p = p
        self.motors = Motors.of(p)
        model = pin.Model()
        model.gravity.linear = np.array([0.0, 0.0, -p["gravity"]])
        links = []
        for i in range(3):
            # at theta = 0 the limb points inwards along x; z is the revolute axis
            frame = np.stack([-RADIAL[i], UP, LATERAL[i]], axis=1)
            lower = model.addJoint(0, pin.JointModelRZ(), pin.SE3(frame, p["base_radius"] * RADIAL[i]), f"revolute{i}")
            model.appendBodyToJoint(lower, self.link("lower", p["lower_com"]), pin.SE3.Identity())
            upper = model.addJoint(lower, pin.JointModelPX(), pin.SE3.Identity(), f"prismatic{i}")
            model.appendBodyToJoint(upper, self.link("upper", -p["upper_com"]), pin.SE3.Identity())
            links.append(upper)
        plate = model.addJoint(0, pin.JointModelFreeFlyer(), pin.SE3.Identity(), "plate")
        inertia = np.diag([p["plate_ixx"], p["plate_ixx"], p["plate_izz"]])
        model.appendBodyToJoint(plate, pin.Inertia(p["plate_mass"], np.zeros(3), inertia), pin.SE3.Identity())
        model.armature = np.append(self.motors.inertia, np.zeros(6))
        r_b = p["joint_spacing"] / np.sqrt(3)
        at_plate = [pin.SE3(np.eye(3), r_b * RADIAL[i]) for i in range(3)]
        closures = [
            pin.RigidConstraintModel(
                pin.ContactType.CONTACT_3D, model, links[i], pin.SE3.Identity(), plate, at_plate[i],
                pin.ReferenceFrame.LOCAL,
            )
            for i in range(3)
        ]  # fmt: skip
        self.model, self.data = model, model.createData()
        self.closures, self.closure_data = pin.StdVec_RigidConstraintModel(), pin.StdVec_RigidConstraintData()
        self.closures.extend(closures)
        self.closure_data.extend([closure.createData() for closure in closures])
        pin.initConstraintDynamics(model, self.data, self.closures, self.closure_data)
        self.proximal = pin.ProximalSettings(1e-14, 0.0, 1)

    def link(self, name: str, com: float) -> pin.Inertia:
        """A link along x; it only ever turns about z, so one moment of inertia matters."""
        p = self.p
        return pin.Inertia(p[f"{name}_mass"], np.array([com, 0.0, 0.0]), p[f"{name}_inertia"] * np.eye(3))

    def accelerate(self, c: Configuration, currents: Array, load: Array) -> tuple[Array, Array]:
        """Accelerations (limb joints, then P and about it, base frame) and forces on the platform (base frame)."""
        to_plate = c.rotation.T
        q = np.concatenate([c.joints, c.position, pin.Quaternion(c.rotation).coeffs()])
        v = np.concatenate([c.joint_rates, to_plate @ c.velocity, to_plate @ c.omega])
        drives = self.motors.force * currents - self.motors.friction * c.joint_rates
        tau = np.concatenate([drives, to_plate @ load[:3], to_plate @ load[3:]])
        a = pin.constraintDynamics(self.model, self.data, q, v, tau, self.closures, self.closure_data, self.proximal)
        # spatial acceleration in the platform's frame -> classical, base frame
        linear = c.rotation @ (a[6:9] + np.cross(v[9:12], v[6:9]))
        accelerations = np.concatenate([a[:6], linear, c.rotation @ a[9:12]])
        forces = []
        for i, data in enumerate(self.closure_data):
            frame = np.stack([c.axial[i], c.normal[i], LATERAL[i]], axis=1)
            forces.append(-frame @ data.contact_force.linear)
        return accelerations, np.array(forces)


@pytest.fixture(scope="module")
def cases() -> list[tuple[dict[str, float | bool], Array, Array, dict[str, Array]]]:
    rng = np.random.default_rng(1)
    drawn = []
    for k in range(PARAMETER_SETS):
        p = oracle.random_parameters(rng) if k else oracle.DEFAULTS
        states = oracle.random_states(rng, p, STATES)
        loads = rng.uniform(-1, 1, (STATES, 6)) * [50, 50, 50, 5, 5, 5]
        drawn.append((p, states, loads))
    requests = [{"parameters": p, "states": s.tolist(), "loads": w.tolist()} for p, s, w in drawn]
    return [(*case, answer) for case, answer in zip(drawn, oracle.rust(requests), strict=True)]


def test_accelerations_and_joint_forces_agree_with_pinocchio(cases) -> None:
    worst = {"acceleration": 0.0, "force": 0.0}
    for p, states, loads, answer in cases:
        mechanism = Mechanism(p)
        for k, (state, load) in enumerate(zip(states, loads, strict=True)):
            c = oracle.configuration(p, state)
            # limb order here: revolute, then leg; states hold the legs' currents first
            currents = np.stack([state[9:12], state[6:9]], axis=1).ravel()
            accelerations, forces = mechanism.accelerate(c, currents, load)
            limb_joints = np.stack([answer["angle"][k], answer["length"][k]], axis=1).ravel()
            ours = np.concatenate([limb_joints, answer["linear"][k], answer["angular"][k]])
            ours_force = (
                answer["axial"][k][:, None] * c.axial
                + answer["normal"][k][:, None] * c.normal
                + answer["lateral"][k][:, None] * LATERAL
            )
            for name, a, b in (("acceleration", ours, accelerations), ("force", ours_force, forces)):
                worst[name] = max(worst[name], float(np.abs(a - b).max() / max(1.0, np.abs(b).max())))
    assert max(worst.values()) < TOLERANCE, worst
