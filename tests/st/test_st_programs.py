#!/usr/bin/env python3
"""Random programs: statements, loops, arrays, functions in a namespace, function blocks with R_EDGE and F_EDGE, classes,
subranges, variables AT %M. Each is made once, as Structured Text and as
Python; after each of some calls of its task all its variables are what Python computes.

test_st_programs.py BIN-DIRECTORY [COUNT [SEED]]
"""
import os
import random
import sys
import tempfile

from st_host import Host

PER_SOURCE, CALLS, STEPS_MAX, NUMBERS, TRUTHS, PLACES, DEPTH = 20, 4, 20000, 5, 3, 8, 3
COUNTERS, RANGED_COUNTER = "i0, i2, i3 : DINT; i1 : DINT (-40..40) := 0;", "i1"


def wrap(value):
    return (value + 2 ** 31) % 2 ** 32 - 2 ** 31


def divide(a, b):
    return wrap(abs(a) // abs(b) * (1 if (a < 0) == (b < 0) else -1))


def modulo(a, b):
    return 0 if b == 0 else a - b * (abs(a) // abs(b) * (1 if (a < 0) == (b < 0) else -1))


def choose(selector, a, b):
    """Both sides have been evaluated, as in Structured Text."""
    return b if selector else a


class TooLong(Exception):
    pass


class Budget:
    """A program that takes too long is not tried: the reference says so before."""

    def __init__(self):
        self.left = STEPS_MAX

    def step(self):
        self.left -= 1
        if self.left < 0:
            raise TooLong


def counts(first, last, step):
    """The values of a FOR, and the one behind them."""
    values = list(range(first, last + (1 if step > 0 else -1), step))
    return values, first + len(values) * step


class Writer:
    """Both texts of a body, line by line."""

    def __init__(self):
        self.st, self.python, self.depth = [], [], 1

    def put(self, st, python):
        self.st.append("  " * self.depth + st)
        self.python.append("    " * self.depth + python)

    def both(self, st, python):
        for line in st:
            self.st.append("  " * self.depth + line)
        for line in python:
            self.python.append("    " * self.depth + line)


class Maker:
    def __init__(self, rng, functions):
        self.random, self.functions = rng, functions
        self.numbers, self.truths, self.arrays, self.loops, self.inside = [], [], [], 0, 0
        self.ranged, self.edges = {}, []  # variables of subranges with their limits; inputs that nobody writes

    def plain(self):
        """A number without a subrange."""
        return self.random.choice([name for name in self.numbers if name not in self.ranged])

    # ---- expressions: (ST, Python) ----

    def variable(self):
        name = self.random.choice(self.numbers + [f"i{k}" for k in range(self.inside)])
        return name, f"v['{name}']"

    def number(self, depth):
        r = self.random
        if depth <= 0 or r.random() < 0.25:
            if r.random() < 0.3:
                value = r.choice((0, 1, -1, 2, 7, 100, 2147483647, -2147483648, r.randrange(-50, 50)))
                return f"DINT#{value}", f"({value})"
            return self.variable()
        kind = r.choice(("+", "-", "*", "/", "MOD", "-x", "MIN", "MAX", "SEL", "a[]", "call", "ABS"))
        a, b = self.number(depth - 1), self.number(depth - 1)
        if kind in "+-*":
            return f"({a[0]} {kind} {b[0]})", f"wrap({a[1]} {kind} {b[1]})"
        if kind == "/":
            divisor = r.choice((1, -1, 2, 3, -7, 10))
            return f"({a[0]} / ({divisor}))", f"divide({a[1]}, {divisor})"
        if kind == "MOD":
            b = self.variable() # a literal 0 is refused
            return f"({a[0]} MOD {b[0]})", f"modulo({a[1]}, {b[1]})"
        if kind == "-x":
            return f"(-({a[0]} + 0))", f"wrap(-{a[1]})"
        if kind in ("MIN", "MAX"):
            return f"{kind}({a[0]} + 0, {b[0]} + 0)", f"{kind.lower()}({a[1]}, {b[1]})"
        if kind == "ABS":
            return f"ABS({a[0]} + 0)", f"wrap(abs({a[1]}))"
        if kind == "SEL":
            c = self.truth(depth - 1)
            return f"SEL({c[0]}, {a[0]} + 0, {b[0]} + 0)", f"choose({c[1]}, {a[1]}, {b[1]})"
        if kind == "a[]" and self.arrays:
            place = self.place(depth - 1)
            return f"a[{place[0]}]", f"v['a'][{place[1]}]"
        if kind == "call" and self.functions:
            name = r.choice(self.functions)
            space = r.choice(("", "Lib.Math.")) if name == "F1" else ""
            return f"{space}{name}({a[0]}, {b[0]})", f"{name}(budget, {a[1]}, {b[1]})"
        return a

    def place(self, depth):
        a = self.number(depth)
        return f"ABS(({a[0]} + 0) MOD {PLACES})", f"abs(modulo({a[1]}, {PLACES}))"

    def truth(self, depth):
        r = self.random
        if depth <= 0 or r.random() < 0.2:
            known = self.truths + self.edges
            if not known or r.random() < 0.2:
                value = r.random() < 0.5
                return str(value).upper(), str(value)
            name = r.choice(known)
            return name, f"v['{name}']"
        kind = r.choice(("=", "<>", "<", ">", "<=", ">=", "AND", "OR", "XOR", "NOT"))
        if kind == "NOT":
            a = self.truth(depth - 1)
            return f"(NOT {a[0]})", f"(not {a[1]})"
        if kind in ("AND", "OR", "XOR"):
            a, b = self.truth(depth - 1), self.truth(depth - 1)
            return f"({a[0]} {kind} {b[0]})", f"({a[1]} {dict(AND='&', OR='|', XOR='^')[kind]} {b[1]})"
        a, b = self.number(depth - 1), self.number(depth - 1)
        return f"({a[0]} + 0 {kind} {b[0]} + 0)", f"({a[1]} {dict(zip(('=', '<>'), ('==', '!='))).get(kind, kind)} {b[1]})"

    # ---- statements ----

    def block(self, w, depth):
        w.depth += 1
        w.put("", "budget.step()")
        for _ in range(self.random.randrange(1, 4)):
            self.statement(w, depth)
        w.depth -= 1

    def statement(self, w, depth):
        kinds = ["number", "number", "truth", "array", "call", "method"]
        if depth > 0:
            kinds += ["if", "if", "case", "for", "while", "repeat"]
        if self.loops and depth < DEPTH:
            kinds += ["leave"]
        getattr(self, "put_" + self.random.choice(kinds))(w, depth)

    def put_number(self, w, _):
        name, e = self.random.choice(self.numbers), self.number(3)
        if name in self.ranged:
            low, high = self.ranged[name]
            w.put(f"{name} := LIMIT(DINT#{low}, {e[0]} + 0, {high});", f"v['{name}'] = min(max({e[1]}, {low}), {high})")
            return
        w.put(f"{name} := {e[0]};", f"v['{name}'] = wrap({e[1]})")

    def put_truth(self, w, depth):
        if not self.truths:
            self.put_number(w, depth)
            return
        name, e = self.random.choice(self.truths), self.truth(3)
        w.put(f"{name} := {e[0]};", f"v['{name}'] = {e[1]}")

    def put_array(self, w, depth):
        if not self.arrays:
            self.put_number(w, depth)
            return
        place, e = self.place(1), self.number(2)
        w.put(f"a[{place[0]}] := {e[0]};", f"v['a'][{place[1]}] = wrap({e[1]})")

    def put_call(self, w, depth):
        if not self.arrays:
            self.put_number(w, depth)
            return
        fb, a, target = self.random.choice(("fb0", "fb1")), self.number(2), self.plain()
        up, down = self.truth(1), self.truth(1)
        w.put(f"{fb}(x := {a[0]}, up := {up[0]}, down := {down[0]}, sum => {target});",
              f"v['{target}'] = Block(budget, v['{fb}'], {a[1]}, {up[1]}, {down[1]})")

    def put_method(self, w, depth):
        if not self.arrays:
            self.put_number(w, depth)
            return
        a, target = self.number(2), self.plain()
        method = self.random.choice(("Add", "Turn"))
        w.put(f"{target} := object.{method}({a[0]});", f"v['{target}'] = {method}(v['object'], {a[1]})")

    def put_if(self, w, depth):
        c = self.truth(2)
        w.put(f"IF {c[0]} THEN", f"if {c[1]}:")
        self.block(w, depth - 1)
        if self.random.random() < 0.4:
            c = self.truth(2)
            w.put(f"ELSIF {c[0]} THEN", f"elif {c[1]}:")
            self.block(w, depth - 1)
        if self.random.random() < 0.5:
            w.put("ELSE", "else:")
            self.block(w, depth - 1)
        w.put("END_IF", "pass")

    def put_case(self, w, depth):
        place, name = self.place(2), f"s{len(w.st)}"
        w.put(f"CASE {place[0]} OF", f"{name} = {place[1]}")
        labels = list(range(PLACES))
        self.random.shuffle(labels)
        for number, label in enumerate(labels[:self.random.randrange(1, 4)]):
            second = labels[number + 4]
            w.depth += 1
            w.put(f"{label}, {second}:", f"{'el' if number else ''}if {name} in ({label}, {second}):")
            self.block(w, depth - 1)
            w.depth -= 1
        if self.random.random() < 0.6:
            w.depth += 1
            w.python.append("    " * w.depth + "else:")
            w.depth -= 1
            w.st.append("  " * w.depth + "ELSE")
            w.depth += 1
            self.block(w, depth - 1)
            w.depth -= 1
        w.put("END_CASE", "pass")
        self.indent_case(w, name)

    @staticmethod
    def indent_case(w, name):
        """The branches in Python are one deeper than `name`: an `if True` holds them."""
        for i in range(len(w.python) - 1, -1, -1):
            if w.python[i].strip().startswith(f"{name} = "):
                w.python.insert(i + 1, "    " * w.depth + "if True:")
                return

    def put_for(self, w, depth):
        if self.inside > 3:
            self.put_number(w, depth)
            return
        r, counter = self.random, f"i{self.inside}"
        first, last, step = r.randrange(-4, 5), r.randrange(-4, 9), r.choice((1, 1, 2, -1, -3))
        w.put(f"FOR {counter} := {first} TO {last} BY {step} DO",
              f"for v['{counter}'] in counts({first}, {last}, {step})[0]:")
        self.inside += 1
        self.loops += 1
        self.block(w, depth - 1)
        self.loops -= 1
        w.put("END_FOR", "else:")
        left = "pass" if counter == RANGED_COUNTER else f"v['{counter}'] = counts({first}, {last}, {step})[1]"
        w.python.append("    " * (w.depth + 1) + left)
        self.inside -= 1

    def put_while(self, w, depth):
        c, name = self.truth(2), self.plain()
        limit = self.random.randrange(1, 100)
        w.put(f"WHILE ({c[0]} AND ({name} < {limit})) DO", f"while ({c[1]} and (v['{name}'] < {limit})):")
        w.depth += 1
        w.put(f"{name} := ABS(({name} / 2) MOD 1000) + 9;", f"v['{name}'] = abs(modulo(divide(v['{name}'], 2), 1000)) + 9")
        w.depth -= 1
        self.loops += 1
        self.block(w, depth - 1)
        self.loops -= 1
        w.put("END_WHILE", "pass")

    def put_repeat(self, w, depth):
        name, limit = self.plain(), self.random.randrange(1, 9)
        loops, self.loops = self.loops, 0 # EXIT and CONTINUE of a REPEAT have no twin in Python
        w.put("REPEAT", "while True:")
        self.block(w, depth - 1)
        w.depth += 1
        w.put(f"{name} := ABS({name} MOD 100) - 1;", f"v['{name}'] = abs(modulo(v['{name}'], 100)) - 1")
        w.depth -= 1
        w.st.append("  " * w.depth + f"UNTIL {name} < {limit} END_REPEAT")
        w.python.append("    " * (w.depth + 1) + f"if v['{name}'] < {limit}: break")
        self.loops = loops

    def put_leave(self, w, _):
        c, word = self.truth(2), self.random.choice(("EXIT", "CONTINUE"))
        w.put(f"IF {c[0]} THEN {word}; END_IF", f"if {c[1]}: {'break' if word == 'EXIT' else 'continue'}")


def make_function(rng, name, functions):
    maker, w = Maker(rng, functions), Writer()
    maker.numbers = ["x", "y", "z"]
    for _ in range(3):
        maker.statement(w, 2)
        if rng.random() < 0.4:
            c, e = maker.truth(2), maker.number(2)
            w.put(f"IF {c[0]} THEN {name} := {e[0]}; RETURN; END_IF", f"if {c[1]}: return wrap({e[1]})")
    e = maker.number(2)
    st = [f"FUNCTION {name} : DINT VAR_INPUT x, y : DINT; END_VAR VAR z : DINT; {COUNTERS} END_VAR", *w.st,
          f"  {name} := {e[0]};", "END_FUNCTION"]
    if name == "F1":
        st = ["NAMESPACE Lib.Math", *st, "END_NAMESPACE", "USING Lib.Math;"]
    python = [f"def {name}(budget, x, y):", "    budget.step()",
              "    v = dict(x=wrap(x), y=wrap(y), z=0, i0=0, i1=0, i2=0, i3=0)", *w.python, f"    return wrap({e[1]})"]
    return st, python


def make_block(rng, functions):
    maker, w = Maker(rng, functions), Writer()
    maker.numbers, maker.edges = ["x", "n", "sum"], ["up", "down"]
    for _ in range(3):
        maker.statement(w, 1)
    st = ["FUNCTION_BLOCK Block VAR_INPUT x : DINT; up : BOOL R_EDGE; down : BOOL F_EDGE; END_VAR VAR_OUTPUT sum : DINT; "
          f"END_VAR VAR n : DINT; {COUNTERS} END_VAR", *w.st, "END_FUNCTION_BLOCK"]
    python = ["def Block(budget, v, x, up, down):", "    budget.step()", "    v['x'] = wrap(x)",
              "    v['up'], v['down'] = up and not v['was up'], v['was down'] and not down",
              "    v['was up'], v['was down'] = up, down", *w.python, "    return v['sum']"]
    return st, python


CLASS = """CLASS Base VAR PUBLIC total : DINT; END_VAR VAR step : DINT (1..9) := 3; END_VAR
METHOD PUBLIC Add : DINT VAR_INPUT more : DINT; END_VAR total := total + more * step; Add := total; END_METHOD
METHOD PUBLIC Turn : DINT VAR_INPUT more : DINT; END_VAR Turn := more; END_METHOD END_CLASS
CLASS Thing EXTENDS Base METHOD PUBLIC OVERRIDE Turn : DINT VAR_INPUT more : DINT; END_VAR
step := LIMIT(DINT#1, ABS(more MOD 12), 9); Turn := SUPER.Add(more); Turn := -THIS.total; END_METHOD END_CLASS"""


def add(v, more):
    v["total"] = wrap(v["total"] + wrap(more * v["step"]))
    return v["total"]


def turn(v, more):
    v["step"] = min(max(1, abs(modulo(more, 12))), 9)
    return wrap(-add(v, more))


def make_program(rng, number, functions):
    maker, w = Maker(rng, functions), Writer()
    maker.numbers, maker.arrays = [f"d{k}" for k in range(NUMBERS)], ["a"]
    maker.truths = [f"b{k}" for k in range(TRUTHS)]
    maker.ranged = {"q": (-9, 40)}
    maker.numbers.append("q")
    for _ in range(rng.randrange(3, 9)):
        maker.statement(w, DEPTH)
    st = [f"PROGRAM P{number}", f"VAR d0 AT %MD{4 * number} : DINT; {', '.join(maker.numbers[1:-1])} : DINT; {COUNTERS}",
          f"q : DINT (-9..40) := 0; b0 AT %MX{number + 4 * PER_SOURCE}.{number % 8} : BOOL; {', '.join(maker.truths[1:])} : BOOL;",
          f"a : ARRAY [0..{PLACES - 1}] OF DINT; fb0, fb1 : Block; object : Thing; END_VAR", *w.st, "END_PROGRAM"]
    return st, [f"def P{number}(budget, v):", *w.python]


def fresh():
    block = dict.fromkeys(("x", "n", "sum", "i0", "i1", "i2", "i3"), 0)
    block.update(dict.fromkeys(("up", "down", "was up", "was down"), False))
    v = dict.fromkeys([f"d{k}" for k in range(NUMBERS)] + ["q", "i0", "i1", "i2", "i3"], 0)
    v.update({f"b{k}": False for k in range(TRUTHS)}, a=[0] * PLACES, fb0=dict(block), fb1=dict(block),
             object={"total": 0, "step": 3})
    return v


def expected(python):
    """Name of each program: its variables after each call; programs that take too long are left out."""
    world = {"Add": add, "Turn": turn, "wrap": wrap, "divide": divide, "modulo": modulo, "counts": counts, "choose": choose}
    exec("\n".join(python), world)  # what we have made ourselves
    result = {}
    for name in [name for name in world if name[0] == "P" and name[1:].isdigit()]:
        states, v = [], fresh()
        try:
            for _ in range(CALLS):
                world[name](Budget(), v)
                states.append({key: list(value) if key == "a" else dict(value) if isinstance(value, dict) else value
                               for key, value in v.items()})
            result[name] = states
        except TooLong:
            pass
    return result


def check(binaries, folder, seed, count):
    rng = random.Random(seed)
    st, python, functions, programs = [CLASS], [], [], {}
    for name in ("F0", "F1"):
        texts = make_function(rng, name, list(functions))
        functions.append(name)
        st += texts[0]
        python += texts[1]
    texts = make_block(rng, functions)
    st, python = st + texts[0], python + texts[1]
    for number in range(count):
        programs[f"P{number}"] = make_program(rng, number, functions)
    known = expected(python + [line for texts in programs.values() for line in texts[1]])
    if not known:
        return 0
    for name in known:
        st += programs[name][0]
    host = Host(binaries, folder, "\n".join(st), f"programs{seed}")
    for call in range(CALLS):
        if not host.run():
            sys.exit(f"seed {seed}: the program was stopped: {host.fault()}, {host.source}")
        for name, states in known.items():
            for key, value in states[call].items():
                pairs = {f"a[{k}]": x for k, x in enumerate(value)} if key == "a" else \
                    {f"{key}.{k}": x for k, x in value.items() if k not in ("up", "down")} if isinstance(value, dict) \
                    else {key: value}
                for variable, wanted in pairs.items():
                    if f"{name}.{variable}" in host.variables and host.value(f"{name}.{variable}") != int(wanted):
                        sys.exit(f"seed {seed}, {name}, call {call + 1}: {variable} is {host.value(f'{name}.{variable}')}; "
                                 f"expected {int(wanted)}\n" + "\n".join(programs[name][0]))
    return len(known)


def main():
    full = os.environ.get("CM1E_TEST_EFFORT") == "full"
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 200 if full else 20
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else random.randrange(10 ** 9)
    done, tried = 0, 0
    with tempfile.TemporaryDirectory() as folder:
        while done < count:
            done += check(sys.argv[1], folder, seed + tried, min(PER_SOURCE, count - done))
            tried += 1
    print(f"{done} programs from seed {seed}")


main()
