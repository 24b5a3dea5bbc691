#!/usr/bin/env python3
"""Writes everything that follows from the ST declarations in fb/interface/*.st: the public headers, the table of blocks
for tests, the reference pages, and what `cm1e explain` says of an ErrorID. The same input gives the same bytes."""
import argparse
import os
import sys

import c_explain
import c_header
import c_table
import pages
import st
import tables

SOURCE = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
FILES = ("types.st", "motion.st", "multi_axis.st", "group.st", "administrative.st", "homing.st", "cm_bridge.st", "standard.st")
COMMAND = "fb/interface/generate.py"


def read(path):
    with open(os.path.join(SOURCE, path), encoding="utf-8") as file:
        return file.read()


def outputs():
    """{path below the source tree: text}"""
    files = [st.Reader(f"fb/interface/{name}", read(f"fb/interface/{name}")).read() for name in FILES]
    classes = tables.Tables(read("fb/interface/classes.md"), read("include/cm1e/error.h"))
    notes = tables.notes(read("fb/interface/notes.md"), {block.name for file in files for block in file.blocks()})
    result = {f"include/cm1e/{file.header}": c_header.header(file) for file in files}
    result["tests/support/block_table.c"] = c_table.source(files, classes)
    result["tools/error_notes.inc"] = c_explain.source(files, classes, read("docs/FUNCTION-BLOCKS.md"))
    has_diagram = lambda name: os.path.exists(os.path.join(SOURCE, "docs/blocks", f"{name}.svg"))
    result.update(pages.all_pages(files, classes, notes, has_diagram))
    return result


def write(folder, texts):
    for path, text in texts.items():
        full = os.path.join(folder, path)
        os.makedirs(os.path.dirname(full), exist_ok=True)
        with open(full + ".new", "w", encoding="utf-8") as file:
            file.write(text)
        os.replace(full + ".new", full)


def check(texts):
    faults = []
    for path, text in texts.items():
        full = os.path.join(SOURCE, path)
        if not os.path.exists(full):
            faults.append(f"{path} is missing")
            continue
        if read(path) != text:
            faults.append(f"{path} is not what {COMMAND} writes")
    return faults


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", default=SOURCE, help="writes below FOLDER (default: into the source tree)")
    parser.add_argument("--check", action="store_true",
                        help="writes nothing; says what is not as it should be, and fails then")
    arguments = parser.parse_args()
    try:
        texts = outputs()
    except st.Fault as fault:
        print(fault, file=sys.stderr)
        return 1
    if not arguments.check:
        write(arguments.folder, texts)
        return 0
    faults = check(texts)
    print("\n".join(faults + [f"run {COMMAND} and commit what it writes"]) if faults
          else f"{len(texts)} generated files are as the declarations say")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
