"""What the tests of the Python package share."""
import subprocess
import sys

import pytest

pytest_plugins = ["pytester"]


@pytest.fixture
def python():
    """Runs a program in an interpreter of its own, to its end: (exit status, what it printed)."""
    def run(text, timeout=30):
        result = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, timeout=timeout)
        return result.returncode, result.stdout + result.stderr
    return run
