"""Every way to name a model: one table that feeds the help, the errors and the documentation."""

from __future__ import annotations

from dataclasses import dataclass

from adamo_vh.plugins import MODELS, plugin_names


@dataclass(frozen=True, slots=True)
class UriForm:
    """A way to name a model."""

    forms: tuple[str, ...]
    """How it is written; what stands in capitals is for the user to fill in."""
    what: str
    """What it is; Markdown."""
    needs: str = ""
    """What it takes; Markdown."""


URI_FORMS = (
    UriForm(
        ("baseline", "baseline:ocr"),
        "the built-in rule-based player ([docs/baseline.md](baseline.md))",
        "`adamo-vh[ocr]` for the second",
    ),
    UriForm(
        ("random", "random:SEED"),
        "uniform over the valid calls, from the seed of the episode or its own: the floor of every "
        "table",
    ),
    UriForm(("openai:NAME",), "OpenAI, Chat Completions", "`OPENAI_API_KEY`"),
    UriForm(("openai-responses:NAME",), "OpenAI, Responses", "`OPENAI_API_KEY`"),
    UriForm(
        ("openai:NAME@http://HOST:PORT/v1",),
        "any OpenAI-compatible server: vLLM, Ollama, llama-server, LM Studio, ...",
        "a key only if the server wants one",
    ),
    UriForm(("anthropic:NAME",), "Anthropic", "`adamo-vh[anthropic]`, `ANTHROPIC_API_KEY`"),
    UriForm(("google:NAME",), "Google", "`adamo-vh[google]`, `GOOGLE_API_KEY`"),
    UriForm(
        ("openrouter:NAME", "mistral:NAME", "ollama:NAME", "PROVIDER:NAME"),
        "whatever else pydantic-ai knows",
        "its package and key",
    ),
    UriForm(("scripted:FILE.json",), "replies from a file"),
    UriForm(("replay:RUN_DIR",), "says again what was said in a recorded run"),
    UriForm(("cassette:RUN_DIR",), "recorded replies, for exactly the recorded requests"),
    UriForm(
        ("PLUGIN", "PLUGIN:ANYTHING"),
        "a model of another installed package (entry point `adamo_vh.models`)",
        "that package",
    ),
)


def known_forms() -> str:
    """All forms in one line, with the names that installed packages add."""
    plain = [form for row in URI_FORMS for form in row.forms if not form.startswith("PLUGIN")]
    return ", ".join([*plain, *plugin_names(MODELS)])


HELP = ", ".join(form for row in URI_FORMS for form in row.forms)
"""For the help of the command line."""


def markdown_table() -> str:
    """The table as `docs/models.md` has it."""
    rows = ["| URI | what it is | needs |", "|---|---|---|"]
    for row in URI_FORMS:
        forms = ", ".join(f"`{form}`" for form in row.forms)
        rows.append(f"| {forms} | {row.what} | {row.needs}{' ' if row.needs else ''}|")
    return "\n".join(rows)
