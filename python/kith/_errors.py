"""What goes wrong, with its place and what helps."""

from __future__ import annotations

from typing import NamedTuple, Optional


class Diagnostic(NamedTuple):
    """One thing that is wrong with a file or a setting."""

    id: str
    """Its name, such as "E0312", which stays the same."""
    message: str
    file: str
    line: Optional[int]
    column: Optional[int]
    help: str
    """What helps; may be empty."""


class Error(Exception):
    """kith cannot do what it was asked.

    str() says what, where and what helps. Wrong arguments raise Python's own ValueError, TypeError and IndexError.
    """

    def __init__(self, text: str, kind: str = "usage", diagnostics: Optional[list[Diagnostic]] = None) -> None:
        super().__init__(text)
        self.kind = kind
        """"usage", "invalid-input", "infeasible", "io", "partial", "mismatch" or "busy"."""
        self.diagnostics: list[Diagnostic] = list(diagnostics or [])
        """Everything that is wrong, in the order of the file; may be empty."""

    def __reduce__(self) -> tuple[type[Error], tuple[str, str, list[Diagnostic]]]:
        return type(self), (str(self), self.kind, self.diagnostics)

    @property
    def id(self) -> str:
        """Of the first diagnostic, such as "E0312"; empty if there is none."""
        return self.diagnostics[0].id if self.diagnostics else ""

    @property
    def place(self) -> str:
        """Of the first diagnostic: "FILE:LINE:COLUMN", as far as it is known."""
        if not self.diagnostics:
            return ""
        first = self.diagnostics[0]
        return ":".join(str(part) for part in (first.file, first.line, first.column) if part)

    @property
    def help(self) -> str:
        """Of the first diagnostic that has any; may be empty."""
        return next((one.help for one in self.diagnostics if one.help), "")


class Warning(UserWarning):  # noqa: A001
    """What kith thinks worth saying about a file or a run that it accepts."""
