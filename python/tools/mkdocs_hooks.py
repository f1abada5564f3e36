"""Hooks of MkDocs: the first page, links out of the pages' folder, and pages of all classes and functions."""

from __future__ import annotations

import posixpath
import re
import sys
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File

ROOT = Path(__file__).parents[2]
SOURCE = "https://github.com/basemat/basemat/blob/main/"
CODE_STYLE = """
.md-typeset pre > code { white-space: pre-wrap; overflow-wrap: anywhere }
.md-typeset table:not([class]) code { overflow-wrap: anywhere }
"""
"""Lines of code break where the page is narrower, and do not scroll."""
sys.path.insert(0, str(Path(__file__).parent))
from reference import Reference  # noqa: E402

REFERENCE = Reference()


def on_config(config: Any) -> Any:
    """Adds the pages of the reference to the navigation, in their groups."""
    groups = []
    for title, names in REFERENCE.groups.items():
        groups.append({title: [{name: f"api/{REFERENCE.page_of[name]}"} for name in names]})
    config.nav.append({"Reference": ["api/index.md", *groups]})
    return config


def on_files(files: Any, config: Any) -> Any:
    """Adds the README as the first page, the table of warnings, and the pages of all classes and functions."""
    readme = (ROOT / "python" / "README.md").read_text("utf-8")
    pages = f"{SOURCE}docs/python/"
    files.append(File.generated(config, "index.md", content=readme.replace(pages, "")))
    files.append(File.generated(config, "warnings.md", content=warnings_of_runs()))
    files.append(File.generated(config, "assets/site.css", content=CODE_STYLE))
    for path, text in REFERENCE.pages.items():
        files.append(File.generated(config, path, content=text))
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
