#!/usr/bin/env python3
"""Wireshark's EtherCAT dissector reads a whole start-up, homing and stop that the tap recorded: nothing malformed.

test_dissector.py CM1E
"""
import collections
import os
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77


def tshark(pcap, *words):
    result = subprocess.run(["tshark", "-n", "-r", pcap, *words], capture_output=True, text=True, timeout=300)
    if result.returncode != 0:
        sys.exit(f"FAILED: tshark: {result.stderr}")
    return result.stdout.splitlines()


def main(cm1e):
    if not shutil.which("tshark"):
        print("SKIPPED: tshark is not installed")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        pcap = os.path.join(folder, "start-up.pcap")
        run = subprocess.run([cm1e, "move", "-i", "sim", "--by", "0.1", "--pcap", pcap], capture_output=True, text=True,
                             timeout=120)
        if run.returncode != 0:
            sys.exit(f"FAILED: cm1e move: {run.stdout}{run.stderr}")
        frames = tshark(pcap, "-T", "fields", "-e", "frame.protocols", "-e", "_ws.malformed")
        bad = [line for line in frames if "ecat" not in line or "malformed" in line.lower()]
        if bad or len(frames) < 1000:
            sys.exit(f"FAILED: {len(bad)} of {len(frames)} frames malformed or not EtherCAT, the first: {bad[:3]}")
        mailbox = tshark(pcap, "-Y", "ecat_mailbox.coe", "-T", "fields", "-e", "ecat_mailbox.coe.type")
        if len(mailbox) < 10:
            sys.exit(f"FAILED: only {len(mailbox)} frames with CoE")
        print(f"{len(frames)} frames, {len(mailbox)} with CoE, none malformed")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
