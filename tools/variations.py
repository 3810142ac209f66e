"""Find the variations that may be scored, and write the table that comes with the package.

    python tools/variations.py --dev 100 --test 100 [--scene s2] [--again]

What is in the table already stays, so that it can be stopped and gone on with; --again proves all
of it anew. Takes some ten seconds a variation.
"""

from __future__ import annotations

import argparse
import time
from pathlib import Path

from adamo_vh.files import write_whole
from adamo_vh.runtime import scenes
from adamo_vh.runtime.scenes.variation import GENERATION
from adamo_vh.session.variations import FIRST, TABLE, accepted, first_fair_attempt

_A_LINE = 20


def main() -> None:
    """Parse the command line; the table is written after every variation."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else "")
    parser.add_argument("--scene", action="append", choices=scenes.scene_names())
    parser.add_argument("--dev", type=int, default=100, help="how many from 1")
    parser.add_argument("--test", type=int, default=100, help="how many from 1000")
    parser.add_argument("--again", action="store_true", help="prove what is there already, too")
    arguments = parser.parse_args()
    table = {
        name: {s: list(accepted().get(name, {}).get(s, [])) for s in FIRST}
        for name in scenes.scene_names()
    }
    if arguments.again:
        table |= {name: {s: [] for s in FIRST} for name in arguments.scene or table}
    for place in range(max(arguments.dev, arguments.test)):
        for name in arguments.scene or table:
            scene = scenes.load_scene(name)
            for split, first in FIRST.items():
                found = table[name][split]
                if len(found) > place or place >= getattr(arguments, split):
                    continue
                started = time.monotonic()
                found.append(first_fair_attempt(scene, first + place))
                write(table)
                seconds = time.monotonic() - started
                print(f"{name} {first + place}: attempt {found[-1]}, {seconds:.0f} s", flush=True)


def write(table: dict[str, dict[str, list[int]]]) -> None:
    """Write the whole table."""
    lines = [
        "# Accepted attempts of the variations from 1 (dev) and from 1000 (test), in their order.",
        "# Made by tools/variations.py.",
        f"generation = {GENERATION}",
    ]
    for name, splits in table.items():
        lines += ["", f"[scenes.{name}]"]
        for split, attempts in splits.items():
            rows = [attempts[i : i + _A_LINE] for i in range(0, len(attempts), _A_LINE)]
            told = [f"    {', '.join(map(str, row))}," for row in rows]
            lines += [f"{split} = [", *told, "]"]
    folder = Path(scenes.__file__).parent
    write_whole(folder / TABLE, ("\n".join(lines) + "\n").encode())


if __name__ == "__main__":
    main()
