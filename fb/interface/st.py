"""Reads the ST declarations of fb/interface/*.st. What they may contain, and what the comments mean, is told in
fb/interface/README.md; anything else is an error that names file and line."""
import re
from dataclasses import dataclass, field

ELEMENTARY = {"BOOL": 1, "SINT": 1, "INT": 2, "UINT": 2, "DINT": 4, "UDINT": 4, "WORD": 2,
              "DWORD": 4, "LREAL": 8, "TIME": 8, "STRING(80)": 81}
VARIABLE = re.compile(r"(\w+)\s*:\s*(REF_TO\s+\w+|ARRAY\s*\[1\.\.\w+\]\s*OF\s+\w+|STRING\(80\)|\w+)\s*(?::=\s*([^;]+?)\s*)?;"
                      r"\s*(?://\s*(.*))?$")
ENUMERATOR = re.compile(r"(\w+)\s*:=\s*(\d+)\s*,?\s*(?://\s*(.*))?$")
COMMENT = re.compile(r"(\(const\))?\s*(?:\[([^\]]*)\])?\s*(?:\{([^}]*)\})?\s*(.*)$")
KEYWORDS = {"PRIVATE", "PUBLIC", "INTERNAL", "PROTECTED", "AT", "BY", "DO", "OF", "TO", "ON"}
SECTIONS = {"VAR_IN_OUT": "in_out", "VAR_INPUT": "input", "VAR_OUTPUT": "output", "VAR": "private"}


class Fault(Exception):
    pass


@dataclass
class Variable:
    name: str
    type: str
    section: str = ""
    default: str = ""
    unit: str = ""
    range: str = ""
    text: str = ""
    const: bool = False
    reference: bool = False
    length: str = ""  # of an array, "" for none


@dataclass
class Declaration:
    kind: str  # "enum", "alias", "struct", "constants", "block"
    name: str
    doc: str
    tags: dict
    variables: list = field(default_factory=list)
    base: str = ""


@dataclass
class File:
    path: str
    header: str = ""
    title: str = ""
    text: str = ""
    includes: list = field(default_factory=list)
    symbol: str = ""
    declarations: list = field(default_factory=list)

    def blocks(self):
        return [declaration for declaration in self.declarations if declaration.kind == "block"]


def split_tags(comment):
    """("text", {"clause": ["..."], ...}); a tag goes on over lines that begin with white space."""
    text, tags, last = [], {}, None
    for line in comment.splitlines():
        tag = re.match(r"\s*@(\w+)\s*(.*)", line)
        if tag:
            last = tag.group(1)
            tags.setdefault(last, []).append(tag.group(2).strip())
        elif last and line.startswith(" "):
            tags[last][-1] += " " + line.strip()
        else:
            last = None
            text.append(line.strip())
    return "\n".join(text).strip(), {name: [value.strip() for value in values] for name, values in tags.items()}


def variable(line, section, where):
    match = VARIABLE.match(line)
    if not match:
        raise Fault(f"{where}: not a declaration: {line}")
    name, kind, default, comment = match.groups()
    const, unit, limits, text = COMMENT.match(comment or "").groups()
    result = Variable(name, kind, section, default or "", unit or "", limits or "", text.strip(), bool(const))
    array = re.match(r"ARRAY\s*\[1\.\.(\w+)\]\s*OF\s+(\w+)", kind)
    if array:
        result.length, result.type = array.groups()
    elif kind.startswith("REF_TO"):
        result.reference, result.type = True, kind.split()[1]
    return result


class Reader:
    def __init__(self, path, text):
        self.path, self.lines, self.at = path, text.splitlines(), 0

    def where(self):
        return f"{self.path}:{self.at}"

    def next(self):
        """The next line that is not empty, None at the end."""
        while self.at < len(self.lines):
            line = self.lines[self.at].strip()
            self.at += 1
            if line:
                return line
        return None

    def comment(self, line):
        """A comment that begins with this line, without its marks."""
        raw = [self.lines[self.at - 1]]
        while "*)" not in raw[-1]:
            if self.at >= len(self.lines):
                raise Fault(f"{self.where()}: a comment has no end")
            raw.append(self.lines[self.at])
            self.at += 1
        text = "\n".join(raw)
        return text[text.index("(*") + 2: text.index("*)")].lstrip("*")

    def declaration(self, line, doc, tags):
        match = re.match(r"TYPE (\w+) : (\(|STRUCT|(\w+);)", line)
        if match and match.group(3):
            self.expect("END_TYPE")
            return Declaration("alias", match.group(1), doc, tags, base=match.group(3))
        if match and match.group(2) == "(":
            return Declaration("enum", match.group(1), doc, tags, self.enumerators())
        if match:
            result = Declaration("struct", match.group(1), doc, tags, self.variables("", "END_STRUCT;"))
            self.expect("END_TYPE")
            return result
        if line == "VAR_GLOBAL CONSTANT":
            return Declaration("constants", "", doc, tags, self.variables("", "END_VAR"))
        match = re.match(r"FUNCTION_BLOCK (\w+)$", line)
        if match:
            return Declaration("block", match.group(1), doc, tags, self.sections())
        raise Fault(f"{self.where()}: neither a type nor a function block: {line}")

    def expect(self, wanted):
        line = self.next()
        if line != wanted:
            raise Fault(f"{self.where()}: {wanted} is missing: {line}")

    def enumerators(self):
        result = []
        while (line := self.next()) != ");":
            match = ENUMERATOR.match(line or "")
            if not match:
                raise Fault(f"{self.where()}: not an enumerator: {line}")
            result.append(Variable(match.group(1), "", default=match.group(2), text=match.group(3) or ""))
        self.expect("END_TYPE")
        return result

    def variables(self, section, end):
        result = []
        while (line := self.next()) != end:
            if line is None:
                raise Fault(f"{self.where()}: {end} is missing")
            result.append(variable(line, section, self.where()))
            if result[-1].name.upper() in KEYWORDS:
                raise Fault(f"{self.where()}: {result[-1].name} is a keyword of IEC 61131-3")
        return result

    def sections(self):
        result = []
        while (line := self.next()) != "END_FUNCTION_BLOCK":
            if line not in SECTIONS:
                raise Fault(f"{self.where()}: not a section of variables: {line}")
            result += self.variables(SECTIONS[line], "END_VAR")
        return result

    def read(self):
        line = self.next()
        if not line or not line.startswith("(*"):
            raise Fault(f"{self.path}:1: the file begins with a comment that names its header")
        text, tags = split_tags(self.comment(line))
        file = File(self.path, *(" ".join(tags.get(name, [""])) for name in ("header", "title")), text,
                    " ".join(tags.get("include", [])).split(), " ".join(tags.get("symbol", [])))
        doc, tags = "", {}
        while (line := self.next()) is not None:
            if line.startswith("(*"):
                doc, tags = split_tags(self.comment(line))
                continue
            file.declarations.append(self.declaration(line, doc, tags))
            doc, tags = "", {}
        return file

