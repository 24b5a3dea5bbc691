#!/usr/bin/env python3
"""The completion of zsh, as a person meets it: keys typed into a real zsh. Skips where there is no zsh.

test_zsh.py BUILD-DIRECTORY
"""
import os
import pty
import select
import shutil
import subprocess
import sys
import tempfile
import time

BUILD = os.path.abspath(sys.argv[1])
BIN, DESCRIBED = os.path.join(BUILD, "bin"), os.path.join(BUILD, "described")
SKIPPED, CLEAR = 77, b"\x15"  # Ctrl-U takes the line away
# No configuration of the machine; no menu, and no question before a long list.
SET_UP = f"PS1='%% '; fpath=({DESCRIBED} $fpath); autoload -Uz compinit; compinit -u -D; setopt nobeep noautomenu; " \
         "LISTMAX=1000; stty cols 200 rows 50; print rea''dy\n"
TYPED = (
    ("cm1e exp\t", "cm1e explain "), ("cm1e sta\t", "cm1e stat"), ("cm1e log --fo\t", "cm1e log --follow "),
    ("cm1e move --velo\t", "cm1e move --velocity="), ("cm1e generate --layout=m\t", "--layout=mdp"),
    ("cm1e scan -b n\t", "-b net.yaml "), ("cm1e scan -i si\t", "-i sim "), ("cm1e sdo re\t", "cm1e sdo read "),
    ("cm1e sim --bridge=\t\t", "eb01  eb02  eb12"), ("cm1e scan --interface=l\t", "--interface=lo "),
    ("cm1e l\t\t", "log  -- show what has happened to a running program's axes"),
    ("cm1e foe read --b\t\t", "--bootstrap  -- In the state Bootstrap, with its mailbox"),
    ("cm1e scan --att\t", "--attach="), ("cm1e move --json --velo\t", "--json --velocity="),
)
faults = []


class Zsh:
    def __init__(self, folder):
        self.pid, self.terminal = pty.fork()
        if self.pid == 0:
            os.chdir(folder)
            os.environ.update(TERM="dumb", PATH=BIN + ":" + os.environ["PATH"], HOME=folder)
            os.execvp("zsh", ["zsh", "-f", "-i"])
        os.write(self.terminal, SET_UP.encode())
        if "ready" not in self.until("ready\r\n"):
            faults.append("zsh does not begin")

    def until(self, wanted, seconds=20):
        """What comes up to these words."""
        seen, end = "", time.monotonic() + seconds
        while wanted not in seen and time.monotonic() < end:
            if select.select([self.terminal], [], [], 0.1)[0]:
                try:
                    seen += os.read(self.terminal, 65536).decode(errors="replace")
                except OSError:
                    break
        return seen

    def check(self, keys, wanted):
        os.write(self.terminal, keys.encode())
        seen = self.until(wanted)
        if wanted not in seen or "invalid" in seen or "_cm1e:" in seen or "bad " in seen:
            faults.append(f"zsh shows no \"{wanted}\" after {keys!r}:\n{seen}")
        os.write(self.terminal, CLEAR + b"print rea''dy\n")
        self.until("ready\r\n")

    def end(self):
        os.write(self.terminal, CLEAR + b"exit\n")
        self.until("never", 0.1)
        os.close(self.terminal)
        os.waitpid(self.pid, 0)


def main():
    if not shutil.which("zsh"):
        print("SKIPPED: zsh is not installed")
        sys.exit(SKIPPED)
    names = subprocess.run([os.path.join(BIN, "cm1e"), "--describe", "commands"], capture_output=True, text=True,
                           timeout=60).stdout.split()
    if len(names) < 20:
        faults.append(f"commands: {names}")
    with tempfile.TemporaryDirectory() as folder:
        for name in ("net.yaml", "other.txt"):
            with open(os.path.join(folder, name), "w", encoding="utf-8"):
                pass
        zsh = Zsh(folder)
        for keys, wanted in TYPED:
            zsh.check(keys, wanted)
        for name in names:  # zsh looks at the options of a command when they are wanted
            zsh.check(f"cm1e {name} --hel\t", f"cm1e {name} --help ")
        zsh.end()
    print("\n".join(faults) or f"zsh completes the {len(names)} commands and what they take")
    sys.exit(1 if faults else 0)


if __name__ == "__main__":
    main()
