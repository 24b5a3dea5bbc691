#!/usr/bin/env python3
"""A master that is killed (SIGKILL) while its motor turns: from firmware V1.3.0 on the watchdog of the drive takes the
torque away; before, the drive goes on with what it was told last, as docs/SAFETY.md says.

test_killed_master.py CM1E
"""
import os
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

# firmware of the drive; whether it has a watchdog (UG 10.1)
FIRMWARES = (("1.2.0", False), ("1.3.0", True), ("1.3.5", True))
SLAVES = "axes: [{{firmware: {}, sim: {{no_stops: true}}}}]\n"
# The watchdog's 100 ms, and pauses of a loaded machine.
LATEST_S = 1.0
# What is seen of a master that stopped because this machine gave it, or the simulator, no processor for 50 ms or more:
# it was not killed while its motor turned, so nothing was tested, and it starts anew.
NO_LONGER_ENABLED = "the drive was no longer enabled when the master was to be killed"
PAUSED = ("no process data came in time", "frames are lost", NO_LONGER_ENABLED)
ATTEMPTS = 5


def enabled(segment):
    return "Operation enabled" in segment.console("status 1")


def run_until_killed(segment, cm1e):
    """Kills a master whose motor turns. None, or why it was none: what the master itself said, or the drive."""
    command = [cm1e, "move", "-b", segment.bus_file(), "X", "--speed", "0.3", "--for", "60"]
    master = subprocess.Popen(segment.command(command), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    try:
        wire.wait_for(lambda: enabled(segment) or master.poll() is not None, 10, "the motor was not enabled")
        time.sleep(0.5)
        # Nothing more of the master's reaches the drive when the simulator answers and has read what was on its way.
        master.send_signal(signal.SIGSTOP)
        enabled(segment)
        time.sleep(0.02)
        turns = enabled(segment)
    finally:
        master.kill()
        told = master.communicate()[1]
    if master.returncode != -signal.SIGKILL:
        return told or f"exit status {master.returncode}"
    return None if turns else NO_LONGER_ENABLED


def kill_master(cm1e, firmware, watchdog):
    with tempfile.TemporaryDirectory() as folder:
        slaves = os.path.join(folder, "slaves.yaml")
        with open(slaves, "w", encoding="utf-8") as file:
            file.write(SLAVES.format(firmware))
        with wire.segment(cm1e, slaves) as segment:
            told = run_until_killed(segment, cm1e)
            if told:
                return told
            if watchdog:
                wire.wait_for(lambda: not enabled(segment), LATEST_S, f"firmware {firmware}: still under torque")
            else:
                time.sleep(LATEST_S)
                wire.check(enabled(segment), f"firmware {firmware}: this drive has no watchdog, but lost its torque")
            print(f"firmware {firmware}: {segment.console('status 1')}")
    return None


if __name__ == "__main__":
    for version, has_watchdog in FIRMWARES:
        for _ in range(ATTEMPTS):
            ended = kill_master(sys.argv[1], version, has_watchdog)
            wire.check(not ended or any(words in ended for words in PAUSED), f"the master ended by itself: {ended}")
            if not ended:
                break
            print(f"firmware {version}: again, this machine stood still: {ended.strip()}")
        wire.check(not ended, f"firmware {version}: no master lived until it was killed, {ATTEMPTS} times")
