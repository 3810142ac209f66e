"""What holds for every test: no provider is ever called, and drawing leaves cores to the others."""

from __future__ import annotations

import gc
import os
from collections.abc import Generator, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import settings

if TYPE_CHECKING:
    from adamo_vh.runtime.builtin import BuiltinEngine
    from adamo_vh.session.lending import LentWorld

# Set before anything imports MuJoCo, and inherited by the subprocesses that tests start.
os.environ["ADAMO_VH_NO_REMOTE"] = "1"
# One thread for each worker's software OpenGL: workers share few cores.
os.environ.setdefault("LP_NUM_THREADS", "1")
# Baked assets are built atomically, so all workers and all runs share one cache.
os.environ.setdefault(
    "ADAMO_VH_CACHE_DIR", str(Path(__file__).resolve().parents[1] / ".cache" / "adamo-tests")
)

# How long an example takes says nothing on a machine that is shared. The examples are the same in
# every run, so that a red gate is the change's own fault; `make test-all` looks for new ones, and
# for more of them.
_EXPLORES = "ADAMO_VH_EXPLORE" in os.environ
settings.register_profile(
    "adamo",
    parent=settings(),
    deadline=None,
    derandomize=not _EXPLORES,
    max_examples=100 if _EXPLORES else 40,
)
settings.load_profile("adamo")


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Collect without looking for garbage, and afterwards look for it among what is new alone.

    Thousands of tests and their modules are made here, which live as long as the worker: going
    through them again and again took a quarter of the collection.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.collect()
        gc.freeze()
        gc.enable()


@pytest.fixture(scope="module")
def one_authority(tmp_path_factory: pytest.TempPathFactory) -> Iterator[None]:
    """One certificate authority in place of all, for tests that make many clients.

    Nothing that they send leaves this machine, and to read all takes longer than many a test.
    """
    import certifi

    end = "-----END CERTIFICATE-----\n"
    first = Path(certifi.where()).read_text("utf-8").partition(end)[0] + end
    file = tmp_path_factory.mktemp("authority") / "one.pem"
    file.write_text(first, "utf-8")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SSL_CERT_FILE", str(file))
        yield


@pytest.fixture(scope="session")
def s1_engine() -> Iterator[BuiltinEngine]:
    """One engine of scene S1 for all tests of a worker; use it through `engine`."""
    from adamo_vh.runtime.builtin import BuiltinEngine

    made = BuiltinEngine("s1")
    yield made
    made.close()


@pytest.fixture(scope="session")
def bare_scene(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A scene file: S1 with two of its objects. Its engine is made in a third of the time."""
    from dataclasses import replace

    from adamo_vh.runtime.scenes.scene import load_scene
    from adamo_vh.runtime.scenes.writing import scene_toml

    full = load_scene("s1")
    file = tmp_path_factory.mktemp("scene") / "bare.toml"
    file.write_text(scene_toml(replace(full, name="bare", objects=full.objects[:2])), "utf-8")
    return str(file)


@pytest.fixture(scope="session")
def s2_engine() -> Iterator[BuiltinEngine]:
    """One engine of scene S2 for all tests of a worker; reset it before use."""
    from adamo_vh.runtime.builtin import BuiltinEngine

    made = BuiltinEngine("s2")
    yield made
    made.close()


@pytest.fixture
def engine(s1_engine: BuiltinEngine) -> BuiltinEngine:
    """Scene S1, just reset."""
    s1_engine.reset(0)
    return s1_engine


@pytest.fixture
def lent(engine: BuiltinEngine) -> LentWorld:
    """Scene S1 for one episode, whose record is that of an engine made for it."""
    from adamo_vh.session.lending import Lender

    return Lender(engine).lend()
