"""The nodes of a file: who is above whom, and where each is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from adamo_vh.geometry import Array
from adamo_vh.runtime.human.own.faults import AGAIN, Broken
from adamo_vh.runtime.human.own.fields import Document, Node


@dataclass(frozen=True, slots=True, eq=False)
class Tree:
    """Nodes as they stand in the file."""

    names: tuple[str, ...]
    parents: tuple[int, ...]
    """-1 for those that are below none."""
    order: tuple[int, ...]
    """Parents before their children."""
    matrices: Array
    """(N, 4, 4) world_from_node."""

    def place(self, node: int) -> Array:
        """(3,) where a node is."""
        return np.asarray(self.matrices[node, :3, 3])

    def above(self, node: int) -> list[int]:
        """A node and all above it, itself first."""
        found = []
        while node >= 0:
            found.append(node)
            node = self.parents[node]
        return found


def tree_of(document: Document) -> Tree:
    """The tree of a file's nodes.

    Raises:
        Broken: A node is missing, has two parents or is its own ancestor, or is nowhere.
    """
    nodes = document.nodes
    parents = [-1] * len(nodes)
    for number, node in enumerate(nodes):
        for child in node.children:
            if child >= len(nodes):
                raise Broken(f"node {child} is missing. {AGAIN}")
            if parents[child] >= 0:
                raise Broken(f"node {child} has two parents. {AGAIN}")
            parents[child] = number
    order = [number for number, parent in enumerate(parents) if parent < 0]
    for number in order:  # It grows.
        order.extend(nodes[number].children)
    if len(order) != len(nodes):
        raise Broken(f"its nodes form a circle: one is its own ancestor. {AGAIN}")
    matrices = np.tile(np.eye(4), (len(nodes), 1, 1))
    with np.errstate(over="ignore", invalid="ignore"):
        for number in order:
            own, parent = _matrix(nodes[number]), parents[number]
            matrices[number] = own if parent < 0 else matrices[parent] @ own
    if not np.isfinite(matrices).all() or np.abs(matrices).max(initial=0.0) > 1e9:
        raise Broken(f"a node is infinitely large or far away. {AGAIN}")
    return Tree(tuple(node.name for node in nodes), tuple(parents), tuple(order), matrices)


def _matrix(node: Node) -> Array:
    if node.matrix is not None:
        return np.array(node.matrix).reshape(4, 4).T
    found = np.eye(4)
    x, y, z, w = np.array(node.rotation) / (np.linalg.norm(node.rotation) or 1.0)
    if node.rotation == (0.0, 0.0, 0.0, 0.0):
        w = 1.0
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )
    found[:3, :3] = turn * np.array(node.scale)
    found[:3, 3] = node.translation
    return found
