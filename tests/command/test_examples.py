#!/usr/bin/env python3
"""The examples from 04 on, on the simulated segment and virtual time: what their traces show is what they are about.
The traces stay in the output folder, as plots, for a person to look at.

test_examples.py BIN-DIRECTORY OUTPUT-DIRECTORY
"""
import csv
import os
import re
import subprocess
import sys
import xml.etree.ElementTree

BIN, OUTPUT = sys.argv[1], sys.argv[2]
COLUMNS = ("time", "state", "set_position", "actual_position", "set_velocity", "actual_velocity", "torque")
faults = []


def expect(condition, what):
    if not condition:
        faults.append(what)


def run(program, stdin=""):
    """What it printed, its trace as a list of dictionaries, and the words of its plot."""
    svg, table = (os.path.join(OUTPUT, f"{program}.{kind}") for kind in ("svg", "csv"))
    done = subprocess.run([os.path.join(BIN, program), "-i", "sim", "--virtual-time", "--svg", svg, "--csv", table],
                          capture_output=True, text=True, timeout=60, input=stdin)
    if done.returncode != 0:
        sys.exit(f"{program}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    with open(table, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))[1:]
    trace = [{name: cell if name == "state" else float(cell) for name, cell in zip(COLUMNS, row)} for row in rows]
    words = [element.text for element in xml.etree.ElementTree.parse(svg).iter("{http://www.w3.org/2000/svg}text")]
    return done.stdout, trace, words


def crossings(trace, position):
    """The samples in which the set position gets to or past a position."""
    return [now for before, now in zip(trace, trace[1:])
            if (before["set_position"] < position) != (now["set_position"] < position)]


def check_follows(name, trace):
    """No step of the set velocity is beyond the acceleration, and the motor is where it should be."""
    for before, now in zip(trace, trace[1:]):
        change = abs(now["set_velocity"] - before["set_velocity"])
        expect(change <= 80 * 0.001 * (1 + 1e-6), f"{name}: the set velocity steps by {change} at {now['time']} s")
    worst = max(abs(sample["set_position"] - sample["actual_position"]) for sample in trace)
    expect(worst < 0.1, f"{name}: the motor is {worst} u away from its set position")


# 2.4.2: the velocity at the end of the first of two moves, 8 u/s and then 4 u/s; 4 u/s and then 8 u/s on the way back.
JUNCTIONS = (("mcAborting", 4, 8), ("mcBuffered", 0, 0), ("mcBlendingLow", 4, 4), ("mcBlendingPrevious", 8, 4),
             ("mcBlendingNext", 4, 8), ("mcBlendingHigh", 8, 8))


def check_buffer_modes():
    printed, trace, words = run("04_buffer_modes")
    check_follows("04_buffer_modes", trace)
    passed = crossings(trace, 2)
    expect(len(passed) == 2 * len(JUNCTIONS), f"04_buffer_modes: {len(passed)} ways past the end of the first moves")
    for (mode, there, back), on_way_there, on_way_back in zip(JUNCTIONS, passed[::2], passed[1::2]):
        for expected, sample in ((there, on_way_there["set_velocity"]), (-back, on_way_back["set_velocity"])):
            # One cycle past the junction the next command has begun to change the velocity.
            expect(abs(sample - expected) <= 80 * 0.001, f"{mode}: passes with {sample} u/s instead of {expected}")
        table = re.search(rf"^{mode} +([\d.]+) +([\d.]+)$", printed, re.MULTILINE)
        expect(table and abs(float(table[1]) - there) < 0.1 and abs(float(table[2]) - back) < 0.1,
               f"{mode}: the table says {table and table.groups()}")
    fastest = max(abs(sample["set_velocity"]) for sample in trace)
    expect(abs(fastest - 8) < 1e-6, f"04_buffer_modes: {fastest} u/s are reached")
    expect([word for word in words if word.startswith("mc")] == [mode for mode, _, _ in JUNCTIONS],
           f"04_buffer_modes: the plot's marks are not the modes: {words}")


def main():
    check_buffer_modes()
    print("\n".join(faults) or "the examples: their traces show what they are about")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
