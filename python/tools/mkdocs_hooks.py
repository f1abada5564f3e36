"""Hooks of MkDocs: the first page, links out of the pages' folder, and a page for each class and function."""

from __future__ import annotations

import importlib
import inspect
import posixpath
import re
from pathlib import Path
from typing import Any

from mkdocs.structure.files import File

ROOT = Path(__file__).parents[2]
SOURCE = "https://github.com/basemat/basemat/blob/main/"
MODULES = ("basemat.opensees", "basemat.containment")
STYLE = """/* Lines of code as wide as the window allows; longer ones break instead of scrolling. */
.md-grid { max-width: 76rem; }
.md-typeset pre > code { white-space: pre-wrap; overflow-wrap: anywhere; }
"""


def on_files(files: Any, config: Any) -> Any:
    """Adds the README as the first page, the warnings, and pages of all classes and functions to the site."""
    readme = (ROOT / "python" / "README.md").read_text("utf-8")
    pages = f"{SOURCE}docs/python/"
    files.append(File.generated(config, "index.md", content=readme.replace(pages, "")))
    files.append(File.generated(config, "warnings.md", content=warnings_of_runs()))
    files.append(File.generated(config, "site.css", content=STYLE))
    reference = reference_names()
    files.append(File.generated(config, "reference.md", content=reference_index(reference)))
    for names in reference.values():
        for name in names:
            content = f"::: {name}\n" if name in MODULES else f"::: basemat.{name}\n"
            files.append(File.generated(config, f"reference/{name}.md", content=content))
    sections = [{title: [f"reference/{name}.md" for name in names]} for title, names in reference.items()]
    config.nav.append({"Reference": ["reference.md", *sections]})
    return files


def reference_names() -> dict[str, list[str]]:
    """Names of the package by kind."""
    import basemat

    kinds: dict[str, list[str]] = {"Classes": [], "Functions": [], "Values": [], "Modules": list(MODULES)}
    for name in basemat.__all__:
        item = getattr(basemat, name)
        kind = "Classes" if inspect.isclass(item) else "Functions" if callable(item) else "Values"
        kinds[kind].append(name)
    return kinds


def reference_index(reference: dict[str, list[str]]) -> str:
    """Page with a line for each name."""
    import basemat

    lines = ["# Reference"]
    for title, names in reference.items():
        lines += ["", f"## {title}", "", "| | |", "|---|---|"]
        for name in names:
            item = importlib.import_module(name) if name in MODULES else getattr(basemat, name)
            summary = "" if title == "Values" else (inspect.getdoc(item) or "").partition("\n\n")[0]
            lines.append(f"| [`{name}`](reference/{name}.md) | {' '.join(summary.split()).replace('|', '&#124;')} |")
    return "\n".join(lines) + "\n"


def warnings_of_runs() -> str:
    """The table of warnings in Rust's tutorial, with Python's names."""
    tutorial = (ROOT / "docs" / "tutorial.md").read_text("utf-8")
    section = tutorial.partition("\n## Warnings\n")[2].partition("\nErrors say")[0]
    for name, python_name in {"Midpoint": "TimeScheme.midpoint()", "DissipativeMidpoint": "TimeScheme.dissipative_midpoint()"}.items():
        section = section.replace(f"`{name}`", f"`{python_name}`")
    section = section.replace("](guide.md", f"]({SOURCE}docs/guide.md")
    return f"# Warnings\n{section}"


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """Makes links out of the folder links to the repository."""
    page_path = posixpath.join("docs/python", page.file.src_uri)

    markdown = markdown.replace("](../tutorial.md#warnings)", "](warnings.md)")

    def outside(found: re.Match[str]) -> str:
        target = posixpath.normpath(posixpath.join(posixpath.dirname(page_path), found[1]))
        return f"]({found[1]})" if target.startswith("docs/python/") else f"]({SOURCE}{target})"

    return re.sub(r"\]\((\.\./[^)]*)\)", outside, markdown)
