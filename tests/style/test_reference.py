#!/usr/bin/env python3
"""Doxygen makes the reference of the public headers without a warning; every function and every header has its place in
it. A function without a comment and a comment that names what is not there are found. Skips where there is no Doxygen.

test_reference.py SOURCE-DIRECTORY
"""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

SOURCE = sys.argv[1]
HEADERS = os.path.join(SOURCE, "include/cm1e")
SKIPPED = 77


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def make(folder, headers):
    command = [os.path.join(SOURCE, "cmake/reference/make.py"), folder, headers]
    return subprocess.run(command, capture_output=True, text=True)


def expect(condition, what, told=""):
    if not condition:
        sys.exit(f"FAILED: {what}\n{told}")


def check_pages(folder):
    pages = {os.path.basename(path): read(path) for path in glob.glob(os.path.join(folder, "reference/*.html"))}
    groups = pages.get("modules.html") or pages["topics.html"]
    for path in sorted(glob.glob(os.path.join(HEADERS, "*.h"))):
        name = os.path.basename(path)
        group = f"group__{name.removesuffix('.h').replace('_', '__')}.html"
        expect(group in pages, f"{name} has no page {group}")
        expect(f">{name}: " in groups, f"{name} has no line in cmake/reference/groups.dox")
        for function in re.findall(r"^CM1E_API [^(;]*?\b(\w+)\(", read(path), re.MULTILINE):
            expect(re.search(rf"\b{function}\b", pages[group]), f"{function}() is not on the page of {name}")
    expect("the command starts at its rising edge" in pages["structMC__MoveAbsolute__t.html"],
           "Execute of MC_MoveAbsolute has the meaning that fb/interface/ gives it")
    image = "MC_MoveAbsolute.svg"
    expect(image in pages["structMC__MoveAbsolute__t.html"] and os.path.exists(os.path.join(folder, "reference", image)),
           "the timing of MC_MoveAbsolute is shown")


def check_that_faults_are_found(folder):
    """All in one run; the other headers are left out, so it is short."""
    headers = os.path.join(folder, "include/cm1e")
    os.makedirs(headers)
    for name in ("api.h", "version.h"):
        shutil.copy(os.path.join(HEADERS, name), headers)
    text = read(os.path.join(headers, "version.h"))
    added = "CM1E_API void planted_silent(void);\n/** See planted_nowhere(), @ref planted_reference. */\n" \
            "CM1E_API void planted_link(void);\n"
    with open(os.path.join(headers, "version.h"), "w", encoding="utf-8") as file:
        file.write(text.replace("/** That version as text", added + "/** That version as text"))
    told = make(folder, headers)
    for fault in ("planted_silent", "planted_reference"):
        is_found = told.returncode != 0 and fault in told.stderr
        expect(is_found, f"{fault} is not found: this test could not fail", told.stderr)


def main():
    if not shutil.which("doxygen"):
        print("SKIPPED: there is no doxygen")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as folder:
        told = make(folder, HEADERS)
        expect(told.returncode == 0, "Doxygen warns", told.stdout + told.stderr)
        check_pages(folder)
    with tempfile.TemporaryDirectory() as folder:
        check_that_faults_are_found(folder)
    print("Doxygen has nothing to say against the public headers, and all of them are in the reference")


if __name__ == "__main__":
    main()
