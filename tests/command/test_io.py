#!/usr/bin/env python3
"""`cm1e io` on the simulated segment: inputs of the motors with what the bus file has wired to them, signals of a module,
outputs that are written for a while, and what is refused before anything is written.

test_io.py BIN-DIRECTORY
"""
import json
import os
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import real_time  # noqa: E402

CM1E = os.path.join(sys.argv[1], "cm1e")
BUS = """bus: {interface: sim, lost_cycles_limit: 50}
axes:
  - {name: X, position: 1, inputs: {home: 2, limit_positive: 3, limits_normally_closed: true}}
  - {name: Y, position: 3}
"""
faults = []


def expect(condition, what, told):
    if not condition:
        faults.append(f"{what}: {told}")


def main(folder):
    bus_file = os.path.join(folder, "bus.yaml")
    with open(bus_file, "w", encoding="utf-8") as file:
        file.write(BUS)

    def io(*words):
        return subprocess.run([CM1E, "io", "-b", bus_file, *words], capture_output=True, text=True, timeout=60)

    told = io("--json")
    listed = json.loads(told.stdout) if told.returncode == 0 else {"axes": [], "signals": []}
    wired = {(row["axis"], row["input"]): row["wired"] for row in listed["axes"] if "input" in row}
    expect(len(wired) == 8 and wired[("X", 2)] == "home switch" and wired[("Y", 1)] == ""
           and wired[("X", 3)] == "positive limit switch (normally closed)", "inputs", told)
    expect([row["axis"] for row in listed["axes"] if "output" in row] == ["X", "Y"], "outputs of motors", told)
    expect([(s["slave"], s["name"], s["type"], s["value"]) for s in listed["signals"]] ==
           [(2, "Inputs", "USINT", "0"), (2, "Outputs", "USINT", "0")], "the module", told)
    whole = json.loads(io("--json", "--all").stdout)
    expect(len(whole["signals"]) > 20 and any(s["of_axis"] for s in whole["signals"]), "--all", whole)
    written = io("2.outputs=5", "--allow-output", "--for", "0.2", "--json")
    values = {s["name"]: s["value"] for s in json.loads(written.stdout or '{"signals": []}')["signals"]}
    expect(values == {"Inputs": "5", "Outputs": "5"}, "an output, and the input that is wired to it", written)
    for words, said in ((["2.outputs=5"], "--allow-output"), (["2.outputs=5", "--allow-output"], "--for"),
                        (["2.outputs"], "NAME=VALUE"), (["2.outputs=x", "--allow-output", "--for", "1"], "x"),
                        (["2.outputs=256", "--allow-output", "--for", "1"], "cannot be written"),
                        (["2.inputs=1", "--allow-output", "--for", "1"], "cannot be written"),
                        (["1.0x6040:00=15", "--allow-output", "--for", "1"], "belongs to a motor"),
                        (["2.nothing=1", "--allow-output", "--for", "1"], "no signal \"nothing\"")):
        told = io(*words)
        expect(told.returncode != 0 and said in told.stderr, f"{words}", told)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as temporary:
        main(temporary)
    if faults:
        real_time.skip_on_a_busy_machine(faults)
        print("FAILED:", *faults, sep="\n")
        sys.exit(1)
    print("inputs, outputs and refusals: good")
