#!/usr/bin/env python3
"""Slaves that come and go over a veth pair, while a motor turns at 1 ms and at 250 us: a group that comes by itself, a
motor that waits until `cm1e recover` asks for it, a stranger. The other slaves lose no cycle: every frame comes back
with the working counter of those that are there. `cm1e status` and `cm1e recover` tell what is absent, waits or
is refused.

test_wire_hot_connect.py CM1E
"""
import json
import os
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [HERE, os.path.join(HERE, "..", "support")]
import wire  # noqa: E402
from control_client import Client, Program  # noqa: E402

LIFT, CHANGER, FINGERS, GUEST = 3, 4, 5, 6
FIXED = """\
axes:
  - {name: X, position: 1}
  - {name: Y, position: 2}
  - {name: lift, explicit_id: 7, optional: true, recover: ask, sim: {absent: true}}
slaves:
  - {name: changer, alias: 4711, hot_connect: gripper, vendor: 0x00000002, product: 0x044D2C52,
     sim: {device: coupler, absent: true}}
  - {name: fingers, position: 2, hot_connect: gripper, vendor: 0x00000002, product: 0x03F03052,
     sim: {device: digital, inputs: 4, outputs: 4, absent: true}}
"""
# Of the segment only: the master does not expect it.
GUEST_ENTRY = """\
  - {name: guest, alias: 99, optional: true, vendor: 0x00000002, product: 0x03F03052,
     sim: {device: digital, inputs: 4, outputs: 4, absent: true}}
"""


def write(segment, name, text):
    path = os.path.join(segment.folder, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def bus_file(segment, cycle_time_us, control="maintain"):
    return write(segment, f"hot_{cycle_time_us}_{control}.yaml", f"bus:\n  interface: {wire.MASTER_INTERFACE}\n"
                 f"  cycle_time_us: {cycle_time_us}\n  frame_timeout_us: {cycle_time_us}\n  control: {control}\n"
                 f"  lost_cycles_limit: {wire.PAUSE_US // cycle_time_us}\n{FIXED}")


class Turning(Program):
    """Axis X turns over the wire, at full rate."""

    def __init__(self, cm1e, segment, path):
        self.segment, self.cm1e = segment, cm1e
        self.environment = {**os.environ, "CM1E_RUNTIME_DIR": os.path.join(segment.folder, "run")}
        command = [cm1e, "move", "-b", path, "X", "--speed", str(self.SPEED), "--for", "120"]
        self.process = subprocess.Popen(segment.command(command), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                        text=True, env=self.environment)
        self.pid = self.process.pid
        self.path = os.path.join(self.environment["CM1E_RUNTIME_DIR"], f"cm1e-{self.pid}-0.sock")
        try:
            wire.wait_for(self.listens, 20, "no control socket")
            wire.wait_for(self.moves, 10, "the axis does not move")
        except FileNotFoundError:
            wire.check(False, f"the run has ended: {self.end()}")

    def attached(self, *words):
        """In the namespace of the program, where the kernel lists its socket."""
        return self.segment.run([self.cm1e, *words, "--attach", str(self.pid)])

    def bus(self):
        with Client(self) as client:
            return client.ask("statistics")["statistics"]["bus"]

    def presence(self, position):
        """0: it takes part."""
        with Client(self) as client:
            return client.ask("slaves")["slaves"][position - 1].get("presence", 0)

    def becomes(self, position, presence, seconds=20):
        wire.wait_for(lambda: self.presence(position) == presence, seconds,
                      f"slave {position} is {self.presence(position)}, not {presence}")


ABSENT, WAITS = 1, 2


def attached(program, *words, good=True):
    told = program.attached(*words)
    wire.check((told.returncode == 0) == good, f"{words}: {told}")
    return told.stdout + told.stderr


def check_refusals(program):
    """Everybody takes part, or is absent: nobody waits, and each refusal says why."""
    told = attached(program, "recover", "changer", good=False)
    wire.check("optional and absent: no device with alias 4711" in told, f"recover of an absent slave: {told}")
    told = attached(program, "recover", "X", good=False)
    wire.check("takes part already" in told, f"recover of a slave that takes part: {told}")
    told = attached(program, "recover", "nobody", good=False)
    wire.check("name of a slave or of an axis" in told, f"recover of an unknown name: {told}")
    told = attached(program, "recover", "99", good=False)
    wire.check("1 ... 5" in told, f"recover of slave 99: {told}")


def check_lift(segment, program):
    """It waits, is listed, and comes when somebody asks; it leaves, and is absent again."""
    segment.console(f"attach {LIFT}")
    program.becomes(LIFT, WAITS)
    told = attached(program, "recover")
    wire.check('waits: Slave 3 ("lift", CM1-E) answers and waits' in told and told.count("absent: Slave") == 2,
               f"recover without a slave: {told}")
    rows = json.loads(attached(program, "recover", "--json"))
    wire.check([row["presence"] for row in rows] == ["waits", "absent", "absent"], f"recover --json: {rows}")
    told = attached(program, "recover", "lift")
    wire.check("slave 3: Operational again" in told, f"recover lift: {told}")
    with Client(program) as client:
        lift = client.ask("axes")["axes"][2]
    wire.check(lift["online"] and not lift["powered"], f"the axis after its return: {lift}")
    segment.console(f"detach {LIFT}")
    program.becomes(LIFT, ABSENT)


def check_gripper(segment, program):
    for position in (CHANGER, FINGERS):
        segment.console(f"attach {position}")
    program.becomes(FINGERS, 0)
    program.becomes(CHANGER, 0)
    for position in (CHANGER, FINGERS):
        segment.console(f"detach {position}")
    program.becomes(FINGERS, ABSENT)


def check_stranger(segment, program):
    segment.console(f"attach {GUEST}")
    stranger = "stranger: A device at place 3 of the wire was refused: vendor 0x00000002, product 0x03F03052, alias 99"
    wire.wait_for(lambda: stranger in program.attached("status").stdout, 20, "status does not tell the stranger")
    row = json.loads(attached(program, "status", "--json"))[-1]
    wire.check(row["stranger"] and row["place"] == 3 and row["product_code"] == 0x03F03052, f"status --json: {row}")
    segment.console(f"detach {GUEST}")
    wire.wait_for(lambda: "stranger" not in program.attached("status").stdout, 20, "the stranger is still told")


def check_cycle(segment, cm1e, cycle_time_us):
    program = Turning(cm1e, segment, bus_file(segment, cycle_time_us))
    before = program.bus()
    check_refusals(program)
    for check in (check_lift, check_gripper, check_stranger, check_lift):
        check(segment, program)
        wire.wait_for(program.moves, 10, f"{cycle_time_us} us: {check.__name__}: axis X was disturbed")
    after = program.bus()
    more = {name: after[name] - before[name] for name in before}
    # A frame that comes back late was lost to a pause of the machine, not to a plug.
    wire.check(more["working_counter_errors"] == 0 and more["lost_frames"] <= more["late_frames"],
               f"{cycle_time_us} us: the others lost cycles: {more}")
    said = program.end()
    wire.check("ErrorStop" not in said, f"the run ended with an error: {said}")
    print(f"{cycle_time_us} us: {more['cycles']} cycles, none lost but {more['late_frames']} by pauses of the machine")


def check_observed(segment, cm1e):
    """A program that lets others look only refuses, and says what it needs."""
    program = Turning(cm1e, segment, bus_file(segment, 1000, "observe"))
    told = attached(program, "recover", "lift", good=False)
    wire.check("control: maintain" in told, f"recover where others may only look: {told}")
    wire.check("absent" in attached(program, "recover"), "the list is for everybody")
    program.end()


def main(cm1e):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "segment.yaml")
        with open(path, "w", encoding="utf-8") as file:
            file.write(FIXED.replace("Y, position: 2", "Y, position: 2, sim: {no_stops: true}")
                       .replace("X, position: 1", "X, position: 1, sim: {no_stops: true}") + GUEST_ENTRY)
        with wire.segment(cm1e, path) as segment:
            for cycle_time_us in (1000, 250):
                check_cycle(segment, cm1e, cycle_time_us)
            check_observed(segment, cm1e)


if __name__ == "__main__":
    main(sys.argv[1])
