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
    recipe = (ROOT / "conda" / "recipe.yaml").read_text("utf-8")
    [conda] = re.findall(r'^  version: "(.+)"$', recipe, re.MULTILINE)
    assert own == crate == conda == importlib.metadata.version("basemat") == bm.__version__
    assert not stated.findall((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def test_the_conda_recipe_has_the_packages_requirements() -> None:
    """As its own program reads the recipe, where this is installed; else the text."""
    metadata = importlib.metadata.requires("basemat") or []
    [numpy] = [own.replace("numpy", "") for own in metadata if own.startswith("numpy") and "extra" not in own]
    path = ROOT / "conda" / "recipe.yaml"
    assert f"    - numpy {numpy}\n" in path.read_text("utf-8")
    rattler = pytest.importorskip("rattler_build")
    [variant] = rattler.Stage0Recipe.from_file(path).render(rattler.VariantConfig.from_yaml("python: ['3.12.*']"))
    assert str(variant.recipe.package.name) == "basemat" and str(variant.recipe.package.version) == bm.__version__
