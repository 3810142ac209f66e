"""The chain of a study: every result in the order in which it came, each linked to those before.

A line is only ever added. So whoever removes an episode that went badly, or plays one again until
it goes well, leaves a trace; and with a signature nobody else can write the chain anew.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from pathlib import Path

from pydantic import TypeAdapter, ValidationError

from adamo_vh.episode.sealing import sealed_digest, sign_run
from adamo_vh.errors import RecordError
from adamo_vh.files import append_line, naming, write_whole
from adamo_vh.record.digest import Signature
from adamo_vh.record.signing import Signer

CHAIN = "chain.jsonl"
LINK = "chain"
"""What the signature of a link is for."""
_GENESIS = "0" * 64
"""What the first link follows."""


@dataclass(frozen=True, slots=True)
class Link:
    """One line of the chain."""

    episode: str
    """Key of the episode."""
    digest: str
    """What its result is sealed with."""
    link: str
    """SHA-256, in hex, of the link before, the key and the digest, each with a line break."""
    signature: Signature | None = None


class Chain:
    """The chain of a study that is open for writing."""

    def __init__(self, folder: Path, signer: Signer | None = None) -> None:
        """Go on with a chain, or begin one; the caller holds the study's lock.

        Args:
            folder: The study's.
            signer: Signs each result that is added, and its link.

        Raises:
            RecordError: It is damaged.
            FileError: It cannot be read or written.
        """
        self._path = folder / CHAIN
        self._signer = signer
        links = read_chain(folder)
        self._last = links[-1].link if links else _GENESIS
        self._linked = {link.episode: link for link in links}
        """The last link of each episode."""
        self._cut()

    def _cut(self) -> None:
        """Take away a last line that a power cut left unfinished."""
        if not self._path.exists():
            return
        with naming("read", self._path):
            data = self._path.read_bytes()
        if data and not data.endswith(b"\n"):
            write_whole(self._path, data[: data.rfind(b"\n") + 1])

    def add(self, episode: str, run: Path) -> None:
        """Link a result, unless it is the one that was linked, and signed, last for its episode.

        Args:
            episode: Its key.
            run: Its run folder. A result without a seal, of an older version, is left out.

        Raises:
            RecordError: The result is damaged.
            FileError: It, or the chain, cannot be written.
        """
        digest = sealed_digest(run)
        before = self._linked.get(episode)
        if not digest:
            return
        if before is not None and before.digest == digest and self._is_enough(before):
            return
        link, signature = _link(self._last, episode, digest), None
        if self._signer is not None:
            sign_run(run, self._signer)
            signature = self._signer.sign(LINK, link)
        added = Link(episode, digest, link, signature)
        append_line(self._path, json.dumps(asdict(added)).encode())
        self._last, self._linked[episode] = link, added

    def holds(self, episode: str) -> bool:
        """Whether a result of an episode is linked and, if there is a signer, signed.

        Args:
            episode: Its key.
        """
        link = self._linked.get(episode)
        return link is not None and self._is_enough(link)

    def _is_enough(self, link: Link) -> bool:
        """Whether a link need not be signed, or is."""
        return self._signer is None or link.signature is not None


def read_chain(folder: Path) -> list[Link]:
    """The chain of a study; nothing, if there is none. A line that a kill cut off is left out.

    Raises:
        RecordError: A line is no link.
        FileError: The file cannot be read.
    """
    path = folder / CHAIN
    if not path.exists():
        return []
    with naming("read", path):
        lines = path.read_bytes().split(b"\n")[:-1]
    codec, links = TypeAdapter(Link), []
    for number, line in enumerate(lines, start=1):
        try:
            links.append(codec.validate_json(line))
        except ValidationError:
            raise RecordError(
                f"{path}, line {number} is damaged. Put back the file as it was; or move it away "
                "and give the same bench command again, which begins a new chain."
            ) from None
    return links


def broken_links(links: list[Link]) -> Iterator[tuple[int, Link]]:
    """Links that do not follow from the one before, with their line's number."""
    before = _GENESIS
    for number, link in enumerate(links, start=1):
        if link.link != _link(before, link.episode, link.digest):
            yield number, link
        before = link.link


def _link(before: str, episode: str, digest: str) -> str:
    return hashlib.sha256(f"{before}\n{episode}\n{digest}\n".encode()).hexdigest()
