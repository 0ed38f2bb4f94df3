"""What the tests share: the command line, which results are held against."""

from __future__ import annotations

import json
import os
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(os.environ.get("GNOMON_ROOT", Path(__file__).parents[2]))
SIZE = (96, 64)


def _binary() -> Path | None:
    """The program: the one that GNOMON names, or one that was built here."""
    named = os.environ.get("GNOMON")
    if named:
        return Path(named).resolve(strict=True)
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    built = [target / profile / "gnomon" for profile in ("release", "debug")]
    return next((path.resolve() for path in built if path.is_file()), None)


@pytest.fixture(scope="session")
def cli(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Any]:
    """Runs the command line in a folder of its own; gives what it prints as JSON."""
    binary = _binary()
    if binary is None:
        pytest.skip("no gnomon program was built, and GNOMON names none")
    folder = tmp_path_factory.mktemp("cli")

    def run(*arguments: str | Path) -> Any:
        words = [str(binary), *map(str, arguments)]
        done = subprocess.run(words, cwd=folder, capture_output=True, check=False)
        assert done.returncode == 0, done.stderr.decode()
        return json.loads(done.stdout) if "--json" in arguments else folder

    return run
