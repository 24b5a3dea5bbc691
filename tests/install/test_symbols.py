#!/usr/bin/env python3
"""Every external symbol of the static libraries begins with cm1e_, MC_, CM_ or iec_, so that the library can be linked
into any program. SOEM's symbols carry the prefix cm1e_ too (src/nic/port/soem_names.h).

test_symbols.py NM STATIC-LIBRARY...
"""
import re
import subprocess
import sys

OURS = re.compile(r"(cm1e|MC|CM|iec)_")


def symbols(nm, library):
    """(name, where it is defined) of every external symbol of a static library."""
    listed = subprocess.run([nm, "--defined-only", "--extern-only", "--print-file-name", library], check=True,
                            capture_output=True, text=True).stdout
    for line in listed.splitlines():
        where, _, symbol = line.rpartition(" ")
        yield symbol, where.rpartition(":")[0]


def main(nm, *libraries):
    count, faults = 0, []
    for library in libraries:
        for symbol, where in symbols(nm, library):
            count += 1
            if not OURS.match(symbol):
                faults.append(f"{where}: {symbol} has none of the prefixes cm1e_, MC_, CM_, iec_")
    print("\n".join(faults) or f"all {count} external symbols of {len(libraries)} libraries have our prefixes")
    return 1 if faults or count < 500 else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
