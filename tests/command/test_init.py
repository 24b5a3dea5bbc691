#!/usr/bin/env python3
"""`cm1e init` on simulated segments: the file that it writes names every motor, loads, and drives at once, as it is and
with its commented keys; what it cannot know is a comment; a file that exists is not written over.

test_init.py BIN-DIRECTORY
"""
import json
import os
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import real_time  # noqa: E402

CM1E = os.path.join(sys.argv[1], "cm1e")

MOTORS = """\
axes:
  - {name: a, position: 1, motor: CM1-E-17S30D}
  - {name: b, alias: 1001, motor: CM1-E-17L30D, firmware: 1.3.3}
  - {name: c, explicit_id: 181, motor: CM1-E-23S30D}
  - {name: d, position: 5, motor: CM1-E-23L20D, firmware: 1.2.0}
"""
BRIDGE = """\
axes:
  - {name: x, position: 1}
  - {name: left, position: 2, channel: 1, motor: CM1, k37: 10}
  - {name: lift, position: 2, channel: 3, motor: CM2, k37: 3}
"""
SERVO = """\
axes:
  - {name: s, position: 1, device: cia402, drive: {counts_per_revolution: 131072, max_speed_rpm: 3000}}
  - {name: x, position: 2}
"""
ONLY_SLAVES = """\
slaves:
  - {name: out, position: 1, sim: {device: digital, outputs: 1}}
  - {name: in, position: 2, sim: {device: digital, inputs: 1, wired_to: out}}
"""
SLAVES = """\
axes:
  - {name: feed, position: 7}
slaves:
  - {name: coupler, position: 1, sim: {device: coupler}}
  - {name: both, position: 2, sim: {device: digital, inputs: 3, outputs: 2}}
  - {name: level, position: 3, sim: {device: analog, inputs: 1}}
  - {name: speed, alias: 1001, vendor: 0x00000002, product: 0x03F03052, sim: {device: analog, outputs: 2}}
  - {name: counter, position: 6, sim: {device: encoder, inputs: 2}}
"""


def expect(condition, what):
    if not condition:
        sys.exit(f"FAILED: {what}")


def run(*words):
    return subprocess.run([CM1E, *words], capture_output=True, text=True, timeout=120, check=False)


def write(path, text):
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def init(folder, name, network):
    """The file made of a network that a bus file describes."""
    interface = "sim:" + write(os.path.join(folder, name + "-network.yaml"), network) if network else "sim"
    path = os.path.join(folder, name + ".yaml")
    done = run("init", "-i", interface, "-o", path)
    expect(done.returncode == 0, f"init of {name}: {done}")
    with open(path, encoding="utf-8") as file:
        return done, path, file.read()


def drive(path, axes):
    for axis in axes:
        moved = run("move", "-b", path, axis, "--by", "0.5")
        expect(moved.returncode == 0 and f"{axis}: move done" in moved.stdout, f"{path}: {moved}")


def check_motors(folder):
    done, path, text = init(folder, "motors", MOTORS)
    expect("4 axes, 1 slave without an axis" in done.stdout, f"{done}")
    # By the order on the wire: positions first, the others fill the places between.
    for wanted in (r"position: 1 .*\n    motor: CM1-E-17S30D ", r"alias: 1001 .*\n    motor: CM1-E-17L30D ",
                   r"explicit_id: 181 .*\n    motor: CM1-E-23S30D ", r"position: 5 .*\n    motor: CM1-E-23L20D ",
                   r"# Slave 4: .*\n  - name: io4\n    position: 4 ", r"# firmware: 1\.3\.3"):
        expect(re.search(wanted, text), f"{wanted} is not in\n{text}")
    drive(path, ["axis1", "axis2", "axis3", "axis4"])
    every = write(os.path.join(folder, "every.yaml"),
                  re.sub(r"^( +)# (firmware|limits|software_limits|cycle_time_us)", r"\1\2", text, flags=re.MULTILINE))
    drive(every, ["axis2"])


def check_bridge(folder):
    done, path, text = init(folder, "bridge", BRIDGE)
    for wanted in (r"channel: 1\n    motor: CM1\n    k37: 10 ", r"channel: 3\n    motor: CM2\n    k37: 3 "):
        expect(re.search(wanted, text), f"{wanted} is not in\n{text}")
    drive(path, ["axis1", "axis2", "axis4"])


def check_servo(folder):
    done, path, text = init(folder, "servo", SERVO)
    if "device: cia402, drive" in text:
        expect("# - {name: axis, position: 1, device: cia402" in text and "1 axis is not complete" in done.stderr, text)
        drive(path, ["axis1"])
    else:
        expect("counts_per_revolution: 131072, max_speed_rpm: 3000" in text, text)
        drive(path, ["axis1", "axis2"])


def signals(path):
    """Names, types and directions as `cm1e io` lists them."""
    done = run("io", "-b", path, "--json")
    expect(done.returncode == 0, f"io -b {path}: {done}")
    return [(signal["slave_name"], signal["name"], signal["type"], signal["output"])
            for signal in json.loads(done.stdout)["signals"] if not signal["of_axis"]]


def check_scan(_):
    """What comes next is no row of the table."""
    done = run("scan", "-i", "sim")
    expect("Next" not in done.stdout and "Next: `cm1e init -i sim " in done.stderr, f"{done}")


def check_slaves(folder):
    """What the file names is there, on that network and on the segment that the simulator makes of the file itself."""
    done, path, text = init(folder, "slaves", SLAVES)
    expect("1 axis, 6 slaves without an axis.\nNext: " in done.stdout, f"{done}")
    expect("The simulator has no such device" not in text, text)
    for wanted in (r"- name: io1\n.*position: 1 .*\n.*product: 0x000C0000\n.*\n    sim: \{device: coupler\}",
                   r"alias: 1001 .*\n    vendor: 0x00000002\n    product: 0x03F03052\n",
                   r"- \{name: in3, bit: 2\}   # BOOL, Channel 3, Input\n    sim: \{device: digital, inputs: 3, outputs: 2\}",
                   r"- \{name: in3, object: 0x6000:11\}   # INT, AI Standard Channel 1, Value\n",
                   r"- \{name: in4, object: 0x6010:11\}   # UDINT, .*\n    sim: \{device: encoder, inputs: 2\}\n"):
        expect(re.search(wanted, text), f"{wanted} is not in\n{text}")
    listed = signals(path)
    expect(len(listed) == 5 + 3 + 2 + 2 + 4, f"{listed}")
    expect(("io2", "out2", "BOOL", True) in listed and ("io3", "in3", "INT", False) in listed, f"{listed}")
    own = write(os.path.join(folder, "own.yaml"), re.sub(r"interface: .*", "interface: sim", text))
    expect(signals(own) == listed, f"on a segment of its own: {signals(own)}, not {listed}")
    drive(own, ["axis1"])


def check_modules(folder):
    """A modular device with the modules in its slots; the file runs on a segment of its own."""
    network = write(os.path.join(folder, "modular.yaml"), "slaves:\n  - {name: io, position: 1, modules: [0x205, 0x302], "
                    "sim: {device: modular}}\n")
    path = os.path.join(folder, "modules.yaml")
    done = run("init", "-i", "sim:" + network, "-o", path)
    with open(path, encoding="utf-8") as file:
        text = file.read()
    expect(done.returncode == 0 and "    modules: [0x00000205, 0x00000302]   # slot by slot\n" in text
           and "    sim: {device: modular}\n" in text, f"{done}\n{text}")
    own = write(os.path.join(folder, "own-modules.yaml"), re.sub(r"interface: .*", "interface: sim", text))
    expect(signals(own) == signals(path) and len(signals(own)) == 7, f"{signals(own)}, {signals(path)}")


def check_without_motor(folder):
    """A network of terminals alone: no axes in the file, and no need of any."""
    done, path, text = init(folder, "terminals", ONLY_SLAVES)
    expect("0 axes, 2 slaves without an axis" in done.stdout and "axes:" not in text, f"{done}\n{text}")
    own = write(os.path.join(folder, "terminals_own.yaml"), re.sub(r"interface: .*", "interface: sim", text))
    expect([signal[:2] for signal in signals(own)] == [("io1", "out1"), ("io2", "in1")], f"{signals(own)}")
    moved = run("move", "-b", own, "--by", "1")
    expect(moved.returncode in (1, 2) and moved.stderr, f"a move without an axis: {moved}")


def check_pdos(folder):
    network = write(os.path.join(folder, "pdos.yaml"), SLAVES)
    done = run("scan", "-b", network, "--pdos")
    for wanted in (r"no process data", r"outputs 0x1600 Channel 1\n +bit +0  0x7000:01 +1 BOOL +Output",
                   r"inputs  0x1A02 AI Standard Channel 2|inputs  0x1A00 AI Standard Channel 1",
                   r"bit +2  gap +14\n +bit +16  0x6000:11 +16 INT +Value", r"0x6041:00 +16 UINT +Statusword"):
        expect(done.returncode == 0 and re.search(wanted, done.stdout), f"{wanted}: {done}")
    done = run("scan", "-b", network, "--pdos", "--json")
    slaves = json.loads(done.stdout)
    expect([len(slave["pdos"]) for slave in slaves][:4] == [0, 5, 4, 2], f"{slaves}")
    last = slaves[2]["pdos"][3]
    expect(last["bit"] == 16 and last["bits"] == 16 and last["index"] == 0x6000 and last["type"] == "INT", f"{last}")
    plain = json.loads(run("scan", "-b", network, "--json").stdout)
    expect("pdos" not in plain[0], f"{plain[0]}")


def check_overwriting(folder):
    _, path, text = init(folder, "one", "")
    again = run("init", "-i", "sim", "-o", path)
    expect(again.returncode == 2 and "--force" in again.stderr, f"a file that exists: {again}")
    write(path, "mine\n")
    forced = run("init", "-i", "sim", "-o", path, "--force")
    with open(path, encoding="utf-8") as file:
        expect(forced.returncode == 0 and file.read() == text, f"--force: {forced}")
    shown = run("init", "-i", "sim")
    expect(shown.returncode == 0 and shown.stdout == text, f"on standard output: {shown}")


def check_several(folder):
    """Several networks: one file, whose axes are numbered over all of them; each of its networks runs."""
    bridge = write(os.path.join(folder, "bridge-network.yaml"), BRIDGE)
    slaves = write(os.path.join(folder, "slaves-network.yaml"), ONLY_SLAVES)
    path = os.path.join(folder, "several.yaml")
    done = run("init", "-i", "sim", "-i", "sim:" + bridge, "-i", "sim:" + slaves, "-o", path)
    expect(done.returncode == 0 and "6 axes, 2 slaves without an axis" in done.stdout, f"several: {done}")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    expect(text.startswith(f"# The networks on sim, sim:{bridge}, sim:{slaves}, written by") and text.count("\nbuses:\n") == 1
           and re.findall(r"^  - name: (\w+)$", text, re.MULTILINE) == ["bus1", "bus2", "bus3"], text)
    drive(path, ["axis1", "axis2", "axis3"])
    shown = run("io", "-b", path, "--network", "bus3")
    expect(shown.returncode == 0 and "io2.in1" in shown.stdout, f"several: {shown}")
    scanned = run("scan", "-b", path)
    expect(scanned.returncode == 0 and scanned.stdout.count("bus bus") == 3, f"several: {scanned}")
    for words in (["-i", "lo", "-i", "lo"], ["-i", "sim"] * 5):
        refused = run("init", *words)
        expect(refused.returncode in (2, 64) and ("twice" in refused.stderr or "at most 4" in refused.stderr), refused)


def check_names_of_files(folder):
    """The interface of the file is the one that was named, whatever YAML makes of its letters."""
    for name in ("a # b", "c: d", 'e "f', "g\\h"):
        _, path, _ = init(folder, name, "axes: [{name: X}]\n")
        scanned = run("scan", "-b", path)
        expect(scanned.returncode == 0 and "CM1-E" in scanned.stdout, f"{name}: {scanned}")
    strange, path = os.path.join(os.fsencode(folder), b"\xff.yaml"), os.path.join(folder, "of_strange.yaml")
    with open(strange, "w", encoding="utf-8") as file:
        file.write("axes: [{name: X}]\n")
    done = run("init", "-i", b"sim:" + strange, "-o", path)
    expect(done.returncode == 2 and "not UTF-8" in done.stderr and not os.path.exists(path), f"not UTF-8: {done}")


def check_refusals(folder):
    for words in (["init"], ["init", "-i", ""], ["init", "-i", "sim", "-o", ""], ["init", "-i", "sim", "more"]):
        done = run(*words)
        expect(done.returncode in (2, 64) and done.stderr, f"{words}: {done}")


def in_a_folder(check):
    with tempfile.TemporaryDirectory() as work:
        check(work)


real_time.together(*(lambda check=check: in_a_folder(check) for check in (
    check_motors, check_bridge, check_servo, check_scan, check_slaves, check_without_motor, check_pdos, check_overwriting,
    check_several, check_modules, check_names_of_files, check_refusals)))
