#!/usr/bin/env python3
"""The code has one form where C allows several: a result of type cm1e_error_t is compared with CM1E_OK or with another
error, and is never taken for a truth value. A comment about a C bool has true and false; TRUE and FALSE are values of
PLCopen inputs. No two files in different rooms have one name. No source, header or test is longer than 700 lines, and
no line of a source or header of the library is wider than 120 columns. No Python source has a function twice, of which
the first would never run.

test_code.py SOURCE-DIRECTORY
"""
import ast
import glob
import os
import re
import sys

SOURCE = sys.argv[1]
FOLDERS = ("include", "src", "fb", "tools", "examples", "bench", "tests", "bindings")
TYPE = "cm1e_error_t"
TOKEN = re.compile(r"[A-Za-z_]\w*|0[xX]\w+|\d[\w.]*|->|&&|\|\||[=!<>]=|\S")
NAME = re.compile(r"[A-Za-z_]\w*\Z")
# A type, a name, and further names after commas; it ends before ";", ",", ")" or an initial value.
DECLARATION = re.compile(r"(?<![\w.>])(?:struct )?([A-Za-z_]\w*)(?: const)?[ \n]+\**(?:const )?(\w+)"
                         r"((?:\[[^\]]*\])*(?:(?: = [^;{}(),]*)?,\s\**\w+(?:\[[^\]]*\])*)*)(?=[;,)]|\s=\s)")
COMPARED = ("==", "!=", "<", ">", "<=", ">=")
faults = []


def read(path):
    with open(os.path.join(SOURCE, path), encoding="utf-8") as file:
        return file.read()


def files():
    return sorted(os.path.relpath(path, SOURCE) for folder in FOLDERS
                  for path in glob.glob(os.path.join(SOURCE, folder, "**/*.[ch]"), recursive=True))


def blank(match):
    return re.sub(r"[^\n]", " ", match.group())


def code(text):
    """The same lines without comments, strings and characters."""
    text = re.sub(r"/\*.*?\*/|//[^\n]*", blank, text, flags=re.DOTALL)
    return re.sub(r'"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', blank, text)


# ---- the form of an error test --------------------------------------------------------------------------------------

def declarations(text):
    """{name: type} of everything that looks like a declaration: parameters, variables, members."""
    found = {}
    for kind, first, others in DECLARATION.findall(text):
        if kind not in ("return", "goto", "typedef", "enum", "struct", "else", "case", "sizeof"):
            for name in [first, *re.findall(r",\s\**(\w+)", others)]:
                found[name] = kind
    return found


def structs(texts):
    """{type: {member: type}}."""
    found = {}
    for text in texts.values():
        for name, body, alias in re.findall(r"\bstruct (\w+) \{\n(.*?)\n\}(?: (\w+))?;", text, re.DOTALL):
            found[alias or f"{name}_t"] = found[name] = declarations(body)
    return found


def functions(text):
    """{name: type it returns}."""
    return {name: kind for kind, name in re.findall(r"^(?:CM1E_API |static |inline |extern )*(\w+) \**(\w+)\(", text,
                                                    re.MULTILINE)}


def bodies(text):
    """(begin, text) of every function with its head."""
    for match in re.finditer(r"^[A-Za-z_][^;{}#]*\)\s*(?:\{[^\n]*\}$|\{\n.*?^\})", text, re.MULTILINE | re.DOTALL):
        yield match.start(), match.group()


def operand(tokens, place):
    """The end of the chain of members, indices and calls that begins at a place, and its names; None at a call."""
    names = [tokens[place].group()]
    place += 1
    while place < len(tokens):
        token = tokens[place].group()
        if token in ("->", "."):
            names.append(tokens[place + 1].group())
            place += 2
        elif token in "([":
            depth = 0
            while place < len(tokens):
                depth += (tokens[place].group() in "([") - (tokens[place].group() in ")]")
                place += 1
                if depth == 0:
                    break
            if token == "(":
                names.append(None)
        else:
            break
    return place, names


def is_error(names, variables, members, results):
    if names[-1] is None:
        return len(names) == 2 and results.get(names[0]) == TYPE
    kind = variables.get(names[0])
    for name in names[1:]:
        kind = members.get(kind, {}).get(name)
    return kind == TYPE


def truth_values(tokens, variables, members, results):
    """(begin, end, whether it is negated) of every error that stands for a truth value."""
    place = 0
    while place < len(tokens):
        before = tokens[place - 1].group() if place else ""
        if not NAME.match(tokens[place].group()) or before in ("->", "."):
            place += 1
            continue
        end, names = operand(tokens, place)
        after = tokens[end].group() if end < len(tokens) else ""
        asked = before == "(" and after == ")" and tokens[place - 2].group() in ("if", "while")
        joined = before in ("&&", "||") and after in (")", ";", "&&", "||", "?", ":", ",")
        leads = before not in COMPARED and after in ("&&", "||", "?")
        zero = after in ("==", "!=") and tokens[end + 1].group() == "0"
        if before == "!" or asked or joined or leads or zero:
            if is_error(names, variables, members, results):
                yield tokens[place - (before == "!")].start(), tokens[end - 1].end(), before == "!"
        place = end if names[-1] is not None else place + 1


def pointers(body):
    """Names of pointers to an error."""
    return set(re.findall(TYPE + r" \*(?:const )?(\w+)[,);]", body))


def check_error_tests(texts):
    members, everywhere = structs(texts), {}
    for path, text in texts.items():
        if path.endswith(".h"):
            everywhere.update(functions(text))
    found = []
    for path, text in texts.items():
        results = {**everywhere, **functions(text)}
        for begin, body in bodies(text):
            variables, tokens = declarations(body), list(TOKEN.finditer(body))
            for name in pointers(body):
                variables[name] = TYPE + " *"
            for first, last, negated in truth_values(tokens, variables, members, results):
                words = re.sub(r"\s+", " ", body[first:last])
                line = text.count("\n", 0, begin + first) + 1
                found.append(f"{path}:{line}: \"{words}\" is an error, not a truth value: write \"{words.lstrip('!')} "
                             f"{'==' if negated else '!='} CM1E_OK\"")
    return found


def check_pointers(texts):
    """A pointer to an error is there or not; it is no error itself."""
    found = []
    for path, text in texts.items():
        for begin, body in bodies(text):
            for name in pointers(body):
                for match in re.finditer(r"(?<![\w.*>])" + name + r" [!=]= CM1E_\w+", body):
                    line = text.count("\n", 0, begin + match.start()) + 1
                    found.append(f"{path}:{line}: \"{name}\" is a pointer, not an error: write \"if ({name})\"")
    return found


# What the check must find, and what it must leave alone.
WRONG = ("if (error)", "return !error;", "if (on && fault->error)", "return first(on) ? 1 : 0;", "while (error == 0)")
RIGHT = ("if (error == CM1E_OK)", "if (on)", "return on && error != CM1E_OK;", "if (shown->error)", "return error;")
SAMPLE = """cm1e_error_t first(bool on);
typedef struct fault {
    cm1e_error_t error;
} fault_t;
typedef struct shown {
    bool error;
} shown_t;
int sample(bool on, const fault_t *fault, const shown_t *shown, cm1e_error_t error)
{
    %s
}
"""


def check_itself():
    for statement in WRONG + RIGHT:
        found = check_error_tests({"sample.h": SAMPLE % statement})
        if len(found) != (statement in WRONG):
            faults.append(f"tests/style/test_code.py judges \"{statement}\" wrongly: {found}")
    pointer = "void sample(cm1e_error_t *error)\n{\n    if (%s)\n        *error = CM1E_OK;\n}\n"
    if len(check_pointers({"a.c": pointer % "error != CM1E_OK"})) != 1 or check_pointers({"a.c": pointer % "error"}):
        faults.append("tests/style/test_code.py judges pointers to errors wrongly")


# ---- true and TRUE --------------------------------------------------------------------------------------------------

# What TRUE and FALSE are said of: inputs and outputs of blocks, and an argument of SOEM's core.
BLOCK_WORDS = re.compile(r"\b(Execute|Enable|Status|Busy|Valid|Done|ecx_setupnic)\b")


def check_truth(path):
    """Of a comment in the sources that have no function blocks."""
    text = read(path)
    for comment in re.finditer(r"/\*.*?\*/", text, re.DOTALL):
        found = re.search(r"\b(TRUE|FALSE)\b", comment.group())
        if found and not BLOCK_WORDS.search(comment.group()):
            line = text.count("\n", 0, comment.start() + found.start()) + 1
            faults.append(f"{path}:{line}: {found.group()} is a value of an input of a block; a C bool is "
                          f"{found.group().lower()}")


# ---- names of files -------------------------------------------------------------------------------------------------

# Names that may be in several folders, and why.
ANY_ROOM = {
    "CMakeLists.txt": "CMake looks for it",
    "Makefile": "make looks for it",
    "README.md": "GitHub and every reader look for it",
    "requirements.txt": "pip and its users look for it",
    "main.c": "the source of each project that `cm1e new` makes",
}


def check_names():
    folders = {}
    for folder in FOLDERS:
        for parent, _, names in os.walk(os.path.join(SOURCE, folder)):
            if "__pycache__" not in parent:
                for name in set(names) - ANY_ROOM.keys():
                    folders.setdefault(name, []).append(os.path.relpath(parent, SOURCE))
    for name, rooms in sorted(folders.items()):
        if len(rooms) > 1:
            faults.append(f"{name} is in {', '.join(sorted(rooms))}: give all but one a name of their own")


# ---- length of files ------------------------------------------------------------------------------------------------

LONGEST = 700
LANGUAGES = (".c", ".h", ".inc", ".l", ".y", ".py", ".js", ".st")
# Files that may be longer, and why.
LONG = {"tests/support/block_table.c": "fb/interface/generate.py writes it"}


def check_length():
    for folder in FOLDERS:
        for parent, _, names in os.walk(os.path.join(SOURCE, folder)):
            for path in (os.path.relpath(os.path.join(parent, name), SOURCE) for name in names):
                lines = read(path).count("\n") if path.endswith(LANGUAGES) and path not in LONG else 0
                if lines > LONGEST:
                    faults.append(f"{path} has {lines} lines, {LONGEST} may be: split it by what it is for")


# ---- width of lines -------------------------------------------------------------------------------------------------

WIDEST = 120
LIBRARY = ("include/", "src/", "fb/")


def check_width():
    for path in files():
        if path.startswith(LIBRARY):
            for number, line in enumerate(read(path).split("\n"), 1):
                if len(line) > WIDEST:
                    faults.append(f"{path}:{number}: {len(line)} columns, {WIDEST} may be: break the line")


# ---- functions of Python -------------------------------------------------------------------------------------------


def check_twice(path, body):
    seen = set()
    for one in body:
        if isinstance(one, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
            if one.name in seen and not one.decorator_list:
                faults.append(f"{path}:{one.lineno}: {one.name} is there twice, and the first one never runs")
            seen.add(one.name)
            check_twice(path, one.body)


def check_python():
    for folder in FOLDERS:
        for path in glob.glob(os.path.join(SOURCE, folder, "**/*.py"), recursive=True):
            path = os.path.relpath(path, SOURCE)
            check_twice(path, ast.parse(read(path)).body)


for path in files():
    if path.startswith(("src/", "tools/")):
        check_truth(path)
check_names()
check_length()
check_width()
check_python()
check_itself()
sources = {path: code(read(path)) for path in files()}
faults += check_error_tests(sources) + check_pointers(sources)
print("\n".join(faults) if faults else "code: fine")
sys.exit(1 if faults else 0)
