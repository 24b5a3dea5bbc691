#!/usr/bin/env python3
"""Every external symbol of the static libraries begins with cm1e_, MC_, CM_ or iec_, so that the library can be linked
into any program. SOEM's symbols carry the prefix cm1e_ too (src/nic/port/soem_names.h). The shared library exports the
functions of the public headers and nothing else.

test_symbols.py NM SOURCE-DIRECTORY SHARED-LIBRARY STATIC-LIBRARY...
"""
import glob
import os
import re
import subprocess
import sys

OURS = re.compile(r"(cm1e|MC|CM|iec)_")
EXPORTED = re.compile(r'^CM1E_API [^;(]*?(\w+)\([^;]*?\)\s*(?:CM1E_SYMBOL\("(\w+)"\)|CM1E_PRINTF\([\d, ]+\))?;', re.MULTILINE)


def symbols(nm, *arguments):
    """(name, where it is defined) of every external symbol."""
    listed = subprocess.run([nm, "--defined-only", "--extern-only", "--print-file-name", *arguments], check=True,
                            capture_output=True, text=True).stdout
    for line in listed.splitlines():
        where, _, symbol = line.rpartition(" ")
        yield symbol, where.rpartition(":")[0]


def public_functions(source):
    """As the linker knows them."""
    names = set()
    for path in glob.glob(os.path.join(source, "include/cm1e/*.h")):
        with open(path, encoding="utf-8") as file:
            names.update(label or name for name, label in EXPORTED.findall(file.read()))
    return names


def main(nm, source, shared, *libraries):
    count, faults = 0, []
    for library in libraries:
        for symbol, where in symbols(nm, library):
            count += 1
            if not OURS.match(symbol):
                faults.append(f"{where}: {symbol} has none of the prefixes cm1e_, MC_, CM_, iec_")
    exported = {symbol for symbol, _ in symbols(nm, "--dynamic", shared)}
    public = public_functions(source)
    faults += [f"{shared} exports {name}, which no public header declares with CM1E_API"
               for name in sorted(exported - public)]
    faults += [f"{shared} does not export {name}, which a public header declares" for name in sorted(public - exported)]
    print("\n".join(faults) or f"all {count} external symbols of {len(libraries)} static libraries have our prefixes; "
          f"the shared one exports the {len(public)} public functions")
    return 1 if faults or count < 500 or len(public) < 100 else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
