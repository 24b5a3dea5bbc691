#!/usr/bin/env python3
"""The simulated Cool MUSCLE Bridge over a veth pair: `cm1e scan` finds it, and pysoem, a master that is not ours, scans
it, reads and writes its objects, sends a CML query, and runs it with 24 + 24 bytes.

test_bridge.py CM1E PYTHON: starts the segment and runs itself with --master in the master's namespace.
"""
import os
import struct
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

VENDOR, PRODUCT = 0x0000AA77, 0x0000EB12
AXES = range(4)


def number(slave, index, sub=0):
    return int.from_bytes(slave.sdo_read(index, sub), "little")


def check_abort(pysoem, code, access, what):
    try:
        access()
    except pysoem.SdoError as error:
        wire.check(error.abort_code == code, f"{what}: abort {error.abort_code:08X}, expected {code:08X}")
    else:
        wire.check(False, f"{what}: no abort")


def check_objects(pysoem, slave):
    wire.check(slave.sdo_read(0x1008, 0).rstrip(b"\0") == b"EB12", "0x1008")
    wire.check(number(slave, 0xF000, 1) == 0x800, "0xF000:1")
    for axis in AXES:
        offset = 0x800 * axis
        wire.check(number(slave, 0xF050, axis + 1) == 0x219800, "0xF050")
        wire.check(number(slave, 0xF511 + axis, 1) == (1 if axis < 2 else 2), "kind of motor")
        slave.sdo_write(0x6099 + offset, 1, struct.pack("<I", 200 + axis))
        wire.check(number(slave, 0x60F6 + offset, 42 - 20) == 200 + axis, "K42 is the homing speed")
        check_abort(pysoem, 0x06010000, lambda o=offset: slave.sdo_read(0x606C + o, 0), "N/A")
        check_abort(pysoem, 0x06090011, lambda o=offset: slave.sdo_read(0x60F6 + o, 99 - 20), "-")
        check_abort(pysoem, 0x06010002, lambda o=offset: slave.sdo_write(0x6041 + o, 0, b"\0\0"), "read-only")


def check_cml(slave):
    """A query on the second axis, in Pre-Operational, where no controlwords keep its serial line busy."""
    slave.sdo_write(0x6860, 0, struct.pack("<b", 101))
    wire.wait_for(lambda: number(slave, 0x6861) == 101, 1.0, "CML not reached")
    slave.sdo_write(0xF582, 0, b"?99.2")
    answers = []

    def answered():
        answers.append(slave.sdo_read(0xF592, 0))
        return answers[-1] != b"Null\r\n"
    wire.wait_for(answered, 1.0, "no answer to ?99.2")
    wire.check(answers[-1] == b"Ux.2=8\r\n", f"?99.2: {answers}")
    wire.check(slave.sdo_read(0xF592, 0) == b"Null\r\n", "the answer came twice")
    time.sleep(0.01)
    slave.sdo_write(0x6860, 0, struct.pack("<b", 8))
    wire.wait_for(lambda: number(slave, 0x6861) == 8, 1.0, "csp not reached")


def exchange(master, slave, words):
    slave.output = b"".join(struct.pack("<Hi", word, target) for word, target in words)
    master.send_processdata()
    good = master.receive_processdata(wire.PAUSE_US) == master.expected_wkc
    return good, list(struct.iter_unpack("<Hi", slave.input))


def run_master():
    import pysoem
    master = pysoem.Master()
    master.open(wire.MASTER_INTERFACE)
    wire.check(master.config_init() == 1, "one slave expected")
    slave = master.slaves[0]
    wire.check((slave.man, slave.id) == (VENDOR, PRODUCT), f"identity {slave.man:08X} {slave.id:08X}")
    wire.wait_for(lambda: (master.read_state(), slave.state == pysoem.PREOP_STATE)[1], 2.0, "Pre-Op not reached")
    check_objects(pysoem, slave)
    check_cml(slave)
    master.config_map()
    wire.check((len(slave.output), len(slave.input)) == (24, 24), f"{len(slave.output)} + {len(slave.input)} bytes")
    wire.check(master.state_check(pysoem.SAFEOP_STATE, 1_000_000) == pysoem.SAFEOP_STATE, "Safe-Op not reached")
    exchange(master, slave, [(0, 0)] * 4)
    master.state = pysoem.OP_STATE
    master.write_state()
    for _ in range(500):
        exchange(master, slave, [(0, 0)] * 4)
        if master.state_check(pysoem.OP_STATE, 1_000) == pysoem.OP_STATE:
            break

    errors, next_cycle, words = 0, time.monotonic(), [(0, 0)] * 4
    for n in range(1500):
        good, inputs = exchange(master, slave, words)
        errors += not good
        # 100 cycles for each step of enabling, where the motors stand; then each at a speed of its own for a second
        word = (0x06, 0x07, 0x0F)[min(n // 100, 2)]
        if n == 0:
            start = [position for _, position in inputs]
        words = [(word, start[axis] + (axis + 1) * min(max(n - 300, 0), 1000)) for axis in AXES]
        next_cycle += 0.001
        time.sleep(max(0.0, next_cycle - time.monotonic()))
    wire.check(errors == 0, f"{errors} of 1,500 cycles had a wrong working counter")
    master.read_state()
    wire.check(slave.state == pysoem.OP_STATE, f"Op left: {slave.state:#x}, AL status {slave.al_status:#x}")
    for axis in AXES:
        status, position = inputs[axis]
        wire.check(status & 0x4F == 0x07 and status & 0x9000 == 0x1000, f"axis {axis}: statusword {status:#06x}")
        wire.check(abs(position - start[axis] - 1000 * (axis + 1)) <= 2, f"axis {axis}: at {position}")
    wire.check(number(slave, 0xF530, 9) > 1000, "the serial line does not count")
    master.state = pysoem.INIT_STATE
    master.write_state()
    master.close()
    print("pysoem: identity, SDOs with their aborts, a CML query, 24 + 24 bytes, Op, 1,500 good cycles, four axes moved")


def main(cm1e, python):
    with wire.segment(cm1e, "--bridge", "eb12") as segment:
        found = segment.run([cm1e, "scan", "-i", wire.MASTER_INTERFACE])
        wire.check(found.returncode == 0 and "EB12" in found.stdout, f"cm1e scan: {found.stdout}{found.stderr}")
        print(found.stdout, end="")
        result = segment.run([python, os.path.abspath(__file__), "--master"])
    print(result.stdout + result.stderr, end="")
    wire.check(result.returncode == 0, f"the master ended with {result.returncode}")


if __name__ == "__main__":
    if sys.argv[1] == "--master":
        run_master()
    else:
        main(*sys.argv[1:])
