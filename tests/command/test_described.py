#!/usr/bin/env python3
"""What the command says of itself: every option of `--help` is in the man page and in the completions, which a real bash
completes with the tabulator; unknown commands, options and words are refused with what may have been meant.

test_described.py BUILD-DIRECTORY SOURCE-DIRECTORY
"""
import os
import pty
import re
import select
import shutil
import subprocess
import sys
import tempfile
import time

BUILD = os.path.abspath(sys.argv[1])
SOURCE = sys.argv[2]
BIN, DESCRIBED = os.path.join(BUILD, "bin"), os.path.join(BUILD, "described")
BASH = os.path.join(DESCRIBED, "cm1e.bash")
FAILED, WRONG_USE = 1, 2
OPTION = re.compile(r"^\s+(?:-(\S), )?--([\w-]+)|^\s+-(\S)[ ,]", re.MULTILINE)
faults = []


def run(*words):
    return subprocess.run([os.path.join(BIN, "cm1e"), *words], capture_output=True, text=True, timeout=60)


def expect(condition, what, told=""):
    if not condition:
        faults.append(f"{what}\n{told}")


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def commands():
    usage = run("--help").stdout
    names = re.findall(r"^  ([a-z]\w*) +\w", usage, re.MULTILINE)
    expect(len(names) > 10 and "scan" in names, "the list of commands cannot be read", usage)
    return names


def options(command):
    """[(letter, name)] of --help"""
    found = [(short or alone, long) for short, long, alone in OPTION.findall(run(command, "--help").stdout)]
    expect(found, f"cm1e {command} --help shows no options")
    return found


def complete(*words):
    """What bash completes the last word to."""
    line = " ".join(f"'{word}'" for word in words)
    script = f"source {BASH}; COMP_WORDS=({line}); COMP_CWORD={len(words) - 1}; _cm1e; printf '%s\\n' \"${{COMPREPLY[@]}}\""
    return subprocess.run(["bash", "--norc", "-c", script], capture_output=True, text=True, timeout=60).stdout.split()


def man_text(path):
    shown = subprocess.run(["groff", "-man", "-ww", "-Tascii", "-P-cbou", "-rLL=200n", path], capture_output=True,
                           text=True, timeout=60)
    expect(shown.returncode == 0 and not shown.stderr, f"{path} is no good roff", shown.stderr)
    return re.sub(r"\s+", " ", shown.stdout)


def check_options(names):
    total = 0
    statuses = re.findall(r"^  (\d)  (.*)$", run("--help").stdout, re.MULTILINE)
    expect(len(statuses) == 3, "the exit statuses in --help")
    page = read(os.path.join(SOURCE, "docs/COMMAND.md"))
    expect(re.findall(r"^\| (\d) \| (.*) \|$", page, re.MULTILINE) == statuses, "docs/COMMAND.md: the exit statuses")
    zsh = read(os.path.join(DESCRIBED, "_cm1e"))
    for name in names:
        page = os.path.join(DESCRIBED, "man1", f"cm1e-{name}.1")
        roff = re.sub(r"\\(?:f.|&)", "", read(page)).replace("\\-", "-")
        words = complete("cm1e", name, "-")
        of_zsh = zsh.partition(f"\n    {name})\n")[2].partition(";;")[0]
        for letter, long in options(name):
            total += 1
            for form in [f"--{long}"] * bool(long) + [f"-{letter}"] * bool(letter and letter != "?"):
                expect(re.search(rf"(?<![\w-]){re.escape(form)}(?![\w-])", roff), f"{page} lacks {form}")
                expect(form in words or form + "=" in words, f"bash does not complete {name} {form}", str(words))
                expect(re.search(rf"'\*?{re.escape(form)}[=+\[]", of_zsh), f"zsh does not complete {name} {form}")
        if shutil.which("groff"):
            text = man_text(page)
            help_text = re.sub(r"\s+", " ", run(name, "--help").stdout)
            first = help_text.partition("] ")[2][:20]
            expect(first.strip() in help_text and name in text, f"{page}: its text", text[:200])
            for status, meaning in statuses:
                expect(f"{status} {meaning}" in text, f"{page}: exit status {status}", text[-400:])
    top = read(os.path.join(DESCRIBED, "man1", "cm1e.1"))
    for name in names:
        expect(f"cm1e\\-{name}" in top, f"cm1e.1 lacks {name}")
    if shutil.which("zsh"):
        told = subprocess.run(["zsh", "-n", os.path.join(DESCRIBED, "_cm1e")], capture_output=True, text=True)
        expect(told.returncode == 0, "the completion of zsh cannot be read", told.stderr)
    return total


def check_words(names):
    expect(set(names) <= set(complete("cm1e", "")), "commands")
    for words, wanted in ((("sdo", ""), {"read", "write", "list"}), (("generate", "e"), {"esi", "ec-extend", "eni"}),
                          (("sim", "--bridge", "="), {"eb01", "eb02", "eb12"}),
                          (("sim", "--bridge", "=", "eb0"), {"eb01", "eb02"}), (("scan", "-i", "si"), {"sim"}),
                          (("sdo", "--type", "=", "US"), {"USINT"}), (("scan", "--interface", "=", "l"), {"lo"}),
                          (("move", "-v", ""), set()), (("nonsense", "-"), set())):
        expect(set(complete("cm1e", *words)) == wanted, f"completion of cm1e {words}", str(complete("cm1e", *words)))


def typed(keys, wanted, folder):
    """What a person sees who types these keys in bash."""
    pid, terminal = pty.fork()
    if pid == 0:
        os.chdir(folder)
        os.environ.update(PS1="$ ", TERM="dumb", PATH=BIN + ":" + os.environ["PATH"], INPUTRC="/dev/null")
        os.execvp("bash", ["bash", "--norc", "--noprofile", "-i"])
    seen = ""

    def until(text, seconds=10):
        nonlocal seen
        end = time.monotonic() + seconds
        while text not in seen and time.monotonic() < end:
            if select.select([terminal], [], [], 0.1)[0]:
                try:
                    seen += os.read(terminal, 4096).decode(errors="replace")
                except OSError:
                    break
        return text in seen
    os.write(terminal, f"source {BASH}; echo rea''dy\n".encode())
    until("ready\r\n$ ")
    time.sleep(0.2)  # readline sets the terminal after its prompt
    seen = ""
    os.write(terminal, keys.encode())
    expect(until(wanted), f"bash shows no \"{wanted}\" after {keys!r}", seen)
    os.close(terminal)
    os.waitpid(pid, 0)


def check_in_a_terminal():
    with tempfile.TemporaryDirectory() as folder:
        for name in ("net.yaml", "other.txt"):
            with open(os.path.join(folder, name), "w", encoding="utf-8"):
                pass
        typed("cm1e exp\t", "cm1e explain ", folder)
        typed("cm1e move --velo\t", "--velocity=", folder)
        typed("cm1e generate --layout=m\t", "--layout=mdp", folder)
        typed("cm1e scan -b n\t", "-b net.yaml", folder)
        typed("cm1e s\t\t", "status", folder)


def check_meant():
    for words, told in ((["sacn"], '"scan"'), (["stat"], '"status"'), (["genrate", "esi"], '"generate"'),
                        (["scan", "--interfce", "sim"], '"--interface"'), (["move", "-i", "sim", "--velcity=3"],
                                                                           '"--velocity"'),
                        (["scan", "-i", "sim", "--jsno"], '"--json"'), (["scan", "--hlep"], '"--help"'),
                        (["sim", "-i", "x", "--bridge", "eb21"], '"eb01"'), (["sim", "-i", "x", "-o", "ug-4.2"],
                                                                           '"ug-4.4"'),
                        (["generate", "esi", "-o", "-", "--mapping", "cps"], '"csp"'),
                        (["generate", "eis", "-o", "-"], '"esi"'), (["sdo", "-i", "sim", "raed", "1", "2"], '"read"'),
                        (["sdo", "-i", "sim", "write", "1", "0x6060", "1", "--type", "UINTT"], '"UINT"'),
                        (["sii", "-i", "sim", "decod", "1"], '"decode"')):
        result = run(*words)
        expect(result.returncode == WRONG_USE and f"did you mean {told}?" in result.stderr and not result.stdout,
               f"cm1e {words}: {told}", f"{result.returncode} {result.stderr}")
    for words in (["zzz"], ["scan", "--zzzzz"]):
        result = run(*words)
        expect(result.returncode == WRONG_USE and "did you mean" not in result.stderr, f"cm1e {words}", result.stderr)
    # What begins like an option may be the value of one, or stand behind "--".
    expect(run("scan", "--pcap", "--jsno", "-i", "sim").returncode == 0, "a value that begins with --")
    os.path.exists("--jsno") and os.unlink("--jsno")
    expect(run("scan", "--interf", "sim").returncode == 0 and run("scan", "--interf=sim").returncode == 0, "short forms")
    check_meant_in_a_bus_file()


def check_meant_in_a_bus_file():
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "bus.yaml")
        for text, told in (("bus: {intreface: sim}\naxes: [{name: a}]", '"interface"'),
                           ("bus: {interface: sim}\naxis: [{name: a}]", '"axes"'),
                           ("bus: {interface: sim}\naxes: [{nmae: a}]", '"name"'),
                           ("bus: {interface: sim}\naxes: [{name: a, limits: {velcity: 3}}]", '"velocity"'),
                           ("bus: {interface: sim}\naxes: [{name: a, mapping: cps}]", '"csp"')):
            with open(path, "w", encoding="utf-8") as file:
                file.write(text + "\n")
            result = run("scan", "-b", path)
            expect(result.returncode == WRONG_USE and f"did you mean {told}?" in result.stderr, text, result.stderr)
        with open(path, "w", encoding="utf-8") as file:
            file.write("bus: {interface: sim, virtual_time: true}\naxes: [{name: lift}, {name: turn}]\n")
        result = run("move", "-b", path, "lfit", "--by", "1")
        expect(result.returncode == WRONG_USE and 'did you mean "lift"?' in result.stderr, "an axis", result.stderr)


def main():
    names = commands()
    total = check_options(names)
    check_words(names)
    check_in_a_terminal()
    check_meant()
    print("\n".join(faults) or f"{total} options of {len(names)} commands are in --help, man pages and completions")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
