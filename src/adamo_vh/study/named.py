"""The paper's studies by their names: the main matrix and its four ablations (Sec. 4)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

_ABLATION: Mapping[str, Any] = {"scenes": ["s1"], "labelings": ["sem"], "repetitions": 15}
"""One parameter at a time, on S1 with SEM labels."""

NAMED: Mapping[str, Mapping[str, Any]] = {
    "paper": {"scenes": ["s1", "s2"], "labelings": ["sem", "opaq"], "repetitions": 15},
    "memory": {
        **_ABLATION,
        "axes": {"k": [4, 6, 10, 50], "switches.buffer_unit": ["step", "block"]},
    },
    "sampling": {
        **_ABLATION,
        "axes": {
            "sampling": [
                {"temperature": 0.0, "top_p": 0.0},
                {"temperature": 0.3, "top_p": 0.5},
                {"temperature": 0.8, "top_p": 1.0},
            ]
        },
    },
    "points": {**_ABLATION, "axes": {"grid": [3, 4, 5, 6, 7]}},
    "resolution": {**_ABLATION, "axes": {"resolution": ["640x360", "1280x720", "1920x1080"]}},
}
"""What each says, in the words of a study file; tasks are all, the models are the user's."""
