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
SUBJECTS = {
    "Structures": ("Structure", "Mesh", "GmshMesh", "GmshSpaceMesh", "Grid", "Layer", "Storey", "PlanStorey", "DeformedShape"),
    "Soil and ground": ("Ground", "Soil", "SoilProfile", "SoilLayer", "Strip", "Plan", "Trench", "TrenchElements", "NearField"),
    "Laws of the interface": ("InterfaceLaw", "Limits", "Joint", "ShallowFooting"),
    "Springs and materials": ("Hysteresis", "Material", "BeamSection", "Iwan", "DruckerPrager"),
    "Motions": ("FreeField", "Spectrum", "PlaneWave", "SoilColumn", "InclinedWave", "EquivalentLinear"),
    "Simulations and results": ("Simulation", "Summary", "State", "Probe", "Load", "JointResults", "Interaction", "PushOver", "Fragility"),
}
"""Classes of each subject; classes that extend them belong to it."""
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
    pages_of_names = reference_pages()
    files.append(File.generated(config, "reference.md", content=reference_index(pages_of_names)))
    for group in pages_of_names.values():
        for name, page in group.items():
            content = f"::: {name}\n" if name in MODULES else f"::: basemat.{name}\n"
            files.append(File.generated(config, page, content=content))
    sections = [{title: [{name: page} for name, page in group.items()]} for title, group in pages_of_names.items()]
    config.nav.append({"Reference": ["reference.md", *sections]})
    return files


def reference_pages() -> dict[str, dict[str, str]]:
    """Names of the package by subject, with their pages."""
    import basemat

    groups: dict[str, dict[str, str]] = {title: {} for title in (*SUBJECTS, "Other classes", "Functions", "Values", "Modules")}
    heads = {title: tuple(getattr(basemat, name) for name in names) for title, names in SUBJECTS.items()}
    for name in basemat.__all__:
        item = getattr(basemat, name)
        if inspect.isclass(item):
            title = next((title for title, classes in heads.items() if issubclass(item, classes)), "Other classes")
            groups[title][name] = f"reference/{name}.md"
        elif callable(item):
            # Some systems take `Fragility` and `fragility` for the same file.
            groups["Functions"][name] = f"reference/functions/{name}.md"
        else:
            groups["Values"][name] = f"reference/{name}.md"
    groups["Modules"] = {name: f"reference/{name}.md" for name in MODULES}
    return groups


def reference_index(pages_of_names: dict[str, dict[str, str]]) -> str:
    """Page with a line for each name."""
    import basemat

    lines = ["# Reference"]
    for title, group in pages_of_names.items():
        lines += ["", f"## {title}", "", "| | |", "|---|---|"]
        for name, page in group.items():
            item = importlib.import_module(name) if name in MODULES else getattr(basemat, name)
            summary = "" if title == "Values" else (inspect.getdoc(item) or "").partition("\n\n")[0]
            lines.append(f"| [`{name}`]({page}) | {' '.join(summary.split()).replace('|', '&#124;')} |")
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
