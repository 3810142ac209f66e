"""Who is told of what happens, and what becomes of their faults."""

from __future__ import annotations

import traceback
import warnings
from collections.abc import Sequence

from adamo_vh.errors import AdamoError
from adamo_vh.observation import Frame
from adamo_vh.record.trajectory import Event, Observer


class Telling:
    """Tells everybody of every event, the records first.

    A fault of a record, or of a guard, is a fault of the episode. One of an observer, who only
    shows what happens, is reported once and ends nothing.
    """

    def __init__(self, records: Sequence[Observer], observers: Sequence[Observer]) -> None:
        """Set who is told.

        Args:
            records: Must take note of every event.
            observers: Show and count; may fail.
        """
        self._records = tuple(records)
        self._observers = tuple(observers)
        self._reported: set[int] = set()

    def tell(self, event: Event, frame: Frame | None = None) -> None:
        """Tell of an event; `frame` is its picture, if it has one."""
        for record in self._records:
            record.notify(event, frame)
        for number, observer in enumerate(self._observers):
            try:
                observer.notify(event, frame)
            except Exception as error:
                if number not in self._reported:
                    self._reported.add(number)
                    who = type(observer).__name__
                    warnings.warn(
                        f"{who} failed, and the episode goes on: {fault(error)}", stacklevel=2
                    )


def fault(error: Exception) -> str:
    """A fault in one line: what it says and, if nobody foresaw it, where it came from."""
    text = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
    if isinstance(error, AdamoError):
        return text
    place = traceback.extract_tb(error.__traceback__)[-1:]
    where = "".join(f" ({one.name}, {one.filename}, line {one.lineno})" for one in place)
    return f"{' '.join(text.split())}{where}"
