#!/usr/bin/env python3
"""Our master over a veth pair against `cm1e sim`: homes and moves an axis at 1 ms and at 250 us, and axes behind a
bridge beside a CM1-E.

test_own_master.py CM1E
"""
import json
import os
import sys
import tempfile

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


def move_behind_a_bridge(cm1e):
    """A motor of each kind behind an EB12, and the CM1-E before it: each moves, the others are not disturbed."""
    with tempfile.TemporaryDirectory() as folder:
        bus_file = os.path.join(folder, "mixed.yaml")
        with open(bus_file, "w", encoding="utf-8") as file:
            file.write(wire.BUS.format(interface=wire.MASTER_INTERFACE, cycle_time_us=1000,
                                       lost_cycles_limit=wire.PAUSE_US // 1000))
            file.write("  - {name: left, position: 2, channel: 2, motor: CM1, k37: 10,\n"
                       "     homing: {method: 2, velocity: 5}}\n")
            file.write("  - {name: right, position: 2, channel: 3, motor: CM2, k37: 10}\n")
        with wire.segment(cm1e, bus_file) as segment:
            home = run(segment, cm1e, bus_file, "home", "left")
            wire.check(home["done"] and abs(home["to"]) < 0.01, f"homing: {home}")
            for axis, way in (("left", 2), ("right", -1), ("X", 1)):
                move = run(segment, cm1e, bus_file, "move", axis, "--by", str(way), "--velocity", "5")
                wire.check(move["done"] and abs(move["to"] - move["from"] - way) < 0.01, f"move of {axis}: {move}")
    print("a bridge beside a CM1-E: homed by a stopper, moved three axes")


if __name__ == "__main__":
    command = sys.argv[1]
    wire.together(lambda: move_behind_a_bridge(command), lambda: home_and_move(command, 1000),
                  lambda: home_and_move(command, 250))
