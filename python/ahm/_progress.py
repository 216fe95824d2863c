"""Progress reports: the argument `progress` is None, True (a progress bar), or a callable."""

from __future__ import annotations

import contextlib
import sys
from typing import Any, Callable, Iterator, Optional, Union

Progress = Union[None, bool, Callable[[str, float], Any]]


class _Line:
    """Progress as one line on stderr that is overwritten. Used if tqdm is not installed."""

    def __init__(self) -> None:
        self.width = 0

    def __call__(self, stage: str, fraction: float) -> None:
        if sys.stderr is None:  # programs without a console
            return
        text = f"\r{stage}: {100 * fraction:3.0f} %"
        sys.stderr.write(text.ljust(self.width))
        sys.stderr.flush()
        self.width = len(text)

    def close(self) -> None:
        if self.width:
            sys.stderr.write("\n")


class _Bar:
    def __init__(self, tqdm: Any) -> None:
        self.bar = tqdm(total=1.0, bar_format="{desc}: {percentage:3.0f}%|{bar}| {elapsed}")

    def __call__(self, stage: str, fraction: float) -> None:
        self.bar.set_description_str(stage, refresh=False)
        self.bar.n = fraction
        self.bar.refresh()

    def close(self) -> None:
        self.bar.close()


@contextlib.contextmanager
def reporting(progress: Progress) -> Iterator[Optional[Callable[[str, float], Any]]]:
    if progress is None or progress is False:
        yield None
    elif progress is True:
        try:
            from tqdm.auto import tqdm

            shown: Any = _Bar(tqdm)
        except ImportError:
            shown = _Line()
        try:
            yield shown
        finally:
            shown.close()
    elif callable(progress):
        yield progress
    else:
        raise TypeError(f"progress: expected None, True or a callable, got {type(progress).__name__}")
