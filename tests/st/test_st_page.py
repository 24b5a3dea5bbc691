#!/usr/bin/env python3
"""docs/STRUCTURED-TEXT.md, done as it says: its bus file, its program and its commands move the simulated axis to where
the page says; all its examples are good.

test_st_page.py BIN-DIRECTORY SOURCE-DIRECTORY
"""
import json
import os
import re
import subprocess
import sys
import tempfile

BIN, SOURCE = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2])


def run(command):
    environment = dict(os.environ, PATH=BIN + os.pathsep + os.environ["PATH"])
    result = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=60, env=environment)
    if result.returncode != 0:
        sys.exit(f"{command}: exit status {result.returncode}\n{result.stdout}{result.stderr}")
    return result.stdout


with open(os.path.join(SOURCE, "docs", "STRUCTURED-TEXT.md"), encoding="utf-8") as file:
    page = file.read()
blocks = re.findall(r"```(\w+)\n(.*?)```", page, re.DOTALL)
position = float(re.search(r"shows the axis at (\d+)", page).group(1))
with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    for name, kind in (("machine.yaml", "yaml"), ("machine.st", "iecst")):
        with open(name, "w", encoding="utf-8") as file:
            file.write(next(text for found, text in blocks if found == kind))
    for command in next(text for found, text in blocks if found == "sh").splitlines():
        run(command.replace("--seconds", "--virtual-time --csv trace.csv --seconds"))
    with open("trace.csv", encoding="utf-8") as file:
        names, *_, last = file.read().splitlines()
    values = dict(zip((name.strip('"') for name in names.split(",")), last.split(",")))
    if float(values["X actual position [u]"]) != position or values["Main.there.Done"] != "1":
        sys.exit(f"the axis is at {values['X actual position [u]']}, Main.there.Done is {values['Main.there.Done']}; the "
                 f"page says {position}")
    if not os.path.getsize("trace.svg"):
        sys.exit("there is no trace.svg")
    for text in [text for found, text in blocks if found == "iecst"][1:]:
        with open("example.st", "w", encoding="utf-8") as file:
            file.write(text)
        if json.loads(run("cm1e st check example.st --json")):
            sys.exit(f"an example of the page has errors: {text}")
