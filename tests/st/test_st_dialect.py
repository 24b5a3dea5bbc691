#!/usr/bin/env python3
"""What TwinCAT and CODESYS have and the standard has not, or has since its 3rd edition: VAR_STAT and VAR_INST, ARRAY[*],
STRUCT with EXTENDS, UNION; and lists of initial values. Programs by the rules of the manuals, and the values that their
variables have then; what is refused is in test_st_errors.py.

test_st_dialect.py BIN-DIRECTORY
"""
import sys
import tempfile

from st_host import Host

BIN = sys.argv[1]
# (name, source, cycles, {variable: value behind them})
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
""", 2, {"FB_A.nCalls": 19, "FB_A.aBuf[3]": 19, "FB_A.M.nCalls": 8, "Main.n": 1, "Main.m": 5, "Main.o": 60, "Main.p": 2,
      "Main.a1.FB_A.M.nLast": 2, "Main.b.FB_B.M.nLast": 52, "Main.b.FB_A.M.nLast": 9, "Main.a1.FB_A.P.get.n": 4,
      "Main.a1.mine": 4, "FB_A.P.set.q": 8, "Main.s": b"xyy"}),
    ("kept_of_a_base", """
FUNCTION_BLOCK FB_A VAR_STAT n : INT; END_VAR VAR_STAT CONSTANT k : INT := 2; END_VAR n := n + 1; END_FUNCTION_BLOCK
FUNCTION_BLOCK FB_B EXTENDS FB_A VAR_OUTPUT x : ARRAY[1..k] OF INT; END_VAR METHOD M n := n + 100; END_METHOD
  SUPER^(); n := n + 10; M(); x[k] := n; END_FUNCTION_BLOCK
PROGRAM Main VAR a : FB_A; b : FB_B; END_VAR a(); b(); END_PROGRAM
""", 2, {"FB_A.n": 224, "Main.b.x[2]": 224}),
    ("kept_by_this", """
VAR_GLOBAL g : INT; END_VAR
FUNCTION_BLOCK FB_A VAR_STAT n : INT := 2; list : ARRAY[1..2] OF INT; END_VAR VAR_STAT CONSTANT k : INT := 4; END_VAR
  VAR_EXTERNAL g : INT; END_VAR METHOD M THIS^.list[2] := THIS^.k + THIS^.n; END_METHOD
  THIS^.n := THIS^.n + 1; M(); THIS^.g := THIS^.list[2]; END_FUNCTION_BLOCK
PROGRAM Main VAR a : FB_A; END_VAR a(); END_PROGRAM
""", 1, {"FB_A.n": 3, "FB_A.list[2]": 7, "g": 7}),
    ("references_to_kept", """
FUNCTION_BLOCK FB_A METHOD M : INT VAR_INST c : INT := 3; q : REFERENCE TO INT; END_VAR VAR_STAT s : INT; END_VAR
  VAR r : REF_TO INT; END_VAR r := REF(c); r^ := r^ + 1; r := ADR(s); r^ := 5; q REF= c; q := q + 10; M := c; END_METHOD END_FUNCTION_BLOCK
PROGRAM Main VAR a : FB_A; n : INT; END_VAR n := a.M(); END_PROGRAM
""", 1, {"Main.n": 14, "Main.a.FB_A.M.c": 14, "FB_A.M.s": 5}),
    # What is assigned may lie partly in what it is assigned to.
    ("overlapping", """
TYPE ST_List : STRUCT a : ARRAY[0..99] OF INT; END_STRUCT; ST_Behind : STRUCT k : INT; l : ST_List; END_STRUCT;
  U_Both : UNION l : ST_List; behind : ST_Behind; END_UNION END_TYPE
PROGRAM Main VAR u : U_Both; m AT %MB0 : ARRAY[0..99] OF INT; n AT %MB2 : ARRAY[0..99] OF INT; i, bad : INT; END_VAR
  FOR i := 0 TO 99 DO u.behind.l.a[i] := i; n[i] := i; END_FOR u.l := u.behind.l; m := n;
  FOR i := 0 TO 99 DO IF u.l.a[i] <> i OR m[i] <> i THEN bad := bad + 1; END_IF END_FOR
  u.behind.l := u.l; n := m;
  FOR i := 0 TO 99 DO IF u.behind.l.a[i] <> i OR n[i] <> i THEN bad := bad + 1; END_IF END_FOR END_PROGRAM
""", 1, {"Main.bad": 0}),
    ("open", """
TYPE ST_P : STRUCT a : INT; l : ARRAY[2..4] OF INT := [7,8,9]; END_STRUCT END_TYPE
VAR_GLOBAL CONSTANT gTab : ARRAY[-1..1] OF INT := [10, 20, 30]; END_VAR
FUNCTION F_Sum : DINT
VAR_IN_OUT CONSTANT a : ARRAY[*] OF INT; END_VAR
VAR i : DINT; END_VAR
FOR i := LOWER_BOUND(a, 1) TO UPPER_BOUND(a, 1) DO F_Sum := F_Sum + a[i]; IF a[i] = 99 THEN CONTINUE; END_IF END_FOR
END_FUNCTION
FUNCTION F_Fill : BOOL
VAR_IN_OUT m : ARRAY[*,*] OF LREAL; END_VAR
VAR_INPUT k : LREAL; END_VAR
VAR i, j : DINT; END_VAR
FOR i := LOWER_BOUND(ARR := m, DIM := 1) TO UPPER_BOUND(m, 1) DO
 FOR j := LOWER_BOUND(m, 2) TO UPPER_BOUND(m, 2) DO m[i, j] := k * i + j; END_FOR END_FOR
END_FUNCTION
FUNCTION F_Sort
VAR_IN_OUT a : ARRAY[*] OF INT; END_VAR
VAR i, j : DINT; t : INT; END_VAR
FOR i := LOWER_BOUND(a,1) TO UPPER_BOUND(a,1) - 1 DO FOR j := i + 1 TO UPPER_BOUND(a,1) DO IF a[j] < a[i] THEN t := a[i]; a[i] := a[j]; a[j] := t; END_IF END_FOR END_FOR
END_FUNCTION
FUNCTION F_Outer : DINT
VAR_IN_OUT b : ARRAY[*] OF INT; END_VAR
F_Sort(a := b); F_Outer := F_Sum(a := b); b[LOWER_BOUND(b,1)].0 := TRUE;
END_FUNCTION
INTERFACE I_X METHOD Use : DINT VAR_IN_OUT a : ARRAY[*] OF INT; END_VAR END_METHOD END_INTERFACE
FUNCTION_BLOCK FB_A IMPLEMENTS I_X
VAR_IN_OUT buf : ARRAY[*] OF ST_P; END_VAR
VAR_OUTPUT n : DINT; END_VAR
METHOD Use : DINT VAR_IN_OUT a : ARRAY[*] OF INT; END_VAR a[1] := a[1] + 1; Use := F_Sum(a); END_METHOD
METHOD Inner : INT buf[1].a := 5; Inner := buf[1].l[3]; END_METHOD
n := Inner(); n := n + UPPER_BOUND(buf, 1); buf[2].l[2] := 77;
END_FUNCTION_BLOCK
FUNCTION_BLOCK FB_B EXTENDS FB_A
METHOD Use : DINT VAR_IN_OUT a : ARRAY[*] OF INT; END_VAR Use := SUPER^.Use(a := a) * 2; END_METHOD
SUPER^();
END_FUNCTION_BLOCK
PROGRAM Main VAR
 x : ARRAY[1..3] OF INT := [3,1,2]; y : ARRAY[0..4] OF INT := [5,4,3,2,1]; z : ARRAY[1..2] OF ARRAY[1..3] OF INT; m : ARRAY[0..1,-1..1] OF LREAL; m1 : ARRAY[1..1,5..6] OF LREAL;
 s1, s2, s3, s4, s5, s6 : DINT; p : ARRAY[1..2] OF ST_P; f : FB_A; g : FB_B; i : I_X; st : ST_P; o : DINT; END_VAR
VAR CONSTANT c : DINT := UPPER_BOUND(gTab, 1); END_VAR
s1 := F_Sum(gTab); s2 := F_Outer(b := y); F_Sort(x); s3 := F_Sum(x); z[2][3] := 6; s4 := F_Sum(a := z[2]);
F_Fill(m, 10.0); F_Fill(m := m1, k := 1);
f(buf := p); g(buf := p, n => o); i := g; s5 := i.Use(a := x); s6 := F_Sum(a := st.l);
END_PROGRAM
""", 1,
     {"Main.s1": 60, "Main.s2": 15, "Main.y[0]": 1, "Main.x[1]": 2, "Main.s3": 6, "Main.s4": 6, "Main.m[1,-1]": 9.0,
      "Main.m[1,1]": 11.0, "Main.m1[1,6]": 7.0, "Main.f.n": 10, "Main.o": 10, "Main.p[2].l[2]": 77,
      "Main.p[1].a": 5, "Main.s5": 14, "Main.s6": 24}),
    # A list of values replaces that of the declaration; FB_Init is called once, whatever lists there are around it.
    ("lists", """
TYPE Point : STRUCT x : INT := 6; y : INT; END_STRUCT; END_TYPE
FUNCTION_BLOCK Once VAR_INPUT x : INT := 3; END_VAR VAR_OUTPUT n : INT; END_VAR
METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; END_VAR n := n + 1; END_METHOD END_FUNCTION_BLOCK
TYPE Held : STRUCT p : Point := (x := 7, y := 9); k : INT := 2; once : Once; END_STRUCT; END_TYPE
FUNCTION_BLOCK Inits VAR_OUTPUT once : Once := (x := 5); h : Held := (k := 3); p : Point := (x := 2, y := 2); END_VAR END_FUNCTION_BLOCK
PROGRAM Main VAR a : Inits; b : Inits := (h := (p := (y := 4), once := (x := 5)), once := (x := 7), p := (y := 1));
  c : ARRAY[1..3] OF Once := [(x := 1), 2((x := 2))]; END_VAR END_PROGRAM
""", 1, {"Main.a.h.k": 3, "Main.a.h.p.x": 7, "Main.a.h.p.y": 9, "Main.a.p.x": 2, "Main.b.h.p.x": 6, "Main.b.h.p.y": 4, "Main.b.p.x": 6,
         "Main.b.p.y": 1, "Main.a.once.n": 1, "Main.b.once.n": 1, "Main.b.once.x": 7, "Main.b.h.once.n": 1, "Main.b.h.once.x": 5,
         "Main.c[1].n": 1, "Main.c[3].n": 1, "Main.c[3].x": 2}),
    ("structures", """
TYPE ST_Last EXTENDS ST_Mid : STRUCT c : STRING := 'c'; END_STRUCT; ST_Mid EXTENDS ST_First : STRUCT b : INT := 5; END_STRUCT END_TYPE
TYPE ST_First : STRUCT a : INT := 3; list : ARRAY[1..3] OF INT := [1, 2, 3]; END_STRUCT END_TYPE
TYPE extends : STRUCT x : INT; END_STRUCT; More EXTENDS Empty : STRUCT x : INT; END_STRUCT; Empty : STRUCT END_STRUCT; END_TYPE
NAMESPACE N TYPE In EXTENDS Base : STRUCT y : INT; END_STRUCT; Base : STRUCT x : INT := 8; END_STRUCT; END_TYPE END_NAMESPACE
PROGRAM Main VAR o : ST_Last := (b := 4, list := [4, 5]); p : ST_Last; n : INT; size : UDINT; e : extends; i : N.In; m : More; END_VAR
  n := p.list[2] + p.b + p.a; p := o; size := SIZEOF(p); e.x := 1; m.x := 2; END_PROGRAM
""", 1, {"Main.n": 10, "Main.size": 92, "Main.p.list[2]": 5, "Main.p.b": 4, "Main.o.a": 3, "Main.o.c": b"c", "Main.i.x": 8}),
    ("unions", """
TYPE U_Value : UNION d : DWORD; b : ARRAY[0..3] OF BYTE; r : REAL; parts : ST_Parts; END_UNION
  ST_Parts : STRUCT low : WORD; high : INT; END_STRUCT; ST_Holds : STRUCT n : BYTE; u : U_Value; END_STRUCT END_TYPE
FUNCTION F_Swap : DWORD VAR_INPUT x : DWORD; END_VAR VAR u, v : U_Value; i : INT; END_VAR
  u.d := x; FOR i := 0 TO 3 DO v.b[3 - i] := u.b[i]; END_FOR F_Swap := v.d; END_FUNCTION
FUNCTION_BLOCK FB_X VAR_INPUT u : U_Value := (b := [1, 2]); p : REF_TO U_Value; END_VAR IF p <> NULL THEN p^.b[3] := u.b[1]; END_IF END_FUNCTION_BLOCK
PROGRAM Main VAR RETAIN kept : U_Value; END_VAR VAR union : BOOL; u : U_Value := (d := 16#01020304); s : DWORD; h, h2 : ST_Holds; f : FB_X;
  m AT %MB0 : U_Value; w AT %MW2 : WORD; size : UDINT; END_VAR
  s := F_Swap(u.d); kept.r := 1.0; u.parts.high := -2; h.u.d := 7; h2 := h; m.d := 16#12345678; union := m.parts.low.3; f(p := REF(h2.u));
  size := SIZEOF(ST_Holds) * 10 + SIZEOF(u); END_PROGRAM
""", 1, {"Main.s": 0x04030201, "Main.kept.d": 0x3F800000, "Main.u.d": 0xFFFE0304, "Main.u.b[0]": 4, "Main.h2.u.parts.low": 7, "Main.w": 0x1234,
         "Main.f.u.d": 0x201, "Main.h2.u.d": 0x02000007, "Main.size": 84}),
    ("unnamed", """
TYPE Other : (Idle := 9, Run); END_TYPE
VAR_GLOBAL gMode : (Slow, Fast) := Fast; END_VAR
FUNCTION_BLOCK FB_A VAR state : (Idle, Run, Done := 7) USINT := Run; END_VAR VAR_OUTPUT n : INT; END_VAR
  METHOD Next VAR step : (One, Two) := Two; END_VAR IF step = Two THEN state := Done; END_IF END_METHOD
  CASE state OF Idle: n := 1; Run: n := 2; Next(); Done: n := n + state; END_CASE END_FUNCTION_BLOCK
FUNCTION_BLOCK FB_B EXTENDS FB_A VAR_STAT k : (Idle2, Run2) := Run2; END_VAR SUPER^(); IF state = Done AND k = Run2 THEN n := n + 100; END_IF
  END_FUNCTION_BLOCK
PROGRAM Main VAR a, b : FB_A; c : FB_B; o : Other := Idle; RETAIN1 : INT; END_VAR VAR RETAIN kept : (Off, On); END_VAR
  a(); a(); b(); c(); kept := On; IF gMode = Fast THEN gMode := Slow; END_IF END_PROGRAM
""", 1, {"Main.a.n": 9, "Main.a.state": 7, "Main.b.n": 2, "Main.c.n": 102, "Main.o": 9, "Main.kept": 1, "gMode": 0}),
    # An alias is the structure itself; a member may be an enumeration without a name, or an instance with its FB_Init.
    ("members", """
NAMESPACE N TYPE Base : STRUCT y, z : INT := 8; END_STRUCT; Far : Base; END_TYPE END_NAMESPACE
TYPE Near : N.Far; ST_A EXTENDS Near : STRUCT mode : (Idle, Run) := Run; f : FB_A(k := 3); g, h : FB_A(k := 5) := (q := 7); END_STRUCT;
  T_A : ST_A; ST_B EXTENDS T_A : STRUCT x : INT := 4; END_STRUCT; END_TYPE
FUNCTION_BLOCK FB_A VAR_INPUT q : INT; END_VAR VAR_OUTPUT n : INT; END_VAR
  METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; k : INT; END_VAR n := n + k; END_METHOD END_FUNCTION_BLOCK
PROGRAM Main VAR a : ST_B; b : ST_B := (z := 2, mode := Idle); n : INT; END_VAR
  n := a.y + b.z; IF a.mode = Run AND b.mode = Idle THEN b.mode := a.mode; END_IF END_PROGRAM
""", 1, {"Main.n": 10, "Main.b.mode": 1, "Main.a.f.n": 3, "Main.a.g.n": 5, "Main.a.h.q": 7, "Main.b.x": 4}),
    ("elements", """
FUNCTION_BLOCK FB_A VAR_INPUT q : INT; END_VAR VAR_OUTPUT n : INT; s : STRING; END_VAR
  METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; k : INT; name : STRING; END_VAR n := n + k; s := name; END_METHOD END_FUNCTION_BLOCK
FUNCTION_BLOCK FB_B EXTENDS FB_A METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; m : INT; END_VAR n := n * m; END_METHOD END_FUNCTION_BLOCK
FUNCTION_BLOCK FB_C VAR_STAT all : ARRAY[0..1] OF FB_A[(k := 8, name := 'x'), (k := 9, name := 'y')]; END_VAR VAR_OUTPUT n : INT; END_VAR n := all[1].n; END_FUNCTION_BLOCK
TYPE ST : STRUCT f : ARRAY[1..2] OF FB_A[(k := 5, name := 'e'), (k := 6, name := 'f')]; END_STRUCT; END_TYPE
VAR_GLOBAL CONSTANT TEN : INT := 10; END_VAR
PROGRAM Main VAR a : ARRAY[0..1, 1..2] OF FB_A[(k := 1, name := 'a'), (k := 2, name := 'b'), (name := 'c', k := 3), (k := TEN, name := 'd')] :=
  [(q := 7), 3((q := 8))]; b : ARRAY[1..1] OF FB_B[(k := 3, m := 4, name := '')]; c : FB_C; e : ST; END_VAR a[1, 2](); c(); END_PROGRAM
""", 1, {"Main.a[0,1].n": 1, "Main.a[0,2].n": 2, "Main.a[1,1].n": 3, "Main.a[1,2].n": 10, "Main.a[1,1].s": b"c", "Main.a[0,1].q": 7,
         "Main.a[1,2].q": 8, "Main.b[1].n": 12, "Main.c.n": 9, "Main.e.f[2].n": 6, "Main.e.f[2].s": b"f"}),
    # Inputs with an initial value may be left out at the end.
    ("left_out", """
FUNCTION F : INT VAR_INPUT a : INT := 3; b : INT := 4; END_VAR F := a * 10 + b; END_FUNCTION
FUNCTION H : INT VAR_IN_OUT q : INT; END_VAR VAR_INPUT s : STRING := 'abcd'; END_VAR q := q + 1; H := LEN(s); END_FUNCTION
INTERFACE I METHOD M : INT VAR_INPUT a : INT := 6; END_VAR END_METHOD END_INTERFACE
FUNCTION_BLOCK B IMPLEMENTS I METHOD M : INT VAR_INPUT a : INT := 6; END_VAR M := a; END_METHOD END_FUNCTION_BLOCK
PROGRAM Main VAR a, b, c, d, e, q : INT; fb : B; i : I := fb; END_VAR a := F(); b := F(1); c := H(q); d := fb.M() + F(); e := i.M(); F(); END_PROGRAM
""", 1, {"Main.a": 34, "Main.b": 14, "Main.c": 4, "Main.q": 1, "Main.d": 40, "Main.e": 6}),
    ("named_as_parts", "PROGRAM Action VAR_OUTPUT n : INT; END_VAR n := n + 1; END_PROGRAM PROGRAM Extends Method(); END_PROGRAM PROGRAM Method "
     "METHOD Go : INT Go := 5; END_METHOD END_PROGRAM PROGRAM Main VAR n : INT; END_VAR n := Action.n + Method.Go(); END_PROGRAM", 1,
     {"Main.n": 6}),
    # FB_Init runs, though nothing calls it: so does a program that it alone calls.
    ("init_of_program", "FUNCTION_BLOCK B METHOD FB_Init VAR_INPUT bInitRetains, bInCopyCode : BOOL; END_VAR Fill(); END_METHOD END_FUNCTION_BLOCK "
     "PROGRAM Fill VAR n : INT; END_VAR n := n + 5; END_PROGRAM PROGRAM Main VAR fb : B; n : INT; END_VAR n := Fill.n; END_PROGRAM", 2,
     {"Main.n": 5}),
    # A method stands behind the name of a program, too.
    ("bare", "PROGRAM Bare METHOD Go : INT Go := 5; END_METHOD END_PROGRAM PROGRAM Main; VAR n : INT; END_VAR n := Bare.Go(); END_PROGRAM",
     1, {"Main.n": 5}),
    ("open_texts", """
FUNCTION G : INT VAR_IN_OUT a : ARRAY[*] OF STRING(5); END_VAR a[1] := 'abcdefg'; G := LEN(a[2]); END_FUNCTION
PROGRAM Main VAR x : ARRAY[1..3] OF STRING(5) := [3('ab')]; n : INT; END_VAR n := G(a := x); END_PROGRAM
""", 1, {"Main.x[1]": b"abcde", "Main.n": 2}),
]
OPEN = "FUNCTION_BLOCK F VAR_IN_OUT a : ARRAY[*] OF INT; END_VAR VAR_INPUT at1 : INT; END_VAR METHOD M a[1] := 1; END_METHOD " \
       "a[at1] := 1; END_FUNCTION_BLOCK PROGRAM Main VAR x : ARRAY[1..3] OF INT; f : F; END_VAR {} END_PROGRAM"
# (source, words of what stops it)
FAULTS = [
    (OPEN.format("f(a := x, at1 := 4);"), "the index 4 is outside 1..3"),
    (OPEN.format("f(a := x, at1 := 0);"), "the index 0 is outside 1..3"),
    (OPEN.format("f(a := x, at1 := 1); f.M();"), "has no variable yet"),
]
faults = []


with tempfile.TemporaryDirectory() as folder:
    for name, source, cycles, expected in PROGRAMS:
        host = Host(BIN, folder, source, name)
        if not all(host.run() for _ in range(cycles)):
            faults.append(f"{name}: {host.fault()}")
            continue
        found = {variable: host.value(variable) if variable in host.variables else None for variable in expected}
        faults += [f"{name}: {variable} is {found[variable]!r}; expected {expected[variable]!r}"
                   for variable in expected if found[variable] != expected[variable]]
    for number, (source, words) in enumerate(FAULTS):
        host = Host(BIN, folder, source, f"fault{number}")
        if host.run() or words not in host.fault()[1]:
            faults.append(f"{source}: {host.fault()}")
if faults:
    sys.exit("\n".join(faults) + f"\n{len(faults)} faults")
print(f"{len(PROGRAMS) + len(FAULTS)} programs")
