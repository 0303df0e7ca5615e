"""What acts on a node of a structure besides its members: springs, weights and bodies."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from modal.compiler.kinds import Table, Three


SPRINGS, GEOMETRIC, BODIES = range(3)
"""What acts on a node: stiffness of springs, geometric stiffness of weights (to be taken away), mass."""


def node_stiffness(node: Table, omega2: float, load: float) -> Three:
    """Entries (v, v), (v, theta) and (theta, theta) of the dynamic stiffness of what acts on a node."""
    return (
        node[SPRINGS, 0] - load * node[GEOMETRIC, 0] - omega2 * node[BODIES, 0],
        node[SPRINGS, 1] - load * node[GEOMETRIC, 1] - omega2 * node[BODIES, 1],
        node[SPRINGS, 2] - load * node[GEOMETRIC, 2] - omega2 * node[BODIES, 2],
    )


def load_node(total: Table, length: float, node: Table, omega2: float, load: float) -> None:
    """Let what acts on a node act at the far end of a block's transfer (4, 4), in place."""
    k0, k1, k2 = node_stiffness(node, omega2, load)
    for j in range(4):
        v = total[0, j] + (1.0 if j == 0 else (length if j == 1 else 0.0))
        theta = total[1, j] + (1.0 if j == 1 else 0.0)
        total[2, j] += k0 * v + k1 * theta
        total[3, j] += k1 * v + k2 * theta
