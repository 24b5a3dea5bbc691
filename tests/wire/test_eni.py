#!/usr/bin/env python3
"""ENI files run: a master that knows nothing but the file (eni_player.py) takes the simulated slaves to Operational over
a veth pair, sees the working counters and the variables where the file says, and moves an axis through them. Files that
do not fit the network stop it where they should.

test_eni.py CM1E GOLDEN_FOLDER
"""
import contextlib
import os
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import wire  # noqa: E402

PLAYER = os.path.join(HERE, "eni_player.py")
# Slaves of the simulator for each file.
NETWORKS = {
    "eni_one_axis.xml": "axes: [{sim: {no_stops: true}}]\n",
    "eni_three_axes.xml": "axes: [{}, {}, {}]\n",
    "eni_mixed.xml": "axes: [{position: 1}, {position: 3}]\n",
}
START = """
def start(master):
    master.start()
    for _ in range(20):
        master.cycle()
    states = master.al_states()
    if states != (8, len(master.slaves)):
        raise Failed(f"AL states {states}")
"""
MOVE = START + """
import math
COUNTS, SECONDS = 40000, 0.8

def await_state(master, controlword, state):
    master.write(AXIS, "Controlword", controlword)
    for _ in range(500):
        master.cycle()
        if master.read(AXIS, "Statusword") & 0x6F == state:
            return
    raise Failed(f"statusword 0x{master.read(AXIS, 'Statusword'):04X} after controlword 0x{controlword:X}")

def play(master):
    start(master)
    begin = master.read(AXIS, "Position actual value", signed=True)
    master.write(AXIS, "Target position", begin)
    master.write(AXIS, "Modes of operation", 8)
    await_state(master, 0x06, 0x21)
    await_state(master, 0x07, 0x23)
    await_state(master, 0x0F, 0x27)
    steps = int(SECONDS / master.cycle_s)
    for step in range(steps + 1):
        master.write(AXIS, "Target position", begin + round(COUNTS * (1 - math.cos(math.pi * step / steps)) / 2))
        master.cycle()
    for _ in range(200):
        master.cycle()
    end = master.read(AXIS, "Position actual value", signed=True)
    if abs(end - begin - COUNTS) > 50:
        raise Failed(f"moved from {begin} to {end}, not by {COUNTS}")
    if master.read(AXIS, "Modes of operation display") != 8:
        raise Failed("the mode is not shown where the file says")
    master.write(AXIS, "Controlword", 0)
    for _ in range(20):
        master.cycle()
    if master.read(AXIS, "Statusword") & 0x04:
        raise Failed("still enabled")
    master.stop()
    master.cycle()
    if master.lost * 100 > master.cycles:
        raise Failed(f"{master.lost} frames lost")
    print(f"moved {end - begin} counts, {master.cycles} cycles, {master.lost} frames lost")
"""
OUTPUTS = START + """
def play(master):
    start(master)
    for value in (0xA5, 0x5A):
        master.write("Y", "0x7000:01", value)
        for _ in range(3):
            master.cycle()
        if master.read("Y", "0x6000:01") != value:
            raise Failed(f"the inputs show 0x{master.read('Y', '0x6000:01'):02X}")
    print("outputs come back as inputs")
"""


def move(axis):
    return f"AXIS = {axis!r}\n{MOVE}"


def play(segment, path, program):
    return segment.run([sys.executable, PLAYER, path, wire.MASTER_INTERFACE, program])


@contextlib.contextmanager
def segment_of(cm1e, path):
    """The simulated slaves that a file is for."""
    with tempfile.TemporaryDirectory() as folder:
        slaves = os.path.join(folder, "slaves.yaml")
        with open(slaves, "w", encoding="utf-8") as file:
            file.write(NETWORKS[os.path.basename(path)])
        with wire.segment(cm1e, slaves) as segment:
            yield segment


def runs(cm1e, path, *programs):
    with segment_of(cm1e, path) as segment:
        for program in programs:
            result = play(segment, path, program)
            wire.check(result.returncode == 0, f"{os.path.basename(path)}: {result.stdout}{result.stderr}")
            print(f"{os.path.basename(path)}: {result.stdout.strip()}")


def is_refused(cm1e, path, old, new, what):
    """The file with `old` replaced by `new` does not run, and the player says `what`."""
    with segment_of(cm1e, path) as segment:
        broken = os.path.join(segment.folder, "broken.xml")
        with open(path, encoding="utf-8") as file:
            text = file.read()
        wire.check(old in text, f"{path} has no {old}")
        with open(broken, "w", encoding="utf-8") as file:
            file.write(text.replace(old, new))
        result = play(segment, broken, START + "def play(master): start(master)")
        wire.check(result.returncode == 1 and what in result.stdout, f"{old} -> {new}: {result.stdout}{result.stderr}")
        print(f"{old} -> {new}: {result.stdout.strip()}")


if __name__ == "__main__":
    command, golden = sys.argv[1], sys.argv[2]
    one, three, mixed = (os.path.join(golden, name) for name in NETWORKS)
    runs(command, one, move("X"))
    runs(command, three, *(move(axis) for axis in "XYZ"))
    runs(command, mixed, move("Z"), OUTPUTS)
    is_refused(command, one, "<Data>02204144</Data>", "<Data>03204144</Data>", "check product code")
    is_refused(command, one, "<Cnt>3</Cnt>", "<Cnt>2</Cnt>", "working counter 3, not 2")
    is_refused(command, one, "<Data>00110D0064000100</Data>", "<Data>00110E0064000100</Data>", "SAFEOP")
