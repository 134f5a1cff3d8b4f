"""A bar on the terminal or in a notebook."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import Callable, Optional, Union

OnProgress = Callable[[int, int, int], object]
Progress = Union[bool, str, OnProgress, None]


def _in_notebook() -> bool:
    shell = sys.modules.get("IPython")
    return shell is not None and type(shell.get_ipython()).__name__ == "ZMQInteractiveShell"


class Bar:
    """Shows how far work is; `callback` is what the work calls, None if nobody wants to know.

    progress: "auto" or True (a bar where somebody can see it), False or None, or a function of done, total, failed.
    """

    WIDTH = 30

    def __init__(self, progress: Progress, what: str) -> None:
        self._what = what
        self._begin = time.monotonic()
        self._drawn = False
        self.callback: Optional[OnProgress] = None
        if callable(progress):
            self.callback = progress
        elif progress not in (True, False, None, "auto"):
            raise TypeError("progress is 'auto', True, False or a function of done, total, failed")
        elif progress and (progress is True or sys.stderr.isatty() or _in_notebook()):
            self.callback = self._draw

    def _draw(self, done: int, total: int, failed: int) -> None:
        filled = self.WIDTH * done // max(total, 1)
        seconds = time.monotonic() - self._begin
        rest = f", about {seconds / done * (total - done):.0f} s left" if done and done < total else ""
        wrong = f", {failed} failed" if failed else ""
        bar = "#" * filled + "." * (self.WIDTH - filled)
        sys.stderr.write(f"\r{self._what} [{bar}] {done}/{total}{wrong}{rest}   ")
        sys.stderr.flush()
        self._drawn = True

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, kind: Optional[type[BaseException]], error: Optional[BaseException],
                 trace: Optional[TracebackType]) -> None:
        if self._drawn:
            sys.stderr.write("\n")
