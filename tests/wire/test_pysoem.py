#!/usr/bin/env python3
"""pysoem, a master that is not ours, against `cm1e sim` over a veth pair: from the device tables, then booted from the
SII image that `cm1e generate sii` writes. To the master both are the same device.

test_pysoem.py CM1E PYTHON [sim arguments]: starts the segment and runs itself with --master in the master's namespace.
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

VENDOR, PRODUCT = 0x00004441, 0x44412002
# One object of every type the CM1-E has: (index, sub-index, struct format, a value to write or None for read-only).
OBJECTS = [
    (0x6060, 0, "<b", 6),            # SINT
    (0x60FB, 1, "<h", -3),           # INT
    (0x607C, 0, "<i", -1200),        # DINT
    (0x1001, 0, "<B", None),         # USINT
    (0x6041, 0, "<H", None),         # UINT
    (0x6081, 0, "<I", 123456),       # UDINT
    (0x1018, 2, "<I", None),         # UDINT in a record
    (0x6099, 1, "<I", 25000),        # UDINT in an array
]
STRINGS = {0x1008: b"CM1-E", 0x1009: b"MYO28-02A", 0x100A: b"1.3.5"}


def check_sdos(pysoem, slave):
    for index, text in STRINGS.items():
        got = slave.sdo_read(index, 0).rstrip(b"\0")
        wire.check(got == text, f"0x{index:04X} is {got!r}, expected {text!r}")
    for index, sub, form, value in OBJECTS:
        size = struct.calcsize(form)
        raw = slave.sdo_read(index, sub)
        wire.check(len(raw) == size, f"0x{index:04X}:{sub} has {len(raw)} bytes, expected {size}")
        if value is None:
            try:
                slave.sdo_write(index, sub, raw)
            except pysoem.SdoError as error:
                wire.check(error.abort_code == 0x06010002, f"0x{index:04X}: abort {error.abort_code:08X}")
            else:
                wire.check(False, f"0x{index:04X}:{sub} is read-only and was written")
        else:
            slave.sdo_write(index, sub, struct.pack(form, value))
            got = struct.unpack(form, slave.sdo_read(index, sub))[0]
            wire.check(got == value, f"0x{index:04X}:{sub} is {got} after writing {value}")
    try:
        slave.sdo_read(0x5555, 0)
    except pysoem.SdoError as error:
        wire.check(error.abort_code == 0x06020000, f"0x5555: abort {error.abort_code:08X}")
    else:
        wire.check(False, "0x5555 exists")
    slave.sdo_write(0x6060, 0, b"\0")


def acknowledge(master, slave, state):
    """Asks for a state with the error acknowledged, and waits until the slave is there without an error."""
    slave.state = state | 0x10
    slave.write_state()
    wire.wait_for(lambda: (master.read_state(), slave.state == state)[1], 1.0,
                  f"state {state:#x} without an error not reached")


def check_wrong_requests(pysoem, master, slave):
    """The AL status codes of three wrong requests, each from the state that makes it wrong."""
    for start, asked, code, why in [
        (pysoem.INIT_STATE, pysoem.OP_STATE, 0x0011, "Init -> Op"),
        (pysoem.PREOP_STATE, 0x07, 0x0012, "an unknown state"),
        (pysoem.PREOP_STATE, pysoem.BOOT_STATE, 0x0011, "Pre-Operational -> Bootstrap"),
    ]:
        acknowledge(master, slave, start)
        slave.state = asked
        slave.write_state()
        wire.wait_for(lambda: (master.read_state(), slave.state & 0x10)[1], 1.0, f"{why} was not refused")
        wire.check(slave.al_status == code, f"{why}: AL status code 0x{slave.al_status:04X}, expected 0x{code:04X}")
        wire.check(slave.state & 0x0F == start, f"{why}: the state became {slave.state:#x}")


def read_eeprom(slave, words):
    image = b""
    while len(image) < 2 * words:
        image += slave.eeprom_read(len(image) // 2)
    return image


def parse_sii(image):
    """Names and PDOs of an SII image, by ETG.1000.6 alone."""
    categories, at = {}, 0x80
    while (kind := struct.unpack_from("<H", image, at)[0]) != 0xFFFF:
        length = 2 * struct.unpack_from("<H", image, at + 2)[0]
        categories.setdefault(kind, image[at + 4:at + 4 + length])
        at += 4 + length
    strings, raw = [""], categories[10][1:]
    for _ in range(categories[10][0]):
        strings.append(raw[1:1 + raw[0]].decode("latin-1"))
        raw = raw[1 + raw[0]:]
    facts = {"names": [strings[categories[30][n]] for n in (0, 2, 3)], "pdos": []}
    for kind in (50, 51):
        data, at = categories[kind], 0
        while at < len(data):
            index, count, manager, _, name, _ = struct.unpack_from("<HBBBBH", data, at)
            entries = [struct.unpack_from("<HBBBBH", data, at + 8 + 8 * n) for n in range(count)]
            facts["pdos"].append({"index": index, "name": strings[name], "sync_manager": manager,
                                  "entries": [[e[0], e[1], e[4], strings[e[2]]] for e in entries],
                                  "bits": sum(e[4] for e in entries)})
            at += 8 + 8 * count
    return facts


def run_master():
    import pysoem
    master = pysoem.Master()
    master.open(wire.MASTER_INTERFACE)
    wire.check(master.config_init() == 1, "one slave expected")
    slave = master.slaves[0]
    wire.check((slave.man, slave.id) == (VENDOR, PRODUCT), f"identity {slave.man:08X} {slave.id:08X}")
    wire.check(slave.name == "CM1-E", f"name {slave.name!r}")
    wire.wait_for(lambda: (master.read_state(), slave.state == pysoem.PREOP_STATE)[1], 2.0, "Pre-Op not reached")
    image = read_eeprom(slave, 1024)
    facts = {"identity": [slave.man, slave.id, slave.rev], "name": slave.name, **parse_sii(image)}
    check_sdos(pysoem, slave)
    check_wrong_requests(pysoem, master, slave)

    acknowledge(master, slave, pysoem.PREOP_STATE)
    master.config_map()
    wire.check(master.state_check(pysoem.SAFEOP_STATE, 1_000_000) == pysoem.SAFEOP_STATE, "Safe-Op not reached")
    wire.check((len(slave.output), len(slave.input)) == (13, 21), f"{len(slave.output)} + {len(slave.input)} bytes")
    facts["bytes"] = [len(slave.output), len(slave.input)]
    by_sii = {pdo["sync_manager"]: pdo["bits"] // 8 for pdo in facts["pdos"] if pdo["sync_manager"] != 0xFF}
    wire.check([by_sii[2], by_sii[3]] == facts["bytes"], f"the SII has {by_sii} bytes, the device {facts['bytes']}")
    slave.output = bytes(12) + b"\x08"  # CSP, controlword 0
    master.send_processdata()
    master.receive_processdata(wire.PAUSE_US)
    master.state = pysoem.OP_STATE
    master.write_state()
    for _ in range(500):
        master.send_processdata()
        master.receive_processdata(wire.PAUSE_US)
        if master.state_check(pysoem.OP_STATE, 1_000) == pysoem.OP_STATE:
            break
    master.read_state()
    wire.check(slave.state == pysoem.OP_STATE, f"Op not reached: {slave.state:#x}, AL status {slave.al_status:#x}")

    errors, next_cycle = 0, time.monotonic()
    for _ in range(1000):
        master.send_processdata()
        errors += master.receive_processdata(wire.PAUSE_US) != master.expected_wkc
        next_cycle += 0.001
        time.sleep(max(0.0, next_cycle - time.monotonic()))
    wire.check(errors == 0, f"{errors} of 1,000 cycles had a wrong working counter")
    wire.check(slave.input[20] == 8, f"mode of operation display {slave.input[20]}, expected 8")
    cycle_us = struct.unpack("<H", slave.sdo_read(0xFE00, 1))[0]
    wire.check(cycle_us in (0, 200, 250, 500, 1000), f"0xFE00:1 is {cycle_us}")
    master.state = pysoem.INIT_STATE
    master.write_state()
    master.close()
    print(json.dumps({"facts": facts, "eeprom": image.hex()}))
    print("pysoem: identity, SDOs of every type, AL status codes, 13 + 21 bytes, Op, 1,000 good cycles")


def scan(cm1e, python, arguments):
    """What pysoem finds on a segment, and the bytes of the slave's EEPROM."""
    with wire.segment(cm1e, *arguments) as segment:
        result = segment.run([python, os.path.abspath(__file__), "--master"])
    answer, _, words = result.stdout.partition("\n")
    print((words if result.returncode == 0 else result.stdout) + result.stderr, end="")
    wire.check(result.returncode == 0, f"the master ended with {result.returncode}")
    answer = json.loads(answer)
    return answer["facts"], bytes.fromhex(answer["eeprom"])


def check_boot_from_file(cm1e, python, arguments, expected, eeprom):
    """The alias tells the image from the one of the tables; all else is the same."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "sii.bin")
        subprocess.run([cm1e, "generate", "sii", "-o", path, "--alias", "4660", *arguments], check=True)
        with open(path, "rb") as file:
            image = file.read()
        facts, booted = scan(cm1e, python, ["--sii", path, *arguments])
        wire.check(booted == image, "the simulator did not boot from the file")
        wire.check(booted != eeprom, "the file is the image of the tables")
        wire.check(facts == expected, f"from the file {facts}, from the tables {expected}")
        # what does not fit is refused, and says why
        with open(path, "wb") as file:
            file.write(image[:300])
        for name, status in ((path, 1), ("/no/such/file", 2)):
            refused = subprocess.run([cm1e, "sim", "-i", "lo", "--sii", name], capture_output=True, text=True)
            wire.check(refused.returncode == status and name in refused.stderr, f"{name}: {refused}")
    print("booted from the file that `cm1e generate sii` wrote: the same device")


def main(cm1e, python, *arguments):
    facts, eeprom = scan(cm1e, python, arguments)
    check_boot_from_file(cm1e, python, arguments, facts, eeprom)


if __name__ == "__main__":
    if sys.argv[1] == "--master":
        run_master()
    else:
        main(*sys.argv[1:])
