#!/usr/bin/env python3
"""A program that links function blocks and scheduler for network interfaces holds no simulator, no reader of bus files
and no generator, and needs neither libcyaml nor libyaml nor libxml2. Asked for "sim", it says what to link. A program
that links cm1e::sim beside them has all it needs for "sim": it is the comparison that shows that this test can see.

test_wire_only.py WIRE-ONLY-PROGRAM ITS-LINK-MAP PROGRAM-WITH-SIMULATOR ITS-LINK-MAP
"""
import re
import subprocess
import sys

FOREIGN = re.compile(r"lib(cyaml|yaml|xml2|jansson|cm1e_\w+)\b")
GUESTS = re.compile(r"^(cm1e_(sim|busfile|esi|eni|ec_extend|generate)_|cyaml_|yaml_|xml[A-Z])")
ARCHIVES = re.compile(r"libcm1e_(sim|busfile|generate)\.(a|so)")


def run(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def guests(program, link_map):
    """What of the simulator, the readers and the generators is in a program: libraries, symbols, members of archives."""
    libraries = {match[0] for match in FOREIGN.finditer(run("ldd", program))}
    symbols = {line.split()[-1] for line in run("nm", program).splitlines() if GUESTS.match(line.split()[-1])}
    with open(link_map, encoding="utf-8", errors="replace") as file:
        members = {match[0] for match in ARCHIVES.finditer(file.read())}
    return libraries, symbols, members


def main(wire_only, wire_only_map, simulated, simulated_map):
    faults = []
    for what, found in zip(("needs", "holds", "takes members of"), guests(wire_only, wire_only_map)):
        if found:
            faults.append(f"{wire_only} {what} {', '.join(sorted(found)[:10])}")
    for what, found in zip(("library", "symbol", "archive"), guests(simulated, simulated_map)):
        if not found:
            faults.append(f"{simulated} has no {what} of the simulator: this test would not see one either")
    result = subprocess.run([wire_only, "sim"], capture_output=True, text=True)
    if result.returncode != 1 or "Link the library cm1e::sim or call cm1e_sim_register()" not in result.stderr:
        faults.append(f"{wire_only} sim: exit status {result.returncode}, {result.stderr}")
    result = subprocess.run([simulated, "sim"], capture_output=True, text=True)
    if result.returncode != 0:
        faults.append(f"{simulated} sim: exit status {result.returncode}, {result.stderr}")
    print("\n".join(faults) or "a program for network interfaces links nothing of simulator, bus files and generators")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:5]))
