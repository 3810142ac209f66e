"""Whether a whole study is what its folder says: every run, and the chain that links them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from adamo_vh.episode.sealing import sealed_digest
from adamo_vh.errors import AdamoError, RecordError
from adamo_vh.record.run_folder import RESULT
from adamo_vh.record.signing import fingerprint, is_signed
from adamo_vh.session.verifying import Verified, verify_run
from adamo_vh.study.chain import CHAIN, LINK, Link, broken_links, read_chain
from adamo_vh.study.running import ordered
from adamo_vh.study.store import episode_folder, read_planned


@dataclass(frozen=True, slots=True)
class ChainVerified:
    """What came of checking a chain."""

    links: int
    head: str
    """The last link; empty if there is no chain, as in older studies."""
    signed_by: tuple[str, ...]
    """Fingerprints of the public keys that signed links, in order."""
    repeated: tuple[str, ...]
    """Episodes with more than one result in it: retried without a score, or scored again."""
    problems: tuple[str, ...]


def verify_episodes(
    folder: Path, *, key: str = "", replayed: bool = True
) -> Iterator[tuple[str, Verified]]:
    """Check every episode of a study that has ended, as `verify_run` does.

    Args:
        folder: The study's.
        key: Public key that must have signed them; any, or none, by default.
        replayed: Execute them again.

    Returns:
        Key and findings of one after the other.

    Raises:
        RecordError: The folder holds no study.
        ConfigError: There is a signature, and the extra `sign` is missing.
    """
    _, episodes = read_planned(folder)
    for planned in ordered(episodes):
        run = episode_folder(folder, planned.key)
        if (run / RESULT).exists():
            yield planned.key, verify_run(run, key=key, replayed=replayed)


def verify_chain(folder: Path, *, key: str = "") -> ChainVerified:
    """Check the chain of a study, against itself and against the results that are there.

    Args:
        folder: The study's.
        key: Public key that must have signed the last link, and with it all before; any, or none,
            by default.

    Raises:
        RecordError: The folder holds no study.
        ConfigError: There is a signature, and the extra `sign` is missing.
    """
    _, episodes = read_planned(folder)
    try:
        links = read_chain(folder)
    except RecordError as error:
        return ChainVerified(0, "", (), (), (str(error),))
    problems = [
        f"{CHAIN}, line {number} ({link.episode}) does not follow from the line before"
        for number, link in broken_links(links)
    ]
    signed_by = tuple(dict.fromkeys(_signers(links, problems)))
    last = links[-1].signature if links else None
    if key and (last is None or last.key != key):
        problems.append(f"{CHAIN}: its last line is not signed by {fingerprint(key)}")
    problems.extend(_unlinked(folder, [one.key for one in episodes], links))
    counted = Counter(episode for episode, _ in {(one.episode, one.digest) for one in links})
    repeated = tuple(sorted(episode for episode, count in counted.items() if count > 1))
    head = links[-1].link if links else ""
    return ChainVerified(len(links), head, signed_by, repeated, tuple(problems))


def _signers(links: Sequence[Link], problems: list[str]) -> Iterator[str]:
    """Who signed, in order; adds to the problems where a signature is wrong."""
    for number, link in enumerate(links, start=1):
        if link.signature is None:
            continue
        if is_signed(LINK, link.link, link.signature):
            yield fingerprint(link.signature.key)
        else:
            problems.append(
                f"{CHAIN}, line {number} ({link.episode}): the signature is not that of its key "
                "over this link"
            )


def _unlinked(folder: Path, keys: Sequence[str], links: Sequence[Link]) -> Iterator[str]:
    """Results that the chain does not know, or that are not there any more."""
    last = {link.episode: link.digest for link in links}
    for episode in dict.fromkeys((*keys, *last)):
        run, told = episode_folder(folder, episode), last.get(episode)
        try:
            digest = sealed_digest(run) if (run / RESULT).exists() else None
        except AdamoError:
            continue  # The check of the run itself says that it is damaged.
        if digest is None and told is not None:
            yield f"{episode} has no result any more, and the chain knows one"
        elif digest and told is None:
            yield (
                f"{episode} has a result that the chain does not know; if the study was killed, "
                "the same bench command adds it"
            )
        elif digest is not None and told is not None and digest != told:
            yield f"{episode} has another result than the one that was chained last"
