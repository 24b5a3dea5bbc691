#!/usr/bin/env python3
"""One program on two networks, over two veth pairs, with a gear from one to the other: at 1 ms and at 250 us, in real
time, while single frames of either network are lost, and with distributed clocks on both.

test_two_buses.py CM1E 16_TWO_NETWORKS
"""
import contextlib
import fcntl
import json
import os
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import tempfile
import termios
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

SECOND = ("ecm1", "ecs1")
TURN_US = 3_000_000
# In gear means: both set-points of this cycle are in the ratio. Only the rounding of a double is left.
ROUNDING = 1e-12
# A lost frame or an overrun costs at most a ramp of both axes (0.3 s to 1 u/s) and the way that the slave makes up then.
BACK_IN_STEP_US = 700_000
TOLD = re.compile(r"(\d+) cycles on two networks, (\d+) of them in step; there the velocities differed by at most (\S+) u/s; "
                  r"(\d+) frames lost, (\d+) overruns")


def bus_file(folder, cycle_time_us, clocks=False):
    path = os.path.join(folder, f"two_{cycle_time_us}{'_clocks' if clocks else ''}.yaml")
    bus = f"cycle_time_us: {cycle_time_us}, lost_cycles_limit: {wire.PAUSE_US // cycle_time_us}"
    bus += ", distributed_clocks: true" if clocks else ""
    pulses = f", dc: {{sync0_us: {cycle_time_us}, shift_us: 400}}" if clocks else ""
    with open(path, "w", encoding="utf-8") as file:
        file.write("buses:\n"
                   f"  - {{name: left, bus: {{interface: {wire.MASTER_INTERFACE}, {bus}}}, "
                   "axes: [{name: feeder, sim: {no_stops: true}}]}\n"
                   f"  - {{name: right, bus: {{interface: {SECOND[0]}, {bus}}}, "
                   "axes: [{name: cutter, sim: {no_stops: true}}, {name: spindle, device: cia402, "
                   f"drive: {{counts_per_revolution: 131072, max_speed_rpm: 3000}}{pulses}}}]}}\n")
    return path


def judge(done, cycle_time_us, what):
    """In step but for what lost frames and a busy machine cost."""
    told = TOLD.search(done.stdout)
    wire.check(done.returncode == 0 and told, f"{what}: {done}")
    in_step_us = int(told[2]) * cycle_time_us
    disturbances = int(told[4]) + int(told[5])
    wire.check(int(told[1]) == TURN_US // cycle_time_us and float(told[3]) < ROUNDING
               and in_step_us >= TURN_US - disturbances * BACK_IN_STEP_US, f"{what}: {done}")
    print(f"{what}: {told[0]}")


def lose_frames(segment, second, command):
    """Single frames of each network are lost, in turn, while the program turns."""
    running = subprocess.Popen(segment.command(command), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    time.sleep(1.5)
    for number in range(10):
        (segment.simulator if number % 2 else second).stdin.write("lose 1\n")
        (segment.simulator if number % 2 else second).stdin.flush()
        time.sleep(0.1)
    out, err = running.communicate(timeout=60)
    return subprocess.CompletedProcess(command, running.returncode, out, err)


def monitor_shows(segment, cm1e, path):
    """What `cm1e monitor` writes on a terminal within a second of its first axes."""
    ours, its = pty.openpty()
    fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", 30, 100, 0, 0))
    environment = {**os.environ, "TERM": "xterm", "LC_ALL": "C.UTF-8",
                   "ASAN_OPTIONS": "detect_leaks=0"}  # ncurses keeps what it knows of a terminal
    monitor = subprocess.Popen(segment.command([cm1e, "monitor", "-b", path, "--network", "right"]), stdin=its, stdout=its,
                               stderr=its, env=environment)
    os.close(its)
    shown, end = "", time.monotonic() + 10
    while "cutter" not in shown and time.monotonic() < end and select.select([ours], [], [], 10)[0]:
        shown += os.read(ours, 65536).decode(errors="replace")
    os.write(ours, b"q")
    with contextlib.suppress(OSError): # its end
        while monitor.poll() is None and select.select([ours], [], [], 10)[0]:
            shown += os.read(ours, 65536).decode(errors="replace")
    wire.check(monitor.wait(10) == 0, f"cm1e monitor ended otherwise: {shown}")
    os.close(ours)
    return shown


def attached(segment, cm1e, path, pid):
    """All commands at the same time, because the program turns for seconds only. Returns them by name, finished."""
    csv = os.path.join(segment.folder, "right.csv")
    right = ["-b", path, "--network", "right"]
    commands = {"left": ["status", "-i", wire.MASTER_INTERFACE], "right": ["status", *right], "both": ["status", "-b", path],
                "io": ["io", *right], "listed": ["trace", "--list", *right],
                "trace": ["trace", "--for", "0.2", "--csv", csv, *right],
                "log": ["log", "--attach", str(pid), "--network", "right"]}
    started = {name: subprocess.Popen(segment.command([cm1e, *words]), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                      text=True) for name, words in commands.items()}
    shown = monitor_shows(segment, cm1e, path)
    done = {}
    for name, process in started.items():
        out, err = process.communicate(timeout=60)
        done[name] = subprocess.CompletedProcess(commands[name], process.returncode, out, err)
        wire.check(process.returncode == 0, done[name])
    with open(csv, encoding="utf-8") as file:
        return done, shown, file.read()


def check_attached(segment, cm1e, example, path):
    """While the program runs, each network has its socket. What is attached to one shows nothing of the other."""
    running = subprocess.Popen(segment.command([example, path]), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wire.wait_for(lambda: segment.run([cm1e, "status", "--attach", str(running.pid), "--network", "right"]).returncode == 0,
                  30, "the program does not run") # by its number, so that no status opens the interfaces before it
    done, monitor, trace = attached(segment, cm1e, path, running.pid)
    out, err = running.communicate(timeout=60)
    wire.check("Operation enabled" in done["left"].stdout, done["left"])
    wire.check("axis cutter" in done["right"].stdout and "Operation enabled" in done["right"].stdout, done["right"])
    wire.check(done["both"].stdout.count("Operation enabled") == 2 and "axis feeder" in done["both"].stdout, done["both"])
    for name, text in {**{name: done[name].stdout for name in ("right", "io", "listed")}, "trace": trace,
                       "monitor": monitor}.items():
        wire.check("cutter" in text and "feeder" not in text, f"{name}: {text}")
    wire.check("cutter set velocity" in done["listed"].stdout and trace.count("\n") > 100, done["listed"])
    judge(subprocess.CompletedProcess([example, path], running.returncode, out, err), 1000, "1000 us, watched")


def clocks_of(segment, cm1e, path):
    """What `cm1e status` tells of the clocks: of the reference of each network, and of the drive with SYNC0. None: the
    program has ended."""
    told = segment.run([cm1e, "status", "-b", path, "--json"])
    if told.returncode != 0:
        return None
    decoder, slaves, text = json.JSONDecoder(), [], told.stdout.strip()
    while text:
        network, end = decoder.raw_decode(text)
        slaves += network
        text = text[end:].strip()
    return [slave.get("clock") for slave in slaves]


def are_together(clocks, cycle_time_us):
    """The second reference is led by the first one, and the drive follows its own: to a tenth of the cycle. It is no better
    than the moments at which frames leave this machine."""
    together_ns = cycle_time_us * 100
    left, right, drive = clocks
    wire.check(left["is_reference"] and right["is_reference"] and not drive["is_reference"], clocks)
    wire.check(drive["sync0_ns"] == cycle_time_us * 1000, clocks)
    return max(abs(right["deviation_ns"]), abs(drive["deviation_ns"])) <= together_ns


def check_clocks(segment, second, cm1e, example):
    """Crystals that are 100 ppm apart: alone they would be 300 us apart after the 3 s of the program."""
    segment.console("clock 1 drift 60")
    for line in ("clock 1 drift -40\n", "clock 2 drift 30\n"):
        second.stdin.write(line)
    second.stdin.flush()
    path = bus_file(segment.folder, 1000, clocks=True)
    running = subprocess.Popen(segment.command([example, path]), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wire.wait_for(lambda: running.poll() is not None or segment.run(
        [cm1e, "status", "--attach", str(running.pid), "--network", "right"]).returncode == 0, 30, "the program does not run")
    seen = []
    while running.poll() is None:
        seen.append(clocks_of(segment, cm1e, path))
    out, err = running.communicate(timeout=60)
    seen = [clocks for clocks in seen if clocks and all(clocks)]
    judge(subprocess.CompletedProcess([example, path], running.returncode, out, err), 1000, "1000 us, clocks")
    together = [clocks for clocks in seen if are_together(clocks, 1000)]
    wire.check(together, f"the clocks are never together: {seen}")
    print(f"clocks together in {len(together)} of {len(seen)} looks: reference of the second network within "
          f"{max(abs(clocks[1]['deviation_ns']) for clocks in together)} ns")


def check_both(segment, second, cm1e, example):
    for cycle_time_us in (1000, 250):
        path = bus_file(segment.folder, cycle_time_us)
        judge(segment.run([example, path]), cycle_time_us, f"{cycle_time_us} us")
        if cycle_time_us == 1000:
            judge(lose_frames(segment, second, [example, path]), cycle_time_us, f"{cycle_time_us} us, frames lost")
    check_attached(segment, cm1e, example, bus_file(segment.folder, 1000))
    check_clocks(segment, second, cm1e, example)
    shown = segment.run([cm1e, "scan", "-b", path])
    wire.check(shown.returncode == 0 and f"bus left on {wire.MASTER_INTERFACE}:" in shown.stdout
               and f"bus right on {SECOND[0]}:" in shown.stdout and shown.stdout.count("CM1-E") >= 2, shown)
    moved = segment.run([cm1e, "move", "-b", path, "cutter", "--by", "0.2"])
    wire.check(moved.returncode == 0 and "cutter: move done" in moved.stdout, moved)


def main():
    cm1e, example = sys.argv[1:]
    with (tempfile.TemporaryDirectory() as folder,
          wire.segment(cm1e, bus_file(folder, 1000), "--network", "left") as segment):
        wire.join(segment.master, segment.slave, *SECOND)
        second = subprocess.Popen(
            wire.enter(segment.slave, wire.with_priority([cm1e, "sim", "-i", SECOND[1], bus_file(segment.folder, 1000),
                                                          "--network", "right"], 60)),
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        try:
            wire.check("simulated slave" in second.stdout.readline(), "the second cm1e sim did not start")
            check_both(segment, second, cm1e, example)
            second.send_signal(signal.SIGINT)
            wire.check(second.wait(10) == 0, "the second cm1e sim did not end in order")
        finally:
            second.kill()
            second.wait()


main()
