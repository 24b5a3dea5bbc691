"""In the time of the machine: the cycle goes on while Python waits, Ctrl-C, running programs. Limits are wide: the
machine may be busy."""
import asyncio
import os
import signal
import subprocess
import sys
import threading
import time

import numpy
import pytest

import cm1e

pytestmark = pytest.mark.real_time
X = [{"name": "X", "counts_per_unit": 5000, "max_position_lag": 1000}]
PROGRAM = """
import cm1e, sys, time
with cm1e.Bus(axes=[{"name": "X", "sim": {"no_stops": True}, "max_position_lag": 1000}, {"name": "Y"}],
              control="maintain") as bus:
    bus["X"].enable()
    bus["X"].move_velocity(0.5)
    print("moves", flush=True)
    sys.stdin.read()
print("ended", flush=True)
"""


@pytest.fixture
def bus():
    with cm1e.Bus(axes=X) as bus:
        bus["X"].enable()
        yield bus


def test_motion_and_await(bus):
    x = bus["X"]
    begun = time.monotonic()
    x.move_absolute(5, 20)
    assert x.info.set_position == pytest.approx(5) and time.monotonic() - begun > 0.2
    ticks = []

    async def tick():
        while True:
            ticks.append(x.position)
            await asyncio.sleep(0.02)

    async def main():
        ticking = asyncio.ensure_future(tick())
        await x.move_absolute(0, 20, wait=False)
        ticking.cancel()
    asyncio.run(main())
    assert len(ticks) > 3 and x.info.set_position == pytest.approx(0)


def test_cycle_goes_on_while_python_computes(bus):
    """The GIL is held for 0.2 s by other threads; the motion does not notice."""
    command = bus["X"].move_absolute(4, 20, wait=False)
    end = time.monotonic() + 0.2
    threads = [threading.Thread(target=lambda: [None for _ in iter(lambda: time.monotonic() < end, False)])
               for _ in range(2)]
    cycles = bus.statistics.cycles
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    command.wait(5)
    assert bus.statistics.cycles - cycles > 100
    bus.stop()
    assert numpy.abs(numpy.diff(bus.trace["X set velocity"])).max() < 25


def test_recording_while_the_bus_runs(bus):
    """In real time, from the same program: all samples, in order, and the motion goes on."""
    with bus.recording(objects=[("X", 0x6041, 0)]) as recording:
        command = bus["X"].move_relative(1, 5, wait=False)
        parts = []
        while not command.done:
            time.sleep(0.05)
            parts.append(recording.take())
        parts.append(recording.take())
    times = numpy.concatenate([part.time for part in parts])
    assert len(parts) > 2 and recording.lost == 0 and numpy.all(numpy.diff(times) > 0) and len(times) > 150
    positions = numpy.concatenate([part["X set position"] for part in parts])
    assert positions[-1] - positions[0] == pytest.approx(1, abs=0.01) and any("0x6041" in name for name in parts[0].names)


def test_threads_use_a_bus_while_it_is_closed():
    """As on virtual time: whatever a thread does then ends with a value or with StateError."""
    bus, faults = cm1e.Bus(axes=X).start(), []
    axis, block = bus["X"], cm1e.blocks.MC_ReadStatus(Axis=bus["X"], Enable=True)
    bus.attach(block)

    def use(function):
        try:
            while True:
                function()
        except cm1e.StateError:
            pass
        except BaseException as error:
            faults.append(error)
    threads = [threading.Thread(target=use, args=(function,)) for function in
               (lambda: axis.position, lambda: block.Disabled, lambda: bus.log()[-1:], lambda: bus.statistics)]
    for thread in threads:
        thread.start()
    time.sleep(0.1)
    bus.close()
    for thread in threads:
        thread.join(20)
    assert not faults and not any(thread.is_alive() for thread in threads)


def test_ctrl_c_stops_the_axis(bus):
    x = bus["X"]
    timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        x.move_absolute(40, 5)
    assert x.state == cm1e.AxisState.STANDSTILL and 0 < x.position < 30
    x.move_relative(1, 20)


def test_ctrl_c_at_a_program_that_computes(tmp_path):
    """A motion is under way, nobody waits for it: the end of the program disables the motor."""
    program = tmp_path / "program.py"
    program.write_text(PROGRAM.replace("sys.stdin.read()", "while True: pass"))
    process = subprocess.Popen([sys.executable, program], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "moves\n"
    process.send_signal(signal.SIGINT)
    said = process.communicate(timeout=20)
    assert process.returncode != 0 and "KeyboardInterrupt" in said[1]


@pytest.fixture
def program(tmp_path, monkeypatch):
    monkeypatch.setenv("CM1E_RUNTIME_DIR", str(tmp_path / "run"))
    process = subprocess.Popen([sys.executable, "-c", PROGRAM], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdout.readline() == "moves\n"
    yield process
    if process.poll() is None:
        assert "ended" in process.communicate("", timeout=20)[0]


def test_attached(program):
    with cm1e.attach(program.pid) as attached:
        assert attached.hello["pid"] == program.pid
        assert attached.axis("X")["state"] == "ContinuousMotion"
        assert attached.axis("X")["velocity"] == pytest.approx(0.5, abs=0.2)
        assert [slave["kind"] for slave in attached.slaves] == ["cm1-e", "cm1-e"]
        assert attached.statistics["cycles"] > 0 and len(attached.io) > 4
        assert any("X: Standstill" in event["text"] for event in attached.log())
        assert len(attached.sdo_read(1, 0x6041)) == 2
        trace = attached.record(0.3, objects=[("X", 0x6041, 0)])
        assert len(trace) > 100 and numpy.all(numpy.diff(trace.time) > 0)
        assert numpy.median(trace["X set velocity"]) == pytest.approx(0.5, abs=0.05)
        assert any("0x6041" in name for name in trace.names)
        for wrong in (lambda: attached.axis("Z"), lambda: attached.sdo_read(9, 0x6041), lambda: attached.ask("nothing"),
                      lambda: attached.jog("X", 1, 0.1)):
            with pytest.raises(cm1e.Error):
                wrong()
    with pytest.raises(cm1e.StateError, match="closed"):
        attached.axes


def test_maintained(program):
    with cm1e.attach() as attached:
        with attached.enabled("Y"):
            attached.jog("Y", 0.5, 0.4)
            assert attached.axis("Y")["position"] > 0.03
        attached.sdo_write(2, 0x6081, 0, (20000).to_bytes(4, "little"))
        assert int.from_bytes(attached.sdo_read(2, 0x6081), "little") == 20000
        program.communicate("", timeout=20)
        with pytest.raises(cm1e.StateError, match="ended"):
            attached.axes
    assert not [listed for listed in cm1e.programs() if listed.pid == program.pid]
    with pytest.raises(cm1e.NotFoundError):
        cm1e.attach(program.pid)
