"""Objections: what is asked back, each once, before a turn is carried out or an episode ended."""

from __future__ import annotations

from adamo_vh.action import Feedback, Pick, action_name, parse
from adamo_vh.cognition.profile import SWITCHES, Profile
from adamo_vh.cognition.prompts import render
from adamo_vh.cognition.turns import Finish
from adamo_vh.errors import InvalidActionError
from adamo_vh.record.turn import FINISH, Turn, Wish


class Doubts:
    """Remembers what was asked back for one instruction, so that nothing is asked twice."""

    def __init__(self, profile: Profile) -> None:
        """Doubt as much as the profile says."""
        self._profile = profile
        self._raised: set[str] = set()

    def about_turn(self, turn: Turn) -> str:
        """What to say instead of going on, or of ending the episode; empty if nothing."""
        if turn.is_empty:
            return self._go_on("nudge") if self._is_new("empty") else ""
        self._raised.discard("empty")
        if turn.unreadable:
            return self._go_on("unreadable", why=turn.unreadable)
        if turn.finish is not None:
            return self._about_finish(turn.finish)
        if turn.is_prose and self._profile.finish_check and self._is_new("prose"):
            return render("finish_check")
        return ""

    def about_pick(self, wish: Wish) -> str:
        """What to say to a Pick of little confidence; empty to let it be done."""
        tag = (wish.arguments or {}).get("object")
        is_pick = wish.call.name == action_name(Pick) and tag is not None
        if is_pick and self._is_unsure(wish) and self._is_new(f"Pick {tag}"):
            return self._unsure("pick_doubt", wish)
        return ""

    def _about_finish(self, finish: Wish) -> str:
        try:
            parse(FINISH, finish.arguments, [Finish])
        except InvalidActionError as error:
            if self._is_new("arguments"):
                return Feedback.of_error(error).text
        if self._is_unsure(finish) and self._is_new("finish"):
            return self._unsure("finish_doubt", finish)
        return ""

    def _is_unsure(self, wish: Wish) -> bool:
        return wish.confidence is not None and wish.confidence < self._profile.min_confidence

    def _is_new(self, what: str) -> bool:
        new = what not in self._raised
        self._raised.add(what)
        return new

    def _unsure(self, name: str, wish: Wish) -> str:
        least = f"{self._profile.min_confidence:g}"
        return render(name, confidence=f"{wish.confidence:g}", least=least)

    def _go_on(self, name: str, **more: str) -> str:
        switches = {switch: getattr(self._profile, switch) for switch in SWITCHES}
        return render(name, go_on=render("go_on", **switches), **more)
