#!/usr/bin/env python3
"""What goes wrong for whoever uses cm1e for the first time: each time the command says what the cause is and what to do.
Another master, an address on the interface, NetworkManager and a wireless interface are in test_two_masters.py and
test_doctor.py, here and in tests/command.

test_first_errors.py CM1E
"""
import os
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402

IF = wire.MASTER_INTERFACE
LINK = ["ip", "link", "set"]
NOBODY = ["setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", "--inh-caps=-all"]
DOCKER = [*NOBODY, "--bounding-set=-sys_nice,-ipc_lock"]  # its default, and a user that is not root
CONTAINER = ["setpriv", "--inh-caps=-all", "--bounding-set=-net_raw"]  # root without the capability
BUS_FILE = f"""\
bus: {{interface: {IF}}}
axes:
  - name: X
    position: 1
    motor: CM1-E-17S30D
    limits: {{velocity: 10}}
"""
MOVE = ["move", "-i", IF, "1", "--by", "0.2", "--velocity", "1"]


def must_tell(segment, name, command, status, *words):
    done = segment.run(command)
    text = done.stdout + done.stderr
    print(f"{name}: {text.strip()}")
    wire.check(done.returncode == status, f"{name}: exit status {done.returncode}, {status} expected: {text}")
    for word in words:
        wire.check(word in text, f"{name}: the text does not have \"{word}\": {text}")


def set_link(namespace, *words):
    done = subprocess.run(wire.enter(namespace, [*LINK, *words]), capture_output=True, text=True)
    wire.check(done.returncode == 0, f"{words}: {done.stderr}")


def wrong_interface(segment, cm1e):
    for command in (["scan", "-i", "eth9"], ["move", "-i", "eth9", "1", "--by", "1"], ["status", "-i", "eth9"]):
        must_tell(segment, "no such interface", [cm1e, *command], 1, '"eth9"', f"There are: {IF}")
    for command in (["scan", "-i", IF], MOVE):
        must_tell(segment, "no right", [*NOBODY, cm1e, *command], 1, "CAP_NET_RAW", "sudo setcap cap_net_raw", cm1e)
    must_tell(segment, "container", [*CONTAINER, cm1e, "scan", "-i", IF], 1, "Not even root has cap_net_raw ", "--cap-add NET_RAW")
    must_tell(segment, "Docker", [*DOCKER, cm1e, "scan", "-i", IF], 1, f"sudo setcap cap_net_raw+ep {cm1e}")
    must_tell(segment, "no Ethernet", [cm1e, "scan", "-i", "lo"], 1, "is not Ethernet")
    must_tell(segment, "served sim", [cm1e, "sim", "-i", "sim"], 2, "on a network interface")


def no_link(segment, cm1e):
    # Each time at once: the flags of an interface follow its link after up to a second, the driver knows.
    for command in (["scan", "-i", IF], ["status", "-i", IF], MOVE):
        set_link(segment.slave, wire.SLAVE_INTERFACE, "down")
        must_tell(segment, "cable out", [cm1e, *command], 1, "the interface has no link", "Plug the cable", "power")
        set_link(segment.slave, wire.SLAVE_INTERFACE, "up")
        wire.wait_for(lambda: segment.run([cm1e, "scan", "-i", IF]).returncode == 0, 10, "no slave answers with the cable in")
    set_link(segment.master, IF, "down")
    must_tell(segment, "interface down", [cm1e, "scan", "-i", IF], 1, "is down", f"sudo ip link set {IF} up")
    set_link(segment.master, IF, "up")
    wire.wait_for(lambda: segment.run([cm1e, "scan", "-i", IF]).returncode == 0, 10, "no slave answers with the interface up")


def motor(segment, cm1e):
    """From a bus file that lets lost frames pass: they are another error, which would be the first one."""
    bus = ["-b", segment.bus_file()]
    move = ["move", *bus, "X", "--by", "0.2", "--velocity", "1"]
    segment.console("power 1 off")
    for command, status in ((move, 1), (["enable", *bus, "--for", "0.2"], 1), (["status", "-i", IF], 0)):
        must_tell(segment, "no motor power", [cm1e, *command], status, "motor power")
    segment.console("power 1 on")
    segment.console("error 1 7510")
    for command, status in ((move, 1), (["status", "-i", IF], 0), (["reset", *bus], 0)):
        must_tell(segment, "device in fault", [cm1e, *command], status, "0x7510", "communication error", "reset the fault")
    must_tell(segment, "ready again", [cm1e, *move], 0, "move done")


def frames_lost(segment, cm1e):
    """More than the cycles that ran over: it is the network, whatever the machine did besides."""
    running = subprocess.Popen(segment.command([cm1e, "move", "-b", segment.bus_file(), "X", "--speed", "1", "--for", "60"]),
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    wire.wait_for(lambda: segment.run([cm1e, "status", "--attach", str(running.pid)]).returncode == 0, 20, "no run")
    segment.console("lose 300")
    told = running.communicate(timeout=60)[1]
    print(f"frames lost: {told.strip()}")
    wire.check(running.returncode == 1 and "frames are lost" in told and "advice: look at cables" in told, told)
    wire.wait_for(lambda: segment.run([cm1e, "scan", "-i", IF]).returncode == 0, 20, "frames are lost for ever")


def bus_file(segment, cm1e):
    path = os.path.join(segment.folder, "machine.yaml")
    cases = [("wrong key", "velocity: 10", "velocty: 10", "X", 2, 'did you mean', "machine.yaml:6:"),
             ("wrong value", "velocity: 10", "velocity: fast", "X", 2, "machine.yaml:6:", "fast"),
             ("wrong firmware", "motor:", "firmware: 1.2.0\n    motor:", "X", 1, "expects firmware 1.2.0", '"1.3.5"'),
             ("wrong position", "position: 1", "position: 2", "X", 1, "at position 2", "Found 1 slave"),
             ("wrong interface", IF, "eth9", "X", 1, '"eth9"', f"There are: {IF}"),
             ("wrong axis", "", "", "Y", 2, 'no axis "Y"', ": X")]
    for name, old, new, axis, status, *words in cases:
        with open(path, "w", encoding="utf-8") as file:
            file.write(BUS_FILE.replace(old, new, 1) if old else BUS_FILE)
        must_tell(segment, name, [cm1e, "move", "-b", path, axis, "--by", "1"], status, *words)
        if name in ("wrong firmware", "wrong position"):
            must_tell(segment, name, [cm1e, "status", "-b", path], 0, "slave 1", "not as the bus file says", *words)
    must_tell(segment, "no file", [cm1e, "move", "-b", "nowhere.yaml", "X", "--by", "1"], 2, "nowhere.yaml", "No such file")


def main():
    cm1e = os.path.abspath(sys.argv[1])
    with wire.segment(cm1e) as segment:
        wrong_interface(segment, cm1e)
        no_link(segment, cm1e)
        motor(segment, cm1e)
        frames_lost(segment, cm1e)
        bus_file(segment, cm1e)


main()
