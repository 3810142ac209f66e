"""Going through the symbols of an instruction."""

from __future__ import annotations

from adamo_vh.inference.baseline.language.words import Kind, Token


class NotUnderstood(Exception):  # noqa: N818 - a control signal of the parser, never seen outside
    """A part of the instruction has no meaning here."""


class Cursor:
    """A position in a list of symbols; filler is skipped."""

    def __init__(self, tokens: list[Token]) -> None:
        self._tokens = [token for token in tokens if token.kind is not Kind.SKIP]
        self._at = 0

    def peek(self, ahead: int = 0) -> Kind | None:
        """Kind of the next symbol, None at the end."""
        at = self._at + ahead
        return self._tokens[at].kind if at < len(self._tokens) else None

    def next(self) -> Token:
        """Consume a symbol."""
        self._at += 1
        return self._tokens[self._at - 1]

    def accept(self, *kinds: Kind) -> Token | None:
        """Consume the next symbol if it is of one of these kinds."""
        return self.next() if self.peek() in kinds else None

    def mark(self) -> int:
        """The position, for `rewind`."""
        return self._at

    def rewind(self, mark: int) -> None:
        """Go back to a marked position."""
        self._at = mark

    def ahead(self) -> str:
        """The words of the next symbol; empty at the end."""
        return self._tokens[self._at].text if self._at < len(self._tokens) else ""

    def words_since(self, mark: int) -> str:
        """The words between a mark and here."""
        return " ".join(token.text for token in self._tokens[mark : self._at])

    def bare_and(self, mark: int) -> bool:
        """Whether at a mark stands "and" with nothing but a thing behind it."""
        kinds = [token.kind for token in self._tokens[mark : mark + 2]]
        return kinds[0] is Kind.AND and kinds[1] not in (Kind.THEN, Kind.COMMA, Kind.AND)

    def fail(self, why: str = "") -> NotUnderstood:
        """An exception that quotes the words ahead."""
        ahead = [token.text for token in self._tokens[self._at : self._at + 4]]
        quoted = f"'{' '.join(ahead)}'" if ahead else "the end of the sentence"
        return NotUnderstood(f"{quoted}{f' ({why})' if why else ''}")
