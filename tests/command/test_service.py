#!/usr/bin/env python3
"""The systemd units of docs/REALTIME.md, with the example 14_service as its program, and of the package: systemd-analyze
finds nothing wrong with them, and a wrong key is found. The user of the latter has not the name of the package's group,
because systemd could not make that user. Skips where there is no systemd-analyze.

test_service.py BIN-DIRECTORY SOURCE-DIRECTORY
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

BIN, SOURCE = os.path.abspath(sys.argv[1]), sys.argv[2]
SKIPPED = 77


def unit(program, folder):
    with open(os.path.join(SOURCE, "docs/REALTIME.md"), encoding="utf-8") as file:
        text = re.search(r"```ini\n(# /etc/systemd/system/motion\.service\n.*?)```", file.read(), re.DOTALL)[1]
    for key, value in (("ExecStart", f"{program} eth1"), ("WorkingDirectory", folder)):
        text, count = re.subn(rf"^{key}=.*$", f"{key}={value}", text, flags=re.MULTILINE)
        if count != 1:
            sys.exit(f"docs/REALTIME.md: the unit has {count} lines with {key}")
    return text


def packaged_unit():
    """As it is installed, for an instance, with the command that was built here."""
    with open(os.path.join(SOURCE, "cmake/debian/cm1e@.service"), encoding="utf-8") as file:
        text = file.read()
    with open(os.path.join(SOURCE, "cmake/debian/cm1e.sysusers"), encoding="utf-8") as file:
        groups = re.findall(r"^g (\S+)", file.read(), re.MULTILINE)
    user = re.search(r"^User=(.+)$", text, re.MULTILINE)
    if not groups or not user or user[1] in groups:
        sys.exit(f"cm1e@.service: its user, {user and user[1]}, must have a name that no group has: {groups}")
    text = re.sub(r"^Documentation=.*\n", "", text, flags=re.MULTILINE)
    return text.replace("=/usr/bin/cm1e", f"={BIN}/cm1e").replace("%i", "cell")


def verify(folder, text):
    path = os.path.join(folder, "motion.service")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return subprocess.run(["systemd-analyze", "verify", path], capture_output=True, text=True, timeout=60)


def of_unit(told):
    """What is said of this unit; of others of the machine there may be more."""
    return [line for line in (told.stdout + told.stderr).splitlines() if "motion.service" in line]


def main():
    if not shutil.which("systemd-analyze"):
        print("SKIPPED: there is no systemd-analyze")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as folder:
        text = unit(os.path.join(BIN, "14_service"), folder)
        good = verify(folder, text)
        if of_unit(good):
            sys.exit(f"the unit of docs/REALTIME.md: {good}")
        good = verify(folder, packaged_unit())
        if of_unit(good):
            sys.exit(f"the unit of the package: {good}")
        for wrong, key in ((packaged_unit().replace("RuntimeDirectory=", "RunTimeDirectory="), "RunTimeDirectory"),
                           (text.replace("WatchdogSec=", "WatchDogSec="), "WatchDogSec"),
                           (text.replace("Type=notify", "Type=notifies"), "notifies"),
                           (text.replace("14_service", "15_service"), "not executable")):
            if not any(key in line for line in of_unit(verify(folder, wrong))):
                sys.exit(f"{key} is not found by systemd-analyze: this test could not fail")
    print("systemd-analyze finds nothing wrong with the units of docs/REALTIME.md and of the package")


if __name__ == "__main__":
    main()
