"""The fixed instructions (system prompt), filled in from the scene, the tools and the labeling."""

from __future__ import annotations

from collections.abc import Iterable

from adamo_vh.action import tool_schema
from adamo_vh.cognition.profile import PAPER, SWITCHES, Profile
from adamo_vh.cognition.prompts import render
from adamo_vh.engine import SceneInfo
from adamo_vh.perception import Labeling, Tagger


def system_prompt(
    scene: SceneInfo,
    labeling: Tagger,
    actions: Iterable[type],
    near_m: float,
    profile: Profile = PAPER,
) -> str:
    """Render the system prompt.

    Args:
        scene: Room extent and areas.
        labeling: How tags are made.
        actions: Action types on offer.
        near_m: What "near" means, metres.
        profile: Which of the prompt's sentences apply.
    """
    corners = [area for area in scene.areas if area.kind == "corner"]
    schemas = [tool_schema(action) for action in actions]
    switches = {name: getattr(profile, name) for name in SWITCHES}
    return render(
        "system",
        x_min=f"{scene.x_min:g}",
        x_max=f"{scene.x_max:g}",
        y_min=f"{scene.y_min:g}",
        y_max=f"{scene.y_max:g}",
        corner_m=f"{corners[0].x_max - corners[0].x_min:g}" if corners else "",
        near_m=f"{near_m:g}",
        labeling=f"- {_described(labeling, profile)}",
        **switches,
        tools=", ".join(f"{s.name}({', '.join(s.parameters['properties'])})" for s in schemas),
    )


def _described(labeling: Tagger, profile: Profile) -> str:
    """What the model is told about tags: nothing of looks where there are none."""
    if labeling is Labeling.OPAQ and not profile.has_pictures:
        return "A tag is a number that says nothing about the object."
    return labeling.described
