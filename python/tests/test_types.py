"""Type stubs say what is there, and programs that use them are checked by them."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent


def mypy(*arguments: str, folder: Path) -> subprocess.CompletedProcess[str]:
    words = [sys.executable, "-m", *arguments]
    return subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)


def test_stubs_are_what_the_module_has(tmp_path):
    """Names, arguments and their defaults, both ways."""
    done = mypy("mypy.stubtest", "gnomon._gnomon", folder=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr


def test_the_example_is_strictly_typed(tmp_path):
    done = mypy("mypy", "--strict", str(HERE / "typed.py"), folder=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    run = subprocess.run([sys.executable, HERE / "typed.py"], cwd=tmp_path, check=False)
    assert run.returncode == 0


def test_the_package_is_strictly_typed(tmp_path):
    done = mypy("mypy", "--strict", "-p", "gnomon", folder=tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("gnomon.render('demo', sise=(1, 1))", "sise"),
        ("gnomon.render(7)", "arg-type"),
        ("x: str = gnomon.render('demo').time_ms", "assignment"),
        ("gnomon.compare('demo').results[0].rmsd", "rmsd"),
    ],
)
def test_mistakes_are_found(tmp_path, line, told):
    program = tmp_path / "mistake.py"
    program.write_text(f"import gnomon\n\n{line}\n")
    done = mypy("mypy", "--strict", str(program), folder=tmp_path)
    assert done.returncode == 1 and told in done.stdout, done.stdout
