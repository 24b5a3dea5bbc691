#!/usr/bin/env python3
"""Methods, properties, interfaces, EXTENDS, THIS^ and SUPER^: which method is called, and what it sees; EN and ENO; and what
is refused.

test_st_objects.py BIN-DIRECTORY
"""
import json
import os
import subprocess
import sys
import tempfile

from st_host import Host

BIN = sys.argv[1]
PROGRAM = """
// Comments and pragmas stand anywhere.
INTERFACE I_Shape
(* first *) METHOD (* of two *) Area : LREAL
END_METHOD
METHOD Scale : BOOL
VAR_INPUT factor : LREAL; END_VAR
END_METHOD
PROPERTY Name : STRING[20]
GET END_GET
END_PROPERTY
END_INTERFACE

FUNCTION_BLOCK ABSTRACT FB_Base IMPLEMENTS I_Shape
VAR calls, bodies : INT; END_VAR
VAR_OUTPUT total : LREAL; END_VAR
METHOD ABSTRACT Area : LREAL
END_METHOD
METHOD PUBLIC Scale : BOOL
VAR_INPUT factor : LREAL; END_VAR
calls := calls + 1;
Scale := factor > 0;
END_METHOD
METHOD Note
total := total + Area();
END_METHOD
PROPERTY Name : STRING[20]
GET
Name := 'base';
END_GET
END_PROPERTY
bodies := bodies + 1;
END_FUNCTION_BLOCK

FUNCTION_BLOCK FB_Square EXTENDS (* of {both} *) FB_Base
VAR_INPUT side : LREAL := 2; END_VAR
METHOD Area : LREAL
Area := side * side;
END_METHOD
METHOD Scale : BOOL
VAR_INPUT factor : LREAL; END_VAR
Scale := SUPER^.Scale(factor);
IF Scale THEN THIS^.side := side * factor; END_IF
END_METHOD
// twice the side
{attribute 'doubled'}
PROPERTY Side2 : LREAL // read
GET // and written
Side2 := side * 2;
END_GET
SET
side := Side2 / 2;
END_SET
END_PROPERTY
SUPER^(); // the end
/* again */ ACTION Clear: total := 0; END_ACTION
END_FUNCTION_BLOCK

FUNCTION_BLOCK FB_Circle EXTENDS FB_Base
VAR r : LREAL := 1; END_VAR
METHOD Area : LREAL
Area := 3 * r * r;
END_METHOD
PROPERTY Name : STRING[20]
GET
Name := 'circle';
END_GET
END_PROPERTY
END_FUNCTION_BLOCK

TYPE Start : STRUCT a : INT := 5; END_STRUCT; END_TYPE
INTERFACE I_Go METHOD Go : INT VAR_INPUT k : INT; s : Start; l : INT := 3; END_VAR END_METHOD END_INTERFACE
FUNCTION_BLOCK ABSTRACT FB_Go IMPLEMENTS I_Go VAR n : INT := 9; END_VAR
METHOD ABSTRACT Go : INT VAR_INPUT k : INT; s : Start; l : INT := 3; END_VAR END_METHOD
METHOD Twice : INT Twice := Go(k := 1) * 2; END_METHOD
METHOD Given : INT VAR_INPUT k : INT; r : REF_TO INT := REF(n); v : REFERENCE TO INT := n; END_VAR Given := r^ * k + v; END_METHOD
END_FUNCTION_BLOCK
FUNCTION_BLOCK FB_Went EXTENDS FB_Go
METHOD Go : INT VAR_INPUT k : INT; s : Start; l : INT := 3; END_VAR Go := s.a * 10 + k + l; END_METHOD
END_FUNCTION_BLOCK
FUNCTION Log2 : INT VAR_INPUT step : INT; END_VAR Log2 := step; END_FUNCTION
FUNCTION_BLOCK FB_Log VAR_INPUT step : INT; END_VAR VAR_OUTPUT o : INT; END_VAR o := o + step * 2; END_FUNCTION_BLOCK

VAR_GLOBAL gi : INT := 4; gref : REF_TO INT := REF(gi); END_VAR
FUNCTION NEXT_OF : INT VAR_IN_OUT c : INT; END_VAR c := c + 1; NEXT_OF := c; END_FUNCTION
INTERFACE I_Empty END_INTERFACE
FUNCTION_BLOCK FB_Drive IMPLEMENTS I_Empty
VAR class : INT := 1; END_VAR VAR CONSTANT fixed : INT := 3; END_VAR
PROPERTY Grade : INT GET Grade := class + fixed; END_GET SET class := Grade; END_SET END_PROPERTY
METHOD Axis_Reset : INT Axis_Reset := class; END_METHOD
METHOD Calc : INT VAR_INPUT x : INT; END_VAR Calc := x * 2; END_METHOD
METHOD Local : INT VAR own : INT; END_VAR Local := NEXT_OF(c := own); END_METHOD
END_FUNCTION_BLOCK
FUNCTION_BLOCK FB_Drive_Axis EXTENDS FB_Drive
METHOD Reset : INT Reset := 2; END_METHOD
PROPERTY Grade : INT GET Grade := SUPER^.Grade * 2; END_GET SET SUPER^.Grade := Grade + 1; END_SET END_PROPERTY
METHOD Calc : INT VAR_INPUT x : INT; END_VAR Calc := SUPER^.Calc(x := x) + x; END_METHOD
END_FUNCTION_BLOCK
FUNCTION_BLOCK FB_User
VAR what : I_Shape; own : INT := 3; inner : REF_TO INT := REF(own); also : REFERENCE TO INT REF= gi; too : REFERENCE TO INT := gi; END_VAR
VAR_INPUT ref : REF_TO INT; END_VAR
METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; what : I_Shape; END_VAR THIS^.what := what; END_METHOD
METHOD Sum : INT Sum := LREAL_TO_INT(what.Area()) * 1000 + ref^ * 100 + inner^ * 10 + also + too - 4; END_METHOD
END_FUNCTION_BLOCK

FUNCTION LEFTOVER : INT VAR_INPUT a : INT; END_VAR
LEFTOVER := a MOD 4;
END_FUNCTION

PROGRAM Main
VAR sq : FB_Square; ci : FB_Circle; shape, none : I_Shape; a1, a2, a3 : LREAL; n1, n2 : STRING[20]; is0, isnt0, ok : BOOL; s2, method, get : LREAL;
drive : FB_Drive; axis : FB_Drive_Axis; shapes : ARRAY[1..2] OF I_Shape; empties : ARRAY[1..2] OF I_Empty; names, sums, grade : INT;
left, kept, viaref, injected, mine : INT; eno, eno2, timer : BOOL; t : TON;
went : FB_Went; igo : I_Go := went; goes, logs : INT; wents : ARRAY[1..2] OF FB_Went;
logger : FB_Log; log : REFERENCE TO FB_Log; log2 : REFERENCE TO FB_Log; kept9 : INT := 9; ref : REF_TO INT := REF(kept9); early : I_Shape := sq; user : FB_User(what := ci) := (ref := REF(kept9)); END_VAR
ACTION Init: a3 := 5; END_ACTION
is0 := none = 0;
shape := sq;
isnt0 := shape <> 0;
a1 := shape.Area();
n1 := shape.Name;
ok := shape.Scale(factor := 1.5);
sq();
sq.Note();
shape := ci;
a2 := shape.Area();
n2 := shape.Name;
ci.Note();
sq.Side2 := 20;
s2 := sq.Side2;
Init();
method := 1; get := method + 1;
left := LEFTOVER(EN := TRUE, a := 7, ENO => eno);
kept := 7;
kept := LEFTOVER(EN := FALSE, a := 8, ENO => eno2);
shapes[1] := sq; empties[1] := drive;
names := drive.Axis_Reset() * 10 + axis.Reset();
sums := axis.Calc(4) + axis.Calc(5) * 100 + axis.Local();
grade := axis.Grade; axis.Grade := 6; grade := grade * 100 + axis.Grade;
viaref := ref^ + gref^;
injected := user.Sum();
mine := LREAL_TO_INT(early.Area());
goes := igo.Go(k := 2) + went.Twice() * 10 + wents[2].Given(k := 10);
log REF= logger; log(step := 3); log2 REF= logger; log2(step := 4); logs := logger.o;
t(EN := FALSE, IN := TRUE, PT := T#0s, Q => timer);
END_PROGRAM
"""
EXPECTED = {"a1": 4, "n1": b"base", "ok": True, "a2": 3, "n2": b"circle", "is0": True, "isnt0": True, "a3": 5, "s2": 20,
            "sq.total": 9, "sq.calls": 1, "sq.bodies": 1, "sq.side": 10, "ci.total": 3, "ci.calls": 0, "method": 1, "get": 2,
            "left": 3, "eno": True, "eno2": False, "kept": 7, "timer": False, "viaref": 13,
            "injected": 3934, "names": 12, "grade": 820, "sums": 1513, "mine": 100, "goes": 55 + 1080 + 99, "logs": 14}
# What a method uses of the VAR_IN_OUT of its block before that has a variable.
IN_OUT = "FUNCTION_BLOCK F VAR_IN_OUT x : INT; END_VAR METHOD M : INT M := x; END_METHOD METHOD N THIS.x := THIS.x + 1; END_METHOD " \
         "METHOD O THIS^(x := x); END_METHOD x := x; END_FUNCTION_BLOCK FUNCTION_BLOCK E EXTENDS F METHOD P SUPER^(); END_METHOD " \
         "END_FUNCTION_BLOCK\n" \
         "FUNCTION_BLOCK C VAR_IN_OUT CONSTANT x : INT; END_VAR METHOD M : INT M := x; END_METHOD END_FUNCTION_BLOCK\n" \
         "FUNCTION_BLOCK W VAR f : F; c : C; END_VAR METHOD Cyclic : INT VAR_IN_OUT x : INT; END_VAR f(x := x); c(x := x); " \
         "Cyclic := f.M(); END_METHOD METHOD Get : INT Get := f.M() + c.M(); END_METHOD END_FUNCTION_BLOCK\n" \
         "FUNCTION Lend : INT VAR_IN_OUT f : F; x : INT; END_VAR f(x := x); END_FUNCTION\n" \
         "PROGRAM Q VAR f : F; e : E; c : C; w : W; i, n : INT; END_VAR VAR_TEMP t : INT; END_VAR "
WITHOUT = ["i := f.M();", "f.O();", "e.P();", "c(x := 3); i := c.M();"]
BASE = "INTERFACE I METHOD M : INT END_METHOD END_INTERFACE FUNCTION_BLOCK B METHOD M : INT M := 1; END_METHOD " \
       "END_FUNCTION_BLOCK "
PRIVATE = "FUNCTION_BLOCK C METHOD PRIVATE Own : INT Own := 1; END_METHOD METHOD PROTECTED Near : INT Near := Own(); " \
          "END_METHOD METHOD PUBLIC FINAL Last : INT Last := 1; END_METHOD PROPERTY PRIVATE X : INT GET X := 1; END_GET " \
          "SET END_SET END_PROPERTY END_FUNCTION_BLOCK "
INTERNAL = "NAMESPACE S FUNCTION_BLOCK D METHOD INTERNAL N : INT N := 1; END_METHOD PROPERTY INTERNAL X : INT GET X := 1; " \
           "END_GET END_PROPERTY END_FUNCTION_BLOCK END_NAMESPACE "
# what may be used
ALLOWED = PRIVATE + "FUNCTION_BLOCK D EXTENDS C METHOD O : INT O := Near(); O := SUPER^.Near(); O := Last(); END_METHOD " \
    "END_FUNCTION_BLOCK NAMESPACE S FUNCTION_BLOCK G METHOD INTERNAL N END_METHOD END_FUNCTION_BLOCK NAMESPACE T " \
    "FUNCTION_BLOCK H VAR g : G; END_VAR METHOD O g.N(); END_METHOD END_FUNCTION_BLOCK END_NAMESPACE END_NAMESPACE " \
    "TYPE Part : STRUCT Next : INT; END_STRUCT; Way : (Far, Near2); END_TYPE VAR_GLOBAL CONSTANT Most : INT := 3; END_VAR " \
    "FUNCTION_BLOCK L VAR c : INT; parts : ARRAY[1..2] OF Part; END_VAR VAR PUBLIC Speed : INT; END_VAR " \
    "PROPERTY Next : INT GET c := c + 1; Next := c; END_GET END_PROPERTY METHOD Get : INT Get := parts[1].Next + THIS^.Speed; " \
    "IF Get = Most AND Far = 0 THEN Get := 1; END_IF END_METHOD END_FUNCTION_BLOCK FUNCTION_BLOCK L2 VAR c : INT; END_VAR " \
    "PROPERTY Speed : INT GET c := c + 1; Speed := c; END_GET END_PROPERTY PROPERTY Most : INT GET c := 2; Most := c; END_GET " \
    "END_PROPERTY PROPERTY Far : INT GET c := 2; Far := c; END_GET END_PROPERTY END_FUNCTION_BLOCK " \
    "PROGRAM P VAR d : D; n : INT; l : L; END_VAR n := d.O(); n := d.Last(); n := l.Get() + l.Get(); END_PROGRAM"
# (source behind BASE, what is said)
REFUSED = [
    ("FUNCTION_BLOCK D EXTENDS G END_FUNCTION_BLOCK", 'no function block "G"'),
    ("FUNCTION_BLOCK D IMPLEMENTS J END_FUNCTION_BLOCK", 'no interface "J"'),
    ("FUNCTION_BLOCK D IMPLEMENTS I END_FUNCTION_BLOCK", 'no method "M"'),
    ("FUNCTION_BLOCK D EXTENDS D END_FUNCTION_BLOCK", "extends itself"),
    ("FUNCTION_BLOCK D EXTENDS B METHOD M : DINT END_METHOD END_FUNCTION_BLOCK", "another result"),
    ("FUNCTION_BLOCK D EXTENDS B METHOD M : INT VAR_INPUT x : INT; END_VAR END_METHOD END_FUNCTION_BLOCK", "other parameters"),
    ("FUNCTION_BLOCK ABSTRACT D END_FUNCTION_BLOCK PROGRAM P VAR d : D; END_VAR END_PROGRAM", "ABSTRACT"),
    ("FUNCTION_BLOCK ABSTRACT D METHOD ABSTRACT N END_METHOD END_FUNCTION_BLOCK FUNCTION_BLOCK E EXTENDS D "
     "END_FUNCTION_BLOCK", 'own method "N"'),
    ("FUNCTION_BLOCK D METHOD M END_METHOD METHOD M END_METHOD END_FUNCTION_BLOCK", "already"),
    ("PROGRAM P VAR b : B; i : I; END_VAR i := b; END_PROGRAM", '"i" is I, and this is B'),
    ("PROGRAM P VAR b : B; n : INT; END_VAR n := b.N(); END_PROGRAM", 'B has no "N"'),
    ("PROGRAM P VAR b : B; n : INT; END_VAR n := b.M(1); END_PROGRAM", "0 arguments"),
    ("FUNCTION_BLOCK D METHOD M M(); END_METHOD END_FUNCTION_BLOCK", "calls itself"),
    ("FUNCTION_BLOCK D EXTENDS B METHOD M : INT M := THIS^.N(); END_METHOD METHOD N : INT N := M(); END_METHOD "
     "END_FUNCTION_BLOCK", "calls itself"),
    ("FUNCTION_BLOCK D METHOD N END_METHOD N(); END_FUNCTION_BLOCK FUNCTION_BLOCK E EXTENDS D METHOD N SUPER^(); END_METHOD "
     "END_FUNCTION_BLOCK", "calls itself"),
    ("FUNCTION N : INT VAR_IN_OUT c : INT; END_VAR c := c + 1; N := c; END_FUNCTION FUNCTION_BLOCK D VAR n : INT; END_VAR METHOD G : "
     "INT G := N(c := n); END_METHOD END_FUNCTION_BLOCK PROGRAM P VAR d : D; i : INT; END_VAR i := d.G() + d.G(); END_PROGRAM",
     "can change variables"),
    ("FUNCTION_BLOCK D VAR n : INT; END_VAR METHOD G : INT G := X; END_METHOD PROPERTY X : INT GET n := n + 1; X := n; END_GET "
     "END_PROPERTY END_FUNCTION_BLOCK PROGRAM P VAR d : D; i : INT; END_VAR i := d.G() + d.G(); END_PROGRAM", "can change variables"),
    ("FUNCTION_BLOCK D IMPLEMENTS I VAR n : INT; END_VAR METHOD M : INT n := n + 1; M := n; END_METHOD END_FUNCTION_BLOCK FUNCTION N "
     ": INT VAR_INPUT o : I; END_VAR N := o.M(); END_FUNCTION PROGRAM P VAR d : D; i : INT; END_VAR i := N(d) + N(d); END_PROGRAM",
     "can change variables"),
    ("FUNCTION_BLOCK D METHOD Q R(); END_METHOD METHOD R END_METHOD END_FUNCTION_BLOCK FUNCTION_BLOCK E EXTENDS D METHOD Q SUPER^.Q(); "
     "END_METHOD METHOD R Q(); END_METHOD END_FUNCTION_BLOCK", "calls itself"),
    ("FUNCTION_BLOCK ABSTRACT D METHOD ABSTRACT Q END_METHOD END_FUNCTION_BLOCK FUNCTION_BLOCK E EXTENDS D METHOD Q SUPER^.Q(); "
     "END_METHOD END_FUNCTION_BLOCK", '"Q" of "D" is ABSTRACT'),
    ("FUNCTION_BLOCK D PROPERTY X : INT GET X := 1; END_GET END_PROPERTY END_FUNCTION_BLOCK PROGRAM P VAR d : D; END_VAR "
     "d.X := 1; END_PROGRAM", "only a variable"),
    (PRIVATE + "PROGRAM P VAR c : C; n : INT; END_VAR n := c.Own(); END_PROGRAM", '"Own" of "C" is PRIVATE'),
    (PRIVATE + "PROGRAM P VAR c : C; n : INT; END_VAR n := c.Near(); END_PROGRAM", '"Near" of "C" is PROTECTED'),
    (PRIVATE + "PROGRAM P VAR c : C; n : INT; END_VAR n := c.X; END_PROGRAM", '"X" of "C" is PRIVATE'),
    (PRIVATE + "PROGRAM P VAR c : C; END_VAR c.X := 1; END_PROGRAM", '"X" of "C" is PRIVATE'),
    (PRIVATE + "FUNCTION_BLOCK D EXTENDS C METHOD O : INT O := Own(); END_METHOD END_FUNCTION_BLOCK", "PRIVATE: only this"),
    (PRIVATE + "FUNCTION_BLOCK D EXTENDS C METHOD O : INT O := SUPER^.Own(); END_METHOD END_FUNCTION_BLOCK", "PRIVATE"),
    (PRIVATE + "FUNCTION_BLOCK D EXTENDS C METHOD Own : INT Own := 2; END_METHOD END_FUNCTION_BLOCK", '"Own" is PRIVATE in "C"'),
    (PRIVATE + "FUNCTION_BLOCK D EXTENDS C METHOD Last : INT Last := 2; END_METHOD END_FUNCTION_BLOCK", '"Last" is FINAL in "C"'),
    ("FUNCTION_BLOCK FINAL D END_FUNCTION_BLOCK FUNCTION_BLOCK E EXTENDS D END_FUNCTION_BLOCK", '"D" is FINAL'),
    ("FUNCTION_BLOCK D IMPLEMENTS I METHOD PRIVATE M : INT M := 1; END_METHOD END_FUNCTION_BLOCK", "so it is PUBLIC"),
    ("FUNCTION_BLOCK D METHOD PRIVATE PUBLIC N END_METHOD END_FUNCTION_BLOCK", "PUBLIC is too many"),
    ("FUNCTION_BLOCK D METHOD FINAL FINAL N END_METHOD END_FUNCTION_BLOCK", "FINAL stands here twice"),
    ("INTERFACE J METHOD PRIVATE N END_METHOD END_INTERFACE", "is of an interface: it is PUBLIC"),
    (INTERNAL + "VAR_GLOBAL d : S.D; x : INT := d.N(); END_VAR", "INTERNAL: only its namespace"),
    (INTERNAL + "VAR_GLOBAL d : S.D; x : INT := d.X; END_VAR", "INTERNAL: only its namespace"),
    ("FUNCTION_BLOCK D METHOD ABSTRACT FINAL N END_METHOD END_FUNCTION_BLOCK", "contradict"),
    ("NAMESPACE S FUNCTION_BLOCK D METHOD INTERNAL N END_METHOD END_FUNCTION_BLOCK END_NAMESPACE "
     "PROGRAM P VAR d : S.D; END_VAR d.N(); END_PROGRAM", "INTERNAL: only its namespace"),
    ("FUNCTION F : INT VAR_INPUT x : INT; END_VAR F := x; END_FUNCTION PROGRAM P VAR n : INT; END_VAR "
     "n := 1 + F(EN := TRUE, x := 1); END_PROGRAM", "EN"),
]
faults = []


def check_values(folder):
    host = Host(BIN, folder, PROGRAM, "objects")
    if not host.run():
        sys.exit(f"the program was stopped: {host.fault()}")
    for name, value in EXPECTED.items():
        if host.value(f"Main.{name}") != value:
            faults.append(f"{name} is {host.value(f'Main.{name}')!r}; expected {value!r}")


    if any(name.lower().endswith(".fixed") for name in host.variables):
        faults.append("a constant of a block is listed as a variable")


def check_nothing(folder):
    host = Host(BIN, folder, BASE + "PROGRAM P VAR i : I; n : INT; END_VAR n := i.M(); END_PROGRAM", "nothing")
    if host.run() or "refers to nothing" not in host.fault()[1]:
        faults.append(f"a call by an interface without an instance: {host.fault()}")


def check_in_out(folder):
    host = Host(BIN, folder, IN_OUT + "n := 4; f(x := n); i := f.M(); f.N(); END_PROGRAM", "given")
    if not host.run() or (host.value("Q.i"), host.value("Q.n")) != (4, 5):
        faults.append(f"a method and the VAR_IN_OUT of its block: {host.fault()}, {host.value('Q.i')}, {host.value('Q.n')}")
    passed = "n := 4; i := w.Cyclic(x := n); i := i * 100 + w.Get() * 10; t := Lend(f := f, x := n); i := i + f.M(); t := 6; f(x := t); " \
             "n := f.M(); END_PROGRAM"
    host = Host(BIN, folder, IN_OUT + passed, "passed")
    if not (host.run() and host.run()) or (host.value("Q.i"), host.value("Q.n")) != (484, 6):
        faults.append(f"a VAR_IN_OUT that is passed on: {host.fault()}, {host.value('Q.i')}, {host.value('Q.n')}")
    for n, statements in enumerate(WITHOUT):
        host = Host(BIN, folder, IN_OUT + statements + " END_PROGRAM", f"without{n}")
        if host.run() or f'"x" is a VAR_IN_OUT of {"C" if n == 3 else "F"} and has no variable' not in host.fault()[1]:
            faults.append(f"{statements}: {host.fault()}")


def check_refused(folder):
    path = os.path.join(folder, "refused.st")
    for source, says in REFUSED:
        with open(path, "w", encoding="ascii") as file:
            file.write(BASE + source)
        result = subprocess.run([os.path.join(BIN, "cm1e"), "st", "check", "--json", path], capture_output=True, text=True,
                                timeout=60)
        texts = [error["text"] for error in json.loads(result.stdout or "[]")]
        if result.returncode != 1 or not any(says in text for text in texts):
            faults.append(f"{source}: \"{says}\" expected, found {texts} {result.stderr}")


def check_allowed(folder):
    path = os.path.join(folder, "allowed.st")
    with open(path, "w", encoding="utf-8") as file:
        file.write(ALLOWED)
    result = subprocess.run([os.path.join(BIN, "cm1e"), "st", "check", path], capture_output=True, text=True, timeout=60)
    if result.returncode != 0:
        faults.append(f"what may be used is refused: {result}")


with tempfile.TemporaryDirectory() as directory:
    check_allowed(directory)
    check_values(directory)
    check_nothing(directory)
    check_in_out(directory)
    check_refused(directory)
if faults:
    sys.exit("\n".join(faults) + f"\n{len(faults)} faults")
