#!/usr/bin/env python3
"""The Python package (bindings/python): built by pip from the installed library, its types, its own tests.

test_python.py BUILD-DIRECTORY SOURCE-DIRECTORY PYTHON-OF-THE-VENV build|types|tests [WORDS FOR PYTEST]
"""
import os
import shutil
import subprocess
import sys

BUILD, SOURCE, PYTHON, PART = (*map(os.path.abspath, sys.argv[1:3]), sys.argv[3], sys.argv[4])
PACKAGE, HOME = os.path.join(SOURCE, "bindings", "python"), os.path.join(BUILD, "python")
SITE, PREFIX = os.path.join(HOME, "site"), os.path.join(HOME, "prefix")
SKIPPED = 77


def run(command, quiet=False, **more):
    result = subprocess.run(command, env={**os.environ, **more}, stdout=subprocess.DEVNULL if quiet else None)
    if result.returncode != 0:
        sys.exit(result.returncode)


def skip_without(*modules):
    if PART != "build" and not os.path.isdir(SITE):
        print("SKIPPED: python: the package was not built")
        sys.exit(SKIPPED)
    words = [PYTHON, "-c", f"import {', '.join(modules)}"]
    if not os.path.exists(PYTHON) or subprocess.run(words, capture_output=True).returncode != 0:
        print(f"SKIPPED: python: there is no {', '.join(modules)} here; scripts/install-dependencies --tests installs it")
        sys.exit(SKIPPED)


def build():
    """As a user does it with an installed library. What pip makes is kept: the next time it takes a second."""
    skip_without("cffi", "scikit_build_core", "numpy")
    shutil.rmtree(SITE, ignore_errors=True)
    run(["cmake", "--install", BUILD, "--prefix", PREFIX], quiet=True, DESTDIR="")
    run([PYTHON, "-m", "pip", "install", "-q", "--disable-pip-version-check", "--no-index", "--no-deps",
         "--no-build-isolation", "--target", SITE, PACKAGE],
        CMAKE_PREFIX_PATH=PREFIX, CMAKE_ARGS="-DCM1E_PYTHON_INSTALLED=ON -DCM1E_PYTHON_STRICT=ON",
        SKBUILD_BUILD_DIR=os.path.join(HOME, "wheel"))


def types():
    skip_without("mypy")
    run([PYTHON, "-m", "mypy", "--strict", "--cache-dir", os.path.join(HOME, "mypy"), "-p", "cm1e"], MYPYPATH=SITE)


def tests():
    skip_without("cffi", "numpy", "pytest")
    run([PYTHON, "-m", "pytest", "-q", "-p", "no:cacheprovider", "--rootdir", PACKAGE, *sys.argv[5:]],
        PYTHONPATH=SITE, PYTHONDONTWRITEBYTECODE="1", CM1E_SOURCE=SOURCE,
        PATH=os.path.join(BUILD, "bin") + os.pathsep + os.environ["PATH"])


{"build": build, "types": types, "tests": tests}[PART]()
