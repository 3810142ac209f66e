"""Our rooms as environments of Gymnasium: `gymnasium.make("adamo_vh.gym:adamo_vh/S1-T10-v0")`.

Needs the extra `gym`. Where ADAMO is installed, Gymnasium knows the ids without this module too.
"""

from __future__ import annotations

from adamo_vh.extras import needed

needed("gymnasium", "gym")

from adamo_vh.adapters.gym.environment import RoomEnv  # noqa: E402
from adamo_vh.adapters.gym.registering import register, room_id, rooms  # noqa: E402

__all__ = ["RoomEnv", "register", "room_id", "rooms"]

register()
