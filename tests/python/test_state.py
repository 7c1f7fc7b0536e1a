"""FMU states: rollback and serialization are bit-identical."""

import multiprocessing
from pathlib import Path

import pytest
from fmpy.fmi1 import FMICallException
from rps3_study.fmu import Fmu, Instance, Value, extracted

STEP = 1e-3


def advance(instance: Instance, first: int, count: int) -> list[dict[str, Value]]:
    """Outputs after each of `count` steps from step `first` on, with inputs that change."""
    excited = "v_leg1" if "v_leg1" in instance.fmu.names("input") else "d1"
    rows = []
    for k in range(first, first + count):
        instance.set({excited: 0.2165 + 1e-4 * (k % 7)})
        instance.step(k * STEP, STEP)
        rows.append(instance.get(instance.fmu.names("output")))
    return rows


def test_replay_from_a_saved_state_is_bit_identical(fmu: Fmu, settings: dict[str, Value]) -> None:
    with Instance(fmu) as instance:
        instance.initialize(settings)
        advance(instance, 0, 20)
        state = instance.slave.getFMUstate()
        first = advance(instance, 20, 30)
        instance.slave.setFMUstate(state)
        assert advance(instance, 20, 30) == first
        instance.slave.freeFMUstate(state)


@pytest.mark.master("FMPy", "FMU state, serialized")
def test_serialized_state_continues_bit_identically_in_another_instance(fmu: Fmu, settings: dict[str, Value]) -> None:
    with Instance(fmu, "first") as one, Instance(fmu, "second") as two:
        one.initialize(settings)
        advance(one, 0, 20)
        state = one.slave.getFMUstate()
        data = one.slave.serializeFMUstate(state)
        expected = advance(one, 20, 30)
        two.initialize(settings)
        restored = two.slave.deSerializeFMUstate(data)
        two.slave.setFMUstate(restored)
        assert advance(two, 20, 30) == expected
        one.slave.freeFMUstate(state)
        two.slave.freeFMUstate(restored)


def continued(archive: Path, settings: dict[str, Value], data: bytes) -> list[dict[str, Value]]:
    """What follows step 20 from a serialized state, in an FMU unpacked and loaded anew."""
    with extracted(archive) as (fmu,), Instance(fmu) as instance:
        instance.initialize(settings)
        state = instance.slave.deSerializeFMUstate(data)
        instance.slave.setFMUstate(state)
        rows = advance(instance, 20, 30)
        instance.slave.freeFMUstate(state)
        return rows


@pytest.mark.parametrize("mode", [2, 4], ids=["no random numbers", "random numbers"])
def test_serialized_state_continues_bit_identically_in_another_process(fmu: Fmu, mode: int) -> None:
    settings: dict[str, Value] = {"control_mode": mode} if "control_mode" in fmu.variables else {}
    with Instance(fmu) as instance:
        instance.initialize(settings)
        advance(instance, 0, 20)
        state = instance.slave.getFMUstate()
        data = instance.slave.serializeFMUstate(state)
        expected = advance(instance, 20, 30)
        instance.slave.freeFMUstate(state)
    with multiprocessing.get_context("spawn").Pool(1) as other:
        assert other.apply(continued, (fmu.archive, settings, data)) == expected


@pytest.mark.parametrize("damage", ["truncated", "flipped", "foreign"])
def test_damaged_state_is_refused_and_the_instance_goes_on_unharmed(
    fmu: Fmu, fmus: dict[str, Fmu], settings: dict[str, Value], damage: str
) -> None:
    with Instance(fmu) as instance, Instance(fmu) as twin:
        for one in (instance, twin):
            one.initialize(settings)
            advance(one, 0, 5)
        state = instance.slave.getFMUstate()
        data = instance.slave.serializeFMUstate(state)
        if damage == "truncated":
            data = data[: len(data) // 2]
        elif damage == "flipped":
            middle = len(data) // 2
            data = data[:middle] + bytes([data[middle] ^ 0x10]) + data[middle + 1 :]
        else:
            other = next(f for f in fmus.values() if f is not fmu)
            with Instance(other) as foreign:
                foreign.initialize({"control_mode": 2} if "control_mode" in other.variables else {})
                theirs = foreign.slave.getFMUstate()
                data = foreign.slave.serializeFMUstate(theirs)
                foreign.slave.freeFMUstate(theirs)
        with pytest.raises(FMICallException):
            instance.slave.deSerializeFMUstate(data)
        assert any(message.status == 3 for message in instance.messages)
        instance.slave.setFMUstate(state)
        assert advance(instance, 5, 10) == advance(twin, 5, 10)
        instance.slave.freeFMUstate(state)
