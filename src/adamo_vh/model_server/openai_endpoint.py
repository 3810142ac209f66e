"""Any local model as an OpenAI-compatible endpoint: chat completions with pictures and tools."""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass, field
from typing import Any

from fastapi import FastAPI, Request, Response
from fastapi.responses import JSONResponse, StreamingResponse
from starlette.exceptions import HTTPException

from adamo_vh.errors import AdamoError, CassetteError
from adamo_vh.inference.messages import AIMessage
from adamo_vh.inference.model import Model
from adamo_vh.model_server import toolless
from adamo_vh.model_server.broken_connections import HalfBody, Hang, Reset
from adamo_vh.model_server.fault_rules import Faults, Rule, What
from adamo_vh.model_server.injected_faults import GARBAGE, error_message, is_as_it_is, spoiled
from adamo_vh.model_server.json_fields import BadRequest
from adamo_vh.model_server.openai_messages import ChatRequest, read_request
from adamo_vh.model_server.openai_replies import (
    Answer,
    Json,
    completion_body,
    completion_events,
    error_body,
    estimated_usage,
    fitted,
)
from adamo_vh.model_server.probe_answers import answer_to_probe
from adamo_vh.serving.admission import Rules
from adamo_vh.serving.edge import Edge

MAX_BODY_BYTES = 64 * 1024 * 1024
"""A larger request is answered with status 413."""


@dataclass(frozen=True, slots=True)
class Served:
    """One answered request, for those who watch."""

    number: int
    status: int
    """Status of the answer; 0 if the connection was broken on purpose."""
    text: str
    """What happened, in a few words."""


@dataclass(frozen=True, slots=True)
class Service:
    """What is served, and how."""

    model: Model
    tools: bool = True
    """Whether the model can call tools; otherwise it writes its calls as text."""
    faults: Faults = field(default_factory=Faults)
    max_body_bytes: int = MAX_BODY_BYTES
    watch: Callable[[Served], None] | None = None
    """Is told of every request."""


def create_app(service: Service) -> Edge:
    """Make the web application, behind its edge.

    Args:
        service: What is served.
    """
    app = FastAPI(title=f"ADAMO serves {service.model.info.name}", openapi_url=None)
    endpoint = _Endpoint(service)

    @app.exception_handler(HTTPException)
    async def failed(request: Request, error: HTTPException) -> Response:
        text = str(error.detail)
        if error.status_code in (404, 405):
            text = (
                f"There is no {request.method} {request.url.path}; see POST /v1/chat/completions."
            )
        return _json(error.status_code, error_body(text, "invalid_request_error"))

    @app.post("/v1/chat/completions")
    async def chat(request: Request) -> Response:
        return await endpoint.chat(request)

    @app.get("/v1/models")
    async def models() -> Json:
        return {"object": "list", "data": [_card(service.model)]}

    @app.get("/v1/models/{name:path}")
    async def model(name: str) -> Json:
        return {**_card(service.model), "id": name}

    @app.get("/health")
    async def health() -> Json:
        known = service.model.info
        return {"status": "ok", "model": known.name, "kind": known.kind, "tools": service.tools}

    rules = Rules(service.max_body_bytes, too_large="send fewer or smaller pictures.")
    return Edge(app, rules)


class _Endpoint:
    """Answers chat completions, one at a time: models may keep a place in a script."""

    def __init__(self, service: Service) -> None:
        self._service = service
        self._requests = 0
        self._turn = asyncio.Lock()

    async def chat(self, request: Request) -> Response:
        self._requests += 1
        number = self._requests
        try:
            asked = read_request(_json_of(await request.body()))
            rule = self._service.faults.meeting(number, asked.parameters)
            if rule is not None and (broken := _instead(rule, asked)) is not None:
                self._tell(number, getattr(broken, "status_code", 0), f"fault: {rule.what}")
                return broken
            if rule is not None and rule.what is What.SLOW:
                await asyncio.sleep(rule.seconds or 0.0)
            answer = await self._answer(number, asked, rule)
        except BadRequest as error:
            body = error_body(str(error), "invalid_request_error", error.field)
            return self._failed(number, 400, body)
        except CassetteError as error:
            # A cassette was asked something else than what it recorded: no retry helps.
            return self._failed(number, 400, error_body(str(error), "invalid_request_error"))
        except Exception as error:
            # The edge of the server: whatever a model raises, the client hears of it in JSON.
            name = "" if isinstance(error, AdamoError) else f"{type(error).__name__}: "
            body = error_body(f"The model cannot answer: {name}{error}", "server_error")
            return self._failed(number, 500, body)
        self._tell(number, 200, _words(answer.message, rule))
        return _sent(answer, asked)

    async def _answer(self, number: int, asked: ChatRequest, rule: Rule | None) -> Answer:
        service = self._service
        given = toolless.conversation(asked, service.tools, service.faults.without_tools)
        probed = answer_to_probe(given.messages, given.tools)
        said = await self._asked(asked, given) if probed is None else probed
        message = said if rule is None else spoiled(said, rule)
        if rule is None or not is_as_it_is(said, rule):
            message = toolless.written(message, given.form)
        message, is_cut = fitted(message, asked.most_tokens)
        usage = estimated_usage(service.model.info.name, asked.messages, asked.tools, message)
        return Answer(number, asked.model, message, usage, is_cut)

    async def _asked(self, asked: ChatRequest, given: toolless.Conversation) -> AIMessage:
        async with self._turn:
            reply = await asyncio.to_thread(
                self._service.model.complete, given.messages, given.tools, asked.sampling
            )
        return reply.message

    def _failed(self, number: int, status: int, body: Json) -> Response:
        self._tell(number, status, body["error"]["message"])
        return _json(status, body)

    def _tell(self, number: int, status: int, text: str) -> None:
        if self._service.watch is not None:
            self._service.watch(Served(number, status, text))


def _json_of(body: bytes) -> Any:
    try:
        return json.loads(body)
    except (ValueError, RecursionError) as error:
        raise BadRequest("body", f"it is not valid JSON: {error}.") from None


def _instead(rule: Rule, asked: ChatRequest) -> Response | None:
    """What is sent in place of an answer; None if the model is to answer."""
    text = error_message(rule)
    match rule.what:
        case What.ERROR:
            status = rule.status or 500
            wait = rule.retry_after_s
            headers = {} if wait is None else {"Retry-After": str(wait)}
            return _json(status, error_body(text, _error_kind(status)), headers)
        case What.ERROR_IN_200:
            return _json(200, error_body(text, "server_error"))
        case What.REFUSED_PARAMETER:
            code = "unsupported_parameter"
            return _json(400, error_body(text, "invalid_request_error", rule.parameter, code))
        case What.BAD_JSON:
            return Response(GARBAGE, media_type="application/json")
        case What.HANG:
            return Hang(rule.seconds or 0.0)
        case What.RESET:
            return Reset()
        case What.HALF_BODY:
            return HalfBody()
    return None


def _error_kind(status: int) -> str:
    if status >= 500:
        return "server_error"
    return "rate_limit_error" if status == 429 else "invalid_request_error"


def _sent(answer: Answer, asked: ChatRequest) -> Response:
    if not asked.stream:
        return _json(200, completion_body(answer))

    async def events() -> AsyncIterator[str]:
        for event in completion_events(answer, asked.stream_usage):
            yield event

    return StreamingResponse(events(), media_type="text/event-stream")


def _json(status: int, body: Json, headers: dict[str, str] | None = None) -> Response:
    return JSONResponse(body, status, headers)


def _card(model: Model) -> Json:
    return {"id": model.info.name, "object": "model", "created": 0, "owned_by": "adamo"}


def _words(message: AIMessage, rule: Rule | None) -> str:
    said = ", ".join(call.name for call in message.calls) or "text"
    return said if rule is None else f"{said}; fault: {rule.what}"
