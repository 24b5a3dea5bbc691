#!/usr/bin/env python3
"""Other compilers of Structured Text, where they are on this machine: each translates its example, as
docs/STRUCTURED-TEXT.md says, and the axis moves. `iec2c` is looked for with its folder lib (MATIEC_LIB, or beside it),
`strucpp` with its runtime/include (STRUCPP_RUNTIME, or beside it), `plc` is RuSTy. Without any of them the test is
skipped, and says so.

test_st_compilers.py BIN-DIRECTORY SOURCE-DIRECTORY ADAPTERS-DIRECTORY
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

BIN, SOURCE, ADAPTERS = (os.path.abspath(path) for path in sys.argv[1:4])
SKIPPED = 77
BUS_FILE = """bus: {interface: sim, cycle_time_us: 1000}
axes:
  - {name: X, position: 1, motor: CM1-E-17S30D, unit: {counts_per_unit: 5000}}
"""


class Missing(Exception):
    pass


def found(command):
    path = shutil.which(command)
    if not path:
        raise Missing(f"{command} is not on PATH")
    return path


def folder_of(variable, command, below, proof):
    """A folder that belongs to a compiler: of the environment, or beside it."""
    here = os.path.dirname(os.path.realpath(found(command)))
    for folder in (os.environ.get(variable, ""), os.path.join(here, below), os.path.join(here, "..", below)):
        if folder and os.path.exists(os.path.join(folder, proof)):
            return os.path.abspath(folder)
    raise Missing(f"{command} is on PATH, but not its folder {below}: {variable} can name it")


def run(command):
    environment = dict(os.environ, PATH=BIN + os.pathsep + os.environ["PATH"])
    result = subprocess.run(command, shell=True, capture_output=True, text=True, timeout=100, env=environment)
    if result.returncode != 0:
        sys.exit(f"{command}: exit status {result.returncode}\n{result.stdout[-3000:]}{result.stderr[-3000:]}")
    return result.stdout + result.stderr


def page(compiler):
    """The commands of the page below the heading of a compiler."""
    with open(os.path.join(SOURCE, "docs", "STRUCTURED-TEXT.md"), encoding="utf-8") as file:
        part = re.search(rf"^### {re.escape(compiler)}\n(.*?)(?=^##)", file.read(), re.DOTALL | re.MULTILINE).group(1)
    return re.search(r"```sh\n(.*?)```", part, re.DOTALL).group(1)


def moves(compiler, values):
    """Does what the page says; the folders of this machine take the place of those on it."""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        with open("machine.yaml", "w", encoding="utf-8") as file:
            file.write(BUS_FILE)
        values = dict(values, **{"/usr/share/cm1e/st": ADAPTERS})
        commands = re.sub("|".join(map(re.escape, values)), lambda match: values[match.group()], page(compiler))
        commands = commands.replace("cc -shared", f"cc -w -I{SOURCE}/include -shared")
        commands = commands.replace("c++ -shared", f"c++ -w -I{SOURCE}/include -shared")
        run("set -e\n" + commands.replace("--seconds", "--virtual-time --csv trace.csv --seconds"))
        with open("trace.csv", encoding="utf-8") as file:
            names, *_, last = file.read().splitlines()
        position = dict(zip((name.strip('"') for name in names.split(",")), last.split(",")))["X actual position [u]"]
        os.chdir(SOURCE)
    if float(position) != 20:
        sys.exit(f"{compiler}: the axis is at {position}, not at 20")


def matiec():
    moves("MATIEC", {"/opt/matiec/lib": folder_of("MATIEC_LIB", "iec2c", "lib", "C/iec_std_lib.h")})
    return run("iec2c -v || true").strip().splitlines()[0]


def strucpp():
    moves("STruC++", {"/opt/strucpp/runtime/include":
                      folder_of("STRUCPP_RUNTIME", "strucpp", "runtime/include", "iec_std_lib.hpp")})
    return run("strucpp --version").strip()


def rusty():
    options = run(f"{found('plc')} --help || true")
    if "Structured Text" not in options:
        raise Missing("plc on PATH is not RuSTy")
    version = run("plc --version || true").replace("Error: ", "")
    unknown = {text: "" for text in ("--fpic ", "--generate-external-constructors ") if text.strip() not in options}
    with tempfile.NamedTemporaryFile() as file:
        run(f"plc --ir {ADAPTERS}/rusty/machine_rusty.st -i {ADAPTERS}/rusty/cm1e_rusty.st -o {file.name}")
        with_table = b"__vtable" in open(file.name, "rb").read()
    moves("RuSTy" if with_table else "RuSTy without tables of methods", unknown)
    return f"{version.strip().splitlines()[0]}, {'with' if with_table else 'without'} tables of methods"


good = 0
for name, compiler in (("MATIEC", matiec), ("STruC++", strucpp), ("RuSTy", rusty)):
    try:
        print(f"{name}: {compiler()}: the axis moves")
        good += 1
    except Missing as missing:
        print(f"{name}: skipped: {missing}")
sys.exit(0 if good else SKIPPED)
