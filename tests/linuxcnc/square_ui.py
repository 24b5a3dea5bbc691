#!/usr/bin/env python3
"""The user of LinuxCNC in the tests: it is started in place of a screen, switches the machine on, runs what the
environment asks for, and writes what it saw to $CM1E_SEEN as JSON.
"""
import contextlib
import glob
import json
import os
import re
import signal
import subprocess
import sys
import time

import hal
import linuxcnc

SEEN = os.environ["CM1E_SEEN"]
WHAT = os.environ["CM1E_WHAT"]
PROGRAM = os.environ["CM1E_PROGRAM"]
component = hal.component("square-ui")  # only a component may look at pins
component.ready()
command, status, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
seen = {"errors": [], "path": [], "following": [], "pins": {}, "positions": [], "signals": [], "pauses": 0, "ended": True}
PATIENCE_S = 20  # a square takes two seconds, if no pause of the machine stops the axes
FIRST_LINE = 4   # of the program that moves


def poll():
    status.poll()
    error = errors.poll()
    if error:
        seen["errors"].append(error[1])


def until(condition, seconds, what):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        poll()
        if condition():
            return True
        time.sleep(0.005)
    seen["errors"].append(f"not within {seconds} s: {what}")
    return False


def pin(name):
    return hal.get_value(name)


def watch(line):
    """One sample of the machine: set and actual positions of the joints, as LinuxCNC knows them, and the line."""
    poll()
    if not enabled():
        return
    joints = status.joint[:3]
    seen["path"].append([round(j["output"], 5) for j in joints] + [round(j["input"], 5) for j in joints] + [line])
    seen["following"].append([round(abs(j["ferror_current"]), 5) for j in joints])


def enabled():
    return all(pin(f"cm1e.{a}.enabled") for a in "xyz")


def machine_on():
    if not until(lambda: status.task_state >= linuxcnc.STATE_ESTOP, 10, "LinuxCNC has begun"):
        return False
    until(lambda: pin("cm1e.ok"), 10, "cm1e.ok")
    command.state(linuxcnc.STATE_ESTOP_RESET)
    until(lambda: status.task_state == linuxcnc.STATE_ESTOP_RESET, 5, "the emergency stop is released")
    command.state(linuxcnc.STATE_ON)
    on = until(lambda: status.task_state == linuxcnc.STATE_ON, 5, "the machine is on")
    return on and until(enabled, 5, "all axes follow")


def home():
    command.mode(linuxcnc.MODE_MANUAL)
    command.wait_complete()
    command.teleop_enable(False)
    command.wait_complete()
    command.home(-1)
    return until(lambda: all(status.homed[:3]), 5, "all joints are homed")


def run_program(line):
    """Runs it from a line on, 0: from its beginning, as far as is wanted. Returns whether it came so far, and the line at
    which it is; the machine may have been switched off meanwhile."""
    command.mode(linuxcnc.MODE_AUTO)
    command.wait_complete()
    command.program_open(PROGRAM)
    command.wait_complete()
    command.auto(linuxcnc.AUTO_RUN, line)
    until(lambda: status.interp_state != linuxcnc.INTERP_IDLE or not enabled(), 5, "the program has begun")
    end = time.monotonic() + 20
    while time.monotonic() < end and enabled():
        line = max(line, status.motion_line)
        watch(line)
        if WHAT != "square" and seen["path"] and seen["path"][-1][0] > 5:
            return True, line
        if status.interp_state == linuxcnc.INTERP_IDLE and status.inpos:
            time.sleep(0.2)
            watch(line)
            break
        time.sleep(0.01)
    return enabled(), line


def corner_before(line):
    """The words of G0 for where a line of the program begins."""
    with open(PROGRAM, encoding="ascii") as file:
        words = re.findall("([XYZ])([-0-9.]+)", " ".join(file.read().splitlines()[:line - 1]))
    return " ".join(axis + value for axis, value in {"Z": "0", **dict(words)}.items())


def go_back(line):
    """Goes to where the line begins, and forgets what was seen since then. False: a pause stopped the axes again."""
    kept = [i for i, row in enumerate(seen["path"]) if row[6] < line]
    seen["path"], seen["following"] = ([seen[what][i] for i in kept] for what in ("path", "following"))
    if not machine_on():
        return False
    command.mode(linuxcnc.MODE_MDI)
    command.wait_complete()
    command.mdi("G0 " + corner_before(line))
    time.sleep(0.1)
    until(lambda: (status.interp_state == linuxcnc.INTERP_IDLE and status.inpos) or not enabled(), 5, "the corner")
    time.sleep(0.2)
    return enabled()


def run_until_done():
    """A machine without a real-time kernel pauses for milliseconds now and then, which stops the axes: this is
    acknowledged by machine-on, and the program is run again from the line in which it happened. The motors are behind
    the control by less than a line."""
    line, end = 0, time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        done, line = run_program(line)
        if done:
            return
        line = max(line - 1, FIRST_LINE) if WHAT == "square" else FIRST_LINE
        seen["pauses"] += 1
        while not go_back(line) and time.monotonic() < end:
            time.sleep(0.5)
        seen["errors"].clear()
    seen["ended"] = False


def fault(action):
    """Something happens in motion; the machine has to stop by itself."""
    action()
    until(lambda: not any(pin(f"cm1e.{a}.powered") for a in "xyz"), 5, "no axis has torque")
    until(lambda: status.task_state != linuxcnc.STATE_ON, 5, "LinuxCNC has switched the machine off")
    seen["pins"] = {"fault": [bool(pin(f"cm1e.{a}.fault")) for a in "xyz"], "state": status.task_state,
                    "on": linuxcnc.STATE_ON}


def jump():
    subprocess.run(["halcmd", "unlinkp", "cm1e.x.pos-cmd"], check=True)
    subprocess.run(["halcmd", "setp", "cm1e.x.pos-cmd", "30"], check=True)


def processes():
    """Number, name and parent of every process."""
    for path in glob.glob("/proc/[0-9]*/stat"):
        try:
            with open(path, encoding="ascii") as file:
                yield re.match(r"(\d+) \((.*)\) \S (\d+)", file.read()).groups()
        except OSError:
            continue  # it has ended


def kill_linuxcnc():
    """All of this LinuxCNC ends at once: nobody tells the bus to stop. Its realtime part is what started the bus."""
    script, mine = str(os.getppid()), str(os.getpid())
    victims = [parent for _, name, parent in processes() if name == "cm1e-linuxcnc"]
    machine = os.environ["INI_FILE_NAME"].encode()
    for number, _, parent in processes():
        with contextlib.suppress(OSError), open(f"/proc/{number}/cmdline", "rb") as file:
            if number != mine and (parent == script or machine in file.read()):
                victims.append(number)
    for number in victims + [script]:
        with contextlib.suppress(OSError):  # it has ended with another one
            os.kill(int(number), signal.SIGKILL)
    os.remove("/tmp/linuxcnc.lock")


def stop_threads():
    """The servo thread ends: no pin changes any more, so only the bus can tell."""
    subprocess.run(["halcmd", "stop"], check=True)
    time.sleep(1)
    subprocess.run(["halcmd", "start"], check=True)  # LinuxCNC waits long for a thread that stands, when it ends


def main():
    if machine_on() and home():
        run_until_done()
        if WHAT == "jump":
            fault(jump)
        elif WHAT == "estop":
            fault(lambda: command.state(linuxcnc.STATE_ESTOP))
        elif WHAT == "threads":
            stop_threads()
        elif WHAT == "killed":
            kill_linuxcnc()
    if WHAT != "killed":
        look_at_pins()
    with open(SEEN, "w", encoding="utf-8") as file:
        json.dump(seen, file)
    if WHAT != "killed":
        command.state(linuxcnc.STATE_ESTOP)


def set_pin(name, value):
    subprocess.run(["halcmd", "setp", name, str(value)], check=True)


def try_signals():
    """Outputs of other slaves, which are wired to inputs."""
    for out in ((0, 1, 0), (1, 0, 1234)):
        for name, value in zip(("valves.out-1", "valves.out-2", "set-point.out-1"), out):
            set_pin("cm1e.io." + name, value)
        time.sleep(0.1)
        seen["signals"].append([pin("cm1e.io." + name) for name in ("sensors.in-1", "sensors.in-2", "level.in-3")])


def look_at_pins():
    poll()
    try_signals()
    seen["positions"] = [pin(f"cm1e.{a}.pos-fb") for a in "xyz"]
    shown = subprocess.run(["halcmd", "-s", "show", "pin", "cm1e"], capture_output=True, text=True).stdout
    seen["names"] = [row.split()[4] for row in shown.splitlines() if len(row.split()) > 4]
    seen["delay_ms"] = pin("cm1e.delay-ms")


main()
sys.exit(0)
