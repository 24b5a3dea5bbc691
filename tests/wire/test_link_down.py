#!/usr/bin/env python3
"""The master's network interface goes down while its motor turns: the master says that the interface did not take its
frames, the watchdog of the drive takes the torque away, the motor does not leap, and when the interface is up again the
next master moves it.

test_link_down.py CM1E
"""
import os
import re
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

SLAVES = "axes: [{firmware: 1.3.5, sim: {no_stops: true}}]\n"
SPEED = 2.0 # revolutions a second
COUNTS = 50000
# The watchdog's 100 ms at this speed, the way in which friction stops the shaft, and pauses of a loaded machine.
MOST_REVOLUTIONS = 1.5
# This machine gave the master, or the simulator, no processor for 50 ms before the interface was down.
PAUSED = ("no process data came in time", "frames are lost")
ATTEMPTS = 5


def position(segment):
    line = segment.console("status 1")
    found = re.search(r"position (-?\d+)", line)
    wire.check(found, f"the console tells no position: {line}")
    return int(found[1])


def enabled(segment):
    return "Operation enabled" in segment.console("status 1")


def set_link(segment, state):
    done = segment.run(["ip", "link", "set", wire.MASTER_INTERFACE, state])
    wire.check(done.returncode == 0, f"the interface does not go {state}: {done.stderr}")


def lose_interface(segment, cm1e):
    """What the master said; None: it ended, or stopped the motor, before the interface was down."""
    command = [cm1e, "move", "-b", segment.bus_file(), "X", "--speed", str(SPEED), "--for", "60"]
    master = subprocess.Popen(segment.command(command), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    try:
        wire.wait_for(lambda: enabled(segment) or master.poll() is not None, 10, "the motor was not enabled")
        time.sleep(0.5)
        if master.poll() is not None:
            told = master.communicate()[1]
            wire.check(any(words in told for words in PAUSED), f"the master ended by itself: {told}")
            return None
        before = position(segment)
        set_link(segment, "down")
        told = master.communicate(timeout=60)[1]
    finally:
        master.kill()
    wire.check(master.returncode == 1, f"the master ended with {master.returncode}: {told}")
    if any(words in told for words in PAUSED) and "did not take" not in told:
        set_link(segment, "up")
        return None
    wire.wait_for(lambda: not enabled(segment), 1, "the drive is still under torque")
    time.sleep(0.3)
    stands = position(segment)
    way = (stands - before) / COUNTS
    wire.check(0 <= way < MOST_REVOLUTIONS, f"the motor went on for {way:.3f} revolutions")
    set_link(segment, "up")
    time.sleep(0.3)
    wire.check(position(segment) == stands, "the motor moves when the interface is up again")
    return told


def main(cm1e):
    with tempfile.TemporaryDirectory() as folder:
        slaves = os.path.join(folder, "slaves.yaml")
        with open(slaves, "w", encoding="utf-8") as file:
            file.write(SLAVES)
        with wire.segment(cm1e, slaves) as segment:
            told = None
            for _ in range(ATTEMPTS):
                told = told or lose_interface(segment, cm1e)
            wire.check(told, f"no master lived until its interface was down, {ATTEMPTS} times")
            print(told.strip())
            unsent = re.search(r"did not take (\d+) frames since the start: it is down", told)
            wire.check(unsent and int(unsent[1]) > 0, "it does not say that the interface is down")
            again = segment.run([cm1e, "move", "-b", segment.bus_file(), "X", "--by", "1", "--velocity", "5"])
            wire.check(again.returncode == 0, f"the next master: {again.stdout}{again.stderr}")
            print(again.stdout.strip())


if __name__ == "__main__":
    main(sys.argv[1])
