"""What is wrong with a field of a scene file, in plain words and with the fix."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from adamo_vh.readable import readable

if TYPE_CHECKING:
    from pydantic_core import ErrorDetails, ValidationError

_WORDS = {
    "missing": "is missing; add it",
    "unexpected_keyword_argument": "there is no such field; remove it or correct its name",
    "float_type": "must be a number, not {value}; write it without quotes",
    "int_type": "must be a whole number, not {value}; write it without quotes",
    "bool_type": "must be true or false, not {value}; write it without quotes",
    "string_type": "must be a text, not {value}; put it into quotes",
    "tuple_type": "must be a list, not {value}; correct it",
    "dataclass_type": "must be a section of its own, not {value}; write [{field}]",
    "string_pattern_mismatch": "{value} must begin with a letter or digit and hold no others than "
    "letters, digits, blanks, _ and -; choose such a name",
    "string_too_short": "is empty; name it",
    "string_too_long": "has {length} letters; use at most {max_length}",
    "too_long": "has more than {max_length} entries; remove some",
    "too_short": "has too few entries; give at least {min_length}",
    "finite_number": "must be a number, not {value}; correct it",
    "greater_than_equal": "{value} is too small; use {ge:g} or more",
    "greater_than": "{value} is too small; use more than {gt:g}",
    "less_than_equal": "{value} is too large; use {le:g} or less",
}
"""What each kind of fault that the validation finds means for who wrote the file."""
_LONGEST = 60


def field_faults(error: ValidationError) -> tuple[tuple[str, str], ...]:
    """Every fault: the field, and what is wrong with it."""
    found = error.errors(include_url=False)
    inner = {details["loc"][:1] for details in found if len(details["loc"]) > 1}
    # A list is not too short for want of the entries that are faulty themselves.
    told = (d for d in found if d["type"] != "too_short" or d["loc"] not in inner)
    return tuple(_fault(details) for details in told)


def _fault(details: ErrorDetails) -> tuple[str, str]:
    """Where a fault is, as in `objects[2].position`, and what is wrong there with the fix."""
    where = "".join(f"[{p}]" if isinstance(p, int) else f".{p}" for p in details["loc"])
    given = details["input"]
    facts = {
        "value": shown(given),
        "field": details["loc"][0] if details["loc"] else "file",
        "length": len(given) if isinstance(given, str) else 0,
        **details.get("ctx", {}),
    }
    words = _WORDS.get(details["type"])
    told = words.format(**facts) if words else f"{details['msg']}; correct it"
    return shortened(where.lstrip(".")) or "file", told


def shown(value: Any) -> str:
    """A value from a file as the file spells it, in brief."""
    return shortened(json.dumps(value, ensure_ascii=False, default=str))


def shortened(text: str) -> str:
    """Text from a file, readable and no longer than fits a line."""
    text = readable(text)
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."
