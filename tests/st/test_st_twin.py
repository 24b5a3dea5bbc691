#!/usr/bin/env python3
"""The example 03 in Structured Text gives the same trace as its C twin, sample by sample, until the C twin breaks the
motor power of an axis on purpose.

test_st_twin.py BIN-DIRECTORY EXAMPLES-DIRECTORY
"""
import csv
import os
import subprocess
import sys
import tempfile

BIN, EXAMPLES = sys.argv[1], sys.argv[2]
BUS = os.path.join(EXAMPLES, "three_axes.yaml")
OF_THE_MACHINE = ("wake-up", "execution")
SAMPLES = 7000  # the fault of the C twin comes later


def run(*words):
    result = subprocess.run(words, capture_output=True, text=True, timeout=60)
    if result.returncode != 0:
        sys.exit(f"{' '.join(words)}: exit status {result.returncode}\n{result.stdout}{result.stderr}")


def trace(path):
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    return rows[0], rows[1:]


def compare(folder):
    names, st = trace(os.path.join(folder, "st.csv"))
    others, c = trace(os.path.join(folder, "c.csv"))
    pairs = [(i, others.index(name), name) for i, name in enumerate(names)
             if name in others and not name.startswith(OF_THE_MACHINE)]
    pairs.append((names.index("Main.step"), others.index("step"), "step"))
    if len(pairs) < 20 or len(st) < SAMPLES or len(c) < SAMPLES:
        sys.exit(f"there is too little to compare: {len(pairs)} signals, {len(st)} and {len(c)} samples")
    for k in range(SAMPLES):
        for i, j, name in pairs:
            if st[k][i] != c[k][j]:
                sys.exit(f"sample {k}, {name}: {st[k][i]} in ST, {c[k][j]} in C")
    steps = {row[names.index("Main.step")] for row in st[:SAMPLES]}
    if not {"0", "1", "2", "3", "4"} <= steps:
        sys.exit(f"the program came to the steps {sorted(steps)} only")
    print(f"{SAMPLES} samples of {len(pairs)} signals are the same")


with tempfile.TemporaryDirectory() as folder:
    program = os.path.join(folder, "program.so")
    run(os.path.join(BIN, "cm1e"), "st", "build", os.path.join(EXAMPLES, "03_plc_program.st"), "-o", program)
    run(os.path.join(BIN, "cm1e"), "run", program, "-b", BUS, "--virtual-time", "-s", "7.2", "--csv",
        os.path.join(folder, "st.csv"))
    run(os.path.join(BIN, "03_plc_program"), "-b", BUS, "--virtual-time", "--csv", os.path.join(folder, "c.csv"))
    compare(folder)
