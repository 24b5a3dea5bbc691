#!/usr/bin/env python3
"""Lines on the standard input of `cm1e sim` act on a motor that our master turns over the wire, and each is answered.

test_sim_console.py CM1E
"""
import os
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402


def turn_and(segment, cm1e, *lines):
    """Starts to turn the motor, gives the console lines, returns the master's standard error."""
    command = segment.command([cm1e, "move", "-b", segment.bus_file(), "--reset", "--speed", "0.3", "--for", "6"])
    master = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wire.wait_for(lambda: "Operation enabled" in segment.console("status 1"), 5, "the motor was not enabled")
    time.sleep(0.3)
    for line in lines:
        answer = segment.console(line)
        wire.check(answer and "expected" not in answer, f"{line!r} was answered with {answer!r}")
    _, complaint = master.communicate(timeout=30)
    wire.check(master.returncode == 1, f"the master ended with {master.returncode} after {lines}: {complaint}")
    return complaint


def main(cm1e):
    with wire.segment(cm1e) as segment:
        wire.check("not a command" in segment.console("fly 1"), "an unknown command was taken")
        complaint = turn_and(segment, cm1e, "power 1 off")
        wire.check("motor power" in complaint, f"power off: {complaint}")
        segment.console("power 1 on")
        result = segment.run([cm1e, "move", "-b", segment.bus_file(), "--by", "0.1"])
        wire.check(result.returncode == 1 and "--reset" in result.stderr, f"a faulty drive moved: {result}")
        complaint = turn_and(segment, cm1e, "error 1 7310")
        wire.check("7310" in complaint and "peed" in complaint, f"over speed: {complaint}")
        complaint = turn_and(segment, cm1e, "unplug 1")
        wire.check("lost" in complaint or "answer" in complaint, f"unplugged: {complaint}")
        segment.console("replug 1")
        result = segment.run([cm1e, "move", "-b", segment.bus_file(), "--reset", "--by", "0.1"])
        wire.check(result.returncode == 0, f"after all that: {result.stdout}{result.stderr}")
    print("console: power off, an error code, unplugged and replugged while the motor turned")


if __name__ == "__main__":
    main(sys.argv[1])
