"""A room of ADAMO as an environment of Gymnasium.

It is a body driven from outside, so an episode here is one as everywhere: the same tools, views,
feedback, limits, record and score. The reward is the completion that a step gained, which is the
one thing that is told here and to no other player.
"""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
from numpy.typing import NDArray

from adamo_vh.action import Feedback, action_name
from adamo_vh.adapters.gym.spaces import (
    STRUCTURED,
    Call,
    action_space,
    observation_space,
    picture,
    read_structured,
    read_text_call,
    text_within,
)
from adamo_vh.episode.config import EpisodeConfig, Settings
from adamo_vh.errors import ConfigError
from adamo_vh.observation import Frame, Observation
from adamo_vh.record.run_folder import reserve
from adamo_vh.record.turn import FINISH
from adamo_vh.session.bodies import tools_for
from adamo_vh.session.driven import DrivenBody
from adamo_vh.session.pooling import process_engines

_PLAYER = "gymnasium"
_LONGEST_S = 1e9
"""A learner may think as long as it likes between two steps."""
_OPTIONS = ("variation",)


class RoomEnv(gymnasium.Env[dict[str, Any], Any]):
    """One task in one room.

    Observation: `image`, the annotated view, (H, W, 3) uint8, and `text`: the instruction, the
    feedback on the last action, and the symbolic state in words. Reward: completion gained by the
    step, so that the rewards of an episode sum up to its completion. Terminated: the agent ended
    the episode; truncated: a limit did. `info` has the same in parts.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012
        "render_modes": ["rgb_array"],
        "render_fps": 1,
    }

    def __init__(
        self,
        task: str = "T1",
        scene: str = "s1",
        *,
        resolution: str | tuple[int, int] = "640x360",
        actions: str = "call",
        variations: Sequence[int] = (0,),
        max_steps: int = 60,
        out: str | Path | None = None,
        render_mode: str | None = None,
        **settings: Any,
    ) -> None:
        """Set it up; the engine is made by the first `reset`.

        Args:
            task: Id of a built-in task, or path of a task file.
            scene: Built-in scene, or path of a scene file.
            resolution: Width and height of the frames.
            actions: "call": a tool call as JSON text. "structured": a tool, an object, a point.
            variations: Of the scene; each reset without an option draws one of them.
            max_steps: Steps after which an episode is truncated.
            out: Folder that keeps a run folder of each episode; none is kept without.
            render_mode: "rgb_array" or none.
            **settings: Others by name, as for `EpisodeConfig.of`: labeling, profile, grid, ...

        Raises:
            ConfigError: A setting is wrong.
        """
        given: Settings = {**settings, "task": task, "scene": scene, "resolution": resolution}  # type: ignore[typeddict-item]
        config = EpisodeConfig.of(**given)
        limits = replace(config.limits, max_steps=max_steps)
        if "limits" not in settings:
            limits = replace(limits, max_seconds=_LONGEST_S)
        self._config = replace(config, limits=limits)
        self._variations = tuple(variations)
        self._out = None if out is None else Path(out)
        self._kind = actions
        names = [action_name(tool.action_type) for tool in tools_for(config)]
        self.tools = (*names, FINISH)
        """Names of the tools, in the order of structured actions."""
        self.render_mode = render_mode
        self.observation_space = observation_space(*config.resolution)
        self.action_space = action_space(actions, self.tools)
        self._closing = ExitStack()
        self._body: DrivenBody | None = None
        self._view: Observation | None = None
        """The last view that the rules of the profile granted."""
        self._held: str | None = None
        """Tag of what is in the hand."""
        self._completion = 0.0

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """Begin an episode.

        Args:
            seed: Of the draws of variations.
            options: `variation`: which one of the scene it is.

        Raises:
            ConfigError: An option is unknown, or the scene has no such variation.
        """
        super().reset(seed=seed)
        chosen = options or {}
        if unknown := sorted(chosen.keys() - set(_OPTIONS)):
            raise ConfigError(f"There is no option {unknown[0]!r}. Options: {', '.join(_OPTIONS)}.")
        drawn = self.np_random.choice(len(self._variations))
        variation = chosen.get("variation", self._variations[drawn])
        config = replace(self._config, variation=variation)
        self._leave()
        out = None if self._out is None else reserve(self._out, "episode")
        with ExitStack() as stack:
            world = stack.enter_context(process_engines().lent(config))
            body = DrivenBody.begin(config, out, player=_PLAYER, engine=world, page=False)
            stack.callback(body.close)
            self._closing = stack.pop_all()
        self._body, self._view = body, body.observe().observation
        self._held = self._view.agent.held
        self._completion = body.completion() or 0.0
        return self._observed(body, None, ())

    def step(self, action: Any) -> tuple[dict[str, Any], float, bool, bool, dict[str, Any]]:
        """Carry out an action; one that is no valid call is refused, and counts as a step.

        Raises:
            gymnasium.error.ResetNeeded: The episode has ended, or has not begun.
            EngineError: The world failed: the episode counts for nothing.
        """
        body = self._body
        if body is None or body.ended:
            raise gymnasium.error.ResetNeeded("The episode has ended; call reset().")
        feedback, shown = self._carried_out(body, self._call(body, action))
        if not body.ended and body.config.profile.fresh_view:
            self._view = body.observe().observation
        before, self._completion = self._completion, body.completion() or 0.0
        terminated = truncated = False
        if body.ended:
            reason = body.result().termination
            truncated = reason.is_truncated
            terminated = not truncated
        view, info = self._observed(body, feedback, shown)
        return view, self._completion - before, terminated, truncated, info

    def render(self) -> NDArray[np.uint8] | None:
        """The last view, (H, W, 3); None without the render mode."""
        shown = self._view if self.render_mode else None
        return None if shown is None else picture(shown.frame)

    def close(self) -> None:
        """Leave the room; its engine stays for others in this process."""
        self._leave()

    def _leave(self) -> None:
        self._body = self._view = None
        self._closing.close()

    def _call(self, body: DrivenBody, action: Any) -> Call:
        if self._kind == STRUCTURED:
            assert self._view is not None
            objects = [item.tag for item in self._view.objects]
            room = body.manifest.initial.scene
            return read_structured(action, self.tools, objects, self._held, room)
        return read_text_call(action)

    def _carried_out(self, body: DrivenBody, call: Call) -> tuple[Feedback | None, Sequence[Frame]]:
        name, arguments = call
        if name == FINISH:
            body.finish(str((arguments or {}).get("answer") or "Done."))
            return None, ()
        result = body.call(name, arguments)
        self._view, self._held = result.observation or self._view, result.agent.held
        return result.feedback, result.pictures

    def _observed(
        self, body: DrivenBody, feedback: Feedback | None, shown: Sequence[Frame]
    ) -> tuple[dict[str, Any], dict[str, Any]]:
        """What is seen and told now."""
        view, state = self._view, body.state_text()
        assert view is not None
        said = "" if feedback is None else feedback.text
        observation = {
            "image": picture(view.frame),
            "text": text_within([f"Instruction: {body.instruction}", said, state]),
        }
        return observation, self._info(body, view, feedback, shown)

    def _info(
        self,
        body: DrivenBody,
        view: Observation,
        feedback: Feedback | None,
        shown: Sequence[Frame],
    ) -> dict[str, Any]:
        info: dict[str, Any] = {
            "instruction": body.instruction,
            "feedback": "" if feedback is None else feedback.text,
            "outcome": "" if feedback is None else str(feedback.outcome),
            "code": "" if feedback is None else str(feedback.code),
            "objects": tuple(item.tag for item in view.objects),
            "closeups": tuple(picture(frame) for frame in shown),
            "steps": body.steps,
        }
        if body.ended:
            result = body.result()
            info |= {"termination": str(result.termination), "completion": result.completion}
            info |= {"strict": result.strict, "state_hash": result.state_hash}
        return info
