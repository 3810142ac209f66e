"""One thread owns OpenGL: engines work in every thread, and none spoils another's pictures."""

from __future__ import annotations

import gc
import subprocess
import sys
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from adamo_vh.action_server import LocalActionServer
from adamo_vh.errors import EngineError, RenderingError
from adamo_vh.geometry import Camera, Vec3
from adamo_vh.runtime.builtin import BuiltinEngine
from adamo_vh.runtime.graphics import in_graphics_thread
from adamo_vh.runtime.rendering import Drawing

SMALL = (320, 180)


def drawn(engine: BuiltinEngine) -> bytes:
    """The view, drawn again."""
    engine.stage.forget()
    return engine.capture(*SMALL).rgb.tobytes()


@pytest.mark.parametrize(("in_a_cycle", "in_a_thread"), [(False, False), (True, True)])
def test_an_engine_that_is_forgotten_spoils_no_picture(
    engine: BuiltinEngine, in_a_cycle: bool, in_a_thread: bool
) -> None:
    before = drawn(engine)

    def forget_one() -> None:
        other = BuiltinEngine("s1")
        other.capture(*SMALL)
        if in_a_cycle:
            other.me = other  # type: ignore[attr-defined]
        del other
        gc.collect()

    if in_a_thread:
        thread = threading.Thread(target=forget_one)
        thread.start()
        thread.join()
    else:
        forget_one()
    assert drawn(engine) == before


def test_what_a_forgotten_engine_drew_with_is_freed() -> None:
    other = BuiltinEngine("s1")
    other.capture(*SMALL)
    uploaded, gl = other.stage.renderer._painter.context, other.stage.renderer._gl
    del other
    gc.collect()
    in_graphics_thread(lambda: None)
    assert gl._context is None
    assert uploaded.baseMesh == uploaded.offFBO == 0


def test_an_engine_works_in_every_thread(engine: BuiltinEngine) -> None:
    alone = drawn(engine)
    with ThreadPoolExecutor(1) as pool:
        assert pool.submit(drawn, engine).result() == alone
        made = pool.submit(BuiltinEngine, "s1").result()
    assert drawn(made) == alone
    made.close()


def test_calls_from_many_threads_wait_for_each_other(engine: BuiltinEngine) -> None:
    """Whatever the order, every view is the picture of one state, and every state is sound."""
    faults: list[BaseException] = []

    def live(number: int) -> None:
        server = LocalActionServer(engine, resolution=SMALL)
        try:
            for step in range(4):
                engine.body.walk(Vec3(-2.0 + 0.3 * number, -3.0 + 0.3 * step, 0.0))
                engine.body.look(Vec3(0.0, -1.0, 0.8))
                server.observe()
                engine.restore(engine.snapshot())
        except BaseException as fault:
            faults.append(fault)

    threads = [threading.Thread(target=live, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert faults == []


def test_ctrl_c_leaves_no_half_drawn_world(engine: BuiltinEngine) -> None:
    alone = drawn(engine)

    def interrupted() -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        in_graphics_thread(interrupted)
    assert drawn(engine) == alone


FORKED = """
import os, sys, adamo_vh
engine = adamo_vh.create_engine({{scene!r}})
{before}
pid = os.fork()
if pid == 0:
    try:
        {inside}
        print("drawn", flush=True)
    except adamo_vh.AdamoError as error:
        print(error, flush=True)
    sys.exit(0)
print("exit", os.waitpid(pid, 0)[1], flush=True)
"""
DRAW = "engine.capture(64, 36)"
NEW = "adamo_vh.create_engine({scene!r})"


@pytest.mark.parametrize(
    ("before", "inside", "works"),
    [(DRAW, f"engine.stage.forget(); {DRAW}", False), (DRAW, NEW, False), ("pass", DRAW, True)],
)
def test_after_a_fork_there_is_an_answer_at_once(
    before: str, inside: str, works: bool, bare_scene: str
) -> None:
    program = FORKED.format(before=before, inside=inside).format(scene=bare_scene)
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=60, check=True
    )
    child, parent = done.stdout.splitlines()
    assert parent == "exit 0"
    assert child == "drawn" if works else "get_context('spawn')" in child


@pytest.mark.parametrize("end", ["", "engine.me = engine; del engine", "1 / 0"])
def test_a_process_ends_well_with_engines_that_nobody_closed(end: str, bare_scene: str) -> None:
    program = f"import adamo_vh; engine = adamo_vh.create_engine({bare_scene!r}); {DRAW}; {end}"
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert done.returncode == (1 if "/" in end else 0)
    assert "Traceback" not in done.stderr or "ZeroDivisionError" in done.stderr


def freed_by_others(engine: BuiltinEngine) -> None:
    """What a carelessly written neighbour does: it frees its own numbers in our context."""
    renderer = engine.stage.renderer

    def free() -> None:
        renderer._gl.make_current()
        renderer._painter.context.free()

    in_graphics_thread(free)


def black(engine: BuiltinEngine) -> None:
    draw = engine.stage.renderer.draw

    def dark(data: Any, camera: Camera, **how: bool) -> Drawing:
        drawn = draw(data, camera, **how)
        return replace(drawn, rgb=np.zeros_like(drawn.rgb))

    engine.stage.renderer.draw = dark  # type: ignore[method-assign]


def of_another_state(engine: BuiltinEngine) -> None:
    """Ids as they were from elsewhere."""
    renderer = engine.stage.renderer
    kept = renderer.draw(engine.data, engine.body.stance.camera(*SMALL))
    renderer.draw = lambda *_, **__: kept  # type: ignore[method-assign]
    engine.body.look(Vec3(0.3, -0.4, 0.8))


@pytest.mark.parametrize("spoil", [freed_by_others, black, of_another_state])
def test_a_wrong_picture_is_an_error_and_nothing_else(
    spoil: Callable[[BuiltinEngine], None],
) -> None:
    engine = BuiltinEngine("s1")
    server = LocalActionServer(engine, resolution=SMALL)
    server.observe()
    spoil(engine)
    engine.stage.forget()
    with pytest.raises(EngineError, match=r"wrong picture|freed what"):
        server.observe()


def test_a_closed_renderer_says_so() -> None:
    engine = BuiltinEngine("s1")
    renderer = engine.stage.renderer
    renderer.close()
    renderer.close()
    with pytest.raises(RenderingError, match="was closed"):
        renderer.color(engine.data, engine.body.stance.camera(*SMALL))
