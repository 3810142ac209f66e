"""The ids under which Gymnasium finds our rooms: `adamo_vh/S1-T10-v0` and so on."""

from __future__ import annotations

NAMESPACE = "adamo_vh"
ANY_ROOM = f"{NAMESPACE}/Room-v0"
"""Takes scene and task as arguments, own files too."""
_ENTRY = "adamo_vh.adapters.gym.environment:RoomEnv"


def register() -> None:
    """Register every scene with every task, and a room that takes both as arguments.

    Gymnasium calls it by itself where ADAMO is installed. Twice is no fault.
    """
    from gymnasium import register as enter
    from gymnasium import registry

    if ANY_ROOM in registry:
        return
    enter(ANY_ROOM, entry_point=_ENTRY)
    for scene, task in rooms():
        arguments = {"scene": scene, "task": task}
        enter(room_id(scene, task), entry_point=_ENTRY, kwargs=arguments)


def rooms() -> tuple[tuple[str, str], ...]:
    """Every built-in scene with every built-in task that is for it."""
    from adamo_vh.benchmark.tasks import TASKS
    from adamo_vh.session.builtin import scene_names

    return tuple(
        (scene, task.id)
        for scene in scene_names()
        for task in TASKS
        if not task.scenes or scene in task.scenes
    )


def room_id(scene: str, task: str) -> str:
    """The id of a scene with a task."""
    return f"{NAMESPACE}/{scene.upper()}-{task}-v0"
