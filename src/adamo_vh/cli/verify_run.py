"""`adamo-vh verify-run`: whether a run, or a study, is what its files say."""

from __future__ import annotations

from dataclasses import asdict
from pathlib import Path

import typer

from adamo_vh.cli.exits import Exit
from adamo_vh.cli.terminal import put_json, say
from adamo_vh.record.signing import read_public_key
from adamo_vh.session.verifying import Verified, verify_run
from adamo_vh.study.store import is_study
from adamo_vh.study.verifying import ChainVerified, verify_chain, verify_episodes

_NO_DIGEST = "no digest (written by an older version)"


def verify_and_show(folder: Path, key: Path | None, *, replayed: bool, as_json: bool) -> None:
    """Check a run or a study; exit 1 if anything in it is not as it was recorded."""
    public = read_public_key(key) if key else ""
    if is_study(folder):
        is_well = _study(folder, public, replayed, as_json)
    else:
        found = verify_run(folder, key=public, replayed=replayed)
        is_well = not found.problems
        if as_json:
            put_json({"ok": is_well, **asdict(found)})
        else:
            _say_run(found, replayed)
    if not is_well:
        raise typer.Exit(Exit.NO)


def _say_run(found: Verified, replayed: bool) -> None:
    for problem in found.problems:
        say(f"Different: {problem}")
    if not found.problems:
        again = f"every state hash equal in {found.steps} steps" if replayed else "not replayed"
        say(f"Same: {_sealed(found)}; {again}; {_signed(found.signed_by)}.")
    elif not found.digest:
        say(f"It has {_NO_DIGEST}.")


def _sealed(found: Verified) -> str:
    return f"digest {found.digest}" if found.digest else _NO_DIGEST


def _signed(who: str) -> str:
    return f"signed by {who}" if who else "not signed"


def _study(folder: Path, key: str, replayed: bool, as_json: bool) -> bool:
    """Check a study; whether all is well."""
    runs: dict[str, Verified] = {}
    for episode, found in verify_episodes(folder, key=key, replayed=replayed):
        runs[episode] = found
        if not as_json:
            for problem in found.problems:
                say(f"Different: {episode}: {problem}")
    chain = verify_chain(folder, key=key)
    unsealed = [episode for episode, found in runs.items() if not found.digest]
    wrong = {episode: found.problems for episode, found in runs.items() if found.problems}
    is_well = not wrong and not chain.problems
    if as_json:
        put_json(
            {
                "ok": is_well,
                "study": str(folder),
                "episodes": len(runs),
                "without_digest": unsealed,
                "steps": sum(found.steps or 0 for found in runs.values()) if replayed else None,
                "signed_by": sorted({found.signed_by for found in runs.values()} - {""}),
                "chain": asdict(chain),
                "problems": wrong,
            }
        )
        return is_well
    for problem in chain.problems:
        say(f"Different: {problem}")
    _say_study(chain, runs, unsealed, replayed)
    return is_well


def _say_study(
    chain: ChainVerified, runs: dict[str, Verified], unsealed: list[str], replayed: bool
) -> None:
    if unsealed:
        say(f"{len(unsealed)} of {len(runs)} episodes have {_NO_DIGEST}, e.g. {unsealed[0]}.")
    for episode in chain.repeated:
        say(f"Note: {episode} has more than one result in the chain: retried, or scored again.")
    good = sum(not found.problems for found in runs.values())
    steps = sum(found.steps or 0 for found in runs.values())
    again = f"{steps} steps executed again" if replayed else "not replayed"
    linked = f"chain of {chain.links} ends in {chain.head}" if chain.links else "no chain"
    who = ", ".join(chain.signed_by)
    say(f"{good} of {len(runs)} episodes are the same; {again}; {linked}; {_signed(who)}.")
