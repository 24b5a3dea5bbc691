#!/usr/bin/env python3
"""docs/FIRST-HOUR.md as a beginner does it: every line with "$" is run in an empty folder, and what the page shows under
it is in the output, in that order. So are such lines of docs/COMMAND.md. The project that `cm1e new` makes does not overwrite anything.

test_first_hour.py BIN-DIRECTORY SOURCE-DIRECTORY
"""
import os
import re
import resource
import signal
import subprocess
import sys
import tempfile
import xml.etree.ElementTree

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import real_time  # noqa: E402

BIN, SOURCE = os.path.abspath(sys.argv[1]), sys.argv[2]
faults = []


def steps(text):
    """[(command, [lines of the page below it])] of all blocks of the page that are a console."""
    found = []
    for block in re.findall(r"^```console\n(.*?)^```", text, re.DOTALL | re.MULTILINE):
        for line in block.splitlines():
            if line.startswith("$ "):
                found.append((line[2:], []))
            else:
                found[-1][1].append(line)
    return found


def run(command, folder):
    environment = {**os.environ, "PATH": BIN + ":" + os.environ["PATH"]}
    return subprocess.run(["bash", "-c", command], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=60).stdout


def check_page(folder, name, least):
    with open(os.path.join(SOURCE, name), encoding="utf-8") as file:
        page = steps(file.read())
    if len(page) < least:
        faults.append(f"{name}: only {len(page)} commands can be read")
    for command, lines in page:
        output = run(command, folder)
        at = 0
        for line in lines:
            found = output.find(line.strip(), at)
            if found < 0:
                faults.append(f"$ {command}\nthe page shows \"{line}\", the output is\n{output}")
                break
            at = found
    return len(page)


def check_new(folder):
    names = sorted(os.listdir(os.path.join(SOURCE, "examples/new")))
    made = os.path.join(folder, "made")
    for expected in (0, 1):
        result = subprocess.run([os.path.join(BIN, "cm1e"), "new", made], capture_output=True, text=True, timeout=60)
        if result.returncode != expected or (expected and "made" not in result.stderr):
            faults.append(f"cm1e new, time {expected + 1}: {result}")
        if sorted(os.listdir(made)) != names:
            faults.append(f"cm1e new made {os.listdir(made)}")
        for name in names:
            with open(os.path.join(made, name), "rb") as one, open(os.path.join(SOURCE, "examples/new", name), "rb") as two:
                if (one.read() == two.read()) == bool(expected and name == "main.c"):
                    faults.append(f"cm1e new: {name} of the folder")
        with open(os.path.join(made, "main.c"), "a", encoding="utf-8") as file:
            file.write("/* mine */\n")
    check_no_half_of_it(os.path.join(folder, "half"))
    for words in ([], [""], ["a", "b"], ["/no/such/folder/x"]):
        result = subprocess.run([os.path.join(BIN, "cm1e"), "new", *words], capture_output=True, text=True, timeout=60)
        if result.returncode == 0 or "folder" not in result.stderr:
            faults.append(f"cm1e new {words}: {result}")


def check_no_half_of_it(folder):
    """Where the disk is full the folder is not left, which a second try would leave alone."""
    def small_files():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))  # the first file fits, main.c does not

    result = subprocess.run([os.path.join(BIN, "cm1e"), "new", folder], capture_output=True, text=True, timeout=60,
                            preexec_fn=small_files)
    if result.returncode != 1 or "cannot be written" not in result.stderr or os.path.exists(folder):
        faults.append(f"cm1e new where no more fits: {result}")


def main():
    real_time.run_above_others()
    with tempfile.TemporaryDirectory() as folder:
        count = check_page(folder, "docs/FIRST-HOUR.md", 10)
        for name in ("move.svg", "lift.svg"):
            xml.etree.ElementTree.parse(os.path.join(folder, name))
        check_page(folder, "docs/COMMAND.md", 2)
        check_new(folder)
    real_time.end(faults, f"docs/FIRST-HOUR.md: {count} commands do what the page shows")


if __name__ == "__main__":
    main()
