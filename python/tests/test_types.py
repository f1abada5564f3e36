"""The stubs agree with the compiled module, and the package with its stubs."""

from __future__ import annotations

import importlib
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


RUST = """
/// A class, with a text that has "brackets) }" and { in it.
#[pyclass(name = "Sample", module = "basemat", frozen, eq)]
pub(crate) struct PySample(Vec<f64>);

type Names<'py> = Vec<(String, Bound<'py, PyAny>)>;

#[pymethods]
impl PySample {
    #[pyo3(signature = (values, *, name="a (", other=None))]
    #[new]
    fn new(py: Python<'_>, values: Numbers, name: &str, other: Option<&PySample>) -> PyResult<Self> {
        let brackets = "{ \\" (";
        Self::of(values, |value: f64| -> f64 { value })
    }

    #[getter]
    fn pairs(&self) -> [(usize, Option<Self>); 2] {
        inner()
    }

    #[classattr]
    #[pyo3(name = "COUNT")]
    const SAMPLE_COUNT: usize = 3;

    fn names(&self, #[pyo3(from_py_with = whole)] index: Option<usize>, names: Names<'_>) -> OrderedDict<String, Array> {}
}

#[pyfunction(name = "_sum")]
pub(crate) fn sum(samples: ListOf<'_, PySample>) {}
"""


def test_types_of_rust_as_python_has_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(ROOT / "tools")
    rust_types = importlib.import_module("rust_types")
    (tmp_path / "sample.rs").write_text(RUST, "utf-8")
    module = rust_types.read(tmp_path)
    assert module.comparable == {"Sample"}
    members = {**module.members["Sample"], **module.functions}
    assert {name: member.kind for name, member in members.items()} == {
        "__new__": "new",
        "pairs": "getter",
        "COUNT": "classattr",
        "names": "method",
        "_sum": "function",
    }
    types = {
        name: [module.python_type(kind, "Sample", "Any", True) for kind in member.parameters.values()]
        + [module.python_type(member.returned, "Sample", None, False)]
        for name, member in members.items()
    }
    assert types == {
        "__new__": ["ArrayLike", "Any", "Sample | None", "Sample"],
        "pairs": ["list[tuple[int, Sample | None]]"],
        "COUNT": ["int"],
        "names": ["int | None", "Sequence[tuple[str, Any]]", "dict[str, NDArray[np.float64]]"],
        "_sum": ["Sample | Sequence[Sample]", "None"],
    }
    with pytest.raises(KeyError, match="Unheard"):
        module.python_type("Option<Unheard>", "Sample", None, True)


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
