#!/usr/bin/env python3
"""Distributed clocks over a veth pair: cm1e brings a drive to Operational that runs by SYNC0, and tells what its clock
does; pysoem, a master that is not ours, measures and sets the same clocks (config_dc, dc_sync).

test_wire_clocks.py CM1E PYTHON: starts the segments and runs itself with --master in the master's namespace.
"""
import json
import os
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

NETWORK = """\
bus: {{interface: {interface}, cycle_time_us: 1000, lost_cycles_limit: 50, control: observe}}
axes:
  - {{name: X, sim: {{no_stops: true}}}}
  - name: Y
    device: cia402
    drive: {{counts_per_revolution: 131072, max_speed_rpm: 3000}}
    dc: {{sync0_us: 1000, shift_us: 400}}
"""
TOLERANCE_NS, HOP_NS, CYCLE_NS = 1000, 700, 1_000_000
DIFFERENCE, ACTIVATION_STATUS, SYNC0_START, DELAY = 0x092C, 0x0984, 0x0990, 0x0928


def write_network(folder, interface):
    path = os.path.join(folder, f"{interface}.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(NETWORK.format(interface=interface))
    return path


def clock_of(segment, cm1e, bus_file):
    told = segment.run([cm1e, "status", "-b", bus_file, "--json"])
    wire.check(told.returncode == 0, f"status: {told.stderr}")
    slaves = json.loads(told.stdout)
    wire.check(all("clock" in slave for slave in slaves), f"no clock: {told.stdout}")
    return slaves[1]["clock"], slaves[0]["clock"]


def in_step(segment, cm1e, bus_file):
    """The clocks of the drive and of the reference, once the drive is within its tolerance."""
    end = time.monotonic() + 10
    while time.monotonic() < end:
        drive, reference = clock_of(segment, cm1e, bus_file)
        if not drive["lost"] and abs(drive["deviation_ns"]) <= TOLERANCE_NS:
            return drive, reference
    wire.check(False, f"the drive does not come in step: {drive}")


def check_own_master(cm1e, folder):
    os.environ["CM1E_RUNTIME_DIR"] = os.path.join(folder, "run")
    with wire.segment(cm1e, write_network(folder, "sim")) as segment:
        segment.console("clock 1 drift 40")
        segment.console("clock 2 drift -60")
        bus_file = write_network(folder, wire.MASTER_INTERFACE)
        program = subprocess.Popen(segment.command([cm1e, "move", "-b", bus_file, "X", "--speed", "0.5", "--for", "60"]),
                                   stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        wire.wait_for(lambda: program.poll() is not None or "OP" in segment.console("status 2"), 20,
                      "the drive does not reach Operational")
        wire.check(program.poll() is None, "the program ended")
        time.sleep(1)
        drive, reference = in_step(segment, cm1e, bus_file)
        wire.check(reference["is_reference"] and not drive["is_reference"], f"{reference} {drive}")
        wire.check(drive["sync0_ns"] == CYCLE_NS, f"{drive}")
        wire.check(", OP" in segment.console("status 2"), segment.console("status 2"))
        # A pause of the machine lets a clock run alone, which may be a loss too: counted from here.
        before = drive["losses"]
        segment.console("clock 2 step 5000")
        time.sleep(1)
        drive, _ = in_step(segment, cm1e, bus_file)
        wire.check(drive["losses"] > before, f"after a jump {drive}")
        log = segment.run([cm1e, "log", "-b", bus_file]).stdout
        wire.check("loss of synchronism" in log, f"the log does not tell it: {log}")
        doctor = segment.run([cm1e, "doctor", "-b", bus_file]).stdout
        wire.check("slave 2 lost synchronism" in doctor, doctor)
        segment.console("clock 2 step 100000")
        wire.wait_for(lambda: "0x0032" in segment.console("status 2"), 5, "the drive stays in Operational")
        program.terminate()
        program.wait(20)
        print(f"cm1e: SYNC0, the drive in Operational, {drive['maximum_ns']} ns after a jump of 5 us, loss in words")


def run_master():
    import pysoem
    master = pysoem.Master()
    master.open(wire.MASTER_INTERFACE)
    wire.check(master.config_init() == 2, "two slaves expected")
    drive = master.slaves[1]
    wire.wait_for(lambda: (master.read_state(), drive.state == pysoem.PREOP_STATE)[1], 2.0, "Pre-Op not reached")

    def read(address, size):
        return int.from_bytes(drive._fprd(address, size), "little")

    master.config_map()
    wire.check(master.config_dc(), "pysoem finds no clocks")
    wire.check(read(DELAY, 4) == HOP_NS, f"pysoem measured a delay of {read(DELAY, 4)} ns")
    drive.dc_sync(True, CYCLE_NS, 400_000)
    wire.check(master.state_check(pysoem.SAFEOP_STATE, 1_000_000) == pysoem.SAFEOP_STATE, "Safe-Op not reached")

    def cycles(count):
        next_cycle = time.monotonic()
        for _ in range(count):
            master.send_processdata()
            master.receive_processdata(wire.PAUSE_US)
            next_cycle += 0.001
            time.sleep(max(0.0, next_cycle - time.monotonic()))

    for slave in master.slaves:
        slave.output = bytes(len(slave.output))
    cycles(300)
    master.state = pysoem.OP_STATE
    master.write_state()
    for _ in range(50):
        cycles(10)
        if master.state_check(pysoem.OP_STATE, 1_000) == pysoem.OP_STATE:
            break
    master.read_state()
    wire.check(drive.state == pysoem.OP_STATE, f"Op not reached: {drive.state:#x}, AL status {drive.al_status:#x}")
    cycles(3000)
    difference = read(DIFFERENCE, 4) & 0x7FFFFFFF
    wire.check(difference <= TOLERANCE_NS, f"the clock is {difference} ns away")
    wire.check(read(ACTIVATION_STATUS, 1) == 0, "SYNC0 is still to come")
    first = read(SYNC0_START, 8)
    cycles(100)
    passed = read(SYNC0_START, 8) - first
    wire.check(passed % CYCLE_NS == 0 and passed >= 90 * CYCLE_NS, f"SYNC0 went on by {passed} ns")
    wire.check((first - 400_000) % CYCLE_NS == 0, f"SYNC0 at {first}")
    master.read_state()
    wire.check(drive.state == pysoem.OP_STATE, f"the drive left Op: {drive.state:#x}, {drive.al_status:#x}")
    master.state = pysoem.INIT_STATE
    master.write_state()
    master.close()
    print(f"pysoem: config_dc, dc_sync, Op by SYNC0, {difference} ns from the reference")


def check_pysoem(cm1e, python, folder):
    with wire.segment(cm1e, write_network(folder, "sim")) as segment:
        segment.console("clock 2 drift 50")
        result = segment.run([python, os.path.abspath(__file__), "--master"])
    print(result.stdout + result.stderr, end="")
    wire.check(result.returncode == 0, f"the master ended with {result.returncode}")


def main(cm1e, python):
    import tempfile
    wire.become_root()
    with tempfile.TemporaryDirectory() as folder:
        check_own_master(cm1e, folder)
        check_pysoem(cm1e, python, folder)


if __name__ == "__main__":
    if sys.argv[1] == "--master":
        run_master()
    else:
        main(*sys.argv[1:])
