#!/usr/bin/env python3
"""Writes what follows from the public headers and from the declarations of the function blocks (fb/interface/): the C
source of the extension module, by cffi, and the classes of the blocks. The same input gives the same bytes.

make_cffi.py SOURCE-TREE FOLDER [COMPILER]    writes FOLDER/_cm1e.c, FOLDER/blocks.py and FOLDER/codes.py
"""
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
HEADERS = ("cm1e/plcopen.h", "cm1e/scheduler.h", "cm1e/sim.h", "cm1e/group.h", "cm1e/io.h", "cm1e/log.h", "cm1e/trace.h",
           "cm1e/generate.h", "cm1e/version.h", "cm1e/iec.h", "py_session.h")
STANDARD = ("stdint.h", "stdbool.h", "stddef.h")


def preprocessed(source, compiler):
    """The public headers without what cffi knows itself: types of the standard headers, attributes, macros."""
    with tempfile.TemporaryDirectory() as empty:
        for name in STANDARD:
            open(os.path.join(empty, name), "w", encoding="utf-8").close()
        text = "".join(f'#include "{name}"\n' for name in HEADERS)
        command = [compiler, "-E", "-P", "-nostdinc", "-U__GNUC__", "-std=c11", "-I", empty, "-I",
                   os.path.join(source, "include"), "-I", os.path.join(HERE, "glue"), "-x", "c", "-"]
        return subprocess.run(command, input=text, capture_output=True, text=True, check=True).stdout


def without_bodies(text):
    """Inline functions as declarations: the compiler that makes the module sees their bodies in the headers."""
    result, at = "", 0
    for match in re.finditer(r"static inline ([^{;]+?)\s*\{", text):
        depth, end = 1, match.end()
        while depth:
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
        result += text[at:match.start()] + match.group(1) + ";"
        at = end
    return result + text[at:]


def declarations(source, compiler):
    text = without_bodies(preprocessed(source, compiler))
    text = re.sub(r"cm1e_error_t cm1e_diag_set\([^;]*;", "", text)  # a variable number of arguments
    return re.sub(r"\bextern\b ", "", text)


def calls(blocks):
    """cm1e_py_call_of(): every block under its name, called as what it is."""
    functions = "".join(f"static void call_{name}(void *fb) {{ {name}(fb); }}\n" for name in blocks)
    rows = "".join(f'    {{"{name}", call_{name}}},\n' for name in blocks)
    return f"""{functions}
static const struct {{ const char *type; void (*call)(void *fb); }} block_types[] = {{
{rows}}};

void (*cm1e_py_call_of(const char *type))(void *fb)
{{
    for (size_t i = 0; i < sizeof block_types / sizeof block_types[0]; i++)
        if (strcmp(block_types[i].type, type) == 0)
            return block_types[i].call;
    return NULL;
}}
"""


def codes(ffi):
    """codes.py: enumerations of the headers, for people who program in Python."""
    text = '"""Numbers of the public headers with their names. Generated from them."""\nfrom enum import IntEnum\n'
    for name, kind, prefix in (("ErrorCode", "cm1e_error_t", "CM1E_"), ("AxisState", "cm1e_axis_state_t", "CM1E_AXIS_"),
                               ("GroupState", "cm1e_group_state_t", "CM1E_GROUP_")):
        rows = "".join(f"    {entry.removeprefix(prefix)} = {number}\n" for number, entry in
                       ffi.typeof(kind).elements.items() if not entry.endswith("_STATE_COUNT"))
        text += f'\n\nclass {name}(IntEnum):\n    """{kind}."""\n\n{rows}'
    return text


def write(folder, name, text):
    with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
        file.write(text)


def main(source, folder, compiler="cc"):
    sys.dont_write_bytecode = True
    sys.path.insert(0, os.path.join(source, "fb", "interface"))
    sys.path.insert(0, HERE)
    import cffi
    import generate
    import st
    import make_blocks

    files = [st.Reader(f"fb/interface/{name}", generate.read(f"fb/interface/{name}")).read() for name in generate.FILES]
    blocks = [block.name for file in files for block in file.blocks()]
    ffi = cffi.FFI()
    ffi.cdef(declarations(source, compiler))
    includes = "#include <string.h>\n" + "".join(f'#include "{name}"\n' for name in HEADERS)
    ffi.set_source("cm1e._cm1e", includes + calls(blocks))
    os.makedirs(folder, exist_ok=True)
    ffi.emit_c_code(os.path.join(folder, "_cm1e.c"))
    write(folder, "blocks.py", make_blocks.module(files))
    write(folder, "codes.py", codes(ffi))


if __name__ == "__main__":
    main(*sys.argv[1:])
