"""The MCP server: tools, prompts and resources over the episodes. Knows no transport."""

from __future__ import annotations

import base64
import traceback
from collections.abc import Callable, Mapping
from importlib.metadata import version
from typing import Any, TypeVar

import anyio
import anyio.to_thread
import mcp_types as types
from mcp.server import Server, ServerRequestContext
from mcp.shared.exceptions import MCPError

from adamo_vh.errors import AdamoError, ConfigError, SceneError
from adamo_vh.record.turn import NOTE
from adamo_vh.service.mcp.episodes import Episodes, Watch
from adamo_vh.service.mcp.offer import ANSWER, END, EPISODE, INSTRUCTIONS, LONGEST, LOOK_AGAIN, NEW
from adamo_vh.service.mcp.prompts import render
from adamo_vh.service.mcp.shown import content, instructions, instructions_uri, read_uri, text
from adamo_vh.session.outside import ENDED, OutsideEpisode
from adamo_vh.session.pooling import BusyError

_T = TypeVar("_T")
Context = ServerRequestContext[Any, Any]
Blocks = list[types.ContentBlock]
_THREADS = 64
"""Calls that are carried out or wait at once."""
_FAULT = "The server failed here; that is no fault of yours. Try again, or begin a new episode."


def create_server(episodes: Episodes, watch: Watch = lambda line: None) -> Server[Any]:
    """An MCP server for the episodes.

    Args:
        episodes: What is played; not closed.
        watch: Is told what goes wrong, for whoever runs the server.
    """
    face = _Face(episodes, watch)
    return Server(
        "adamo-vh",
        version=version("adamo-vh"),
        title="ADAMO",
        instructions=render("server", episode=episodes.fixed, finish=episodes.offer.finish),
        get_tool_input_schema=face.schemas.get,
        on_list_tools=face.list_tools,
        on_call_tool=face.call_tool,
        on_list_prompts=face.list_prompts,
        on_get_prompt=face.get_prompt,
        on_list_resources=face.list_resources,
        on_list_resource_templates=face.list_resource_templates,
        on_read_resource=face.read_resource,
    )


class _ToldError(Exception):
    """What a client is told instead of a result."""


class _Face:
    """Answers requests; what takes time is done in threads."""

    def __init__(self, episodes: Episodes, watch: Watch) -> None:
        self._episodes = episodes
        self._watch = watch
        self._threads = anyio.CapacityLimiter(_THREADS)
        self._tools = episodes.offer.tools()
        self.schemas: Mapping[str, Mapping[str, Any]] = {t.name: t.parameters for t in self._tools}
        """The arguments of each tool; asked for at every call."""

    async def list_tools(
        self, context: Context, params: types.PaginatedRequestParams | None
    ) -> types.ListToolsResult:
        """The body's tools, and those beside them."""
        free = (LOOK_AGAIN, INSTRUCTIONS)
        return types.ListToolsResult(
            tools=[
                types.Tool(
                    name=tool.name,
                    description=tool.description,
                    input_schema=tool.parameters,
                    annotations=types.ToolAnnotations(
                        read_only_hint=tool.name in free, open_world_hint=False
                    ),
                )
                for tool in self._tools
            ]
        )

    async def call_tool(
        self, context: Context, params: types.CallToolRequestParams
    ) -> types.CallToolResult:
        """Carry a call out. What is wrong with it is told in the result."""
        client, given = self._client(context), dict(params.arguments or {})
        try:
            blocks = await self._in_thread(lambda: self._called(params.name, given, client))
        except _ToldError as failed:
            return types.CallToolResult(content=[text(str(failed))], is_error=True)
        return types.CallToolResult(content=blocks)

    async def list_prompts(
        self, context: Context, params: types.PaginatedRequestParams | None
    ) -> types.ListPromptsResult:
        """One: the instructions of an episode."""
        which = types.PromptArgument(
            name=EPISODE, description="Id of the episode.", required=not self._episodes.fixed
        )
        told = "What an episode asks for, and how its world works."
        prompt = types.Prompt(name=INSTRUCTIONS, description=told, arguments=[which])
        return types.ListPromptsResult(prompts=[prompt])

    async def get_prompt(
        self, context: Context, params: types.GetPromptRequestParams
    ) -> types.GetPromptResult:
        """The instructions as the first message of a conversation."""
        if params.name != INSTRUCTIONS:
            raise MCPError(types.INVALID_PARAMS, f"There is no such prompt; use {INSTRUCTIONS}.")
        name = (params.arguments or {}).get(EPISODE, self._episodes.fixed)
        told = await self._asked(lambda: self._instructions(name, self._client(context)))
        return types.GetPromptResult(
            messages=[types.PromptMessage(role="user", content=text(told))]
        )

    async def list_resources(
        self, context: Context, params: types.PaginatedRequestParams | None
    ) -> types.ListResourcesResult:
        """The instructions of the one episode that is set up; others are known by their ids."""
        fixed = self._episodes.fixed
        resource = types.Resource(
            name=INSTRUCTIONS, uri=instructions_uri(fixed), mime_type="text/markdown"
        )
        return types.ListResourcesResult(resources=[resource] if fixed else [])

    async def list_resource_templates(
        self, context: Context, params: types.PaginatedRequestParams | None
    ) -> types.ListResourceTemplatesResult:
        """Instructions and frames."""
        whole = "adamo://episode/{episode}"
        kinds = ((INSTRUCTIONS, f"{whole}/instructions"), ("frame", f"{whole}/frame/{{name}}"))
        return types.ListResourceTemplatesResult(
            resource_templates=[
                types.ResourceTemplate(name=name, uri_template=uri) for name, uri in kinds
            ]
        )

    async def read_resource(
        self, context: Context, params: types.ReadResourceRequestParams
    ) -> types.ReadResourceResult:
        """Instructions as text, or a frame as it was drawn."""
        uri = str(params.uri)
        if (found := read_uri(uri)) is None:
            raise MCPError(types.INVALID_PARAMS, "There is no such resource.")
        name, frame = found
        contents: types.TextResourceContents | types.BlobResourceContents
        if frame:
            data, kind = await self._asked(lambda: self._episodes.frame(name, frame))
            blob = base64.b64encode(data).decode()
            contents = types.BlobResourceContents(uri=uri, mime_type=kind, blob=blob)
        else:
            told = await self._asked(lambda: self._instructions(name, self._client(context)))
            contents = types.TextResourceContents(uri=uri, mime_type="text/markdown", text=told)
        return types.ReadResourceResult(contents=[contents])

    async def _asked(self, work: Callable[[], _T]) -> _T:
        """What is no tool has no result to tell of a mistake in."""
        try:
            return await self._in_thread(work)
        except _ToldError as failed:
            raise MCPError(types.INVALID_PARAMS, str(failed)) from None

    async def _in_thread(self, work: Callable[[], _T]) -> _T:
        """Do what may wait.

        Raises:
            _ToldError: It cannot be done, in words that a player may read.
        """
        try:
            return await anyio.to_thread.run_sync(work, limiter=self._threads)
        except _ToldError:
            raise
        except (ConfigError, SceneError, BusyError) as error:
            raise _ToldError(str(error)) from None
        except AdamoError as error:
            # What is wrong with a run folder is for whoever runs the server.
            self._watch(f"fault: {error}")
            raise _ToldError(_FAULT) from None
        except Exception:
            self._watch(f"fault: {traceback.format_exc()}")
            raise _ToldError(_FAULT) from None

    def _called(self, tool: str, given: dict[str, Any], client: str) -> Blocks:
        if tool == NEW and not self._episodes.fixed:
            name, begun = self._episodes.begin(client, given)
            return [text(instructions(name, begun)), *content(name, begun.view())]
        name = _text_of(given, EPISODE)
        episode = self._episodes.find(name, client)
        if episode is None:
            return [text(ENDED)]
        if tool == INSTRUCTIONS:
            return [text(_told(name, episode))]
        if tool == LOOK_AGAIN:
            return content(name, episode.view())
        if tool == END and self._episodes.offer.finish == END:
            answer = _text_of(given, ANSWER)
            return content(name, episode.answer(answer, client))
        note = ""
        if not episode.config.profile.note_argument:
            note = _text_of(given, NOTE, needed=False)
        return content(name, episode.call(tool, given, note, client))

    def _client(self, context: Context) -> str:
        """Who plays: what the client calls itself, unless it is known; empty if neither."""
        params = context.session.client_params
        return self._episodes.offer.player or ("" if params is None else params.client_info.name)

    def _instructions(self, name: str, client: str) -> str:
        episode = self._episodes.find(name, client)
        return ENDED if episode is None else _told(name, episode)


def _told(name: str, episode: OutsideEpisode) -> str:
    return ENDED if episode.ended else instructions(name, episode)


def _text_of(given: dict[str, Any], name: str, *, needed: bool = True) -> str:
    """Take a text out of the arguments.

    Raises:
        _ToldError: It is missing, or no text, or too long.
    """
    value = given.pop(name, None)
    if value is None and not needed:
        return ""
    if not isinstance(value, str):
        raise _ToldError(f"{name} is missing or no text; give it.")
    if len(value) > LONGEST:
        raise _ToldError(f"{name} has {len(value)} characters; use at most {LONGEST}.")
    return value
