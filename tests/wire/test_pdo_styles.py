#!/usr/bin/env python3
"""Process data as makers arrange them, over a veth pair: a device with its inputs on sync manager 2 and its outputs on 3,
one with modules in its slots and padding behind their bits, an encoder terminal. Our master at 1 ms and 250 us, and
pysoem, exchange the same bits with them; pysoem gets the abort code for PDOs that exclude each other.

test_pdo_styles.py CM1E PYTHON: starts the segment and runs itself with --master in the master's namespace.
"""
import json
import os
import struct
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

SWAPPED, MODULAR, COUNTER, PLAIN = 1, 2, 3, 4
COUNTS_PER_S = 40000
SLAVES = f"""\
slaves:
  - {{name: swapped, position: {SWAPPED}, sim: {{device: analog, inputs: 2, outputs: 2, swapped: true}}}}
  - {{name: modular, position: {MODULAR}, modules: [0x205, 0x105, 0x402, 0x302], sim: {{device: modular}}}}
  - {{name: counter, position: {COUNTER}, sim: {{device: encoder, inputs: 1, counts_per_s: {COUNTS_PER_S}}}}}
  - {{name: plain, position: {PLAIN}, sim: {{device: analog, inputs: 2}}}}
"""
# What is written, and where it comes back.
WRITTEN = {"swapped.0x7000:11": -1234, "swapped.0x7010:11": 77, "modular.0x7000:02": 1, "modular.0x7000:05": 1,
           "modular.0x7020:02": 4711}
BACK = {"0x6000:11": "-1234", "0x6010:11": "77"}


def bus_file(segment, cycle_time_us):
    path = os.path.join(segment.folder, f"styles_{cycle_time_us}.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(f"bus:\n  interface: {wire.MASTER_INTERFACE}\n  cycle_time_us: {cycle_time_us}\n"
                   f"  lost_cycles_limit: {wire.PAUSE_US // cycle_time_us}\n{SLAVES}")
    return path


def check_our_master(segment, cm1e, cycle_time_us):
    done = segment.run([cm1e, "io", "--json", "-b", bus_file(segment, cycle_time_us), "--allow-output", "--for", "0.2",
                        *(f"{name}={value}" for name, value in WRITTEN.items())])
    wire.check(done.returncode == 0, f"{cycle_time_us} us: {done}")
    inputs = {}
    for row in json.loads(done.stdout)["signals"]:
        if not row["output"]:
            inputs.setdefault(row["slave_name"], []).append(int(row["value"]))
    wire.check(inputs["swapped"] == [0, 0, -1234, 0, 0, 77], f"{cycle_time_us} us: swapped {inputs}")
    wire.check(inputs["modular"] == [0, 1, 0, 0, 1, 0, 4711], f"{cycle_time_us} us: modular {inputs}")
    wire.check(inputs["counter"][1] > 0, f"{cycle_time_us} us: counter {inputs}")
    print(f"our master, {cycle_time_us} us: all came back")


def exchange(master, times=20):
    for _ in range(times):
        master.send_processdata()
        counter = master.receive_processdata(wire.PAUSE_US)
        time.sleep(0.001)
    return counter


def run_master():
    import pysoem
    master = pysoem.Master()
    master.open(wire.MASTER_INTERFACE)
    wire.check(master.config_init() == PLAIN, f"{len(master.slaves)} slaves")
    # It asks for Pre-Operational and does not wait; before that state a slave has no mailbox.
    wire.check(master.state_check(pysoem.PREOP_STATE, 2_000_000) == pysoem.PREOP_STATE, "Pre-Op not reached")
    swapped, modular, counter, plain = master.slaves
    plain.sdo_write(0x1C13, 0, bytes(1))
    plain.sdo_write(0x1C13, 1, struct.pack("<H", 0x1A00))
    plain.sdo_write(0x1C13, 2, struct.pack("<H", 0x1A01))
    try:
        plain.sdo_write(0x1C13, 0, bytes([2]))
        wire.check(False, "PDOs that exclude each other are assigned")
    except pysoem.SdoError as error:
        wire.check(error.abort_code & 0xFFFFFFFF == 0x06040043, f"abort code {error.abort_code:#x}")
    plain.sdo_write(0x1C13, 2, struct.pack("<H", 0x1A02))
    plain.sdo_write(0x1C13, 0, bytes([2]))
    idents = [struct.unpack("<I", modular.sdo_read(0xF050, n))[0] for n in range(1, 5)]
    wire.check(idents == [0x205, 0x105, 0x402, 0x302], f"detected modules {idents}")
    master.config_map()
    sizes = [(len(slave.output), len(slave.input)) for slave in master.slaves]
    wire.check(sizes == [(4, 8), (5, 5), (0, 6), (0, 8)], f"sizes {sizes}")
    wire.check(master.state_check(pysoem.SAFEOP_STATE, 2_000_000) == pysoem.SAFEOP_STATE, "Safe-Op not reached")
    master.state = pysoem.OP_STATE
    master.write_state()
    for _ in range(200):
        exchange(master, 1)
        if master.state_check(pysoem.OP_STATE, 1_000) == pysoem.OP_STATE:
            break
    master.read_state()
    wire.check(all(slave.state == pysoem.OP_STATE for slave in master.slaves),
               f"Op not reached: {[(slave.name, slave.state, hex(slave.al_status)) for slave in master.slaves]}")
    swapped.output = struct.pack("<hh", -1234, 77)
    modular.output = struct.pack("<Bhh", 0b10010, 0, 4711)
    wire.check(exchange(master) == 3 + 3 + 1 + 1, "the working counter is another")
    wire.check(struct.unpack("<HhHh", swapped.input) == (0, -1234, 0, 77), f"swapped {swapped.input}")
    wire.check(struct.unpack("<Bhh", modular.input) == (0b10010, 0, 4711), f"modular {modular.input}")
    before, begin = struct.unpack("<HI", counter.input)[1], time.monotonic()
    exchange(master, 200)
    speed = (struct.unpack("<HI", counter.input)[1] - before) / (time.monotonic() - begin)
    wire.check(abs(speed - COUNTS_PER_S) < 0.2 * COUNTS_PER_S, f"the counter turns at {speed} counts/s")
    master.state = pysoem.INIT_STATE
    master.write_state()
    master.close()
    print("pysoem: all came back")


def main(cm1e, python):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "segment.yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(SLAVES)
        with wire.segment(cm1e, path) as segment:
            for cycle_time_us in (1000, 250):
                check_our_master(segment, cm1e, cycle_time_us)
            result = segment.run([python, os.path.abspath(__file__), "--master"])
            print(result.stdout + result.stderr, end="")
            wire.check(result.returncode == 0, f"pysoem ended with {result.returncode}")


if __name__ == "__main__":
    if sys.argv[1] == "--master":
        run_master()
    else:
        main(*sys.argv[1:])
