"""Builds programs in Structured Text and runs them in this process, without a bus: tests see every variable."""
import ctypes
import os
import subprocess

KINDS = {0: ctypes.c_uint8, 1: ctypes.c_int8, 2: ctypes.c_int16, 3: ctypes.c_int32, 4: ctypes.c_int64, 5: ctypes.c_uint8,
         6: ctypes.c_uint16, 7: ctypes.c_uint32, 8: ctypes.c_uint64, 9: ctypes.c_float, 10: ctypes.c_double,
         11: ctypes.c_int64}
STRING, WSTRING = 12, 13


class Variable(ctypes.Structure):
    _fields_ = [("name", ctypes.c_char_p), ("data", ctypes.c_void_p), ("size", ctypes.c_uint32), ("kind", ctypes.c_int),
                ("detail", ctypes.c_char_p), ("bit", ctypes.c_int), ("ranged", ctypes.c_int), ("first", ctypes.c_int64),
                ("last", ctypes.c_int64), ("names", ctypes.POINTER(ctypes.c_char_p)),
                ("values", ctypes.POINTER(ctypes.c_int64)), ("name_count", ctypes.c_uint32)]


class Task(ctypes.Structure):
    _fields_ = [("name", ctypes.c_char_p), ("interval_ns", ctypes.c_int64), ("priority", ctypes.c_uint32),
                ("run", ctypes.CFUNCTYPE(None))]


class Fault(ctypes.Structure):
    _fields_ = [("happened", ctypes.c_int), ("file", ctypes.c_char_p), ("line", ctypes.c_uint), ("text", ctypes.c_char_p),
                ("values", ctypes.c_longlong * 3)]


class List(ctypes.Structure):
    _fields_ = [("first", ctypes.POINTER(Variable)), ("count", ctypes.c_uint32)]


class Table(ctypes.Structure):
    _fields_ = [("version", ctypes.c_uint32), ("interface", ctypes.c_uint64), ("layout", ctypes.c_uint64),
                ("name", ctypes.c_char_p), ("begin", ctypes.CFUNCTYPE(None)), ("tasks", ctypes.POINTER(Task)),
                ("task_count", ctypes.c_uint32), ("variables", List), ("axes", List), ("groups", List), ("located", List),
                ("retained", List), ("unlisted", ctypes.c_uint64), ("fault", ctypes.POINTER(Fault)), ("loop_limit", ctypes.POINTER(ctypes.c_int64))]


def fast_compiler(folder):
    """The C compiler without information for debuggers, which takes a third of its time and changes nothing else."""
    path = os.path.join(folder, "cc-without-g")
    if not os.path.exists(path):
        with open(path, "w", encoding="utf-8") as file:
            file.write(f'#!/bin/sh\nexec {os.environ.get("CC") or "cc"} "$@" -g0\n')
        os.chmod(path, 0o755)
    return {**os.environ, "CC": path}


class Host:
    """One built program."""

    def __init__(self, binaries, folder, text, name="program", *words):
        self.source = os.path.join(folder, name + ".st")
        library = os.path.join(folder, name + ".so")
        with open(self.source, "w", encoding="utf-8") as file:
            file.write(text)
        result = subprocess.run([os.path.join(binaries, "cm1e"), "st", "build", self.source, "-o", library, *words],
                                capture_output=True, text=True, timeout=300, errors="replace", env=fast_compiler(folder))
        if result.returncode != 0 or result.stderr:
            raise RuntimeError(f"{result.stderr}{result.stdout}\n{text if len(text) < 5000 else self.source}")
        self.library = ctypes.CDLL(library)
        self.table = Table.in_dll(self.library, "cm1e_st_program")
        self.table.begin()
        self.variables = {}
        for i in range(self.table.variables.count):
            variable = self.table.variables.first[i]
            self.variables[variable.name.decode()] = variable

    def run(self):
        for i in range(self.table.task_count):
            self.table.tasks[i].run()
        return not self.table.fault.contents.happened

    def fault(self):
        """(line, text) of what stopped the program; None: it runs."""
        fault = self.table.fault.contents
        return (fault.line, fault.text.decode().replace("%lld", "{}").format(*fault.values)) if fault.happened else None

    def value(self, name):
        variable = self.variables[name]
        if variable.bit:  # of a byte AT %MX
            return ctypes.string_at(variable.data, 1)[0] >> (variable.bit - 1) & 1
        if variable.kind == WSTRING:
            units = ctypes.string_at(variable.data, variable.size)
            return units.decode("utf-16-le", errors="surrogatepass").split("\0")[0]
        if variable.kind == STRING:
            return ctypes.string_at(variable.data)
        return ctypes.cast(variable.data, ctypes.POINTER(KINDS[variable.kind])).contents.value
