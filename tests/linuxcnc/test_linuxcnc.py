#!/usr/bin/env python3
"""LinuxCNC with the HAL component cm1e: a square on three simulated motors over a veth pair, without a screen, and what
happens if LinuxCNC goes wrong.

test_linuxcnc.py BUILD-DIRECTORY SOURCE-DIRECTORY build|square|faults
"""
import glob
import json
import os
import re
import shutil
import subprocess
import sys

BUILD, SOURCE, PART = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), sys.argv[3]
sys.path.insert(0, os.path.join(SOURCE, "tests", "wire"))
import wire  # noqa: E402

HERE, EXAMPLE = os.path.dirname(os.path.abspath(__file__)), os.path.join(SOURCE, "bindings", "linuxcnc", "example")
HOME = os.path.join(BUILD, "linuxcnc")
ROOT = os.path.join(HOME, "root")  # what the page installs
MODULES = "/usr/lib/linuxcnc/modules"
RIGHTS = "cap_net_raw,cap_sys_nice,cap_ipc_lock+ep"
NOBODY = "65534"  # rtapi_app refuses to run for root
SIDE = 20.0
# Servo periods that the axes are behind, and the silence that stops them: a machine without a real-time kernel pauses.
DELAY, TIMEOUT_MS = 60, 120
# Behind the motors of the example: outputs wired to inputs, which are pins too.
SLAVES = """
slaves:
  - {name: Valves, position: 4, sim: {device: digital, outputs: 2}}
  - {name: Sensors, position: 5, sim: {device: digital, inputs: 2, wired_to: Valves}}
  - {name: set point, position: 6, sim: {device: analog, outputs: 1}}
  - {name: level, position: 7, sim: {device: analog, inputs: 1, wired_to: set point}}
"""


def need_linuxcnc():
    for what, package in (("linuxcnc", "linuxcnc-uspace"), ("halcompile", "linuxcnc-uspace-dev"),
                          ("setpriv", "util-linux"), ("setcap", "libcap2-bin")):
        if not shutil.which(what) and not os.path.exists(os.path.join("/usr/sbin", what)):
            wire.skip(f"linuxcnc: the package {package} is not installed; scripts/install-dependencies --linuxcnc "
                      "installs it")


def run(command, **more):
    done = subprocess.run(command, capture_output=True, text=True, **more)
    wire.check(done.returncode == 0, f"{' '.join(command)}: {done.stdout}{done.stderr}")
    return done.stdout


def page():
    with open(os.path.join(SOURCE, "docs", "LINUXCNC.md"), encoding="utf-8") as file:
        return file.read()


def build():
    """The commands of the page, with an installed library of its own, and without root's rights over this machine."""
    need_linuxcnc()
    prefix = os.path.join(HOME, "prefix")
    shutil.rmtree(ROOT, ignore_errors=True)
    os.makedirs(HOME, exist_ok=True)
    run(["cmake", "--install", BUILD, "--prefix", prefix], env={**os.environ, "DESTDIR": ""})
    bindings = os.path.join(HOME, "bindings")
    if not os.path.islink(bindings):
        os.symlink(os.path.join(SOURCE, "bindings"), bindings)
    block, = (block for block in re.findall(r"```sh\n(.*?)```", page(), re.DOTALL) if "cmake" in block)
    environment = {**os.environ, "CMAKE_PREFIX_PATH": prefix, "DESTDIR": ROOT, "CFLAGS": "-Werror"}
    commands = [line.replace("sudo ", "") for line in block.splitlines()]
    wire.check(len(commands) == 4 and commands[3].split()[1] == RIGHTS, f"the page builds in another way: {commands}")
    for line in commands[:3]:
        run(line.split(), cwd=HOME, env=environment)


def segment_file():
    """The bus file of the example with more slaves."""
    path = os.path.join(HOME, "with_slaves.yaml")
    with open(os.path.join(EXAMPLE, "square.yaml"), encoding="utf-8") as file:
        text = file.read()
    with open(path, "w", encoding="utf-8") as file:
        file.write(text + SLAVES)
    return path


def prepare(folder):
    """A folder that anybody may read: LinuxCNC's modules with ours, our program with its rights, the example."""
    module, modules = ROOT + MODULES + "/cm1e.so", os.path.join(folder, "modules")
    if not os.path.exists(module):
        wire.skip("linuxcnc: the component was not built")
    shutil.copytree(MODULES, modules, symlinks=True)
    shutil.copy(module, modules)
    program = shutil.copy(ROOT + "/usr/local/bin/cm1e-linuxcnc", folder)
    if subprocess.run(["/usr/sbin/setcap", RIGHTS, program], capture_output=True).returncode != 0:
        wire.skip("linuxcnc: this file system gives programs no capabilities")
    for name in os.listdir(EXAMPLE):
        shutil.copy(os.path.join(EXAMPLE, name), folder)
    shutil.copy(os.path.join(HERE, "square_ui.py"), folder)
    shutil.copy(segment_file(), os.path.join(folder, "square.yaml"))
    path = os.path.join(folder, "square.ini")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    for key, value in (("INTERFACE", wire.MASTER_INTERFACE), ("PROGRAM", program), ("DELAY", DELAY),
                       ("TIMEOUT", TIMEOUT_MS), ("FERROR", 20), ("MIN_FERROR", 10), ("DISPLAY", os.path.join(folder, "square_ui.py"))):
        text = re.sub(rf"(?m)^{key} = .*$", f"{key} = {value}", text)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    path = os.path.join(folder, "square.ngc")
    with open(path, encoding="utf-8") as file:
        text = file.read()
    with open(path, "w", encoding="utf-8") as file: # as fast as it can
        file.write(text.replace("F1800", "F4800").replace("Z-5", "Z-2"))
    subprocess.run(["chown", "-R", NOBODY, folder], check=True)
    os.chmod(folder, 0o755)
    subprocess.run(["/usr/sbin/setcap", RIGHTS, program], check=True)  # a new owner takes them away


def linuxcnc(segment, what):
    """Runs LinuxCNC once; returns what its user saw and what was said on the console."""
    folder, seen = segment.folder, os.path.join(segment.folder, "seen.json")
    if not os.path.exists(os.path.join(folder, "modules")):
        prepare(folder)
    if os.path.exists(seen):
        os.remove(seen)
    user = f"setpriv --reuid {NOBODY} --regid {NOBODY} --clear-groups"
    words = f"mount --bind {folder}/modules {MODULES} && cd {folder} && exec {user} linuxcnc -r square.ini"
    environment = {**os.environ, "HOME": folder, "CM1E_SEEN": seen, "CM1E_WHAT": what, "CM1E_PROGRAM":
                   os.path.join(folder, "square.ngc"), "LINUXCNC_FORCE_REALTIME": "1", "DISPLAY": ""}
    done = subprocess.run(segment.command(["unshare", "--mount", "--ipc", "sh", "-c", words], 1), capture_output=True,
                          text=True, timeout=90, env=environment)
    said = done.stdout + done.stderr
    wire.check(os.path.exists(seen), f"{what}: LinuxCNC did not come so far: {said}")
    with open(seen, encoding="utf-8") as file:
        return json.load(file), said


def check_pins(names):
    """The page has every pin, and no other."""
    told = set()
    for name in re.findall(r"`(cm1e\.[\w.-]+)`", page()[page().index("## Pins"):page().index("## What keeps")]):
        told.add(re.sub(r"-N$", "-1", name.replace("AXIS", "x")))
    told -= {"cm1e.read", "cm1e.write", "cm1e.io.SLAVE.in-1", "cm1e.io.SLAVE.out-1"}
    there = {name for name in names if not re.match(r"cm1e\.([yz]\.|x\.in-[2-9]|io\.|.*\.time$)", name)}
    signals = {"io.valves.out-1", "io.valves.out-2", "io.sensors.in-1", "io.sensors.in-2", "io.set-point.out-1",
               "io.level.in-3"}
    wire.check(signals <= {name[5:] for name in names}, f"these signals are no pins: {signals - set(names)}")
    wire.check(told == there, f"pins of the page and of the component differ: {sorted(told ^ there)}")


def square(segment):
    seen, said = linuxcnc(segment, "square")
    if not seen["ended"] and "the bus paused or was silent for so long" in said:
        print(f"SKIPPED: linuxcnc: pauses of this machine stopped the axes {seen['pauses']} times, so no square ended")
        sys.exit(wire.NOT_JUDGED)
    wire.check(seen["ended"], f"the square did not end: {seen['errors']}\n{said}")
    check_pins(seen["names"])
    wire.check(not seen["errors"], f"errors of LinuxCNC: {seen['errors']}\n{said}")
    for axis in (0, 1):
        actual = [row[3 + axis] for row in seen["path"]]
        wire.check(abs(max(actual) - SIDE) < 0.1 and abs(min(actual)) < 0.1,
                   f"joint {axis} was at {min(actual)} ... {max(actual)}")
    wire.check(seen["signals"] == [[False, True, 0.0], [True, False, 1234.0]], f"signals: {seen['signals']}")
    wire.check(all(abs(p) < 0.01 for p in seen["positions"]), f"it ended at {seen['positions']}")
    corners = [(0, 0), (SIDE, 0), (SIDE, SIDE), (0, SIDE)]
    for corner in corners:
        nearest = min(abs(row[3] - corner[0]) + abs(row[4] - corner[1]) for row in seen["path"])
        wire.check(nearest < 1.0, f"the corner {corner} was missed by {nearest} mm")
    off = max(min(abs(row[3]), abs(row[3] - SIDE), abs(row[4]), abs(row[4] - SIDE)) for row in seen["path"])
    wire.check(off < 0.1, f"it was {off} mm beside the square")
    most = [max(row[axis] for row in seen["following"]) for axis in range(3)]
    print("following error of X, Y, Z: " + ", ".join(f"{value:.3f}" for value in most) +
          f" mm, with a delay of {seen['delay_ms']:.1f} ms; beside the square: {off:.3f} mm; "
          f"pauses that stopped it: {seen['pauses']}")
    wire.check(most[0] < 80 * (DELAY + 12) * 1e-3, "the following error is larger than the delay explains")


def faults(segment):
    seen, said = linuxcnc(segment, "jump")
    wire.check("a position from outside asks for more than the axis limits allow" in said, f"jump: {said}")
    pins = seen["pins"]
    wire.check(pins and pins["fault"][0] and pins["state"] != pins["on"], f"jump: {pins}")
    seen, said = linuxcnc(segment, "threads")
    wire.check("the control gave no position in time" in said, f"the servo thread stops: {said}")
    seen, said = linuxcnc(segment, "killed")
    wire.check("LinuxCNC ended without unloading cm1e" in said and "stopped in order" in said, f"killed: {said}")
    seen, said = linuxcnc(segment, "estop")
    wire.check(seen["pins"] and not any(seen["pins"]["fault"]), f"emergency stop: {seen['pins']} {said}")


def main():
    if PART == "build":
        build()
        return
    need_linuxcnc()
    wire.become_root()
    if subprocess.run(["setpriv", "--reuid", NOBODY, "true"], capture_output=True).returncode != 0:
        wire.skip("linuxcnc: rtapi_app needs a user other than root, and this namespace has none")
    if glob.glob("/tmp/linuxcnc.lock"):
        wire.skip("linuxcnc: LinuxCNC runs on this machine already")
    with wire.segment(os.path.join(BUILD, "bin", "cm1e"), segment_file()) as segment:
        {"square": square, "faults": faults}[PART](segment)


main()
