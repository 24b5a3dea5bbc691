#!/usr/bin/env python3
"""`cm1e io` on the simulated segment: inputs of the motors with what the bus file has wired to them, signals of a
module, outputs that are written for a while, and what is refused before anything is written. The same beside a running
program.

test_io.py BIN-DIRECTORY
"""
import contextlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import real_time  # noqa: E402
from control_client import Client  # noqa: E402

CM1E = os.path.join(sys.argv[1], "cm1e")
BUS = """bus: {interface: sim, lost_cycles_limit: 50}
axes:
  - {name: X, position: 1, inputs: {home: 2, limit_positive: 3, limits_normally_closed: true}}
  - {name: Y, position: 3}
"""
WIRED_BUS = """\
bus: {interface: sim, cycle_time_us: 1000, lost_cycles_limit: 50}
axes:
  - name: X
    position: 1
    inputs: {signals: [switches.part, switches.home], home: switches.home, limit_positive: switches.end,
             home_normally_closed: true}
    outputs: {signals: [valves.glue]}
slaves:
  - {name: valves, position: 2, outputs: [{name: glue, bit: 0}, {name: free, bit: 1}],
     sim: {device: digital, outputs: 4}}
  - {name: switches, position: 3, inputs: [{name: part, bit: 0}, {name: home, bit: 1}, {name: end, bit: 2}],
     sim: {device: digital, inputs: 4}}
"""
SAFE_BUS = """bus: {interface: sim, lost_cycles_limit: 50}
axes:
  - {name: X, position: 1}
slaves:
  - {name: valves, position: 2, outputs: [{name: lamp, bit: 3, safe: on}]}
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
    with open(os.path.join(folder, "wide.yaml"), "w", encoding="utf-8") as file:
        file.write(BUS.replace("name: Y", "name: 'türntable'"))
    wide = subprocess.run([CM1E, "io", "-b", file.name], capture_output=True, text=True, timeout=60)
    types = {max(line.rfind(" BOOL "), line.rfind(" USINT ")) for line in wide.stdout.splitlines() if "." in line}
    expect("türntable.IN1" in wide.stdout and types == {48}, "a column for all names", wide)
    whole = json.loads(io("--json", "--all").stdout)
    expect(len(whole["signals"]) > 20 and any(s["of_axis"] for s in whole["signals"]), "--all", whole)
    written = io("2.outputs=5", "--allow-output", "--for", "0.2", "--json")
    values = {s["name"]: s["value"] for s in json.loads(written.stdout or '{"signals": []}')["signals"]}
    expect(values == {"Inputs": "5", "Outputs": "5"}, "an output, and the input that is wired to it", written)
    for words, said in ((["2.outputs=5"], "--allow-output"), (["2.outputs=5", "--allow-output"], "--for"),
                        (["2.outputs"], "NAME=VALUE"), (["2.outputs=x", "--allow-output", "--for", "1"], "x"),
                        (["2.outputs=256", "--allow-output", "--for", "1"], "with 256: its type has no such value: USINT, 0 ... 255"),
                        (["2.inputs=1", "--allow-output", "--for", "1"], "cannot be written with 1: it is an input"),
                        (["1.0x6040:00=15", "--allow-output", "--for", "1"], "belongs to a motor"),
                        (["2.nothing=1", "--allow-output", "--for", "1"], "no signal \"nothing\"")):
        told = io(*words)
        expect(told.returncode == 2 and said in told.stderr, f"{words}", told)


# ---- beside a running program ---------------------------------------------------------------------------------------

@contextlib.contextmanager
def running(folder, control, *words, bus=None):
    """A program that has the network, and a function that runs `cm1e io` beside it."""
    environment = {**os.environ, "CM1E_RUNTIME_DIR": os.path.join(folder, "run")}
    bus_file = os.path.join(folder, "attached.yaml")
    with open(bus_file, "w", encoding="utf-8") as file:
        file.write((bus or BUS).replace("sim,", f"sim, control: {control},"))
    process = subprocess.Popen([CM1E, words[0], "-b", bus_file, *words[1:]], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True, env=environment)
    path = os.path.join(folder, "run", f"cm1e-{process.pid}-0.sock")

    def start(*more):
        return subprocess.Popen([CM1E, "io", "--attach", str(process.pid), *more], stdout=subprocess.PIPE,
                                stderr=subprocess.PIPE, text=True, env=environment)

    def io(*more):
        child = start(*more)
        out, err = child.communicate(timeout=60)
        return subprocess.CompletedProcess(more, child.returncode, out, err)
    try:
        end = time.monotonic() + 10
        while not os.path.exists(path) and time.monotonic() < end:
            time.sleep(0.01)
        io.start, io.path = start, path
        yield io
        expect(process.poll() is None, "the program has ended", words)
    finally:
        process.terminate()
        out, err = process.communicate(timeout=30)
        expect("ErrorStop" not in out + err, "the program was disturbed", out + err)


def values(told):
    signals = json.loads(told.stdout or '{"signals": []}')["signals"]
    return {(row["slave"], row["name"]): row["value"] for row in signals}


def attached(folder):
    turn = ("move", "X", "--speed", "0.01", "--for", "100")
    with running(folder, "maintain", *turn) as io:
        alone = subprocess.run([CM1E, "io", "-b", os.path.join(folder, "attached.yaml")], capture_output=True,
                               text=True, timeout=60)
        told = io()
        expect(told.returncode == 0 and [line.rsplit(None, 1)[0] for line in told.stdout.splitlines()] ==
               [line.rsplit(None, 1)[0] for line in alone.stdout.splitlines()], "the same rows as alone", (alone, told))
        whole = io("--json", "--all")
        expect(len(json.loads(whole.stdout)["signals"]) > 20, "--all", whole)
        written = io("2.outputs=5", "--allow-output", "--for", "1.5", "--json")
        expect(values(written) == {(2, "Inputs"): "5", (2, "Outputs"): "5"}, "written, and renewed", written)
        expect(values(io("--json")) == {(2, "Inputs"): "0", (2, "Outputs"): "0"}, "0 when it has ended", io("--json"))
        for words, said in ((["2.outputs=256"], "with 256: its type has no such value: USINT, 0 ... 255."),
                            (["2.inputs=1"], "with 1: it is an input."),
                            (["1.0x6040:00=15"], "belongs to a motor"), (["2.nothing=1"], "no signal \"nothing\""),
                            (["2.outputs=3", "9.outputs=1"], "names no slave")):
            told = io(*words, "--allow-output", "--for", "1")
            expect(told.returncode == 2 and said in told.stderr, f"attached {words}", told)
        check_ends(io)
    with running(folder, "observe", *turn) as io:
        told = io("2.outputs=5", "--allow-output", "--for", "1")
        expect(told.returncode == 1 and "control: maintain" in told.stderr and io().returncode == 0, "observe", told)
    with running(folder, "maintain", "io", "2.outputs=3", "--allow-output", "--for", "100") as io:
        expect(values(io("--json")) == {(2, "Inputs"): "3", (2, "Outputs"): "3"}, "an output of the program", io())
        told = io("2.outputs=5", "--allow-output", "--for", "1")
        expect(told.returncode == 1 and "belongs to the program" in told.stderr, "it is not written", told)
        expect(values(io("--json"))[(2, "Outputs")] == "3", "it has kept its value", io())


def check_safe_value(folder):
    """An output that is let go of has the safe value of the bus file again."""
    with running(folder, "maintain", "move", "X", "--speed", "0.01", "--for", "100", bus=SAFE_BUS) as io:
        expect(values(io("--json"))[(2, "lamp")] == "1", "the safe value", io("--json"))
        told = io("valves.lamp=0", "--allow-output", "--for", "0.3", "--json")
        expect(values(told)[(2, "lamp")] == "0" and '"slave_name": "valves"' in told.stdout, "by its name", told)
        expect(values(io("--json"))[(2, "lamp")] == "1", "the safe value again", io("--json"))


def check_wiring(folder):
    """Signals that axes use are marked, and an output that an axis drives is not written, alone and attached."""
    uses = {(2, "glue"): "X: output 11", (2, "free"): "", (3, "part"): "X: input 11",
            (3, "home"): "X: input 12, home switch (normally closed)", (3, "end"): "X: input 13, positive limit switch"}

    def check(io, what, said):
        told = io("--json")
        rows = {(row["slave"], row["name"]): row["use"] for row in json.loads(told.stdout)["signals"]}
        expect({key: rows.get(key) for key in uses} == uses, f"{what}: uses", (rows, told.stderr))
        expect("X: input 12, home switch (normally closed)" in io().stdout, f"{what}: as text", io().stdout)
        told = io("valves.glue=1", "--allow-output", "--for", "0.2")
        expect(told.returncode == 1 and said in told.stderr and "X: output 11" in told.stderr, f"{what}: driven", told)
        told = io("valves.free=1", "--allow-output", "--for", "0.2", "--json")
        expect(values(told)[2, "free"] == "1" and values(told)[2, "glue"] == "0", f"{what}: another one", told)

    path = os.path.join(folder, "wired.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(WIRED_BUS)
    check(lambda *words: subprocess.run([CM1E, "io", "-b", path, *words], capture_output=True, text=True, timeout=60),
          "alone", "belongs to an axis")
    with running(folder, "maintain", "move", "X", "--speed", "0.01", "--for", "100", bus=WIRED_BUS) as io:
        check(io, "attached", "whose axis drives it")


def check_ends(io):
    """Whoever holds an output and does not renew it, or is gone, loses it; another one does not get it before."""
    with Client(io.path) as client:
        def output():
            return next(row for row in client.ask("io")["io"] if row["output"] and not row["of_axis"])["value"]

        def wait_for(value, seconds):
            end = time.monotonic() + seconds
            while output() != value and time.monotonic() < end:
                time.sleep(0.01)
            return output() == value
        for number in (signal.SIGSTOP, signal.SIGKILL, signal.SIGINT):
            child = io.start("2.outputs=9", "--allow-output", "--for", "60")
            expect(wait_for(9, 5), "an output is set", number)
            refused = client.ask("output", name="2.outputs", value=1)
            expect(not refused["ok"] and "Another connection" in refused["error"]["text"], "it is held", refused)
            child.send_signal(number)
            expect(wait_for(0, 3), f"0 after {number!r}", output())
            child.kill()
            child.communicate()
        told = client.ask("output", name="2.outputs", value=7, keep_ms=200)
        expect(told["ok"] and output() == 7, "a client", told)
        time.sleep(0.4)
        expect(output() == 0, "an output that is not renewed", output())
        with Client(io.path) as other:
            expect(client.ask("output", name="2.outputs", value=5, keep_ms=5000)["ok"] and output() == 5, "a client", output())
            expect(other.ask("output", name="2.outputs", value=None)["ok"] and output() == 5, "let go of by another one", output())
            expect(not other.ask("output", name="2.outputs", value=6)["ok"], "it is still held", output())
            expect(client.ask("output", name="2.outputs", value=None)["ok"] and output() == 0, "let go of", output())
            expect(other.ask("output", name="2.outputs", value=6)["ok"] and output() == 6, "another one has it then", output())
            expect(other.ask("output", name="2.outputs", value=None)["ok"] and output() == 0, "let go of again", output())
        for wrong in ({}, {"name": 5, "value": 1}, {"name": "2.outputs"}, {"name": "2.outputs", "value": "1"},
                      {"name": "2.outputs", "value": 1, "keep_ms": 10},
                      {"name": "2.outputs", "value": 1, "keep_ms": 6000}):
            refused = client.ask("output", **wrong)
            expect(not refused["ok"] and "expected" in refused["error"]["text"], f"output {wrong}", refused)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as temporary:
        main(temporary)
        attached(temporary)
        check_safe_value(temporary)
        check_wiring(temporary)
    if faults:
        real_time.skip_on_a_busy_machine(faults)
        print("FAILED:", *faults, sep="\n")
        sys.exit(1)
    print("inputs, outputs and refusals: good")
