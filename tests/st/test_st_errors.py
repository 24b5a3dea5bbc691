#!/usr/bin/env python3
"""What is wrong in a program is told with line, column and words, and never ends the translator: each case below is a
program with one mistake, the place of the mistake, and words that the text must have.

test_st_errors.py BIN-DIRECTORY
"""
import json
import os
import random
import subprocess
import sys
import tempfile

BIN = sys.argv[1]
faults = []

# (declarations and statements of a program, or a whole source; line:column; words, and behind a "!" those that it must not have)
PROGRAM = "PROGRAM Main\nVAR\n  i : INT; r : REAL; b : BOOL; w : WORD; s : STRING; l : LREAL; u : UINT; t : TON; d : DINT;\n" \
          "  a : ARRAY[1..3] OF INT; tm : TIME; c : E_Color; p : Point; q : REF_TO INT; k : LINT; x : ULINT; d1 : DATE; wide : E_Wide; tod : TOD;\nEND_VAR\n" \
          "VAR CONSTANT\n  N : INT := 3; TOO : INT := 16;\nEND_VAR\n{}\nEND_PROGRAM\nTYPE E_Color : (Red, Green); E_Wide : (Below := -1, Far := 70000); Point : STRUCT x, y : INT; " \
          "END_STRUCT; END_TYPE\nFUNCTION Twice : INT\nVAR_INPUT v : INT; END_VAR\nTwice := 2 * v;\nEND_FUNCTION\n" \
          "FUNCTION Change : INT\nVAR_IN_OUT v : INT; END_VAR\nv := v + 1; Change := v;\nEND_FUNCTION\n"
STATEMENTS = [
    ("i := 1", "10:1", ["cannot stand here", '";"']),
    ("i = 1;", "9:3", ["cannot stand here", '":="']),
    ("b S= i;", "9:6", ["what is behind S= and R= is a BOOL; this is INT"]),
    ("i S= b;", "9:1", ["INT"]),
    ("N R= b;", "9:1", ["CONSTANT"]),
    ("b S= b R= ;", "9:11", ["cannot stand here"]),
    ("i := 1 r := 2.0;", "9:8", ["cannot stand here", '";"', "!not in the standard"]),
    ("b := b S= b;", "9:8", ["cannot stand here"]),
    ("IF b i := 1; END_IF", "9:6", ['is a "THEN" missing before it?']),
    ("WHILE b i := 1; END_WHILE", "9:9", ['is a "DO" missing before it?']),
    ("IF b THEN i := 1; END IF", "9:23", ["one word, as END_IF"]),
    ("r := 1,5;", "9:7", ["a number has a point"]),
    ("b := w.%X3;", "9:8", [".%X3, .%B1", "a single bit is value.3"]),
    ("w := w AND NOT 16#1;", "9:12", ["NOT WORD#16#1"]),
    ("a[2] := l;", "9:9", ['"a[...]" is INT']),
    ("q^ := l;", "9:7", ['"q^" is INT']),
    ("b := c.Red = c;", "9:8", ['"c" is the variable here; the enumerator is E_Color#Red']),
    ("CASE i OF i + 1: d := 1; END_CASE", "9:13", ["known before the program runs"]),
    ("t(IN := b, PT := 1000);", "9:18", ["a time is written as T#1s500ms"]),
    ("t(IN := b, PT := 1.5);", "9:18", ["a time is written as T#1s500ms"]),
    ("IF i == 1 THEN i := 2; END_IF", "9:7", ["compared by one"]),
    ("IF i := 1 THEN i := 2; END_IF", "9:6", ['compared by "="']),
    ("i := d := 3;", "9:8", ["statement of its own"]),
    ("b := b && b;", "9:9", ["AND is a single"]),
    ("b := i != 1;", "9:8", ["<>"]),
    ("b := b || b;", "9:8", ["OR"]),
    ("IF b THEN i := 1;", "10:1", ['"END_PROGRAM" cannot stand here', "an IF before it has no END_IF"]),
    ("IF b THEN i := 1; ELSE i := 2;", "10:1", ["an IF before it has no END_IF"]),
    ("FOR i := 1 TO 3 DO IF b THEN i := 1; END_FOR", "9:38", ['"END_FOR" cannot stand here', "an IF before it"]),
    ("FOR i := 1 TO 3 DO d := 1;", "10:1", ["a FOR before it has no END_FOR"]),
    ("WHILE b DO d := 1;", "10:1", ["a WHILE before it has no END_WHILE"]),
    ("REPEAT d := 1;", "10:1", ["a REPEAT before it has no UNTIL"]),
    ("CASE i OF 1: d := 1; ELSE d := 2;", "10:1", ["a CASE before it has no END_CASE"]),
    ("IF b THEN i := 1; ELSEIF (i > 1) THEN i := 2; END_IF", "9:34", ["ELSIF"]),
    ("IF b THEN i := 1; ELSEIF b THEN i := 2; END_IF", "9:26", ["ELSIF"]),
    ("j := 1;", "9:1", ["no variable", '"j"']),
    ("DT_TO_DATE(DT#1969-12-31-23:59:59);", "9:12", ["from 1970 to 2262"]),
    ("i := Twice();", "9:6", ['Twice needs a value for "v" too']),
    ("ii := 1;", "9:1", ['did you mean "i"']),
    ("i := 1.5;", "9:6", ["INT"]),
    ("i := 40000;", "9:6", ["40000", "INT"]),
    ("i := -32769;", "9:6", ["INT"]),
    ("i := d;", "9:6", ["DINT_TO_INT"]),
    ("u := i;", "9:6", ["INT_TO_UINT"]),
    ("r := d;", "9:6", ["DINT_TO_REAL"]),
    ("r := l;", "9:6", ["LREAL_TO_REAL"]),
    ("l := k;", "9:6", ["LINT_TO_LREAL"]),
    ("b := i;", "9:6", ["INT_TO_BOOL"]),
    ("i := b;", "9:6", ["BOOL_TO_INT"]),
    ("i := w;", "9:6", ["WORD_TO_INT"]),
    ("w := i;", "9:6", ["INT_TO_WORD"]),
    ("s := i;", "9:6", ["INT_TO_STRING"]),
    ("i := s;", "9:6", ["STRING"]),
    ("tm := i;", "9:7", ["INT_TO_TIME"]),
    ("b := i AND b;", "9:8", ["INT AND BOOL"]),
    ("i := i AND 1;", "9:8", ["INT AND"]),
    ("i := NOT i;", "9:6", ["NOT INT"]),
    ("b := -b;", "9:6", ["- BOOL"]),
    ("u := -u;", "9:6", ["- UINT"]),
    ("w := w + 1;", "9:8", ["WORD_TO_UINT"]),
    ("i := b + 1;", "9:8", ["BOOL + "]),
    ("x := x + i;", "9:8", ["ULINT + INT"]),
    ("b := k < x;", "9:8", ["LINT < ULINT"]),
    ("r := r MOD 2;", "9:8", ["REAL MOD"]),
    ("l := i ** 2;", "9:8", ["base is REAL"]),
    ("tm := tm * tm;", "9:10", ["TIME * TIME"]),
    ("d1 := d1 + d1;", "9:10", ["DATE + DATE"]),
    ("b := s = 1;", "9:8", ["STRING[80] ="]),
    ("b := b < b;", "9:8", ["BOOL < BOOL"]),
    ("i := i / 0;", "9:8", ["divides by zero"]),
    ("i := 1 / 0;", "9:8", ["divides by zero"]),
    ("i := 5 MOD 0;", "9:8", ["divides by zero"]),
    ("k := 9223372036854775807 + 1;", "9:26", ["64 bits"]),
    ("x := 18446744073709551616;", "9:6", ["64 bits"]),
    ("i := 16#G;", "9:6", ["16#"]),
    ("i := 1__0;", "9:6", ["\"1__0\"", "underscore"]),
    ("i := 16#_F;", "9:6", ["underscore"]),
    ("x := 1_.5;", "9:6", ["underscore"]),
    ("i := 3#12;", "9:6", ["base"]),
    ("i := 12abc;", "9:6", ["neither a number nor a name"]),
    ("i := INT#70000;", "9:6", ["70000"]),
    ("i := FOO#7;", "9:6", ["FOO"]),
    ("l := 1.0E999;", "9:6", ["LREAL"]),
    ("tm := T#5;", "9:7", ["TIME"]),
    ("tm := T#5x;", "9:7", ["TIME"]),
    ("tm := T#1s1h;", "9:7", ["largest unit first"]),
    ("tm := T#200000d;", "9:7", ["106751"]),
    ("tod := TOD#23:59:59.9999999999;", "9:8", ["TOD", "23:59:59.999"]),
    ("tm := T#106751d23h47m16s854ms775us808ns;", "9:7", ["106751"]),
    ("tm := T#106751d23h47m16s854ms775us807.6ns;", "9:7", ["106751"]),
    ("tm := T#-106751d23h47m16s854ms775us809ns;", "9:7", ["106751"]),
    ("d1 := D#2023-02-29;", "9:7", ["D#"]),
    ("d1 := D#2024-13-01;", "9:7", ["DATE"]),
    ("s := 'abc;", "9:6", ["no ' at its end"]),
    ("s := \"abc\";", "9:6", ["WSTRING_TO_STRING"]),
    ("s := \"a$00\";", "9:6", ["means nothing in a WSTRING"]),
    ("s := 'a$Zb';", "9:6", ["$Z"]),
    ("a[0] := 1;", "9:3", ["0 is outside 1..3"]),
    ("a[i, 1] := 1;", "9:1", ["1 index; found 2"]),
    ("a[r] := 1;", "9:3", ["integer"]),
    ("i[1] := 1;", "9:1", ["INT is no array"]),
    ("i := a;", "9:6", ["ARRAY"]),
    ("p.z := 1;", "9:3", ["Point has no"]),
    ("i.x := 1;", "9:3", ["INT has no members"]),
    ("i.16 := TRUE;", "9:3", [".15"]),
    ("r.1 := TRUE;", "9:3", ["no single bits"]),
    ("i := q;", "9:6", ["REF_TO INT"]),
    ("i := i^;", "9:6", ["^ is for REF_TO"]),
    ("q := REF(d);", "9:6", ["REF_TO"]),
    ("c := 1;", "9:6", ["enumerators", "CASE"]),
    ("c := i;", "9:6", ["enumerators", "for instance Red"]),
    ("c := c + 1;", "9:8", ["enumerators"]),
    ("u := c;", "9:6", ["UINT", "E_Color has values of INT", "TO_UINT(...)"]),
    ("u := E_Wide.Below;", "9:13", ["-1 is not a value of UINT"]),
    ("r := wide;", "9:6", ["REAL", "E_Wide has values of DINT", "TO_REAL(...)"]),
    ("c := SEL(b, c, 1);", "9:6", ["enumerators"]),
    ("l := SIN(c);", "9:10", ["REAL or LREAL", "E_Color"]),
    ("i := MAX(c, b);", "9:13", ["INT and BOOL"]),
    ("b := Green;", "9:6", ["BOOL", "this is E_Color"]),
    ("b := c = b;", "9:8", ["E_Color = BOOL"]),
    ("w := c AND w;", "9:8", ["E_Color AND WORD"]),
    ("c := Blue;", "9:6", ["Blue"]),
    ("c := E_Color#Blue;", "9:6", ["E_Color has no"]),
    ("c := E_Colour#Red;", "9:6", ["no enumeration", 'did you mean "E_Color"']),
    ("p.z := 1; p.xx := 2;", "9:3", ['Point has no "z"']),
    ("i := Main.ii;", "9:11", ['the program "Main" has no variable "ii"', 'did you mean "i"']),
    ("r := LIMIT(MM := 1, IN := r, MX := 2);", "9:12", ['LIMIT has no input "MM"', 'did you mean "MN"']),
    ("N := 4;", "9:1", ["CONSTANT"]),
    ("t.Q := TRUE;", "9:3", ["output"]),
    ("b := t.Priv;", "9:8", ["within TON"]),
    ("b := t.P;", "9:8", ["TON has no"]),
    ("t := t;", "9:1", ["cannot be assigned"]),
    ("t(IM := TRUE);", "9:3", ['did you mean "IN"']),
    ("t(IN := TRUE, IN := FALSE);", "9:15", ["twice"]),
    ("t(IN => b);", "9:3", ["use :="]),
    ("t(Q := b);", "9:3", ["use =>"]),
    ("t(Q => i);", "9:3", ["BOOL"]),
    ("t(TRUE, PT := T#1s);", "9:9", ["all by position"]),
    ("t(TRUE, T#1s, 3);", "9:15", ["2 arguments"]),
    ("t(EN := 1.5);", "9:9", ["EN"]),
    ("b := t(IN := TRUE);", "9:6", ["no result"]),
    ("i := Twice();", "9:6", ["needs a value"]),
    ("i := Twice(1, 2);", "9:15", ["1 argument"]),
    ("i := Twice(1.5);", "9:12", ["INT"]),
    ("i := Twise(1);", "9:6", ['did you mean "Twice"']),
    ("i := MAX(1, IN2 := );", "9:6", ["MAX needs a value", '"IN1"']),
    ("i := MUX(IN0 := 1, IN1 := 2, IN2 := 3);", "9:6", ["MUX needs a value", '"K"']),
    ("q := REF(IN := i);", "9:6", ["without a name"]),
    ("i := SQRT(2);", "9:6", ["INT", "LREAL"]),
    ("i := 1; {IF defined (X)} i := 2; {ELSE} i := 3; {END_IF}", "9:9", ["{IF ...}", "not supported"]),
    ("{IF (NOT hasattribute(pou: P, 'x'))} i := 2; {END_IF}", "9:1", ["{IF ...}", "not supported"]),
    ("{ELSE} i := 2;", "9:1", ["{IF ...}", "not supported"]),
    ("i := i + SEL(b, -1, 1);", "9:", ["DINT"]),
    ("i := 1; {attribute 'call_after_init'} i := 2;", "9:9", ["call_after_init"]),
    ("k := -(-9223372036854775808);", "9:6", ["64 bits"]),
    ("i := Change(3);", "9:13", ["variable"]),
    ("i := Change(d);", "9:13", ["VAR_IN_OUT of type INT"]),
    ("i := Change();", "9:6", ["needs a value"]),
    ("i := Change(i) + i;", "9:6", ["statement of its own"]),
    ("a[i] := Change(i);", "9:1", ["on the left"]),
    ("TON(IN := TRUE);", "9:1", ["declare an instance"]),
    ("Main();", "1:9", ["recursion"]),
    ("ABS(i);", "9:1", ["not used"]),
    ("i := ABS();", "9:6", ["1 argument"]),
    ("r := SQRT(i);", "9:11", ["REAL or LREAL"]),
    ("i := MAX(i, s);", "9:13", ["elementary"]),
    ("k := MAX(k, x);", "9:13", ["one type"]),
    ("i := LEN(i);", "9:10", ["STRING"]),
    ("w.i := TRUE;", "9:3", ["single bit", "CONSTANT"]),
    ("u := UINT#3; b := i.TOO;", "9:21", ["bits .0 to .15"]),
    ("s := SEL(b, s, i);", "9:13", ["one elementary type"]),
    ("q := __NEW(INT);", "9:6", ["__NEW", "declare a variable"]),
    ("MEMCPY(ADR(a), ADR(a), SIZEOF(a));", "9:1", ["MEMCPY", "assign the whole"]),
    ("i := SIZEOF(Pont);", "9:13", ['"Pont"']),
    ("i += 1;", "9:3", ["x := x + 1"]),
    ("i++;", "9:2", ["x := x + 1"]),
    ("i := 0x1F;", "9:6", ["16#"]),
    ("i := 1; VAR j : INT; END_VAR", "9:9", ["in front of the statements"]),
    ("w := SHL(w, w);", "9:13", ["integer"]),
    ("d1 := REAL_TO_DATE(r);", "9:7", ["no conversion"]),
    ("EXIT;", "9:1", ["within FOR"]),
    ("IF i THEN END_IF", "9:4", ["BOOL"]),
    ("IF b THEN i := 1;", "10:1", ["END_PROGRAM"]),
    ("WHILE 1 DO END_WHILE", "9:7", ["BOOL"]),
    ("FOR r := 1 TO 3 DO END_FOR", "9:5", ["integers"]),
    ("FOR c := Red TO Green DO END_FOR", "9:5", ["FOR counts with an integer, not with E_Color", "INT or DINT"]),
    ("FOR i := 1 TO 40000 DO END_FOR", "9:15", ["40000"]),
    ("FOR i := 1 TO 3 BY 0 DO END_FOR", "9:20", ["0"]),
    ("FOR i := 1 TO 3 DO i := 2; END_FOR", "9:20", ["EXIT"]),
    ("FOR i := 1 TO 3 DO FOR i := 1 TO 2 DO END_FOR END_FOR", "9:24", ["EXIT"]),
    ("CASE r OF 1: ; END_CASE", "9:6", ["integer"]),
    ("CASE i OF 1: ; 1: ; END_CASE", "9:16", ["label already"]),
    ("CASE i OF 1..5: ; 3: ; END_CASE", "9:19", ["label already"]),
    ("CASE i OF 5..1: ; END_CASE", "9:11", ["empty"]),
    ("CASE i OF d: ; END_CASE", "9:11", ["DINT"]),
    ("CASE i OF a[1]: ; END_CASE", "9:11", ["before the program runs"]),
    ("CASE i OF i := 1; END_CASE", "9:11", ["label"]),
    ("CASE c OF Red: ; 0: ; END_CASE", "9:18", ["0 has a label already"]),
    ("CASE c OF Red: ; 40000: ; END_CASE", "9:18", ["40000 is not a value of INT", "the selector"]),
    ("CASE c OF Red: ; 1.5: ; END_CASE", "9:18", ["enumerators"]),
    ("%QX0.0 := TRUE;", "9:1", ["name"]),
    ("i := #;", "9:6", ["#"]),
    ("i := 1; (* no end", "9:9", ["no end"]),
    ("i;", "9:1", ["does nothing"]),
]
SOURCES = [
    ("PROGRAM Main VAR c : CHAR; END_VAR END_PROGRAM", "1:22", ["CHAR is not supported"]),
    ("TYPE S : STRUCT a : BIT; END_STRUCT; END_TYPE", "1:21", ["BIT is not supported"]),
    ("PROGRAM Main VAR c : ANY_INT; END_VAR END_PROGRAM", "1:22", ["ANY_INT is not supported"]),
    ("TYPE U : UNION a : INT; b : STRING; END_UNION END_TYPE", "1:25", ["not all bits are a value of STRING"]),
    ("TYPE U : UNION a : REF_TO INT; b : LWORD; END_UNION END_TYPE", "1:16", ["not all bits are a value of REF_TO INT"]),
    ("TYPE U : UNION a : BOOL; b : BYTE; END_UNION END_TYPE", "1:16", ["BOOL"]),
    ("TYPE U : UNION a : E; b : BYTE; END_UNION E : (A, B); END_TYPE", "1:16", ["value of E"]),
    ("TYPE U : UNION a : INT (0..3); b : BYTE; END_UNION END_TYPE", "1:16", ["INT (0..3)"]),
    ("TYPE U : UNION a : S; b : BYTE; END_UNION S : STRUCT x : INT := 1; END_STRUCT END_TYPE", "1:16", ["value of S"]),
    ("TYPE U : UNION a : ARRAY[1..2] OF TON; b : BYTE; END_UNION END_TYPE", "1:16", ["TON"]),
    ("TYPE U : UNION a : INT := 3; b : BYTE; END_UNION END_TYPE", "1:16", ["without initial values"]),
    ("TYPE U : UNION a : U; b : BYTE; END_UNION END_TYPE", "1:6", ["contains itself"]),
    ("TYPE U : UNION a : INT; b : BYTE; END_UNION END_TYPE PROGRAM P VAR u : U := (a := 1, b := 2); END_VAR END_PROGRAM", "1:86", ["one member"]),
    ("TYPE U : UNIOM a : INT; b : BYTE; END_UNION END_TYPE", "1:35", ["begins with UNION"]),
    ("PROGRAM Main VAR x : INT; END_VAR JMP l; l: x := 1; END_PROGRAM", "1:39", ["JMP is not supported"]),
    ("PROGRAM Main VAR i : INTT; END_VAR END_PROGRAM", "1:22", ['did you mean "INT"']),
    ("PROGRAM Main VAR i : INT; I : INT; END_VAR END_PROGRAM", "1:27", ["already"]),
    ("PROGRAM Main END_PROGRAM PROGRAM main END_PROGRAM", "1:34", ["already"]),
    ("PROGRAM Main VAR CONSTANT i : INT; END_VAR END_PROGRAM", "1:27", ["needs a value"]),
    ("PROGRAM Main VAR CONSTANT i : INT := j; j : INT := i; END_VAR END_PROGRAM", "1:27", ["itself"]),
    ("PROGRAM Main VAR i : INT := k; k : INT; END_VAR END_PROGRAM", "1:29", ["before the program runs"]),
    ("TYPE A : STRUCT b : B; END_STRUCT; B : STRUCT a : A; END_STRUCT; END_TYPE", "1:36", ["contains itself"]),
    ("TYPE A : ARRAY[1..2] OF A; END_TYPE", "1:6", ["contains itself"]),
    ("TYPE A : ARRAY[3..2] OF INT; END_TYPE", "1:16", ["no range"]),
    ("TYPE A : ARRAY[1..1000000000] OF LREAL; END_TYPE", "1:16", ["MB"]),
    ("TYPE A : INT (10..0); END_TYPE", "1:10", ["10..0 is no range of INT"]),
    ("TYPE A : REAL (0..1); END_TYPE", "1:10", ["no range of REAL"]),
    ("PROGRAM P VAR x : INT (1..5); END_VAR x := 6; END_PROGRAM", "1:44", ["6 is not a value of INT (1..5)"]),
    ("PROGRAM P VAR x : INT (1..5); END_VAR x.1 := TRUE; END_PROGRAM", "1:41", ["single bit"]),
    ("PROGRAM P VAR x : INT (1..5) := 0; END_VAR END_PROGRAM", "1:33", ["0 is not a value"]),
    ("TYPE A : (Red, red); END_TYPE", "1:16", ["already"]),
    ("TYPE A : (Red := 200) SINT; END_TYPE", "1:11", ["SINT"]),
    ("TYPE A : (Red) REAL; END_TYPE", "1:6", ["BYTE ... LWORD, not REAL"]),
    ("TYPE A : (Red := 300) BYTE; END_TYPE", "1:11", ["300 is not a value of BYTE"]),
    ("TYPE INT : REAL; END_TYPE", "1:6", ["elementary"]),
    ("PROGRAM P VAR i, at : INT; END_VAR END_PROGRAM", "1:18", ["expected a name"]),
    ("PROGRAM P VAR by : INT; END_VAR END_PROGRAM", "1:15", ["expected END_VAR, or a name, which no word of the language is"]),
    ("PROGRAM P VAR i : INT; IF i > 0 THEN i := 1; END_IF END_PROGRAM", "1:24", ["expected END_VAR, or a name"]),
    ("FUNCTION_BLOCK F VAR_IN_OUT v : INT; END_VAR END_FUNCTION_BLOCK PROGRAM P VAR f : F; i : INT; END_VAR f.v := i; "
     "END_PROGRAM", "1:105", ["a VAR_IN_OUT of F: it gets its variable in the call"]),
    ("PROGRAM P VAR s : STRING[1000]; END_VAR END_PROGRAM", "1:19", ["255"]),
    ("PROGRAM P VAR y : INT; x : INT REF= y; END_VAR END_PROGRAM", "1:37", ["REF_TO INT"]),
    ("PROGRAM P VAR x, y : INT; END_VAR x REF= y; END_PROGRAM", "1:35", ["REFERENCE TO"]),
    ("PROGRAM P VAR x : REFERENCE TO INT; y : DINT; END_VAR x REF= y; END_PROGRAM", "1:62", ["REFERENCE TO INT"]),
    ("PROGRAM P VAR x : BOOL R_EDGE; END_VAR END_PROGRAM", "1:15", ["inputs of type BOOL"]),
    ("FUNCTION P VAR_INPUT x : BOOL F_EDGE; END_VAR END_FUNCTION", "1:22", ["inputs of type BOOL"]),
    ("PROGRAM P VAR_INPUT x : BOOL R_EDGE; END_VAR x := TRUE; END_PROGRAM", "1:46", ["not written"]),
    ("FUNCTION_BLOCK F METHOD M : INT END_METHOD END_FUNCTION_BLOCK PROGRAM P VAR f : F; i : INT; END_VAR i := f.M; END_PROGRAM",
     "1:108", ['"M" is a method of F: it is called, M(...)']),
    ("CLASS A VAR_INPUT i : INT; END_VAR END_CLASS", "1:19", ["no inputs and outputs"]),
    ("CLASS A VAR v : INT; END_VAR END_CLASS PROGRAM P VAR a : A; END_VAR a(); END_PROGRAM", "1:69", ["call a method"]),
    ("CLASS A VAR v : INT; END_VAR END_CLASS PROGRAM P VAR a : A; n : INT; END_VAR n := a.v; END_PROGRAM", "1:85",
     ["VAR PUBLIC"]),
    ("NAMESPACE A PROGRAM P END_PROGRAM END_NAMESPACE", "1:21", ["in no namespace"]),
    ("USING B; PROGRAM P END_PROGRAM", "1:7", ["no NAMESPACE \"B\""]),
    ("NAMESPACE A FUNCTION F : INT END_FUNCTION END_NAMESPACE NAMESPACE B FUNCTION F : INT END_FUNCTION END_NAMESPACE "
     "USING A, B; PROGRAM P VAR n : INT; END_VAR n := F(); END_PROGRAM", "1:161", ["in A and in B"]),
    ("FUNCTION_BLOCK A METHOD FB_Init VAR_INPUT bInitRetains, bInCopyCode : BOOL; n : INT; END_VAR END_METHOD "
     "END_FUNCTION_BLOCK PROGRAM P VAR a : A; END_VAR END_PROGRAM", "1:138", ["FB_Init of A needs \"n\""]),
    *(("FUNCTION_BLOCK A METHOD FB_Init VAR_INPUT n : INT; END_VAR END_METHOD END_FUNCTION_BLOCK FUNCTION_BLOCK B END_FUNCTION_BLOCK "
       f"PROGRAM P VAR a : ARRAY[1..2] OF {given}; END_VAR END_PROGRAM", place, [words])
      for given, place, words in (
          ("A", "1:140", "for each element: ARRAY[1..2] OF A[(number := 1), (number := 2)]"),
          ("A[(n := 1)]", "1:161", "the array has 2 elements, and the inputs of FB_Init are given for 1"),
          ("A[(n := 1), (n := 2, N := 3)]", "1:180", '"N" is given twice'),
          ("A[(n := 1), (n := 2), (n := 3)]", "1:161", "given for 3"), ("A[(n := 1), (m := 2)]", "1:172", 'no FB_Init with an input "m"'),
          ("A[1, 2]", "1:161", "in parentheses"), ("A[2((n := 1))]", "1:161", "in parentheses"),
          ("A(n := 1)", "1:160", "ARRAY[1..2] OF A[(n := ...), (n := ...)]"), ("B[(n := 1), (n := 1)]", "1:161", "no FB_Init"),
          ("ARRAY[1..2] OF A", "1:140", "more dimensions"), ("ARRAY[1..2] OF A[(n := 1)]", "1:", "cannot stand here"))),
    ("FUNCTION_BLOCK A END_FUNCTION_BLOCK PROGRAM P VAR a : A(n := 1); END_VAR END_PROGRAM", "1:57", ["no FB_Init"]),
    ("FUNCTION_BLOCK A METHOD FB_Init VAR_INPUT n : INT; END_VAR END_METHOD END_FUNCTION_BLOCK "
     "PROGRAM P VAR a : A(n := 1, n := 2); END_VAR END_PROGRAM", "1:118", ['"n" is given twice']),
    ("PROGRAM P VAR a : ARRAY[1..2] OF INT := [1, 2, 3]; END_VAR END_PROGRAM", "1:48", ["2 elements"]),
    ("TYPE E : (Off, Gate); END_TYPE PROGRAM P VAR gate : AXIS_REF; s : E; b : BOOL; END_VAR b := s = Gate; END_PROGRAM", "1:95",
     ['E = AXIS_REF is not defined; "Gate" is the variable here, the enumerator is E#Gate']),
    ("TYPE E : (Off, Gate); END_TYPE PROGRAM P VAR gate : AXIS_REF; s : E; END_VAR s := gate; END_PROGRAM", "1:83",
     ['for instance Off; "gate" is the variable here, the enumerator is E#Gate']),
    ("PROGRAM P VAR t : TON := (PP := T#1s); END_VAR END_PROGRAM", "1:27", ["PP", 'did you mean "PT"']),
    ("TYPE T : STRUCT name : INT; END_STRUCT; END_TYPE PROGRAM P VAR t : T := (naem := 1); END_VAR END_PROGRAM", "1:74",
     ['did you mean "name"']),
    ("FUNCTION_BLOCK F METHOD FB_Init : BOOL VAR_INPUT bInitRetains, bInCopyCode : BOOL; size : INT; END_VAR END_METHOD "
     "END_FUNCTION_BLOCK PROGRAM P VAR f : F(szie := 1); END_VAR END_PROGRAM", "1:154", ["no FB_Init", 'did you mean "size"']),
    ("PROGRAM P VAR t : TON := (PT := 1); END_VAR END_PROGRAM", "1:33", ["PT"]),
    ("FUNCTION_BLOCK F VAR_IN_OUT r : INT; END_VAR END_FUNCTION_BLOCK PROGRAM P VAR f : F; END_VAR f(r := ); END_PROGRAM", "1:96",
     ['a variable for "r" is missing']),
    ("FUNCTION F : INT F := F(); END_FUNCTION", "1:10", ["recursion"]),
    ("FUNCTION F : INT F := G(); END_FUNCTION FUNCTION G : INT G := F(); END_FUNCTION", "1:", ["recursion"]),
    ("FUNCTION F : INT VAR t : TON; END_VAR F := 1; END_FUNCTION", "1:22", ["keeps nothing"]),
    ("VAR_GLOBAL g : INT; END_VAR FUNCTION F : INT g := 1; F := 1; END_FUNCTION", "1:46", ["global"]),
    ("FUNCTION F : INT VAR a : ARRAY[1..100000] OF LREAL; END_VAR F := 1; END_FUNCTION", "1:10", ["bytes"]),
    ("PROGRAM P VAR_EXTERNAL g : INT; END_VAR END_PROGRAM", "1:24", ["VAR_GLOBAL"]),
    ("VAR_GLOBAL goal : INT; END_VAR PROGRAM P VAR_EXTERNAL gaol : INT; END_VAR END_PROGRAM", "1:55", ['did you mean "goal"']),
    ("VAR_GLOBAL g : DINT; END_VAR PROGRAM P VAR_EXTERNAL g : INT; END_VAR END_PROGRAM", "1:53", ["is DINT"]),
    ("FUNCTION_BLOCK F METHOD M : INT END_FUNCTION_BLOCK", "1:33", ["cannot stand here"]),
    ("FUNCTION_BLOCK F EXTENDS G END_FUNCTION_BLOCK", "1:16", ['no function block "G"']),
    ("FUNCTION_BLOCK Inner END_FUNCTION_BLOCK FUNCTION_BLOCK F EXTENDS Inenr END_FUNCTION_BLOCK", "1:56",
     ['did you mean "Inner"']),
    ("FUNCTION_BLOCK G VAR inner : INT; END_VAR THIS^.iner := 1; END_FUNCTION_BLOCK", "1:49", ['did you mean "inner"']),
    ("CONFIGURATION C RESOURCE R ON PC TASK t(INTERVAL := T#0s); PROGRAM a WITH t : P; END_RESOURCE END_CONFIGURATION "
     "PROGRAM P END_PROGRAM", "1:41", ["above 0"]),
    ("CONFIGURATION C RESOURCE R ON PC PROGRAM a WITH t : P; END_RESOURCE END_CONFIGURATION PROGRAM P END_PROGRAM",
     "1:42", ["no task"]),
    ("CONFIGURATION C RESOURCE R ON PC TASK fast(INTERVAL := T#1s); PROGRAM a WITH fsat : P; END_RESOURCE END_CONFIGURATION "
     "PROGRAM P END_PROGRAM", "1:71", ['did you mean "fast"']),
    ("CONFIGURATION C RESOURCE R ON PC PROGRAM a : Plnt; END_RESOURCE END_CONFIGURATION PROGRAM Plant END_PROGRAM", "1:42",
     ['no program', 'did you mean "Plant"']),
    ("CONFIGURATION C RESOURCE R ON PC PROGRAM a : P (Strat := TRUE); END_RESOURCE END_CONFIGURATION "
     "PROGRAM P VAR_INPUT Start : BOOL; END_VAR END_PROGRAM", "1:49", ['no input "Strat"', 'did you mean "Start"']),
    ("CONFIGURATION C RESOURCE R ON PC TASK t(SINGLE := TRUE); PROGRAM a : Q; END_RESOURCE END_CONFIGURATION", "1:41",
     ["SINGLE"]),
    ("CONFIGURATION C RESOURCE R ON PC PROGRAM a : Q; END_RESOURCE END_CONFIGURATION", "1:42", ["no program"]),
    ("PROGRAM A END_PROGRAM PROGRAM P A(); END_PROGRAM CONFIGURATION C RESOURCE R ON PC PROGRAM p : P; PROGRAM a : A; END_RESOURCE "
     "END_CONFIGURATION", "1:106", ['"A" is called in the statements of another one', "no task runs it"]),
    ("PROGRAM A END_PROGRAM FUNCTION F : INT A(); END_FUNCTION", "1:40", ["calls no program"]),
    ("PROGRAM A END_PROGRAM PROGRAM P VAR i : INT; END_VAR i := A(); END_PROGRAM", "1:59", ["a program has no result"]),
    ("PROGRAM A END_PROGRAM PROGRAM P A(x := 1); END_PROGRAM", "1:35", ['no input "x"']),
    ("PROGRAM A B(); END_PROGRAM PROGRAM B A(); END_PROGRAM", "1:", ["recursion"]),
    ("VAR_GLOBAL x : INT; END_VAR PROGRAM P VAR_EXTERNAL x : INT := 5; END_VAR END_PROGRAM", "1:52", ["its initial value stands in VAR_GLOBAL"]),
    ("VAR_GLOBAL x : BOOL; END_VAR PROGRAM P VAR_EXTERNAL x AT %IX1.0.0 : BOOL; END_VAR END_PROGRAM", "1:53", ["its address stands in VAR_GLOBAL"]),
    ("FUNCTION_BLOCK A METHOD FB_Init VAR_INPUT n : INT; END_VAR END_METHOD END_FUNCTION_BLOCK VAR_GLOBAL x : A(n := 1); END_VAR "
     "PROGRAM P VAR_EXTERNAL x : A(n := 2); END_VAR END_PROGRAM", "1:147", ["its inputs of FB_Init stand in VAR_GLOBAL"]),
    ("FUNCTION_BLOCK A METHOD FB_Init VAR_INPUT n : INT; END_VAR END_METHOD END_FUNCTION_BLOCK FUNCTION F VAR_IN_OUT x : A(n := 2); END_VAR "
     "END_FUNCTION", "1:112", ["is an instance of the caller"]),
    ("PROGRAM P VAR RETAIN NON_RETAIN x : INT; END_VAR END_PROGRAM", "1:33", ["RETAIN contradicts NON_RETAIN"]),
    ("PROGRAM P VAR CONSTANT RETAIN x : INT := 3; END_VAR END_PROGRAM", "1:31", ["RETAIN contradicts CONSTANT"]),
    ("CONFIGURATION C RESOURCE R ON PC TASK t (INTERVAL := T#1ms, interval := T#2ms); PROGRAM p WITH t : P; END_RESOURCE "
     "END_CONFIGURATION PROGRAM P END_PROGRAM", "1:61", ["interval stands here twice"]),
    ("FUNCTION_BLOCK F A(); END_FUNCTION_BLOCK PROGRAM A END_PROGRAM PROGRAM Main VAR f1 : F; END_VAR END_PROGRAM", "1:50",
     ['nothing runs the program "A"', 'called in "F"', "CONFIGURATION"]),
    ("PROGRAM A ACTION Act: B(); END_ACTION END_PROGRAM PROGRAM B END_PROGRAM", "1:59", ['nothing runs the program "B"', 'called in "A.Act"']),
    ("FUNCTION_BLOCK F METHOD M A.Act(); A(); END_METHOD END_FUNCTION_BLOCK PROGRAM A ACTION Act: B(); END_ACTION END_PROGRAM PROGRAM B "
     "END_PROGRAM PROGRAM Main VAR f1 : F; END_VAR f1(); END_PROGRAM", "1:79", ['nothing runs the program "A"', 'called in "F.M"']),
    ("INTERFACE I END_INTERFACE PROGRAM P I(); END_PROGRAM", "1:37", ["is an interface"]),
    ("FUNCTION F : INT VAR_STAT n : INT; END_VAR F := 1; END_FUNCTION", "1:27", ["keeps nothing", "function block"]),
    ("FUNCTION_BLOCK B VAR x : INT; END_VAR VAR_STAT p : REF_TO INT := REF(x); END_VAR END_FUNCTION_BLOCK", "1:66",
     ["VAR_STAT exists before there is an instance"]),
    ("FUNCTION_BLOCK B VAR_INST x : INT; END_VAR END_FUNCTION_BLOCK", "1:27", ["VAR_INST is for methods"]),
    ("FUNCTION F VAR_INST x : INT; END_VAR END_FUNCTION", "1:21", ["VAR_INST is for methods"]),
    ("FUNCTION_BLOCK B VAR_STAT x : INT; x : INT; END_VAR END_FUNCTION_BLOCK", "1:36", ["B has \"x\" already"]),
    ("FUNCTION_BLOCK B VAR_STAT RETAIN x : TON; END_VAR END_FUNCTION_BLOCK", "1:34", ["RETAIN keeps values"]),
    ("FUNCTION_BLOCK B METHOD M VAR_INST RETAIN x : INT; END_VAR END_METHOD END_FUNCTION_BLOCK", "1:43", ["RETAIN in a function block"]),
    ("FUNCTION_BLOCK B METHOD M : INT VAR_STAT x : INT; END_VAR x := 3; M := x; END_METHOD END_FUNCTION_BLOCK "
     "PROGRAM P VAR f : B; n : INT; END_VAR n := f.M() + n; END_PROGRAM", "1:148", ["can change variables"]),
    ("FUNCTION_BLOCK B VAR_STAT x : INT; END_VAR END_FUNCTION_BLOCK PROGRAM P VAR n : INT; END_VAR n := B.x; END_PROGRAM", "1:101", ['"B" is a type, and no enumeration']),
    ("INTERFACE I METHOD M VAR_INST a : INT; END_VAR END_METHOD END_INTERFACE", "1:31", ["VAR_INPUT, VAR_OUTPUT and VAR_IN_OUT only"]),
    ("INTERFACE I METHOD M VAR_STAT a : INT; END_VAR END_METHOD END_INTERFACE", "1:31", ["VAR_INPUT, VAR_OUTPUT and VAR_IN_OUT only"]),
    ("INTERFACE I METHOD M VAR a : INT; END_VAR END_METHOD END_INTERFACE", "1:26", ["VAR_INPUT, VAR_OUTPUT and VAR_IN_OUT only"]),
    ("INTERFACE I METHOD M : INT M := 1; END_METHOD END_INTERFACE", "1:28", ["has no statements"]),
    ("INTERFACE I PROPERTY M : INT GET M := 1; END_GET END_PROPERTY END_INTERFACE", "1:34", ["has no statements"]),
    ("FUNCTION_BLOCK B METHOD M VAR_INPUT i : INT; END_VAR VAR_INST a : INT := i; END_VAR END_METHOD END_FUNCTION_BLOCK", "1:74", ['"i"']),
    ("FUNCTION F VAR_INPUT a : ARRAY[*] OF INT; END_VAR END_FUNCTION", "1:32", ["VAR_IN_OUT"]),
    ("TYPE T : ARRAY[*] OF INT; END_TYPE", "1:16", ["VAR_IN_OUT"]),
    ("TYPE T : STRUCT a : ARRAY[*] OF INT; END_STRUCT; END_TYPE", "1:27", ["VAR_IN_OUT"]),
    ("TYPE T : STRUCT a : BOOL R_EDGE; END_STRUCT; END_TYPE", "1:26", ["not for members"]),
    ("TYPE T : STRUCT a AT %IX1.0.1 : BOOL; END_STRUCT; END_TYPE", "1:22", ["at no address"]),
    ("TYPE T : UNION a : (Off, On); END_UNION; END_TYPE", "1:16", ["not all bits are a value"]),
    ("TYPE A : STRUCT m : (Off, On); END_STRUCT; B : STRUCT m : (On, Off); END_STRUCT; END_TYPE PROGRAM P VAR a : A; END_VAR "
     "a.m := On; END_PROGRAM", "1:127", ["several enumerations", "One without a name gets one by TYPE"]),
    ("FUNCTION F VAR_IN_OUT a : ARRAY[*] OF INT; b : ARRAY[*] OF INT; END_VAR a := b; END_FUNCTION", "1:73", ["element by element"]),
    ("FUNCTION F VAR_IN_OUT a : ARRAY[*] OF INT; END_VAR VAR r : ARRAY[1..2] OF INT; END_VAR r := a; END_FUNCTION", "1:93", ["ARRAY [*] OF INT"]),
    ("FUNCTION F VAR_IN_OUT a : ARRAY[*] OF INT; END_VAR END_FUNCTION PROGRAM Main VAR x : ARRAY[1..3] OF DINT; END_VAR F(x); END_PROGRAM", "1:117", ["ARRAY [*] OF INT and needs"]),
    ("FUNCTION F VAR_IN_OUT a : ARRAY[*,*] OF INT; END_VAR END_FUNCTION PROGRAM Main VAR x : ARRAY[1..3] OF INT; END_VAR F(x); END_PROGRAM", "1:118", ["ARRAY [*, *] OF INT and needs"]),
    ("FUNCTION F : UDINT VAR_IN_OUT a : ARRAY[*] OF INT; END_VAR F := SIZEOF(a); END_FUNCTION", "1:72", ["whose size is known"]),
    ("FUNCTION_BLOCK F VAR_IN_OUT a : ARRAY[*] OF INT; END_VAR VAR p : REF_TO INT; q : POINTER TO ARRAY[1..2] OF INT; END_VAR p := REF(a[1]); q := ADR(a); END_FUNCTION_BLOCK", "1:146", ["whose size is known"]),
    ("FUNCTION F : DINT VAR_IN_OUT a : ARRAY[*] OF INT; END_VAR F := UPPER_BOUND(a, 2); END_FUNCTION", "1:79", ["number of a dimension"]),
    ("FUNCTION F : DINT VAR_INPUT x : INT; END_VAR F := UPPER_BOUND(x, 1); END_FUNCTION", "1:63", ["an array"]),
    ("FUNCTION F VAR_IN_OUT CONSTANT a : ARRAY[*] OF INT; END_VAR a[1] := 2; END_FUNCTION", "1:61", ["CONSTANT"]),
    ("FUNCTION F VAR_IN_OUT a : ARRAY[*,*,*,*,*] OF INT; END_VAR END_FUNCTION", "1:33", ["at most 4"]),
    ("FUNCTION F VAR_IN_OUT a : ARRAY[1..3] OF INT; END_VAR END_FUNCTION FUNCTION G VAR_IN_OUT a : ARRAY[*] OF INT; END_VAR F(a); END_FUNCTION", "1:121", ["needs a variable of this type"]),
    ("PROGRAM P VAR a : (Idle, Run); Idle : INT; END_VAR a := Idle; END_PROGRAM", "1:57", ["hides the enumerator", "!unnamed"]),
    ("PROGRAM P VAR a : (Idle, Run); END_VAR a := a.Run; END_PROGRAM", "1:47", ["is the variable here; the enumerator is Run", "!unnamed"]),
    ("FUNCTION_BLOCK A VAR_TEMP n : INT; END_VAR THIS^.n := 1; END_FUNCTION_BLOCK", "1:50", ["VAR_TEMP of A: its statements know it"]),
    ("FUNCTION_BLOCK A VAR_TEMP PUBLIC n : INT; END_VAR END_FUNCTION_BLOCK PROGRAM P VAR a : A; i : INT; END_VAR i := a.n; "
     "END_PROGRAM", "1:115", ["VAR_TEMP of A: its statements know it"]),
    ("TYPE U : UNION n : LINT; axis : AXIS_REF; END_UNION; END_TYPE", "1:26", ["not all bits are a value of AXIS_REF"]),
    ("TYPE U : UNION n : LINT; g : ARRAY[1..2] OF AXES_GROUP_REF; END_UNION; END_TYPE", "1:26", ["not all bits are a value"]),
    ("TYPE A EXTENDS Bace : STRUCT x : INT; END_STRUCT; Base : STRUCT y : INT; END_STRUCT; END_TYPE", "1:6", ["no structure", 'did you mean "Base"']),
    ("TYPE A EXTENDS B : STRUCT x : INT; END_STRUCT; B EXTENDS A : STRUCT y : INT; END_STRUCT; END_TYPE", "1:", ["extends itself"]),
    ("TYPE A EXTENDS A : STRUCT x : INT; END_STRUCT; END_TYPE", "1:6", ["no structure"]),
    ("TYPE A EXTENDS B : STRUCT x : INT; END_STRUCT; B : STRUCT X : INT; END_STRUCT; END_TYPE", "1:27", ['A has "x" already']),
    ("TYPE A EXTENDS B : STRUCT x : INT; END_STRUCT; B : C; C : B; END_TYPE", "1:6", ["no structure"]),
    ("TYPE A EXTENDS B : STRUCT x : INT; END_STRUCT; B : A; END_TYPE", "1:6", ["no structure"]),
    ("TYPE A EXTENDS B : STRUCT x : INT; END_STRUCT; B : ARRAY[1..2] OF INT; END_TYPE", "1:6", ["no structure"]),
    ("TYPE A EXTENDS INT : STRUCT x : INT; END_STRUCT; END_TYPE", "1:6", ["no structure"]),
    ("TYPE A EXTENDS B : STRUCT x : INT; END_STRUCT; B : UNION y : INT; END_UNION; END_TYPE", "1:6", ["no structure"]),
    ("TYPE A EXTENDS AXIS_REF : STRUCT x : INT; END_STRUCT; END_TYPE", "1:6", ["no structure"]),
    ("TYPE A IMPLEMENTS B : STRUCT x : INT; END_STRUCT; B : STRUCT y : INT; END_STRUCT; END_TYPE", "1:8", ["EXTENDS"]),
    ("CONFIGURATION C RESOURCE R AN PC PROGRAM p : P; END_RESOURCE END_CONFIGURATION PROGRAM P END_PROGRAM", "1:28", ["expected ON"]),
    ("TYPE A : (Off, On); END_TYPE PROGRAM P VAR a : A; END_VAR a := Onn; END_PROGRAM", "1:64", ['did you mean "On"']),
    ("FUNCTION_BLOCK B VAR m : (Off, On); END_VAR END_FUNCTION_BLOCK PROGRAM P VAR i : INT; END_VAR i := On; END_PROGRAM", "1:100", ['"On"']),
    ("FUNCTION_BLOCK B VAR m : (Off, off); END_VAR END_FUNCTION_BLOCK", "1:32", ["already"]),
    ("FUNCTION_BLOCK B VAR m : (Off, On); n : (On, Gone); END_VAR m := Gone; END_FUNCTION_BLOCK", "1:66", ["m", "(Off, ...)"]),
    ("CONFIGURATION C END_CONFIGURATION", "1:15", ["no program"]),
    ("PROGRAM P VAR x AT %IX1.0 : BOOL; END_VAR END_PROGRAM", "1:20", ["%IX3.0.5"]),
    ("PROGRAM P VAR x AT %IX1.0.8 : BOOL; END_VAR END_PROGRAM", "1:20", ["%IX3.0.5"]),
    ("PROGRAM P VAR x AT %IW1.0 : DINT; END_VAR END_PROGRAM", "1:20", ["16 bits", "DINT"]),
    ("PROGRAM P VAR x AT %MB4 : S; END_VAR END_PROGRAM TYPE S : STRUCT a : LINT (0..5); END_STRUCT; END_TYPE", "1:20",
     ["a multiple of 8"]),
    ("PROGRAM P VAR x AT %MW1 : INT; END_VAR END_PROGRAM", "1:20", ["multiple of 2"]),
    ("PROGRAM P VAR x AT %MX1 : BOOL; END_VAR END_PROGRAM", "1:20", ["%MX4.3"]),
    ("PROGRAM P VAR x AT %MB1 : INT; END_VAR END_PROGRAM", "1:20", ["8 bits", "INT"]),
    ("PROGRAM P VAR x AT %I* : BOOL; END_VAR END_PROGRAM", "1:20", ["*"]),
    ("FUNCTION_BLOCK P VAR x AT %IX1.0.1 : BOOL; END_VAR END_FUNCTION_BLOCK", "1:27", ["several instances"]),
    ("PROGRAM P VAR RETAIN t : TON; END_VAR END_PROGRAM", "1:22", ["RETAIN keeps values"]),
    ("PROGRAM P VAR RETAIN t : REF_TO INT; END_VAR END_PROGRAM", "1:22", ["RETAIN keeps values"]),
    ("FUNCTION_BLOCK P VAR RETAIN t : INT; END_VAR END_FUNCTION_BLOCK", "1:29", ["VAR_IN_OUT"]),
    ("MC_Power", "1:1", ["cannot stand here"]),
    ("PROGRAM P VAR b : BOOL; END_VAR b := b.IF; END_PROGRAM", "1:40", ["expected a name, a number or a value of a type"]),
    ("\xff\xfeP\0R\0O\0G\0", "1:1", ["UTF-16: save it as UTF-8"]),
    ("<?xml version=\"1.0\"?>\n<project xmlns=\"http://www.plcopen.org/xml/tc6_0200\"/>", "1:1", ["XML, and none of a TwinCAT project"]),
    ("PROGRAM P VAR i := 1; END_VAR END_PROGRAM", "1:17", ["cannot stand here; expected AT, ',' or ':'"]),
    ("FUNCTION_BLOCK MC_Power END_FUNCTION_BLOCK", "1:16", ["already"]),
]
# Sources that are large, deep or no text at all: an answer in words, whatever it is.
HUGE = [
    "PROGRAM P VAR i : INT; END_VAR i := " + "(" * 1000000 + "1" + ")" * 1000000 + "; END_PROGRAM",
    "PROGRAM P VAR i : INT; END_VAR i := 1" + " + 1" * 1000000 + "; END_PROGRAM",
    "PROGRAM P VAR i : INT; END_VAR i := " + "-" * 1000000 + "1; END_PROGRAM",
    "PROGRAM P " + "IF TRUE THEN " * 100000 + "END_PROGRAM",
    "PROGRAM P VAR i : INT; END_VAR " + "IF TRUE THEN " * 3000 + "i := 1; " + "END_IF " * 3000 + "END_PROGRAM",
    "TYPE A : " + "ARRAY[1..2] OF " * 100000 + "INT; END_TYPE",
    "(*" * 1000000, "a" * 1000000, "%" * 10000, "'" + "a" * 1000000, "\0" * 1000, "\xff" * 1000, "PROGRAM",
    "".join(f"TYPE T{i} : STRUCT a : T{i + 1}; END_STRUCT; END_TYPE\n" for i in range(100000)),
    "".join(f"TYPE T{i} : T{i + 1}; END_TYPE\n" for i in range(100000)),
    "".join(f"FUNCTION F{i} : INT F{i} := F{i + 1}(); END_FUNCTION\n" for i in range(30000)),
    "PROGRAM P VAR CONSTANT " + "".join(f"c{i} : INT := c{i + 1};" for i in range(100000)) + " END_VAR END_PROGRAM",
    "PROGRAM P VAR i : INT; END_VAR i := a" + ".b" * 1000000 + "; END_PROGRAM",
    "PROGRAM P VAR a : ARRAY[1..1000000] OF INT := [1000000(1)]; b : ARRAY[1..10] OF INT := [10(10(1))]; END_VAR END_PROGRAM",
]

# Good sources of which nobody calls anything: no program is built of them.
NOTHING_RUNS = ["", "(* later *)\n", "FUNCTION_BLOCK Later\nVAR_INPUT i : INT; END_VAR\nEND_FUNCTION_BLOCK\n"]


def run(*words):
    return subprocess.run([os.path.join(BIN, "cm1e"), "st", *words], capture_output=True, timeout=120)


def answer(folder, text):
    path = os.path.join(folder, "case.st")
    with open(path, "w", encoding="latin-1") as file:
        file.write(text)
    result = run("check", path, "--json")
    if result.returncode not in (0, 1):
        sys.exit(f"{text[:300]}\nexit status {result.returncode}: {result.stderr.decode()[-500:]}")
    return json.loads(result.stdout) if result.stdout else [], result


def check_case(folder, text, place, words, shown):
    errors, _ = answer(folder, text)
    if not errors:
        faults.append(f"{shown}: no error")
        return
    found = "".join(f"{error['line']}:{error['column']}: {error['text']}\n" for error in errors)
    first = f"{errors[0]['line']}:{errors[0]['column']}"
    if not (first == place or place.endswith(":") and first.startswith(place)) or \
            not all((word.lstrip("!") in errors[0]["text"]) != word.startswith("!") for word in words):
        faults.append(f"{shown}: expected {place} and {words}, found {found}")
    if len(errors) > 2:
        faults.append(f"{shown}: one mistake, and {len(errors)} errors: {found}")


def check_bounds(folder):
    """Each bound is taken, and the next number refused: priorities, and the last day of each month."""
    task = "CONFIGURATION C RESOURCE R ON PC TASK t(PRIORITY := {}); PROGRAM a WITH t : P (o => g, i := 3); END_RESOURCE " \
           "END_CONFIGURATION VAR_GLOBAL g : INT; f : DINT; END_VAR PROGRAM P VAR_INPUT i : INT; END_VAR VAR_OUTPUT o : INT; " \
           "END_VAR END_PROGRAM"
    last = {month: 31 if month in (1, 3, 5, 7, 8, 10, 12) else 30 if month != 2 else 28 for month in range(1, 13)}
    days = [f"2023-{month:02}-{day:02}" for month, day in last.items()] + ["2024-02-29", "2000-02-29", "1970-01-01"]
    of_another = "PROGRAM P VAR CONSTANT N : INT := 3; END_VAR END_PROGRAM PROGRAM Q VAR i : INT; END_VAR " \
                 "CASE i OF P.N: i := 1; END_CASE END_PROGRAM" # its value is known here, too
    for source in (of_another, task.format(0), task.format(65535), PROGRAM.format("".join(f"d1 := D#{day};" for day in days))):
        if answer(folder, source)[0]:
            faults.append(f"{source}: nothing is wrong in it, and it has errors: {answer(folder, source)[0]}")
    for number in (-1, 65536):
        check_case(folder, task.format(number), "1:41", ["PRIORITY is 0 (the highest) to 65535"], f"PRIORITY {number}")
    check_case(folder, task.format(1).replace("=> g", "=> f"), "1:79", ['"o" needs a variable of type INT'], "=> f")
    for day in [f"2023-{month:02}-{day + 1:02}" for month, day in last.items()] + \
            ["2100-02-29", "2023-00-01", "2023-01-00", "1969-12-31", "2263-01-01"]:
        check_case(folder, PROGRAM.format(f"d1 := D#{day};"), "9:7", ["DATE"], day)


# Each changes a global variable: its place is behind a "~". What is read only, or is of the function itself, may stand there.
IN_FUNCTION = """VAR_GLOBAL g : INT; s : Pair; a : ARRAY[1..2] OF INT; fb : Block; b : BOOL; END_VAR
TYPE Pair : STRUCT x : INT; END_STRUCT END_TYPE
FUNCTION_BLOCK Block VAR n : INT; END_VAR VAR_OUTPUT o : INT; END_VAR METHOD M : INT n := n + 1; M := n; END_METHOD o := o + 1; END_FUNCTION_BLOCK
FUNCTION Change : INT VAR_IN_OUT v : INT; END_VAR VAR_OUTPUT o : INT; END_VAR v := v + 1; o := v; END_FUNCTION
FUNCTION F : INT VAR_EXTERNAL g : INT; s : Pair; a : ARRAY[1..2] OF INT; fb : Block; b : BOOL; END_VAR VAR i : INT; q : REF_TO INT; END_VAR
{}
END_FUNCTION PROGRAM Main VAR n : INT; END_VAR n := F(); END_PROGRAM"""
CHANGES = ["~g := 1;", "s.~x := 1;", "~a[1] := 1;", "i := Change(v := ~g);", "i := Change(v := s.~x);", "i := Change(v := ~a[2]);",
           "i := Change(v := i, o => ~g);", "~fb();", "i := ~fb.M();", "q := REF(~g);", "~b S= i = 0;",
           "FOR ~g := 1 TO 2 DO i := i + 1; END_FOR"]
READS = "i := g + s.x + a[1]; i := fb.o; i := Change(v := i, o => i); FOR i := g TO 2 DO F := i; END_FOR"


def check_changes(folder):
    if answer(folder, IN_FUNCTION.format(READS))[0]:
        faults.append(f"a function that only reads has errors: {answer(folder, IN_FUNCTION.format(READS))[0]}")
    for change in CHANGES:
        check_case(folder, IN_FUNCTION.format(change.replace("~", "")), f"6:{change.index('~') + 1}",
                   ["a function changes no global variable"], change)


# How many arguments the functions of the standard have: the least, and the most (0: any number above it).
ARITIES = {
    (0, 0): "TIME",
    (1, 1): "ABS SQRT LN LOG EXP SIN COS TAN ASIN ACOS ATAN TRUNC MOVE REF ADR __ISVALIDREF SIZEOF LEN",
    (2, 2): "ATAN2 SHL SHR ROL ROR SUB DIV EXPT GT GE EQ NE LE LT LOWER_BOUND UPPER_BOUND LEFT RIGHT FIND",
    (2, None): "MIN MAX ADD MUL CONCAT", (3, 3): "LIMIT SEL MID INSERT DELETE", (3, None): "MUX", (4, 4): "REPLACE",
}


def check_arities(folder):
    """One argument too few, the least number, the most, one too many; what is refused is told with both numbers."""
    cases = [(name, count, least <= count and (most is None or count <= most))
             for (least, most), names in ARITIES.items() for name in names.split()
             for count in {max(least - 1, 0), least, least + 1 if most is None else most, (most or least) + 1}]
    for first in range(0, len(cases), 20): # no more errors are told of a file
        some = cases[first:first + 20]
        text = PROGRAM.format("\n".join(f"{name}({', '.join('i' * count)});" for name, count, _ in some))
        found = {error["line"]: error["text"] for error in answer(folder, text)[0]}
        for line, (name, count, good) in enumerate(some, 9):
            text = found.get(line, "")
            if good == ("argument" in text) or (not good and not text.endswith(f"; found {count}")):
                faults.append(f"{name} of {count}: {text!r}")


def damaged(source, generator):
    """A good program with some of its words changed, left out or doubled."""
    words = source.split(" ")
    for _ in range(generator.randrange(1, 4)):
        at = generator.randrange(len(words))
        words[at] = generator.choice(["", words[generator.randrange(len(words))], words[at] + " " + words[at], "(", ";"])
    return " ".join(words)


with tempfile.TemporaryDirectory() as folder:
    good = PROGRAM.format("t(IN := b, PT := T#1s, Q => b); FOR i := 1 TO N DO a[i] := Twice(i); END_FOR\n"
                          "CASE c OF Red: c := Green; ELSE c := E_Color.Red; END_CASE q := REF(i); q^ := 3;")
    if answer(folder, good)[0]:
        sys.exit(f"the good program has errors: {answer(folder, good)[0]}")
    for statement, place, words in STATEMENTS:
        check_case(folder, PROGRAM.format(statement), place, words, statement)
    for source, place, words in SOURCES:
        check_case(folder, source, place, words, source)
    check_bounds(folder)
    check_arities(folder)
    check_changes(folder)
    for source in HUGE:
        errors, result = answer(folder, source)
        if any(not error["text"] for error in errors) or (result.returncode == 1) != bool(errors):
            faults.append(f"{source[:60]}: exit status {result.returncode}, {errors[:2]}")
    for source in NOTHING_RUNS:
        if answer(folder, source)[0]:
            faults.append(f"{source!r}: it has an error, and nothing is wrong in it")
        path = os.path.join(folder, "nothing.st")
        with open(path, "w", encoding="latin-1") as file:
            file.write(source)
        result = run("build", path)
        if result.returncode != 1 or b"nothing would run" not in result.stderr or os.path.exists(path[:-2] + "so"):
            faults.append(f"{source!r} is built: exit status {result.returncode}, {result.stderr.decode()}")
    seed = random.randrange(10 ** 9)
    generator = random.Random(seed)
    for _ in range(500 if os.environ.get("CM1E_TEST_EFFORT") == "full" else 100):
        answer(folder, damaged(good, generator))
if faults:
    sys.exit("\n".join(faults) + f"\n{len(faults)} faults")
print(f"{len(STATEMENTS) + len(SOURCES) + len(HUGE) + len(NOTHING_RUNS)} cases, seed {seed}")
