#!/usr/bin/env python3
"""Files of a PLC project of TwinCAT, which are XML with Structured Text in it: what stands in which part of them, that
errors name the line and the column of the file, and what is not in Structured Text.

test_st_twincat.py BIN-DIRECTORY
"""
import os
import subprocess
import sys
import tempfile

from st_host import Host

BIN = sys.argv[1]
HEAD = '<?xml version="1.0" encoding="utf-8"?>\n<TcPlcObject Version="1.1.0.1" ProductVersion="3.1.4024.0">\n'
faults = []


def code(declaration, body=None):
    """What a POU, a method and so on have; without a body as an interface has it."""
    text = f"    <Declaration><![CDATA[{declaration}]]></Declaration>\n"
    return text if body is None else text + f"    <Implementation>\n      <ST><![CDATA[{body}]]></ST>\n    </Implementation>\n"


def element(name, attributes, content):
    return f"  <{name} {attributes}>\n{content}  </{name}>\n"


def whole(kind, name, content):
    return HEAD + element(kind, f'Name="{name}" Id="{{1}}"', content) + "</TcPlcObject>\n"


# What is before the first word of a declaration; words in comments and texts are none of the file's own.
BEFORE = ("", "\n\n", "(* FUNCTION of PROGRAM *)\n", "// FUNCTION_BLOCK \n// INTERFACE\n", "{attribute 'PROGRAM'}\n",
          "{a}{b}\n(* c *) (**)\n// d\n")
COUNTER = ("FUNCTION_BLOCK FB_Counter IMPLEMENTS I_Counter\nVAR\n  n, calls : INT;\nEND_VAR\n",
           "calls := calls + 1; // </ST> <Declaration>\n")
PARTS = (element("Method", 'Name="Add"', code("METHOD Add : INT\nVAR_INPUT more : INT; END_VAR\n", "n := n + more; Add := n;")) +
         element("Action", 'Name="Clear"', "    <Implementation>\n      <ST><![CDATA[n := 0;]]></ST>\n    </Implementation>\n") +
         element("Property", 'Name="Level"', code("PROPERTY Level : INT\n") +
                 element("Get", 'Name="Get"', code("VAR\nEND_VAR\n", "Level := 10 * n;")) +
                 element("Set", 'Name="Set"', code("VAR\nEND_VAR\n", "n := Level / 1;"))) +
         '  <LineIds Name="FB_Counter">\n    <LineId Id="1" Count="0" />\n  </LineIds>\n')
MAIN = ("PROGRAM MAIN\nVAR\n  fb, other : FB_Counter; any : I_Counter; a, b, c, d, e : INT; point : ST_Point; text : STRING := 'PROGRAM';\n"
        "END_VAR\n",
        "fb(); a := fb.Add(more := 3); a := fb.Add(more := 4); b := fb.Level; fb.Level := 5; c := fb.Level;\n"
        "any := fb; d := any.Add(more := GVL.step); other.Add(more := 7); other.Clear(); point.y := F_Twice(v := GVL.step);\n"
        "IF text < 'Q' AND a <> 8 THEN e := e + 1; END_IF\n")
FILES = {
    "I_Counter.TcIO": whole("Itf", "I_Counter", code("INTERFACE I_Counter\n") + element(
        "Method", 'Name="Add"', code("METHOD Add : INT\nVAR_INPUT more : INT; END_VAR\n"))),
    "ST_Point.TcDUT": whole("DUT", "ST_Point", code("TYPE ST_Point :\nSTRUCT\n  x, y : INT;\nEND_STRUCT\nEND_TYPE\n")),
    "GVL.TcGVL": whole("GVL", "GVL", code("{attribute 'qualified_only'}\nVAR_GLOBAL\n  step : INT := 21;\nEND_VAR\n")),
    "F_Twice.TcPOU": whole("POU", "F_Twice", code("FUNCTION F_Twice : INT\nVAR_INPUT v : INT; END_VAR\n", "F_Twice := 2 * v;")),
}
EXPECTED = {"MAIN.a": 7, "MAIN.b": 70, "MAIN.c": 50, "MAIN.d": 26, "MAIN.e": 1, "MAIN.point.y": 42, "MAIN.fb.calls": 1,
            "MAIN.fb.n": 26, "MAIN.other.n": 0}


def write(folder, files):
    paths = [os.path.join(folder, name) for name in files]
    for path, text in zip(paths, files.values()):
        with open(path, "w", encoding="utf-8") as file:
            file.write(text)
    return paths


def check_values(folder, name, before, empty):
    """Of a program whose POUs begin with `before`; its last file is that of the host."""
    counter = element("POU", 'Name="FB_Counter"', code(before + COUNTER[0], COUNTER[1]) + PARTS) + empty
    files = {**FILES, "FB_Counter.TcPOU": HEAD + counter + "</TcPlcObject>\n"}
    host = Host(BIN, folder, whole("POU", "MAIN", code(before + MAIN[0], MAIN[1])), name, *write(folder, files))
    if not host.run():
        faults.append(f"{name}: {host.fault()}")
    found = {variable: host.value(variable) if variable in host.variables else None for variable in EXPECTED}
    faults.extend(f"{name}: {variable} is {found[variable]}; expected {EXPECTED[variable]}" for variable in EXPECTED
                  if found[variable] != EXPECTED[variable])


def check_error(folder, name, text, place, words):
    """The place is that of the mark ~ in the text, or the one that is stated."""
    before = text.split("~")[0]
    wanted = place or f"{before.count(chr(10)) + 1}:{len(before) - before.rfind(chr(10))}"
    path, = write(folder, {name: text.replace("~", "")})
    result = subprocess.run([os.path.join(BIN, "cm1e"), "st", "check", path], capture_output=True, text=True, timeout=60)
    first = result.stderr.split("\n", 1)[0]
    if result.returncode != 1 or f":{wanted}: error: " not in first or words not in first:
        faults.append(f"{name}: expected {wanted} and {words!r}, found {result.returncode}, {result.stderr}")


GOOD = "PROGRAM MAIN\nVAR\n  n : INT;\nEND_VAR\n"
ERRORS = [
    (whole("POU", "MAIN", code("PROGRAM MAIN\nVAR\n  n : ~INTT;\nEND_VAR\n", "n := 1;")), "", "INTT"),
    (whole("POU", "MAIN", code(GOOD, "n := 1;\n  n := ~m;\n")), "", '"m"'),
    (whole("POU", "MAIN", code(GOOD, "~m := 1;")), "", '"m"'),
    (whole("POU", "MAIN", code(GOOD, "n := 1;") + element("Action", 'Name="Go"', "<Implementation><ST><![CDATA[\n\n\t~m := 1;]]></ST>"
                                                         "</Implementation>\n")), "", '"m"'),
    (whole("POU", "MAIN", code(GOOD, "n := 1;") + element("Method", 'Name="Go"', code("METHOD Go\n", "n := 1; ~m := 2;"))), "", '"m"'),
    (whole("POU", "MAIN", "<!-- a comment\nof two lines -->\n" + code(GOOD, "~m := 1;")), "", '"m"'),
    # What is between the parts is no Structured Text, whatever it is.
    (whole("POU", "MAIN", code(GOOD) + "<Folder><![CDATA[q := 1;\n]]></Folder>\n<Implementation><ST><![CDATA[n := ~m;]]></ST></Implementation>\n"),
     "", '"m"'),
    *((whole("POU", "MAIN", code(GOOD) + f"    <Implementation>\n      <{part}>\n      </{part}>\n    </Implementation>\n"), "10:1",
       f"not in Structured Text (it is <{part}>)") for part in ("NWL", "SFC", "CFC", "LD", "FBD", "IL", "UML")),
]

with tempfile.TemporaryDirectory() as home:
    for i, text in enumerate(BEFORE):
        check_values(home, f"before{i}", text, "  <ObjectProperties><XmlArchive/></ObjectProperties>\n" if i % 2 else "")
    for i, (text, at, told) in enumerate(ERRORS):
        check_error(home, f"error{i}.TcPOU", text, at, told)
    # A file that ends too early: whatever is cut off, it is told, and never ends the translator.
    source = whole("POU", "MAIN", code(GOOD, "n := n + 1;") + PARTS)
    for size in range(len(HEAD) + 60, len(source), 7):
        cut, = write(home, {"cut.TcPOU": source[:size]})
        done = subprocess.run([os.path.join(BIN, "cm1e"), "st", "check", cut], capture_output=True, timeout=60, check=False)
        if done.returncode not in (0, 1):
            faults.append(f"cut off behind {size}: {done.returncode}, {done.stderr}")
if faults:
    sys.exit("\n".join(faults) + f"\n{len(faults)} faults")
print(f"{len(BEFORE) + len(ERRORS)} cases")
