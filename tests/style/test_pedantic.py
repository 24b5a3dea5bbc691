#!/usr/bin/env python3
"""Every C file of ours is ISO C as it is compiled, beside what it marks as an extension: -Wpedantic finds nothing. A
file that was built with these words (CM1E_STRICT of the everyday build) is not compiled once more.

test_pedantic.py BUILD-DIRECTORY SOURCE-DIRECTORY
"""
import concurrent.futures
import json
import os
import shlex
import subprocess
import sys

ADDED = ["-Wpedantic", "-Werror=pedantic", "-Werror=overlength-strings"]


def ours(build, source):
    """(file, command) of every C file of the project, once."""
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as file:
        commands = {entry["file"]: entry for entry in json.load(file) if entry["file"].endswith(".c")}
    for path, entry in sorted(commands.items()):
        name = os.path.relpath(path, source)
        if name.startswith(("src/", "fb/", "tools/", "examples/", "tests/", "bench/")):
            words = shlex.split(entry["command"])
            # A compiler cache stands before the compiler. What is written goes nowhere.
            start = 1 if os.path.basename(words[0]) in ("ccache", "sccache") else 0
            out = words.index("-o")
            yield name, words[start:out] + words[out + 2:], entry["directory"]


def was_built_so(command):
    undone = [word for word in command if word.startswith("-Wno-") and word != "-Wno-format-truncation"]
    return not set(ADDED) - set(command) and not undone


def compile_one(item):
    name, command, directory = item
    if was_built_so(command):
        return None
    result = subprocess.run(command + ADDED + ["-fsyntax-only"], cwd=directory, capture_output=True, text=True)
    return f"{name}:\n{result.stderr}" if result.returncode else None


def main(build, source):
    files = list(ours(build, source))
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        faults = [fault for fault in pool.map(compile_one, files) if fault]
    print("\n".join(faults) or f"-Wpedantic finds nothing in {len(files)} files, "
          f"{sum(was_built_so(command) for _, command, _ in files)} of them as they were built")
    return 1 if faults or len(files) < 100 else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:3]))
