#!/usr/bin/env python3
"""No public function crashes, or waits for ever, where one of its pointers is NULL, on a bus that operates and on one that
was only opened. One that returns an error then says in words what is missing. The functions are those of the headers, so
a new one is called as well; function blocks have an instance, as in every language of IEC 61131-3.

test_null.py SOURCE-DIRECTORY LIBRARY-DIRECTORY COMPILER [FUNCTION ...]
"""
import os
import re
import subprocess
import sys
import tempfile

LIBRARIES = ["cm1e", "cm1e_sim", "cm1e_generate", "cm1e_control", "cm1e_plot", "cm1e_busfile"]
# What is there for a call: objects that only the library can make; None: it is not worth the trouble. All other structs
# are zeros.
OBJECTS = {
    "cm1e_bus_t": "bus", "cm1e_scheduler_t": "scheduler", "cm1e_sim_segment_t": "segment", "cm1e_diag_t": "&diag",
    "cm1e_bus_config_t": "&config", "cm1e_control_t": None, "cm1e_sim_server_t": None, "cm1e_findings_t": None,
}
# A size that belongs to the struct before it, where the name of the parameter says nothing.
SIZES = {"axis_size": "cm1e_axis_config_t", "slave_size": "cm1e_slave_config_t", "device_size": "cm1e_device_options_t"}
STRINGS = {"line": '"help"', "target": '"cm1e-null"', "interface_name": '"sim"', "first": '"sim"', "second": '"other"',
           "path": '"/nonexistent/file"', "request": '"{}"', "name": '"axis1"'}
FRAME = r'''
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>
%(includes)s

static cm1e_bus_config_t config;
static cm1e_diag_t diag;
static cm1e_bus_t *bus;
static cm1e_scheduler_t *scheduler;
static cm1e_sim_segment_t *segment;
static AXIS_REF_t axis;
static AXES_GROUP_REF_t group;
static char text[2048];
static uint8_t bytes[2048];
static cm1e_error_t result;
static const volatile char *pointed;

static void make(int operating)
{
    cm1e_sim_register();
    cm1e_control_serve_own(false);
    if (cm1e_bus_config_init(&config, "sim", 2) != CM1E_OK)
        _exit(100);
    config.virtual_time = true;
    if (cm1e_bus_open(&bus, &config, &diag) != CM1E_OK)
        _exit(101);
    segment = cm1e_bus_segment(bus);
    if (operating && (cm1e_bus_start(bus, &diag) != CM1E_OK ||
                      cm1e_scheduler_create(&scheduler, bus, NULL, &diag) != CM1E_OK))
        _exit(102);
    if (operating)
        axis = cm1e_scheduler_axis(scheduler, 0);
    cm1e_group_create(&group, NULL, NULL);
    memset(&diag, 0, sizeof diag);
}

%(functions)s

static const struct {
    const char *name;
    void (*call)(void);
    int needs; /* 1: an error is expected, 2: CM1E_ERROR_INVALID_ARGUMENT with a text */
} calls[] = {
%(table)s
};

int main(void)
{
    int faults = 0;
    for (int operating = 0; operating < 2; operating++) {
        make(operating);
        for (size_t i = 0; i < sizeof calls / sizeof calls[0]; i++) {
            fflush(stdout);
            const pid_t child = fork();
            int status = 0;
            if (child == 0) {
                alarm(20);
                result = CM1E_OK;
                calls[i].call();
                if (pointed)
                    (void)*pointed;
                const int refused = result == CM1E_ERROR_INVALID_ARGUMENT;
                const int told = strstr(diag.text, "need") || strstr(diag.text, "missing") || strstr(diag.text, "no ");
                const int wrong = (calls[i].needs == 1 && result == CM1E_OK) || (calls[i].needs == 2 && !(refused && told));
                if (wrong)
                    printf("%%s: returns %%d, \"%%s\"; expected an %%s\n", calls[i].name, result,
                           diag.text, calls[i].needs == 2 ? "invalid argument, and what is needed" : "error");
                fflush(stdout);
                _exit(wrong);
            }
            waitpid(child, &status, 0);
            if (WIFSIGNALED(status)) {
                printf("%%s: %%s\n", calls[i].name, WTERMSIG(status) == SIGALRM ? "waits for ever" : "crashes");
                faults++;
            } else {
                faults += WEXITSTATUS(status) != 0;
            }
        }
    }
    printf("%%zu calls, %%d faults\n", sizeof calls / sizeof calls[0], faults);
    return faults > 0;
}
'''
ALLOWED = {"cm1e_bus_close(bus)"}
# Without one of these a function that can return an error has to.
NEEDED = {"bus", "scheduler", "segment", "server", "sdo", "io", "info", "findings", "file", "request", "control", "exchange"}


def prototypes(folder):
    for name in sorted(os.listdir(folder)):
        with open(os.path.join(folder, name), encoding="utf-8") as file:
            code = re.sub(r"/\*.*?\*/|^\s*#.*?$", " ", file.read(), flags=re.DOTALL | re.MULTILINE)
        for match in re.finditer(r"CM1E_API\s+([^;(]*?)(\w+)\(([^;]*?)\)\s*(?:CM1E_\w+\([^)]*\)\s*)?;", code):
            result, function, parameters = (" ".join(group.split()) for group in match.groups())
            if not re.fullmatch(rf"{function}_t \*fb", parameters) and parameters != "void":
                yield result, function, [part.strip() for part in parameters.split(",")]


def argument(parameters, at):
    """(C expression of a good argument, whether it is a pointer)"""
    parameter = parameters[at]
    match = re.fullmatch(r"(?:const )?(?:struct )?(?:volatile )?(\w+) (\**)(\w+)((?:\[\w*\])?)", parameter)
    kind, stars, name, array = match.groups()
    if stars == "*" and kind == "char":
        return ("text" if "const" not in parameter else STRINGS.get(name, '"x"')), True
    if stars == "*" and kind in ("void", "uint8_t"):
        return "bytes", True
    if stars == "**":
        return {"cm1e_bus_t": "&(cm1e_bus_t *){NULL}"}.get(kind, f"&({kind} *){{NULL}}"), True
    if stars or array:
        if kind in OBJECTS:
            return OBJECTS[kind] or "NULL", True
        count = "[8]" if array else "[1]"
        return f"({kind}{count}){{0}}", True
    if kind == "AXIS_REF_t":
        return "axis", False
    if kind == "AXES_GROUP_REF_t":
        return "group", False
    if name in SIZES:
        return f"sizeof({SIZES[name]})", False
    if kind == "size_t" or name == "size":
        before = re.fullmatch(r"(?:const )?(\w+) \*\w+", parameters[at - 1]) if at else None
        if before and before.group(1) not in ("char", "void", "uint8_t"):
            return f"sizeof({before.group(1)})" if name.endswith("size") else "1", False
        return "64", False
    return "1", False


def calls_of(function, parameters):
    """(what is NULL, arguments) of each call."""
    good = [argument(parameters, at) for at in range(len(parameters)) if parameters[at] != "..."]
    pointers = [at for at, (_, is_pointer) in enumerate(good) if is_pointer]
    for missing in [[at] for at in pointers] + ([pointers] if len(pointers) > 1 else []):
        names = [re.search(r"(\w+)(?:\[\w*\])?$", parameters[at]).group(1) for at in missing]
        yield "+".join(names), ["NULL" if at in missing else text for at, (text, _) in enumerate(good)]


def main(source, library, compiler, *only):
    folder = os.path.join(source, "include/cm1e")
    functions, table = [], []
    for returns, function, parameters in prototypes(folder):
        if only and function not in only:
            continue
        for what, arguments in calls_of(function, parameters):
            call = f"{function}({', '.join(arguments)});"
            keep = ("result = " if returns == "cm1e_error_t" else
                    "pointed = (const volatile char *)" if "*" in returns else "(void)")
            needs = 0
            if returns == "cm1e_error_t" and what in NEEDED and f"{function}({what})" not in ALLOWED:
                needs = 2 if any(parameter.endswith("*diag") for parameter in parameters) else 1
            functions.append(f"static void call_{len(table)}(void) {{ {keep}{call} }}")
            table.append(f'    {{"{function}({what})", call_{len(table)}, {needs}}},')
    includes = "\n".join(f"#include <cm1e/{name}>" for name in sorted(os.listdir(folder)) if name != "tc2_mc2.h")
    with tempfile.TemporaryDirectory() as place:
        path = os.path.join(place, "calls.c")
        with open(path, "w", encoding="utf-8") as file:
            file.write(FRAME % {"includes": includes, "functions": "\n".join(functions), "table": "\n".join(table)})
        program = os.path.join(place, "calls")
        subprocess.run([compiler, "-std=gnu11", "-Wall", "-Wno-nonnull", "-Werror", "-I", os.path.join(source, "include"), path, "-o",
                        program, "-L", library, f"-Wl,-rpath,{library}", *(f"-l{name}" for name in LIBRARIES)],
                       check=True)
        run = subprocess.run([program], capture_output=True, text=True)
    print(run.stdout)
    return run.returncode


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
