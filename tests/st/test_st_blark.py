#!/usr/bin/env python3
"""Every source in Structured Text of the tree, and the examples of docs/STRUCTURED-TEXT.md, are read by blark too, a
parser that we did not write. It knows TwinCAT's dialect, in which a configuration is no text, REF_TO is POINTER TO, and
METHOD is reserved and stands beside its block: these differences are taken out first. NAMESPACE, USING and CLASS of the
3rd edition are unknown to it (and to TwinCAT): it reads what is within a namespace, and a CLASS as a FUNCTION_BLOCK.

test_st_blark.py SOURCE-DIRECTORY VENV-PYTHON
"""
import glob
import os
import random
import re
import subprocess
import sys
import tempfile

SOURCE, PYTHON = sys.argv[1], sys.argv[2]
SKIPPED = 77


def sources():
    """[(name, text)]"""
    result = []
    for path in sorted(glob.glob(os.path.join(SOURCE, "**", "*.st"), recursive=True)):
        if "/build" not in path[len(SOURCE):] and "/.deps" not in path[len(SOURCE):]:
            with open(path, encoding="utf-8") as file:
                result.append((os.path.relpath(path, SOURCE), file.read()))
    with open(os.path.join(SOURCE, "docs", "STRUCTURED-TEXT.md"), encoding="utf-8") as file:
        for number, text in enumerate(re.findall(r"```iecst\n(.*?)```", file.read(), re.DOTALL)):
            result.append((f"STRUCTURED-TEXT.md, example {number + 1}", text))
    return result


def without_parts(match):
    """TwinCAT has methods, properties and actions beside their block, not within it."""
    parts = re.compile(r"\b(METHOD|PROPERTY|ACTION)\b.*?\bEND_\1\b", re.DOTALL)
    text = match.group(0)
    return parts.sub("", text) + "\n" + "\n".join(part.group(0) for part in parts.finditer(text))


def adapted(text):
    for name in re.findall(r"\bNAMESPACE\s+([\w.]+)", text):
        text = text.replace(name + ".", "")
    text = re.sub(r"\bNAMESPACE\s+[\w.]+|\bEND_NAMESPACE\b|\bUSING\s[^;]*;", "", text)
    text = re.sub(r"\b(END_)?CLASS\b", r"\1FUNCTION_BLOCK", text)
    text = re.sub(r"\b(INTERFACE|FUNCTION_BLOCK|PROGRAM)\b.*?\bEND_\1\b", without_parts, text, flags=re.DOTALL)
    text = re.sub(r"\bCONFIGURATION\b.*?\bEND_CONFIGURATION\b", "", text, flags=re.DOTALL)
    return re.sub(r"\b(method|reference)\b", r"\1_", text.replace("REF_TO", "POINTER TO"))


def parse(folder, texts):
    """What blark says of all texts, in one file because it begins slowly; "" for nothing."""
    path = os.path.join(folder, "source.st")
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(adapted(text) for text in texts))
    result = subprocess.run([PYTHON, "-m", "blark", "parse", path], capture_output=True, text=True, timeout=300)
    return "" if result.returncode == 0 else result.stdout[-300:] + result.stderr[-600:]


if not os.path.exists(PYTHON) or subprocess.run([PYTHON, "-c", "import blark"], stderr=subprocess.DEVNULL).returncode:
    print("SKIPPED: st_blark: there is no blark here; scripts/install-dependencies --tests installs it")
    sys.exit(SKIPPED)
with tempfile.TemporaryDirectory() as folder:
    if not parse(folder, ["PROGRAM P VAR x : ; END_VAR x := ; END_PROGRAM"]):
        sys.exit("blark reads a program that is none")
    chosen = sources()
    if os.environ.get("CM1E_TEST_EFFORT") != "full": # blark takes 14 s for all
        interface = [source for source in chosen if source[0].startswith("fb")]
        chosen = [source for source in chosen if source not in interface] + [random.choice(interface)]
    complaint = parse(folder, [text for _, text in chosen])
    if complaint:
        sys.exit(f"{complaint}\nof {', '.join(name for name, _ in chosen)}")
print(", ".join(name for name, _ in chosen))
