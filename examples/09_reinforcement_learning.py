"""A room as an environment of Gymnasium: the reward is the completion that a step gained.

Needs the extra: pip install 'adamo-vh[gym]'. Here somebody who knows the room plays; a policy takes
his place, with the picture and the text of each observation.
"""

from __future__ import annotations

import json

import gymnasium

ID = "adamo_vh.gym:adamo_vh/S1-T8-v0"
CALLS = (
    {"name": "Pick", "arguments": {"object": "Glass_37"}},
    {"name": "Drop", "arguments": {"object": "Glass_37", "x": 1.27, "y": -1.88, "z": 0.0}},
    {"name": "Pick", "arguments": {"object": "Plate_57"}},
    {"name": "Drop", "arguments": {"object": "Plate_57", "x": 1.32, "y": -1.33, "z": 0.0}},
    {"name": "Finish", "arguments": {"answer": "Both are on the floor."}},
)


def main() -> None:
    """Play one episode and add the rewards up."""
    env = gymnasium.make(ID, resolution="320x180")
    observation, info = env.reset(seed=0)
    print(info["instruction"])
    print("picture:", observation["image"].shape, "objects in view:", len(info["objects"]))
    total = 0.0
    for call in CALLS:
        observation, reward, terminated, truncated, info = env.step(json.dumps(call))
        total += float(reward)
        print(f"{call['name']:<6} reward {reward:.1f}  {info['feedback']}")
        if terminated or truncated:
            print(f"ended: {info['termination']}, completion {total:.1f}, strict {info['strict']}")
    env.close()


if __name__ == "__main__":
    main()
