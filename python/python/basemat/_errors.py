"""Exceptions and warnings of the package."""

import re as _re

__all__ = ["BasematWarning", "CheckpointError", "Error", "FileError", "InputError", "StepError"]


class Error(Exception):
    """Any fault that basemat reports."""


class InputError(Error, ValueError):
    """A part of a scene that is out of its range, or does not fit the others."""

    def add_note(self, note: str) -> None:
        """Takes a note into the text; of the argument that was refused, which PyO3 notes, the name."""
        name = _re.fullmatch(r"while processing '(\w+)'", note)
        self.args = (f"{name[1]}: {self}" if name else f"{self}\n{note}",)


class FileError(Error):
    """A file that cannot be read or written."""


class CheckpointError(Error):
    """A run that could not be saved or resumed."""


class StepError(Error, RuntimeError):
    """A step that could not be solved; the simulation stays at the last accepted one.

    ``step`` is its number, from 1, and ``time`` that at its end (s).
    """

    step: int
    time: float


class BasematWarning(UserWarning):
    """What a user should know of a run that is no error: ``warnings`` filters it by this class."""


for _name in __all__:
    globals()[_name].__module__ = "basemat"
