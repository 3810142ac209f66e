"""The words of a report, for a reader who is new to them."""

from __future__ import annotations

from adamo_vh.report.study.section import OTHER_TASKS, REPEAT

WORDS: tuple[tuple[str, str], ...] = (
    (
        "completion",
        "Fraction of a task’s conditions that hold at the end. Means are over tasks, so that each "
        "task counts once.",
    ),
    (
        "strict",
        "1 only if all conditions hold and nothing else was moved, nothing overlaps and nothing "
        "floats; else 0.",
    ),
    (
        REPEAT,
        "95 % interval from the spread of repetitions within each cell: where the mean would lie "
        "if the same episodes were played again.",
    ),
    (
        OTHER_TASKS,
        "95 % interval from the spread of the tasks’ means: where the mean would lie on other "
        "tasks like these. With 15 tasks it is wide.",
    ),
    (
        "deterministic",
        "A model that does the same whenever the world is the same. It is played once in each "
        "variation of a scene; there is nothing to repeat, and n counts variations.",
    ),
    (
        "variation",
        "A rearranged version of a scene: things in other places, further things, other light. 0 "
        "is the paper’s.",
    ),
    (
        "cell",
        "All episodes that are alike but for repetition and variation: same model, profile, "
        "scene, labeling and task.",
    ),
    (
        "unscored",
        "Ended by a fault of ours or of a provider; in no figure, and never counted as 0.",
    ),
    (
        "labeling",
        "What the tags of objects say: SEM class and number (“Plate_57”), OPAQ the number alone.",
    ),
    (
        "C-D level",
        "Capability-Difficulty: the sum of what a prompt asks for in actions, references and "
        "relations.",
    ),
    (
        "pass^k",
        "How likely k episodes of a cell are all strict successes.",
    ),
    (
        "early stop",
        "The agent ended the episode with conditions open. If it said that all was done, it is a "
        "false claim too.",
    ),
    (
        "p",
        "How often chance alone gives a difference, or a correlation, at least as large.",
    ),
    (
        "could have seen",
        "The smallest true difference that so many episodes show with 80 % power. A smaller one "
        "may be there and not be seen.",
    ),
)
"""Each with its meaning."""
