#!/usr/bin/env python3
"""The Debian packages that cpack has written: lintian finds no error, a program is compiled with what they hold, and in
a bare Debian they are installed, used by members of the group cm1e and by others, and removed without a trace.

test_packages.py BUILD-DIRECTORY
"""
import contextlib
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
RELEASE = "bookworm"
PARTS = ("cm1e", "libcm1e-dev", "libcm1e-doc", "libcm1e0.1", "python3-cm1e")
PROGRAM = """\
#include <cm1e/scheduler.h>
#include <cm1e/version.h>
#include <stdio.h>
int main(void) { puts(cm1e_version()); return 0; }
"""
# What apt and dpkg write about themselves, and caches that programs of Debian write.
OF_APT = re.compile(r"^/(var/(lib/(apt|dpkg|systemd)|cache|log)|etc/(passwd|group|gshadow|shadow|subuid|subgid|ld\.so\.cache)"
                    r"|tmp|proc|sys|dev|run|root)")
PYTHON = """\
import importlib.metadata, cm1e
with cm1e.Bus(axes=[{"name": "X", "counts_per_unit": 5000}], virtual_time=True) as bus:
    bus["X"].enable()
    bus["X"].move_absolute(position=20, velocity=50)
    print(f"X is at {bus['X'].position:.1f}, cm1e {importlib.metadata.version('cm1e')} is {cm1e.__version__}")
"""
DEMO = ["cm1e", "move", "-i", "sim", "1", "--by", "1", "--velocity", "5"]


def skip(why):
    print("SKIPPED:", why)
    sys.exit(SKIPPED)


def run(*command, **options):
    done = subprocess.run(command, capture_output=True, text=True, **options)
    if done.returncode != 0:
        sys.exit(f"FAILED: {' '.join(command)}\n{done.stdout}{done.stderr}")
    return done.stdout


def expect(condition, what, told):
    if not condition:
        sys.exit(f"FAILED: {what}\n{told}")


def packages_of(build):
    found = sorted(glob.glob(os.path.join(build, "*.deb")))
    names = tuple(os.path.basename(path).partition("_")[0] for path in found)
    expect(names == tuple(sorted(PARTS)), f"the packages {PARTS}", names)
    return found


def check_summaries(packages):
    """By which people find a package: each has its own."""
    first = [run("dpkg-deb", "-f", path, "Description").splitlines()[0] for path in packages]
    expect(len(set(first)) == len(packages) and all("EtherCAT servo motors CM1-E" in line for line in first),
           "a summary of its own for each package", first)


def check_by_lintian(packages):
    if not shutil.which("lintian"):
        print("lintian is not here: it was not asked")
        return
    told = subprocess.run(["lintian", "--allow-root", "--tag-display-limit", "0", *packages], capture_output=True, text=True)
    print(told.stdout.strip())
    expect("E: " not in told.stdout and told.returncode == 0, "lintian", told)


def compile_with(packages, folder):
    """Shared and static, by what the packages hold alone."""
    for path in packages:
        run("dpkg-deb", "-x", path, folder)
    source, program = os.path.join(folder, "program.c"), os.path.join(folder, "program")
    with open(source, "w", encoding="utf-8") as file:
        file.write(PROGRAM)
    libraries = os.path.dirname(glob.glob(os.path.join(folder, "usr/lib/*/libcm1e.so"))[0])
    words = run("pkg-config", "--cflags", "--libs", "cm1e",
                env={**os.environ, "PKG_CONFIG_LIBDIR": os.path.join(libraries, "pkgconfig")}).split()
    run("cc", source, "-o", program, *words)
    shared = run(program, env={**os.environ, "LD_LIBRARY_PATH": libraries})
    run("cc", source, "-o", program, *(word for word in words if word.startswith("-I")),
        os.path.join(libraries, "libcm1e.a"), "-pthread", "-lm")
    expect(run(program) == shared, "the version of the static library", shared)


class Chroot:
    """A bare Debian in a folder."""
    def __init__(self, folder):
        self.folder = folder

    def run(self, *command):
        return subprocess.run(["chroot", self.folder, *command], capture_output=True, text=True,
                              env={"PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "DEBIAN_FRONTEND": "noninteractive", "LC_ALL": "C"})

    def good(self, *command):
        done = self.run(*command)
        expect(done.returncode == 0, f"in the chroot: {' '.join(command)}", done)
        return done.stdout + done.stderr

    def files(self):
        found = self.good("find", "/", "-xdev", "-not", "-type", "d").splitlines()
        return {path for path in found if not OF_APT.match(path)}


def mirror():
    """The one from which this machine takes Debian's own packages."""
    for path in ["/etc/apt/sources.list", *glob.glob("/etc/apt/sources.list.d/*")]:
        with contextlib.suppress(OSError), open(path, encoding="utf-8") as file:
            for block in re.split(r"\n\s*\n", file.read()):
                found = re.search(rf"^deb (?:\[.*?\] )?(http\S+) {RELEASE} main", block, re.MULTILINE) or (
                    re.search(rf"^Suites:.*\b{RELEASE}(\s|$)", block, re.MULTILINE) and
                    re.search(r"^URIs: (http\S+)", block, re.MULTILINE))
                if found:
                    return found[1]
    return "http://deb.debian.org/debian"


def make_chroot(folder):
    if os.geteuid() != 0 or not shutil.which("debootstrap"):
        skip("installing in a bare Debian needs root and debootstrap")
    made = subprocess.run(["debootstrap", "--variant=minbase", RELEASE, folder, mirror()], capture_output=True, text=True)
    if made.returncode != 0:
        skip(f"debootstrap made no Debian: {made.stdout[-300:]}{made.stderr[-300:]}")
    os.chmod(folder, 0o755)  # of everybody in it, not only of root
    return Chroot(folder)


def use(chroot):
    """By everybody in simulation; on network interfaces by members of the group only."""
    chroot.good("useradd", "member", "-G", "cm1e")
    chroot.good("useradd", "stranger")
    for user in ("member", "stranger"):
        told = chroot.good("setpriv", f"--reuid={user}", f"--regid={user}", "--init-groups", *DEMO)
        expect("move done" in told, f"the demo as {user}", told)
    told = chroot.good("python3", "-c", PYTHON)
    version = chroot.good("cm1e", "--version").strip()
    expect(told == f"X is at 20.0, {version} is {version.removeprefix('cm1e ')}\n", "the demo in Python", told)
    as_user = lambda user: chroot.run("setpriv", f"--reuid={user}", f"--regid={user}", "--init-groups", "cm1e", "scan",
                                      "-i", "lo")
    told = as_user("stranger")
    expect("CAP_NET_RAW" in told.stderr, "a stranger is told what is missing", told)
    told = as_user("member")
    expect("is not Ethernet" in told.stderr, "a member opens a socket", told)
    for path in ("/usr/share/man/man1/cm1e-move.1.gz", "/usr/share/doc/cm1e/FIRST-HOUR.md", "/usr/include/cm1e/plcopen.h",
                 "/lib/systemd/system/cm1e@.service", "/lib/udev/rules.d/60-cm1e.rules", "/usr/lib/python3/dist-packages/cm1e/py.typed",
                 "/usr/share/doc/cm1e/reference/index.html", "/usr/share/doc/cm1e/soem/soem/ethercatmain.c"):
        chroot.good("test", "-e", path)
    chroot.good("userdel", "member")
    chroot.good("userdel", "stranger")


def install_and_remove(packages, folder):
    chroot = make_chroot(folder)
    chroot.good("apt-get", "update", "-q")
    depends = chroot.files()
    for path in packages:
        shutil.copy(path, os.path.join(folder, "tmp"))
    install = ["apt-get", "install", "-q", "-y", "--no-install-recommends",
               *(f"/tmp/{os.path.basename(path)}" for path in packages)]
    fetched = chroot.run(*install, "--download-only")
    if fetched.returncode != 0 and re.search("Failed to fetch|Temporary failure|Could not connect", fetched.stderr):
        skip(f"apt could not fetch what the packages depend on: {fetched.stderr[-300:]}")
    chroot.good(*install)
    expect("cm1e" in chroot.good("getent", "group", "cm1e"), "the group", "")
    use(chroot)
    chroot.good("apt-get", "purge", "-q", "-y", *PARTS)
    chroot.good("apt-get", "autoremove", "-q", "-y", "--purge")
    left = sorted(chroot.files() - depends)
    expect(not left, "files that stay after a purge", left)
    expect(chroot.run("getent", "group", "cm1e").returncode != 0, "the group stays", "")


def main(build):
    packages = packages_of(build)
    check_summaries(packages)
    check_by_lintian(packages)
    with tempfile.TemporaryDirectory() as folder:
        compile_with(packages, folder)
    with tempfile.TemporaryDirectory() as folder:
        install_and_remove(packages, folder)
    print("the packages are installed, used and removed")


if __name__ == "__main__":
    main(sys.argv[1])
