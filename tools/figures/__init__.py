"""How the shipped figures are made: soft shapes, meshed, painted and bound to the skeleton.

`python -m tools.figures` runs this; it needs scikit-image and fast-simplification (the `bake`
extra). What it makes lies in `human/data` and is read by `adamo_vh.runtime.human.looks`.
"""
