"""What the baseline understood, written in one short line per part, so that tables can be read."""

from __future__ import annotations

from adamo_vh.inference.baseline.language.plan import Act, Description, Goal, Plan, Question
from adamo_vh.inference.baseline.language.requests import understand


def thing(meant: Description) -> str:
    """A description: "all Lock x2", "red largest", "all but(Plate)"."""
    words = [*meant.ids, *meant.classes[:1], *meant.colours]
    words += [f"{colour}-part" for colour in meant.part_colours]
    words += [*meant.shapes, *["clear"] * meant.transparent, *["label"] * meant.label]
    if meant.size:
        words.append(f"{meant.size}{meant.rank if meant.rank > 1 else ''}")
    words += [f"x{meant.count}"] if meant.count else []
    words += [f"from-{meant.source[0]}"] if meant.source else []
    words += ["other"] if meant.other else []
    words += [f"but({thing(left_out)})" for left_out in meant.but]
    return " ".join([*["all"] * meant.every, *words])


def place(goal: Goal) -> str:
    """A place: "floor", "surface(sofa)", "near(Plate)", "shift(left 20)"."""
    inner = [thing(other) for other in (goal.anchor, goal.second) if other]
    inner += [word for word in (goal.furniture, goal.direction) if word]
    inner += [f"{goal.distance_m * 100:.0f}"] if goal.distance_m else []
    return f"{goal.relation}({' '.join(inner)})" if inner else str(goal.relation)


def wish(goal: Goal) -> str:
    """A wish: "Plate floor"."""
    return f"{thing(goal.target)} {place(goal)}"


def question(asked: Question) -> str:
    """A question: "is Cup red", "count all Lock at floor"."""
    words = [*["not"] * asked.negated, str(asked.ask)]
    words += [thing(asked.target)] if asked.target else []
    words += ["at", place(asked.place)] if asked.place else []
    words += [thing(asked.quality)] if asked.quality else []
    return " ".join(words)


def act(done: Act) -> str:
    """An act: "look Plate", "walk left 2"."""
    words = [done.name, thing(done.target) if done.target else "", done.direction]
    words += [f"{done.distance_m:g}"] if done.name == "walk" and done.direction else []
    return " ".join(word for word in words if word)


def parts(plan: Plan) -> list[str]:
    """All that shall be done and said of a plan that was understood; remarks are left out."""
    assert not plan.problem, plan.problem
    lines = [wish(goal) for goal in plan.goals]
    lines += [f"? {question(asked)}" for asked in plan.questions]
    lines += [f"! {act(done)}" for done in plan.acts]
    if plan.condition:
        lines.insert(0, f"if {question(plan.condition)}:")
    if plan.otherwise:
        lines += ["else:", *parts(plan.otherwise)]
    return lines


def read(text: str) -> list[str]:
    """An instruction, understood and written in short."""
    return parts(understand(text))
