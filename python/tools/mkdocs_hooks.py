"""Hooks of MkDocs: the first page, links out of the pages' folder, and pages of all classes and functions."""

from __future__ import annotations

import posixpath
import re
import tempfile
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File

ROOT = Path(__file__).parents[2]
SOURCE = "https://github.com/basemat/basemat/blob/main/"
MODULES = ("basemat", "basemat.opensees", "basemat.containment")


def on_files(files: Any, config: Any) -> Any:
    """Adds the README as the first page, and the pages that pdoc writes of the docstrings."""
    readme = (ROOT / "python" / "README.md").read_text("utf-8")
    pages = f"{SOURCE}docs/python/"
    files.append(File.generated(config, "index.md", content=readme.replace(pages, "")))
    files.append(File.generated(config, "warnings.md", content=warnings_of_runs()))
    import pdoc

    pdoc.render.configure(docformat="google", show_source=False)
    with tempfile.TemporaryDirectory() as folder:
        pdoc.pdoc(*MODULES, output_directory=Path(folder))
        for page in Path(folder).rglob("*.*"):
            name = page.relative_to(folder).as_posix()
            files.append(File.generated(config, f"api/{name}", content=page.read_text("utf-8")))
    return files


def warnings_of_runs() -> str:
    """The table of warnings in Rust's tutorial, with Python's names."""
    tutorial = (ROOT / "docs" / "tutorial.md").read_text("utf-8")
    section = tutorial.partition("\n## Warnings\n")[2].partition("\nErrors say")[0]
    for name, python_name in {"Midpoint": "TimeScheme.midpoint()", "DissipativeMidpoint": "TimeScheme.dissipative_midpoint()"}.items():
        section = section.replace(f"`{name}`", f"`{python_name}`")
    return f"# Warnings\n{section}"


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Makes links out of the folder links to the repository."""
    page_path = posixpath.join("docs/python", page.file.src_uri)

    markdown = markdown.replace("](../tutorial.md#warnings)", "](warnings.md)")

    def outside(found: re.Match[str]) -> str:
        target = posixpath.normpath(posixpath.join(posixpath.dirname(page_path), found[1]))
        return f"]({found[1]})" if target.startswith("docs/python/") else f"]({SOURCE}{target})"

    return re.sub(r"\]\((\.\./[^)]*)\)", outside, markdown)
