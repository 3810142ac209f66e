"""`adamo-vh run --agent-cmd`: a program of the user's own plays an episode and is scored."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from rich.console import Console

from adamo_vh.cli.episode import mark_latest, run_folder, show_result
from adamo_vh.cli.progress import Progress
from adamo_vh.cli.terminal import complain, line
from adamo_vh.episode.config import EpisodeConfig
from adamo_vh.episode.sealing import sign_run
from adamo_vh.extras import extra
from adamo_vh.record.signing import Signer
from adamo_vh.record.trajectory import Observer

_LAST_LINES = 5


def play_and_show(
    instruction: str | None,
    command: str,
    *,
    isolation: str,
    passed: list[str],
    shown: list[Path],
    out: Path | None,
    sign: Path | None,
    as_json: bool,
    **settings: Any,
) -> None:
    """Let a program play and print what happens, or one JSON object at the end.

    Raises:
        ConfigError: A setting is wrong, or the extra `mcp` is missing.
    """
    with extra("mcp", "--agent-cmd"):
        from adamo_vh.service.agent.playing import FOLDER, Program, play_program
    signer = Signer(sign) if sign else None
    config = EpisodeConfig.of(instruction, **settings)
    observers: list[Observer] = [] if as_json else [Progress(Console())]
    program = Program(command, isolation, tuple(passed), tuple(shown))
    with run_folder(out, config.task or config.instruction) as folder:
        result = play_program(
            program,
            {**settings, "instruction": instruction},
            folder,
            watch=complain,
            observers=observers,
        )
        mark_latest(folder)
    if signer is not None:
        sign_run(folder, signer)
    if not as_json:
        _show_said(folder / FOLDER / "stderr.txt")
    show_result(result, folder, as_json=as_json)


def _show_said(path: Path) -> None:
    """The last lines that a program wrote beside its output."""
    last = path.read_text(encoding="utf-8").strip().splitlines()[-_LAST_LINES:]
    if last:
        line("it wrote", "\n".join(last))
