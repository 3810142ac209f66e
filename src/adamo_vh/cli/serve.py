"""`adamo-vh serve`: the body for programs from outside, until the process is told to stop."""

from __future__ import annotations

import os
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from adamo_vh.cli.episode import RUNS
from adamo_vh.cli.listening import NEW, key_of, names_of, told_to_stop
from adamo_vh.cli.terminal import say
from adamo_vh.errors import ConfigError
from adamo_vh.extras import extra
from adamo_vh.serving.admission import Rules


def serve(
    address: str,
    port: int,
    out: Path | None,
    *,
    token: str,
    judge: str,
    hosts: list[str],
    engine: str = "built-in",
    **terms: Any,
) -> None:
    """Serve the body until the process is told to stop; every record is whole then.

    Args:
        address: Where to listen.
        port: The port; 0 for a free one.
        out: Where run folders go.
        token: What players bring; empty for none.
        judge: What a judge brings; `NEW` to make one up, empty for no judge.
        hosts: Further names under which this machine may be asked.
        engine: built-in, or remote for those that dial in.
        **terms: What is offered; see `adamo_vh.service.hosting.Terms`.

    Raises:
        ConfigError: A setting is wrong, the port is taken, or the extra `serve` is missing.
    """
    with extra("serve", "The service"):
        from adamo_vh.service.app import FACES, MAX_BODY_BYTES, serving
        from adamo_vh.service.engines.face import dialled_engines, engine_face
    from adamo_vh.action_server.wire import Create
    from adamo_vh.service.engines.door import PATH, EngineDoor
    from adamo_vh.service.engines.page import PAGE, page_folder
    from adamo_vh.service.hosting import Host, Terms

    player_key, judge_key = key_of(token, "--token"), key_of(judge, "--judge")
    rules = Rules(
        MAX_BODY_BYTES, token=player_key, judge_token=judge_key, hosts=names_of(address, hosts)
    )
    folder = out or RUNS / f"served-{datetime.now(UTC):%Y%m%d-%H%M%S}"
    stop = told_to_stop()
    faces, engines = FACES, None
    if is_remote := _is_remote(engine):
        page = page_folder(os.environ.get(PAGE, ""))
        door = EngineDoor(arrived=lambda name: say(f"engine  {name} dialled in"), page=page)
        faces, engines = (*FACES, engine_face(door)), dialled_engines(door)
    host = Host(folder, Terms(**terms), engines)
    try:
        with serving(host, address=address, port=port, rules=rules, faces=faces) as url:
            if is_remote:
                say(f"engines {url.replace('http', 'ws', 1)}{PATH}")
                if door.page is not None:
                    say(f"or open {url}/ in a browser")
            else:
                # A wrong setting is told now, and the first player does not wait for the engine.
                host.prepare(Create(instruction="Look around."))
            say(f"serving {url}/v1")
            if token == NEW:
                say(f"token   {player_key}")
            if judge == NEW:
                say(f"judge   {judge_key}")
            say(f"records {folder}")
            say(f"try     adamo-vh run --task T1 --body {url}")
            say("stop    Ctrl+C")
            stop.wait()
    finally:
        host.close_all()
    say("stopped; every record is whole")


def _is_remote(engine: str) -> bool:
    """Whether engines dial in.

    Raises:
        ConfigError: There is no such kind of engine.
    """
    if engine not in ("built-in", "remote"):
        raise ConfigError(f"--engine {engine}: use built-in or remote.")
    return engine == "remote"
