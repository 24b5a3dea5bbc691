#!/usr/bin/env python3
"""What statements, function blocks and initial values do, by cases from the rules of IEC 61131-3 and from
docs/STRUCTURED-TEXT.md; and what stops a program.

test_st_semantics.py BIN-DIRECTORY
"""
import sys
import tempfile

from st_host import Host

BIN = sys.argv[1]
UNITS = """
TYPE E_Color : (Red, Green := 5, Blue); E_Small : (One := 1, Two) USINT; E_Wide : (Near, Far := 70000);
  E_Long : (Long1 := 5000000000, Long2 := -5000000000, Long3 := 7) LINT; E_Longer : (Max := 9223372036854775807) LINT;
  Point : STRUCT x : INT := 7; y : INT; END_STRUCT;
  Box : STRUCT low : Point; high : Point := (x := 9, y := 8); list : ARRAY[0..2] OF Point; END_STRUCT;
  Row : ARRAY[-1..1] OF INT; END_TYPE
FUNCTION Twice : INT VAR_INPUT v : INT := 4; END_VAR Twice := 2 * v; END_FUNCTION
FUNCTION Real : REAL VAR_INPUT v : REAL; END_VAR Real := v + 0.5; END_FUNCTION
FUNCTION Early : INT VAR_INPUT v : INT; END_VAR
  Early := 1; IF v > 0 THEN RETURN; END_IF Early := 2; END_FUNCTION
FUNCTION Split : BOOL VAR_INPUT v : INT; END_VAR VAR_OUTPUT tens, ones : INT; END_VAR VAR_IN_OUT calls : INT; END_VAR
  tens := v / 10; ones := v MOD 10; calls := calls + 1; Split := TRUE; END_FUNCTION
FUNCTION Greet : STRING VAR_INPUT who : STRING(10); END_VAR Greet := CONCAT('hi ', who); END_FUNCTION
FUNCTION WGreet : WSTRING VAR_INPUT who : WSTRING(4); END_VAR WGreet := CONCAT("hi ", who); END_FUNCTION
FUNCTION Sum : DINT VAR_INPUT v : Row; END_VAR VAR i : INT; END_VAR
  FOR i := -1 TO 1 DO Sum := Sum + v[i]; END_FOR END_FUNCTION
FUNCTION Move1 : Point VAR_INPUT p : Point; END_VAR Move1 := p; Move1.x := Move1.x + 1; END_FUNCTION
FUNCTION Bump VAR_INPUT what : REFERENCE TO INT; more : INT; END_VAR what := what + more; END_FUNCTION
FUNCTION Flat : INT VAR_INPUT d : DINT; END_VAR VAR z : DINT; END_VAR
  IF ABS(d + 0) + 0 <= z + 0 THEN Flat := 1; END_IF END_FUNCTION
FUNCTION Flat2 : INT VAR_INPUT d : DINT; END_VAR
  IF d < 0 THEN d := 0 - d; END_IF IF d <= 0 THEN Flat2 := 1; END_IF END_FUNCTION
FUNCTION_BLOCK Counter VAR_INPUT step : INT := 2; END_VAR VAR_OUTPUT total : INT := 100; END_VAR
  total := total + step; END_FUNCTION_BLOCK
FUNCTION_BLOCK Outer VAR_IN_OUT shared : INT; END_VAR VAR inner : Counter := (step := 5); END_VAR
  VAR_OUTPUT seen : INT; END_VAR VAR_TEMP t : INT; END_VAR
  t := t + 1; inner(total => seen); shared := shared + t; END_FUNCTION_BLOCK
TYPE Percent : INT (10..100); Five : INT := 5; Lamp : (Dark, Bright) := Bright;
  Part : STRUCT share : Percent; five : Five; lamp : Lamp; END_STRUCT; END_TYPE
FUNCTION Half : Percent VAR_INPUT v : Percent; END_VAR Half := v / 2 + 10; END_FUNCTION
FUNCTION_BLOCK Edges VAR_INPUT up : BOOL R_EDGE; down : BOOL F_EDGE; END_VAR VAR_OUTPUT ups, downs : INT; left : Five; END_VAR
  IF up THEN ups := ups + 1; END_IF IF down THEN downs := downs + 1; END_IF END_FUNCTION_BLOCK
FUNCTION_BLOCK Edges2 EXTENDS Edges VAR_OUTPUT mine : INT; END_VAR IF up THEN mine := mine + 1; END_IF SUPER^();
  END_FUNCTION_BLOCK
FUNCTION_BLOCK Made VAR_OUTPUT id, seen : INT; END_VAR
  METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; END_VAR id := 7; seen := 1; END_METHOD
  END_FUNCTION_BLOCK
FUNCTION_BLOCK Made2 EXTENDS Made METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; number : INT;
  who : STRING; END_VAR seen := seen * 10 + LEN(who); id := number; END_METHOD END_FUNCTION_BLOCK
FUNCTION_BLOCK Pump METHOD Set__Up : INT Set__Up := 3; END_METHOD METHOD get__level : INT get__level := 1; END_METHOD
  PROPERTY level : INT GET level := 2; END_GET END_PROPERTY END_FUNCTION_BLOCK
FUNCTION_BLOCK Pump__Set METHOD Up : INT Up := 4; END_METHOD END_FUNCTION_BLOCK
NAMESPACE Plant
  USING Tools.Math;
  CLASS ABSTRACT Shape VAR PUBLIC name : STRING := 'shape'; END_VAR VAR sides : INT := 2; END_VAR
    METHOD PUBLIC ABSTRACT Area : INT END_METHOD METHOD PUBLIC Sides : INT Sides := THIS.sides; END_METHOD END_CLASS
  CLASS Square EXTENDS Shape VAR edge : INT := 3; END_VAR
    METHOD PUBLIC OVERRIDE Area : INT Area := Double(edge) * edge / 2; END_METHOD
    METHOD PUBLIC Grow VAR_INPUT more : INT; END_VAR edge := edge + more; sides := 4 + SUPER.Sides(); END_METHOD END_CLASS
  NAMESPACE Inner TYPE Hue : (Red, Green); END_TYPE FUNCTION One : INT One := 1; END_FUNCTION
    FUNCTION Two : INT Two := One() + Inner.One(); END_FUNCTION END_NAMESPACE
END_NAMESPACE
NAMESPACE Tools.Math FUNCTION Double : INT VAR_INPUT v : INT; END_VAR Double := 2 * v; END_FUNCTION END_NAMESPACE
FUNCTION Double : INT VAR_INPUT v : INT; END_VAR Double := 200 * v; END_FUNCTION
FUNCTION Speed : INT VAR_INPUT step : INT; END_VAR Speed := step; END_FUNCTION
TYPE Nothing : STRUCT END_STRUCT; END_TYPE
FUNCTION_BLOCK Idle METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; END_VAR END_METHOD END_FUNCTION_BLOCK
FUNCTION More : INT VAR_IN_OUT CONSTANT v : INT; END_VAR More := v + 1; END_FUNCTION
FUNCTION_BLOCK Late VAR_INPUT a : INT := 1; END_VAR VAR_OUTPUT o : INT; END_VAR
  METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; n : INT; END_VAR o := a; a := n; END_METHOD END_FUNCTION_BLOCK
TYPE Lamps : ARRAY[0..2] OF Lamp; END_TYPE
FUNCTION LeftOut : INT VAR_INPUT a : INT; p : Point := (y := 4); row : Row := [1, 2, 3]; q : Point; l : Lamps; END_VAR
  LeftOut := p.x * 1000 + p.y * 100 + row[1] * 10 + q.x + l[2]; END_FUNCTION
FUNCTION_BLOCK Leaver METHOD M : INT VAR_INPUT a : INT; p : Point; END_VAR M := p.x; END_METHOD END_FUNCTION_BLOCK
FUNCTION Next : INT VAR_IN_OUT c : INT; END_VAR c := c + 1; Next := c; END_FUNCTION
FUNCTION Fill : BOOL VAR_IN_OUT w : WORD; END_VAR w := w OR 16#F0; Fill := TRUE; END_FUNCTION
TYPE E_Flags : (FlagsOff, FlagsOn := 200) BYTE := FlagsOn; Latched : STRUCT r, s : BOOL; END_STRUCT; END_TYPE
FUNCTION_BLOCK Setter VAR_OUTPUT S : BOOL := TRUE; END_VAR END_FUNCTION_BLOCK
VAR_GLOBAL flag AT %MX0.3 : BOOL := TRUE; bits AT %MB0 : BYTE; word2 AT %MW2 : WORD; low2 AT %MB2 : BYTE; real8 AT %MD8 : REAL;
  raw8 AT %MD8 : DWORD; END_VAR
VAR_GLOBAL g : INT := 3; over AT %MW20 : INT := 4; under AT %MB21 : BYTE := 7; END_VAR
FUNCTION_BLOCK Reader VAR_INPUT CONSTANT most : INT := 3; END_VAR VAR_EXTERNAL read : INT; END_VAR
  METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; k : INT; END_VAR read := read * 10 + k; END_METHOD END_FUNCTION_BLOCK
VAR_GLOBAL first1 : Reader(k := 1); read : INT := 9; second2 : Reader(k := 2); END_VAR
VAR_GLOBAL CONSTANT KK : INT := 4; KK2 : INT := KK * 2 + 1; CLess : BOOL := KK < KK2;
  CWide : BOOL := 18446744073709551615 > ULINT#1; CNan : BOOL := REAL#0.1 = LREAL#0.1 OR T#1s >= T#1001ms; CSame : BOOL := E_Color#Green <> E_Color#Red; END_VAR
"""
VARS = "i, j, n : INT; d : DINT; s : STRING(10); b : BOOL; c : E_Color; m : E_Small; p : Point; x : Box; r : Row; " \
       "w : WORD; q : REF_TO INT; q2 : REF_TO Point; z : REFERENCE TO INT; zp : REFERENCE TO Point; k : Counter; o : Outer; t : TIME; l : LREAL; f : REAL; " \
       "grid : ARRAY[1..2, 0..2] OF INT := [1, 2, 3, 2(9), 6]; u : USINT; a : ARRAY[1..KK] OF INT := [3(7)]; big : LINT; x64 : ULINT;" \
       "h : Percent; h2 : ARRAY[1..2] OF Percent; near : INT (-5..5) := 2; loop : INT (1..4); part : Part; five, five2 : Five; " \
       "e : Edges; e2 : Edges2; speed : Counter; idle : ARRAY[1..3] OF Idle; empty : ARRAY[1..3] OF Nothing; behind : BYTE := 7; late : Late(n := 5) := (a := 9); leaver : Leaver; made : Made; made2 : Made2(number := 3, who := 'abc'); sq : Plant.Square; pump : Pump; pump2 : Pump__Set; " \
       "hue : Plant.Inner.Hue; on : STRING; task, with, resource : INT; f1 : ARRAY[1..2] OF BOOL; bit : Latched; setter : Setter; flags : E_Flags; long : STRING(255); wlong : WSTRING(255); y : WSTRING(10); y2 : WSTRING := \"\u00e4$\"$20AC\";"
# The literal of a time and its value, in both directions.
TIMES = [("T#-106751d23h47m16s854ms775us808ns", -2**63), ("T#-106751d23h47m16s854ms775us807ns", 1 - 2**63),
         ("T#106751d23h47m16s854ms775us807ns", 2**63 - 1), ("T#0ms", 0), ("T#-1ns", -1), ("T#-1h500us", -3600000500000)]
# (statements, {variable: value after one call})
CASES = [
    ("IF TRUE THEN i := 1; ELSE i := 2; END_IF", {"i": 1}),
    ("y2 := TIME_TO_WSTRING(T#1h2m3s4ms5us);", {"y2": "T#1h2m3s4ms5us"}),
    ("y2 := LTIME_TO_WSTRING(LTIME#1ms2us3ns); s := LTIME_TO_STRING(LT#12ms);", {"y2": "T#1ms2us3ns", "s": b"T#12ms"}),
    ("s := TIME_TO_STRING(T#90s); y := TIME_TO_WSTRING(T#0s);", {"s": b"T#1m30s", "y": "T#0ms"}),
    ("s := TIME_TO_STRING(T#-1d7ns); y := TIME_TO_WSTRING(T#3600s);", {"s": b"T#-1d7ns", "y": "T#1h"}),
    *((f"t := {text}; y2 := TIME_TO_WSTRING(t);", {"t": value, "y2": text}) for text, value in TIMES),
    ("t := T#-106751d23h47m16s854ms775us808.4ns; b := t < T#0s AND -t = t;", {"t": -2**63, "b": True}),
    ("c := Green; i := c; j := c + 1; n := 2 * Blue - c; b := c = 5 AND 6 = Blue AND c < i + 1 AND c >= Red;",
     {"i": 5, "j": 6, "n": 7, "b": True}),
    ("c := Green; d := E_Wide.Far - c; l := c / 2.0; f := -c; i := m MOD 2; n := TO_INT(E_Wide.Far); j := a[m + 1];",
     {"d": 69995, "l": 2.5, "f": -5.0, "i": 1, "n": 4464, "j": 7}),
    ("m := Two; u := m * m; FOR i := m TO c + 4 DO n := n + i; END_FOR b := c <> Blue AND m = Two; t := T#1s * m;",
     {"u": 4, "n": 9, "b": True, "t": 2 * 10**9}),
    ("z REF= i; z := 5; j := z + 1; b := __ISVALIDREF(z);", {"i": 5, "j": 6, "b": True}),
    ("b := NOT __ISVALIDREF(z); zp REF= p; zp.y := 3; n := zp.x; zp.x := 4; Bump(what := i, more := p.x);",
     {"b": True, "n": 7, "i": 4}),
    ("z REF= i; Bump(what := z, more := 3); z REF= j; z := 9;", {"i": 3, "j": 9}),
    ("b := 1.0 / (LREAL#0.0 - i) > 0.0;", {"b": True}),  # GCC 12 alone makes -0.0 of it
    # GCC 12 alone takes |d| for above 0, which it is not at the smallest number.
    ("d := -1; FOR i := 1 TO 31 DO d := d * 2; END_FOR j := Flat(d); n := Flat2(d);", {"d": -2**31, "j": 1, "n": 1}),
    ("IF i = 1 THEN j := 1; ELSIF i = 0 THEN j := 2; ELSIF TRUE THEN j := 3; ELSE j := 4; END_IF;", {"j": 2}),
    ("i := 4; CASE i OF 1, 2: j := 1; 3..5, 9: j := 2; n := 7; ELSE j := 3; END_CASE", {"j": 2, "n": 7}),
    ("i := 6; CASE i OF 1, 2: j := 1; 3..5: j := 2; ELSE j := 3; n := 1; END_CASE", {"j": 3, "n": 1}),
    ("on := STRING#'a$'b'; y := WSTRING#\"c$\"d\"; s := on; task := 3; with := task; resource := with; i := resource;", {"s": b"a'b", "y": 'c"d', "i": 3}),
    ("i := 5; CASE i OF KK: j := 1; KK + 1: j := 2; KK + 2..2 * KK: j := 3; END_CASE", {"j": 2}),
    ("i := 7; CASE i OF KK + 2..2 * KK: j := 3; -(KK): j := 4; END_CASE", {"j": 3}),
    ("i := -3; CASE i OF -5..-1: j := 1; END_CASE", {"j": 1}),
    ("i := 9; CASE i OF 1: j := 1; END_CASE", {"j": 0}),
    ("c := Green; CASE c OF Red: j := 1; E_Color#Green: j := 2; E_Color.Blue: j := 3; END_CASE", {"j": 2}),
    ("c := Green; CASE c OF 0: j := 1; 5: j := 2; END_CASE CASE c OF Red..4: i := 1; 5..6: i := 2; END_CASE", {"i": 2, "j": 2}),
    ("u := Green; CASE u OF Red: j := 1; Green: j := 2; END_CASE w := Blue; CASE w OF 0..5: i := 1; Blue: i := 2; END_CASE",
     {"u": 5, "w": 6, "i": 2, "j": 2}),
    ("c := Green; l := c; m := Two; f := m; c := Blue; t := T#1s * Real(c);", {"l": 5.0, "f": 2.0, "t": 6500 * 10**6}),
    ("c := Green; i := MAX(c, 3) * 10 + LIMIT(Red, i, Blue); j := MUX(c - 4, 7, c, 9); n := ABS(Red - c) + SEL(b, Blue, i);",
     {"i": 50, "j": 5, "n": 11}),
    ("m := Two; w := SHL(WORD#1, m); d := MAX(m, E_Wide.Far, i); f := MIN(m, 2.5); s := LEFT('abc', m); i := MUX(m, 4, 5, 6);",
     {"w": 4, "d": 70000, "f": 2.0, "s": b"ab", "i": 6}),
    ("c := SEL(NOT b, Red, Green); m := MOVE(MUX(1, One, Two)); i := SEL(b, c, m);", {"c": 5, "m": 2, "i": 5}),
    ("t := TOD#23:59:59.9999999994 - TOD#22:58:59.9999999999;", {"t": 3660 * 10**9 - 1}),
    ("FOR i := Red TO Blue DO j := j + 1; END_FOR FOR u := Green TO Blue DO n := n + u; END_FOR", {"j": 7, "n": 11}),
    ("big := E_Longer.Max; CASE Long2 + i OF Long1..Long1: j := 1; -5000000000: j := 2; END_CASE n := Long3;",
     {"big": 2**63 - 1, "j": 2, "n": 7}),
    ("x64 := E_Wide.Far; l := Green; f := Blue;", {"x64": 70000, "l": 5.0, "f": 6.0}),
    ("CASE 3 OF KK: j := 1; 3: j := 2; END_CASE", {"j": 2}),
    ("FOR i := 1 TO 5 DO j := j + i; END_FOR", {"i": 6, "j": 15}),
    ("FOR i := 5 TO 1 BY -2 DO j := j * 10 + i; END_FOR", {"i": -1, "j": 531}),
    ("FOR i := 3 TO 1 DO j := 1; END_FOR", {"i": 3, "j": 0}),
    ("n := 3; FOR i := 1 TO n DO n := 1; j := j + 1; END_FOR", {"j": 3}),
    ("FOR u := 250 TO 255 DO j := j + 1; END_FOR", {"j": 6}),
    ("FOR i := 32760 TO 32767 BY 5 DO j := j + 1; END_FOR", {"j": 2}),
    ("FOR big := 9223372036854775806 TO 9223372036854775807 DO j := j + 1; END_FOR", {"j": 2}),
    ("FOR i := 1 TO 9 DO IF i = 3 THEN CONTINUE; END_IF IF i = 6 THEN EXIT; END_IF j := j + i; END_FOR", {"j": 12, "i": 6}),
    ("FOR i := 1 TO 3 DO FOR n := 1 TO 3 DO IF n = 2 THEN EXIT; END_IF j := j + 1; END_FOR END_FOR", {"j": 3}),
    ("FOR i := 1 TO 3 DO CASE i OF 2: EXIT; END_CASE j := i; END_FOR", {"i": 2, "j": 1}),
    ("WHILE i < 4 DO i := i + 1; IF i = 2 THEN CONTINUE; END_IF j := j + i; END_WHILE", {"i": 4, "j": 8}),
    ("REPEAT i := i + 1; IF i = 2 THEN CONTINUE; END_IF j := j + i; UNTIL i >= 4 END_REPEAT", {"i": 4, "j": 8}),
    ("REPEAT i := 7; UNTIL TRUE END_REPEAT", {"i": 7}),
    ("i := 1; RETURN; i := 2;", {"i": 1}),
    ("i := Twice(3); j := Twice(v := 5); n := Early(1) * 10 + Early(0);", {"i": 6, "j": 10, "n": 12}),
    ("b := Split(v := 47, tens => i, ones => j, calls := n); b := Split(v := 8, calls := n);", {"i": 4, "j": 7, "n": 2}),
    ("s := Greet('abcdefghijklmnop');", {"s": b"hi abcdefg"}),
    ("r[-1] := 3; r[1] := 4; d := Sum(r);", {"d": 7}),
    ("p := Move1(p); p := Move1(p);", {"p.x": 9}),
    ("k(); i := k.total; k(step := 10); j := k.total; k(5); n := k.total;", {"i": 102, "j": 112, "n": 117}),
    ("k.step := 6; k(total => d);", {"d": 106}),
    ("o(shared := g); o(shared := g, seen => i);", {"g": 5, "i": 110}),
    ("i := x.low.x; j := x.high.x * 10 + x.high.y; n := x.list[2].x;", {"i": 7, "j": 98, "n": 7}),
    ("x.list[1] := x.high; i := x.list[1].y; x.list[1].y := 1; j := x.high.y;", {"i": 8, "j": 8}),
    ("i := grid[1, 0] * 100 + grid[2, 0] * 10 + grid[2, 2]; grid[2, 1] := 4; j := grid[2, 1];", {"i": 196, "j": 4}),
    ("i := a[3]; j := a[4];", {"i": 7, "j": 0}),
    ("d := c; j := m; c := Blue; big := c;", {"d": 0, "j": 1, "big": 6}),
    ("f := MAX(1, 2.5, -3); u := MIN(7, 200); l := SIN(0.0) + ABS(-3); w := SEL(b, 1, 2);", {"f": 2.5, "u": 7, "l": 3, "w": 1}),
    ("q := REF(i); q^ := 5; q2 := REF(p); q2^.y := 6; b := q2 <> NULL;", {"i": 5, "p.y": 6, "b": 1}),
    ("w.0 := TRUE; w.15 := TRUE; i.1 := TRUE; b := w.15;", {"w": 0x8001, "i": 2, "b": 1}),
    ("w := 16#FFFF; w.3 := FALSE;", {"w": 0xFFF7}),
    ("i := KK; j := KK2;", {"i": 4, "j": 9}),
    ("i := 32767; i := i + 1; u := 0; u := u - 1;", {"i": -32768, "u": 255}),
    ("i := -32768; i := -i; j := -32768; n := -1; j := j / n;", {"i": -32768, "j": -32768}),
    ("i := -7 / 2; j := -7 MOD 2; n := 7; n := n MOD -2;", {"i": -3, "j": -1, "n": 1}),
    ("n := 0; i := 5 + 3 MOD 2 * 4; j := 7; j := j MOD n;", {"i": 9, "j": 0}),
    ("l := -2.0 ** 2; f := 2.0 ** 3;", {"l": 4.0, "f": 8.0}),
    ("i := REAL_TO_INT(2.5); j := REAL_TO_INT(3.5); n := LREAL_TO_INT(-1E9); d := TRUNC(-2.9);",
     {"i": 2, "j": 4, "n": -32768, "d": -2}),
    ("i := DINT_TO_INT(70000); u := INT_TO_USINT(-1); w := INT_TO_WORD(-2); b := INT_TO_BOOL(2);",
     {"i": 4464, "u": 255, "w": 65534, "b": 1}),
    ("t := T#1h2m3s4ms; d := TIME_TO_DINT(t); t := DINT_TO_TIME(1500);", {"d": 3723004, "t": 1500000000}),
    ("t := T#1.5s * 2; t := t + T#-500ms; t := t / 5;", {"t": 500000000}),
    ("t := T#1s * 1.5; b := t = T#1500ms;", {"b": 1}),
    ("b := TRUE" + "".join(f" AND D#{year}-{month % 12 + 1:02}-01 - D#{year}-{month:02}-{day} = T#1d" for year in (2023, 2024)
                           for month, day in enumerate((31, 28 + year % 2023, 31, 30, 31, 30, 31, 31, 30, 31, 30), 1)) + ";", {"b": 1}),
    ("b := TOD#12:30:00 - TOD#12:00:00 = T#30m; t := DT#2024-03-01-00:00:00 - DT#2024-02-28-00:00:00;",
     {"b": 1, "t": 2 * 86400 * 10 ** 9}),
    ("s := 'a$'b$$$41'; i := LEN(s);", {"s": b"a'b$A", "i": 5}),
    ("s := 'abcdefghijklmnop'; i := LEN(s);", {"s": b"abcdefghij", "i": 10}),
    ("s := 'abc'; s := CONCAT(s, s, s); i := FIND(s, 'ca'); j := FIND(s, 'x');", {"s": b"abcabcabc", "i": 3, "j": 0}),
    ("s := INT_TO_STRING(-42); i := STRING_TO_INT('123abc'); l := STRING_TO_LREAL('2.5'); b := STRING_TO_BOOL('TRUE');",
     {"s": b"-42", "i": 123, "l": 2.5, "b": 1}),
    ("i := SEL(TRUE, 1, 2); j := MUX(1, 10, 20, 30); n := LIMIT(MN := 0, IN := 9, MX := 5);", {"i": 2, "j": 20, "n": 5}),
    ("i := ADD(1, 2, 3); b := GT(3, 2); l := EXPT(2.0, 10); l := SQRT(l * l);", {"i": 6, "b": 1, "l": 1024.0}),
    # Comparisons by name: of 1 with 2, of 2 with 2, and of 3 with 2.
    *((f"i := 0; FOR j := 1 TO 3 DO n := 2; b := {name}(j, n); i := 2 * i; IF b THEN i := i + 1; END_IF END_FOR", {"i": bits})
      for name, bits in (("LT", 4), ("LE", 6), ("EQ", 2), ("NE", 5), ("GE", 3), ("GT", 1))),
    ("b := FALSE; IF b AND_THEN q^ = 1 THEN i := 1; END_IF IF TRUE OR_ELSE q^ = 1 THEN j := 1; END_IF", {"i": 0, "j": 1}),
    ("i := 2#1010 + 8#17 + 16#F + 1_000;", {"i": 1040}),
    ("x64 := 18446744073709551615; x64 := x64 / 2; big := -9223372036854775808;", {"x64": 2 ** 63 - 1, "big": -2 ** 63}),
    ("(* a (* nested *) comment *) i := 1; // line\n j := 2; /* other */ {pragma} n := 3;", {"i": 1, "j": 2, "n": 3}),
    ("i := h + h2[2]; j := near; h := 50; n := Half(v := h);", {"i": 20, "j": 2, "h": 50, "n": 35}),
    ("FOR loop := 1 TO 4 DO j := j + loop; END_FOR", {"loop": 4, "j": 10}),
    ("near := -5; near := near + 10; h2[1] := MAX(h, 99);", {"near": 5, "h2[1]": 99}),
    ("i := part.share; j := part.five; n := five * 10 + five2; b := part.lamp = Bright;", {"i": 10, "j": 5, "n": 55, "b": 1}),
    ("FOR i := 0 TO 7 DO e(up := i MOD 4 >= 2, down := i MOD 4 >= 2); e2(up := i MOD 4 >= 2); END_FOR "
     "i := e.ups * 10 + e.downs; j := e2.ups * 10 + e2.mine; e(); e(); b := e.up;", {"i": 21, "j": 22, "b": 1}),
    ("e(up := TRUE); e(); e(); i := e.ups; e(up := FALSE, down := TRUE); e(down := FALSE); j := e.downs;", {"i": 1, "j": 1}),
    ("h2[2] := MIN(MAX(h, 200), 100); h2[1] := -(-h);", {"h2[2]": 100, "h2[1]": 10}),
    ("i := LEN(y2); y := y2; b := y2 = \"\u00e4$\"\u20ac\"; s := WSTRING_TO_STRING(y2);",
     {"i": 3, "y": "\u00e4\"\u20ac", "b": 1, "s": "\u00e4\"\u20ac".encode()}),
    ("y := \"abcdefghijklmnop\"; i := LEN(y); j := FIND(y, \"cd\"); y := REPLACE(MID(y, 4, 2), \"XY\", 2, 2);",
     {"i": 10, "j": 3, "y": "bXYe"}),
    ("y := WGreet(\"\u00fc\u00fc\u00fc\u00fc\u00fc\"); b := y < \"hj\"; y2 := INSERT(DELETE(y, 3, 1), \"-\", 1);",
     {"y": "hi \u00fc\u00fc\u00fc\u00fc", "b": 1, "y2": "\u00fc-\u00fc\u00fc\u00fc"}),
    ("y := STRING_TO_WSTRING('a$C3$A4$E4'); s := WSTRING_TO_STRING(\"$D83D$DE00\"); i := LEN(\"\U0001f600\");",
     {"y": "a\u00e4\u00e4", "s": "\U0001f600".encode(), "i": 2}),
    ("y := INT_TO_WSTRING(-42); i := WSTRING_TO_INT(\"123x\"); y2 := CONCAT(LEFT(y, 1), RIGHT(y, 1), \"\"); l := WSTRING_TO_LREAL(\"2.5\");",
     {"y": "-42", "i": 123, "y2": "-2", "l": 2.5}),
    ("n := e.left * 10 + e2.left; i := made.id * 10 + made.seen; j := made2.id * 100 + made2.seen;", {"n": 55, "i": 71, "j": 313}),
    ("sq.Grow(more := 1); i := sq.Area(); j := sq.Sides(); sq.name := 'sq'; s := sq.name;", {"i": 16, "j": 6, "s": b"sq"}),
    ("i := pump.Set__Up() * 1000 + pump2.Up() * 100 + pump.get__level() * 10 + pump.level;", {"i": 3412}),
    ("i := Tools.Math.Double(4); j := Double(4); n := Plant.Inner.Two(); hue := Plant.Inner.Hue#Green; "
     "b := hue = Plant.Inner.Hue#Green;", {"i": 8, "j": 800, "n": 2, "hue": 1, "b": 1}),
    ("b := flag; i := bits; flag := NOT flag; j := bits; word2 := 16#1234; n := low2; low2 := 16#FF; w := word2; real8 := 1.0;",
     {"b": 1, "i": 8, "j": 0, "n": 0x34, "w": 0x12FF, "raw8": 0x3F800000}),
    # Calls: named inputs of functions with any number of them, real functions of integers, what a call changes.
    ("i := MAX(IN2 := 5, IN1 := 3); j := MUX(K := 1, IN0 := 3, IN1 := 7); s := CONCAT(IN2 := 'b', IN1 := 'a'); n := "
     "ADD(IN1 := 1, IN2 := 2, IN3 := 4); b := GT(IN1 := 2, IN2 := 1);", {"i": 5, "j": 7, "s": b"ab", "n": 7, "b": 1}),
    ("l := 2 * SQRT(4) / 8 + SQRT(MAX(SQRT(16), 1)); t := T#1s * SQRT(2); d := TRUNC(10 * SQRT(2)); f := SQRT(4); "
     "i := LREAL_TO_INT(10 * SEL(TRUE, SQRT(2), SIN(1)));", {"l": 2.5, "t": 1414213562, "d": 14, "f": 2.0, "i": 8}),
    ("FOR i := Next(n) TO Next(n) + 2 DO j := j * 10 + i; END_FOR", {"j": 1234, "i": 5}),
    ("w.0 := Fill(w); w.012 := TRUE; b := w.012;", {"w": 0x10F1, "b": 1}),
    ("speed(step := 4); j := speed.total; i := 3; k(step := Twice(i));", {"j": 104, "k.total": 106}),
    ("i := 2; empty[i] := empty[1]; empty[3] := empty[1]; j := behind; n := late.o * 10 + late.a;", {"j": 7, "n": 19}),
    ("i := More(v := KK); j := More(v := i + 1); n := More(v := 3) * 10 + More(v := i);", {"i": 5, "j": 7, "n": 46}),
    # A call of literals only has the type of what it is assigned to; beside other operands it is DINT or LREAL.
    ("i := MAX(1, 2); u := LIMIT(0, 7, 5); f := SQRT(4); u := 255; d := u + MAX(1, 2); n := 100; big := n * MAX(1000, 2); "
     "l := f * SQRT(2) / SQRT(2); x64 := DINT_TO_ULINT(n * MOVE(1000)); b := i + ABS(-32768) = 32770;",
     {"i": 2, "f": 2.0, "d": 257, "big": 100000, "l": 2.0, "x64": 100000, "b": 1}),
    ("i := 0; d := i + ABS(-32768); j := read;", {"d": 32768, "j": 912}),
    ("i := over; l := REAL#0.1; b := REAL#0.1 = LREAL#0.1;", {"i": 0x704, "l": 0.10000000149011612, "b": 0}),
    # Texts are read as literals.
    ("x64 := STRING_TO_ULINT('18446744073709551615'); i := STRING_TO_INT('16#FF') + STRING_TO_INT(' -1_000x'); w := "
     "STRING_TO_WORD('2#1111_1111'); b := STRING_TO_BOOL('true'); l := STRING_TO_LREAL('-1_0.5e1'); j := STRING_TO_INT('-99999');",
     {"x64": 2 ** 64 - 1, "i": -745, "w": 255, "b": 1, "l": -105.0, "j": -32768}),
    ("t := STRING_TO_TIME(' T#1h2m'); d := TIME_TO_DINT(STRING_TO_TIME('ltime#2.5S3ms')); l := STRING_TO_LREAL('0x1A') + "
     "STRING_TO_LREAL('inf'); i := LWORD_TO_INT(STRING_TO_LWORD('-5')); b := STRING_TO_TIME('5') = T#0s;",
     {"t": 3720 * 10**9, "d": 2503, "l": 0.0, "i": 0, "b": 1}),
    *((f"t := STRING_TO_TIME('{text}'); y2 := TIME_TO_WSTRING(WSTRING_TO_TIME(\"{text}\"));", {"t": value, "y2": text})
      for text, value in TIMES),
    ("t := STRING_TO_TIME('T#2h and more'); big := TIME_TO_LINT(STRING_TO_TIME('T#1h_30m ')); b := STRING_TO_BOOL(' TRUE;') AND NOT "
     "STRING_TO_BOOL('TRUEX'); { if not for us: a note } i := 3; { else where }", {"t": 7200 * 10**9, "big": 5400000, "b": 1, "i": 3}),
    ("i := LeftOut(a := 1); j := leaver.M(a := 1);", {"i": 7438, "j": 7}),
    # S= and R=: each of several refers to what is behind the last. S and R are names too.
    ("b S= i = 0; w.3 S= b; f1[1] S= f1[2] S= w.3 R= b; w.4 R= b; f1[2] R= i <> 0; i := WORD_TO_INT(w); b S= FALSE;",
     {"b": 1, "i": 0, "f1[1]": 1, "f1[2]": 1}),
    ("S := 'x'; IF s='x' AND NOT (S='y') THEN i := 1; END_IF bit.r R= b; bit.s s= TRUE; IF bit.S=NOT bit.R THEN j := 1; END_IF "
     "setter(S=>b);", {"i": 1, "j": 1, "b": 1, "bit.r": 0, "bit.s": 1}),
    # The names of the standard library of TwinCAT and CODESYS.
    ("s := CONCAT(STR1 := 'ab', STR2 := 'cd'); n := FIND(STR2 := 'c', STR1 := s); "
     "y := INSERT(STR1 := MID(STR := \"abcd\", POS := 2, LEN := 2), STR2 := \"-\", POS := 1);",
     {"s": b"abcd", "n": 3, "y": "b-c"}),
    ("FOR i := 1 TO 20 DO long := CONCAT(long, 'abcdefghijklm', 'no'); END_FOR i := LEN(long); j := FIND(RIGHT(long, 3), 'mno'); "
     "wlong := STRING_TO_WSTRING(long); n := LEN(wlong); b := WSTRING_TO_STRING(wlong) = long;", {"i": 255, "j": 1, "n": 255, "b": 1}),
    ("b := flags = FlagsOn AND flags > 4 AND flags <> behind AND (flags OR 16#1) = 201; w := flags; i := flags; CASE flags OF FlagsOff: j := 1; 200: j := 2; END_CASE flags := FlagsOff; "
     "w := w OR flags; n := TO_INT(E_Flags.FlagsOn);", {"b": 1, "w": 200, "i": 200, "j": 2, "n": 200, "flags": 0}),
    ("w.KK := TRUE; x64.KK2 := w.KK; p.x.KK := FALSE; i := i; b := x64.KK2 AND NOT w.KK2;", {"w": 16, "x64": 512, "p.x": 7, "b": 1}),
    ("s := SEL(b, 'no', s); i := LEN(s); b := TRUE; s := SEL(G := b, IN0 := s, IN1 := CONCAT(s, '-yes')); y := MUX(1, \"a\", y, y2); "
     "s := CONCAT(s, MUX(n + 1, 'a', SEL(b, 'x', 'y')));", {"i": 2, "s": b"no-yesy", "y": ""}),
    ("d := UDINT_TO_DINT(SIZEOF(Point) * 1000 + SIZEOF(Plant.Inner.Hue) + SIZEOF(INT) * 10 + SIZEOF(E_Wide) * 100); i := UDINT_TO_INT(SIZEOF(r));", {"d": 4422, "i": 6}),
    ("b := CLess AND CWide AND NOT CNan; w.0 := CLess; n := SEL(CSame, 1, 2);", {"b": 1, "w": 1, "n": 2}),
    ("s := DATE_TO_STRING(D#2024-02-29); y2 := DT_TO_WSTRING(DT#1998-02-13-14:20); b := TO_STRING(TOD#01:02:03.5) = 'TOD#01:02:03.5' AND "
     "DT_TO_STRING(DT#1970-01-01-00:00:00 - T#1s) = 'DT#1969-12-31-23:59:59' AND DT_TO_STRING(DT#2000-03-01-00:00:00.000000001) = 'DT#2000-03-01-00:00:00.000000001' AND "
     "LEN(DATE_TO_STRING(D#2262-01-01)) = 12; wlong := TIME_TO_WSTRING(T#1s); d := LEN(wlong);",
     {"s": b"D#2024-02-", "y2": "DT#1998-02-13-14:20:00", "b": 1, "d": 4}),
    ("d := DT_TO_DINT(DT#2020-01-01-12:00:00); i := TOD_TO_INT(TOD#00:00:30); b := UDINT_TO_DT(1577880000) = DT#2020-01-01-12:00:00 AND "
     "DINT_TO_TOD(-1) = TOD#23:59:59.999 AND DINT_TO_DATE(100000) = D#1970-01-02 AND DATE_TO_DWORD(D#1970-01-02) = 86400;",
     {"d": 1577880000, "i": 30000, "b": 1}),
    ("I := 1; if I = 1 then J := I + 1; end_if", {"i": 1, "j": 2}),
]
# (statements, words of the fault): the line is that of the statement
FAULTS = [
    ("i := 5; a[i] := 1;", "5 is outside 1..4"), ("i := -2; r[i] := 1;", "-2 is outside -1..1"),
    ("i := 3; grid[1, i] := 1;", "3 is outside 0..2"), ("j := 7; i := j / n;", "7 is divided by zero"),
    ("q^ := 1;", "NULL"), ("i := q2^.x;", "NULL"), ("WHILE TRUE DO i := i; END_WHILE", "1000000 times"),
    ("REPEAT b := FALSE; UNTIL b END_REPEAT", "1000000 times"),
    ("FOR i := 1 TO 30000 DO FOR d := 1 TO 30000 DO j := 1; END_FOR END_FOR", "1000000 times"),
    ("FOR i := 1 TO 3 BY n DO j := 1; END_FOR", "steps of 0"), ("i := MUX(n + 3, 1, 2);", "3 is outside 0..1"), ("s := MUX(n - 1, s, 'a');", "-1 is outside 0..1"),
    ("t := t / f;", "divided by zero"), ("i := 101; h := i;", "the value 101 is outside the range 10..100"),
    ("near := near * -3;", "-6 is outside the range -5..5"), ("n := Half(v := n);", "0 is outside the range 10..100"),
    ("CASE a[n - 1] OF 1: j := 1; END_CASE", "-1 is outside 1..4"),
    ("k(total => near);", "102 is outside the range -5..5"),
]
faults = []


def program(number, body):
    return f"PROGRAM P{number}\nVAR_OUTPUT {VARS} END_VAR\n{body}\nEND_PROGRAM\n"


def check_cases(folder):
    host = Host(BIN, folder, UNITS + "".join(program(n, body) for n, (body, _) in enumerate(CASES)), "cases", "--variables", "20000")
    for n, (body, expected) in enumerate(CASES):
        host.table.begin()
        for i in range(host.table.task_count):
            if host.table.tasks[i].name == f"P{n}".encode():
                host.table.tasks[i].run()
        if host.fault():
            sys.exit(f"{body}: {host.fault()}")
        for name, value in expected.items():
            found = host.value(name if name in ("g", "raw8") else f"P{n}.{name}")
            if found != value:
                faults.append(f"{body}: {name} is {found!r}; expected {value!r}")


def check_faults(folder):
    for n, (body, words) in enumerate(FAULTS):
        host = Host(BIN, folder, UNITS + program(n, body), f"fault{n}")
        line = (UNITS + program(n, "")).count("\n") - 1
        ran = host.run()
        if ran or words not in host.fault()[1] or host.fault()[0] != line:
            faults.append(f"{body}: line {line}, {words}; found {host.fault()}")
        elif host.run():
            faults.append(f"{body}: a task ran after the fault")


EVENTS = """
PROGRAM Main VAR n : INT; up AT %MX0.0 : BOOL; END_VAR n := n + 1; up := n MOD 4 >= 2; END_PROGRAM
VAR_GLOBAL CONSTANT most : INT := 3; END_VAR
PROGRAM Other VAR_EXTERNAL CONSTANT most : INT; END_VAR VAR a : ARRAY[1..most] OF INT; END_VAR a[3] := 1; END_PROGRAM
PROGRAM Event VAR c : INT; END_VAR c := c + 1; END_PROGRAM
CONFIGURATION C RESOURCE R ON PC TASK T1 (PRIORITY := 1); TASK T2 (SINGLE := m.up, PRIORITY := 2);
TASK T3 (SINGLE := m.up, INTERVAL := T#10ms, PRIORITY := 3); PROGRAM m WITH T1 : Main; PROGRAM at WITH T2 : Event;
TASK of_last (PRIORITY := 4); TASK T2_at_edge (PRIORITY := 5); PROGRAM last : Other; PROGRAM p4 WITH of_last : Other;
PROGRAM p5 WITH T2_at_edge : Other; PROGRAM both WITH T3 : Event; END_RESOURCE END_CONFIGURATION
"""


def check_events(folder):
    """A task with SINGLE runs once for each rising edge; with an INTERVAL also in it while the variable is FALSE."""
    host = Host(BIN, folder, EVENTS.replace("PROGRAM at", "PROGRAM once"), "events")
    for _ in range(8):
        host.run()
    found = host.value("once.c"), host.value("both.c")
    if found != (2, 6):
        faults.append(f"tasks by event ran {found} times; expected 2 and 2 + 4")
    intervals = [host.table.tasks[i].interval_ns for i in range(host.table.task_count)]
    if intervals != [0, 0, 0, 10000000, 0, 0, 0]:
        faults.append(f"intervals of tasks: {intervals}")


CALLED = """
PROGRAM Sub VAR_INPUT x : INT; up : BOOL R_EDGE; END_VAR VAR_OUTPUT y : INT; END_VAR VAR n, ups : INT := 0; END_VAR
  y := x + 1; n := n + 1; IF up THEN ups := ups + 1; END_IF
  ACTION Clear: n := 0; END_ACTION METHOD Get : INT VAR_INPUT k : INT; END_VAR Get := n + k; END_METHOD END_PROGRAM
PROGRAM Other VAR k : INT; END_VAR k := k + 1; IF k = 2 THEN Sub.Clear(); END_IF END_PROGRAM
FUNCTION_BLOCK Caller Sub(); END_FUNCTION_BLOCK
PROGRAM Main VAR n, m, q : INT; b : BOOL; c : Caller; END_VAR
  b := NOT b; Sub(x := 3, up := b, y => m); n := Sub.y; Sub(20); c(); q := Sub.Get(k := 100); Main.More();
  ACTION More: m := m + 1; END_ACTION END_PROGRAM
"""
CONFIGURED = "CONFIGURATION C RESOURCE R ON PC TASK T(PRIORITY := 1); PROGRAM a WITH T : Other; PROGRAM m WITH T : Main; END_RESOURCE END_CONFIGURATION"


def check_called():
    """A program that others call runs there only, with one instance."""
    for name, text in (("called", CALLED.replace("Main.More", "More")), ("configured", CALLED.replace("Main.More", "More") + CONFIGURED),
                       ("by_name", CALLED)):
        host = Host(BIN, folder, text, name)
        for _ in range(3):
            host.run()
        main, other = ("m", "a") if name == "configured" else ("Main", "Other")
        found = [host.value(of) for of in (f"{main}.n", f"{main}.m", f"{main}.q", "Sub.y", "Sub.n", "Sub.ups", f"{other}.k")]
        if found != [4, 5, 106, 21, 6, 2, 3] or host.table.task_count != (1 if name == "configured" else 2):
            faults.append(f"{name}: programs that are called: {found}, {host.table.task_count} tasks")


GIVEN = "CONFIGURATION C RESOURCE R ON PC TASK t(INTERVAL := T#1ms); PROGRAM a WITH t : P (i := 3, o => g); PROGRAM b WITH t : P (" \
        "i := g, o => h); END_RESOURCE END_CONFIGURATION VAR_GLOBAL g, h : INT; END_VAR PROGRAM P VAR_INPUT i : INT; END_VAR " \
        "VAR_OUTPUT o : INT; END_VAR o := 10 * i; END_PROGRAM"


def check_given(folder):
    """What a configuration gives to a program before it runs, and takes from it behind it."""
    host = Host(BIN, folder, GIVEN, "given")
    host.run()
    found = [host.value(of) for of in ("a.i", "g", "b.i", "h")]
    if found != [3, 30, 30, 300]:
        faults.append(f"programs with values of the configuration: {found}")


KEPT = "TYPE Mode : (Idle, Run := 5); Recipe : STRUCT speed : INT; depth : INT; mode : Mode; list : ARRAY[1..2] OF INT; " \
       "END_STRUCT; END_TYPE VAR_GLOBAL RETAIN rec : ARRAY[0..1] OF Recipe; END_VAR PROGRAM P END_PROGRAM"
KEPT_OTHERWISE = [("speed : INT; depth : INT", "depth : INT; speed : INT"), ("depth", "width"), ("Idle, Run := 5", "Run, Idle := 5"),
                  ("[1..2]", "[0..1]")]


def check_layouts(folder):
    """What RETAIN variables consist of, by name: a file of others is refused."""
    known = [Host(BIN, folder, KEPT, "kept").table.layout]
    if Host(BIN, folder, KEPT + "\n(* again *)", "same").table.layout != known[0]:
        faults.append("RETAIN: a comment changes the layout")
    for n, (old, new) in enumerate(KEPT_OTHERWISE):
        known.append(Host(BIN, folder, KEPT.replace(old, new), f"kept{n}").table.layout)
        if known[-1] in known[:-1]:
            faults.append(f"RETAIN: {old} and {new} have one layout")


with tempfile.TemporaryDirectory() as folder:
    check_layouts(folder)
    check_events(folder)
    check_called()
    check_given(folder)
    check_cases(folder)
    check_faults(folder)
if faults:
    sys.exit("\n".join(faults) + f"\n{len(faults)} faults")
print(f"{len(CASES)} cases, {len(FAULTS)} faults")
