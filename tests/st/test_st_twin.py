#!/usr/bin/env python3
"""The examples in Structured Text give the same traces as their C twins, sample by sample: 03 until the C twin breaks the
motor power of an axis on purpose, the gear, the winder (a cam) and the XY table to their ends.

test_st_twin.py BIN-DIRECTORY EXAMPLES-DIRECTORY
"""
import csv
import os
import subprocess
import sys
import tempfile

BIN, EXAMPLES = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])
OF_THE_MACHINE = ("wake-up", "execution")
# Example, bus file, options of the C twin; samples (0: to the end of the C twin), signals that there are at least, and
# the last step that is to be reached.
TWINS = (("03_plc_program", "three_axes.yaml", ("-b", "three_axes.yaml"), 7000, 20, 4),
         ("10_electronic_gear", "gear.yaml", (), 0, 20, 7), ("12_winder", "winder.yaml", (), 0, 20, 5),
         ("13_xy_table", "xy_table.yaml", (), 0, 15, 5))


def run(*words):
    result = subprocess.run(words, capture_output=True, text=True, timeout=60, cwd=EXAMPLES)
    if result.returncode != 0:
        sys.exit(f"{' '.join(words)}: exit status {result.returncode}\n{result.stdout}{result.stderr}")


def trace(path):
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    return rows[0], rows[1:]


def compare(folder, example, samples, signals, last_step):
    names, st = trace(os.path.join(folder, "st.csv"))
    others, c = trace(os.path.join(folder, "c.csv"))
    pairs = [(i, others.index(name), name) for i, name in enumerate(names)
             if name in others and not name.startswith(OF_THE_MACHINE)]
    step = names.index("Main.step")
    if "step" in others:
        pairs.append((step, others.index("step"), "step"))
    samples = samples or len(c)
    if len(pairs) < signals or samples < 2000 or len(st) < samples or len(c) < samples:
        sys.exit(f"{example}: there is too little to compare: {len(pairs)} signals, {len(st)} and {len(c)} samples")
    for i, j, name in pairs:
        for k in range(samples):
            if st[k][i] != c[k][j]:
                sys.exit(f"{example}, sample {k}, {name}: {st[k][i]} in ST, {c[k][j]} in C")
    steps = {int(row[step]) for row in st[:samples]}
    if not set(range(last_step + 1)) <= steps:
        sys.exit(f"{example}: the program came to the steps {sorted(steps)} only")
    print(f"{example}: {samples} samples of {len(pairs)} signals are the same")


with tempfile.TemporaryDirectory() as folder:
    program, ours = os.path.join(folder, "program.so"), os.path.join(folder, "c.csv")
    for example, bus, options, samples, signals, last_step in TWINS:
        run(os.path.join(BIN, "cm1e"), "st", "build", example + ".st", "-o", program)
        run(os.path.join(BIN, example), *options, "--virtual-time", "--csv", ours)
        with open(ours, encoding="utf-8") as file:
            seconds = (samples or sum(1 for _ in file)) / 1000 + 0.2
        run(os.path.join(BIN, "cm1e"), "run", program, "-b", bus, "--virtual-time", "-s", str(seconds), "--csv",
            os.path.join(folder, "st.csv"))
        compare(folder, example, samples, signals, last_step)
