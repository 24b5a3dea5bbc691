#!/usr/bin/env python3
"""Installs the library into a fresh prefix, takes the C program out of README.md, builds it as a stranger's project with
find_package(cm1e), and runs it on the simulated segment. Beside it, programs that define names which the library's
sources might use (own_names.c), or that link libpcap before and after the library (with_libpcap.c).

test_install.py BUILD-DIRECTORY SOURCE-DIRECTORY
"""
import os
import re
import subprocess
import sys
import tempfile


def run(*command, **options):
    result = subprocess.run(command, capture_output=True, text=True, timeout=240, **options)
    if result.returncode != 0:
        sys.exit(f"FAILED: {' '.join(command)}\n{result.stdout}{result.stderr}")
    return result.stdout


def main(build, source):
    with open(os.path.join(source, "README.md"), encoding="utf-8") as file:
        programs = re.findall(r"```c\n(.*?)```", file.read(), re.DOTALL)
    if len(programs) != 1 or len(programs[0].splitlines()) > 40:
        sys.exit(f"FAILED: README.md should hold one C program of at most 40 lines, found "
                 f"{[len(program.splitlines()) for program in programs]}")
    with tempfile.TemporaryDirectory() as folder:
        prefix, project = os.path.join(folder, "prefix"), os.path.join(folder, "project")
        run("cmake", "--install", build, "--prefix", prefix)
        for needed in ("bin/cm1e", "include/cm1e/plcopen.h", "share/doc/cm1e/LICENSE", "share/doc/cm1e/THIRD-PARTY.md",
                       "share/doc/cm1e/licenses/SOEM.txt"):
            if not os.path.exists(os.path.join(prefix, needed)):
                sys.exit(f"FAILED: {needed} is not installed")
        os.mkdir(project)
        program = os.path.join(project, "readme.c")
        with open(program, "w", encoding="utf-8") as file:
            file.write(programs[0])
        run("cmake", "-G", "Ninja", "-S", os.path.join(source, "tests/install"), "-B", project,
            f"-DCMAKE_PREFIX_PATH={prefix}", f"-DCM1E_PROGRAM={program}", "-DCMAKE_C_FLAGS=-Wall -Wextra -Werror")
        run("cmake", "--build", project)
        for name in ("consumer", "own_names", "before_libpcap", "after_libpcap"):
            print(run(os.path.join(project, name), cwd=project), end="")


if __name__ == "__main__":
    main(*sys.argv[1:3])
