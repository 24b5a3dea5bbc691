#!/usr/bin/env python3
"""`cm1e doctor` on a wire: motor power that is off, a drive in error, a connection that was lost and where, an address
on the interface, the cable out, another program on the interface.

test_wire_doctor.py CM1E
"""
import json
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

SLAVES = "axes: [{position: 1}, {position: 2}, {position: 3}]\n"


# /sys shows the network namespace in which it was mounted.
WITH_SYS = ["unshare", "--mount", "sh", "-c", 'mount -t sysfs sysfs /sys && exec "$@"', "sh"]


def doctor(segment, cm1e, *words, sys_of=WITH_SYS):
    done = segment.run([*sys_of, cm1e, "doctor", "-i", wire.MASTER_INTERFACE, "--seconds", "0", "--json", *words])
    wire.check(done.stdout.startswith("["), f"no list of findings: {done.stdout}{done.stderr}")
    return done.returncode, json.loads(done.stdout)


def find(found, subject, level, *words):
    """The one finding of this subject and level that has the words."""
    fitting = [f for f in found
               if f["subject"] == subject and f["level"] == level and all(w in f["fact"] for w in words)]
    wire.check(len(fitting) == 1, f"{subject}, {level}, {words}: {found}")
    return fitting[0]


def look(segment, cm1e):
    _, found = doctor(segment, cm1e)
    find(found, "slaves", "ok", "3")
    find(found, "connections", "ok")
    find(found, "addresses", "ok", "none")
    wire.check(not [f for f in found if f["group"] == "network" and f["level"] == "problem"], f"problems: {found}")

    segment.console("power 2 off")
    status, found = doctor(segment, cm1e)
    wire.check(status == 1, f"exit status {status} with a problem")
    find(found, "motor power", "problem", "slave 2")
    find(found, "motor power", "ok", "slave 3")
    segment.console("power 2 on")

    segment.console("error 3 7510")
    _, found = doctor(segment, cm1e)
    find(found, "error", "problem", "slave 3", "0x7510")
    segment.console("error 3 clear")


def look_at_wiring(segment, cm1e):
    segment.console("unplug 3")
    _, found = doctor(segment, cm1e)
    find(found, "slaves", "ok", "2")
    segment.console("replug 3")
    _, found = doctor(segment, cm1e)
    find(found, "slaves", "ok", "3")
    find(found, "lost links", "problem", "between slave 2 (port 1, OUT) and slave 3 (port 0, IN)",
         "as slave 2 counts")

    subprocess.run(wire.enter(segment.master, ["ip", "address", "add", "192.0.2.7/24", "dev", wire.MASTER_INTERFACE]),
                   check=True)
    _, found = doctor(segment, cm1e)
    advice = find(found, "addresses", "advice", "192.0.2.7")
    done = segment.run(["sh", "-c", advice["fix"]])
    _, found = doctor(segment, cm1e)
    wire.check(done.returncode == 0, f"the commands fail: {done.stdout}{done.stderr}")
    find(found, "addresses", "ok", "none")


def look_beside_another(segment, cm1e, bus_file):
    move = subprocess.Popen(segment.command([cm1e, "move", "-b", bus_file, "1", "--speed", "0.5", "--for", "4"]),
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wire.wait_for(lambda: "Operation enabled" in segment.console("status 1") or move.poll() is not None, 10,
                  "the motor was not enabled")
    _, found = doctor(segment, cm1e)
    find(found, "program", "note", "cm1e move")
    find(found, "slaves", "ok", "3")
    out, err = move.communicate(timeout=60)
    wire.check(move.returncode == 0, f"the move beside the doctor: {out}{err}")


def look_without_sys(segment, cm1e):
    _, found = doctor(segment, cm1e, sys_of=[])
    find(found, wire.MASTER_INTERFACE, "note", "network namespace that /sys does not show")
    find(found, "slaves", "ok", "3")


def look_at_a_link(segment, cm1e):
    ip = ["ip", "link", "set"]
    subprocess.run(wire.enter(segment.slave, [*ip, wire.SLAVE_INTERFACE, "down"]), check=True)
    _, found = doctor(segment, cm1e)
    find(found, "link", "problem", "no link")
    subprocess.run(wire.enter(segment.slave, [*ip, wire.SLAVE_INTERFACE, "up"]), check=True)
    subprocess.run(wire.enter(segment.master, [*ip, wire.MASTER_INTERFACE, "down"]), check=True)
    _, found = doctor(segment, cm1e)
    find(found, "link", "problem", "is down")


def main():
    cm1e = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        slaves, bus_file = os.path.join(folder, "sim.yaml"), os.path.join(folder, "bus.yaml")
        bus = f"bus: {{interface: {wire.MASTER_INTERFACE}, lost_cycles_limit: 50}}\n"
        for path, text in ((slaves, SLAVES), (bus_file, bus + SLAVES)):
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
        with wire.segment(cm1e, slaves) as segment:
            look(segment, cm1e)
            look_at_wiring(segment, cm1e)
            look_beside_another(segment, cm1e, bus_file)
            look_without_sys(segment, cm1e)
            look_at_a_link(segment, cm1e)


main()
