"""A data set in the layout of the Hugging Face Hub: parquet files that `datasets` opens.

Two tables: `turns`, a row for each answer of a model with the pictures it was given, and
`episodes`, a row an episode. Rows are written as they are read, an episode at a time.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from adamo_vh.adapters.exports.form import Form
from adamo_vh.adapters.exports.recorded import Episode
from adamo_vh.extras import needed
from adamo_vh.files import make_folder, naming, write_whole
from adamo_vh.record.trajectory import Observed, Shown
from adamo_vh.report.timeline import Deed, ShownTurn, turns

DATA, CARD = "data", "README.md"
_MOST_BYTES = 400_000_000
"""Of a file; then a new one is begun, at an episode's end."""

_IMAGE = "image"
_COLUMNS: Mapping[str, Mapping[str, Any]] = {
    "turns": {
        "episode": "string",
        "turn": "int64",
        "instruction": "string",
        "image": _IMAGE,
        "closeups": [_IMAGE],
        "state_text": "string",
        "note": "string",
        "actions": [
            {
                "name": "string",
                "arguments": "string",
                "feedback": "string",
                "outcome": "string",
                "code": "string",
            }
        ],
        "ending": "string",
        "answer": "string",
        "input_tokens": "int64",
        "output_tokens": "int64",
    },
    "episodes": {
        "episode": "string",
        "instruction": "string",
        "task": "string",
        "scene": "string",
        "variation": "int64",
        "labeling": "string",
        "model": "string",
        "model_kind": "string",
        "profile": "string",
        "seed": "int64",
        "system_prompt": "string",
        "turns": "int64",
        "steps": "int64",
        "termination": "string",
        "answer": "string",
        "completion": "float64",
        "strict": "float64",
        "input_tokens": "int64",
        "output_tokens": "int64",
        "cost_usd": "float64",
    },
}
"""Columns of each table. An image is the file's bytes; null where none was shown, and a number is
null where it is not known."""

_CARD = """---
configs:
- config_name: turns
  default: true
  data_files: data/turns-*.parquet
- config_name: episodes
  data_files: data/episodes-*.parquet
---

# Episodes recorded with ADAMO

`turns` has a row for each answer of a model: the view and the text that it was given, and what it
did. `episodes` has a row an episode: how it was set up and what came of it. Both share the column
`episode`.
"""


def write_parquet(episodes: Iterable[Episode], folder: Path, form: Form) -> int:
    """Write episodes as a data set.

    Args:
        episodes: What is exported.
        folder: Takes `data/` and a `README.md` that says how the files belong together.
        form: Nothing of it matters here.

    Returns:
        How many episodes were written.

    Raises:
        ConfigError: The extra is not installed.
    """
    needed("pyarrow", "export")
    count = 0
    with _Table("turns", folder) as rows, _Table("episodes", folder) as heads:
        for episode in episodes:
            with episode.tolerated():
                rows.add(list(_turns(episode)))
                heads.add([_episode(episode)])
                count += 1
    write_whole(folder / CARD, _CARD.encode())
    return count


class _Table:
    """The files of one table, each closed when it is full."""

    def __init__(self, name: str, folder: Path) -> None:
        import pyarrow as pa

        self._name = name
        self._folder = make_folder(folder / DATA)
        columns = _COLUMNS[name]
        features = {column: _feature(kind) for column, kind in columns.items()}
        told = json.dumps({"info": {"features": features}})
        fields = [(column, _arrow(kind)) for column, kind in columns.items()]
        self._schema = pa.schema(fields, metadata={"huggingface": told})
        self._writer: Any = None
        self._path = Path()
        self._files = 0

    def add(self, rows: list[dict[str, Any]]) -> None:
        """Write rows; they stay together in one file."""
        import pyarrow as pa
        from pyarrow import parquet

        if self._writer is None:
            self._path = self._folder / f"{self._name}-{self._files:05d}.parquet"
            self._files += 1
            self._writer = parquet.ParquetWriter(self._path, self._schema, compression="zstd")
        with naming("written", self._path):
            self._writer.write_table(pa.Table.from_pylist(rows, schema=self._schema))
        if self._path.stat().st_size > _MOST_BYTES:
            self._close()

    def _close(self) -> None:
        if self._writer is not None:
            self._writer.close()
            self._writer = None

    def __enter__(self) -> _Table:
        return self

    def __exit__(self, *_: object) -> None:
        if not self._files:
            self.add([])  # A table without rows still has its columns.
        self._close()


def _feature(kind: Any) -> Any:
    """A column in the words of `datasets`."""
    if isinstance(kind, list):
        return [_feature(kind[0])]
    if isinstance(kind, Mapping):
        return {name: _feature(inner) for name, inner in kind.items()}
    return {"_type": "Image"} if kind == _IMAGE else {"dtype": kind, "_type": "Value"}


def _arrow(kind: Any) -> Any:
    """A column's type in the file."""
    import pyarrow as pa

    if isinstance(kind, list):
        return pa.list_(_arrow(kind[0]))
    if isinstance(kind, Mapping):
        return pa.struct([(name, _arrow(inner)) for name, inner in kind.items()])
    if kind == _IMAGE:
        return pa.struct([("bytes", pa.binary()), ("path", pa.string())])
    return {"string": pa.string, "int64": pa.int64, "float64": pa.float64}[kind]()


def _turns(episode: Episode) -> Iterator[dict[str, Any]]:
    instruction, number = episode.manifest.config.instruction, 0
    for turn in turns(episode.trajectory):
        if turn.started is not None:
            instruction = turn.started.instruction
        if turn.thought is None:
            continue
        number += 1
        yield _turn(episode, turn, number, instruction)


def _turn(episode: Episode, turn: ShownTurn, number: int, instruction: str) -> dict[str, Any]:
    assert turn.thought is not None
    reply = turn.thought.reply
    shown = [picture.event for deed in turn.deeds for picture in deed.pictures]
    return {
        "episode": episode.name,
        "turn": number,
        "instruction": instruction,
        "image": None if turn.view is None else _image(episode, turn.view),
        "closeups": [_image(episode, event) for event in shown if isinstance(event, Shown)],
        "state_text": turn.thought.state_text,
        "note": turn.note,
        "actions": [_action(deed) for deed in turn.deeds],
        "ending": str(reply.ending),
        "answer": turn.thought.turn.answer if turn.thought.turn.ends else "",
        "input_tokens": reply.usage.input_tokens,
        "output_tokens": reply.usage.output_tokens,
    }


def _image(episode: Episode, event: Observed | Shown) -> dict[str, Any]:
    return {"bytes": episode.picture(event).data, "path": event.frame}


def _action(deed: Deed) -> dict[str, str]:
    act = deed.act
    arguments = {name: json.loads(value) for name, value in deed.call.arguments}
    told = {"name": deed.call.name, "arguments": json.dumps(arguments, ensure_ascii=False)}
    if act is None:
        feedback, outcome, code = deed.left_out, "left_out" if deed.left_out else "", ""
    else:
        feedback, outcome = act.feedback.text, str(act.feedback.outcome)
        code = str(act.feedback.code or "")
    return told | {"feedback": feedback, "outcome": outcome, "code": code}


def _episode(episode: Episode) -> dict[str, Any]:
    manifest, result = episode.manifest, episode.result
    config, begun = manifest.config, next(iter(episode.trajectory.events), None)
    row: dict[str, Any] = dict.fromkeys(_COLUMNS["episodes"])
    row |= {
        "episode": episode.name,
        "instruction": config.instruction,
        "task": config.task,
        "scene": config.scene,
        "variation": config.variation,
        "labeling": manifest.labeling or str(config.labeling),
        "model": manifest.model_name,
        "model_kind": str(manifest.model_kind),
        "profile": str(config.profile),
        "seed": config.seed,
        "system_prompt": getattr(begun, "system_prompt", None),
        "turns": len(episode.trajectory.thoughts),
        "steps": len(episode.trajectory.acts),
    }
    if result is None:
        return row
    return row | {
        "termination": str(result.termination),
        "answer": result.answer,
        "completion": result.completion,
        "strict": result.strict,
        "input_tokens": result.usage.input_tokens,
        "output_tokens": result.usage.output_tokens,
        "cost_usd": result.cost_usd,
    }
