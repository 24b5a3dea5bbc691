"""docs/PYTHON.md and the README: every program in them runs as it stands. The notebook is executed."""
import os
import re
import subprocess
import sys

import pytest

import cm1e

SOURCE = os.environ.get("CM1E_SOURCE", os.path.join(os.path.dirname(__file__), "..", "..", ".."))


def blocks(name):
    with open(os.path.join(SOURCE, name), encoding="utf-8") as file:
        return re.findall(r"```python\n(.*?)```", file.read(), re.DOTALL)


PAGE = blocks("docs/PYTHON.md")


def run(text, folder, *words):
    program = folder / "program.py"
    program.write_text(text)
    result = subprocess.run([sys.executable, *words, program], capture_output=True, text=True, timeout=60, cwd=folder)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


@pytest.mark.real_time
def test_first_program_moves_to_where_the_page_says(tmp_path):
    assert len(PAGE) >= 8
    with open(os.path.join(SOURCE, "docs/PYTHON.md"), encoding="utf-8") as file:
        told = re.search(r"It prints `([^`]+)`", file.read()).group(1)
    assert run(PAGE[0], tmp_path).strip() == told == "X is at 20.0"
    readme = blocks("bindings/python/README.md")[0].replace("counts_per_unit", "max_position_lag\": 100, \"counts_per_unit")
    assert float(run(readme, tmp_path)) == pytest.approx(20, abs=0.1)


@pytest.mark.parametrize("number", [n for n, text in enumerate(PAGE) if "virtual_time" in text])
def test_programs_on_virtual_time(number, tmp_path):
    run(PAGE[number], tmp_path)


def test_test_of_the_page(tmp_path):
    text, = (text for text in PAGE if "pytest.mark" in text)
    run(text, tmp_path, "-m", "pytest", "-q", "-p", "no:cacheprovider")


@pytest.mark.real_time
def test_attached_program_of_the_page(tmp_path, monkeypatch):
    monkeypatch.setenv("CM1E_RUNTIME_DIR", str(tmp_path / "run"))
    text, = (text for text in PAGE if "attach()" in text)
    with cm1e.Bus(axes=1) as bus:
        bus.axes[0].enable()
        assert "axis1: Standstill" in run(text, tmp_path)


def test_names_of_the_page_exist():
    with open(os.path.join(SOURCE, "docs/PYTHON.md"), encoding="utf-8") as file:
        text = file.read()
    names = re.findall(r"`(?:bus|axis|cm1e)\.(\w+)", text)
    assert len(names) > 15
    for name in names:
        assert any(hasattr(owner, name) for owner in (cm1e, cm1e.Bus, cm1e.Axis)) or name in ("files", "yaml", "h"), name


def test_notebook(tmp_path):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    path = os.path.join(SOURCE, "bindings", "python", "examples", "gear.ipynb")
    book = nbformat.read(path, as_version=4)
    assert not any(cell.get("outputs") for cell in book.cells), "the notebook is kept without its results"
    nbclient.NotebookClient(book, timeout=60, kernel_name="python3",
                            resources={"metadata": {"path": str(tmp_path)}}).execute()
    shown = [output for cell in book.cells for output in cell.get("outputs", [])]
    assert any("image/svg+xml" in output.get("data", {}) for output in shown)
    assert any("follows exactly" in output.get("text", "") for output in shown)
