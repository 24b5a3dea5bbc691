"""Random motions, planned by us and by ruckig: ours never takes longer by more than 1e-6.

    test_ruckig.py <oracle_plan> <python of the venv with ruckig>

Ruckig's limits of the acceleration are by its sign, ours by whether |v| grows: where acceleration and deceleration
differ, only motions that never go backwards can be compared. Where ruckig gives an error, or thinks that there is
nothing to do, there is no second opinion; how often is printed. Where ours is shorter, ruckig brakes at its limits
without need. CM1E_TEST_SEED repeats a run.
"""
import math
import os
import random
import struct
import subprocess
import sys

PROBLEMS = 240000
TOLERANCE = 1e-6
LIMITS = struct.Struct("9d")


def decade(low, high):
    return math.exp(random.uniform(math.log(low), math.log(high)))


def random_start(vmax, acc, dec, jerk):
    """Within the limits, also when its acceleration is eased. Often at a limit to the last bit."""
    kind = random.random()
    if kind < 0.2:
        return 0.0, 0.0
    for _ in range(50):
        v = random.uniform(-1, 1) * vmax
        a = random.choice((0.0, acc, -dec, random.uniform(-dec, acc)))
        if kind < 0.3:
            v = math.copysign(vmax, v)
        if kind > 0.9:
            v = math.copysign(vmax, a) - a * abs(a) / jerk / 2
        if abs(v) <= vmax and abs(v + a * abs(a) / jerk / 2) <= vmax:
            return v, a
    return 0.0, 0.0


def random_problem():
    vmax, acc, jerk = decade(0.1, 1000), decade(1, 10000), decade(10, 1e6)
    dec = acc if random.random() < 0.7 else decade(1, 10000)
    v, a = random_start(vmax, acc, dec, jerk)
    w = random.choice((0.0, random.uniform(-1, 1) * vmax, vmax, -vmax))
    if acc != dec:
        v, w = abs(v), abs(w)
        if v + a * abs(a) / jerk / 2 > vmax:
            a = 0.0
    slower = min(acc, dec)
    typical = vmax * (vmax / slower + slower / jerk)
    target = random.uniform(0 if acc != dec else -1, 1) * typical * decade(1e-6, 10)
    return 0.0, v, a, target, w, vmax, acc, dec, jerk


def scenario_s6():
    """A new target in the middle of a move, at a = amax and v + a2/2j = vmax: nothing needs braking."""
    return 23.125, 262.5, 1500.0, 250.0, 0.0, 300.0, 1500.0, 1500.0, 30000.0


def goes_backwards(profile, vmax):
    """Whether the velocity gets below zero: at a border of pieces, or where the acceleration passes zero."""
    pieces = zip(profile.t, profile.v, profile.a, profile.j)
    lowest = min(v - a * a / j / 2 if j > 0 and a < 0 and -a / j < t else v for t, v, a, j in pieces)
    return min(lowest, profile.v[-1]) < -1e-9 * vmax


class Ruckig:
    def __init__(self, ruckig):
        self.otg, self.input, self.trajectory = ruckig.Ruckig(1), ruckig.InputParameter(1), ruckig.Trajectory(1)

    def duration(self, problem):
        """None: ruckig gives an error, or its motion is not one that ours can be compared with."""
        x, v, a, target, w, vmax, acc, dec, jerk = problem
        i = self.input
        i.current_position, i.current_velocity, i.current_acceleration = [x], [v], [a]
        i.target_position, i.target_velocity = [target], [w]
        i.max_velocity, i.max_acceleration, i.min_acceleration, i.max_jerk = [vmax], [acc], [-dec], [jerk]
        try:
            if self.otg.calculate(i, self.trajectory) < 0:
                return None, "error"
        except Exception:  # whatever it is called in this version
            return None, "error"
        if self.trajectory.duration == 0 and target != x:
            return None, "does not move"  # less than 1e-8 is nothing to it
        if acc != dec and goes_backwards(self.trajectory.profiles[0][0], vmax):
            return None, "goes backwards"
        return self.trajectory.duration, None


def plan(program, problems):
    data = b"".join(LIMITS.pack(*problem) for problem in problems)
    output = subprocess.run([program], input=data, stdout=subprocess.PIPE, check=True).stdout
    durations = struct.unpack(f"{len(output) // 8}d", output)
    assert len(durations) == len(problems), f"{len(durations)} answers to {len(problems)} problems"
    return durations


def main():
    program = sys.argv[1]
    import ruckig
    seed = int(os.environ.get("CM1E_TEST_SEED", "20260802"), 0)
    print(f"CM1E_TEST_SEED={seed}, ruckig {ruckig.__version__}")
    random.seed(seed)
    oracle = Ruckig(ruckig)
    problems = [scenario_s6()] + [random_problem() for _ in range(PROBLEMS)]
    ours = plan(program, problems)
    skipped, compared, shorter, failed = {"error": 0, "goes backwards": 0, "does not move": 0}, 0, 0, 0
    for problem, duration in zip(problems, ours):
        theirs, why = oracle.duration(problem)
        if duration < 0:
            failed += 1
            print(f"no plan for {problem}")
        elif why:
            skipped[why] += 1
        else:
            compared += 1
            if duration > theirs * (1 + TOLERANCE) + 1e-9:
                failed += 1
                if failed < 20:
                    print(f"longer: {duration!r} instead of {theirs!r} for {problem}")
            shorter += duration < theirs * (1 - TOLERANCE) - 1e-9
    theirs, _ = oracle.duration(problems[0])
    print(f"compared {compared}: longer {failed}, shorter {shorter}; left out of ruckig: "
          + ", ".join(f"{why} {count}" for why, count in skipped.items()))
    print(f"S6: ours {0.2 + ours[0]:.4f} s, ruckig {0.2 + theirs:.4f} s")
    if abs(0.2 + ours[0] - 13 / 12) > 1e-9:
        failed += 1
        print("S6 takes longer than 1.0833 s")
    if compared < 100000 or skipped["error"] > len(problems) // 100:
        failed += 1
        print("too little was compared")
    return 1 if failed else 0


if __name__ == "__main__":
    if sys.executable != os.path.abspath(sys.argv[2]):
        if not os.path.exists(sys.argv[2]):
            sys.exit(77)
        if subprocess.run([sys.argv[2], "-c", "import ruckig"], stderr=subprocess.DEVNULL).returncode:
            print("ruckig is not installed: scripts/install-dependencies --tests")
            sys.exit(77)
        os.execv(sys.argv[2], [sys.argv[2], *sys.argv])
    sys.exit(main())
