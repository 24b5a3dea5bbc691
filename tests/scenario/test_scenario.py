#!/usr/bin/env python3
"""The program scenario: a seed repeats exactly, a scenario as text is the same one, a failing one is made smaller, and
a file that is wrong is refused in words.

    test_scenario.py <program>
"""
import re
import subprocess
import sys
import tempfile
from pathlib import Path

PROGRAM = sys.argv[1]
SEEDS = (1, 2, 7, 11, 1000000002, 2000000006, 6000000003, 7000000005, 8000000003, 9000000003)
# Seeds with what scenario_random.c has for seeds from there on.
MORE, WIDE, VARIED, BESIDE, PLANT, SHOVE = (billion * 1000000000 for billion in (1, 2, 6, 7, 8, 9))
COUNT = 20
# The judge takes a limit that the machine was not made for as a failure: a way to see that it can fail at all.
SPOILED = ("run cycles=900 cycle_us=1000 lost_limit=3\n"
           "axis kind=cm1e counts_per_unit=1000 velocity=400000 acceleration=3e6 deceleration=3e6 jerk=1e8\n"
           "axis kind=cm1e counts_per_unit=1000 velocity=400000 acceleration=3e6 deceleration=3e6 jerk=1e8\n"
           "step at=300 axis=1 block=MC_MoveVelocity velocity=300000\n"
           "step at=310 axis=0 block=MC_MoveRelative distance=1000 velocity=1000\n"
           "fault at=500 kind=error axis=1 length=1 value=255\n")  # no error of the motor: the console refuses it


def run(*words):
    done = subprocess.run([PROGRAM, *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          check=False, timeout=200)
    return done.returncode, done.stdout


def hash_of(said):
    return re.search(r"hash ([0-9a-f]{16})", said)[1]


def check_repetition(folder):
    hashes = []
    for seed in SEEDS:
        first, again = run("--seed", seed), run("--seed", seed)
        assert first == again and first[0] == 0, (first, again)
        text = folder / "one.scenario"
        text.write_text(run("--seed", seed, "--write")[1])
        code, said = run("--play", text)
        assert code == 0 and hash_of(said) == hash_of(first[1]), said
        hashes.append(hash_of(said))
    assert len(set(hashes)) == len(SEEDS), hashes


def check_failure(folder):
    spoiled = folder / "spoiled.scenario"
    spoiled.write_text(SPOILED)
    code, said = run("--shrink", "--folder", folder, "--play", spoiled)
    assert code == 1 and "FAIL: console" in said, said
    smaller = (folder / "shrunk-0.scenario").read_text()
    assert smaller.count("\nstep") == 0 and smaller.count("\naxis") == 1 and smaller.count("\nfault") == 1, smaller
    code, said = run("--play", folder / "shrunk-0.scenario")
    assert code == 1 and "FAIL: console" in said, said


def check_more():
    code, said = run("--seed", MORE, "--count", COUNT)
    assert code == 0 and f"{COUNT} scenarios from seed {MORE} on: 0 failed" in said, said
    texts = [run("--seed", MORE + number, "--write")[1] for number in range(COUNT)]
    assert all(" memory=" in text for text in texts) and any("cycle_us=250" in text for text in texts), texts
    assert " memory=" not in run("--seed", MORE - 1, "--write")[1]


def check_wide():
    code, said = run("--seed", WIDE, "--count", COUNT)
    assert code == 0 and f"{COUNT} scenarios from seed {WIDE} on: 0 failed" in said, said
    text = "".join(run("--seed", WIDE + number, "--write")[1] for number in range(COUNT))
    for word in (" optional=1", " overlap=1", "kind=detach", "kind=stranger", "MC_Step", "Profile", "CM_FollowPosition"):
        assert word in text, word
        assert word not in run("--seed", WIDE - 1, "--write")[1], word


def check_varied():
    code, said = run("--seed", VARIED, "--count", COUNT)
    assert code == 0 and f"{COUNT} scenarios from seed {VARIED} on: 0 failed" in said, said
    text = "".join(run("--seed", VARIED + number, "--write")[1] for number in range(COUNT))
    for word in (" modulo=", " done_waits=1", " again=", " update=1", " change=", " parameter=", " source=1", " scaling=",
                 " transition=", "MC_GroupSetOverride", "MC_CamTableSelect", "kind=emergency"):
        assert word in text, word
        assert word not in run("--seed", VARIED - 1, "--write")[1], word


def check_beside():
    code, said = run("--seed", BESIDE, "--count", COUNT)
    assert code == 0 and f"{COUNT} scenarios from seed {BESIDE} on: 0 failed" in said, said
    text = "".join(run("--seed", BESIDE + number, "--write")[1] for number in range(3 * COUNT))
    for word in (" start=", " wired=1", "kind=input", "MC_ReadActualPosition", "MC_ReadDigitalInput", "CM_SendCML"):
        assert word in text, word
        assert word not in run("--seed", BESIDE - 1, "--write")[1], word


def check_plant():
    code, said = run("--seed", PLANT, "--count", COUNT)
    assert code == 0 and f"{COUNT} scenarios from seed {PLANT} on: 0 failed" in said, said
    text = "".join(run("--seed", PLANT + number, "--write")[1] for number in range(3 * COUNT))
    for word in (" backlash=", " switched=1", "kind=mailbox", " allow=1", "MC_GroupReadPosition"):
        assert word in text, word
        assert word not in run("--seed", PLANT - 1, "--write")[1], word


def check_shove():
    code, said = run("--seed", SHOVE, "--count", COUNT)
    assert code == 0 and f"{COUNT} scenarios from seed {SHOVE} on: 0 failed" in said, said
    texts = [run("--seed", SHOVE + number, "--write")[1] for number in range(COUNT)]
    assert sum("kind=shove" in text for text in texts) > COUNT // 2, texts
    assert "kind=shove" not in run("--seed", SHOVE - 1, "--write")[1]


def check_refusals(folder):
    for text, words in (("axis kind=nonsense\n", "line 1"), ("run cycles=100 cycle_us=1000\n", "needs an axis"),
                        ("nonsense\n", "expected run"), ("run cycles=abc\n", "not one of this name")):
        wrong = folder / "wrong.scenario"
        wrong.write_text(text)
        code, said = run("--play", wrong)
        assert code == 1 and words in said, said
    assert run("--nonsense")[0] == 2


def main():
    with tempfile.TemporaryDirectory() as name:
        check_repetition(Path(name))
        check_failure(Path(name))
        check_refusals(Path(name))
    check_more()
    check_wide()
    check_varied()
    check_beside()
    check_plant()
    check_shove()
    print("ok")


if __name__ == "__main__":
    main()
