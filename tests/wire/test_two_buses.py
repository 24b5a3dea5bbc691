#!/usr/bin/env python3
"""One program on two networks, over two veth pairs, with a gear from one to the other: at 1 ms and at 250 us, in real
time, and while single frames of either network are lost.

test_two_buses.py CM1E 16_TWO_NETWORKS
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

SECOND = ("ecm1", "ecs1")
TURN_US, IN_STEP_AT_LEAST = 3_000_000, 300
COUNTS_PER_UNIT = 50000
TOLD = re.compile(r"(\d+) cycles on two networks, (\d+) of them in step; there the velocities differed by at most (\S+) u/s")


def bus_file(folder, cycle_time_us):
    path = os.path.join(folder, f"two_{cycle_time_us}.yaml")
    bus = f"cycle_time_us: {cycle_time_us}, lost_cycles_limit: {wire.PAUSE_US // cycle_time_us}"
    with open(path, "w", encoding="utf-8") as file:
        file.write("buses:\n"
                   f"  - {{name: left, bus: {{interface: {wire.MASTER_INTERFACE}, {bus}}}, "
                   "axes: [{name: feeder, sim: {no_stops: true}}]}\n"
                   f"  - {{name: right, bus: {{interface: {SECOND[0]}, {bus}}}, "
                   "axes: [{name: cutter, sim: {no_stops: true}}]}\n")
    return path


def judge(done, cycle_time_us, what):
    """In step to a thousandth of a count in a cycle: with less a slave does not make up distance."""
    told, tolerance = TOLD.search(done.stdout), 1e-3 / COUNTS_PER_UNIT / (cycle_time_us * 1e-6)
    wire.check(done.returncode == 0 and told, f"{what}: {done}")
    wire.check(int(told[1]) == TURN_US // cycle_time_us and int(told[2]) >= IN_STEP_AT_LEAST
               and float(told[3]) < tolerance, f"{what}: {done}")
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


def check_attached(segment, cm1e, example, path):
    """While the program runs, each network has its socket."""
    running = subprocess.Popen(segment.command([example, path]), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    time.sleep(1.2)
    left = segment.run([cm1e, "status", "-i", wire.MASTER_INTERFACE])
    right = segment.run([cm1e, "status", "-b", path, "--network", "right"])
    both = segment.run([cm1e, "status", "-b", path])
    named = segment.run([cm1e, "log", "--attach", str(running.pid), "--network", "right"])
    out, err = running.communicate(timeout=60)
    wire.check(left.returncode == 0 and "Operation enabled" in left.stdout, left)
    wire.check(right.returncode == 0 and "axis cutter" in right.stdout and "Operation enabled" in right.stdout, right)
    wire.check(both.stdout.count("Operation enabled") == 2 and "axis feeder" in both.stdout, both)
    wire.check(named.returncode == 0, named)
    judge(subprocess.CompletedProcess([example, path], running.returncode, out, err), 1000, "1000 us, watched")


def check_both(segment, second, cm1e, example):
    for cycle_time_us in (1000, 250):
        path = bus_file(segment.folder, cycle_time_us)
        judge(segment.run([example, path]), cycle_time_us, f"{cycle_time_us} us")
        if cycle_time_us == 1000:
            judge(lose_frames(segment, second, [example, path]), cycle_time_us, f"{cycle_time_us} us, frames lost")
    check_attached(segment, cm1e, example, bus_file(segment.folder, 1000))
    shown = segment.run([cm1e, "scan", "-b", path])
    wire.check(shown.returncode == 0 and f"bus left on {wire.MASTER_INTERFACE}:" in shown.stdout
               and f"bus right on {SECOND[0]}:" in shown.stdout and shown.stdout.count("CM1-E") == 2, shown)
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
