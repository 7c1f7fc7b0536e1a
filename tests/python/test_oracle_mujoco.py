"""A trajectory against MuJoCo with three `connect` constraints, whose softness is known and shrinks.

MuJoCo's constraints are springs by design: with impedance d the joint accelerates apart by (1 - d)
of what it would do unconstrained, against a spring of time constant `TIME_CONSTANT`. A joint
therefore gapes by about (1 - d) / d a TIME_CONSTANT^2, and as d goes to 1 the motion must go to
ours, the error with (1 - d).
"""

import mujoco
import numpy as np
import oracle
import pytest
from oracle import LATERAL, RADIAL, UP, Array, Motors
from scipy.spatial.transform import Rotation

STEP = 1e-4
DURATION = 0.25
# the smallest that MuJoCo accepts is two steps
TIME_CONSTANT = 4 * STEP
SOFTNESS = (0.1, 0.01, 0.001)
# gravity, the motors' forces and the centrifugal ones tear at the joints with less than this, m/s2
ACCELERATION = 20.0


def vector(values: Array) -> str:
    return " ".join(repr(float(x)) for x in values)


def quaternion(rotation: Array) -> str:
    return vector(Rotation.from_matrix(rotation).as_quat(scalar_first=True))


def description(p: dict[str, float | bool], softness: float) -> str:
    """The mechanism in MJCF: limbs at theta = 0 along x, the revolute axes along z."""
    motors = Motors.of(p)
    limbs = ""
    for i in range(3):
        frame = np.stack([-RADIAL[i], UP, LATERAL[i]], axis=1)
        bodies = {
            "lower": (p["lower_com"], f'type="hinge" axis="0 0 1" armature="{motors.inertia[2 * i]}"'),
            "upper": (-p["upper_com"], f'type="slide" axis="1 0 0" armature="{motors.inertia[2 * i + 1]}"'),
        }
        placement = f'pos="{vector(p["base_radius"] * RADIAL[i])}" quat="{quaternion(frame)}"'
        for k, (name, (com, joint)) in enumerate(bodies.items()):
            mass, inertia = p[f"{name}_mass"], p[f"{name}_inertia"]
            limbs += f"""
            <body {placement}>
              <joint {joint} damping="{motors.friction[2 * i + k]}"/>
              <inertial mass="{mass}" pos="{com} 0 0" diaginertia="{inertia} {inertia} {inertia}"/>"""
            placement = ""
        limbs += f'<site name="limb{i}"/></body></body>'
    r_b = p["joint_spacing"] / np.sqrt(3)
    sites = "".join(f'<site name="plate{i}" pos="{vector(r_b * RADIAL[i])}"/>' for i in range(3))
    closures = "".join(f'<connect site1="limb{i}" site2="plate{i}"/>' for i in range(3))
    impedance = 1 - softness
    return f"""
    <mujoco>
      <compiler inertiafromgeom="false"/>
      <option timestep="{STEP}" integrator="RK4" gravity="0 0 {-p["gravity"]}" solver="Newton"
              tolerance="0" iterations="20" jacobian="dense"/>
      <default><equality solref="{TIME_CONSTANT} 1" solimp="{impedance} {impedance} 0.001"/></default>
      <worldbody>{limbs}
        <body name="plate"><freejoint/>
          <inertial mass="{p["plate_mass"]}" pos="0 0 0"
                    diaginertia="{p["plate_ixx"]} {p["plate_ixx"]} {p["plate_izz"]}"/>{sites}
        </body>
      </worldbody>
      <equality>{closures}</equality>
    </mujoco>"""


def simulate(p: dict[str, float | bool], state: Array, softness: float) -> tuple[Array, float]:
    """Rows of (heave, tilt_x, tilt_y) every 10 ms and the largest gap between joint halves."""
    model = mujoco.MjModel.from_xml_string(description(p, softness))
    data = mujoco.MjData(model)
    c = oracle.configuration(p, state)
    data.qpos[:6], data.qvel[:6] = c.joints, c.joint_rates
    data.qpos[6:9], data.qvel[6:9] = c.position, c.velocity
    data.qpos[9:13] = Rotation.from_matrix(c.rotation).as_quat(scalar_first=True)
    data.qvel[9:12] = c.rotation.T @ c.omega
    data.qfrc_applied[:6] = Motors.of(p).force * np.stack([state[9:12], state[6:9]], axis=1).ravel()
    rows, gap = [], 0.0
    for k in range(round(DURATION / STEP) + 1):
        if k % 100 == 0:
            tilt = Rotation.from_quat(data.qpos[9:13], scalar_first=True).as_rotvec()
            rows.append([data.qpos[8], tilt[0], tilt[1]])
        mujoco.mj_step(model, data)
        for i in range(3):
            halves = data.site(f"limb{i}").xpos - data.site(f"plate{i}").xpos
            gap = max(gap, float(np.linalg.norm(halves)))
    return np.array(rows), gap


@pytest.fixture(scope="module")
def start() -> Array:
    """A tilted start in motion, with currents that about carry the weight."""
    return np.array([0.09, 0.12, 0.08, -0.2, -0.3, 0.4, 0.1, 0.05, 0.12, 0.2, 0.1, 0.25])


def test_mujoco_s_trajectory_converges_to_ours_as_its_constraints_stiffen(start: Array) -> None:
    p = oracle.DEFAULTS
    times = np.arange(0, DURATION + STEP / 2, 100 * STEP)
    request = {"parameters": p, "states": [start.tolist()], "loads": [[0.0] * 6], "times": times.tolist()}
    ours = oracle.rust([request])[0]["coordinates"]
    travel = np.abs(ours - ours[0]).max(axis=0)
    assert travel.min() > 0.01, "a motion worth comparing"
    r_b = p["joint_spacing"] / np.sqrt(3)
    scale = np.array([1.0, r_b, r_b])
    errors = []
    for softness in SOFTNESS:
        theirs, gap = simulate(p, start, softness)
        errors.append(float(np.abs((theirs - ours) * scale).max()))
        assert gap < softness / (1 - softness) * ACCELERATION * TIME_CONSTANT**2
    # first order in the softness until the integrators' errors show
    assert errors[1] < 0.2 * errors[0] and errors[2] < 0.2 * errors[1]
    assert errors[2] < 1e-8
