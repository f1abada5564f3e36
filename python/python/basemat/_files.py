"""Files of results."""

from __future__ import annotations

import hashlib
import os
import secrets
from contextlib import suppress
from pathlib import Path
from typing import Any

from . import _core
from ._errors import FileError

_KINDS = ("Run",)


def replace(path: str | os.PathLike[str], data: bytes) -> None:
    """Writes a file under another name and renames it: the file is then complete, or as it was before."""
    target = os.path.realpath(path)
    temporary = f"{target}.{secrets.token_hex(8)}.tmp"
    try:
        if os.path.exists(target) and not os.path.isfile(target):
            # A pipe or a terminal.
            Path(target).write_bytes(data)
            return
        with open(temporary, "xb") as file:
            file.write(data)
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, target)
    except OSError as error:
        raise FileError(f"{os.fspath(path)} cannot be written: {error.strerror}") from error
    finally:
        with suppress(OSError):
            os.remove(temporary)


def save(self: _core.Run, path: str | os.PathLike[str]) -> None:
    """Writes the run with its time series to a file at ``path``, for `load`.

    The file is for this version of the package; frames, arrays and `Run.summary` are for
    longer keeping.
    """
    # As its pickle has it.
    made: Any = self.__reduce__()
    kind, data = made[1]
    digest = hashlib.sha256(data).hexdigest()
    heading = f"basemat {_core.__version__} {kind} {digest}\n"
    replace(path, heading.encode() + data)


def load(path: str | os.PathLike[str]) -> _core.Run:
    """The `Run` that `Run.save` wrote to the file at ``path``, to the same bits.

    Raises a `FileError` for a file of another version or of something else, and for one that
    was cut off or changed. Unlike a pickle it cannot run anything.
    """
    name = os.fspath(path)
    try:
        heading, _, data = Path(path).read_bytes().partition(b"\n")
    except OSError as error:
        raise FileError(f"{name} cannot be read: {error.strerror}") from error
    words = heading.decode("utf-8", "replace").split(" ")
    if len(words) != 4 or words[0] != "basemat" or words[2] not in _KINDS:
        raise FileError(f"{name} is no file of a run")
    if words[1] != _core.__version__:
        raise FileError(f"{name} is of version {words[1]}, but this is {_core.__version__}")
    if words[3] != hashlib.sha256(data).hexdigest():
        raise FileError(f"{name} is damaged: its check sum does not agree")
    run: Any = _core._restored(words[2], data)
    assert isinstance(run, _core.Run)
    return run
