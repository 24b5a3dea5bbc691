#!/usr/bin/env python3
"""A master that is killed (SIGKILL) while its motor turns: from firmware V1.3.0 on the watchdog of the drive takes the
torque away; before, the drive goes on with what it was told last, as docs/SAFETY.md says.

test_killed_master.py CM1E
"""
import os
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


def enabled(segment):
    return "Operation enabled" in segment.console("status 1")


def kill_master(cm1e, firmware, watchdog):
    with tempfile.TemporaryDirectory() as folder:
        slaves = os.path.join(folder, "slaves.yaml")
        with open(slaves, "w", encoding="utf-8") as file:
            file.write(SLAVES.format(firmware))
        with wire.segment(cm1e, slaves) as segment:
            command = [cm1e, "move", "-b", segment.bus_file(), "X", "--speed", "0.3", "--for", "60"]
            master = subprocess.Popen(segment.command(command), stdout=subprocess.DEVNULL)
            try:
                wire.wait_for(lambda: enabled(segment), 10, "the motor was not enabled")
                time.sleep(0.5)
                wire.check(master.poll() is None, f"the master ended by itself with {master.returncode}")
            finally:
                master.kill()
                master.wait()
            if watchdog:
                wire.wait_for(lambda: not enabled(segment), LATEST_S, f"firmware {firmware}: still under torque")
            else:
                time.sleep(LATEST_S)
                wire.check(enabled(segment), f"firmware {firmware}: this drive has no watchdog, but lost its torque")
            print(f"firmware {firmware}: {segment.console('status 1')}")


if __name__ == "__main__":
    for version, has_watchdog in FIRMWARES:
        kill_master(sys.argv[1], version, has_watchdog)
