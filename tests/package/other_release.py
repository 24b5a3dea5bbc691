#!/usr/bin/env python3
"""Builds, tests and packages cm1e in another release of Debian or Ubuntu, or cross for another processor, in a folder
with a bare system of that release (debootstrap). By hand: it takes some minutes, and needs root.

other_release.py RELEASE FOLDER [--arm64] [--quick] [--tests PATTERN]
  RELEASE   bookworm, trixie (Debian 12, 13) or noble (Ubuntu 24.04)
  FOLDER    the system is made there, and used again the next time
  --arm64   cross-builds for arm64, and runs what it has built under qemu
  --quick   without link-time optimisation, which takes most of the time
  --tests   builds those programs of tests/unit too that match (test_core, test_motion|test_sim ...), and runs them;
            the longest ones are left out under an emulator
"""
import argparse
import os
import re
import subprocess
import sys

from test_packages import Chroot, mirror, skip

SOURCE = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../.."))
UBUNTU = ("noble", "http://archive.ubuntu.com/ubuntu", "/usr/share/keyrings/ubuntu-archive-keyring.gpg")
TOOLS = ("build-essential", "cmake", "ninja-build", "pkg-config", "python3", "python3-pip", "python3-setuptools",
         "flex", "bison", "libjs-dygraphs", "ccache", "lintian", "doxygen", "python3-cffi", "locales", "ca-certificates")
LIBRARIES = ("libcyaml-dev", "libyaml-dev", "libjansson-dev", "libxml2-dev", "libncurses-dev", "libmicrohttpd-dev",
             "check", "libsubunit-dev")
NATIVE = ("python3-dev", "python3-numpy", "libcap2-bin")
CROSS = ("crossbuild-essential-arm64", "qemu-user-static")
TOO_LONG = "random|slow_time|motion_state"  # minutes under an emulator
DEMO = ["move", "-i", "sim", "1", "--by", "1", "--velocity", "5"]


def say(text):
    print(f"== {text}", flush=True)


class System(Chroot):
    def told(self, *command, log=None):
        """Runs on, with its output in a file of the system; its warnings are told."""
        done = self.run("sh", "-c", " ".join(command) + " 2>&1")
        if log:
            with open(os.path.join(self.folder, "tmp", log), "w", encoding="utf-8") as file:
                file.write(done.stdout)
        for line in sorted(set(re.findall(r"^.*\bwarning: .*$", done.stdout, re.MULTILINE))):
            print("  ", line)
        if done.returncode != 0:
            sys.exit(f"FAILED: {' '.join(command)}\n{done.stdout[-3000:]}")
        return done.stdout


def make_system(release, folder):
    if os.geteuid() != 0:
        skip("only root makes a system in a folder")
    if os.path.exists(os.path.join(folder, "usr/bin/apt-get")):
        return
    command = ["debootstrap", "--variant=minbase", release, folder, mirror()]
    if release == UBUNTU[0]:
        if not os.path.exists(UBUNTU[2]):
            skip(f"{UBUNTU[2]} is not here: Debian 13 has it in the package ubuntu-keyring")
        command = ["debootstrap", "--variant=minbase", "--extractor=dpkg-deb", f"--keyring={UBUNTU[2]}",
                   "--components=main,universe", release, folder, UBUNTU[1], "/usr/share/debootstrap/scripts/gutsy"]
    made = subprocess.run(command, capture_output=True, text=True)
    if made.returncode != 0:
        skip(f"debootstrap made no {release}: {made.stdout[-300:]}{made.stderr[-300:]}")
    os.chmod(folder, 0o755)


def install(system, arm64):
    packages = [*TOOLS, *LIBRARIES, *NATIVE]
    if arm64:
        system.good("dpkg", "--add-architecture", "arm64")
        packages = [*TOOLS, *CROSS, *(f"{name}:arm64" for name in LIBRARIES)]
    system.good("apt-get", "update", "-q")
    system.good("apt-get", "install", "-q", "-y", "--no-install-recommends", *packages)


def bring_source(folder):
    """What git knows, as it stands here, and the archives that the build would fetch."""
    target = os.path.join(folder, "root/cm1e")
    os.makedirs(target, exist_ok=True)
    names = subprocess.run(["git", "-C", SOURCE, "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
                           capture_output=True, check=True).stdout.split(b"\0")
    names = [name for name in names if name and os.path.exists(os.path.join(SOURCE.encode(), name))]
    names += [os.path.join(".deps", name).encode() for name in os.listdir(os.path.join(SOURCE, ".deps"))
              if name.endswith((".tar.gz", ".tar.xz"))]
    packed = subprocess.run(["tar", "-C", SOURCE, "--null", "-T", "-", "-c"], input=b"\0".join(names),
                            capture_output=True, check=True).stdout
    subprocess.run(["tar", "-C", target, "-x"], input=packed, check=True)


def tests_that_match(pattern):
    names = (os.path.splitext(name)[0] for name in sorted(os.listdir(os.path.join(SOURCE, "tests/unit"))))
    return [name for name in names if name.startswith("test_") and re.search(pattern, name)]


def demo(system, command):
    """In real time: where another program takes the processors, the simulated watchdog bites, so it is tried again."""
    words = " ".join([command, *DEMO])
    for _ in range(9):
        done = system.run("sh", "-c", words)
        if done.returncode == 0:
            break
    else:
        sys.exit(f"FAILED: {words}\n{done.stdout}{done.stderr}")
    return done.stdout.strip()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("release", choices=("bookworm", "trixie", "noble"))
    parser.add_argument("folder")
    parser.add_argument("--arm64", action="store_true")
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--tests")
    options = parser.parse_args()
    folder = os.path.abspath(options.folder)
    say(f"{options.release} in {folder}")
    make_system(options.release, folder)
    system = System(folder)
    install(system, options.arm64)
    bring_source(folder)
    preset, build = ("package-arm64", "build-arm64") if options.arm64 else ("package", "build-package")
    settings = "-DCMAKE_C_COMPILER_LAUNCHER=ccache"
    settings += f" -DCM1E_BUILD_TESTS={'ON' if options.tests else 'OFF'}"
    settings += f" -DCM1E_LINK_TIME_OPTIMIZATION={'OFF' if options.quick else 'ON'}"
    run_it = "qemu-aarch64-static " if options.arm64 else ""
    say(system.good("sh", "-c", "cc --version | head -1; cmake --version | head -1").strip().replace("\n", ", "))
    system.told(f"cd /root/cm1e && cmake --preset {preset} {settings}", log="configure.log")
    # With tests the default target has all of them.
    programs = tests_that_match(options.tests) if options.tests else []
    if options.arm64:
        programs = [name for name in programs if not re.search(TOO_LONG, name)]
    say("build")
    system.told(f"cd /root/cm1e && cmake --build {build} --target cm1e {' '.join(programs)}", log="build.log")
    say("the simulated axis")
    print(demo(system, f"cd /root/cm1e && {run_it}{build}/bin/cm1e"))
    if programs:
        say(f"{len(programs)} programs of tests/unit")
        pattern = f"^({'|'.join(programs)})$"
        told = system.told(f"cd /root/cm1e && ctest --test-dir {build} -L unit -R '{pattern}'", log="ctest.log")
        print(re.search(r"^\d+% tests passed.*", told, re.MULTILINE)[0])
    say("packages")
    system.told(f"cd /root/cm1e && cmake --preset {preset} {settings} -DCM1E_BUILD_TESTS=OFF && cmake --build {build}",
                log="packages.log")
    system.told(f"cd /root/cm1e/{build} && cpack", log="cpack.log")
    lint = system.run("sh", "-c", f"cd /root/cm1e/{build} && lintian --allow-root --tag-display-limit 0 *.deb").stdout
    errors = "\n".join(line for line in lint.splitlines() if line.startswith("E:"))
    print(errors or "lintian finds no error")
    if not options.arm64:
        system.good("sh", "-c", f"apt-get install -q -y --no-install-recommends /root/cm1e/{build}/*.deb")
        print(demo(system, "cm1e"))
        system.good("sh", "-c", "apt-get purge -q -y cm1e libcm1e-dev libcm1e-doc 'libcm1e0*' python3-cm1e")
    if errors:
        sys.exit("FAILED: lintian finds errors")
    say("done")


if __name__ == "__main__":
    main()
