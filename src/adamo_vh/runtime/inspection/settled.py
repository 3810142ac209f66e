"""From a scene to a world at rest, or to a clear error where the physics cannot take the scene."""

from __future__ import annotations

from adamo_vh.errors import SceneError
from adamo_vh.runtime import physics
from adamo_vh.runtime.human.looks import Figure
from adamo_vh.runtime.inspection.arrangement import inspect_arrangement
from adamo_vh.runtime.scenes.scene import Scene
from adamo_vh.runtime.world import CompiledWorld, build_world, scene_assets


def settled_world(scene: Scene, figure: Figure) -> CompiledWorld:
    """Compile a scene with a person in it, and let everything come to rest.

    Raises:
        SceneError: The scene cannot be simulated; names the field and the fix.
    """
    import mujoco

    # Loaded once for both: reading them is most of what the look at the arrangement takes.
    assets = scene_assets(scene)
    for finding in inspect_arrangement(scene, assets):
        # Simulating a pile would take minutes, and then fill the memory of the physics.
        if finding.blocks:
            raise SceneError(f"{scene.name}: {finding.where}: {finding.problem}; {finding.fix}")
    try:
        world = build_world(scene, figure, assets)
        physics.settle(world, None)
    except (mujoco.FatalError, ValueError) as fault:
        reason = str(fault).partition("\n")[0]
        raise SceneError(
            f"{scene.name}: the physics cannot take it: {reason}; move apart what touches, or "
            "leave something out ('adamo-vh scenes check' with the file tells more)"
        ) from None
    return world
