"""What the tests of the wires say to a model, and how they say it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from tests.dialects import DIALECTS, Dialect, Said, uri
from tests.fake_provider import Answers, FakeProvider, Json

from adamo_vh.action import Drop, Look, Pick, ToolSchema, Walk, tool_schema
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    SystemMessage,
    TextPart,
    ToolCall,
)
from adamo_vh.inference.model import Reply, Sampling
from adamo_vh.inference.remote.provider import ProviderModel
from adamo_vh.inference.remote.retry import RetryPolicy

TOOLS = [tool_schema(action) for action in (Look, Walk, Pick, Drop)]
FIRST = ImagePart(b"\xff\xd8\xff\xe0 first frame", "image/jpeg", 1920, 1080)
SECOND = ImagePart(b"\x89PNG second frame", "image/png", 640, 360)
ASK: tuple[Message, ...] = (
    SystemMessage("You live in a body."),
    SystemMessage("Plate_57 at (0.2, -1.0, 0.8)."),
    HumanMessage((TextPart("Pick the plate"), FIRST)),
)
QUICK = RetryPolicy(max_tries=3, max_wait_s=5.0, base_s=0.001, timeout_s=5.0)
NAMES = [dialect.name for dialect in DIALECTS]
"""Names of the wires, for the ids of tests."""


def calls(*ids: str, kept: str = "") -> AIMessage:
    """An answer that looked about, once for each id."""
    looks = [ToolCall(id, "Look", {"x": 0.5, "y": n, "z": 1}) for n, id in enumerate(ids)]
    return AIMessage("I look.", tuple(looks), kept)


@dataclass(frozen=True)
class Told:
    """What a model answered, and what its server received for it."""

    reply: Reply
    requests: list[Json]
    paths: list[str]
    model: ProviderModel
    dialect: Dialect

    def said(self, *kinds: str, request: int = -1) -> list[Said]:
        """What a request said, of some kinds or of all."""
        pieces = self.dialect.read(self.requests[request])
        return [piece for piece in pieces if not kinds or piece.kind in kinds]


def tell(
    dialect: Dialect,
    answers: Answers,
    messages: Sequence[Message] = ASK,
    *,
    tools: Sequence[ToolSchema] = TOOLS,
    sampling: Sampling | None = None,
    retry: RetryPolicy = QUICK,
    refused: Iterable[str] = (),
    schema: ToolSchema | None = None,
) -> Told:
    """Ask a server that speaks a dialect."""
    with (
        FakeProvider(answers) as server,
        ProviderModel(uri(dialect, server), retry, refused) as model,
    ):
        reply = model.complete(messages, tools, sampling or Sampling(), schema=schema)
        return Told(reply, server.requests, server.paths, model, dialect)
