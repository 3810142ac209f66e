"""A small scripted mind behind the test server: it sees, and answers in the way it is asked."""

from __future__ import annotations

import base64
import io
import json
from collections.abc import Sequence
from dataclasses import dataclass, field

from PIL import Image
from tests.fake_provider import Canned, Json, call, completion, fault

_COLOURS = {
    "red": (220, 20, 20),
    "green": (20, 140, 40),
    "blue": (25, 50, 215),
    "yellow": (250, 225, 20),
    "black": (0, 0, 0),
    "white": (255, 255, 255),
}
Step = tuple[str, Json]


@dataclass
class Brain:
    """Carries out a list of calls, one a turn, and then answers."""

    steps: Sequence[Step] = ()
    answer: str = "It is done."
    tools: str = "native"
    """native, leaked, none (they are ignored), or 400 or 500: they are refused with that."""
    schema: str = "obeyed"
    """obeyed, ignored, or 400."""
    pictures: str = "seen"
    """seen, unseen, or 500."""
    asked: list[Json] = field(default_factory=list)

    def __call__(self, request: Json) -> Canned:
        """Answer a request."""
        self.asked.append(request)
        if (no := self._refusal(request)) is not None:
            return no
        said = self._say(request)
        if isinstance(said, str):
            return completion(said)
        return self._with_tools(*said) if "tools" in request else self._without(request, *said)

    def _refusal(self, request: Json) -> Canned | None:
        if self.pictures == "500" and _pictures(request):
            return fault(500, "image input is not supported - hint: you may need the mmproj")
        if "tools" in request and self.tools in ("400", "500"):
            return fault(int(self.tools), "tools param requires --jinja flag")
        if "response_format" in request and self.schema == "400":
            return fault(400, "response_format is not supported")
        return None

    def _with_tools(self, name: str, args: Json) -> Canned:
        if self.tools == "native":
            return completion(f"Now I {name}.", [call(name, args, f"call_{len(self.asked)}")])
        if self.tools == "leaked":
            return completion(json.dumps({"name": name, "arguments": args}))
        return completion("I cannot do that.")

    def _without(self, request: Json, name: str, args: Json) -> Canned:
        thought = f"Now I {name}."
        if "response_format" in request and self.schema == "obeyed":
            return completion(_in_schema(request, thought, name, args))
        if name == "SwitchLamp":  # Nothing but the schema asked for it.
            return completion("Somebody should switch it on.")
        if name == "finish":
            return completion(f"{thought}\nFinal Answer: {args['answer']}")
        return completion(f"Thought: {thought}\nAction: {name}\nAction Input: {json.dumps(args)}")

    def _say(self, request: Json) -> Step | str:
        roles = [message["role"] for message in request["messages"]]
        last = len(roles) - roles[::-1].index("assistant") if "assistant" in roles else 0
        text = json.dumps([message["content"] for message in request["messages"][last:]])
        if "left half" in text:
            if not _pictures(request):
                return "I see no picture."
            left, right = _seen(_pictures(request)[-1])
            return "No idea." if self.pictures == "unseen" else f"{left}, {right}"
        if "Answer with the one word" in text:
            return "ready"
        if "lamp named" in text:
            return "SwitchLamp", {"lamp": "desk"}
        turn = roles.count("assistant")
        if turn < len(self.steps):
            return self.steps[turn]
        return self.answer if "tools" in request else ("finish", {"answer": self.answer})


def _in_schema(request: Json, thought: str, name: str, args: Json) -> str:
    """A step as the schema in the request asks for it; fails on one that does not allow it."""
    schema = request["response_format"]["json_schema"]["schema"]
    assert schema["required"] == ["thought", "action"]
    (action,) = (
        option["properties"]
        for option in schema["properties"]["action"]["anyOf"]
        if option["properties"]["name"]["const"] == name
    )
    assert set(action["args"]["required"]) <= args.keys() <= action["args"]["properties"].keys()
    return json.dumps({"thought": thought, "action": {"name": name, "args": args}})


def _pictures(request: Json) -> list[Image.Image]:
    return [
        Image.open(io.BytesIO(base64.b64decode(part["image_url"]["url"].partition(",")[2])))
        for message in request["messages"]
        if isinstance(message["content"], list)
        for part in message["content"]
        if part["type"] == "image_url"
    ]


def _seen(picture: Image.Image) -> tuple[str, str]:
    def named(x: int) -> str:
        pixel = picture.convert("RGB").getpixel((x, picture.height // 2))
        return next(name for name, colour in _COLOURS.items() if colour == pixel)

    return named(5), named(picture.width - 5)
