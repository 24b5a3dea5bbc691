#!/usr/bin/env python3
"""Commands on a bus file with several buses: what shows things shows all of them, an axis chooses its bus, and the rest
says how to choose.

test_buses.py BUILD-DIRECTORY SOURCE-DIRECTORY
"""
import json
import os
import subprocess
import sys
import tempfile
import time

BIN = os.path.join(os.path.abspath(sys.argv[1]), "bin")
FILE = os.path.join(sys.argv[2], "examples", "two_buses.yaml")
FAILED, WRONG_USE = 1, 2
faults = []


def run(*words):
    return subprocess.run([os.path.join(BIN, "cm1e"), *words], capture_output=True, text=True, timeout=60)


def expect(condition, what):
    if not condition:
        faults.append(str(what))


for command in ("scan", "status", "io", "states"):
    shown = run(command, "-b", FILE)
    left, right = shown.stdout.find("bus left on sim:"), shown.stdout.find("bus right on sim:")
    expect(shown.returncode == 0 and 0 <= left < right, shown)
    one = run(command, "-b", FILE, "--network", "right")
    expect(one.returncode == 0 and "bus " not in one.stdout.split("\n")[0] and "gripper" not in one.stdout, one)
expect("cutter" in run("status", "-b", FILE).stdout.split("bus right")[1], "the axis of the second bus")

both = run("scan", "-b", FILE, "--json")
decoder, text, documents = json.JSONDecoder(), both.stdout.strip(), []
while text:
    document, end = decoder.raw_decode(text)
    documents.append(document)
    text = text[end:].strip()
expect(len(documents) == 2, both)

moved = run("move", "-b", FILE, "cutter", "--by", "0.1")
expect(moved.returncode == 0 and "cutter" in moved.stdout, moved)
for words in (["move", "--by", "0.1"], ["reset"], ["io", "feeder.OUT1=1", "--allow-output", "--for", "1"]):
    refused = run(words[0], "-b", FILE, *words[1:])
    expect(refused.returncode == WRONG_USE and "2 buses: left (sim), right (sim)" in refused.stderr
           and "--network" in refused.stderr, refused)
unknown = run("scan", "-b", FILE, "--network", "up")
expect(unknown.returncode == WRONG_USE and 'no bus "up"' in unknown.stderr, unknown)
nowhere = run("move", "-b", FILE, "nobody", "--by", "0.1")
expect(nowhere.returncode == WRONG_USE and "--network" in nowhere.stderr, nowhere)
example = subprocess.run([os.path.join(BIN, "16_two_networks"), os.path.join(sys.argv[2], "examples", "bridge.yaml")],
                         capture_output=True, text=True, timeout=60)
expect(example.returncode != 0 and "one network" in example.stderr, example)

# A program on two networks tells of each what it counted, at the socket of either.
with tempfile.TemporaryDirectory() as folder:
    environment = {**os.environ, "CM1E_RUNTIME_DIR": folder}
    words = [os.path.join(BIN, "16_two_networks"), FILE]
    with subprocess.Popen(words, env=environment, stdout=subprocess.DEVNULL) as program:
        end = time.monotonic() + 20
        while len(os.listdir(folder)) < 2 and time.monotonic() < end:
            time.sleep(0.02)
        words = [os.path.join(BIN, "cm1e"), "monitor", "--json", "--attach", str(program.pid), "--network", "right"]
        shown = subprocess.run(words, env=environment, capture_output=True, text=True, timeout=60)
        told = json.loads(shown.stdout).get("statistics", {})
        networks = told.get("networks", [])
        expect([(one["network"], one["interface"]) for one in networks] == [("left", "sim"), ("right", "sim")] and
               all(one["cycles"] > 0 and one["sync_losses"] == 0 for one in networks), shown)
        expect(abs(sum(one["lost_frames"] for one in networks) - told["bus"]["lost_frames"]) <= 100, shown)
        program.terminate()

# objects of slaves by the names of the bus file
MACHINE = os.path.join(sys.argv[2], "examples", "machine.yaml")
for name, position in (("feed", "6"), ("pressures", "4")):
    by_name, by_number = (run("sdo", "read", "-b", MACHINE, word, "0x1018:2") for word in (name, position))
    expect(by_name.returncode == 0 and by_name.stdout == by_number.stdout != "", (by_name, by_number))
nobody = run("sdo", "read", "-b", MACHINE, "pressure", "0x1018:2")
expect(nobody.returncode == WRONG_USE and 'neither an axis nor a slave "pressure"; did you mean "pressures"?' in nobody.stderr, nobody)
states = run("states", "-b", MACHINE, "valves")
expect(states.returncode == 0 and "Digital" in states.stdout and len(states.stdout.splitlines()) == 1, states)

# of several networks the slave chooses the one that has it
with tempfile.TemporaryDirectory() as folder:
    file = os.path.join(folder, "buses.yaml")
    terminal = "sim: {device: digital, outputs: 4}"
    with open(file, "w", encoding="ascii") as out:
        for name, axis, slave in (("left", "X", "lamps"), ("right", "Y", "valves")):
            out.write(f"{'' if name == 'right' else 'buses:'}\n  - name: {name}\n    bus: {{interface: sim}}\n    axes: [{{name: {axis}, "
                      f"position: 1}}]\n    slaves: [{{name: {slave}, position: 2, {terminal}}}, {{name: same, position: 3, {terminal}}}]\n")
    right = run("states", "-b", file, "valves")
    expect(right.returncode == 0 and right.stdout.startswith("  2 ") and right.stdout.count("\n") == 1, right)
    both = run("sdo", "read", "-b", file, "same", "0x1018:2")
    expect(both.returncode == WRONG_USE and "Choose one with --network" in both.stderr, both)

# beside a program too, and in a file that has slaves and no axes
with tempfile.TemporaryDirectory() as folder:
    environment = {**os.environ, "CM1E_RUNTIME_DIR": folder}
    slaves = os.path.join(folder, "slaves.yaml")
    with open(MACHINE, encoding="utf-8") as whole, open(slaves, "w", encoding="utf-8") as file:
        text = whole.read()
        file.write("bus: {interface: sim}\n" + text[text.index("slaves:"):])
    words = [os.path.join(BIN, "cm1e"), "io", "-b", MACHINE, "valves.lamp=1", "--allow-output", "--for", "60"]
    with subprocess.Popen(words, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as program:
        end = time.monotonic() + 20
        while len(os.listdir(folder)) < 2 and time.monotonic() < end:
            time.sleep(0.02)
        for words, says in ((["states", "valves"], "Digital terminal 4+0"), (["scan"], "-          valves\n")):
            shown = subprocess.run([os.path.join(BIN, "cm1e"), *words, "-b", slaves, "--attach", str(program.pid)], env=environment,
                                   capture_output=True, text=True, timeout=60)
            expect(says in shown.stdout, shown)
        program.terminate()

# a bus file is checked without its network
good = run("check", FILE)
expect(good.returncode == 0 and "bus file, 3 axes, 0 other slaves, no error" in good.stdout, good)
machine = run("check", MACHINE)
expect(machine.returncode == 0 and "bus file, 1 axis, 5 other slaves, no error" in machine.stdout, machine)
with tempfile.TemporaryDirectory() as folder:
    for name in ("wrong.yaml", "wrong.yml"):
        wrong = os.path.join(folder, name)
        with open(wrong, "w", encoding="ascii") as file:
            file.write("axes:\n  - {name: X, position: 1, velocty: 3}\n")
        told = run("check", wrong)
        expect(told.returncode == FAILED and f"{wrong}:2:28: " in told.stderr and "velocty" in told.stderr, told)
        listed = run("check", "--json", wrong)
        expect(listed.returncode == FAILED and "velocty" in json.loads(listed.stdout)["findings"][0]["text"], listed)

for fault in faults:
    print(fault)
sys.exit(1 if faults else 0)
