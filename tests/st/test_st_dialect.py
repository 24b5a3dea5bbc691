#!/usr/bin/env python3
"""What TwinCAT and CODESYS have and the standard has not, or has since its 3rd edition: VAR_STAT and VAR_INST. Programs by
the rules of their manuals, and the values that their variables have then; what is refused is in test_st_errors.py.

test_st_dialect.py BIN-DIRECTORY
"""
import sys
import tempfile

from st_host import Host

BIN = sys.argv[1]
# (name, source, {variable: value after two cycles})
PROGRAMS = [
    ("kept", """
FUNCTION_BLOCK FB_A
VAR CONSTANT cStart : INT := 7; END_VAR
VAR_STAT nCalls : INT := cStart; aBuf : ARRAY[0..cStart] OF INT; END_VAR
VAR_STAT CONSTANT k : INT := 3; END_VAR
VAR mine : INT; END_VAR
METHOD M : INT
VAR_INPUT a : INT; END_VAR
VAR_STAT nCalls : INT; END_VAR
VAR_INST nLast : INT := cStart; big : ARRAY[1..100000] OF LREAL; spot : REF_TO INT := REF(mine); END_VAR
VAR loc : INT; END_VAR
nCalls := nCalls + 1; M := nLast; nLast := a; loc := loc + 1; spot^ := spot^ + loc; big[1] := 2;
END_METHOD
PROPERTY P : INT GET VAR_INST n : INT; END_VAR n := n + 1; P := n; END_GET
SET VAR_INST n : INT; END_VAR VAR_STAT q : INT; END_VAR n := P; q := q + n; END_SET END_PROPERTY
nCalls := nCalls + k; aBuf[3] := nCalls;
END_FUNCTION_BLOCK
FUNCTION_BLOCK FB_B EXTENDS FB_A
METHOD M : INT VAR_INPUT a : INT; END_VAR VAR_INST nLast : INT := 50; END_VAR
M := SUPER^.M(a := a); M := M + nLast; nLast := nLast + 1; END_METHOD
END_FUNCTION_BLOCK
FUNCTION F : INT VAR_STAT CONSTANT two : INT := 2; END_VAR F := two; END_FUNCTION
PROGRAM Main VAR a1, a2 : FB_A; b : FB_B; n, m, o, p : INT; END_VAR
VAR_STAT RETAIN s : STRING := 'x'; END_VAR
a1(); a2(); n := a1.M(a := 1); n := a1.M(a := F()); m := a2.M(a := 5); o := b.M(a := 9);
p := a1.P; p := a1.P; p := a2.P; a1.P := 4; s := CONCAT(s, 'y');
END_PROGRAM
""", {"FB_A.nCalls": 19, "FB_A.aBuf[3]": 19, "FB_A.M.nCalls": 8, "Main.n": 1, "Main.m": 5, "Main.o": 60, "Main.p": 2,
      "Main.a1.FB_A.M.nLast": 2, "Main.b.FB_B.M.nLast": 52, "Main.b.FB_A.M.nLast": 9, "Main.a1.FB_A.P.get.n": 4,
      "Main.a1.mine": 4, "FB_A.P.set.q": 8, "Main.s": b"xyy"}),
]
faults = []


with tempfile.TemporaryDirectory() as folder:
    for name, source, expected in PROGRAMS:
        host = Host(BIN, folder, source, name)
        if not (host.run() and host.run()):
            faults.append(f"{name}: {host.fault()}")
            continue
        found = {variable: host.value(variable) if variable in host.variables else None for variable in expected}
        faults += [f"{name}: {variable} is {found[variable]!r}; expected {expected[variable]!r}"
                   for variable in expected if found[variable] != expected[variable]]
if faults:
    sys.exit("\n".join(faults) + f"\n{len(faults)} faults")
print(f"{len(PROGRAMS)} programs")
