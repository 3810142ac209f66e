"""One table of URIs feeds the errors, the help and the documentation."""

from __future__ import annotations

from pathlib import Path

from adamo_vh.inference.uris import HELP, URI_FORMS, known_forms, markdown_table

DOCS = Path(__file__).parents[2] / "docs" / "models.md"


def test_the_documentation_has_the_table() -> None:
    assert markdown_table() in DOCS.read_text(encoding="utf-8")


def test_every_form_is_in_help_and_errors() -> None:
    forms = [form for row in URI_FORMS for form in row.forms]
    assert len(forms) == len({*forms})
    assert all(form in HELP for form in forms)
    assert all(form in known_forms() for form in forms if not form.startswith("PLUGIN"))
