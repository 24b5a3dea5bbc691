"""Axes on virtual time: motions, waiting, errors, the end of a bus."""
import asyncio
import gc
import os
import sys

import numpy
import pytest

import cm1e
from cm1e.blocks import MC_DIRECTION

XY = [{"name": "X", "counts_per_unit": 5000}, {"name": "Y", "counts_per_unit": 5000}]


@pytest.fixture
def bus():
    with cm1e.Bus(axes=XY, virtual_time=True) as bus:
        for axis in bus.axes:
            axis.enable()
        yield bus


def test_move_absolute_waits_for_its_end(bus):
    before = bus.time
    command = bus["X"].move_absolute(20, 50)
    assert command.done and command.block.Done
    assert bus["X"].info.set_position == pytest.approx(20)
    assert bus["X"].position == pytest.approx(20, abs=0.05)
    assert 0.4 < bus.time - before < 0.6  # 20 u with 50 u/s


def test_two_runs_are_equal_sample_by_sample():
    def run():
        with cm1e.Bus(axes=XY, virtual_time=True) as bus:
            x, y = bus.axes
            x.enable()
            y.enable()
            command = y.move_absolute(-3, 20, wait=False)
            x.move_relative(5, 40)
            command.wait()
            return bus.trace.array
    first, second = run(), run()
    assert len(first) > 100
    assert numpy.array_equal(first, second)


def test_commands_of_two_axes_go_on_together(bus):
    x, y = bus.axes
    before = bus.time
    commands = [x.move_absolute(20, 50, wait=False), y.move_absolute(20, 50, wait=False)]
    assert not any(command.done for command in commands)
    for command in commands:
        command.wait()
    assert bus.time - before < 0.6


def test_await(bus):
    async def both():
        before = bus.time
        await asyncio.gather(bus["X"].move_absolute(10, 50, wait=False), bus["Y"].move_absolute(-10, 50, wait=False))
        return bus.time - before
    assert asyncio.run(both()) < 1
    assert [round(axis.position) for axis in bus.axes] == [10, -10]


def test_cancelled_task_stops_the_axis(bus):
    async def cancelled():
        task = asyncio.ensure_future(wait_for(bus["X"].move_absolute(40, 10, wait=False)))
        for _ in range(300):
            await asyncio.sleep(0)
        assert bus["X"].velocity > 1
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task

    async def wait_for(command):
        await command
    asyncio.run(cancelled())
    bus.advance(0.1)
    assert bus["X"].state == cm1e.AxisState.STANDSTILL
    assert abs(bus["X"].velocity) < 0.1
    bus["X"].move_absolute(0, 50)


def test_timeout_stops_the_axis(bus):
    with pytest.raises(TimeoutError, match="MC_MoveAbsolute"):
        bus["X"].move_absolute(40, 10, timeout=0.5)
    bus.advance(0.1)
    assert bus["X"].state == cm1e.AxisState.STANDSTILL and bus["X"].position < 6


def test_enabling_that_nobody_waits_for_any_more_is_taken_back():
    with cm1e.Bus(axes=1, virtual_time=True) as bus:
        with pytest.raises(TimeoutError):
            bus.axes[0].enable(timeout=0.002)
        bus.advance(1)
        assert not bus.axes[0].info.powered and not bus.simulated_motor(1).torque_on
        bus.axes[0].enable()
        bus.axes[0].disable()
        assert not bus.simulated_motor(1).torque_on


def test_aborted_command_raises(bus):
    first = bus["X"].move_absolute(30, 10, wait=False)
    bus.advance(0.2)
    bus["X"].move_absolute(0, 50)
    with pytest.raises(cm1e.CommandAborted, match="X"):
        first.wait()


def test_refused_command_raises_the_text_of_the_library(bus):
    bus["Y"].disable()
    with pytest.raises(cm1e.AxisError, match="Disabled: enable it with MC_Power") as error:
        bus["Y"].move_absolute(1, 10)
    assert error.value.code == cm1e.ErrorCode.ERROR_AXIS_NOT_POWERED
    with pytest.raises(cm1e.AxisError, match="velocity"):
        bus["X"].move_absolute(1, 1e6)


def test_fault_reset_and_going_on(bus):
    x = bus["X"]
    x.move_velocity(5)
    bus.simulate("power 1 off")
    bus.wait_until(lambda: x.state == cm1e.AxisState.ERROR_STOP, timeout=1)
    assert x.info.error == cm1e.ErrorCode.ERROR_DRIVE_POWER
    with pytest.raises(cm1e.Error, match="MC_Reset|power"):
        x.move_relative(1, 5)
    bus.simulate("power 1 on")
    bus.advance(0.5)
    x.reset()
    x.enable()
    x.move_relative(1, 5)
    assert any(event.axis == "X" and event.kind == "error" and "power" in event.text for event in bus.log())


def test_motions_and_positions(bus):
    x = bus["X"]
    x.set_position(100)
    assert x.position == pytest.approx(100, abs=0.01)
    x.move_velocity(-5)
    bus.advance(0.2)
    assert x.velocity == pytest.approx(-5, abs=0.2)
    x.halt()
    bus.advance(0.05)
    assert abs(x.velocity) < 0.1
    x.move_velocity(5)
    x.stop()
    x.move_absolute(100, 20, direction=MC_DIRECTION.mcPositiveDirection)
    assert x.read_parameter(1) == pytest.approx(x.info.set_position)


def test_home():
    with cm1e.Bus(axes=[{"name": "X", "counts_per_unit": 5000, "homing": {"method": -2, "velocity": 20}}],
                  virtual_time=True) as bus:
        bus["X"].enable()
        bus["X"].home(3)
        assert bus["X"].info.homed
        assert bus["X"].info.set_position == pytest.approx(3, abs=0.01)


def test_trace_as_arrays(bus):
    bus["X"].move_absolute(10, 50)
    trace = bus.trace
    assert trace["X set position"].dtype == numpy.float64
    assert trace["X set position"].max() == pytest.approx(10)
    assert numpy.all(numpy.diff(trace.time) == pytest.approx(0.001))
    assert "Y torque" in trace.names and len(trace) == len(trace.time)
    with pytest.raises(KeyError, match="X torque"):
        trace["Z torque"]


def test_trace_outlives_the_run_and_is_written(tmp_path):
    with cm1e.Bus(axes=1, virtual_time=True, trace_objects=[("axis1", 0x6077, 0)]) as bus:
        bus.advance(0.1)
        bus.stop()
        assert not bus.running
        assert len(bus.trace) >= 100
        assert any("0x6077" in name for name in bus.trace.names)
        for name in ("trace.csv", "trace.svg"):
            bus.write_trace(tmp_path / name)
            assert os.path.getsize(tmp_path / name) > 100
        with pytest.raises(cm1e.Error, match="npy, csv"):
            bus.write_trace(tmp_path / "trace.xls")


def test_group():
    with cm1e.Bus(axes=XY, virtual_time=True, groups=["table"]) as bus:
        table = bus.group("table")
        for place, axis in enumerate(bus.axes, 1):
            axis.enable()
            table.add(axis, place)
        table.enable()
        table.move_linear_absolute([3, 4], 10)
        assert [axis.info.set_position for axis in bus.axes] == pytest.approx([3, 4])
        table.move_direct_absolute([-1, 2])
        assert [axis.info.set_position for axis in bus.axes] == pytest.approx([-1, 2])
        with pytest.raises(TimeoutError):
            table.move_linear_absolute([30, 40], 5, timeout=0.5)
        bus.advance(0.1)
        assert table.state == cm1e.GroupState.STANDBY
        move = table.move_linear_absolute([0, 0], 10, wait=False)
        bus.advance(0.2)
        table.interrupt()
        rest = [axis.info.set_position for axis in bus.axes]
        bus.advance(0.5)
        assert rest == [axis.info.set_position for axis in bus.axes] and not move.done
        table.resume()
        move.wait()
        assert [axis.info.set_position for axis in bus.axes] == pytest.approx([0, 0])
        with pytest.raises(cm1e.Error, match="Nothing is interrupted"):
            table.resume()


def test_sdo(bus):
    assert len(bus.sdo_read(1, 0x6041)) == 2
    with pytest.raises(cm1e.BusError, match="does not exist") as error:
        bus.sdo_read(1, 0x9999)
    assert error.value.foreign_code == 0x06020000
    bus.sdo_write(2, 0x6081, 0, (20000).to_bytes(4, "little"))
    assert int.from_bytes(bus.sdo_read(2, 0x6081), "little") == 20000


def test_slaves_and_scan():
    bus = cm1e.Bus(axes=2)
    try:
        assert [slave.kind for slave in bus.scan()] == ["cm1-e", "cm1-e"]
        with pytest.raises(cm1e.StateError, match="start"):
            bus.attach(cm1e.blocks.TON())
    finally:
        bus.close()


# ---- the end -----------------------------------------------------------------------------------------------------------

def test_everything_of_a_closed_bus_raises():
    with cm1e.Bus(axes=1, virtual_time=True, groups=["G"]) as bus:
        axis, group = bus.axes[0], bus.group("G")
        axis.enable()
        command = axis.move_velocity(1, wait=False)
        signal = bus.io["1.Statusword"]
        block = cm1e.blocks.MC_ReadStatus(Axis=axis, Enable=True)
        bus.attach(block)
    for use in (lambda: axis.position, lambda: axis.move_relative(1, 1), axis.enable, axis.disable, lambda: bus.axes,
                lambda: bus.time, lambda: bus.io, lambda: signal.value, lambda: signal.quality, lambda: bus.trace,
                lambda: block.Standstill, lambda: bus.log(), lambda: bus.advance(1), lambda: bus.simulate("help"),
                lambda: bus.sdo_read(1, 0x6041), lambda: group.state, bus.start, bus.stop, lambda: bus.statistics,
                command.wait, lambda: bus.simulated_motor(1), lambda: bus.attach(cm1e.blocks.TON()), bus.scan,
                lambda: bus.on_cycle(print), lambda: axis.error_text, lambda: setattr(block, "Enable", False),
                lambda: bus.slaves):
        with pytest.raises(cm1e.StateError):
            use()
    bus.close()
    assert not bus.running


def test_exception_in_the_block_disables_the_motor():
    with pytest.raises(ZeroDivisionError):
        with cm1e.Bus(axes=1, virtual_time=True) as bus:
            bus.axes[0].enable()
            bus.axes[0].move_velocity(1)
            assert bus.simulated_motor(1).torque_on
            1 / 0
    assert not bus.running


def test_stop_ramps_down_and_disables(bus):
    bus["X"].move_velocity(20)
    bus.stop()
    assert not bus.simulated_motor(1).torque_on
    assert abs(bus.simulated_motor(1).velocity_counts_per_s) < 1000
    states = [event.text for event in bus.log() if event.axis == "X" and event.kind == "state"]
    assert states[-1].startswith("X: Disabled")
    velocity = bus.trace["X actual velocity"]
    assert numpy.abs(numpy.diff(velocity)).max() < 5  # a ramp, no jump
    with pytest.raises(cm1e.StateError):
        bus["X"].move_relative(1, 1)


def test_garbage_collection_stops_the_bus(capfd):
    bus = cm1e.Bus(axes=1, virtual_time=True).start()
    bus.axes[0].enable()
    bus.axes[0].move_velocity(1)
    session = bus._session
    del bus
    gc.collect()
    assert not cm1e.bus.lib.cm1e_py_runs(session)


@pytest.mark.parametrize("end", ["pass", "1/0", "import os, signal; os.kill(os.getpid(), signal.SIGTERM); bus.advance(9)",
                                 "import sys; sys.exit(0)"])
def test_end_of_the_interpreter_disables_the_motor(python, tmp_path, end):
    """What the drive saw is in the pcap file: its last controlwords take the enable away."""
    pcap = tmp_path / "frames.pcap"
    status, said = python("import cm1e\n"
                          f"bus = cm1e.Bus(axes=1, virtual_time=True, pcap={str(pcap)!r}).start()\n"
                          "bus.axes[0].enable()\n"
                          "bus.axes[0].move_velocity(1)\n"
                          f"bus.advance(0.1)\n{end}")
    assert status == {"1/0": 1}.get(end, 143 if "SIGTERM" in end else 0), said
    assert disabled_at_end(pcap.read_bytes())


def test_process_that_vanishes_does_not(python, tmp_path):
    """So the test above can fail. What stops the motor then is the watchdog of its drive."""
    pcap = tmp_path / "frames.pcap"
    python(f"import cm1e, os\nbus = cm1e.Bus(axes=1, virtual_time=True, pcap={str(pcap)!r}).start()\n"
           "bus.axes[0].enable()\nbus.axes[0].move_velocity(1)\nbus.advance(5)\nos._exit(0)")
    assert len(pcap.read_bytes()) > 10000 and not disabled_at_end(pcap.read_bytes())


def test_error_at_close_does_not_hide_the_first_one(monkeypatch):
    with pytest.raises(ZeroDivisionError) as error:
        with cm1e.Bus(axes=1, virtual_time=True) as bus:
            monkeypatch.setattr(cm1e.bus.errors, "check", lambda *_: cm1e.bus.errors.fail(-6))
            1 / 0
    assert "closed with an error" in error.value.__notes__[0]


def test_wrong_arguments_are_told(bus):
    for wrong, kind, said in ((lambda: bus.advance(-1), ValueError, "-1 s cannot pass"),
                              (lambda: bus.advance(float("nan")), ValueError, "cannot pass"),
                              (lambda: bus.cycles(-1), ValueError, "-1 cycles cannot pass"),
                              (lambda: bus.sdo_read(9, 0x6064), cm1e.NotFoundError, "There is no slave 9; the network has 2."),
                              (lambda: bus.sdo_write(0, 0x6081, 0, b"1234"), cm1e.NotFoundError, "There is no slave 0"),
                              (lambda: bus.simulated_motor(3), cm1e.NotFoundError, "There is no slave 3; the network has 2."),
                              (lambda: bus.simulated_motor(0), cm1e.NotFoundError, "There is no slave 0"),
                              (lambda: cm1e.Bus(axes=[{"name": "X\0Y"}]), cm1e.ConfigError, "a character 0"),
                              (lambda: bus.sdo_write(1, 0x6064, 0, 5), TypeError, "the value is 5; expected bytes"),
                              (lambda: bus["X"].read_parameter(999), cm1e.AxisError, "X has no parameter 999;"),
                              (lambda: bus["X"].write_parameter(999, 1), cm1e.AxisError, "X has no parameter 999;")):
        with pytest.raises(kind) as error:
            wrong()
        assert said in str(error.value)


def disabled_at_end(pcap):
    """The logical process data of the last frames: controlword 0x0F in the run, and none with it at the end."""
    at, words = 24, []
    while at + 16 <= len(pcap):
        size = int.from_bytes(pcap[at + 8:at + 12], "little")
        frame = pcap[at + 16:at + 16 + size]
        if frame[12:14] == b"\x88\xa4" and frame[16] in (0x0A, 0x0B, 0x0C):
            words.append(int.from_bytes(frame[26:28], "little"))
        at += 16 + size
    return 0x0F in words[len(words) // 2:-20] and all(word & 0x0F != 0x0F for word in words[-4:])


def test_fork_leaves_the_bus_to_the_parent(bus):
    child = os.fork()
    if child == 0:
        status = 1
        try:
            bus["X"].position
        except cm1e.StateError:
            bus.close()
            status = 0
        os._exit(status)
    assert os.waitpid(child, 0)[1] == 0
    bus["X"].move_relative(1, 20)


def interrupt_at(line, act):
    """Acts, with a Ctrl-C at that line of the package's code. Whether it came before the end."""
    left, code = [line], os.path.dirname(cm1e.__file__)

    def look(frame, event, _):
        if os.path.dirname(frame.f_code.co_filename) != code:
            return None
        left[0] -= event == "line"
        if left[0] == 0 and event == "line":
            sys.settrace(None)
            raise KeyboardInterrupt
        return look
    sys.settrace(look)
    try:
        act()
    except KeyboardInterrupt:
        return True
    finally:
        sys.settrace(None)
    return False


@pytest.mark.parametrize("what", ["motion", "halt", "stop"])
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")  # in a generator that is closed
def test_ctrl_c_at_any_line_leaves_nothing_that_moves(bus, what):
    x = bus["X"]
    act = {"motion": lambda: x.move_relative(2, 1), "halt": x.halt, "stop": x.stop}[what]
    line, interrupted = 0, True
    while interrupted:
        line += 1
        if what != "motion":
            x.move_velocity(2)
        interrupted = interrupt_at(line, act)
        bus.advance(0.2)
        if what == "motion" and interrupted:
            assert x.state == cm1e.AxisState.STANDSTILL, line
        x.halt()  # the axis takes commands
        x.move_absolute(0, 20)
    assert line > 100
    assert len(bus._kept) < 20  # some interrupts come where only memory is given back


def test_execute_of_an_attached_block_begins_nothing(bus):
    x = bus["X"]
    move = cm1e.blocks.MC_MoveRelative(Axis=x, Distance=1, Velocity=5)
    bus.attach(move)
    with pytest.raises(cm1e.StateError, match="attached already"):
        x.execute(move)
    bus.advance(0.5)
    assert not move.Execute and x.state == cm1e.AxisState.STANDSTILL and abs(x.position) < 0.01


def test_too_many_blocks_are_refused_in_words(bus):
    blocks = [cm1e.blocks.TON() for _ in range(600)]
    with pytest.raises(cm1e.StateError, match="TON is not attached: 512 blocks are. Detach"):
        bus.attach(*blocks)
    kept = len(bus._kept)
    for _ in range(3):
        with pytest.raises(cm1e.StateError):
            bus.attach(cm1e.blocks.TON())
    assert len(bus._kept) == kept and len(bus._attached) == 512
    x = bus["X"]
    x.move_velocity(1)  # commands have room of their own, above all those that stop
    x.stop()
    x.disable()
    bus.detach(*blocks)
    bus.attach(cm1e.blocks.TON())


def test_commands_under_way_take_no_places_of_attached_blocks(bus):
    x = bus["X"]
    x.enable()
    moves = [x.execute(cm1e.blocks.MC_MoveRelative(Axis=x, Distance=0.001, Velocity=1), wait=False)
             for _ in range(20)]
    blocks = [cm1e.blocks.TON() for _ in range(512)]
    bus.attach(*blocks)
    with pytest.raises(cm1e.StateError, match="512 blocks are"):
        bus.attach(cm1e.blocks.TON())
    bus.detach(blocks[0])
    bus.attach(cm1e.blocks.TON())
    assert len(moves) == 20
