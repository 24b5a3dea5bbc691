#!/usr/bin/env python3
"""ENI files run: a master that knows nothing but the file (eni_player.py) takes the simulated slaves to Operational
over a veth pair, sees the working counters and the variables where the file says, and moves an axis through them. Files
that do not fit the network stop it where they should.

Golden files, files of `cm1e generate eni` from a bus file, and from a scan on the wire.

test_eni.py CM1E GOLDEN_FOLDER
"""
import contextlib
import os
import sys
import tempfile
from xml.etree import ElementTree

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, HERE)
import wire  # noqa: E402

# How long a slave may take to change its state; where it never does, the tenth will do.
LONG_TIMEOUT, SHORT_TIMEOUT = "<Timeout>10000</Timeout>", "<Timeout>1000</Timeout>"
TWO_FRAMES = 75   # axes: one frame carries 70
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
    if master.names("out", AXIS, "Modes of operation"):   # else the start-up SDO has set it
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
    if master.names("in", AXIS, "Modes of operation display") and master.read(AXIS, "Modes of operation display") != 8:
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
def segment_of(cm1e, text, *arguments):
    """The simulated slaves of a bus file with this text, and its path."""
    with tempfile.TemporaryDirectory() as folder:
        slaves = os.path.join(folder, "slaves.yaml")
        with open(slaves, "w", encoding="utf-8") as file:
            file.write(text)
        with wire.segment(cm1e, slaves, *arguments) as segment:
            segment.slaves = slaves
            yield segment


def generate(segment, cm1e, *arguments):
    """What `cm1e generate eni` writes."""
    path = os.path.join(segment.folder, "generated.xml")
    result = segment.run([cm1e, "generate", "eni", *arguments, "-o", path])
    wire.check(result.returncode == 0, f"generate eni {arguments}: {result.stdout}{result.stderr}")
    return path


def succeeds(segment, path, program, what):
    result = play(segment, path, program)
    wire.check(result.returncode == 0, f"{what}: {result.stdout}{result.stderr}")
    print(f"{what}: {result.stdout.strip()}")


def from_a_bus_file(cm1e, mapping, cycle_time_us):
    text = f"bus: {{cycle_time_us: {cycle_time_us}}}\naxes: [{{name: X, mapping: {mapping}}}]\n"
    with segment_of(cm1e, text) as segment:
        path = generate(segment, cm1e, "-b", segment.slaves)
        succeeds(segment, path, move("X"), f"bus file, {mapping}, {cycle_time_us} us")


def two_frames(cm1e):
    """More slaves than a frame can carry."""
    axes = ", ".join(f"{{name: A{n}}}" for n in range(1, TWO_FRAMES + 1))
    with segment_of(cm1e, f"axes: [{axes}]\n") as segment:
        path = generate(segment, cm1e, "-b", segment.slaves)
        succeeds(segment, path, START + "def play(master): start(master); print(len(master.frames), 'frames')",
                 f"bus file, {TWO_FRAMES} axes")


def from_a_scan(cm1e):
    """Objects in the other order of the guide, and an I/O module between the motors."""
    with segment_of(cm1e, NETWORKS["eni_mixed.xml"], "--pdo-order", "ug-7.2") as segment:
        path = generate(segment, cm1e, "-i", wire.MASTER_INTERFACE)
        succeeds(segment, path, move("CM1-E 3"), "scan, objects in the order of UG 7.2")


def beside_device_emulation(cm1e):
    """Simple terminals, whose AL status shows the acknowledge bit of AL control, before and between the motors."""
    text = "bus: {sim_gaps: terminal}\naxes: [{position: 2}, {position: 4}]\n"
    with segment_of(cm1e, text) as segment:
        path = generate(segment, cm1e, "-i", wire.MASTER_INTERFACE)
        succeeds(segment, path, move("CM1-E 4"), "scan, beside device emulation")


def without_lrw(cm1e):
    """The controller of the middle one of three motors cannot do LRW, so its ESI says: it has an LWR and an LRD."""
    with segment_of(cm1e, "axes: [{}, {}, {}]\n") as segment:
        esi = os.path.join(segment.folder, "no_lrw.xml")
        result = segment.run([cm1e, "generate", "esi", "-o", esi])
        wire.check(result.returncode == 0, f"generate esi: {result.stdout}{result.stderr}")
        with open(esi, encoding="utf-8") as file:
            text = file.read()
        with open(esi, "w", encoding="utf-8") as file:
            file.write(text.replace(" RevisionNo=", " UseLrdLwr=\"1\" RevisionNo="))
        network = os.path.join(segment.folder, "network.yaml")
        with open(network, "w", encoding="utf-8") as file:
            file.write("bus: {interface: " + wire.MASTER_INTERFACE + "}\n"
                       "axes: [{name: X, position: 1}, {name: Z, position: 3}]\n"
                       "slaves: [{name: Y, position: 2, esi: no_lrw.xml}]\n")
        path = generate(segment, cm1e, "-b", network)
        for axis in "YZ":
            succeeds(segment, path, move(axis), "bus file, a motor without LRW between two")


def start_up_of_the_bus(cm1e):
    """What this library writes into a modular device, for a clock, and into a drive without a mode in its process data."""
    text = ("bus: {distributed_clocks: true}\n"
            "axes:\n  - {name: s, position: 1, device: cia402, drive: {counts_per_revolution: 131072, max_speed_rpm: 3000, "
            "outputs_pdo: 0x1601, inputs_pdo: 0x1A01}}\n"
            "slaves:\n  - {name: island, position: 2, modules: [0x00000205, 0x00000105], sim: {device: modular}}\n"
            "  - {name: level, position: 3, sim: {device: analog, inputs: 2}, dc: {sync0_us: 1000}}\n"
            "  - {name: flow, position: 4, sim: {device: analog, inputs: 1}, dc: {sync0_us: 1000, sync1_us: 250}}\n")
    with segment_of(cm1e, text) as segment:
        path = generate(segment, cm1e, "-b", segment.slaves, "-i", wire.MASTER_INTERFACE)
        written = {slave.findtext("Info/Name"): [
            (int(command.findtext("Index")), int(command.findtext("SubIndex")), command.findtext("Data"))
            for command in slave.findall("Mailbox/CoE/InitCmds/InitCmd")] for slave in ElementTree.parse(path).iter("Slave")}
        expected = {"s": [(0x6060, 0, "08")], "island": [(0xF030, 0, "00"), (0xF030, 1, "05020000"), (0xF030, 2, "05010000"),
                                                        (0xF030, 0, "02")],
                    "level": [(0x1C32, 1, "0200"), (0x1C33, 1, "0200")], "flow": [(0x1C32, 1, "0300"), (0x1C33, 1, "0300")]}
        for name, commands in expected.items():
            wire.check([one for one in written[name] if one in commands] == commands, f"{name}: {written[name]}")
        succeeds(segment, path, START + "def play(master): start(master); print('4 slaves')", "scan, start-up of the bus file")


def runs(cm1e, path, *programs):
    with segment_of(cm1e, NETWORKS[os.path.basename(path)]) as segment:
        for program in programs:
            succeeds(segment, path, program, os.path.basename(path))


def is_refused(cm1e, path, old, new, what):
    """The file with `old` replaced by `new` does not run, and the player says `what`."""
    with segment_of(cm1e, NETWORKS[os.path.basename(path)]) as segment:
        broken = os.path.join(segment.folder, "broken.xml")
        with open(path, encoding="utf-8") as file:
            text = file.read()
        wire.check(old in text, f"{path} has no {old}")
        with open(broken, "w", encoding="utf-8") as file:
            file.write(text.replace(old, new).replace(LONG_TIMEOUT, SHORT_TIMEOUT))
        result = play(segment, broken, START + "def play(master): start(master)")
        wire.check(result.returncode == 1 and what in result.stdout, f"{old} -> {new}: {result.stdout}{result.stderr}")
        print(f"{old} -> {new}: {result.stdout.strip()}")


if __name__ == "__main__":
    command, golden = sys.argv[1], sys.argv[2]
    one, three, mixed = (os.path.join(golden, name) for name in NETWORKS)
    wire.together(
        lambda: two_frames(command),
        lambda: runs(command, three, *(move(axis) for axis in "XYZ")),
        lambda: runs(command, one, move("X")),
        lambda: runs(command, mixed, move("Z"), OUTPUTS),
        # Every mapping that has a target position, and a shorter cycle.
        lambda: from_a_bus_file(command, "csp", 1000),
        lambda: from_a_bus_file(command, "dynamic", 500),
        lambda: from_a_scan(command),
        lambda: beside_device_emulation(command),
        lambda: without_lrw(command),
        lambda: start_up_of_the_bus(command),
        lambda: is_refused(command, one, "<Data>02204144</Data>", "<Data>03204144</Data>", "check product code"),
        lambda: is_refused(command, one, "<Cnt>3</Cnt>", "<Cnt>2</Cnt>", "working counter 3, not 2"),
        lambda: is_refused(command, one, "<Data>00110D0064000100</Data>", "<Data>00110E0064000100</Data>", "SAFEOP"))
