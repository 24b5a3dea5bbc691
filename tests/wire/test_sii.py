#!/usr/bin/env python3
"""The SII of a slave over a veth pair, process by process: read, written, read again, the backup back.

test_sii.py CM1E
"""
import os
import signal
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import wire  # noqa: E402


def read(path):
    with open(path, "rb") as file:
        return file.read()


def signals(segment, cm1e, first):
    """Behind a signal the words that are left are written: half of an image is no SII."""
    image = bytearray(read(first))
    for place in range(2 * 0x300, len(image)):
        image[place] ^= 0xA5
    wanted = os.path.join(segment.folder, "wanted")
    with open(wanted, "wb") as file:
        file.write(image)
    for number, what in enumerate((signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGQUIT)):
        backup, again = (os.path.join(segment.folder, f"{name}{number}") for name in ("signalled", "seen"))
        write = [cm1e, "sii", "write", "-i", wire.MASTER_INTERFACE, "1", wanted, "--backup", backup]
        process = subprocess.Popen(segment.command(write), stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        wire.wait_for(lambda: os.path.exists(backup) and os.path.getsize(backup) == len(image), 10, "no backup")
        process.send_signal(what)
        out, err = process.communicate(timeout=60)
        wire.check(process.returncode == 0 and "is written" in out, f"{what.name}: {process.returncode} {out}{err}")
        for words in (("read", "1", again), ("write", "1", backup, "--backup", f"{again}.backup")):
            told = segment.run([cm1e, "sii", "-i", wire.MASTER_INTERFACE, *words])
            wire.check(told.returncode == 0, f"{what.name}: {told.stderr}")
        wire.check(read(again) == bytes(image), f"{what.name}: half of the image was written")


def main(cm1e):
    with wire.segment(cm1e) as segment:
        def sii(*words):
            result = segment.run([cm1e, "sii", "-i", wire.MASTER_INTERFACE, *words])
            wire.check(result.returncode == 0, f"cm1e sii {' '.join(words)}: {result.stdout}{result.stderr}")
            return result.stdout

        first, changed, backup, again, last = (os.path.join(segment.folder, name)
                                               for name in ("first", "changed", "backup", "again", "last"))
        sii("read", "1", first)
        image = bytearray(read(first))
        image[2 * 0x0C] ^= 0x5A  # revision
        image[2 * 0x300] ^= 0xFF
        with open(changed, "wb") as file:
            file.write(image)
        sii("write", "1", changed, "--backup", backup)
        wire.check(read(backup) == read(first), "the backup is not what was in the slave")
        sii("read", "1", again)
        wire.check(read(again) == bytes(image), "the slave does not hold what was written")
        sii("write", "1", backup, "--backup", os.path.join(segment.folder, "another"))
        sii("read", "1", last)
        wire.check(read(last) == read(first), "the backup is not back")
        # The SII of an older firmware, on the configuration words of the slave: a slave that contradicts itself.
        old, kept = os.path.join(segment.folder, "old"), os.path.join(segment.folder, "kept")
        generated = segment.run([cm1e, "generate", "sii", "--firmware", "1.2.0", "--config-data", first, "-o", old])
        wire.check(generated.returncode == 0, f"generate sii: {generated.stderr}")
        sii("write", "1", old, "--backup", kept)
        diff = segment.run([cm1e, "diff", old, "-i", wire.MASTER_INTERFACE])
        wire.check(diff.returncode == 1 and "contradicts itself: the revision" in diff.stdout,
                   f"diff: {diff.stdout}{diff.stderr}")
        sii("write", "1", kept, "--backup", os.path.join(segment.folder, "third"))
        diff = segment.run([cm1e, "diff", first, "-i", wire.MASTER_INTERFACE])
        wire.check(diff.returncode == 0, f"diff: {diff.stdout}{diff.stderr}")
        scan = segment.run([cm1e, "scan", "-i", wire.MASTER_INTERFACE])
        wire.check(scan.returncode == 0 and "CM1-E" in scan.stdout, f"scan: {scan.stdout}{scan.stderr}")
        signals(segment, cm1e, first)
    print("SII read, written, read back, and the backup written back")


if __name__ == "__main__":
    main(sys.argv[1])
