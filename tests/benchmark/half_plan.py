"""Half a plan of a task, which scores its fraction."""

from __future__ import annotations

from collections.abc import Sequence

from adamo_vh.benchmark.conditions import Condition, Holds


def first_half(conditions: Sequence[Condition]) -> tuple[Condition, ...]:
    """Goals of half a plan: the first half of the conditions.

    With an odd number the one in the middle is begun, not finished: its objects are only picked.
    Played to its end, the oracle of n simple conditions satisfies exactly n // 2 of them.
    """
    half, odd = divmod(len(conditions), 2)
    begun = conditions[half : half + odd]
    return (
        *conditions[:half],
        *(Holds(i) for c in begun if not isinstance(c, Holds) for i in sorted(c.moves)),
    )
