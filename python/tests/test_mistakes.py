"""GOAL: the page of mistakes quotes the messages that the package has.
SCENE: each program in its tables.
REFERENCE: the messages beside them on the page.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import pytest

import basemat as bm

sys.path.insert(0, str(Path(__file__).parents[1] / "tools"))
import pages  # noqa: E402

PAGE = pages.DOCS / "mistakes.md"
ROWS = re.findall(r"^\|`(.*?)`\|(.*?)\|(.*)\|$", PAGE.read_text("utf-8"), re.M)
WARNING = "a warning: "


@pytest.fixture(scope="module")
def names() -> dict[str, Any]:
    """Names of the page's program."""
    found: dict[str, Any] = {}
    exec(pages.programs(PAGE)[0], found)
    return found


def test_the_page_has_rows() -> None:
    assert len(ROWS) == len([line for line in PAGE.read_text("utf-8").splitlines() if line.startswith("|`")]) > 25


@pytest.mark.parametrize(("program", "message"), [row[:2] for row in ROWS], ids=range(len(ROWS)))
def test_a_mistake_has_its_message(names: dict[str, Any], program: str, message: str) -> None:
    if "sweep(" in program or "stripes(" in program:
        pytest.importorskip("pandas")
    if "animate(" in program:
        pytest.importorskip("matplotlib")
    if message.startswith(WARNING):
        with pytest.warns(bm.BasematWarning, match=re.escape(message[len(WARNING) :])):
            eval(program, names)
        return
    with pytest.raises((bm.Error, TypeError, KeyError)) as caught:
        eval(program, names)
    assert message in str(caught.value).replace('"', "")
