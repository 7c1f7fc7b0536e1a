"""The plant's right-hand side against Pinocchio and MuJoCo."""

from __future__ import annotations

import tempfile
from pathlib import Path
from time import perf_counter

import mujoco
import numpy as np
import oracle
import pinocchio as pin
from oracle import Array
from test_oracle_mujoco import description
from test_oracle_pinocchio import Mechanism

from suite import peers
from suite.peers import Native, Program, fastest
from suite.table import Row

STATES = 100
SECTION = "right-hand side"
# softness of MuJoCo's constraints; its cost does not depend on it
SOFTNESS = 0.01
MUJOCO_STEPS = 100


def vectors(mechanism: Mechanism, state: Array) -> tuple[Array, Array, Array]:
    """Pinocchio's q, v and tau at a state."""
    c = oracle.configuration(mechanism.p, state)
    q = np.concatenate([c.joints, c.position, pin.Quaternion(c.rotation).coeffs()])
    v = np.concatenate([c.joint_rates, c.rotation.T @ c.velocity, c.rotation.T @ c.omega])
    currents = np.stack([state[9:12], state[6:9]], axis=1).ravel()
    drives = mechanism.motors.force * currents - mechanism.motors.friction * c.joint_rates
    return q, v, np.concatenate([drives, np.zeros(6)])


def cases(mechanism: Mechanism, states: Array) -> str:
    """The file that benches/peers/pinocchio.cpp reads."""
    lines = [f"{len(mechanism.closures)} {len(states)}"]
    for closure in mechanism.closures:
        point = closure.joint2_placement.translation
        lines.append(f"{closure.joint1_id} {closure.joint2_id} " + " ".join(map(repr, point.tolist())))
    lines += [" ".join(map(repr, vector.tolist())) for state in states for vector in vectors(mechanism, state)]
    return "\n".join(lines) + "\n"


class Mujoco:
    """mj_step of the mechanism, with the explicit Euler method: one evaluation of the dynamics a step."""

    def __init__(self, p: dict[str, float | bool], state: Array) -> None:
        text = description(p, SOFTNESS).replace('integrator="RK4"', 'integrator="Euler"')
        # as it is used: to its default tolerance rather than to the last bit, as the oracle asks for
        text = text.replace('tolerance="0" iterations="20"', "")
        self.model = mujoco.MjModel.from_xml_string(text)
        self.data = mujoco.MjData(self.model)
        c = oracle.configuration(p, state)
        self.qpos = np.concatenate([c.joints, c.position, pin.Quaternion(c.rotation).coeffs()[[3, 0, 1, 2]]])
        self.qvel = np.concatenate([c.joint_rates, c.velocity, c.rotation.T @ c.omega])

    def seconds(self) -> float:
        """A step, by MuJoCo's own loop over many: no Python in between."""
        mujoco.mj_resetData(self.model, self.data)
        self.data.qpos[:], self.data.qvel[:] = self.qpos, self.qvel
        begin = perf_counter()
        mujoco.mj_step(self.model, self.data, MUJOCO_STEPS)
        return (perf_counter() - begin) / MUJOCO_STEPS


def measure(native: Native, rounds: int) -> list[Row]:
    """Our right-hand side against both, all in turn; agreement is checked on the way."""
    p = oracle.DEFAULTS
    states = oracle.random_states(np.random.default_rng(1), p, STATES)
    mechanism = Mechanism(p)
    still = np.zeros(12)
    still[0] = 0.05
    mujoco_step = Mujoco(p, still)
    program = peers.pinocchio()
    candidates = {
        "ours": lambda: native.measure("right_hand_side", states=states.tolist(), rounds=10),
        "mujoco": mujoco_step.seconds,
    }
    if program is None:
        times = fastest(rounds, candidates)
        return [Row(SECTION, "rps3", times["ours"], "MuJoCo 4 `mj_step`", times["mujoco"], "no g++: no Pinocchio")]
    with tempfile.TemporaryDirectory() as directory:
        model, file = Path(directory) / "model.txt", Path(directory) / "cases.txt"
        mechanism.model.saveToText(str(model))
        file.write_text(cases(mechanism, states), encoding="utf-8")
        with Program(program, model, file) as pinocchio:
            theirs = np.array(pinocchio.line().split(), dtype=float).reshape(STATES, -1)
            times = fastest(rounds, {**candidates, "pinocchio": lambda: float(pinocchio.ask("1"))})
    (answer,) = oracle.rust([{"parameters": p, "states": states.tolist(), "loads": [[0.0] * 6] * STATES}])
    ours = np.stack([answer["angle"], answer["length"]], axis=2).reshape(STATES, 6)
    worst = float((np.abs(ours - theirs[:, :6]).max(axis=1) / np.maximum(1.0, np.abs(theirs[:, :6]).max(axis=1))).max())
    if worst > 1e-8:
        raise AssertionError(f"the joints' accelerations differ by {worst:.1e}")
    return [
        Row(
            SECTION, "rps3", times["ours"], "Pinocchio 4 `constraintDynamics`, C++", times["pinocchio"],
            f"accelerations agree to {worst:.0e}",
        ),
        Row(SECTION, "rps3", times["ours"], "MuJoCo 4 `mj_step`, Euler", times["mujoco"], "one evaluation a step"),
    ]  # fmt: skip
