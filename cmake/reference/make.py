#!/usr/bin/env python3
"""Writes the reference of the public headers as pages for a browser, by Doxygen. A warning of Doxygen is an error.

make.py OUTPUT-DIRECTORY [FOLDER-OF-HEADERS]      the pages are in OUTPUT-DIRECTORY/reference
"""
import os
import re
import subprocess
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
SOURCE = os.path.normpath(os.path.join(HERE, "../.."))


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def layout():
    """Since 1.9.8 a group is a topic, and what was a module is something else."""
    told = subprocess.run(["doxygen", "--version"], capture_output=True, text=True, check=True).stdout
    version = tuple(int(number) for number in re.findall(r"\d+", told)[:3])
    text = read(os.path.join(HERE, "layout.xml"))
    return text.replace('type="modules"', 'type="topics"') if version >= (1, 9, 8) else text


def main(output, headers=os.path.join(SOURCE, "include/cm1e")):
    os.makedirs(output, exist_ok=True)
    numbers = re.findall(r"#define CM1E_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", read(os.path.join(headers, "version.h")))
    with open(os.path.join(output, "program.c"), "w", encoding="utf-8") as file:
        file.write(re.search(r"^```c\n(.*?)^```", read(os.path.join(SOURCE, "README.md")), re.DOTALL | re.MULTILINE)[1])
    with open(os.path.join(output, "layout.xml"), "w", encoding="utf-8") as file:
        file.write(layout())
    settings = read(os.path.join(HERE, "Doxyfile.in"))
    for name, value in (("version", ".".join(numbers)), ("output", output), ("source", SOURCE), ("headers", headers),
                        ("include", os.path.dirname(headers))):
        settings = settings.replace(f"@{name}@", value)
    environment = {**os.environ, "LC_ALL": "C.UTF-8"}  # the pages are the same everywhere
    return subprocess.run(["doxygen", "-"], input=settings, text=True, env=environment).returncode


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
