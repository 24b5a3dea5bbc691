#!/usr/bin/env python3
"""The service cm1e@NAME under systemd, which is booted in a bare Debian (systemd-nspawn): it starts when its motors are
in operation, root attaches to it, a stop ramps down and disables, variables are kept, two run beside each other, one
that is killed does not start again, and whoever names a wrong file reads in the journal what is wrong. By hand, because
making a Debian takes a minute or two.

test_booted_service.py BUILD-DIRECTORY [FOLDER]     FOLDER: keeps the Debian there, and uses it again
"""
import contextlib
import glob
import os
import shutil
import subprocess
import sys
import tempfile
import time

from test_packages import Chroot, expect, make_chroot, packages_of, run, skip

PROGRAM = """\
VAR_GLOBAL
    X : AXIS_REF;
END_VAR
VAR_GLOBAL RETAIN
    Starts : DINT;
END_VAR
PROGRAM Turn
VAR
    Power : MC_Power;
    Move  : MC_MoveVelocity;
    Told  : BOOL;
END_VAR
IF NOT Told THEN
    Starts := Starts + 1;
    Told := TRUE;
END_IF
Power(Axis := X, Enable := TRUE, EnablePositive := TRUE, EnableNegative := TRUE);
Move(Axis := X, Execute := Power.Status, Velocity := 5);
END_PROGRAM
"""
BUS = """\
bus:
  interface: sim
axes:
  - name: X
"""


class Booted:
    """A Debian whose first process is systemd."""
    def __init__(self, folder):
        self.log = tempfile.TemporaryFile()
        self.nspawn = subprocess.Popen(
            ["systemd-nspawn", "--quiet", "--directory", folder, "--register=no", "--keep-unit", "--boot",
             "--private-network", "--capability=CAP_NET_RAW,CAP_SYS_NICE,CAP_IPC_LOCK"],
            stdin=subprocess.DEVNULL, stdout=self.log, stderr=subprocess.STDOUT)
        self.first = self._first_process()
        deadline = time.monotonic() + 90
        while self.run("systemctl", "is-system-running").stdout.strip() not in ("running", "degraded"):
            expect(time.monotonic() < deadline and self.nspawn.poll() is None, "systemd starts", self.told())
            time.sleep(0.3)

    def told(self):
        self.log.seek(0)
        return self.log.read().decode(errors="replace")

    def _first_process(self):
        path = f"/proc/{self.nspawn.pid}/task/{self.nspawn.pid}/children"
        deadline = time.monotonic() + 30
        while time.monotonic() < deadline and self.nspawn.poll() is None:
            with open(path, encoding="ascii") as file:
                children = file.read().split()
            for child in children:
                with contextlib.suppress(OSError):
                    if "systemd" in os.path.basename(os.readlink(f"/proc/{child}/exe")) and \
                            os.readlink(f"/proc/{child}/ns/pid") != os.readlink("/proc/self/ns/pid"):
                        return child
            time.sleep(0.2)
        skip(f"systemd-nspawn does not boot here: {self.told()[-300:]}")

    def run(self, *command):
        inside = ["nsenter", "--target", self.first, "--all", "--", *command]
        return subprocess.run(inside, capture_output=True, text=True)

    def good(self, *command):
        done = self.run(*command)
        last = self.run("journalctl", "--no-pager", "-n", "8").stdout if done.returncode != 0 else ""
        expect(done.returncode == 0, " ".join(command), f"{done}\n{last}")
        return done.stdout

    def value(self, name, key):
        return self.good("systemctl", "show", "--property", key, "--value", f"cm1e@{name}").strip()

    def journal(self, name):
        return self.good("journalctl", "--no-pager", "--output", "cat", "--unit", f"cm1e@{name}")

    def end(self):
        self.run("systemctl", "poweroff")
        try:
            self.nspawn.wait(30)
        except subprocess.TimeoutExpired:
            self.nspawn.kill()


def starts_and_stops(machine):
    machine.good("systemctl", "start", "cm1e@cell")
    process = machine.value("cell", "MainPID")
    user = machine.good("ps", "-o", "uid=", "-p", process).strip()
    expect(int(user) >= 61184, "the user is a dynamic one", user)
    expect(machine.value("cell", "StatusText") == "in operation", "the state that systemd shows", "")
    told = machine.good("cm1e", "status", "--attach", process)
    expect("Operation enabled" in told, "root sees that the motor has torque", told)
    expect(machine.good("ls", "/run/cm1e/cell").strip().endswith(".sock"), "the socket is where the unit says", "")
    began = time.monotonic()
    machine.good("systemctl", "stop", "cm1e@cell")
    told = machine.journal("cell")
    expect(machine.value("cell", "Result") == "success" and "a signal ended it" in told and "axes are disabled" in told,
           "a stop ramps down and disables", told)
    expect(time.monotonic() - began < 10, "a stop is quick", "")


def keeps_variables(machine):
    machine.good("systemctl", "start", "cm1e@cell")
    told = machine.good("cm1e", "var", "get", "--attach", machine.value("cell", "MainPID"), "Starts")
    expect(told.split()[-1] == "2" or " 2 " in told, "a variable is kept over a stop", told)


def two_beside_each_other(machine):
    machine.good("systemctl", "start", "cm1e@other")
    machine.good("systemctl", "stop", "cm1e@other")
    told = machine.good("cm1e", "status", "--attach", machine.value("cell", "MainPID"))
    expect("Operation enabled" in told, "a service goes on when another one stops", told)


def killed_stays_down(machine):
    machine.good("kill", "-KILL", machine.value("cell", "MainPID"))
    time.sleep(3)
    expect(machine.value("cell", "ActiveState") == "failed" and machine.value("cell", "NRestarts") == "0",
           "a machine that has failed waits for a person", machine.value("cell", "ActiveState"))
    machine.good("systemctl", "start", "cm1e@cell")
    machine.good("systemctl", "stop", "cm1e@cell")


def refused(machine, name, *words):
    """A start that cannot succeed fails, and the journal says why."""
    done = machine.run("systemctl", "start", "--", f"cm1e@{name}")
    expect(done.returncode != 0, f"cm1e@{name} is refused", done)
    told = done.stderr + machine.run("journalctl", "--no-pager", "--output", "cat", "--unit", f"cm1e@{name}").stdout + \
        machine.run("journalctl", "--no-pager", "--output", "cat", "_PID=1", "-n", "30").stdout
    for word in words:
        expect(word in told, f"cm1e@{name}: the journal says \"{word}\"", told)
    machine.run("systemctl", "reset-failed")


def hostile(machine):
    refused(machine, "absent", "/etc/cm1e/absent.so", "No such file")
    refused(machine, "text", "/etc/cm1e/text.so")
    refused(machine, "halved", "/etc/cm1e/halved.so is cut off")
    refused(machine, "wrong", "wrong.yaml", "axes")
    refused(machine, "secret", "/etc/cm1e/secret.so", "ermission denied")
    refused(machine, "..")
    refused(machine, "a/b")
    refused(machine, "x" * 300)


def prepare(folder, build):
    work = os.path.join(folder, "etc/cm1e")
    os.makedirs(work, exist_ok=True)
    source = os.path.join(folder, "tmp/cell.st")
    with open(source, "w", encoding="utf-8") as file:
        file.write(PROGRAM)
    program = os.path.join(work, "cell.so")
    run(os.path.join(build, "bin/cm1e"), "st", "build", source, "-o", program)
    for name in ("cell", "other", "text", "halved", "wrong", "secret"):
        with open(os.path.join(work, f"{name}.yaml"), "w", encoding="utf-8") as file:
            file.write(BUS if name != "wrong" else BUS.replace("axes", "axis"))
        if name != "cell":
            shutil.copy(program, os.path.join(work, f"{name}.so"))
    with open(os.path.join(work, "text.so"), "w", encoding="utf-8") as file:
        file.write(PROGRAM)
    os.truncate(os.path.join(work, "halved.so"), os.path.getsize(program) // 2)
    os.chmod(os.path.join(work, "secret.so"), 0o600)


def make_debian(folder, build):
    ready = os.path.exists(os.path.join(folder, "usr/lib/systemd/systemd"))
    chroot = Chroot(folder) if ready else make_chroot(folder)
    if not ready:
        chroot.good("apt-get", "update", "-q")
        chroot.good("apt-get", "install", "-q", "-y", "--no-install-recommends", "systemd", "systemd-sysv", "dbus",
                    "procps")
    for path in packages_of(build):
        if not os.path.basename(path).startswith(("python3", "libcm1e-d")):
            shutil.copy(path, os.path.join(folder, "tmp"))
    chroot.good("apt-get", "install", "-q", "-y", "--reinstall", "--no-install-recommends", "--allow-downgrades",
                *(f"/tmp/{os.path.basename(path)}" for path in glob.glob(os.path.join(folder, "tmp/*.deb"))))
    chroot.run("rm", "-rf", "/var/lib/private/cm1e", "/var/lib/cm1e", "/var/log/journal")
    with open(os.path.join(folder, "etc/machine-id"), "w", encoding="ascii"):
        pass


def main(build, folder):
    if not shutil.which("systemd-nspawn"):
        skip("there is no systemd-nspawn (package systemd-container)")
    make_debian(folder, build)
    prepare(folder, build)
    machine = Booted(folder)
    try:
        for check in (starts_and_stops, keeps_variables, two_beside_each_other, killed_stays_down, hostile):
            check(machine)
            print(check.__name__.replace("_", " "))
        told = machine.good("systemd-analyze", "security", "--no-pager", "cm1e@cell")
        print(told.strip().splitlines()[-1])
    finally:
        machine.end()


if __name__ == "__main__":
    if len(sys.argv) > 2:
        os.makedirs(sys.argv[2], exist_ok=True)
        main(sys.argv[1], os.path.abspath(sys.argv[2]))
    else:
        with tempfile.TemporaryDirectory() as temporary:
            main(sys.argv[1], temporary)
