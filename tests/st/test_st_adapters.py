#!/usr/bin/env python3
"""Other compilers of Structured Text call our blocks, through the adapters that are installed in share/cm1e/st. Without
these compilers: what they write is written by stand-ins (compilers.py), from the same declarations. Every input and
output of every block goes through each adapter to its place; a program of each compiler moves a simulated axis.

test_st_adapters.py BIN-DIRECTORY SOURCE-DIRECTORY ADAPTERS-DIRECTORY
"""
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor

import compilers
import every_value

BIN, SOURCE, ADAPTERS = (os.path.abspath(path) for path in sys.argv[1:4])
STAND_INS = os.path.join(SOURCE, "tests/st/stand_ins")
C = ["cc", "-std=c11", "-Wall", "-Werror", "-fPIC", f"-I{SOURCE}/include", f"-I{ADAPTERS}"]
CXX = ["c++", "-std=c++17", "-Wall", "-Werror", "-fPIC", f"-I{SOURCE}/include", f"-I{ADAPTERS}"]
BUS_FILE = """bus: {interface: sim, cycle_time_us: 1000}
axes:
  - {name: X, position: 1, motor: CM1-E-17S30D, unit: {counts_per_unit: 5000}}
"""

# The same program as each compiler makes it: the axis goes to 20.
MATIEC_PROGRAM = """
#include "iec_std_lib.h"
#include "POUS.h"
static __IEC_AXIS_REF_t X;
static MC_POWER power;
static MC_MOVEABSOLUTE there;
unsigned long long common_ticktime__ = 2000000;
AXIS_REF *__GET_GLOBAL_X(void) { return &X.value; }
void config_init__(void) { X.value.HANDLE = 0; }
void config_run__(unsigned long tick)
{
    (void)tick;
    power.AXIS.value = X.value;
    power.ENABLE.value = power.ENABLEPOSITIVE.value = power.ENABLENEGATIVE.value = 1;
    MC_POWER_body__(&power);
    there.AXIS.value = X.value;
    there.EXECUTE.value = power.STATUS.value;
    there.POSITION.value = 20;
    there.VELOCITY.value = 50;
    MC_MOVEABSOLUTE_body__(&there);
}
"""
STRUCPP_PROGRAM = """
#pragma once
#include "blocks.hpp"
namespace strucpp {
inline GlobalVar<AXIS_REF> X;
struct Program_MAIN : ProgramBase {
    MC_POWER POWER;
    MC_MOVEABSOLUTE THERE;
    void run() override
    {
        POWER.AXIS = X.value;
        POWER.ENABLE = true;
        POWER.ENABLEPOSITIVE = true;
        POWER.ENABLENEGATIVE = true;
        POWER();
        THERE.AXIS = X.value;
        THERE.EXECUTE = POWER.STATUS.get();
        THERE.POSITION = 20.0;
        THERE.VELOCITY = 50.0;
        THERE();
    }
};
struct Configuration_CONFIG {
    Program_MAIN MAIN;
    ProgramBase *programs[1] = {&MAIN};
    TaskInstance task{"CYCLE", 2000000, 1, programs, 1};
    ResourceInstance resource{"RES", "PLC", &task, 1};
    ResourceInstance *get_resources() { return &resource; }
    std::size_t get_resource_count() const { return 1; }
};
} // namespace strucpp
"""
RUSTY_PROGRAM = """
#include "machine.h"
AXIS_REF X;
typedef struct { MC_Power_type power; MC_MoveAbsolute_type there; } Main_type;
Main_type Main_instance;
void Main(Main_type *self)
{
    self->power.Axis = &X;
    self->power.Enable = self->power.EnablePositive = self->power.EnableNegative = true;
    MC_Power(&self->power);
    self->there.Axis = &X;
    self->there.Execute = self->power.Status;
    self->there.Position = 20;
    self->there.Velocity = 50;
    MC_MoveAbsolute(&self->there);
}
"""


class Compiler:
    """One stand-in, with its folder."""

    def __init__(self, folder, name, table_of_methods=None):
        self.kind = name
        self.name = name if table_of_methods is None else f"{name}, {'with' if table_of_methods else 'without'} table"
        self.folder = os.path.join(folder, self.name)
        os.makedirs(self.folder)
        with open(os.path.join(ADAPTERS, name, f"cm1e_{name}.st"), encoding="utf-8") as file:
            source = compilers.Source(file.read())
        self.own = os.path.join(ADAPTERS, name)
        if name == "matiec":
            self.write("POUS.h", compilers.Matiec(source).text)
            self.program, self.flags = MATIEC_PROGRAM, [f"-I{STAND_INS}/matiec"]
        elif name == "strucpp":
            self.write("blocks.hpp", compilers.Strucpp(source).text)
            self.write("machine.hpp", STRUCPP_PROGRAM)
            self.program = '#include "machine.hpp"\n'
            self.flags = [f"-I{STAND_INS}/strucpp", f"-I{self.own}", "-include", f"{self.own}/cm1e_strucpp.hpp",
                          '-DCM1E_HEADER="machine.hpp"']
        else:
            self.write("machine.h", compilers.Rusty(source, table_of_methods).text)
            self.program = RUSTY_PROGRAM
            self.flags = [f"-DCM1E_RUSTY_VTABLE={int(table_of_methods)}"]
            if table_of_methods:
                self.flags.append(f"@{self.own}/wrap.txt")
        self.cxx = name == "strucpp"
        self.adapter = [] if self.cxx else [f"{self.own}/cm1e_{name}.c"]

    def write(self, name, text):
        with open(os.path.join(self.folder, name), "w", encoding="utf-8") as file:
            file.write(text)

    def run(self, command):
        result = subprocess.run(command, capture_output=True, text=True, cwd=self.folder, timeout=120)
        if result.returncode != 0:
            raise RuntimeError(f"{self.name}: {' '.join(command)}: exit status {result.returncode}\n"
                               f"{result.stdout[-3000:]}{result.stderr[:3000]}")
        return result.stdout

    def build(self, source, output, more):
        language = ".cpp" if self.cxx else ".c"
        self.write(source + language, getattr(self, source))
        self.run((CXX if self.cxx else C) + [f"-I{self.folder}", *self.flags, source + language, *self.adapter, *more,
                                             "-o", output])

    def every_value(self, of, library):
        self.values = every_value.program(of, every_value.COMPILERS[self.kind])
        self.build("values", "values", [library])
        return self.run(["./values"])

    def moves(self):
        host = os.path.join(self.own, f"cm1e_{self.kind}_host.{'cpp' if self.cxx else 'c'}")
        self.build("program", "machine.so", [host, "-shared", "-DCM1E_AXES=AXIS(X)"])
        self.write("machine.yaml", BUS_FILE)
        said = self.run([os.path.join(BIN, "cm1e"), "run", "machine.so", "-b", "machine.yaml", "--virtual-time",
                         "--seconds", "2", "--csv", "trace.csv"])
        with open(os.path.join(self.folder, "trace.csv"), encoding="utf-8") as file:
            names, *_, last = file.read().splitlines()
        position = dict(zip((name.strip('"') for name in names.split(",")), last.split(",")))["X actual position [u]"]
        if float(position) != 20:
            raise RuntimeError(f"{self.name}: the axis is at {position}, not at 20\n{said}")


def judge(of, compiler, library):
    said = compiler.every_value(of, library)
    compiler.moves()
    return f"{compiler.name}: {said.strip()}; its axis moves"


with tempfile.TemporaryDirectory() as folder:
    of = every_value.model()
    all_of_them = [Compiler(folder, "matiec"), Compiler(folder, "strucpp"), Compiler(folder, "rusty", False),
                   Compiler(folder, "rusty", True)]
    library = os.path.join(folder, "library")
    with open(library + ".c", "w", encoding="utf-8") as file:
        file.write(every_value.library(of))
    all_of_them[0].run(C + ["-c", library + ".c", "-o", library + ".o"])
    with ThreadPoolExecutor(2) as pool:
        for line in pool.map(lambda compiler: judge(of, compiler, library + ".o"), all_of_them):
            print(line)
