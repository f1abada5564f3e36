"""The stubs agree with the compiled module, and the package with its stubs."""

from __future__ import annotations

import importlib.metadata
import re
import subprocess
import sys
from pathlib import Path

import pytest

import basemat as bm

ROOT = Path(__file__).parents[1]


def check(*command: str) -> None:
    pytest.importorskip("mypy")
    done = subprocess.run(
        [sys.executable, "-m", *command], cwd=ROOT, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stdout + done.stderr


def test_stubs_are_those_of_the_compiled_module() -> None:
    allowed = str(ROOT / "tests" / "stubtest_allowed.txt")
    options = ["--concise", "--mypy-config-file", "pyproject.toml", "--allowlist", allowed]
    check("mypy.stubtest", "basemat", *options)


def test_the_package_is_typed() -> None:
    check("mypy", "--strict", "-p", "basemat")


def test_there_is_one_version() -> None:
    stated = re.compile(r'^version = "(.+)"$', re.MULTILINE)
    [own], [crate] = (
        stated.findall((folder / "Cargo.toml").read_text(encoding="utf-8"))
        for folder in (ROOT, ROOT.parent)
    )
    assert own == crate == importlib.metadata.version("basemat") == bm.__version__
    assert not stated.findall((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
