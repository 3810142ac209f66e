"""Drive the body yourself: observe, act, read the feedback. There is no model here.

An action server is what a mind has of a body: views, typed actions, truthful feedback.
"""

from __future__ import annotations

from adamo_vh import create_engine
from adamo_vh.action import Drop, Look, Pick
from adamo_vh.action_server import LocalActionServer


def main() -> None:
    """Find the plate, take it, put it on the floor."""
    world = create_engine("s1")
    world.reset(0)
    body = LocalActionServer(world, resolution=(1280, 720))

    view = body.observe().observation
    print("in view:", ", ".join(item.tag for item in view.objects))
    plate = next(item for item in view.objects if item.tag.startswith("Plate"))

    for action in (
        Look(plate.position.x, plate.position.y, plate.position.z),
        Pick(plate.tag),
        Drop(plate.tag, -1.5, -2.5, 0.0),
        Pick("Plate_999"),  # No such thing was ever seen: a refusal, and nothing happens.
    ):
        result = body.execute(action)
        print(f"{type(action).__name__:5}", result.feedback.text)
    world.close()


if __name__ == "__main__":
    main()
