#!/usr/bin/env python3
"""`cm1e firmware update` over a veth pair: the motor has the new firmware afterwards; whatever breaks it off, the command
says what the motor has, and the same command brings it back. pysoem's FoE, as a second opinion on the simulated device.

test_firmware.py CM1E PYTHON: runs itself with --master in the master's namespace.
"""
import json
import os
import signal
import struct
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

ROOM = 128 - 6 - 6  # bytes of a file in one packet
SLAVES = "axes: [{name: X, sim: {no_stops: true}}, {name: Y, sim: {no_stops: true}}]\n"


class Bench:
    def __init__(self, cm1e, python, segment, folder):
        self.cm1e, self.python, self.segment, self.folder = cm1e, python, segment, folder

    def image(self, version, size=30000, said=None):
        path = os.path.join(self.folder, f"firmware-{version}-{size}.bin")
        text = f"CM1-E simulated firmware {version}, {said or size} bytes\n".encode()
        with open(path, "wb") as file:
            file.write(text + bytes(n % 251 for n in range(size - len(text))))
        return path

    def command(self, path, *words, position="1"):
        return [self.cm1e, "firmware", "update", "-i", wire.MASTER_INTERFACE, "-p", position, path, "--yes", *words]

    def update(self, path, *words):
        return self.segment.run(self.command(path, *words))

    def version(self, slave=1):
        told = self.segment.run([self.cm1e, "sdo", "read", "-i", wire.MASTER_INTERFACE, str(slave), "0x100A"])
        return told.stdout.strip() if told.returncode == 0 else told.stderr

    def good(self, path, before, after, *words):
        told = self.update(path, *words)
        wire.check(told.returncode == 0 and f"was {before} and is {after}" in told.stdout, f"{words}: {told}")
        wire.check(self.version() == after, f"version {self.version()}, expected {after}")

    def bad(self, path, said, touched, *words):
        told = self.update(path, *words)
        wire.check(told.returncode == 1 and said in told.stderr, f"expected \"{said}\": {told}")
        wire.check(("may be incomplete now" if touched else "keeps the firmware") in told.stderr, f"{told}")


def updates(bench):
    """Up and down, with an EEPROM that fits; what a motor keeps without power stays."""
    wire.check(bench.version() == "1.3.5", bench.version())
    bench.segment.run([bench.cm1e, "params", "set", "-i", wire.MASTER_INTERFACE, "1", "H3=-7"])
    told = bench.update(bench.image("1.2.0"), "--json")
    wire.check(json.loads(told.stdout)["before"] == "1.3.5" and json.loads(told.stdout)["after"] == "1.2.0", f"{told}")
    scan = bench.segment.run([bench.cm1e, "scan", "-i", wire.MASTER_INTERFACE]).stdout
    wire.check("0x20020001" in scan and "0x20020103" in scan, f"the revisions after an update of one slave: {scan}")
    kept = bench.segment.run([bench.cm1e, "params", "get", "-i", wire.MASTER_INTERFACE, "1", "H3", "--json"])
    wire.check(json.loads(kept.stdout)[0]["value"] == -7, f"H3 after an update: {kept}")
    bench.good(bench.image("1.3.4", 50 * ROOM), "1.2.0", "1.3.4")  # ends with a packet of no bytes
    bench.good(bench.image("1.3.5", 50 * ROOM + 1), "1.3.4", "1.3.5")


def disturbed(bench):
    """Lost, damaged and late frames, a slave that is busy: it takes longer."""
    bench.segment.console("firmware 1 busy 20")
    bench.good(bench.image("1.3.4"), "1.3.5", "1.3.4")
    process = subprocess.Popen(bench.segment.command(bench.command(bench.image("1.3.5", 150000))), stdout=subprocess.PIPE,
                               stderr=subprocess.PIPE, text=True)
    # Before its first frame the faults would gather, and a scan repeats a broadcast three times only.
    wire.wait_for(lambda: process.poll() is not None or "BOOT" in bench.segment.console("status 1"), 10, "no Bootstrap")
    faults = 0
    while process.poll() is None:
        faults += 1
        bench.segment.console(("lose 1", "corrupt 2", "delay 2 3000", "lose 3")[faults % 4])
        time.sleep(0.01)
    out, err = process.communicate()
    wire.check(process.returncode == 0 and "is 1.3.5" in out, f"with {faults} faults: {out}{err}")
    print(f"an update with {faults} times lost, damaged or late frames: good")


def refused(bench):
    """What the slave does not take: it keeps what it has."""
    console = bench.segment.console
    console("firmware 1 name right.bin")
    bench.bad(bench.image("1.3.4"), "0x8001, file not found", False)
    bench.good(bench.image("1.3.4"), "1.3.5", "1.3.4", "--name", "right.bin")
    console("firmware 1 nothing")
    console("firmware 1 password 1234")
    bench.bad(bench.image("1.3.5"), "wrong password", False)
    bench.good(bench.image("1.3.5"), "1.3.4", "1.3.5", "--password", "1234")
    console("firmware 1 nothing")
    short = bench.update(bench.image("1.3.4", 500))
    wire.check(short.returncode == 1 and "Nothing was done" in short.stderr, f"a file of 500 bytes: {short}")
    other = bench.segment.run(bench.command(bench.image("1.3.4"), position="3"))
    wire.check(other.returncode == 1 and "no slave 3" in other.stderr, f"{other}")
    wire.check(bench.version() == "1.3.5", bench.version())


def broken_off(bench):
    """Half-way: the slave has no firmware, cannot leave Init, and is brought back by the same command."""
    console, recover = bench.segment.console, bench.image("1.3.5")
    half = bench.image("1.3.4", 120000)

    def recovered(first="unknown"):
        console("firmware 1 nothing")
        bench.good(recover, first, "1.3.5")

    console("firmware 1 error 8011 5000")
    bench.bad(half, "FoE error 0x8011, fault of the flash memory", True)
    wire.check("0x0014" in bench.version(), f"a slave without a firmware: {bench.version()}")
    recovered()
    bench.bad(bench.image("1.3.4", 20000, said=30000), "0x8012", True)
    recovered()
    console("firmware 1 silent 5000")
    bench.bad(half, "did not answer for 0.3 s", True, "--timeout", "0.3")
    recovered()
    console("firmware 1 busy 1000000")
    bench.bad(half, "has acknowledged no part of it: it does not say whether it has erased", True, "--timeout", "0.3")
    recovered("1.3.5")  # nothing of the file had come
    def while_writing(what):
        process = subprocess.Popen(bench.segment.command(bench.command(half)), stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        wire.wait_for(lambda: "BOOT" in console("status 1"), 10, "Bootstrap was not reached")
        time.sleep(0.2)
        what(process)
        out, err = process.communicate(timeout=60)
        return process, out, err

    process, out, err = while_writing(lambda process: process.send_signal(signal.SIGHUP))
    wire.check(process.returncode == 0 and "is 1.3.4" in out, f"the terminal was closed: {process.returncode} {out}{err}")
    recovered("1.3.4")
    for what in (lambda process: console("power-cycle 1 300"), lambda process: process.send_signal(signal.SIGINT),
                 lambda process: process.send_signal(signal.SIGQUIT)):
        process, out, err = while_writing(what)
        wire.check(process.returncode == 1 and ("stopped answering" in err or "Broken off" in err) and
                   "may be incomplete now" in err and "run the same command again" in err, f"{out}{err}")
        wire.wait_for(lambda: bench.segment.run([bench.cm1e, "sii", "decode", "-i", wire.MASTER_INTERFACE, "1"]).returncode
                      == 0, 10, "the slave is not back")
        recovered()


def beside_others(bench):
    """A program that has the wire, and slaves that one has left behind."""
    bus_file = os.path.join(bench.folder, "bus.yaml")
    with open(bus_file, "w", encoding="utf-8") as file:
        file.write(f"bus: {{interface: {wire.MASTER_INTERFACE}, lost_cycles_limit: 50}}\naxes: [{{name: X}}, {{name: Y}}]\n")
    move = subprocess.Popen(bench.segment.command([bench.cm1e, "move", "-b", bus_file, "X", "--speed", "0.5", "--for",
                                                   "60"]), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wire.wait_for(lambda: "Operation enabled" in bench.segment.console("status 1") or move.poll() is not None, 10,
                  "the motor was not enabled")
    if move.poll() is not None:
        wire.check(False, f"the move ended: {move.communicate()}")
    told = bench.update(bench.image("1.3.4"))
    wire.check(told.returncode == 1 and "needs the network for itself" in told.stderr and
               f"cm1e move (process {move.pid})" in told.stderr, f"beside a move: {told}")
    wire.check("Operation enabled" in bench.segment.console("status 1"), "the move was disturbed")
    move.kill()
    move.communicate()
    told = bench.update(bench.image("1.3.4"))
    wire.check(told.returncode == 1 and "Operational" in told.stderr and "Nothing was done" in told.stderr,
               f"slaves of a master that was killed: {told}")
    wire.check(bench.version() == "1.3.5", bench.version())  # which scans, and so ends Operational
    told = bench.segment.run([bench.cm1e, "firmware", "update", "-b", bus_file, "-a", "Y", bench.image("1.3.3"), "--yes"])
    wire.check(told.returncode == 0 and bench.version(2) == "1.3.3" and bench.version() == "1.3.5", f"by name: {told}")


# ---- pysoem ---------------------------------------------------------------------------------------------------------

def run_master(path):
    import pysoem
    master = pysoem.Master()
    master.open(wire.MASTER_INTERFACE)
    wire.check(master.config_init() == 2, "two slaves expected")
    slave = master.slaves[0]
    slave.state = pysoem.INIT_STATE
    slave.write_state()
    wire.check(slave.state_check(pysoem.INIT_STATE, 3_000_000) == pysoem.INIT_STATE, "Init not reached")
    for box, offset in (("out", pysoem.SiiOffset.BOOT_RX_MBX), ("in", pysoem.SiiOffset.BOOT_TX_MBX)):
        start, size = struct.unpack("<HH", slave.eeprom_read(offset))
        slave.amend_mbx(mailbox=box, start_address=start, size=size)
    slave.state = pysoem.BOOT_STATE
    slave.write_state()
    wire.check(slave.state_check(pysoem.BOOT_STATE, 3_000_000) == pysoem.BOOT_STATE, "Bootstrap not reached")
    with open(path, "rb") as file:
        result = slave.foe_write(os.path.basename(path), 0, file.read(), 1_000_000)
    slave.state = pysoem.INIT_STATE
    slave.write_state()
    wire.check(slave.state_check(pysoem.INIT_STATE, 3_000_000) == pysoem.INIT_STATE, "Init not reached again")
    master.close()
    print(result)


def second_opinion(bench):
    def by_pysoem(path):
        return bench.segment.run([bench.python, os.path.abspath(__file__), "--master", path])

    for version, size in (("1.3.0", 40 * ROOM), ("1.3.4", 12345)):
        told = by_pysoem(bench.image(version, size))
        wire.check(told.returncode == 0 and int(told.stdout) > 0, f"pysoem: {told}")
        wire.check(bench.version() == version, f"by pysoem: {bench.version()}, expected {version}")
    bench.segment.console("firmware 1 error 8002 0")
    told = by_pysoem(bench.image("1.3.5"))
    wire.check(told.returncode != 0 or int(told.stdout) < 0, f"pysoem does not see an error: {told}")
    bench.segment.console("firmware 1 nothing")
    wire.check(bench.version() == "1.3.4", bench.version())
    print("pysoem: two files written, an error seen")


def main(cm1e, python):
    def on_a_segment(check):
        with tempfile.TemporaryDirectory() as folder:
            slaves = os.path.join(folder, "slaves.yaml")
            with open(slaves, "w", encoding="utf-8") as file:
                file.write(SLAVES)
            with wire.segment(cm1e, slaves) as segment:
                begin = time.monotonic()
                check(Bench(cm1e, python, segment, folder))
                print(f"{check.__name__}: {time.monotonic() - begin:.1f} s", flush=True)

    wire.together(*(lambda check=check: on_a_segment(check) for check in (
        broken_off, updates, disturbed, refused, beside_others, second_opinion)))


if __name__ == "__main__":
    if sys.argv[1] == "--master":
        run_master(sys.argv[2])
    else:
        main(*sys.argv[1:])
