#!/usr/bin/env python3
"""Commands on a bus file with several buses: what shows things shows all of them, an axis chooses its bus, and the rest
says how to choose.

test_buses.py BUILD-DIRECTORY SOURCE-DIRECTORY
"""
import json
import os
import subprocess
import sys

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

for fault in faults:
    print(fault)
sys.exit(1 if faults else 0)
