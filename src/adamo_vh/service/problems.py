"""How a fault is told to who asked: a status, a word for programs, and a sentence for people."""

from __future__ import annotations

from adamo_vh.action_server.wire import Failed, Problem
from adamo_vh.errors import (
    AdamoError,
    ConfigError,
    EngineError,
    EpisodeOverError,
    RecordError,
    SceneError,
)
from adamo_vh.service.hosting import NoSessionError
from adamo_vh.session.pooling import BusyError


class JudgeOnlyError(AdamoError):
    """Only a judge is told this."""

    def __init__(self) -> None:
        super().__init__("Only a judge may ask this: send the judge's token as bearer token.")


_KINDS: tuple[tuple[type[AdamoError], int, str], ...] = (
    (NoSessionError, 404, "not_found"),
    (EpisodeOverError, 409, "episode_over"),
    (JudgeOnlyError, 403, "judge_only"),
    (BusyError, 503, "busy"),
    (EngineError, 500, "engine_error"),
    (RecordError, 409, "not_ended"),
    (SceneError, 400, "invalid_request_error"),
    (ConfigError, 400, "invalid_request_error"),
)


def told(error: Exception) -> tuple[int, Failed]:
    """The HTTP status of a fault, and what is said of it."""
    for kind, status, word in _KINDS:
        if isinstance(error, kind):
            return status, Failed(Problem(str(error), word))
    # Paths and values of ours are nobody's business.
    what = f"A fault of the server, not of yours: {type(error).__name__}."
    return 500, Failed(Problem(what, "server_error"))
