#!/usr/bin/env python3
"""Our master over a veth pair against `cm1e sim`: homes and moves an axis at 1 ms and at 250 us.

test_own_master.py CM1E
"""
import json
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402


def run(segment, cm1e, bus_file, *words):
    result = segment.run([cm1e, words[0], "--json", "-b", bus_file, *words[1:]])
    wire.check(result.returncode == 0, f"cm1e {' '.join(words)}: {result.stdout}{result.stderr}")
    return json.loads(result.stdout)


def home_and_move(cm1e, cycle_time_us):
    with wire.segment(cm1e) as segment:
        bus_file = segment.bus_file(cycle_time_us)
        home = run(segment, cm1e, bus_file, "home", "X")
        wire.check(home["done"] and abs(home["to"]) < 0.01, f"homing: {home}")
        move = run(segment, cm1e, bus_file, "move", "X", "--by", "2", "--velocity", "5")
        wire.check(move["done"] and abs(move["to"] - move["from"] - 2) < 0.01, f"move: {move}")
        bad = segment.run([cm1e, "move", "-b", bus_file, "X", "--by", "2", "--velocity", "5000"])
        wire.check(bad.returncode == 1 and "velocity" in bad.stderr, f"too fast a move: {bad}")
    print(f"{cycle_time_us} us: homed on the hard stop, moved 2 revolutions")


if __name__ == "__main__":
    for cycle in (1000, 250):
        home_and_move(sys.argv[1], cycle)
