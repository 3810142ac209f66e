"""The one thread of a process that touches OpenGL, and what it opens.

What a context holds is freed in whatever context is current then, and a context is current in one
thread only. So one thread opens, draws and frees for all engines of the process, whichever thread
they are used in or forgotten by.
"""

from __future__ import annotations

import atexit
import ctypes
import os
import sys
import threading
from collections.abc import Callable, Sequence
from concurrent.futures import Future, wait
from functools import partial
from queue import SimpleQueue
from typing import Any, TypeVar

from adamo_vh.errors import RenderingError

_T = TypeVar("_T")

_FIX = "install one with 'apt-get install libegl1 libopengl0 libgl1-mesa-dri' (or libosmesa6)"
_NO_GL = (
    ImportError,
    RuntimeError,
    AttributeError,
    OSError,
    TypeError,
    ValueError,
    ctypes.ArgumentError,
)
"""What a missing or broken OpenGL library raises, depending on which part is missing."""
_BACKENDS = ("egl", "osmesa")
_FORKED = (
    "This process was forked from one that had already drawn, and OpenGL does not survive a fork. "
    "Start workers with multiprocessing.get_context('spawn'), e.g. "
    "ProcessPoolExecutor(mp_context=get_context('spawn')), or fork before the first picture."
)


class _GraphicsThread:
    """Carries jobs out one after another until the process ends."""

    def __init__(self) -> None:
        self.process = os.getpid()
        # Its put may be called from anywhere, a garbage collection within another put too.
        self._jobs: SimpleQueue[Callable[[], None] | None] = SimpleQueue()
        self._thread = threading.Thread(target=self._work, name="adamo-vh-graphics", daemon=True)
        self._thread.start()

    def _work(self) -> None:
        while (job := self._jobs.get()) is not None:
            job()
            # Nothing of a job may live on here: it would keep an engine from being forgotten.
            del job

    def later(self, job: Callable[[], None]) -> None:
        """Have a job done that nobody waits for; what it raises is lost."""
        self._jobs.put(partial(_carry_out, job, Future()))

    def now(self, job: Callable[[], _T]) -> _T:
        """Have a job done and wait for what it gives or raises."""
        if threading.current_thread() is self._thread:
            return job()
        answer: Future[_T] = Future()
        self._jobs.put(partial(_carry_out, job, answer))
        try:
            return answer.result()
        except BaseException:
            # Also after Ctrl-C the world must not change while it is being drawn.
            wait([answer])
            raise

    def stop(self) -> None:
        """End the thread: at exit nothing may be drawn any more."""
        if self.process == os.getpid():
            self._jobs.put(None)
            self._thread.join(timeout=5.0)


def _carry_out(job: Callable[[], _T], answer: Future[_T]) -> None:
    try:
        answer.set_result(job())
    except BaseException as fault:
        answer.set_exception(fault)


_lock = threading.Lock()
_threads: list[_GraphicsThread] = []
"""The thread, once it is needed."""


def check_process() -> None:
    """Make sure that this process may draw.

    Raises:
        RenderingError: It was forked after its parent had drawn; names the fix.
    """
    if _threads and _threads[0].process != os.getpid():
        raise RenderingError(_FORKED)


def _thread() -> _GraphicsThread:
    check_process()
    with _lock:
        if not _threads:
            _threads.append(_GraphicsThread())
            atexit.register(_threads[0].stop)
    return _threads[0]


def in_graphics_thread(job: Callable[[], _T]) -> _T:
    """Have a job done by the thread that owns OpenGL, and wait for it.

    Raises:
        RenderingError: The process was forked after its parent had drawn.
    """
    return _thread().now(job)


def free_later(free: Callable[[], None]) -> None:
    """Have graphics memory freed by its owner; from any thread, a finaliser too."""
    if _threads and _threads[0].process == os.getpid():
        _threads[0].later(free)


def open_gl(width_px: int, height_px: int) -> Any:
    """Open an off-screen OpenGL context: EGL, else OSMesa; `MUJOCO_GL` decides where it is set.

    Only the graphics thread calls this.

    Returns:
        A context with `make_current` and `free`.

    Raises:
        RenderingError: Neither works; names the packages that help.
    """
    asked = _asked_backend()
    problems = []
    for backend in [asked] if asked else _BACKENDS:
        try:
            return _open_backend(backend, width_px, height_px)
        except _NO_GL as error:
            problems.append(f"{backend}: {error}")
    raise RenderingError(
        f"No OpenGL to draw with ({'; '.join(problems)}); {_fix(asked, problems)}."
    )


def load_mujoco() -> None:
    """Import MuJoCo, which looks for what `MUJOCO_GL` names when it is first imported.

    Raises:
        RenderingError: It names what is not there; says what to set.
    """
    asked = _asked_backend()
    device = os.environ.get("MUJOCO_EGL_DEVICE_ID")
    if device and not device.strip().isdecimal():
        raise RenderingError(
            f"MUJOCO_EGL_DEVICE_ID is {device!r}; unset it, or set it to a device's number, like 0."
        )
    try:
        import mujoco  # noqa: F401
    except _NO_GL as error:
        if not asked:
            raise
        # What a failed import leaves behind would hide the reason the next time.
        for name in [n for n in sys.modules if n.split(".")[0] in ("mujoco", "OpenGL")]:
            del sys.modules[name]
        raise RenderingError(
            f"MUJOCO_GL is {asked!r}, whose library is missing here; {_fix(asked, ())}."
        ) from error


def _asked_backend() -> str:
    """What `MUJOCO_GL` asks for; empty if it leaves the choice."""
    asked = os.environ.get("MUJOCO_GL", "").lower().strip()
    if asked and asked not in _BACKENDS:
        raise RenderingError(
            f"MUJOCO_GL is {asked!r}: ADAMO draws off screen with egl or osmesa; set one of these "
            "or unset it."
        )
    return asked


def _fix(asked: str, problems: Sequence[str]) -> str:
    """What helps if no OpenGL could be opened."""
    device = os.environ.get("MUJOCO_EGL_DEVICE_ID")
    missing = any(problem.startswith("egl: libEGL") for problem in problems)
    if device and asked != "osmesa" and not missing:
        return f"unset MUJOCO_EGL_DEVICE_ID, which is {device!r}, or set it to a device's number"
    if asked == "osmesa":
        return "install it with 'apt-get install libosmesa6', or unset MUJOCO_GL"
    return _FIX


def _open_backend(backend: str, width_px: int, height_px: int) -> Any:
    library = {"egl": "libEGL.so.1", "osmesa": "libOSMesa.so.8"}[backend]
    if sys.platform == "linux":
        ctypes.CDLL(library)
    if os.environ.get("PYOPENGL_PLATFORM", backend) != backend:
        # PyOpenGL binds to one platform at import; a failed first choice must be unloaded.
        for name in [n for n in sys.modules if n.split(".")[0] == "OpenGL"]:
            del sys.modules[name]
        sys.modules.pop("mujoco.egl", None)
        sys.modules.pop("mujoco.egl.egl_ext", None)
    os.environ["PYOPENGL_PLATFORM"] = backend
    if backend == "egl":
        from mujoco.egl import GLContext
    else:
        from mujoco.osmesa import GLContext
    return GLContext(width_px, height_px)


def backend_name() -> str:
    """Which OpenGL this machine draws with: a context is opened and freed to see.

    Raises:
        RenderingError: None works.
    """
    load_mujoco()

    def opened() -> str:
        context = open_gl(64, 64)
        context.make_current()
        name = type(context).__module__.rpartition(".")[2]
        context.free()
        return name

    return in_graphics_thread(opened)
