"""Token estimates follow each provider's published examples and never shrink as a prompt grows."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from hypothesis import given
from hypothesis import strategies as st

from adamo_vh.action import Drop, Look, Pick, ToolSchema, Walk, tool_schema
from adamo_vh.inference.cost.tokens import (
    ANTHROPIC,
    ANTHROPIC_HIGH,
    GEMINI,
    GEMINI_3,
    OPENAI_PATCHES,
    OPENAI_TILES,
    QWEN,
    QWEN_3,
    ImageRule,
    estimate_image,
    estimate_message,
    estimate_reply,
    estimate_request,
    estimate_text,
    metered,
    rule_for,
)
from adamo_vh.inference.messages import (
    AIMessage,
    HumanMessage,
    ImagePart,
    Message,
    SystemMessage,
    TextPart,
    ToolCall,
    ToolMessage,
)
from adamo_vh.inference.model import ModelInfo, ModelKind, Reply, Sampling, Usage
from adamo_vh.inference.players.scripted import ScriptedModel

RULES = (
    OPENAI_TILES,
    OPENAI_PATCHES,
    ANTHROPIC,
    ANTHROPIC_HIGH,
    GEMINI,
    GEMINI_3,
    QWEN,
    QWEN_3,
)
TOOLS = [tool_schema(action) for action in (Look, Walk, Pick, Drop)]
FRAME = ImagePart(b"frame", "image/jpeg", 1920, 1080)


# Counted by o200k_base itself, with the npm package gpt-tokenizer.
COUNTED = (
    ("- P3: (-3.00, 1.29, 1.15)", 19),
    (
        "- Cup_45: center (-0.424, -0.353, 0.845), volume 2049.5 cm3, box [342, 263, 367, 270] px",
        44,
    ),
    ('{"x": 0.0, "y": -1.0, "z": 0.0}', 24),
    (
        "Corrected: (0.00, -1.00, 0.00) is not reachable; stopped at (-0.83, -0.98, 0.00), "
        "0.83 m from it.",
        47,
    ),
    ("The objects and reference points below describe the latest frame.", 11),
    ("Pick the plate and place it on the floor", 9),
)


@pytest.mark.parametrize(("text", "counted"), COUNTED)
def test_text_of_our_kind_is_estimated_near_to_what_is_counted(text: str, counted: int) -> None:
    assert estimate_text(text) == pytest.approx(counted, rel=0.05)


def test_numbers_count_by_groups_of_three_digits() -> None:
    assert [estimate_text("7" * digits) for digits in (1, 3, 4, 6, 7)] == [1, 1, 2, 2, 3]


def test_nothing_is_no_token_and_something_is_at_least_one() -> None:
    assert estimate_text("") == 0
    assert estimate_text("a") == 1
    assert estimate_text("物体を床に置いてください") > 6
    assert estimate_text("🪴") >= 2


WORDS = st.lists(
    st.sampled_from(["Plate_57", "plate", "the", "-0.42", "1234567", "(", "),", "größer", "OPAQ"]),
    max_size=30,
)


@given(WORDS, WORDS)
def test_a_longer_text_never_has_fewer_tokens(first: list[str], second: list[str]) -> None:
    short, long = " ".join(first), " ".join([*first, *second])
    assert estimate_text(short) <= estimate_text(long)
    assert estimate_text(long) <= estimate_text(short) + estimate_text(" ".join(["", *second])) + 1


@given(st.text(max_size=60), st.text(max_size=60))
def test_added_text_never_lowers_the_estimate(text: str, more: str) -> None:
    assert estimate_text(text) <= estimate_text(text + more)


@given(st.text(max_size=200))
def test_every_text_is_covered(text: str) -> None:
    assert 0 <= estimate_text(text) <= 3 * len(text)


@pytest.mark.parametrize(
    ("rule", "width_px", "height_px", "tokens"),
    [
        # OpenAI, "Images and vision", the examples of its section on costs.
        (OPENAI_TILES, 1024, 1024, 4 * 170 + 85),
        (OPENAI_TILES, 2048, 4096, 6 * 170 + 85),
        (OPENAI_TILES, 1920, 1080, 6 * 170 + 85),
        (OPENAI_TILES, 480, 270, 1 * 170 + 85),
        (OPENAI_PATCHES, 1024, 1024, round(1024 * 1.62)),
        (OPENAI_PATCHES, 1800, 2400, round(1452 * 1.62)),
        # Anthropic, "Vision": its table of sizes for both tiers.
        (ANTHROPIC, 200, 200, 64),
        (ANTHROPIC, 1000, 1000, 1296),
        (ANTHROPIC, 3840, 2160, 1560),
        (ANTHROPIC, 1920, 1080, 1560),
        (ANTHROPIC_HIGH, 1920, 1080, 2691),
        (ANTHROPIC_HIGH, 3840, 2160, 4784),
        # Google, "Image understanding": 960 x 540 makes crops of 360 px, 3 by 2 of them.
        (GEMINI, 384, 384, 258),
        (GEMINI, 960, 540, 6 * 258),
        (GEMINI_3, 1920, 1080, 1120),
        # Qwen2.5-VL: sides rounded to 28 px, from 4 to 16,384 cells, a sign at either end.
        (QWEN, 1920, 1080, 69 * 39 + 2),
        (QWEN, 28, 28, 4 + 2),
        (QWEN_3, 1920, 1080, 60 * 34 + 2),
    ],
)
def test_pictures_count_as_in_the_documentation(
    rule: ImageRule, width_px: int, height_px: int, tokens: int
) -> None:
    assert estimate_image(width_px, height_px, rule) == tokens


@given(st.sampled_from(RULES), st.integers(1, 8000), st.integers(1, 8000))
def test_every_picture_has_a_bounded_count(rule: ImageRule, width_px: int, height_px: int) -> None:
    tokens = estimate_image(width_px, height_px, rule)
    assert tokens >= 1
    if rule is not GEMINI:  # its documented formula grows with the aspect ratio, without a bound
        assert tokens <= 16384 + 2
    assert estimate_image(height_px, width_px, rule) == pytest.approx(tokens, rel=0.1)


@given(st.integers(64, 1500), st.integers(64, 1500), st.integers(1, 60))
def test_within_the_limits_a_larger_picture_never_costs_less(
    width_px: int, height_px: int, more_px: int
) -> None:
    for rule in (ANTHROPIC_HIGH, QWEN_3):
        small = estimate_image(width_px, height_px, rule)
        assert small <= estimate_image(width_px + more_px, height_px + more_px, rule)


@pytest.mark.parametrize(
    ("uri", "rule"),
    [
        ("openai:gpt-4o", OPENAI_TILES),
        ("openai-responses:gpt-4.1", OPENAI_TILES),
        ("openai:gpt-5-mini", OPENAI_PATCHES),
        ("openrouter:openai/gpt-4.1-mini", OPENAI_PATCHES),
        ("anthropic:claude-3-5-sonnet-20241022", ANTHROPIC),
        ("anthropic:claude-opus-4-20250514", ANTHROPIC),
        ("anthropic:claude-sonnet-4-5-20250929", ANTHROPIC),
        ("anthropic:claude-opus-4-7", ANTHROPIC_HIGH),
        ("openrouter:anthropic/claude-opus-5", ANTHROPIC_HIGH),
        ("google:gemini-2.5-flash", GEMINI),
        ("google-vertex:gemini-3-pro-preview", GEMINI_3),
        ("openai:Qwen/Qwen2.5-VL-7B-Instruct@http://127.0.0.1:8000/v1", QWEN),
        ("openai:qwen3-vl:8b@http://127.0.0.1:11434/v1", QWEN_3),
        ("openai:my-own@http://claude.example/v1", OPENAI_TILES),
        ("baseline", OPENAI_TILES),
    ],
)
def test_a_model_is_known_by_its_name(uri: str, rule: ImageRule) -> None:
    assert rule_for(uri) == rule


def test_some_models_of_a_family_count_otherwise() -> None:
    sizes = {
        "gpt-4o-mini": 2833 + 6 * 5667,
        "gpt-5": 70 + 6 * 140,
        "o3": 75 + 6 * 150,
        "gpt-4.1-nano": round(1508 * 2.46),
        "o4-mini": round(1508 * 1.72),
        "gemma-3-27b-it": 256,
    }
    counted = {name: estimate_image(1920, 1080, rule_for(f"openai:{name}")) for name in sizes}
    assert counted == sizes


PROMPT: tuple[Message, ...] = (
    SystemMessage("You live in a room."),
    HumanMessage((TextPart("Pick the plate."), FRAME)),
    AIMessage("I see it.", (ToolCall("call_1", "Pick", {"object": "Plate_57"}, ""),)),
    ToolMessage("call_1", "Pick", "Done: you hold Plate_57.", (FRAME,)),
)


def test_a_request_is_its_messages_its_tools_and_its_pictures() -> None:
    bare = estimate_request(PROMPT)
    assert bare == sum(map(estimate_message, PROMPT)) + 3
    assert estimate_request(PROMPT, TOOLS) - bare == pytest.approx(271, abs=10)
    pictures = 2 * (estimate_image(1920, 1080, QWEN) - estimate_image(1920, 1080, OPENAI_TILES))
    assert estimate_request(PROMPT, (), QWEN) - bare == pictures


@given(st.integers(0, 4), st.integers(0, 4))
def test_a_longer_prompt_is_never_cheaper(count: int, tools: int) -> None:
    shorter = estimate_request(PROMPT[:count], TOOLS[:tools])
    assert shorter <= estimate_request(PROMPT, TOOLS[:tools]) <= estimate_request(PROMPT, TOOLS)


def test_a_reply_is_its_note_and_its_calls() -> None:
    note = AIMessage("I see it.")
    call = ToolCall("call_1", "Pick", {"object": "Plate_57"}, '{"object": "Plate_57"}')
    assert estimate_reply(note) == estimate_text("I see it.")
    assert estimate_reply(AIMessage("I see it.", (call,))) > estimate_reply(note) + 8
    assert estimate_reply(AIMessage("", (call,))) == estimate_reply(
        AIMessage("", (ToolCall("call_1", "Pick", {"object": "Plate_57"}),))
    )


class Counting:
    """A model with tokens of its own."""

    info = ModelInfo("counting", ModelKind.VLM)

    def complete(
        self, messages: Sequence[Message], tools: Sequence[ToolSchema], sampling: Sampling
    ) -> Reply:
        return Reply(AIMessage("Done."), Usage(11, 2))


def test_a_player_without_tokens_gets_an_estimate_that_is_marked() -> None:
    model = metered(ScriptedModel("scripted:x", [AIMessage("I see it.")]), QWEN)
    reply = model.complete(PROMPT, TOOLS, Sampling())
    assert (model.info.name, model.info.kind) == ("scripted:x", ModelKind.SCRIPTED)
    assert reply.usage == Usage(estimate_request(PROMPT, TOOLS, QWEN), 4, estimated=True)
    assert reply.cost_usd is None


def test_what_a_provider_counted_is_kept() -> None:
    reply = metered(Counting()).complete(PROMPT, TOOLS, Sampling())
    assert reply.usage == Usage(11, 2)
