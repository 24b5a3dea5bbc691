#!/usr/bin/env python3
"""Optional slaves that are absent, as the commands show them: alone, and beside a program that runs the network.

test_hot_connect.py BIN-DIRECTORY
"""
import json
import os
import subprocess
import sys
import tempfile
import time

CM1E = os.path.join(sys.argv[1], "cm1e")
EXAMPLE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "examples", "hot_connect.yaml")
ABSENT = ('Slave 3 ("lift", CM1-E) is optional and absent: no device with explicit device ID 7 is on the wire.',
          'Slave 4 ("changer", not seen yet) is optional and absent: no device with alias 4711 is on the wire.',
          'Slave 5 ("fingers", not seen yet) is optional and absent: no device with place 2 of the group "gripper"')
faults = []


def expect(condition, what, told):
    if not condition:
        faults.append(f"{what}: {told}")


def run(*words, **more):
    return subprocess.run([CM1E, *words], capture_output=True, text=True, timeout=60, **more)


def alone():
    told = run("status", "-b", EXAMPLE)
    expect(told.returncode == 0 and all(text in told.stdout for text in ABSENT), "status", told)
    listed = json.loads(run("status", "-b", EXAMPLE, "--json").stdout)
    expect([row.get("presence") for row in listed] == [None, None] + ["absent"] * 3, "status --json", listed)
    told = run("doctor", "-b", EXAMPLE)
    expect(all(text in told.stdout for text in ABSENT) and "does not answer" not in told.stdout, "doctor", told)


WIRE = """axes:
  - {name: first, alias: 7, firmware: 1.2.0}
  - {name: second, position: 2, firmware: 1.3.5}
"""
IN_FRONT = """bus: {interface: "sim:wire.yaml"}
axes:
  - {name: Y, position: 1}                       # the first while the lift is not there
  - {name: lift, alias: 7, optional: true}
"""


def in_front(folder):
    """An axis is its own motor where an optional one is before it on the wire: its position counts without that."""
    for name, text in (("wire.yaml", WIRE), ("bus.yaml", IN_FRONT)):
        with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
            file.write(text)
    for axis, firmware in (("Y", "1.3.5"), ("lift", "1.2.0")):
        told = run("params", "backup", axis, f"{axis}.yaml", "-b", "bus.yaml", cwd=folder)
        expect(told.returncode == 0, f"params of {axis}", told)
        with open(os.path.join(folder, f"{axis}.yaml"), encoding="utf-8") as file:
            text = file.read()
        expect(firmware in text, f"the parameters of {axis} are those of another motor", text[:400])
    told = run("status", "-b", "bus.yaml", cwd=folder)
    expect("slave 1, axis lift: CM1-E, firmware 1.2.0" in told.stdout and
           "slave 2, axis Y: CM1-E, firmware 1.3.5" in told.stdout, "status with an optional motor in front", told)
    told = run("graph", "-b", "bus.yaml", cwd=folder)
    expect("1: lift" in told.stdout and "2: Y" in told.stdout, "graph with an optional motor in front", told)


def attached(folder):
    """The others move; the absent ones are told by the program."""
    bus_file = os.path.join(folder, "bus.yaml")
    with open(EXAMPLE, encoding="utf-8") as file, open(bus_file, "w", encoding="utf-8") as other:
        other.write(file.read().replace("cycle_time_us: 1000", "cycle_time_us: 1000\n  lost_cycles_limit: 50"))
    environment = {**os.environ, "CM1E_RUNTIME_DIR": os.path.join(folder, "run")}
    program = subprocess.Popen([CM1E, "move", "X", "-b", bus_file, "--speed", "0.05", "--for", "100"],
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment)
    path = os.path.join(folder, "run", f"cm1e-{program.pid}-0.sock")
    end = time.monotonic() + 20
    while not os.path.exists(path) and program.poll() is None and time.monotonic() < end:
        time.sleep(0.02)
    told = run("status", "--attach", str(program.pid), env=environment)
    expect(told.returncode == 0 and all(text in told.stdout for text in ABSENT), "status of a program", told)
    expect("slave 1" in told.stdout and "Operational" in told.stdout, "the others of a program", told)
    expect(program.poll() is None, "the program has ended", program.returncode)
    program.terminate()
    out, err = program.communicate(timeout=30)
    expect("ErrorStop" not in out + err, "the program was disturbed", out + err)


alone()
with tempfile.TemporaryDirectory() as temporary:
    in_front(temporary)
    attached(temporary)
for fault in faults:
    print(fault)
print("hot connect:", "fine" if not faults else f"{len(faults)} faults")
sys.exit(bool(faults))
