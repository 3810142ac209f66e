"""Model the people and write them into the package.

pip install -e '.[bake]'
python -m tools.figures            # all
python -m tools.figures mara       # one
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Sequence
from pathlib import Path

from tools.figures.figure import build_figure
from tools.figures.storage import save_figure
from tools.figures.variant import PEOPLE

DATA = Path(__file__).resolve().parents[2] / "src" / "adamo_vh" / "runtime" / "human" / "data"


def main(arguments: Sequence[str] | None = None) -> None:
    """Parse the command line, model, save."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0] if __doc__ else None)
    parser.add_argument("names", nargs="*", help="people; all when none")
    parser.add_argument("--out", type=Path, default=DATA, help="folder for the data")
    options = parser.parse_args(arguments)
    for name in options.names or PEOPLE:
        start = time.perf_counter()
        figure = build_figure(PEOPLE[name])
        path = options.out / f"{name}.npz"
        save_figure(figure, path)
        counts = ", ".join(f"{g.name} {len(g.faces)}" for g in figure.garments)
        print(
            f"{path.name}: {figure.triangle_count} triangles ({counts}), "
            f"{path.stat().st_size / 1000:.0f} kB, {time.perf_counter() - start:.0f} s"
        )


if __name__ == "__main__":
    main()
