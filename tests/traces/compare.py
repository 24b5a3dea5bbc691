#!/usr/bin/env python3
"""The timing diagrams in docs/blocks/ are what the blocks do: draws them anew and compares. Words and order must be the
same; numbers may differ by less than a pixel, because another compiler may round another way.

compare.py BLOCK-TRACES SOURCE-DIRECTORY
"""
import glob
import os
import re
import subprocess
import sys
import tempfile

NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
WORDS = re.compile(r">([^<]*)<")
TOLERANCE = 0.75


def pages(folder):
    return {os.path.basename(path)[:-3] for path in glob.glob(os.path.join(folder, "*.md"))} - {"README", "TYPES"}


def diagrams(folder):
    result = {}
    for path in glob.glob(os.path.join(folder, "*.svg")):
        with open(path, encoding="utf-8") as file:
            result[os.path.basename(path)[:-4]] = file.read()
    return result


def difference(old, new):
    """Why two diagrams are not the same; None if they are."""
    if WORDS.findall(old) != WORDS.findall(new):
        return "other words or numbers in it"
    if NUMBER.sub("#", old) != NUMBER.sub("#", new):
        return "another course"
    for one, other in zip(NUMBER.findall(old), NUMBER.findall(new)):
        if abs(float(one) - float(other)) > TOLERANCE:
            return f"pixel {other} instead of {one}"
    return None


def main(program, source):
    folder = os.path.join(source, "docs/blocks")
    with tempfile.TemporaryDirectory() as fresh:
        subprocess.run([program, fresh], check=True)
        drawn, kept = diagrams(fresh), diagrams(folder)
    faults = [f"{name} has no diagram" for name in sorted(pages(folder) - set(drawn))]
    faults += [f"docs/blocks/{name}.svg belongs to no block" for name in sorted(set(kept) - set(drawn))]
    for name, text in sorted(drawn.items()):
        why = difference(kept[name], text) if name in kept else "it is missing"
        if why:
            faults.append(f"docs/blocks/{name}.svg is not what a run draws: {why}")
    if faults:
        print("\n".join(faults))
        print("Look at what has changed. To draw them anew: <build>/bin/block_traces docs/blocks")
        return 1
    print(f"{len(drawn)} timing diagrams are what a run draws")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:3]))
