"""The commands of `adamo-vh`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from adamo_vh.cli.agent_options import AgentBind, AgentCmd, AgentEnv, Isolation
from adamo_vh.cli.body_options import BodyToken, BodyUrl, JudgeToken
from adamo_vh.cli.engines_app import engines_app
from adamo_vh.cli.exits import listed
from adamo_vh.cli.figure_app import figure_app
from adamo_vh.cli.mcp_app import mcp_app
from adamo_vh.cli.scenes_app import scenes_app
from adamo_vh.cli.serve_app import serve_app
from adamo_vh.cli.speech_app import speech_app
from adamo_vh.cli.studio_app import studio_app
from adamo_vh.cli.study_app import study_app
from adamo_vh.cli.tasks_app import tasks_app
from adamo_vh.inference.uris import HELP

app = typer.Typer(
    help="Give a vision-language model a body in a 3D room, and measure why it succeeds or fails.",
    epilog=listed(),
    no_args_is_help=True,
    pretty_exceptions_enable=False,
)
app.add_typer(tasks_app, name="tasks")
app.add_typer(scenes_app, name="scenes")
models_app = typer.Typer(help="The models.", no_args_is_help=True)
app.add_typer(models_app, name="models")
cache_app = typer.Typer(help="What is kept to be faster.", invoke_without_command=True)
app.add_typer(cache_app, name="cache")
app.add_typer(study_app)
app.add_typer(mcp_app)
app.add_typer(engines_app)
app.add_typer(serve_app)
app.add_typer(speech_app, name="speech")
app.add_typer(studio_app)
app.add_typer(figure_app, name="figure")

_KEYS = ("token", "judge_token")
Json = Annotated[bool, typer.Option("--json", help="Print JSON instead of text.")]
Scene = Annotated[str, typer.Option(help="Built-in scene or scene file.")]
Figure = Annotated[
    str,
    typer.Option(help="Body: mara, jonas, amina, ken, or a file of your own: .glb or .vrm."),
]
Labeling = Annotated[str, typer.Option(help="sem or opaq.")]
Model = Annotated[str, typer.Option(help=HELP)]
ToolCalls = Annotated[
    str, typer.Option(help="How a remote model gives its calls: auto, native, schema or react.")
]
Profile = Annotated[
    str, typer.Option(help="How it is spoken to: paper, paper-exact, lean or single.")
]
Switch = Annotated[
    list[str] | None,
    typer.Option(help="One switch of the profile, e.g. plan=1; may be repeated."),
]
Record = Annotated[
    bool, typer.Option("--record", help="Keep every request and reply as a cassette.")
]
EngineOption = Annotated[
    str,
    typer.Option(
        "--engine", help="built-in; or remote: waits for an engine that dials in (docs/engines.md)."
    ),
]
EnginePort = Annotated[
    int, typer.Option("--engine-port", help="Where to wait for a remote engine; 0 for any port.")
]
RunFolder = Annotated[
    Path | None, typer.Option(help="Run folder; a new one below runs/ by default.")
]


def _tell_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        from adamo_vh.cli.terminal import say

        say(f"adamo-vh {version('adamo-vh')}")
        raise typer.Exit


@app.callback()
def adamo(
    version: Annotated[
        bool,
        typer.Option(
            "--version", help="Say which version it is.", callback=_tell_version, is_eager=True
        ),
    ] = False,
) -> None:
    """Give a vision-language model a body in a 3D room, and measure why it succeeds or fails."""


@app.command()
def run(
    context: typer.Context,
    instruction: Annotated[
        str | None, typer.Argument(help="What the agent is told.", show_default=False)
    ] = None,
    task: Annotated[
        str | None, typer.Option(help="A task instead: T1 to T15, or a task file.")
    ] = None,
    scene: Scene = "s1",
    figure: Figure = "mara",
    labeling: Labeling = "sem",
    engine: EngineOption = "built-in",
    engine_port: EnginePort = 8020,
    model: Model = "baseline",
    tool_calls: ToolCalls = "auto",
    profile: Profile = "paper",
    switch: Switch = None,
    seed: Annotated[int, typer.Option(help="Seed of the model's draws.")] = 0,
    variation: Annotated[int, typer.Option(help="Variation of the scene; 0 as it stands.")] = 0,
    tool: Annotated[
        list[str] | None,
        typer.Option(help="One more tool, from another package; may be repeated."),
    ] = None,
    k: Annotated[int, typer.Option(help="Steps in the short-term memory.")] = 50,
    grid: Annotated[int, typer.Option(help="Reference points along a side.")] = 6,
    resolution: Annotated[str, typer.Option(help="Frame size, WIDTHxHEIGHT.")] = "1920x1080",
    text: Annotated[str, typer.Option(help="Symbolic text: full or paper.")] = "full",
    max_steps: Annotated[int, typer.Option(help="Step cap.")] = 60,
    max_seconds: Annotated[float, typer.Option(help="Time cap of thinking and acting.")] = 600.0,
    agent_cmd: AgentCmd = None,
    agent_env: AgentEnv = None,
    agent_bind: AgentBind = None,
    isolation: Isolation = "auto",
    body: BodyUrl = None,
    token: BodyToken = "",
    judge_token: JudgeToken = "",
    budget: Annotated[
        list[str] | None,
        typer.Option(
            help="A cap: tokens=50000, usd=0.5, calls=20 or seconds=300; may be repeated."
        ),
    ] = None,
    record: Record = False,
    out: RunFolder = None,
    resume: Annotated[
        Path | None,
        typer.Option(
            help="Go on with an interrupted run; takes --budget, --sign and --json alone."
        ),
    ] = None,
    video: Annotated[
        Path | None, typer.Option(help="Film the episode: FILE.webm, .mp4 (by ffmpeg) or .avi.")
    ] = None,
    sign: Annotated[
        Path | None,
        typer.Option(help="Sign the result with this Ed25519 private key.", metavar="KEYFILE"),
    ] = None,
    json: Json = False,
) -> None:
    """Run one episode: an instruction in plain words, or a task of the benchmark."""
    from adamo_vh.cli.away import run_away
    from adamo_vh.cli.episode import resume_and_show, run_and_show
    from adamo_vh.cli.settings import pairs, read_budget, refuse_if_given, refuse_others
    from adamo_vh.record.termination import Limits

    caps = read_budget(pairs(budget, "budget"))
    if resume is not None:
        refuse_others(context, "resume", "budget", "sign", "json", "engine", "engine_port", *_KEYS)
        resume_and_show(resume, caps, sign, (engine, engine_port), as_json=json)
        return
    settings: dict[str, Any] = {
        "task": task,
        "scene": scene,
        "figure": figure,
        "labeling": labeling,
        "profile": profile,
        "switches": pairs(switch, "switch"),
        "added_tools": tool or (),
        "budget": caps,
        "seed": seed,
        "variation": variation,
        "k": k,
        "grid": grid,
        "resolution": resolution,
        "text_form": text,
        "limits": Limits(max_steps=max_steps, max_seconds=max_seconds),
    }
    if agent_cmd is not None:
        from adamo_vh.cli.agent import play_and_show

        why = "does not go with --agent-cmd; leave it out."
        refuse_if_given(context, why, "model", "tool_calls", "record", "video", "engine", "body")
        settings |= {"isolation": isolation, "passed": agent_env or [], "shown": agent_bind or []}
        play_and_show(instruction, agent_cmd, out=out, sign=sign, as_json=json, **settings)
        return
    refuse_if_given(context, "is for --agent-cmd; add it.", "agent_env", "agent_bind", "isolation")
    settings |= {"model": model, "tool_calls": tool_calls}
    if body is not None:
        run_away(context, instruction, (body, token, judge_token), settings, as_json=json)
        return
    run_and_show(
        instruction,
        as_json=json,
        out=out,
        where=(engine, engine_port),
        record=record,
        video=video,
        sign=sign,
        **settings,
    )


@app.command()
def chat(
    context: typer.Context,
    scene: Scene = "s1",
    figure: Figure = "mara",
    labeling: Labeling = "sem",
    model: Model = "baseline",
    tool_calls: ToolCalls = "auto",
    profile: Profile = "lean",
    switch: Switch = None,
    budget: Annotated[
        list[str] | None,
        typer.Option(help="A cap on the whole conversation, e.g. usd=0.5; may be repeated."),
    ] = None,
    out: RunFolder = None,
    resume: Annotated[
        Path | None, typer.Option(help="Go on with a recorded conversation or episode.")
    ] = None,
    record: Record = False,
) -> None:
    """Talk with the agent: one instruction after another, in the same world, remembered."""
    from adamo_vh.cli.chat import talk
    from adamo_vh.cli.settings import pairs, read_budget, refuse_others

    if resume is not None:
        refuse_others(context, "resume", "budget")
    talk(
        resume=resume,
        out=out,
        record=record,
        scene=scene,
        figure=figure,
        labeling=labeling,
        model=model,
        tool_calls=tool_calls,
        profile=profile,
        switches=pairs(switch, "switch"),
        budget=read_budget(pairs(budget, "budget")),
    )


@app.command()
def replay(
    run_dir: Annotated[Path, typer.Argument(help="A run folder.")],
    start: Annotated[int, typer.Option("--from", help="Begin after this many steps.")] = 0,
    json: Json = False,
) -> None:
    """Execute a recorded episode again, without its model, and verify every state hash."""
    from adamo_vh.cli.episode import replay_and_show

    replay_and_show(run_dir, start, as_json=json)


@app.command()
def explain(
    run_dir: Annotated[Path, typer.Argument(help="A run folder.")], json: Json = False
) -> None:
    """Say why a recorded episode failed: its class, a finer code, and what shows it."""
    from adamo_vh.cli.explain import explain_and_show

    explain_and_show(run_dir, as_json=json)


@models_app.command("check")
def models_check(
    uri: Annotated[str, typer.Argument(help="The model, as for --model of run.")],
    refresh: Annotated[bool, typer.Option("--refresh", help="Ask it again.")] = False,
    json: Json = False,
) -> None:
    """Ask a model a few small questions: is it there, does it see, does it call tools?"""
    from adamo_vh.cli.models import check

    check(uri, refresh=refresh, as_json=json)


@app.command()
def doctor(json: Json = False) -> None:
    """Check this machine: graphics, cache, keys, versions; every problem comes with its fix."""
    from adamo_vh.cli.doctor import examine

    examine(as_json=json)


@cache_app.callback()
def cache(context: typer.Context, json: Json = False) -> None:
    """Say where the cache is and what it holds."""
    if context.invoked_subcommand is None:
        from adamo_vh.cli.cache import show

        show(as_json=json)


@cache_app.command("clear")
def cache_clear(json: Json = False) -> None:
    """Remove what the cache holds; it is made again when it is needed."""
    from adamo_vh.cli.cache import clear

    clear(as_json=json)


@app.command("serve-model")
def serve_model(
    model: Annotated[
        str, typer.Argument(help="baseline, random, scripted:FILE.json or cassette:DIR.")
    ] = "baseline",
    port: Annotated[int, typer.Option(help="Port; 0 for a free one.")] = 8010,
    host: Annotated[str, typer.Option(help="A loopback address; no other is served.")] = (
        "127.0.0.1"
    ),
    tools: Annotated[
        bool,
        typer.Option(
            "--tools/--no-tools",
            help="Without, the model has no tool calling: it writes JSON steps if the request "
            "brings their schema, else Thought, Action and Action Input as text.",
        ),
    ] = True,
    faults: Annotated[
        Path | None,
        typer.Option(
            help="TOML file of what goes wrong on purpose. Each fault table has a what (error with "
            "status and retry_after_s, error_in_200, refused_parameter with parameter, hang or "
            "slow with seconds, reset, half_body, bad_json, empty_reply, unknown_tool, "
            "wrong_arguments, broken_arguments, two_calls, leaked_call with style) and one of "
            "every (every Nth request), requests (a list of numbers) and probability. Example: "
            "docs/serve-model.md."
        ),
    ] = None,
) -> None:
    """Serve a local model as an OpenAI-compatible endpoint, for any client on this machine."""
    from adamo_vh.cli.serve_model import serve

    serve(model, host, port, faults, tools=tools)
