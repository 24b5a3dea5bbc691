#!/usr/bin/env python3
"""`cm1e params restore` that breaks off half-way: the report says exactly what the motor has afterwards. A motor that
lacks an object of the guide.

test_wire_params.py CM1E
"""
import json
import os
import sys
import tempfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

WANTED = {"Home offset": 300, "K47": 55, "K48": 7, "K60": 8, "H3": -9}


def values(segment, cm1e):
    result = segment.run([cm1e, "params", "get", "-b", segment.bus_file(), "1", *WANTED, "--json"])
    return {row["name"]: row["value"] for row in json.loads(result.stdout)}


def check_half_way(segment, cm1e, path):
    """The third of five writes fails."""
    before = values(segment, cm1e)
    segment.console("refuse 1 60F6:1C")
    broken = segment.run([cm1e, "params", "restore", "-b", segment.bus_file(), "1", path, "--yes", "--json"])
    told = json.loads(broken.stdout)
    wire.check(broken.returncode == 1 and "0x06060000" in broken.stderr and "hardware" in broken.stderr, str(broken))
    wire.check(told == {"done": False, "written": ["Home offset", "K47"], "failed": "K48", "not_written": ["K60", "H3"]},
               str(broken))
    for line in ("written and read back: Home offset, K47\n", "value is to be looked at: K48\n", "not written: K60, H3\n"):
        wire.check(line in broken.stderr, f"{line!r} is not in {broken.stderr}")
    now = values(segment, cm1e)
    wire.check(now == {**before, "Home offset": 300, "K47": 55}, f"what the motor has: {now}")
    segment.console("refuse 1 nothing")
    rest = segment.run([cm1e, "params", "restore", "-b", segment.bus_file(), "1", path, "--yes", "--json"])
    wire.check(rest.returncode == 0 and json.loads(rest.stdout)["written"] == ["K48", "K60", "H3"], f"the rest: {rest}")
    wire.check(values(segment, cm1e) == WANTED, "the values after all")


def check_missing(segment, cm1e, folder):
    """The guide's text lists H8, the drive of its screenshot has none."""
    path = os.path.join(folder, "without.yaml")
    segment.console("refuse 1 60FB:09 missing")
    backup = segment.run([cm1e, "params", "backup", "-b", segment.bus_file(), "1", path])
    with open(path, encoding="utf-8") as file:
        text = file.read()
    wire.check(backup.returncode == 0 and "has no H8" in backup.stderr and "  H7: " in text and "H8" not in text,
               f"a motor without H8: {backup}")
    with open(path, "a", encoding="utf-8") as file:
        file.write("  H8: 5\n")
    restored = segment.run([cm1e, "params", "restore", "-b", segment.bus_file(), "1", path, "--yes"])
    wire.check(restored.returncode == 1 and "has no H8" in restored.stderr and "nothing to change" in restored.stdout,
               f"H8 restored to a motor without it: {restored}")
    segment.console("refuse 1 nothing")


def check_gone(segment, cm1e, path):
    """The motor is unplugged: nothing can be read, nothing is said to be written."""
    segment.console("unplug 1")
    gone = segment.run([cm1e, "params", "restore", "-b", segment.bus_file(), "1", path, "--yes"])
    wire.check(gone.returncode == 1 and "written" not in gone.stdout, f"an unplugged motor: {gone}")
    segment.console("replug 1")


def main(cm1e):
    with wire.segment(cm1e) as segment, tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "wanted.yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write('device: {kind: cm1-e, firmware: "1.3.5"}\nparameters:\n'
                       + "".join(f"  {name}: {value}\n" for name, value in WANTED.items()))
        check_half_way(segment, cm1e, path)
        check_missing(segment, cm1e, folder)
        check_gone(segment, cm1e, path)
    print("a restore that breaks off says what was written")


if __name__ == "__main__":
    main(sys.argv[1])
