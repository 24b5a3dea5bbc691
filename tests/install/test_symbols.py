#!/usr/bin/env python3
"""Every external symbol of the static libraries begins with cm1e_, MC_, CM_ or iec_, so that the library can be linked
into any program. SOEM's symbols carry the prefix cm1e_ too (src/nic/port/soem_names.h). The shared libraries together
export the functions of the public headers, each once, and libcm1e.so what it shares with its guests (CM1E_GUEST_API).

test_symbols.py NM SOURCE-DIRECTORY LIBRARY...
"""
import glob
import os
import re
import subprocess
import sys

OURS = re.compile(r"(cm1e|MC|CM|iec)_")
EXPORTED = re.compile(r'^CM1E_(?:GUEST_)?API [^;(]*?(\w+)\([^;]*?\)\s*(?:CM1E_SYMBOL\("(\w+)"\)|CM1E_PRINTF\([\d, ]+\))?;', re.MULTILINE)


def symbols(nm, *arguments):
    """(name, where it is defined) of every external symbol."""
    listed = subprocess.run([nm, "--defined-only", "--extern-only", "--print-file-name", *arguments], check=True,
                            capture_output=True, text=True).stdout
    for line in listed.splitlines():
        where, _, symbol = line.rpartition(" ")
        yield symbol, where.rpartition(":")[0]


def marked_functions(source, headers):
    """Those with CM1E_API or CM1E_GUEST_API, as the linker knows them."""
    names = set()
    for path in glob.glob(os.path.join(source, headers)):
        with open(path, encoding="utf-8") as file:
            names.update(label or name for name, label in EXPORTED.findall(file.read()))
    return names


def main(nm, source, *libraries):
    count, faults = 0, []
    static = [library for library in libraries if library.endswith(".a")]
    shared = [library for library in libraries if not library.endswith(".a")]
    for library in static:
        for symbol, where in symbols(nm, library):
            count += 1
            if not OURS.match(symbol):
                faults.append(f"{where}: {symbol} has none of the prefixes cm1e_, MC_, CM_, iec_")
    exported = [symbol for library in shared for symbol, _ in symbols(nm, "--dynamic", library)]
    public, for_guests = marked_functions(source, "include/cm1e/*.h"), marked_functions(source, "src/*/*.h")
    faults += [f"{name} is exported, which no header marks" for name in sorted(set(exported) - public - for_guests)]
    faults += [f"{name} is not exported, which a header marks" for name in sorted((public | for_guests) - set(exported))]
    faults += [f"{name} is exported by two libraries" for name in sorted({x for x in exported if exported.count(x) > 1})]
    print("\n".join(faults) or f"all {count} external symbols of {len(static)} static libraries have our prefixes; "
          f"{len(shared)} shared ones export {len(public)} public functions and {len(for_guests)} for guests")
    return 1 if faults or count < 500 or len(public) < 100 or len(shared) < 2 else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
