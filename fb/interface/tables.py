"""Reads the tables in fb/interface/classes.md and the list of errors in include/cm1e/error.h."""
import re

from st import Fault

STATES = ("Disabled", "Standstill", "Homing", "DiscreteMotion", "ContinuousMotion", "SynchronizedMotion", "Stopping",
          "ErrorStop")
ERROR_ID_BASE = 0x1E00


def rows(text, heading):
    """The rows of the table below a heading, without its head."""
    part = re.search(rf"^## {heading}\n(.*?)(?=^## |\Z)", text, re.DOTALL | re.MULTILINE)
    if not part:
        raise Fault(f"fb/interface/classes.md: there is no heading {heading}")
    lines = [line for line in part.group(1).splitlines() if line.startswith("|")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[2:]]


def notes(text, names):
    """[({names of blocks}, text)] of fb/interface/notes.md: what is said below a heading that names blocks."""
    result = []
    for part in re.split(r"^## ", text, flags=re.MULTILINE)[1:]:
        heading, _, body = part.partition("\n")
        blocks = {name.strip() for name in heading.split(",")}
        if not blocks <= names:
            raise Fault(f"fb/interface/notes.md: {heading}: {', '.join(blocks - names)} is no block")
        result.append((blocks, body.strip()))
    return result


class Tables:
    def __init__(self, classes, errors):
        self.errors = {name.removeprefix("ERROR_"): (ERROR_ID_BASE - int(value), text) for name, value, text in
                       re.findall(r'X\((\w+), (-?\d+), "([^"]*)"\)', errors)}
        self.states = {name: cells for name, *cells in rows(classes, "In which state")}
        self.groups = {}
        for group, error, when in rows(classes, "Errors"):
            self.groups.setdefault(group, []).append((error, when))
        self.meanings = dict(rows(classes, "Inputs and outputs with the same meaning in all blocks"))
        for where, name in [(f"state class {name}", cell) for name, cells in self.states.items() for cell in cells
                            if cell != "-" and cell not in STATES] + \
                           [(f"group {group}", error) for group, list_ in self.groups.items() for error, _ in list_]:
            if name not in self.errors:
                raise Fault(f"fb/interface/classes.md: {where}: {name} is neither a state nor an error")
        for name, cells in self.states.items():
            if len(cells) != len(STATES):
                raise Fault(f"fb/interface/classes.md: state class {name} has {len(cells)} states")

    def states_of(self, block):
        """One cell per state; none for a block that knows no axis."""
        name = " ".join(block.tags.get("states", []))
        if name and name not in self.states:
            raise Fault(f"{block.name}: there is no state class {name}")
        return self.states.get(name, [])

    def errors_of(self, block):
        """[(error, when)] of a block, without refusals by state."""
        result = []
        for group in " ".join(block.tags.get("errors", [])).split():
            if group not in self.groups:
                raise Fault(f"{block.name}: there is no group of errors {group}")
            result += self.groups[group]
        for line in block.tags.get("error", []):
            error, _, when = line.partition(" ")
            if error not in self.errors:
                raise Fault(f"{block.name}: there is no error {error}")
            result.append((error, when))
        return result
