"""What `cm1e explain` says of an ErrorID beside its text: when it comes, as docs/FUNCTION-BLOCKS.md has it, and the
blocks whose pages have it."""
import re
import textwrap

ROW = re.compile(r"^\| `0x1E[0-9A-F]{2}` \| `(\w+)` \| [^|]* \| ([^|]*) \|$", re.MULTILINE)
BLOCKS = 6  # an error of more blocks than these is one of nearly all


def plain(markdown):
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", markdown)
    return text.replace("**axis**", "the axis itself").replace("`", "").replace("\\", "\\\\").replace('"', '\\"').strip()


def source(files, classes, function_blocks):
    blocks = {}
    for file in files:
        for block in file.blocks():
            refused = [cell for cell in classes.states_of(block) if cell in classes.errors]
            for error in [error for error, _ in classes.errors_of(block)] + refused:
                names = blocks.setdefault(error, [])
                if block.name not in names:
                    names.append(block.name)
    text = "/* Written by fb/interface/generate.py from docs/FUNCTION-BLOCKS.md and fb/interface: do not edit. */\n"
    for name, when in ROW.findall(function_blocks):
        names = blocks.get(name.removeprefix("ERROR_"), [])
        shown = " ".join(names) if len(names) <= BLOCKS else "*"
        lines = textwrap.wrap(plain(when), 100, drop_whitespace=False) or [""]
        quoted = "\n           ".join(f'"{line}"' for line in lines)
        text += f'ERROR_NOTE({name},\n           {quoted},\n           "{shown}")\n'
    return text
