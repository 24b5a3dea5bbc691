#!/usr/bin/env python3
"""Random expressions of every elementary type, also with variables of subranges and in memory (%M): what the translated
program computes is what a reference in Python computes, which knows the types by the ranges of their values only.

test_st_random.py BIN-DIRECTORY [COUNT [SEED]]
"""
import math
import os
import random
import struct
import sys
import tempfile

from st_host import Host

INTS = {f"{sign}{name}": (bits, sign == "") for name, bits in (("SINT", 8), ("INT", 16), ("DINT", 32), ("LINT", 64))
        for sign in ("", "U")}
BITS = {"BYTE": 8, "WORD": 16, "DWORD": 32, "LWORD": 64}
REALS = {"REAL": 24, "LREAL": 53}
TEXTS = {"STRING": "abcAB01 $'", "WSTRING": "abcAB01 $\"\u00e4\u00df\u20ac"}
PER_PROGRAM, PER_UNIT = 400, 20  # a large unit takes the compiler long


def limits(name):
    if name in BITS:
        return 0, 2 ** BITS[name] - 1
    bits, signed = INTS[name]
    return (-2 ** (bits - 1), 2 ** (bits - 1) - 1) if signed else (0, 2 ** bits - 1)


def wrap(name, value):
    low, high = limits(name)
    return (value - low) % (high - low + 1) + low


def single(value):
    try:
        return struct.unpack("f", struct.pack("f", value))[0]
    except OverflowError:
        return math.copysign(math.inf, value)


def as_real(name, value):
    try:
        value = float(value)
    except OverflowError:
        value = math.copysign(math.inf, value)
    return single(value) if name == "REAL" else value


def holds(wide, narrow):
    """Every value of the type `narrow` is one of the type `wide`."""
    if wide == narrow:
        return True
    if narrow in REALS:
        return wide in REALS and REALS[wide] >= REALS[narrow]
    low, high = limits(narrow)
    if wide in REALS:
        return narrow in INTS and max(-low, high) <= 2 ** REALS[wide]
    return limits(wide)[0] <= low and high <= limits(wide)[1]


def common(a, b):
    fits = [name for name in (*INTS, *REALS) if holds(name, a) and holds(name, b)]
    whole = [name for name in fits if name in INTS]
    if whole:
        return min(whole, key=lambda name: (INTS[name][0], name not in (a, b)))
    return min(fits, key=REALS.get, default=None)


def convert(name, value):
    return as_real(name, value) if name in REALS else value


def divided(a, b):
    quotient = abs(a) // abs(b)
    return quotient if (a < 0) == (b < 0) else -quotient


def real_divided(a, b):
    if math.isnan(a) or math.isnan(b):
        return math.nan
    if b != 0:
        return a / b if math.isfinite(b) else (math.nan if math.isinf(a) else math.copysign(0.0, a) *
                                               math.copysign(1, b))
    if a == 0:
        return math.nan
    return math.copysign(math.inf, a) * math.copysign(1, b)


class Node:
    """An expression: its text, its type, its value."""

    def __init__(self, text, name, value):
        self.text, self.name, self.value = text, name, value


class Generator:
    def __init__(self, seed):
        self.random = random.Random(seed)
        self.inputs = {}
        self.memory = 0  # bytes AT %M that are taken

    def constant(self, name):
        """A value of a type, preferably one that is special."""
        pick = self.random
        if name == "BOOL":
            return pick.random() < 0.5
        if name in TEXTS:
            return "".join(pick.choice(TEXTS[name]) for _ in range(pick.randrange(0, 9)))
        if name == "TIME":
            return pick.choice([0, 1, -1, 10 ** 6, 1500 * 10 ** 6, pick.randrange(-10 ** 15, 10 ** 15)])
        if name in REALS:
            return as_real(name, pick.choice([0, 1, -1, 0.5, 2.5, 1e30, -1e-3, pick.uniform(-100, 100),
                                              pick.uniform(-1e6, 1e6), pick.randrange(-40000, 40000)]))
        low, high = limits(name)
        return pick.choice([low, high, 0, 1, pick.randrange(low, high + 1), pick.randrange(max(low, -20), min(high, 20)),
                            high - 1, low + 1])

    def literal(self, name, value):
        if name == "BOOL":
            return "TRUE" if value else "FALSE"
        if name == "STRING":
            return "'" + value.replace("$", "$$").replace("'", "$'") + "'"
        if name == "WSTRING":
            return '"' + "".join(f"${ord(c):04X}" if c in '$"' or self.random.random() < 0.1 else c for c in value) + '"'
        if name == "TIME":
            return f"T#{'-' if value < 0 else ''}{abs(value)}ns"
        if name in REALS:
            return f"{name}#{value!r}" if "e" not in repr(value) else f"{name}#{value:.20f}" if abs(value) < 1 \
                else f"{name}#{value:.1f}"
        if name in BITS and self.random.random() < 0.5:
            return f"{name}#16#{value:X}"
        return f"{name}#{value}"

    def leaf(self, name):
        value = self.constant(name)
        if self.random.random() < 0.3:
            return Node(self.literal(name, value), name, value)
        variable = f"v{len(self.inputs)}"
        self.inputs[variable] = (name, self.literal(name, value), *self.declared(name, value))
        return Node(variable, name, value)

    def declared(self, name, value):
        """Where a variable is (" AT %MW4"), and its type, which may be a subrange around its value."""
        if name in INTS and self.random.random() < 0.2:
            return "", self.around(name, value)
        widths = {**BITS, **{word: bits for word, (bits, _) in INTS.items()}, "REAL": 32, "LREAL": 64, "BOOL": 1}
        if name not in widths or self.random.random() > 0.15:
            return "", OF.get(name, name)
        size = max(1, widths[name] // 8)
        at = -(-self.memory // size) * size
        self.memory = at + size
        bit = f".{self.random.randrange(8)}" if name == "BOOL" else ""
        return f" AT %M{ {1: 'X', 8: 'B', 16: 'W', 32: 'D', 64: 'L'}[widths[name]]}{at}{bit}", name

    def around(self, name, value):
        low, high = limits(name)
        high = min(high, 2 ** 63 - 1)
        return f"{name} ({max(low, value - self.random.choice((0, 1, 50)))}..{min(high, value + self.random.choice((0, 3)))})" \
            if value <= high else name

    def of(self, name, depth):
        if depth <= 0 or self.random.random() < 0.1:
            return self.leaf(name)
        if name == "BOOL":
            return self.boolean(depth)
        if name in TEXTS:
            return self.string(name, depth)
        if name == "TIME":
            return self.time(depth)
        if name in BITS:
            return self.bits(name, depth)
        return self.number(name, depth)

    # ---- numbers -------------------------------------------------------------------------------------------------

    def pair(self, name, depth):
        """Two operands whose common type is `name`."""
        narrow = [other for other in (*INTS, *REALS) if holds(name, other) and common(other, name) == name]
        a, b = name, self.random.choice(narrow)
        if self.random.random() < 0.5:
            a, b = b, a
        return self.of(a, depth - 1), self.of(b, depth - 1)

    def arithmetic(self, name, depth):
        a, b = self.pair(name, depth)
        op = self.random.choice(["+", "-", "*", "/"] + (["MOD"] if name in INTS else []))
        x, y = convert(name, a.value), convert(name, b.value)
        if name in REALS:
            try:
                value = {"+": lambda: x + y, "-": lambda: x - y, "*": lambda: x * y, "/": lambda: real_divided(x, y)}[op]()
            except OverflowError:
                return self.leaf(name)
            return Node(f"({a.text} {op} {b.text})", name, as_real(name, value))
        if op == "/" and y == 0:
            return Node(f"({a.text} MOD {b.text})", name, 0)
        value = {"+": lambda: x + y, "-": lambda: x - y, "*": lambda: x * y, "/": lambda: divided(x, y),
                 "MOD": lambda: 0 if y == 0 else x - y * divided(x, y)}[op]()
        return Node(f"({a.text} {op} {b.text})", name, wrap(name, value))

    def function(self, name, depth):
        kind = self.random.choice(["ABS", "MIN", "MAX", "LIMIT", "SEL", "MUX"])
        if kind == "ABS":
            a = self.of(name, depth - 1)
            return Node(f"ABS({a.text})", name, wrap(name, abs(a.value)) if name in INTS else abs(a.value))
        if kind == "SEL":
            g, a, b = self.of("BOOL", depth - 1), self.of(name, depth - 1), self.of(name, depth - 1)
            return Node(f"SEL({g.text}, {a.text}, {b.text})", name, b.value if g.value else a.value)
        values = [self.of(name, depth - 1) for _ in range(3)]
        texts = ", ".join(value.text for value in values)
        if kind == "MUX":
            which = self.random.randrange(3)
            return Node(f"MUX({which}, {texts})", name, values[which].value)
        numbers = [value.value for value in values]
        if any(isinstance(number, float) and math.isnan(number) for number in numbers):
            return self.leaf(name)
        if kind == "LIMIT":
            low, value, high = numbers
            low_or = value if value > low else low
            return Node(f"LIMIT({texts})", name, high if high < low_or else low_or)
        result = numbers[0]
        for number in numbers[1:]:
            if (number < result) if kind == "MIN" else (number > result):
                result = number
        return Node(f"{kind}({texts})", name, result)

    def converted(self, name, depth):
        source = self.random.choice([*INTS, *REALS] + (["BOOL"] if name in INTS else []) + ["TIME"] * (name in INTS))
        a = self.of(source, depth - 1)
        text = f"{source}_TO_{name}({a.text})" if self.random.random() < 0.7 else f"TO_{name}({a.text})"
        value = a.value
        if source == "TIME":
            value = divided(value, 10 ** 6)
        if name in REALS:
            return Node(text, name, as_real(name, value))
        if source in REALS:
            low, high = limits(name)
            value = 0 if math.isnan(value) else high if value >= high else low if value <= low else round(value)
        return Node(text, name, wrap(name, int(value)))

    def number(self, name, depth):
        choice = self.random.random()
        if choice < 0.5:
            return self.arithmetic(name, depth)
        if choice < 0.7:
            return self.function(name, depth)
        if choice < 0.85:
            return self.converted(name, depth)
        if name in INTS and not INTS[name][1]:
            return self.leaf(name)
        a = self.of(name, depth - 1)
        return Node(f"(-{a.text})", name, wrap(name, -a.value) if name in INTS else -a.value)

    # ---- bits, BOOL ----------------------------------------------------------------------------------------------

    def bits(self, name, depth):
        width = BITS[name]
        kind = self.random.choice(["AND", "OR", "XOR", "NOT", "SHL", "SHR", "ROL", "ROR"])
        a = self.of(name, depth - 1)
        if kind == "NOT":
            return Node(f"(NOT {a.text})", name, a.value ^ (2 ** width - 1))
        if kind in ("AND", "OR", "XOR"):
            b = self.of(self.random.choice([other for other in BITS if BITS[other] <= width]), depth - 1)
            value = {"AND": a.value & b.value, "OR": a.value | b.value, "XOR": a.value ^ b.value}[kind]
            return Node(f"({a.text} {kind} {b.text})", name, value)
        n = self.random.randrange(0, width + 3)
        if kind[0] == "S":
            value = a.value << n if kind == "SHL" else a.value >> n
        else:
            turn = n % width if kind == "ROL" else -n % width
            value = a.value << turn | a.value >> (width - turn)
        return Node(f"{kind}({a.text}, {n})", name, value & (2 ** width - 1))

    def boolean(self, depth):
        kind = self.random.choice(["logic", "not", "compare", "compare", "string", "bit"])
        if kind == "not":
            a = self.of("BOOL", depth - 1)
            return Node(f"(NOT {a.text})", "BOOL", not a.value)
        if kind == "logic":
            a, b = self.of("BOOL", depth - 1), self.of("BOOL", depth - 1)
            op = self.random.choice(["AND", "OR", "XOR", "&", "AND_THEN", "OR_ELSE"])
            value = {"A": a.value and b.value, "&": a.value and b.value, "O": a.value or b.value,
                     "X": a.value != b.value}[op[0]]
            return Node(f"({a.text} {op} {b.text})", "BOOL", value)
        if kind == "bit":
            variable = self.leaf(self.random.choice(list(BITS)))
            if not variable.text.startswith("v"):
                return self.leaf("BOOL")
            n = self.random.randrange(BITS[variable.name])
            return Node(f"{variable.text}.{n}", "BOOL", bool(variable.value >> n & 1))
        if kind == "string":
            name = self.random.choice(list(TEXTS))
            a, b = self.of(name, depth - 1), self.of(name, depth - 1)
        else:
            name = self.random.choice([*INTS, *REALS])
            a, b = self.pair(name, depth)
            a.value, b.value = convert(name, a.value), convert(name, b.value)
        op = self.random.choice(["=", "<>", "<", ">", "<=", ">="])
        value = {"=": a.value == b.value, "<>": a.value != b.value, "<": a.value < b.value, ">": a.value > b.value,
                 "<=": a.value <= b.value, ">=": a.value >= b.value}[op]
        return Node(f"({a.text} {op} {b.text})", "BOOL", value)

    # ---- times, texts --------------------------------------------------------------------------------------------

    def time(self, depth):
        a = self.of("TIME", depth - 1)
        op = self.random.choice(["+", "-", "*", "/"])
        if op in "+-":
            b = self.of("TIME", depth - 1)
            value = a.value + b.value if op == "+" else a.value - b.value
        else:
            b = self.of(self.random.choice(["INT", "DINT", "UINT"]), depth - 1)
            if op == "/" and b.value == 0:
                return a
            value = a.value * b.value if op == "*" else divided(a.value, b.value)
        return Node(f"({a.text} {op} {b.text})", "TIME", wrap("LINT", value))

    def string(self, name, depth):
        a, b = self.of(name, depth - 1), self.of(name, depth - 1)
        n, p = self.random.randrange(0, 12), self.random.randrange(0, 12)
        kind = self.random.choice(["CONCAT", "LEFT", "RIGHT", "MID", "INSERT", "DELETE", "REPLACE", "convert"])
        s = a.value
        if len(s) + len(b.value) > 200:
            return self.leaf(name)
        if kind == "convert":
            other = self.of("STRING" if name == "WSTRING" else "WSTRING", depth - 1)
            return Node(f"{other.name}_TO_{name}({other.text})", name, other.value) if other.value.isascii() else a
        if kind == "CONCAT":
            return Node(f"CONCAT({a.text}, {b.text})", name, s + b.value)
        if kind in ("LEFT", "RIGHT"):
            return Node(f"{kind}({a.text}, {n})", name, s[:n] if kind == "LEFT" else s[len(s) - n:] if n < len(s) else s)
        if kind == "MID":
            return Node(f"MID({a.text}, {n}, {p})", name, s[p - 1:p - 1 + n] if p > 0 else "")
        if kind == "INSERT":
            return Node(f"INSERT({a.text}, {b.text}, {p})", name, s[:p] + b.value + s[p:] if p <= len(s) else s)
        inside = 1 <= p <= len(s) + 1
        if kind == "DELETE":
            return Node(f"DELETE({a.text}, {n}, {p})", name, s[:p - 1] + s[p - 1 + n:] if inside else s)
        return Node(f"REPLACE({a.text}, {b.text}, {n}, {p})", name, s[:p - 1] + b.value + s[p - 1 + n:] if inside else s)


OF = {"STRING": "STRING(255)", "WSTRING": "WSTRING(255)"}


def same(name, found, expected):
    if name in TEXTS:
        return found == (expected.encode() if name == "STRING" else expected)
    if name in REALS:
        return found == expected or (math.isnan(found) and math.isnan(expected))
    return found == int(expected)


def unit(generator, number, count):
    """A program of some expressions: its text, and what its results are to be."""
    names = ["BOOL", *TEXTS, "TIME", *INTS, *BITS, *REALS]
    generator.inputs = {}
    nodes = [generator.of(generator.random.choice(names), generator.random.randrange(1, 5)) for _ in range(count)]
    text = f"PROGRAM P{number}\nVAR_OUTPUT\n"
    for i, node in enumerate(nodes):
        ranged = node.name in INTS and generator.random.random() < 0.3
        text += f"r{i} : {generator.around(node.name, node.value) if ranged else OF.get(node.name, node.name)};\n"
    text += "END_VAR\nVAR\n" + "".join(f"{variable}{at} : {declared} := {value};\n" for variable, (_, value, at, declared)
                                       in generator.inputs.items()) + "END_VAR\n"
    return text + "".join(f"r{i} := {node.text};\n" for i, node in enumerate(nodes)) + "END_PROGRAM\n", nodes


def check(binaries, folder, seed, count):
    generator = Generator(seed)
    units = [unit(generator, number, min(PER_UNIT, count - number * PER_UNIT)) for number in range(-(-count // PER_UNIT))]
    host = Host(binaries, folder, "".join(text for text, _ in units), f"random{seed}")
    if not host.run():
        sys.exit(f"seed {seed}: the program was stopped: {host.fault()}, {host.source}")
    for number, (text, nodes) in enumerate(units):
        for i, node in enumerate(nodes):
            found = host.value(f"P{number}.r{i}")
            if not same(node.name, found, node.value):
                sys.exit(f"seed {seed}: {node.name}: {node.text}\nis {found!r}; expected {node.value!r}, in {text}")


def main():
    full = os.environ.get("CM1E_TEST_EFFORT") == "full"
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 4000 if full else 800
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else random.randrange(10 ** 9)
    with tempfile.TemporaryDirectory() as folder:
        for done in range(0, count, PER_PROGRAM):
            check(sys.argv[1], folder, seed + done // PER_PROGRAM, min(PER_PROGRAM, count - done))
    print(f"{count} expressions from seed {seed}")


main()
