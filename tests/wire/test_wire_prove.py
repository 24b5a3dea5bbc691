#!/usr/bin/env python3
"""`cm1e init` and `cm1e prove` on a wire: a simulator that plays a profile with a planted difference, the watchdog of the
motor, and what is refused: an interface that is in use, a network that another master has left in Operational. Ctrl-C
within the writes leaves the motor with the values that it had.

test_prove.py CM1E
"""
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

PLANTED = {"cm1e_profile": 1, "entries": [{"entry": "0x100A", "text": "1.3.4"}, {"entry": "0x6084", "default": 1000}]}
MOTION = ["--allow-motion", "--max-velocity", "3", "--max-travel", "2"]
POINTS = [word for name in ("id.*", "dict.*", "esc.clock", "state.op", "move.*", "watchdog.*", "home.-1")
          for word in ("--point", name)]


def prove(segment, cm1e, *words):
    return segment.run([cm1e, "prove", "-i", wire.MASTER_INTERFACE, *words])


def look(segment, cm1e, folder):
    made = os.path.join(folder, "made.yaml")
    done = segment.run([cm1e, "init", "-i", wire.MASTER_INTERFACE, "-o", made])
    wire.check(done.returncode == 0, f"init: {done}")
    with open(made, "r+", encoding="utf-8") as file:
        text = file.read().replace("bus:\n", "bus:\n  lost_cycles_limit: 50\n", 1)
        file.seek(0)
        file.write(text)
    done = segment.run([cm1e, "move", "-b", made, "axis1", "--by", "0.2", "-v", "1"])
    wire.check(done.returncode == 0 and "move done" in done.stdout, f"a move with the file of init: {done}")

    # The simulator has only the planted difference. The motor cannot reach its stops and switches within two turns.
    # The bus file lets a machine pause for 50 ms.
    done = prove(segment, cm1e, "-b", segment.bus_file(), "--json", "-o", os.path.join(folder, "report"), *POINTS, *MOTION)
    report = json.loads(done.stdout)
    verdicts = {point["id"]: point["verdict"] for point in report["points"]}
    differs = {name for name, verdict in verdicts.items() if verdict == "differs"}
    wire.check(done.returncode == 1 and differs == {"dict.defaults"}, f"differs: {differs} {done.stdout[-3000:]}")
    wire.check(report["device"]["firmware"] == "1.3.4" and not report["device"]["simulated"], str(report["device"]))
    for name in ("move.csp", "move.csv", "move.pp", "move.pv", "move.unit", "watchdog.motor", "esc.clock", "state.op"):
        wire.check(verdicts[name] == "agrees", f"{name}: {verdicts[name]}")
    wire.check(verdicts["home.-1"] == "unknown", str(verdicts))
    status = segment.console("status 1")
    wire.check("Operation enabled" not in status, f"the motor is left enabled: {status}")
    for ending in (".md", ".json", ".profile.json"):
        wire.check(os.path.exists(os.path.join(folder, "report" + ending)), f"no report{ending}")


def look_at_wrong_unit(segment, cm1e, folder):
    """A bus file that says kcounts/s2 of a motor that takes counts/s2 (UG 6.2.2, 6.2.3): a thousandth of the acceleration."""
    wrong = os.path.join(folder, "wrong.yaml")
    with open(wrong, "w", encoding="utf-8") as file:
        file.write(f"bus: {{interface: {wire.MASTER_INTERFACE}, lost_cycles_limit: 50}}\n"
                   "axes: [{position: 1, wire: {acceleration_unit: kcounts_per_s2}}]\n")
    done = prove(segment, cm1e, "-b", wrong, "--json", "--point", "move.pv", *MOTION)
    point = next(point for point in json.loads(done.stdout)["points"] if point["id"] == "move.pv")
    wire.check(done.returncode == 1 and point["verdict"] == "differs", f"a wrong unit: {point}")
    wire.check("acceleration by positions (0x6083)" in json.dumps(point), f"a wrong unit: {point}")


def settings(segment, cm1e):
    done = segment.run([cm1e, "params", "list", "-i", wire.MASTER_INTERFACE, "1", "--json"])
    return {row["name"]: row["value"] for row in json.loads(done.stdout)}


def interrupt(segment, cm1e):
    """Frames that are late stretch the time between the write of a bound and the one that takes it back."""
    def timed(*points):
        begin = time.monotonic()
        segment.run([cm1e, "prove", "-i", wire.MASTER_INTERFACE, "--allow-writes", *points])
        return time.monotonic() - begin

    segment.console("delay 1000000 300")
    before = settings(segment, cm1e)
    reading_s = timed("--point", "id.vendor")
    writing_s = timed("--point", "write.too-*") - reading_s
    ended = 0
    for _ in range(10):
        process = subprocess.Popen(segment.command([cm1e, "prove", "-i", wire.MASTER_INTERFACE, "--json", "--allow-writes",
                                                    "--point", "write.too-*"]), stdout=subprocess.PIPE, text=True)
        time.sleep(reading_s + writing_s * random.random())
        process.send_signal(random.choice((signal.SIGINT, signal.SIGTERM, signal.SIGHUP)))
        out = process.communicate(timeout=20)[0]
        ended += process.returncode == 1 and "told to end" in out
    wire.check(settings(segment, cm1e) == before, f"settings are left changed: {settings(segment, cm1e)}, before {before}")
    wire.check(ended > 0, "no run was broken off within its writes")
    segment.console("delay 1 0")


def running_move(segment, cm1e, bus_file):
    move = subprocess.Popen(segment.command([cm1e, "move", "-b", bus_file, "1", "--speed", "0.5", "--for", "20"]),
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wire.wait_for(lambda: "Operation enabled" in segment.console("status 1") or move.poll() is not None, 10,
                  "the motor was not enabled")
    return move


def refuse(segment, cm1e):
    move = running_move(segment, cm1e, segment.bus_file())
    done = prove(segment, cm1e)
    wire.check(done.returncode == 1 and "in use by cm1e move" in done.stderr, f"beside a move: {done}")
    wire.check("Operation enabled" in segment.console("status 1"), "the refused prove has disturbed the move")
    # A master that dies leaves this firmware in Operational: it has no watchdog (UG 10.1).
    move.send_signal(signal.SIGKILL)
    move.communicate(timeout=20)
    done = prove(segment, cm1e)
    wire.check(done.returncode == 1 and "is in Operational" in done.stderr and done.stdout == "", f"enabled: {done}")


def main():
    cm1e = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        planted, old = os.path.join(folder, "planted.json"), os.path.join(folder, "old.yaml")
        with open(planted, "w", encoding="utf-8") as file:
            json.dump(PLANTED, file)
        with open(old, "w", encoding="utf-8") as file:
            file.write("axes: [{position: 1, firmware: 1.2.0, sim: {no_stops: true}}]\n")
        with wire.segment(cm1e, "--profile", planted) as segment:
            look(segment, cm1e, folder)
            look_at_wrong_unit(segment, cm1e, folder)
            interrupt(segment, cm1e)
        with wire.segment(cm1e, old) as segment:
            refuse(segment, cm1e)


main()
