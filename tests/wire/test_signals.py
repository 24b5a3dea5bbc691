#!/usr/bin/env python3
"""A master that is told to end while its motor turns, in every way in which a terminal or a system tells it: the motor
stands when the master has ended, also that of firmware 1.2.0 in CSV, which nothing else would stop. The simulator ends
in order by the same signals.

test_signals.py CM1E
"""
import contextlib
import os
import re
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

SLAVES = "axes: [{firmware: 1.2.0, sim: {no_stops: true}}]\n"
CSV = "    mapping: csv\n    limits: {deceleration: 20}\n"
NUMBERS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGPIPE, signal.SIGTSTP, signal.SIGXCPU,
           signal.SIGXFSZ)


def bus_file(segment):
    path = segment.bus_file()
    with open(path, "a", encoding="utf-8") as file:
        file.write(CSV)
    return path


def position(segment):
    line = segment.console("status 1")
    found = re.search(r"position (-?\d+)", line)
    wire.check(found, f"the console tells no position: {line}")
    return int(found[1])


def velocity(segment):
    """Of the shaft, revolutions a second."""
    began, before = time.monotonic(), position(segment)
    time.sleep(0.05)
    return (position(segment) - before) / 50000 / (time.monotonic() - began)


def end_by(segment, cm1e, number, nohup=False):
    """Signals the master twice; returns what it said and how long it took to end."""
    command = [cm1e, "move", "-b", bus_file(segment), "X", "--speed", "10", "--for", "3" if nohup else "60"]
    master = subprocess.Popen(segment.command([*(["nohup"] if nohup else []), *command]), stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wire.wait_for(lambda: velocity(segment) > 9 or master.poll() is not None, 10, "the motor does not turn")
    began = time.monotonic()
    for _ in range(2):
        master.send_signal(number)
        time.sleep(0.1)
    output, complaint = master.communicate(timeout=20)
    took = time.monotonic() - began
    speed = velocity(segment)
    wire.check(abs(speed) < 0.1, f"{number.name}: the motor goes on with {speed} rev/s; {complaint}")
    return master.returncode, output, complaint, took


@contextlib.contextmanager
def segment_of_a_motor(cm1e):
    with tempfile.TemporaryDirectory() as folder:
        slaves = os.path.join(folder, "slaves.yaml")
        with open(slaves, "w", encoding="utf-8") as file:
            file.write(SLAVES)
        with wire.segment(cm1e, slaves) as segment:
            yield segment


def ended_master(cm1e, numbers):
    with segment_of_a_motor(cm1e) as segment:
        for number in numbers:
            status, _, complaint, took = end_by(segment, cm1e, number)
            wire.check(status == 1 and "interrupted" in complaint, f"{number.name}: {status} {complaint}")
            wire.check(took > 0.4, f"{number.name}: at rest after {took:.3f} s, sooner than the ramp")
            print(f"{number.name}: at rest, ended after {took:.3f} s")


def master_under_nohup(cm1e):
    with segment_of_a_motor(cm1e) as segment:
        status, output, complaint, took = end_by(segment, cm1e, signal.SIGHUP, nohup=True)
        wire.check(status == 0 and "done" in output and took > 2, f"under nohup: {status} {output}{complaint}")
    print("SIGHUP under nohup: ignored, the move ends by itself")


def ended_simulator(cm1e):
    for number in (signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT, signal.SIGPIPE):
        with wire.segment(cm1e) as segment: # its end judges the exit status
            segment.simulator.send_signal(number)
            time.sleep(0.1)


def main(cm1e):
    wire.together(lambda: master_under_nohup(cm1e), lambda: ended_master(cm1e, NUMBERS[:4]),
                  lambda: ended_master(cm1e, NUMBERS[4:]), lambda: ended_simulator(cm1e))


if __name__ == "__main__":
    main(sys.argv[1])
