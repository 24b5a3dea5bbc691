#!/usr/bin/env python3
"""Public headers keep their promises: every function has a doc comment that says from where it may be called (@rt cycle,
@rt any, @rt init or @rt block) and CM1E_API, no header includes SOEM's, every header compiles alone as C11, C17, C++17 and
C++20, with GCC and clang, without a warning; what is no ISO C stands in api.h alone, guarded. The everyday run compiles
all headers together in each of these ways, and each alone in two of them: once as C and once as C++.

test_headers.py SOURCE-DIRECTORY
"""
import concurrent.futures
import os
import re
import shutil
import subprocess
import sys

PROTOTYPE = re.compile(r"^(?!typedef|static|#)[A-Za-z_][\w \*]*?\b(\w+)\([^;{]*\)[^;{]*;", re.MULTILINE)
COMPILERS = [(compiler, standard) for pair in (("gcc", "g++"), ("clang", "clang++"))
             for compiler, standards in zip(pair, (("c11", "c17"), ("c++17", "c++20"))) for standard in standards]
WARNINGS = ["-Wall", "-Wextra", "-Wconversion", "-Wshadow", "-pedantic", "-Werror"]
MARK = re.compile(r"@rt (cycle|any|init|block)\b")


def functions(text):
    """(name, line, preceding doc comment) of every prototype outside of comments and structs."""
    blank = lambda match: re.sub(r"[^\n]", " ", match.group(0))
    code = re.sub(r"/\*.*?\*/", blank, text, flags=re.DOTALL)
    code = re.sub(r'^extern "C" \{$|^\}$', blank, code, flags=re.MULTILINE)  # around all of a header
    code = re.sub(r"\{[^{}]*\}", blank, code)
    for match in PROTOTYPE.finditer(code):
        name = match.group(1)
        block = text.find(f"typedef struct {name}_t {{") if f"({name}_t *fb)" in match.group(0) else -1
        before = text[: block if block >= 0 else match.start()].rstrip()  # a function block is documented at its struct
        comment = before[before.rfind("/**"):] if before.endswith("*/") else ""
        yield name, text.count("\n", 0, match.start()) + 1, comment, match.group().startswith("CM1E_API ")


def compile_them(source, names, compiler, standard):
    result = subprocess.run([compiler, "-x", "c++" if "++" in standard else "c", f"-std={standard}", *WARNINGS,
                             "-fsyntax-only", "-I", os.path.join(source, "include"), "-"],
                            input="".join(f"#include <cm1e/{name}>\n" for name in names) + "typedef int not_empty;\n",
                            capture_output=True, text=True)
    said = f"{' '.join(names)}, included alone, cannot be compiled with {compiler} -std={standard}: {result.stderr}"
    return said if result.returncode else ""


def ways(number, compilers):
    """In which the header of that number is compiled alone."""
    if os.environ.get("CM1E_TEST_EFFORT") == "full":
        return compilers
    return [compilers[at % len(compilers)] for at in (number, number + 2)]


def main(source):
    faults, runs = [], []
    compilers = [(compiler, standard) for compiler, standard in COMPILERS if shutil.which(compiler)]
    folder = os.path.join(source, "include/cm1e")
    names = sorted(os.listdir(folder))
    for place, name in enumerate(names):
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
        if name != "api.h" and re.search(r"__(?:attribute|asm|builtin|extension|typeof)", text):
            faults.append(f"{name} uses an extension of the compiler, which api.h does under guard")
        runs += [([name], *way) for way in ways(place, compilers)]
    runs += [(names, *way) for way in compilers]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        faults += [fault for fault in pool.map(lambda run: compile_them(source, *run), runs) if fault]
    print("\n".join(faults) or f"public headers: every function says from where it may be called, no warning in {len(runs)} "
          "compilations")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
