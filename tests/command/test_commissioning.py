#!/usr/bin/env python3
"""Registers, states and wiring by the command line: `cm1e reg`, `states` and `graph`, alone and attached to a program.

test_commissioning.py BIN-DIRECTORY
"""
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree

CM1E = os.path.join(os.path.abspath(sys.argv[1]), "cm1e")
BUS = """\
bus: {interface: sim, sim_gaps: terminal, lost_cycles_limit: 50}
axes:
  - {name: "X < \\"1\\"", sim: {no_stops: true}}
  - {name: Y, position: 3}
"""
FOLDER = tempfile.mkdtemp()
ENVIRONMENT = {**os.environ, "CM1E_RUNTIME_DIR": os.path.join(FOLDER, "run")}
FILE = os.path.join(FOLDER, "bus.yaml")
faults = []


def expect(condition, what, told=""):
    if not condition:
        faults.append(f"{what}\n    {told}")


def run(*words):
    return subprocess.run([CM1E, *words], capture_output=True, text=True, timeout=60, env=ENVIRONMENT,
                          stdin=subprocess.DEVNULL)


def on_bus(*words):
    return run(*words, "-b", FILE)


def check_registers():
    told = on_bus("reg", "read", "1", "0x0130")
    expect(told.returncode == 0 and told.stdout == "0x0130  02 00\n  0x0130 = 2 (0x0002): AL status\n", "reg read",
           told)
    told = json.loads(on_bus("reg", "read", "Y", "0x10", "4", "--json").stdout)
    expect(told == {"position": 3, "address": 16, "data": "03100000"}, "the address of slave 3", told)
    told = on_bus("reg", "write", "Y", "0x0420", "500")
    expect(told.returncode == 2 and "--allow-write" in told.stderr, "without consent", told)
    told = on_bus("reg", "write", "Y", "0x0420", "500", "--allow-write")
    expect(told.returncode == 0 and "0x0420 = 500 " in told.stdout, "reg write", told)
    told = on_bus("reg", "write", "Y", "0x0420", "0x10000", "--allow-write")
    expect(told.returncode == 1 and "does not fit into 2 bytes" in told.stderr, "a value that is too large", told)
    for words, said in ((("1", "0x10000"), "the address"), (("1", "0", "513"), "the number of bytes"),
                        (("9", "0"), "no slave 9")):
        told = on_bus("reg", "read", *words)
        expect(told.returncode in (1, 2) and said in told.stderr and told.stdout == "", f"reg read {words}", told)


def check_states():
    told = on_bus("states")
    expect(told.returncode == 0 and [line.split()[:2] for line in told.stdout.splitlines()] ==
           [["1", "Pre-Operational"], ["2", "Pre-Operational"], ["3", "Pre-Operational"]], "states", told)
    told = on_bus("states", "Y", "init", "--json")
    expect(told.returncode == 0 and [(s["position"], s["al_state"]) for s in json.loads(told.stdout)] == [(3, "Init")],
           "a state that is requested", told)
    told = on_bus("states", "Y", "safeop")
    expect(told.returncode == 1 and "0x001D, invalid output configuration" in told.stdout and "refuses" in told.stderr,
           "a state that is refused", told)
    told = on_bus("states", "Y", "op")
    expect(told.returncode == 2 and "exchanges the process data" in told.stderr, "Operational", told)


def check_graph():
    told = on_bus("graph")
    for words in ('digraph network', '1: X < \\"1\\"\\nCM1-E', 's1 -> s2 [taillabel="1", headlabel="0"]',
                  's2 -> s3 [taillabel="1", headlabel="0"]', 'master -> s1'):
        expect(words in told.stdout, f"graph: {words}", told)
    expect(told.returncode == 0 and "red" not in told.stdout, "graph", told)
    picture = on_bus("graph", "--svg", "-")
    root = xml.etree.ElementTree.fromstring(picture.stdout)
    texts = [t.text for t in root.iter("{http://www.w3.org/2000/svg}text")]
    expect('1: X < "1"' in texts and "3: Y" in texts and "ports: 0 open, 1 -, 2 -, 3 -" in texts, "the picture", texts)
    boxes = [(int(r.get("x")), int(r.get("y"))) for r in root.iter("{http://www.w3.org/2000/svg}rect") if r.get("x")]
    expect(len(boxes) == 4 and len({y for _, y in boxes}) == 1 and boxes == sorted(set(boxes)), "a line", boxes)
    told = json.loads(on_bus("graph", "--json").stdout)
    expect([(s["parent"], s["parent_port"], s["known"]) for s in told] == [(0, 0, True), (1, 1, True), (2, 1, True)],
           "graph --json", told)


def check_attached():
    """They look at the network of a running program, and change nothing."""
    program = subprocess.Popen([CM1E, "move", "-b", FILE, "1", "--speed", "0.5", "--for", "30"], stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True, env=ENVIRONMENT)
    socket = os.path.join(FOLDER, "run", f"cm1e-{program.pid}-0.sock")
    end = time.monotonic() + 10
    while not os.path.exists(socket) and time.monotonic() < end:
        time.sleep(0.02)
    pid = str(program.pid)
    try:
        told = run("states", "--attach", pid)
        expect([line.split()[1] for line in told.stdout.splitlines()] == ["Operational"] * 3, "states attached", told)
        told = run("reg", "read", "1", "0x0130", "--attach", pid)
        expect("0x0130 = 8 (0x0008): AL status" in told.stdout, "reg attached", told)
        told = run("reg", "read", "1", "0x0000", "300", "--attach", pid)
        expect(told.returncode == 0 and len(told.stdout.splitlines()) > 19, "many registers attached", told)
        told = run("reg", "read", "1", "0x08ff", "2", "--attach", pid)
        expect(told.returncode == 1 and "up to 0x08FF" in told.stderr, "registers that reading changes", told)
        told = run("graph", "--attach", pid)
        expect("s2 -> s3" in told.stdout and "Operational" in told.stdout, "graph attached", told)
        elsewhere = os.path.join(FOLDER, "elsewhere.yaml")  # of a segment that was made beside the program
        with open(elsewhere, "w", encoding="utf-8") as file:
            file.write('bus: {interface: "sim:not-here.yaml"}\naxes: [{name: Q}]\n')
        told = run("states", "-b", elsewhere, "--attach", pid)
        expect(told.stdout.count("Operational") == 3, "attached, with a bus file whose segment is not here", told)
        for words in (("states", "1", "init"), ("reg", "write", "1", "0x120", "1", "--allow-write")):
            told = run(*words, "--attach", pid)
            expect(told.returncode == 2 and "--attach" in told.stderr, f"{words}", told)
        told = on_bus("states")
        expect("Operational" in told.stdout or told.returncode == 0, "beside a simulated network", told)
    finally:
        program.terminate()
        out, err = program.communicate(timeout=30)
        expect("ErrorStop" not in out + err, "the program was disturbed", out + err)


if __name__ == "__main__":
    try:
        with open(FILE, "w", encoding="utf-8") as bus_file:
            bus_file.write(BUS)
        for check in (check_registers, check_states, check_graph, check_attached):
            check()
    finally:
        shutil.rmtree(FOLDER, ignore_errors=True)
    if faults:
        print("FAILED:", *faults, sep="\n")
        sys.exit(1)
