"""Our tools for agents that Inspect AI drives itself: a body that waits for their calls."""

from __future__ import annotations

from contextlib import ExitStack
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from adamo_vh.action import ToolSchema
from adamo_vh.action_server import ActionResult
from adamo_vh.adapters.inspect.conversation import chat, offered_tools, parts_of
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.result import EpisodeResult
from adamo_vh.errors import EpisodeOverError
from adamo_vh.inference.messages import HumanMessage, ImagePart, SystemMessage, TextPart
from adamo_vh.observation import Frame
from adamo_vh.record.termination import TerminationReason
from adamo_vh.session.driven import DrivenBody
from adamo_vh.session.pooling import process_engines

if TYPE_CHECKING:
    from inspect_ai.model import ChatMessage, Content, ModelOutput
    from inspect_ai.tool import Tool

_OVER = "The episode has ended; nothing was done."


class Seat:
    """A body in its room, for one sample."""

    def __init__(self, config: EpisodeConfig, folder: Path | None, player: str) -> None:
        """Begin an episode.

        Args:
            config: How it is set up.
            folder: Its run folder; a temporary one by default.
            player: Who decides, as the record calls him.
        """
        with ExitStack() as stack:
            place = folder or Path(stack.enter_context(TemporaryDirectory(prefix="adamo-vh-")))
            world = stack.enter_context(process_engines().lent(config))
            out = folder or place / "run"
            self.body = DrivenBody.begin(config, out, player=player, engine=world, page=False)
            stack.callback(self.body.close)
            self._closing = stack.pop_all()

    def opening(self) -> list[ChatMessage]:
        """What an agent is told at first: the rules, the instruction, the view and the state."""
        seen = self.body.observe().observation
        parts = [TextPart(self.body.instruction), TextPart(self.body.state_text())]
        words = [part for part in parts if part.text]
        return chat(
            [SystemMessage(self.body.system_prompt), HumanMessage((*words, _image(seen.frame)))]
        )

    def tools(self) -> list[Tool]:
        """The tools of the profile, for any agent of Inspect."""
        return [self._tool(tool) for tool in self.body.tools]

    def finish(self, output: ModelOutput) -> EpisodeResult:
        """End the episode, unless it has ended, and score it.

        Args:
            output: What the agent said at last; with a call of ours in it, it was cut off.
        """
        if not self.body.expire():
            own = {tool.name for tool in self.body.tools}
            last = output.message.tool_calls if output.choices else None
            if any(call.function in own for call in last or ()):
                self.body.finish("", TerminationReason.BUDGET, "a limit of Inspect was reached")
            else:
                self.body.finish(output.completion)
        return self.body.result()

    def close(self) -> None:
        """Leave the room."""
        self._closing.close()

    def _tool(self, tool: ToolSchema) -> Tool:
        from anyio import to_thread
        from inspect_ai.tool import ToolDef

        (info,) = offered_tools([tool])

        # Inspect reads these very annotations, and hands whatever comes to `kwargs: Any`.
        async def execute(**kwargs: Any) -> Any:
            return await to_thread.run_sync(partial(self._call, tool.name, kwargs))

        made = ToolDef(
            execute, name=info.name, description=info.description, parameters=info.parameters
        )
        found: Tool = made.as_tool()
        return found

    def _call(self, name: str, arguments: dict[str, Any]) -> list[Content]:
        try:
            done = self.body.call(name, arguments)
        except EpisodeOverError:
            return parts_of([TextPart(_OVER)])
        return parts_of([TextPart(self._told(done)), *self._pictures(done)])

    def _told(self, done: ActionResult) -> str:
        state = "" if self.body.ended else self.body.state_text()
        over = "The episode has ended." if self.body.ended else ""
        return "\n\n".join(text for text in (done.feedback.text, over, state) if text)

    def _pictures(self, done: ActionResult) -> list[ImagePart]:
        view = done.observation
        if view is None and self.body.config.profile.fresh_view and not self.body.ended:
            view = self.body.observe().observation
        shown = [*done.pictures, *([view.frame] if view is not None else [])]
        return [_image(frame) for frame in shown]


def _image(frame: Frame) -> ImagePart:
    return ImagePart(frame.data, frame.media_type, frame.width_px, frame.height_px)
