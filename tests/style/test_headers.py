#!/usr/bin/env python3
"""Public headers keep their promises: every function has a doc comment that says from where it may be called (@rt cycle,
@rt any, @rt init or @rt block), no header includes SOEM's, every header compiles alone as C11 and as C++.

test_headers.py SOURCE-DIRECTORY C-COMPILER C++-COMPILER
"""
import os
import re
import subprocess
import sys

PROTOTYPE = re.compile(r"^(?!typedef|static|#)[A-Za-z_][\w \*]*?\b(\w+)\([^;{]*\)[^;{]*;", re.MULTILINE)
MARK = re.compile(r"@rt (cycle|any|init|block)\b")


def functions(text):
    """(name, line, preceding doc comment) of every prototype outside of comments and structs."""
    blank = lambda match: re.sub(r"[^\n]", " ", match.group(0))
    code = re.sub(r"/\*.*?\*/", blank, text, flags=re.DOTALL)
    code = re.sub(r'^extern "C" \{$|^\}$', blank, code, flags=re.MULTILINE)  # around all of a header
    code = re.sub(r"\{[^{}]*\}", blank, code)
    for match in PROTOTYPE.finditer(code):
        name = match.group(1)
        block = text.find(f"typedef struct {name} {{") if f"({name}_t *fb)" in match.group(0) else -1
        before = text[: block if block >= 0 else match.start()].rstrip()  # a function block is documented at its struct
        comment = before[before.rfind("/**"):] if before.endswith("*/") else ""
        yield name, text.count("\n", 0, match.start()) + 1, comment, match.group().startswith("CM1E_API ")


def main(source, cc, cxx):
    faults = []
    folder = os.path.join(source, "include/cm1e")
    for name in sorted(os.listdir(folder)):
        path = os.path.join(folder, name)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        for function, line, comment, exported in functions(text):
            if not exported:
                faults.append(f"{name}:{line}: {function}() lacks CM1E_API")
            if not MARK.search(comment):
                faults.append(f"{name}:{line}: {function}() lacks a doc comment with @rt cycle|any|init|block")
        for included in re.findall(r'#include [<"]([^>"]+)', text):
            if included.startswith(("ethercat", "soem", "osal", "nicdrv")):
                faults.append(f"{name} includes {included}")
        for number, line in enumerate(text.splitlines(), 1):
            if len(line) > 120:
                faults.append(f"{name}:{number}: {len(line)} characters")
        for compiler, language in ((cc, ["-x", "c", "-std=c11"]), (cxx, ["-x", "c++"])):
            result = subprocess.run([compiler, *language, "-Wall", "-Wextra", "-Werror", "-fsyntax-only",
                                     "-I", os.path.join(source, "include"), "-"],
                                    input=f"#include <cm1e/{name}>\n", capture_output=True, text=True)
            if result.returncode:
                faults.append(f"{name} does not compile alone with {compiler}: {result.stderr}")
    print("\n".join(faults) or "public headers: every function says from where it may be called")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:4]))
