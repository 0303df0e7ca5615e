"""The truss of a laced column, member by member."""

import numpy as np


def plain_truss(column, panels, shadow=False, breadths=None):
    """Node positions and stiffness without the feet, member by member; opposite faces as seen through, or alike."""
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    h = column.panel_height
    halves = np.full(panels + 1, column.leg_spacing / 2) if breadths is None else breadths / 2
    nodes = [np.array([x * half, y * half, k * h]) for k, half in enumerate(halves) for x, y in corners]
    stiffness = np.zeros((3 * len(nodes), 3 * len(nodes)))

    def add(level, leg, other_level, other_leg, area):
        i, j = 4 * level + leg % 4, 4 * other_level + other_leg % 4
        along = nodes[j] - nodes[i]
        row = np.zeros(3 * len(nodes))
        row[3 * i : 3 * i + 3], row[3 * j : 3 * j + 3] = -along, along
        stiffness[:] += column.youngs_modulus * area / np.linalg.norm(along) ** 3 * np.outer(row, row)

    for k in range(panels):
        for leg in range(4):
            add(k, leg, k + 1, leg, column.leg_area)
            add(k + 1, leg, k + 1, leg + 1, column.horizontal_area)
            low, high = leg, leg + 1
            if (column.lacing == "zigzag" and k % 2) != (shadow and leg >= 2):
                low, high = high, low
            add(k, low, k + 1, high, column.diagonal_area)
            if column.lacing == "X":
                add(k, high, k + 1, low, column.diagonal_area)
        add(k + 1, 0, k + 1, 2, column.plan_bracing_area)
        add(k + 1, 1, k + 1, 3, column.plan_bracing_area)
    return np.array(nodes), stiffness[12:, 12:]
