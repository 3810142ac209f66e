"""Every exception that ADAMO raises on purpose, as one tree.

::

    AdamoError
    ├── ConfigError            a setting or argument of the caller is wrong; nothing was started
    ├── FileError              a file cannot be read or written: names it, the reason and the fix
    ├── SceneError             a scene file is wrong: names the file, the field and the fix
    ├── InvalidActionError     a tool call is no valid action; carries the feedback for the model
    ├── EpisodeOverError       the episode has ended: nothing more is done in it
    ├── EngineError            the world itself failed
    │   └── RenderingError     no OpenGL to draw with
    ├── ModelError             the model could not answer; the episode is unscored
    │   ├── ModelConfigError   unknown model, missing extra, missing key: no retry helps
    │   ├── ProviderError      the provider failed after all retries
    │   │   └── RefusedError   the provider refuses the request as it is: no waiting helps
    │   ├── BudgetError        the budget of a whole study is used up: nothing was asked
    │   └── CassetteError      the recorded calls do not fit what is asked now
    └── RecordError            a run folder is missing, damaged or of another version
        └── FolderInUseError   somebody else writes the run folder now

What a *model* does wrong (an unknown tool, an unseen tag) is never an exception above the agent:
it becomes feedback and the loop goes on.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any


class AdamoError(Exception):
    """Base of all errors; the message names the fix."""


class ConfigError(AdamoError):
    """A setting or argument of the caller is wrong."""


class FileError(AdamoError):
    """A file cannot be read or written, or is not what it should be."""


class SceneError(AdamoError):
    """A scene file is wrong.

    Attributes:
        faults: Everything that is wrong with it: the field, and the problem with its fix.
    """

    def __init__(self, text: str, faults: tuple[tuple[str, str], ...] = ()) -> None:
        super().__init__(text)
        self.faults = faults or (("file", text),)


class InvalidActionError(AdamoError):
    """A tool call is not a valid action.

    Attributes:
        code: Typed reason, one of `adamo_vh.action.Code`.
        call: Name and arguments as they were given, where a whole call was read; None if not.
    """

    call: tuple[str, Mapping[str, Any] | None] | None = None

    def __init__(self, code: str, text: str) -> None:
        super().__init__(text)
        self.code = code


class EpisodeOverError(AdamoError):
    """The episode has ended; nothing was changed."""


class EngineError(AdamoError):
    """The world itself failed; the episode is unscored."""


class RenderingError(EngineError):
    """No OpenGL implementation could be used."""


class ModelError(AdamoError):
    """The model could not answer; the episode is unscored.

    Attributes:
        spent: What was spent before that, an `adamo_vh.inference.model.Spent`; None for nothing.
    """

    spent: Any = None


class ModelConfigError(ModelError):
    """Unknown model, missing extra or missing key; no retry helps."""


class ProviderError(ModelError):
    """The provider failed after all retries.

    Attributes:
        status: The HTTP status of the last failure; None if nothing was answered.
        words: What the server said of it, without keys.
        most_pictures: How many pictures a prompt may hold, if it is about that; None if not.
    """

    def __init__(
        self,
        text: str,
        status: int | None = None,
        words: str = "",
        most_pictures: int | None = None,
    ) -> None:
        super().__init__(text)
        self.status = status
        self.words = words
        self.most_pictures = most_pictures


class RefusedError(ProviderError):
    """The provider refuses the request as it is; unlike a fault, no waiting helps."""


class BudgetError(ModelError):
    """The budget of a whole study is used up: the model was not asked; nothing is broken."""


class CassetteError(ModelError):
    """The recorded calls do not fit what is asked now: names the call and shows the difference."""


class RecordError(AdamoError):
    """A run folder is missing, damaged or of another version."""


class FolderInUseError(RecordError):
    """Somebody else writes the run folder now; says who."""
