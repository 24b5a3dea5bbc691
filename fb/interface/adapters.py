#!/usr/bin/env python3
"""Writes what lets other compilers of Structured Text call the blocks, from the ST declarations in fb/interface/*.st:
for each compiler the declarations in its dialect, and the C or C++ between its instances and those of the library; and
the declarations as PLCopen XML. It runs in the build, because nobody reads these files. The same input gives the same
bytes.

    fb/interface/adapters.py FOLDER
"""
import sys

import adapter_matiec
import adapter_rusty
import adapter_strucpp
import dialects
import generate
import plcopen_xml
import st

# What src/st/st_embedded.c has, in its order: a program says for which interface it was made.
EMBEDDED = [f"fb/interface/{name}" for name in generate.FILES] + ["src/st/tc2_mc2.st", "src/st/tc2_blocks.st"]


def interface_number():
    """As cm1e_st_interface() computes it: FNV-1a."""
    number = 14695981039346656037
    for path in EMBEDDED:
        for byte in generate.read(path).encode():
            number = (number ^ byte) * 1099511628211 % 2 ** 64
    return number


def interface_header():
    return ("/* The interface of the blocks that these adapters were made for; the command that loads a program "
            f"compares it. */\n#define CM1E_ST_INTERFACE UINT64_C(0x{interface_number():016x})\n")


def outputs():
    """{path below the folder: text}"""
    files = [st.Reader(f"fb/interface/{name}", generate.read(f"fb/interface/{name}")).read() for name in generate.FILES]
    model = dialects.Model(files)
    result = {f"{name}/cm1e_{name}.st": dialects.declarations(model, dialect)
              for name, dialect in dialects.DIALECTS.items()}
    result["cm1e_interface.h"] = interface_header()
    result.update(adapter_rusty.files(model))
    result.update(adapter_matiec.files(model))
    result.update(adapter_strucpp.files(model))
    result.update(plcopen_xml.files(model))
    return result


def main(arguments):
    if len(arguments) != 1:
        print(__doc__, file=sys.stderr)
        return 2
    generate.write(arguments[0], outputs())
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
