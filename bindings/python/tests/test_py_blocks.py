"""The classes of the function blocks: their memory is that of C, wrong values are exceptions, the cycle calls them."""
import random
import threading
from datetime import timedelta
from enum import IntEnum

import numpy
import pytest

import cm1e
from cm1e import blocks
from cm1e._cm1e import ffi

STRUCTS = [item for item in vars(blocks).values()
           if isinstance(item, type) and issubclass(item, blocks.Struct) and hasattr(item, "_c_type")]


@pytest.fixture
def bus():
    with cm1e.Bus(axes=[{"name": "X", "counts_per_unit": 5000}, {"name": "Y", "counts_per_unit": 5000}],
                  virtual_time=True) as bus:
        yield bus


def a_value(member, chance):
    if member.kind == "enum":
        return chance.choice(list(member.of))
    return {"bool": lambda: chance.random() < 0.5, "float": lambda: chance.uniform(-1e6, 1e6),
            "int": lambda: chance.randint(0, 127), "str": lambda: "µ" * chance.randint(0, 40),
            "timedelta": lambda: timedelta(microseconds=chance.randint(-10**12, 10**12))}[member.kind]()


@pytest.mark.parametrize("kind", STRUCTS, ids=lambda kind: kind.__name__)
def test_what_is_written_is_read(kind):
    item, chance = kind({}) if kind is blocks.Struct else kind(), random.Random(1)
    assert dict(ffi.typeof(kind._c_type).fields).keys() - {"Private"} == kind._members.keys()
    for member in kind._members.values():
        if member.section == "output":
            with pytest.raises(AttributeError, match="output"):
                setattr(item, member.name, 0)
        elif member.kind in ("enum", "bool", "float", "int", "str", "timedelta") and \
                not member.name.startswith("NumberOf"):
            for _ in range(5):
                value = a_value(member, chance)
                setattr(item, member.name, value)
                assert getattr(item, member.name) == value
                assert type(getattr(item, member.name)) is type(value)


@pytest.mark.parametrize("kind", STRUCTS, ids=lambda kind: kind.__name__)
def test_wrong_types_are_exceptions(kind):
    item = kind()
    for member in kind._members.values():
        if member.section == "output":
            continue
        for wrong in (object(), "1" if member.kind != "str" else 1, [object()], None, b"x", 1 + 1j, numpy.complex128(1),
                      1.0 if member.kind == "bool" else numpy.bool_(True)):
            with pytest.raises((TypeError, ValueError)):
                setattr(item, member.name, wrong)
    with pytest.raises(AttributeError, match=kind.__name__):
        item.Positon = 1
    with pytest.raises(AttributeError):
        item.Nothing


def test_values_out_of_range():
    move = blocks.MC_MoveAbsolute()
    with pytest.raises(AttributeError, match="did you mean Position"):
        move.Positon = 1
    for name, wrong, error in (("Position", float("nan"), ValueError), ("Direction", 99, ValueError),
                               ("Direction", blocks.MC_BUFFER_MODE.mcBlendingLow, TypeError), ("Execute", 1, TypeError),
                               ("Position", True, TypeError)):
        with pytest.raises(error, match=name):
            setattr(move, name, wrong)
    for name in ("Position", "Axis", "Direction", "Execute"):  # None is not "as it was", and not 0
        with pytest.raises(TypeError, match=f"{name}: expected .*, not None"):
            blocks.MC_MoveAbsolute(**{name: None})
    with pytest.raises(ValueError, match="INT"):
        blocks.MC_ReadParameter(ParameterNumber=40000)
    with pytest.raises(TypeError, match="timedelta"):
        blocks.TON(PT=5)
    with pytest.raises(ValueError, match="80 bytes"):
        blocks.CM_SendCML(Command="x" * 81)
    with pytest.raises(ValueError, match="at most 8"):
        blocks.MC_MoveLinearAbsolute(Position=[1.0] * 9)
    with pytest.raises(ValueError, match="NumberOfPoints is 3"):
        blocks.MC_CAM_REF(Points=[blocks.MC_CAM_POINT(), blocks.MC_CAM_POINT()], NumberOfPoints=3)


def test_every_block_is_called_without_its_axis(bus):
    """None of them crashes; those that need an axis say so."""
    said = {}

    @bus.on_cycle
    def program(_):
        for name, kind in blocks.BLOCKS.items():
            block = kind()
            for trigger in ("Execute", "Enable"):
                if trigger in kind._members:
                    setattr(block, trigger, True)
            block()
            if "ErrorID" in kind._members:
                said[name] = block.ErrorID
    bus.cycles(1)
    assert len(blocks.BLOCKS) > 80 and len(said) > 60
    refused = {name for name, number in said.items() if number in (0x1E00 + 90, 0x1E00 + 140)}
    assert len(refused) > 60, said


def test_every_block_with_an_axis_and_nothing_else(bus):
    """Pointers that a program leaves out lead nowhere."""
    x, y = bus.axes
    x.enable()

    @bus.on_cycle
    def program(_):
        for kind in blocks.BLOCKS.values():
            inputs = {member.name: y if member.name == "Slave" else x for member in kind._members.values()
                      if member.kind == "axis" and member.section == "in_out"}
            kind(**inputs)(**{trigger: True for trigger in ("Execute", "Enable")
                              if trigger in kind._members and kind is not blocks.MC_Power})
    bus.cycles(3)


def test_attached_block_acts_in_every_cycle(bus):
    timer, counter = blocks.TON(IN=True, PT=timedelta(milliseconds=20)), blocks.CTU(PV=3)
    bus.attach(timer, counter)
    bus.cycles(21)
    assert timer.Q and timer.ET == timedelta(milliseconds=20)
    for pulse in range(4):
        counter.CU = True
        bus.cycles(1)
        assert counter.CV == min(pulse + 1, 4) and counter.Q == (pulse >= 2)
        counter.CU = False
        bus.cycles(1)
    bus.detach(timer)
    timer.IN = False
    bus.cycles(1)
    assert timer.Q
    with pytest.raises(cm1e.StateError, match="attached"):
        bus.attach(counter)


def test_program_in_every_cycle(bus):
    """A program as a PLC has it; its exception reaches whoever lets time pass."""
    x = bus["X"]
    power = blocks.MC_Power(Axis=x, EnablePositive=True, EnableNegative=True)
    move, seen = blocks.MC_MoveRelative(Axis=x, Distance=2, Velocity=50), []

    @bus.on_cycle
    def program(_):
        power(Enable=True)
        move(Execute=power.Status)
        seen.append(bus.time)
        if move.Done:
            raise KeyError("done")
    with pytest.raises(KeyError, match="done"):
        bus.advance(5)
    assert x.info.set_position == pytest.approx(2)
    assert seen == pytest.approx([n * 0.001 for n in range(len(seen))])


def test_callback_cannot_wait(bus):
    bus["X"].enable()

    @bus.on_cycle
    def program(_):
        bus["X"].move_relative(1, 10)
    with pytest.raises(cm1e.StateError, match="cannot wait"):
        bus.cycles(1)


def test_callback_starts_and_stops_a_command(bus):
    """A callback does not wait: the axis ramps down in the cycles behind it, and then takes commands again."""
    x, commands = bus["X"], []
    x.enable()
    begun = bus.time

    @bus.on_cycle
    def program(_):
        if not commands:
            commands.append(x.move_absolute(40, 10, wait=False))
        elif bus.time > begun + 0.3:
            commands[0].stop()
    bus.advance(0.5)
    assert commands[0].done and x.state == cm1e.AxisState.STANDSTILL and 1 < x.position < 5
    with pytest.raises(cm1e.CommandAborted, match="was stopped"):
        commands[0].wait()
    bus.execute(blocks.MC_MoveAbsolute(Axis=x, Velocity=50))


def test_real_time_takes_no_callback():
    with cm1e.Bus(axes=1, realtime="off") as bus:
        with pytest.raises(cm1e.StateError, match="virtual_time"):
            bus.on_cycle(print)
        with pytest.raises(cm1e.StateError, match="attached"):
            blocks.MC_ReadStatus(Axis=bus.axes[0])(Enable=True)
        with pytest.raises(cm1e.StateError, match="sleep"):
            bus.advance(1)


def test_axis_of_another_bus_is_refused(bus):
    with cm1e.Bus(axes=1, virtual_time=True) as other:
        stranger = other.axes[0]
        probe = blocks.MC_TouchProbe(Axis=bus["X"], TriggerInput=blocks.MC_TRIGGER_REF(Axis=stranger, InputNumber=1))
        for block in (blocks.MC_Power(Axis=stranger), probe):
            with pytest.raises(cm1e.AxisError, match="another bus"):
                bus.attach(block)
    with pytest.raises(cm1e.StateError):
        blocks.MC_Power(Axis=stranger)(Enable=True)


def test_cam(bus):
    master, slave = bus.axes
    for axis in bus.axes:
        axis.enable()
    points = [blocks.MC_CAM_POINT(Master=m, Slave=s) for m, s in ((0, 0), (5, 3), (10, 0))]
    cam = blocks.MC_CAM_REF(Points=points, Curve=blocks.MC_CAM_CURVE.mcCamLinear)
    assert cam.NumberOfPoints == 3
    select = blocks.MC_CamTableSelect(Master=master, Slave=slave, CamTable=cam, Execute=True)
    bus.attach(select)
    bus.wait_until(lambda: select.Done, timeout=1)
    cam.Points = points[:2]
    join = blocks.MC_CamIn(Master=master, Slave=slave, CamTableID=select.CamTableID, Execute=True)
    bus.attach(join)
    bus.wait_until(lambda: join.InSync, timeout=1)
    master.move_absolute(5, 10)
    assert slave.info.set_position == pytest.approx(3, abs=0.01)


def test_threads_use_a_bus_while_it_is_closed():
    """Whatever a thread does at that moment ends with a value or with StateError."""
    bus = cm1e.Bus(axes=1, virtual_time=True).start()
    axis, faults, begun = bus.axes[0], [], threading.Barrier(5)
    block = blocks.MC_ReadStatus(Axis=axis, Enable=True)
    bus.attach(block)

    def use(function):
        begun.wait()
        try:
            while True:
                function()
        except cm1e.StateError:
            pass
        except BaseException as error:
            faults.append(error)
    threads = [threading.Thread(target=use, args=(function,)) for function in
               (lambda: axis.position, lambda: block.Disabled, lambda: bus.log(), lambda: bus.cycles(3))]
    for thread in threads:
        thread.start()
    begun.wait()
    for _ in range(20):
        axis.position
    bus.close()
    for thread in threads:
        thread.join(20)
    assert not faults and not any(thread.is_alive() for thread in threads)


def test_what_a_command_waits_for():
    """The last of its steps, not the first: MC_GearInPos shows StartSync before InSync."""
    ends = {kind: kind()._ends for kind in (blocks.MC_GearInPos, blocks.MC_MoveVelocity, blocks.MC_Home, blocks.MC_Power)}
    assert ends[blocks.MC_GearInPos] == ["InSync", "CommandAborted", "Error"]
    assert ends[blocks.MC_MoveVelocity] == ["InVelocity", "CommandAborted", "Error"]
    assert ends[blocks.MC_Home] == ["Done", "CommandAborted", "Error"]
    assert ends[blocks.MC_Power] == ["Status", "Error"]


def test_names_of_the_standard():
    assert issubclass(blocks.MC_BUFFER_MODE, IntEnum)
    assert blocks.MC_DIRECTION.mcShortestWay == 2
    assert blocks.MC_HOME_DIRECTION is blocks.MC_DIRECTION
