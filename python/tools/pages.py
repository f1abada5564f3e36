"""Runs the programs of the pages in `docs/python` and writes their pictures to `docs/python/images`.

    python tools/pages.py
"""

from __future__ import annotations

import os
import re
import shutil
import sys
import tempfile
from pathlib import Path
from typing import Any

DOCS = Path(__file__).parents[2] / "docs" / "python"
PAGES = sorted(DOCS.rglob("*.md"))


def programs(page: Path) -> list[str]:
    """The programs of a page, each of which uses names of those before it."""
    return re.findall(r"^```python\n(.*?)^```", page.read_text("utf-8"), re.M | re.S)


def run(page: Path, folder: Path) -> dict[str, Any]:
    """Runs the programs of a page in a folder; their names."""
    import matplotlib.pyplot

    matplotlib.use("agg")
    # Protocols and dataclasses look for the module of a class.
    names: dict[str, Any] = {"__name__": "__main__"}
    before = Path.cwd()
    os.chdir(folder)
    try:
        for number, program in enumerate(programs(page)):
            exec(compile(program, f"{page.name}, program {number + 1}", "exec"), names)
    finally:
        os.chdir(before)
        matplotlib.pyplot.close("all")
    return names


def main() -> None:
    """Writes the pictures."""
    images = DOCS / "images"
    images.mkdir(exist_ok=True)
    for page in PAGES:
        with tempfile.TemporaryDirectory() as folder:
            run(page, Path(folder))
            for picture in sorted(Path(folder).glob("*.png")):
                print(shutil.copy(picture, images), file=sys.stderr)


if __name__ == "__main__":
    main()
