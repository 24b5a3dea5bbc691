#!/usr/bin/env python3
"""The simulated Cool MUSCLE Bridge over a veth pair: `cm1e scan` finds it, and pysoem, a master that is not ours, scans
it, reads and writes its objects, and runs it with 24 + 24 bytes as the guide's flows say: four motors to Operation
enabled, csp, homing by hm, digital signals, a CML query, the status objects, ways between modes that there are not. A
second master is killed while its motors turn, and the watchdog of the bridge frees them.

test_bridge.py CM1E PYTHON: starts the segment and runs itself with --master or --killed in the master's namespace.
"""
import json
import os
import re
import signal
import struct
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

VENDOR, PRODUCT = 0x0000AA77, 0x0000EB12
AXES = range(4)
MODE_NAMES = {6: "hm", 8: "csp", 101: "CML", 120: "CMD", 121: "CPIO"}
HM, CSP, CML, CMD, CPIO = MODE_NAMES
# Controlwords of BR 6.1.2 and the states of BR 6.1.3, by the bits that count.
SHUT_DOWN, SWITCH_ON, ENABLE_OPERATION, START_HOMING = 0x06, 0x07, 0x0F, 0x1F
STATE_BITS, SWITCH_ON_DISABLED, READY, SWITCHED_ON, ENABLED = 0x4F, 0x40, 0x01, 0x03, 0x07
FOLLOWS, MOTOR_ERROR, MOTOR_FREE = 0x1000, 0x4000, 0x8000
REACHED, ATTAINED, HOMING_ERROR = 0x0400, 0x1000, 0x2000
# The watchdog's 100 ms, and pauses of a loaded machine.
LATEST_S = 1.0


def number(slave, index, sub=0):
    return int.from_bytes(slave.sdo_read(index, sub), "little")


def check_abort(pysoem, code, access, what):
    try:
        access()
    except pysoem.SdoError as error:
        wire.check(error.abort_code == code, f"{what}: abort {error.abort_code:08X}, expected {code:08X}")
    else:
        wire.check(False, f"{what}: no abort, expected {code:08X}")


class Master:
    """One slave, a cycle of 1 ms, and what goes to each axis: controlword and target position."""

    def __init__(self, pysoem):
        self.pysoem = pysoem
        self.master = pysoem.Master()
        self.master.open(wire.MASTER_INTERFACE)
        found = self.master.config_init()
        wire.check(found == 1, f"{found} slaves found, one bridge expected")
        self.slave = self.master.slaves[0]
        self.words, self.targets = [0] * 4, [0] * 4
        self.status, self.position = [0] * 4, [0] * 4
        self.bad_cycles = self.cycles_run = 0
        self.next_cycle = 0.0

    def exchange(self):
        self.slave.output = b"".join(struct.pack("<Hi", *pair) for pair in zip(self.words, self.targets))
        self.master.send_processdata()
        good = self.master.receive_processdata(wire.PAUSE_US) == self.master.expected_wkc
        if good:
            self.status, self.position = map(list, zip(*struct.iter_unpack("<Hi", self.slave.input)))
        return good

    def cycles(self, count, each=None):
        """`each` gets the number of the cycle, from 1 on, before it is sent."""
        self.next_cycle = max(self.next_cycle, time.monotonic())
        for n in range(count):
            if each:
                each(n + 1)
            self.bad_cycles += not self.exchange()
            self.cycles_run += 1
            self.next_cycle += 0.001
            time.sleep(max(0.0, self.next_cycle - time.monotonic()))

    def wait(self, condition, seconds, what):
        for _ in range(int(seconds * 200)):
            if condition():
                return
            self.cycles(5)
        status = ", ".join(f"{word:#06x}" for word in self.status)
        wire.check(condition(), f"{what}; statuswords {status}, positions {self.position}")

    def start(self):
        self.master.config_map()
        sizes = len(self.slave.output), len(self.slave.input)
        wire.check(sizes == (24, 24), f"{sizes[0]} + {sizes[1]} bytes of process data, 24 + 24 expected (BR 6.3.1)")
        safe_op, op = self.pysoem.SAFEOP_STATE, self.pysoem.OP_STATE
        wire.check(self.master.state_check(safe_op, 1_000_000) == safe_op, "Safe-Operational not reached")
        self.exchange()
        self.master.state = op
        self.master.write_state()
        for _ in range(500):
            self.exchange()
            if self.master.state_check(op, 1_000) == op:
                return
        wire.check(False, f"Operational not reached: AL status code {self.slave.al_status:#x}")

    def stop(self):
        self.master.state = self.pysoem.INIT_STATE
        self.master.write_state()
        self.master.close()

    # -- one axis; `axis` counts from 0

    def read(self, axis, index, sub=0):
        return number(self.slave, index + 0x800 * axis, sub)

    def write(self, axis, index, sub, form, value):
        self.slave.sdo_write(index + 0x800 * axis, sub, struct.pack(form, value))

    def request_mode(self, axis, mode):
        self.cycles(6)
        self.write(axis, 0x6060, 0, "<b", mode)
        self.cycles(6)
        return self.read(axis, 0x6061)

    def switch(self, axis, mode):
        """The flows of BR appendix 3. A motor that creeps into its position is not in position yet: once more then."""
        for _ in range(20):
            shown = self.request_mode(axis, mode)
            if shown == mode:
                return
        wire.check(False, f"axis {axis}: 0x6061 shows {MODE_NAMES.get(shown, shown)} after a switch to "
                   f"{MODE_NAMES[mode]}")

    def refuses(self, axis, mode, why):
        before = self.read(axis, 0x6061)
        shown = self.request_mode(axis, mode)
        wire.check(shown == before, f"axis {axis}: {why}: the way from {MODE_NAMES[before]} to {MODE_NAMES[mode]} "
                   f"led to {MODE_NAMES.get(shown, shown)}")

    # -- all axes

    def enable(self):
        """BR 6.1: one state after the other, targets where the motors are. Nothing may move."""
        self.cycles(5)
        begin, self.targets = list(self.position), list(self.position)
        for word, state in ((SHUT_DOWN, READY), (SWITCH_ON, SWITCHED_ON), (ENABLE_OPERATION, ENABLED)):
            self.words = [word] * 4
            self.wait(lambda state=state: all(status & STATE_BITS == state for status in self.status), 0.5,
                      f"controlword {word:#04x}: not all motors are in state {state:#04x}")
        self.cycles(20)
        for axis in AXES:
            wire.check(not self.status[axis] & (MOTOR_FREE | MOTOR_ERROR), f"axis {axis}: enabled, but the statusword "
                       f"is {self.status[axis]:#06x}")
            wire.check(abs(self.position[axis] - begin[axis]) <= 2,
                       f"axis {axis}: moved from {begin[axis]} to {self.position[axis]} by enabling")

    def disable(self):
        self.words = [SHUT_DOWN] * 4
        self.cycles(10)
        self.words = [0] * 4
        self.wait(lambda: all(status & STATE_BITS == SWITCH_ON_DISABLED and status & MOTOR_FREE
                              for status in self.status), 0.5, "not all motors are free after Disable voltage")

    def move(self, cycles, speeds, halfway=None):
        """csp, each axis by a speed of its own, counts a cycle; then the motors stand at their targets."""
        start = list(self.targets)

        def target(n):
            self.targets = [start[axis] + speeds[axis] * n for axis in AXES]
            if halfway and n == cycles // 2:
                halfway()
        self.cycles(cycles, target)
        self.cycles(50)
        for axis in AXES:
            wire.check(self.status[axis] & (STATE_BITS | FOLLOWS) == ENABLED | FOLLOWS,
                       f"axis {axis}: statusword {self.status[axis]:#06x} after the move")
            wire.check(abs(self.position[axis] - self.targets[axis]) <= 20,
                       f"axis {axis}: at {self.position[axis]}, its target is {self.targets[axis]}")


def check_objects(pysoem, slave):
    name = slave.sdo_read(0x1008, 0).rstrip(b"\0")
    wire.check(name == b"EB12", f"0x1008 is {name}")
    wire.check(number(slave, 0xF000, 1) == 0x800, "0xF000:1 is not 0x800")
    for axis in AXES:
        offset = 0x800 * axis
        wire.check(number(slave, 0xF050, axis + 1) == 0x219800, f"0xF050:{axis + 1} is not 0x219800")
        wire.check(number(slave, 0xF511 + axis, 1) == (1 if axis < 2 else 2), f"{0xF511 + axis:#x}:1: kind of motor")
        slave.sdo_write(0x6099 + offset, 1, struct.pack("<I", 200 + axis))
        wire.check(number(slave, 0x60F6 + offset, 42 - 20) == 200 + axis, f"axis {axis}: K42 is not the homing speed")
        check_abort(pysoem, 0x06010000, lambda o=offset: slave.sdo_read(0x606C + o, 0), f"axis {axis}: an N/A object")
        check_abort(pysoem, 0x06090011, lambda o=offset: slave.sdo_read(0x60F6 + o, 99 - 20),
                    f"axis {axis}: K99, which no motor has")
        check_abort(pysoem, 0x06010002, lambda o=offset: slave.sdo_write(0x6041 + o, 0, b"\0\0"),
                    f"axis {axis}: writing the statusword")


def check_homing(bus):
    """The flows of BR appendix 4, each axis with a method of its own: stopper CW, CCW, switch CW, CCW."""
    for axis in AXES:
        bus.switch(axis, HM)
        bus.write(axis, 0x6098, 0, "<B", axis + 1)
        bus.write(axis, 0x6099, 1, "<I", 5000)
        bus.write(axis, 0x6099, 2, "<I", 5000)
        bus.write(axis, 0x609A, 0, "<I", 5000)
    bus.cycles(100)
    bus.words = [START_HOMING] * 4
    bus.cycles(20)
    for axis in AXES:
        wire.check(not bus.status[axis] & (REACHED | ATTAINED | HOMING_ERROR),
                   f"axis {axis}: statusword {bus.status[axis]:#06x} while the motor is searching")
    bus.wait(lambda: all(word & (ATTAINED | HOMING_ERROR) for word in bus.status), 8.0, "homing does not end")
    for axis in AXES:
        wire.check(bus.status[axis] & (REACHED | ATTAINED | HOMING_ERROR) == REACHED | ATTAINED,
                   f"axis {axis}: homing ended with the statusword {bus.status[axis]:#06x}")
        wire.check(abs(bus.position[axis]) <= 20, f"axis {axis}: at {bus.position[axis]} after homing, 0 expected")
    bus.words = [ENABLE_OPERATION] * 4
    bus.targets = list(bus.position)
    for axis in AXES:
        bus.refuses(axis, CML, "from hm only csp is reached (BR 6)")
        bus.switch(axis, CSP)
    # A reference found by a switch is its flank, where a count decides: a little further on the switch is closed.
    for _ in range(20):
        bus.targets = [target + (-5 if axis % 2 else 5) for axis, target in enumerate(bus.targets)]
        bus.cycles(1)
    bus.cycles(50)


def check_signals(bus):
    """BR 6.5: by SDO, in csp, while the motor is enabled. A CM1 has neither input 1 nor output 1."""
    for axis in AXES:
        bus.write(axis, 0x60FE, 2, "<I", 0x0F)
        bus.write(axis, 0x60FE, 1, "<I", 0x03)
        bus.cycles(5)
        shown, expected = bus.read(axis, 0x60FE, 1) & 0x0F, 0x02 if axis < 2 else 0x03
        wire.check(shown & 0x02 == 0x02 and (axis < 2 or shown == expected), f"axis {axis}: outputs {shown:#x}")
        bus.write(axis, 0x60FE, 1, "<I", 0)
        # Methods 1 and 3 end on the CW side, where input 2 is; 2 and 4 on the CCW side, where input 3 is.
        inputs = bus.read(axis, 0x60FD)
        wire.check(inputs == (0x02, 0x04)[axis % 2], f"axis {axis}: inputs {inputs:#x} beyond its reference")


def check_cml(bus):
    """BR appendix 2.1 and 2.3: 0000h for five cycles, the string, an answer, then none. The others stand enabled."""
    bus.words[1] = 0
    bus.switch(1, CML)
    for text, answer in ((b"?99.2", b"Ux.2=16\r\n"), (b"K42.2", b"K42.2=5000\r\n")):
        bus.cycles(8)
        bus.slave.sdo_write(0xF582, 0, text)
        answers = []

        def answered():
            answers.append(bus.slave.sdo_read(0xF592, 0))
            return answers[-1] != b"Null\r\n"
        bus.wait(answered, 0.5, f"no answer to {text}")
        wire.check(answers[-1] == answer, f"{text}: answers {answers}, {answer} expected")
        wire.check(bus.slave.sdo_read(0xF592, 0) == b"Null\r\n", f"the answer to {text} came twice")
    bus.refuses(1, HM, "hm is reached from csp only (BR 6)")
    bus.switch(1, CSP)
    wire.check(all(bus.status[axis] & STATE_BITS == ENABLED for axis in (0, 2, 3)),
               "another axis lost its power by a CML query")


def check_status(bus):
    """F530 (BR 7.4), all 24."""
    slave = bus.slave
    wire.check(number(slave, 0xF530) == 24, f"F530 has {number(slave, 0xF530)} entries")
    values = [number(slave, 0xF530, sub) for sub in range(1, 25)]
    wire.check(values[0:4] == [0] * 4, f"receive errors of the serial lines: {values[0:4]}")
    wire.check(values[4:8] == [0x10] * 4, f"the motors are free, but F530:5 ... 8 say {values[4:8]}")
    wire.check(min(values[8:16]) > 1000, f"the counters of the serial lines stand: {values[8:16]}")


def check_dead_ends(bus):
    """The drawing of BR 6, with the motors free."""
    bus.switch(2, CMD)
    bus.switch(3, CPIO)
    for axis in (2, 3):
        bus.refuses(axis, CSP, "there is no way back but power-off (BR 6)")
        bus.refuses(axis, HM, "hm is reached from csp only (BR 6)")
    bus.switch(0, HM)
    bus.write(0, 0x6060, 0, "<b", 3)
    bus.cycles(10)
    wire.check(bus.read(0, 0x6061) == CSP, "a mode that there is not does not lead to csp (BR 6.2.2 note 3)")


def run_master():
    import pysoem
    bus = Master(pysoem)
    slave = bus.slave
    wire.check((slave.man, slave.id) == (VENDOR, PRODUCT), f"identity {slave.man:08X} {slave.id:08X}")
    wire.wait_for(lambda: (bus.master.read_state(), slave.state == pysoem.PREOP_STATE)[1], 2.0,
                  "Pre-Operational not reached")
    check_objects(pysoem, slave)
    bus.start()
    bus.enable()
    bus.move(300, [20, -30, 40, -50], halfway=lambda: bus.write(0, 0x6060, 0, "<b", HM))
    wire.check(bus.read(0, 0x6061) == CSP, "axis 0: the mode was switched in motion (BR 6.2.2 note 1)")
    check_homing(bus)
    check_signals(bus)
    bus.move(200, [-40, 30, -20, 10])
    check_cml(bus)
    bus.disable()
    wire.check(bus.read(0, 0x60FD) == 0, "axis 0: inputs are shown of a motor that is not enabled (BR 6.5)")
    check_status(bus)
    check_dead_ends(bus)
    wire.check(bus.bad_cycles == 0, f"{bus.bad_cycles} of {bus.cycles_run} cycles had a wrong working counter")
    bus.master.read_state()
    wire.check(slave.state == pysoem.OP_STATE, f"Op left: {slave.state:#x}, AL status code {slave.al_status:#x}")
    print(f"pysoem: identity, objects with their aborts, 24 + 24 bytes, {bus.cycles_run} good cycles; four axes "
          "enabled, moved and homed; signals, a CML query, F530, dead ends")
    bus.stop()


def run_until_killed():
    """Three motors turn in csp, the fourth searches its origin; then this process is no more."""
    import pysoem
    bus = Master(pysoem)
    bus.start()
    bus.enable()
    bus.switch(3, HM)
    bus.write(3, 0x6098, 0, "<B", 1)
    bus.write(3, 0x6099, 1, "<I", 100)
    bus.write(3, 0x6099, 2, "<I", 100)
    bus.cycles(100)
    bus.words[3] = START_HOMING

    def target(n):
        bus.targets[:3] = [bus.targets[axis] + 20 * (axis + 1) for axis in range(3)]
        if n == 300:
            os.kill(os.getpid(), signal.SIGKILL)
    bus.cycles(400, target)


def positions(line):
    return [int(word) for word in re.findall(r"position (-?\d+)", line)]


def kill_master(segment, python):
    begin = positions(segment.console("status 1"))
    command = segment.command([python, os.path.abspath(__file__), "--killed"])
    master = subprocess.run(command, capture_output=True, text=True, timeout=60)
    wire.check(master.returncode == -signal.SIGKILL, f"the master to be killed ended with {master.returncode}: "
               f"{master.stdout}{master.stderr}")
    wire.wait_for(lambda: segment.console("status 1").count("motor 0x10") == 4, LATEST_S,
                  f"not all motors are free after the master is gone: {segment.console('status 1')}")
    free = segment.console("status 1")
    wire.check("SAFEOP" in free and "enabled" not in free, f"the watchdog left {free}")
    time.sleep(0.3)
    first = positions(segment.console("status 1"))
    time.sleep(0.1)
    last = positions(segment.console("status 1"))
    wire.check(first == last, f"motors move on without a master: {first}, then {last}")
    wire.check(all(abs(end - start) > 1000 for start, end in zip(begin, last)),
               f"not all motors had been moving: from {begin} to {last}")
    print(f"killed master: {free}")


def check_words(segment, cm1e):
    """`cm1e status` of a bridge with two motors in dead ends, one without its cable, and one in overload."""
    segment.console("motor 1 2 unplug")
    segment.console("motor 1 4 error overload")
    time.sleep(0.1)
    result = segment.run([cm1e, "status", "-i", wire.MASTER_INTERFACE, "--json"])
    wire.check(result.returncode == 0, f"cm1e status: {result.stdout}{result.stderr}")
    motors = json.loads(result.stdout)[0]["motors"]
    modes = [motor["mode_name"] for motor in motors]
    wire.check("CMD" in modes and "CPIO" in modes, f"cm1e status: modes {modes}")
    for motor in motors:
        wire.check((motor["state"] == "none in CMD mode") == (motor["mode_name"] == "CMD"), f"cm1e status: {motor}")
        wire.check(motor["state"] != "unknown state", f"cm1e status: {motor}")
    for motor, words, cure in ((motors[1], "serial communication error", "cable"), (motors[3], "overload", "load")):
        wire.check(motor["status_text"] == words and cure in motor["what_to_do"], f"cm1e status: {motor}")
    wire.check(motors[1]["receive_errors"] > 50 and motors[1]["sent"] - motors[1]["received"] > 50,
               f"cm1e status: {motors[1]}")
    wire.check(motors[0]["bits_per_second"] == 176800 and motors[0]["receive_errors"] == 0,
               f"cm1e status: {motors[0]}")
    text = segment.run([cm1e, "status", "-i", wire.MASTER_INTERFACE]).stdout
    for words in ("0x0F serial communication error", "what to do       check the cable", "only power-off leads back"):
        wire.check(words in text, f"cm1e status lacks \"{words}\":\n{text}")
    segment.console("motor 1 2 replug")


BUS = """\
bus: {{interface: {interface}, lost_cycles_limit: 50}}
axes:
  - {{name: left, position: 1, channel: 1, k37: 10}}
  - {{name: right, position: 1, channel: 4, k37: 10}}
"""


def check_refusals(segment, cm1e):
    """What refuses a motor with an error says which error it is."""
    path = os.path.join(segment.folder, "bridge.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(BUS.format(interface=wire.MASTER_INTERFACE))
    segment.console("motor 1 4 error overload")
    segment.console("motor 1 1 unplug")
    time.sleep(0.1)
    for axis, says, words in (("right", "The motor (CM2) says: overload", ["move", "--by", "0.1"]),
                              ("left", "The motor (CM1) says: serial communication error", ["move", "--by", "0.1"]),
                              ("left", "its status is: serial communication error", ["cml", "?99.1", "--axis"])):
        result = segment.run([cm1e, *words, axis, "-b", path])
        wire.check(result.returncode == 1 and says in result.stderr, f"cm1e {words[0]} {axis}: {result.stderr}")
    segment.console("motor 1 1 replug")
    for axis in ("left", "right"):
        result = segment.run([cm1e, "move", axis, "-b", path, "--by", "0.1", "--reset"])
        wire.check(result.returncode == 0, f"cm1e move --reset {axis}: {result.stderr}")


def main(cm1e, python):
    with wire.segment(cm1e, "--bridge", "eb12") as segment:
        found = segment.run([cm1e, "scan", "-i", wire.MASTER_INTERFACE])
        wire.check(found.returncode == 0 and "bridge EB12, motors CM1, CM1, CM2, CM2" in found.stdout,
                   f"cm1e scan: {found.stdout}{found.stderr}")
        print(found.stdout, end="")
        result = segment.run([python, os.path.abspath(__file__), "--master"])
        print(result.stdout + result.stderr, end="")
        wire.check(result.returncode == 0, f"the master ended with {result.returncode}; {segment.console('status 1')}")
        check_words(segment, cm1e)
        segment.console("power-cycle 1 100")  # two motors are in modes from which nothing else leads to csp
        time.sleep(0.3)
        check_refusals(segment, cm1e)
        segment.console("power-cycle 1 100")
        time.sleep(0.3)
        kill_master(segment, python)


if __name__ == "__main__":
    if sys.argv[1] == "--master":
        run_master()
    elif sys.argv[1] == "--killed":
        run_until_killed()
    else:
        main(*sys.argv[1:])
