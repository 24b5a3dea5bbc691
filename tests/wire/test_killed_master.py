#!/usr/bin/env python3
"""A master that is killed (SIGKILL: kill -9, or a machine without memory) or stands still (SIGSTOP, SIGCONT; a machine that
is suspended to RAM does the same to the process) while its motor turns. Judged at the simulated shaft, for every device
that the simulator knows, as docs/SAFETY.md says: a drive with a watchdog loses its torque; one without goes on with what
it was told last. After SIGCONT no motor moves again by itself, and the master says what happened.

test_killed_master.py CM1E
"""
import os
import re
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

BUS = "bus: {{interface: {}, lost_cycles_limit: 50}}\n"
CM1E = "axes: [{{name: X, firmware: {}, mapping: {}, motion: {}, sim: {{no_stops: true}}}}]\n"
BRIDGE = "axes: [{name: X, position: 1, channel: %d, motor: %s, k37: 10}]\n"
CIA402 = """\
axes:
  - name: X
    device: cia402
    drive: {counts_per_revolution: 4096, max_speed_rpm: 3000}
    sim: {no_stops: true}
"""
# What the motor does while nothing arrives: it loses its torque, stands under torque, or goes on turning.
FREE, STANDS, TURNS = "free", "stands", "turns"
# name, axes of the bus file, options of `cm1e sim` beside that file, what happens without frames (UG 10.1, BR 9.2)
DEVICES = [(f"CM1-E {firmware}, {mapping}, moved by the {motion}", CM1E.format(firmware, mapping, motion), (), alone)
           for firmware, mapping, motion, alone in (
               ("1.2.0", "dynamic", "host", STANDS), ("1.2.0", "csv", "host", TURNS),
               ("1.2.0", "dynamic", "drive", TURNS), ("1.3.0", "dynamic", "host", FREE),
               ("1.3.0", "csv", "host", FREE), ("1.3.5", "dynamic", "host", FREE),
               ("1.3.5", "dynamic", "drive", FREE))]
DEVICES += [(f"{motor} behind a bridge (channel: {channel})", BRIDGE % (channel, motor), ("--bridge", "eb12"), FREE)
            for motor, channel in (("CM1", 1), ("CM2", 3))]
DEVICES += [("CiA 402", CIA402, (), FREE)]
SPEED = 2.0  # revolutions a second
COUNTS = {"CiA 402": 4096}  # of a revolution
SUSPENDED_S = 0.4
WATCHDOG_S = 0.1
# The watchdog's 100 ms, the way in which a motor without torque coasts, and pauses of a loaded machine.
LATEST_S = 1.0
# What is seen of a master that stopped because this machine gave it, or the simulator, no processor for 50 ms or more:
# it was not ended while its motor turned, so nothing was tested, and it starts anew.
PAUSED = ("no process data came in time", "frames are lost", "no frame was sent for")
ATTEMPTS = 5


class Shaft:
    """The motor of the axis, as the simulator shows it. Positions are in revolutions."""

    def __init__(self, segment, device, sim_options):
        self.segment, self.counts = segment, COUNTS.get(device, 50000)
        self.channel = int(re.search(r"channel: (\d)", device)[1]) if sim_options else None

    def status(self):
        line = self.segment.console("status 1")
        return re.search(rf"ID{self.channel} [^;]*", line)[0] if self.channel else line

    def enabled(self):
        return "Operation enabled" in self.status()

    def position(self):
        return int(re.search(r"position (-?\d+)", self.status())[1]) / self.counts

    def travel(self, seconds=0.05):
        begin = self.position()
        time.sleep(seconds)
        return abs(self.position() - begin)

    def turns(self):
        return self.enabled() and self.travel() > 0.02 * SPEED

    def stands(self):
        return self.travel() < 0.001


class Turning:
    """A master whose motor turns, and what it says at its end."""

    def __init__(self, shaft, cm1e, bus):
        command = shaft.segment.command([cm1e, "move", "-b", bus, "X", "--speed", str(SPEED), "--for", "60"])
        self.master = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        wire.wait_for(lambda: self.master.poll() is not None or shaft.turns(), 10, "the motor does not turn")
        self.told = ""

    def stop(self, shaft):
        """Suspends it. Nothing more of it reaches the drive when the simulator has read what was on its way. Whether
        the motor turned until then."""
        self.master.send_signal(signal.SIGSTOP)
        shaft.status()
        time.sleep(0.02)
        return self.master.poll() is None and shaft.enabled()

    def end(self, number):
        self.master.send_signal(number)
        self.told = self.master.communicate(timeout=20)[1]
        return self.master.returncode


def judge_alone(shaft, device, alone):
    """What the motor does while nothing arrives. How far it goes until it stands, at most."""
    begin = shaft.position()
    if alone == FREE:
        wire.wait_for(lambda: not shaft.enabled(), LATEST_S, f"{device}: still under torque")
    if alone == TURNS:
        wire.check(shaft.turns(), f"{device}: without frames it has stopped: {shaft.status()}")
    else:
        wire.wait_for(shaft.stands, LATEST_S, f"{device}: still turning")
    if alone == STANDS:
        wire.check(shaft.enabled(), f"{device}: this drive has no watchdog, but lost its torque")
    way = abs(shaft.position() - begin)
    wire.check(alone == TURNS or way < SPEED * WATCHDOG_S * 1.5, f"{device}: it went on for {way} revolutions")
    return f"{alone} after {way:.3f} revolutions" if alone != TURNS else alone


def kill(shaft, turning, device, alone):
    if not turning.stop(shaft):
        return False
    wire.check(turning.end(signal.SIGKILL) == -signal.SIGKILL, f"{device}: {turning.told}")
    done = judge_alone(shaft, device, alone)
    print(f"{device}, killed: {done}: {shaft.status()}")
    return True


def suspend(shaft, turning, device, alone):
    begin = time.monotonic()
    if not turning.stop(shaft):
        return False
    done = judge_alone(shaft, device, alone)
    time.sleep(max(0.0, begin + SUSPENDED_S - time.monotonic()))
    before = shaft.position()
    turning.master.send_signal(signal.SIGCONT)
    farthest = 0.0
    while turning.master.poll() is None:
        farthest = max(farthest, abs(shaft.position() - before))
        time.sleep(0.002)
    turning.end(0)
    # One that turned alone brakes now; the others stay where they are.
    allowed = SPEED * 0.1 if alone == TURNS else 0.002
    wire.check(farthest < allowed, f"{device}: after SIGCONT it moved by {farthest} revolutions")
    wire.check(turning.master.returncode == 1 and "no frame was sent for" in turning.told,
               f"{device}: exit status {turning.master.returncode}: {turning.told}")
    wire.check(shaft.stands() and not shaft.enabled(), f"{device}: {shaft.status()}")
    print(f"{device}, suspended: {done}; then {farthest:.4f} revolutions: {shaft.status()}")
    return True


def end_while_turning(shaft, cm1e, bus, device, alone, way):
    """One that ends by itself because this machine stood still is none."""
    for _ in range(ATTEMPTS):
        turning = Turning(shaft, cm1e, bus)
        try:
            if way(shaft, turning, device, alone):
                return
        finally:
            turning.master.kill()
            told = turning.told or turning.master.communicate()[1]
        wire.check(any(words in told for words in PAUSED), f"{device}: the master ended by itself: {told}")
        print(f"{device}: again, this machine stood still: {told.strip()}")
    wire.check(False, f"{device}: no master lived until it was ended, {ATTEMPTS} times")


def check_device(cm1e, device, axes, options, alone):
    with tempfile.TemporaryDirectory() as folder:
        bus, slaves = (os.path.join(folder, name) for name in ("bus.yaml", "slaves.yaml"))
        for path, text in ((bus, BUS.format(wire.MASTER_INTERFACE) + axes), (slaves, axes)):
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
        with wire.segment(cm1e, *(options or (slaves,))) as segment:
            shaft = Shaft(segment, device, options)
            for way in (suspend, kill):
                end_while_turning(shaft, cm1e, bus, device, alone, way)


if __name__ == "__main__":
    wire.together(*(lambda device=device: check_device(sys.argv[1], *device) for device in DEVICES))
