#!/usr/bin/env python3
"""A whole machine over a veth pair: a coupler with eight digital terminals of 1 to 8 bits, an analog device each way
with CoE, of which the inputs run by SYNC0, two CM1-Es, a servo drive of another maker and a bridge. Our master, pysoem,
and a master that knows nothing but the ENI of our scan exchange the same bits with it. The PLC program of the examples
moves its motors, over the wire and on virtual time.

test_whole_machine.py CM1E PYTHON: starts the segment and runs itself with --master in the master's namespace.
"""
import json
import os
import struct
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

CHANNELS = [8, 4, 1, 7]  # of the terminals with outputs; behind each stands one with as many inputs, wired to it
DIGITAL, ANALOG_OUT, ANALOG_IN, MOTOR, SECOND, DRIVE, BRIDGE = 2, 10, 11, 12, 13, 14, 15
EACH_WAY = len(CHANNELS) + 4  # slaves with outputs, and with inputs
PATTERNS = [0b10110101, 0b01001010, 0b11111111, 0b00000000]


def bus_file(folder, cycle_time_us, bridge, virtual=False):
    limits = "limits: {velocity: 100, acceleration: 800, deceleration: 800, jerk: 16000, position_lag: 5}"
    homing = "velocity: 20, acceleration: 400, timeout_s: 20}"
    lines = ["bus:", f"  interface: {'sim' if virtual else wire.MASTER_INTERFACE}", f"  cycle_time_us: {cycle_time_us}",
             f"  lost_cycles_limit: {wire.PAUSE_US // cycle_time_us}", *["  virtual_time: true"] * virtual, "axes:",
             f"  - {{name: motor, position: {MOTOR}, unit: {{counts_per_unit: 5000}}, {limits},",
             f"     homing: {{method: -3, offset: -5, torque: 30, {homing}}}",
             f"  - {{name: second, position: {SECOND}, unit: {{counts_per_unit: 5000}}, {limits},",
             f"     homing: {{method: -6, offset: 5, torque: 30, {homing}}}",
             f"  - {{name: drive, position: {DRIVE}, device: cia402, {limits}, unit: {{counts_per_unit: 13107.2}},",
             "     drive: {counts_per_revolution: 131072, max_speed_rpm: 3000},",
             f"     homing: {{method: 22, offset: 5, {homing}}}"]
    if bridge:
        lines.append(f"  - {{name: left, position: {BRIDGE}, channel: 2, motor: CM1, k37: 10}}")
    lines += ["slaves:", "  - {name: coupler, position: 1, sim: {device: coupler}}"]
    for n, count in enumerate(CHANNELS):
        lines.append(f"  - {{name: out{n}, position: {DIGITAL + 2 * n}, sim: {{device: digital, outputs: {count}}}}}")
        lines.append(f"  - {{name: in{n}, position: {DIGITAL + 2 * n + 1}, "
                     f"sim: {{device: digital, inputs: {count}, wired_to: out{n}}}}}")
    lines += [f"  - {{name: set, position: {ANALOG_OUT}, sim: {{device: analog, outputs: 2}}}}",
              f"  - {{name: level, position: {ANALOG_IN}, sim: {{device: analog, inputs: 2, wired_to: set}},",
              f"     dc: {{sync0_us: {cycle_time_us}}}}}"]
    path = os.path.join(folder, f"machine_{cycle_time_us}_{virtual}.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")
    return path


# ---- the PLC program of the examples ---------------------------------------------------------------------------------

def run_example(cm1e, path, run):
    """The program as it is: homing, moves of three axes together, constant speed, off. Returns what it printed."""
    done = run([os.path.join(os.path.dirname(cm1e), "03_plc_program"), "-b", path, "--seconds", "1"])
    wire.check(done.returncode == 0, f"03_plc_program -b {path}: {done.stdout}{done.stderr}")
    for axis in ("motor", "second", "drive"):
        wire.check(axis in done.stdout, f"03_plc_program does not tell of {axis}: {done.stdout}")
    return done.stdout


def run_here(command):
    return subprocess.run(command, capture_output=True, text=True, timeout=60)


# ---- our master ------------------------------------------------------------------------------------------------------

def check_our_master(segment, cm1e, path, cycle_time_us):
    """The PLC program moves the motors beside it, and every output comes back at its input, and nowhere else."""
    run_example(cm1e, path, segment.run)
    for pattern in PATTERNS[:2]:
        writes = [f"out{n}.output {channel + 1}={pattern >> channel & 1}"
                  for n, count in enumerate(CHANNELS) for channel in range(min(count, 3))]
        writes += [f"set.output 1={-1234 + pattern}", f"set.output 2={pattern}"]
        done = segment.run([cm1e, "io", "--json", "-b", path, "--allow-output", "--for", "0.2", *writes])
        wire.check(done.returncode == 0, f"{cycle_time_us} us: {done.stdout}{done.stderr}")
        values = {}
        for signal in json.loads(done.stdout)["signals"]:
            if signal["slave_name"] and not signal["output"]:
                values.setdefault(signal["slave_name"], []).append(int(signal["value"]))
        for n, count in enumerate(CHANNELS):
            expected = [pattern >> channel & 1 if channel < 3 else 0 for channel in range(count)]
            wire.check(values[f"in{n}"] == expected, f"{cycle_time_us} us: in{n} is {values[f'in{n}']}, not {expected}")
        level = [value for place, value in enumerate(values["level"]) if place % 3 == 2]
        wire.check(level == [-1234 + pattern, pattern], f"{cycle_time_us} us: level is {values['level']}")
    print(f"our master, {cycle_time_us} us: the PLC program ran, {sum(CHANNELS)} bits and two words came back")


# ---- pysoem ----------------------------------------------------------------------------------------------------------

def places():
    """Where SOEM puts the bits of the terminals: fewer than 8 bits share bytes, 8 begin a new one."""
    bit, found = 0, []
    for count in CHANNELS:
        if count >= 8 or bit + count > 8:
            bit = 0
        found.append(bit)
        bit = 0 if count >= 8 else bit + count
    return found


def shared(pattern, n):
    """The byte of terminal n with the bits of its neighbours in the same byte."""
    value, at = 0, places()
    first = n
    while first > 0 and at[first] > 0:
        first -= 1
    last = n
    while last + 1 < len(CHANNELS) and at[last + 1] > 0:
        last += 1
    for m in range(first, last + 1):
        value |= (pattern & ((1 << CHANNELS[m]) - 1)) << at[m]
    return value


def exchange(master, times):
    """The working counters. SOEM's own expectation forgets slaves whose bits are in a byte that another one began."""
    counters = set()
    for _ in range(times):
        master.send_processdata()
        counters.add(master.receive_processdata(wire.PAUSE_US))
        time.sleep(0.001)
    return counters


def run_master():
    import pysoem
    master = pysoem.Master()
    master.open(wire.MASTER_INTERFACE)
    wire.check(master.config_init() == DRIVE, f"{len(master.slaves)} slaves")
    master.config_map()
    wire.check(master.state_check(pysoem.SAFEOP_STATE, 2_000_000) == pysoem.SAFEOP_STATE, "Safe-Op not reached")
    slaves = master.slaves
    for motor in (MOTOR, SECOND):
        slaves[motor - 1].output = bytes(12) + b"\x08"  # CSP, controlword 0
    exchange(master, 3)
    master.state = pysoem.OP_STATE
    master.write_state()
    for _ in range(200):
        exchange(master, 1)
        if master.state_check(pysoem.OP_STATE, 1_000) == pysoem.OP_STATE:
            break
    master.read_state()
    wire.check(all(slave.state == pysoem.OP_STATE for slave in slaves),
               f"Op not reached: {[(slave.name, slave.state, slave.al_status) for slave in slaves]}")
    at = places()
    for pattern in PATTERNS:
        for n in range(len(CHANNELS)):
            slaves[DIGITAL - 1 + 2 * n].output = bytes([shared(pattern, n)])
        slaves[ANALOG_OUT - 1].output = struct.pack("<hh", -1234 + pattern, pattern)
        counters = exchange(master, 20)
        wire.check(counters == {3 * EACH_WAY}, f"working counters {counters}")
        for n, count in enumerate(CHANNELS):
            got = slaves[DIGITAL + 2 * n].input[0] >> at[n] & ((1 << count) - 1)
            wire.check(got == pattern & ((1 << count) - 1), f"in{n} is {got:#x} with {pattern:#x}")
        state1, first, state2, second = struct.unpack("<HhHh", slaves[ANALOG_IN - 1].input)
        wire.check((state1, first, state2, second) == (0, -1234 + pattern, 0, pattern), f"level: {first}, {second}")
    value = struct.unpack("<h", slaves[ANALOG_IN - 1].sdo_read(0x6000, 0x11))[0]
    wire.check(value == -1234 + PATTERNS[-1], f"0x6000:11 is {value}")
    master.state = pysoem.INIT_STATE
    master.write_state()
    master.close()
    print(f"pysoem: {len(slaves)} slaves in Op, {sum(CHANNELS)} bits and two words came back")


# ---- an ENI of it ----------------------------------------------------------------------------------------------------

PLAYER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "eni_player.py")
PLAY = """
def play(master):
    master.start()
    for _ in range(20):
        master.cycle()
    if master.al_states() != (8, len(master.slaves)):
        raise Failed(f"AL states {master.al_states()}")
    for pattern in PATTERNS:
        for n, count in enumerate(CHANNELS):
            terminal = NAMES["out"].format(n=n, count=count, position=2 + 2 * n)
            for channel in range(count):
                master.write(terminal, f"Channel {channel + 1}.Output", pattern >> channel & 1)
        master.write(NAMES["ao"], "AO Output Channel 1.Value", pattern - 1234)
        for _ in range(20):
            master.cycle()
        for n, count in enumerate(CHANNELS):
            for channel in range(count):
                terminal = NAMES["in"].format(n=n, count=count, position=3 + 2 * n)
                got = master.read(terminal, f"Channel {channel + 1}.Input")
                if got != pattern >> channel & 1:
                    raise Failed(f"input {channel + 1} of in{n} is {got} with {pattern:#x}")
        if master.read(NAMES["ai"], "AI Standard Channel 1.Value", signed=True) != pattern - 1234:
            raise Failed("the analog value is another")
    print("the ENI of our scan, played by itself:", sum(CHANNELS), "bits and a word came back")
"""


PLAY_CLOCKS = PLAY.replace("def play(master):", "def play_bits(master):") + """
def play(master):
    play_bits(master)
    found = master.differences()
    if len(found) != len(master.slaves) - 1 or max(found.values()) > 1000:
        raise Failed(f"the clocks are apart: {found}")
    if not any(getattr(slave, "starts", 0) for slave in master.slaves):
        raise Failed("no slave has SYNC0")
    print("its clocks:", len(found), "follow the reference, at most", max(found.values()), "ns apart")
"""


# Of the slaves in an ENI: as the slaves say, or as the bus file says.
SCANNED = {"out": "Digital terminal {count}+0 {position}", "in": "Digital terminal 0+{count} {position}",
           "ao": "Analog terminal 2+0 10", "ai": "Analog terminal 0+2 11"}
NAMED = {"out": "out{n}", "in": "in{n}", "ao": "set", "ai": "level"}


def check_eni(segment, cm1e, play, names, *bus_file_options):
    path = os.path.join(segment.folder, "scan.xml")
    made = segment.run([cm1e, "generate", "eni", "-i", wire.MASTER_INTERFACE, *bus_file_options, "-o", path])
    wire.check(made.returncode == 0, f"generate eni: {made}")
    checked = segment.run([cm1e, "check", path])
    wire.check(checked.returncode == 0, f"check of the ENI: {checked.stdout}{checked.stderr}")
    played = segment.run([sys.executable, PLAYER, path, wire.MASTER_INTERFACE,
                          f"PATTERNS, CHANNELS, NAMES = {PATTERNS}, {CHANNELS}, {names}\n{play}"])
    print(played.stdout + played.stderr, end="")
    wire.check(played.returncode == 0, f"the player of the ENI ended with {played.returncode}")


def main(cm1e, python):
    with tempfile.TemporaryDirectory() as folder:
        for cycle_time_us, bridge in ((1000, True), (250, False)):
            print(run_example(cm1e, bus_file(folder, cycle_time_us, bridge, virtual=True), run_here).splitlines()[-1])
        slow = bus_file(folder, 1000, True)
        with wire.segment(cm1e, slow) as segment:
            check_our_master(segment, cm1e, slow, 1000)
        fast = bus_file(folder, 250, False)
        with wire.segment(cm1e, fast) as segment:
            check_our_master(segment, cm1e, fast, 250)
            result = segment.run([python, os.path.abspath(__file__), "--master"])
            print(result.stdout + result.stderr, end="")
            wire.check(result.returncode == 0, f"pysoem ended with {result.returncode}")
            check_eni(segment, cm1e, PLAY, SCANNED)
            for position in (MOTOR, ANALOG_IN):
                segment.console(f"clock {position} drift {4 * position}")
            check_eni(segment, cm1e, PLAY_CLOCKS, NAMED, "-b", fast)


if __name__ == "__main__":
    if sys.argv[1] == "--master":
        run_master()
    else:
        main(*sys.argv[1:])
