#!/usr/bin/env python3
"""Every pair of commands, started at the same moment on one interface: each does its whole work, attached to the other or
alone, or is refused and told who has the interface. None fails in any other way, and the drive is left as it was.

test_pairs.py CM1E
CM1E_TEST_EFFORT=full: a larger sample of the pairs. CM1E_TEST_TRIES=100: so many tries of all. CM1E_TEST_SEED: of the
sample.
"""
import itertools
import os
import random
import re
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

SAMPLE, LARGE_SAMPLE = 10, 80
SLAVES = "axes: [{sim: {no_stops: true}}]\n"  # many moves in one direction
IF, BUS_FILE = wire.MASTER_INTERFACE, "BUS-FILE"
# (words, what its output has when its work is done)
COMMANDS = [
    (["scan", "-i", IF], "CM1-E"),
    (["status", "-i", IF], "firmware 1.3.5"),
    (["sdo", "read", "-i", IF, "1", "0x1008"], "CM1-E"),
    (["sdo", "list", "-i", IF, "1"], "0x6041"),
    (["sii", "decode", "-i", IF, "1"], "0x00004441"),
    (["params", "get", "-i", IF, "1", "K37"], "K37"),
    (["reset", "-i", IF], "has no error"),
    (["led", "-i", IF, "1", "--for", "0.1"], "its LED shows"),
    (["enable", "-b", BUS_FILE, "X", "--for", "0.1"], "was enabled"),
    (["move", "-b", BUS_FILE, "X", "--by", "0.1", "--velocity", "5"], "move done"),
    (["io", "-i", IF, "--all"], "Statusword"),
    (["log", "-i", IF], ""),
    (["states", "-i", IF], "CM1-E"),
    (["reg", "-i", IF, "read", "1", "0x0130"], "AL status"),
    (["graph", "-i", IF], "digraph"),
    (["alias", "-i", IF, "1"], "alias 0"),
    (["trace", "-i", IF, "--for", "0.1", "--csv", "/dev/null"], "recorded"),
    (["doctor", "-i", IF, "--seconds", "0"], "problem"),
    (["init", "-i", IF], "axes:"),
]
REFUSED = re.compile(r"in use by cm1e \w+ \(process \d+\) since|needs the network for itself|"
                     r"No program has the network interface|"
                     # asked the program that has it, which lets others only look, or ends
                     r"lets others look only|does not run any more|has ended, or closed the connection")


def finish(process):
    try:
        out, err = process.communicate(timeout=60)
    except subprocess.TimeoutExpired:
        process.kill()
        wire.check(False, f"{process.args}: it does not end: {process.communicate()}")
    return out + err


def run_pair(segment, cm1e, bus_file, pair):
    """How many of the two were refused."""
    commands = [[cm1e, *(bus_file if word == BUS_FILE else word for word in words)] for words, _ in pair]
    running = [subprocess.Popen(segment.command(command), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
               for command in commands]
    refused = 0
    for process, (words, done) in zip(running, pair):
        told = finish(process)
        if process.returncode == 0:
            wire.check(done in told, f"{words} beside {pair}: it has not done its work: {told}")
            continue
        wire.check(process.returncode == 1 and REFUSED.search(told),
                   f"{words} beside {[other for other, _ in pair]}: exit status {process.returncode}: {told}")
        refused += 1
    return refused


def run_pairs(cm1e, slaves, pairs, tries):
    refused = 0
    with wire.segment(cm1e, slaves) as segment:
        bus_file = segment.bus_file()
        for _ in range(tries):
            for pair in pairs:
                both = run_pair(segment, cm1e, bus_file, pair)
                needs_owner = sum(words[0] == "log" for words, _ in pair)
                wire.check(both - needs_owner < 2, f"both of {pair} were refused")
                refused += both
    return refused


def main():
    cm1e = os.path.abspath(sys.argv[1])
    pairs = list(itertools.combinations_with_replacement(COMMANDS, 2))
    seed = int(os.environ.get("CM1E_TEST_SEED", time.time()))
    tries = int(os.environ.get("CM1E_TEST_TRIES", "0"))
    if not tries:
        print(f"a sample, CM1E_TEST_SEED={seed}")
        count = LARGE_SAMPLE if os.environ.get("CM1E_TEST_EFFORT") == "full" else SAMPLE
        pairs, tries = random.Random(seed).sample(pairs, count), 1
    with tempfile.TemporaryDirectory() as folder, open(os.path.join(folder, "sim.yaml"), "w", encoding="utf-8") as file:
        file.write(SLAVES)
        file.flush()
        refused = run_pairs(cm1e, file.name, pairs, tries)
    print(f"{len(pairs)} pairs, {tries} tries of each: {refused} of {2 * tries * len(pairs)} commands were refused")


main()
