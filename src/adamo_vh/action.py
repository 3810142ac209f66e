"""What the agent can do: typed actions, their tool schemas, and the feedback on them.

One frozen dataclass is the tool schema, the validation, the wire message and the log record of an
action. A new tool is a new dataclass; what carries it out is paired with it in
`adamo_vh.action_server.Tool`, the one place where tools are added.
"""

from __future__ import annotations

import ast
import inspect
import math
import re
import textwrap
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from enum import StrEnum
from functools import cache
from types import FunctionType
from typing import Annotated, Any, ClassVar, Protocol

from pydantic import ConfigDict, Field, TypeAdapter, ValidationError

from adamo_vh.errors import ConfigError, InvalidActionError

_STRICT = ConfigDict(
    extra="forbid", coerce_numbers_to_str=True, str_strip_whitespace=True, str_max_length=100
)

_X = Annotated[float, Field(description="World X in metres.", allow_inf_nan=False)]
_Y = Annotated[float, Field(description="World Y in metres.", allow_inf_nan=False)]
_Z = Annotated[
    float, Field(description="World Z in metres; the floor is at 0.", allow_inf_nan=False)
]


class Action(Protocol):
    """Any frozen dataclass whose fields are the arguments of a tool."""

    __dataclass_fields__: ClassVar[dict[str, Any]]


@dataclass(frozen=True, slots=True)
class Look:
    """Turn body and gaze to a point in the room and receive a new view from there."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    x: _X
    y: _Y
    z: _Z


@dataclass(frozen=True, slots=True)
class Walk:
    """Walk to a point on the floor, or to the nearest reachable place to it."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    x: _X
    y: _Y
    z: _Z


@dataclass(frozen=True, slots=True)
class Pick:
    """Take an object that you have seen into your hand, walking closer if it is out of reach."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    object: Annotated[str, Field(description="Tag of the object, as shown in the view.")]


@dataclass(frozen=True, slots=True)
class Drop:
    """Put the object in your hand down at a point, walking closer if it is out of reach."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    object: Annotated[str, Field(description="Tag of the object in your hand.")]
    x: _X
    y: _Y
    z: _Z


@dataclass(frozen=True, slots=True)
class Inspect:
    """See an object in view or in hand close up, large enough to read what is printed on it."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT

    object: Annotated[str, Field(description="Tag of the object, as shown in the view.")]


@dataclass(frozen=True, slots=True)
class Survey:
    """See all objects in view close up on one sheet, each with its tag."""

    __pydantic_config__: ClassVar[ConfigDict] = _STRICT


class Outcome(StrEnum):
    """How an action ended."""

    DONE = "done"
    CORRECTED = "corrected"
    """Carried out, but not as asked; the text says what was corrected."""
    REFUSED = "refused"
    """Nothing changed; the text says why."""


class Code(StrEnum):
    """The finer reason behind an outcome. Tools from outside may add their own strings."""

    OK = "ok"
    REPOSITIONED = "repositioned"
    """Done, after walking closer."""

    STOPPED_SHORT = "stopped_short"
    """Walk ended at the nearest reachable place."""
    GAZE_LIMITED = "gaze_limited"
    """The neck does not turn that far."""
    PLACED_ELSEWHERE = "placed_elsewhere"
    """Drop went to the nearest free spot."""

    MOVED_INSIDE = "moved_inside"
    """The point was a little outside the room; the nearest one inside was taken."""
    CANCELLED = "cancelled"
    """Stopped on request, before the end."""

    UNKNOWN_TOOL = "unknown_tool"
    BAD_ARGUMENT = "bad_argument"
    UNKNOWN_TAG = "unknown_tag"
    NOT_SEEN = "not_seen"
    NOT_IN_VIEW = "not_in_view"
    OUTSIDE_ROOM = "outside_room"
    HAND_FULL = "hand_full"
    HAND_EMPTY = "hand_empty"
    NOT_HELD = "not_held"

    GONE = "gone"
    """The object is not in the room any more."""
    UNREACHABLE = "unreachable"
    NO_FREE_SPOT = "no_free_spot"


@dataclass(frozen=True, slots=True)
class Feedback:
    """What the agent is told about its last tool call."""

    outcome: Outcome
    code: str
    """One of `Code`, or a string of a tool added from outside."""
    text: str
    """One short, truthful sentence or two."""
    walked_m: float = 0.0
    """Length of the way that the body walked for it, metres."""
    stopped_s: float | None = None
    """Simulated seconds of motion after which it was stopped on request; None if it was not."""

    @classmethod
    def of_error(cls, error: InvalidActionError) -> Feedback:
        """The refusal that an invalid call gets: nothing changed in the world."""
        return cls(Outcome.REFUSED, error.code, f"Refused: {error}")


@dataclass(frozen=True, slots=True)
class ToolSchema:
    """A tool as a model sees it."""

    name: str
    description: str
    parameters: dict[str, Any]
    """JSON schema of the arguments."""


def action_name(action_type: type) -> str:
    """The tool name of an action type: its class name."""
    return action_type.__name__


@cache
def _codec(action_type: type) -> TypeAdapter[Any]:
    return TypeAdapter(action_type)


@cache
def tool_schema(action_type: type) -> ToolSchema:
    """Generate the tool schema of an action from its dataclass."""
    schema = _codec(action_type).json_schema()
    schema.pop("title", None)
    schema.pop("description", None)
    for field in schema.get("properties", {}).values():
        field.pop("title", None)
    return ToolSchema(action_name(action_type), _description(action_type), schema)


def _description(action_type: type) -> str:
    """The first paragraph of a class's docstring; out of its source where Python drops them.

    Raises:
        ConfigError: There is none.
    """
    name, doc = action_name(action_type), action_type.__doc__
    if not doc or doc.startswith(f"{name}("):  # What a dataclass makes up for a missing one.
        doc = docstring_in_source(action_type)
    if not doc:
        raise ConfigError(
            f"Tool {name} has no description: give its class a docstring, which is what a model "
            "reads of it. Under `python -OO` the class must stand in a source file."
        )
    return inspect.cleandoc(doc).split("\n\n")[0].replace("\n", " ")


def docstring_in_source(described: type | FunctionType) -> str | None:
    """What stands in the source of a class or function, where Python has dropped its docstring."""
    try:
        (found,) = ast.parse(textwrap.dedent(inspect.getsource(described))).body
    except (OSError, TypeError, SyntaxError, ValueError):
        return None
    return ast.get_docstring(found) if isinstance(found, ast.ClassDef | ast.FunctionDef) else None


def parse(name: str, arguments: Mapping[str, Any] | None, actions: Iterable[type]) -> Any:
    """Turn a model's tool call into a typed action.

    Args:
        name: Tool name as the model wrote it.
        arguments: Arguments, or None if they could not be read as a JSON object.
        actions: The action types that are on offer.

    Returns:
        An instance of one of `actions`.

    Raises:
        InvalidActionError: The tool is unknown or an argument is missing, unknown or malformed.
    """
    known = {action_name(a): a for a in actions}
    if name not in known:
        offer = ", ".join(known)
        raise InvalidActionError(
            Code.UNKNOWN_TOOL, f"there is no tool named {name[:60]!r}. Tools: {offer}."
        )
    signature = ", ".join(tool_schema(known[name]).parameters.get("properties", {}))
    if arguments is None:
        raise InvalidActionError(
            Code.BAD_ARGUMENT, f"the arguments are not a JSON object. Usage: {name}({signature})."
        )
    schema = tool_schema(known[name]).parameters
    if odd := next(_no_numbers(dict(arguments), schema, schema.get("$defs", {})), ""):
        raise InvalidActionError(Code.BAD_ARGUMENT, f"{odd}. Usage: {name}({signature}).")
    try:
        return _codec(known[name]).validate_python(dict(arguments))
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(part) for part in first["loc"]) or "arguments"
        raise InvalidActionError(
            Code.BAD_ARGUMENT, f"{where}: {first['msg']}. Usage: {name}({signature})."
        ) from None


_NUMBER = re.compile(r"-?(?:0|[1-9][0-9]*)(?:\.[0-9]+)?(?:[eE][+-]?[0-9]+)?")
"""A number as JSON writes it; as text it is understood too."""


def _no_numbers(
    value: Any, schema: Mapping[str, Any], definitions: Mapping[str, Any], where: str = ""
) -> Iterator[str]:
    """What stands where a number belongs and is none, though Python would take it for one."""
    if "$ref" in schema:
        schema = definitions.get(schema["$ref"].rpartition("/")[2], {})
    options = [schema, *schema.get("anyOf", ())]
    kinds = {option.get("type") for option in options}
    if isinstance(value, Mapping):
        for name, inner in schema.get("properties", {}).items():
            path = f"{where}.{name}" if where else name
            yield from _no_numbers(value.get(name), inner, definitions, path)
    elif isinstance(value, list):
        for inner in value:
            yield from _no_numbers(inner, schema.get("items", {}), definitions, where)
    elif kinds & {"number", "integer"}:
        if isinstance(value, bool) and "boolean" not in kinds:
            yield f"{where}: {str(value).lower()} is no number"
        elif isinstance(value, str) and "string" not in kinds:
            if not _NUMBER.fullmatch(value.strip(" ")):
                yield f"{where}: {value[:40]!r} is no number; write it like 1.5"
        elif isinstance(value, float) and not math.isfinite(value):
            yield f"{where}: {value} is no finite number"
