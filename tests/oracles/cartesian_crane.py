"""The basic slewing crane with an elastic rope, all in fixed axes, by another solver with its own events.

The jib's tip and the load are free points; springs of the jib act between the tip and where the platform carries it,
with their reaction on the platform. Nothing of it is the package's.
"""

from dataclasses import dataclass
from math import cos, hypot, sin
from types import SimpleNamespace
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp


@dataclass
class CartesianCrane:
    """Parameters as the package's basic crane has them; rope c, tau; load m, drag; rope and shaft: value and rate."""

    p: SimpleNamespace
    stiffness: float
    relaxation: float
    load: float
    drag: float
    rope: Any
    shaft: Any

    def strain(self, t: float, y: list[float]) -> tuple[float, float, list[float]]:
        """Strain of the rope, its rate, and its direction."""
        x, v = [y[7 + k] - y[k] for k in range(3)], [y[10 + k] - y[3 + k] for k in range(3)]
        (length, rate), distance = self.rope(t), hypot(*x)
        eps = (distance - length) / length
        n = [own / distance for own in x]
        return eps, (n[0] * v[0] + n[1] * v[1] + n[2] * v[2] - (1 + eps) * rate) / length, n

    def margin(self, t: float, y: list[float]) -> float:
        """Above zero where the rope is taut."""
        eps, rate, _ = self.strain(t, y)
        return min(eps, eps + self.relaxation * rate)

    def slope(self, t: float, state: np.ndarray, taut: bool) -> list[float]:
        """State: tip, its velocity, platform's angle, load, its velocity, platform's rate."""
        p, y = self.p, state.tolist()
        c, s, w = cos(y[6]), sin(y[6]), y[13]
        ahead, left = c * y[0] + s * y[1], c * y[1] - s * y[0]
        ahead_rate, left_rate = c * y[3] + s * y[4] + w * left, c * y[4] - s * y[3] - w * ahead
        fx = -p.stiffness_jib_radial * (ahead - p.geometry_jib_radius) - p.damping_jib_radial * ahead_rate
        fy = -p.stiffness_jib_lateral * left - p.damping_jib_lateral * left_rate
        rise = y[2] - p.geometry_tower_height - p.geometry_top_height
        force = c * fx - s * fy, s * fx + c * fy, -p.stiffness_jib_vertical * rise - p.damping_jib_vertical * y[5]
        pull = [0.0, 0.0, 0.0]
        if taut:
            eps, rate, n = self.strain(t, y)
            pull = [self.stiffness * (eps + self.relaxation * rate) * own for own in n]
        tip_drag, drag = p.drag_jib_tip * hypot(*y[3:6]), self.drag * hypot(*y[10:13])
        tip = [(force[k] + pull[k] - tip_drag * y[3 + k]) / p.mass_jib_tip for k in range(3)]
        load = [(-pull[k] - drag * y[10 + k]) / self.load for k in range(3)]
        angle, speed = self.shaft(t)
        twist = y[6] - angle
        within = max(-p.drive_corner, min(twist, p.drive_corner))
        torque = -p.drive_soft_stiffness * within - p.drive_stiff_stiffness * (twist - within)
        torque -= p.drive_damping * (w - speed) + ahead * fy - left * fx
        g = p.gravity
        return [
            *y[3:6], *tip[:2], tip[2] - g, w, *y[10:13], *load[:2], load[2] - g, torque / p.inertia_platform,
        ]  # fmt: skip

    def run(
        self, start: np.ndarray, ends: np.ndarray, jumps: list[float], tolerance: float
    ) -> tuple[list, np.ndarray]:
        """Instants of switches, and states at the given ends; restarts at jumps of the drives' accelerations."""
        t, y, taut, switched, found = 0.0, start, True, [], []
        for stop in sorted({*jumps, *ends.tolist()}):
            while t < stop:

                def crossing(t: float, y: np.ndarray, taut: bool) -> float:
                    return self.margin(t, y)

                crossing.terminal, crossing.direction = True, -1.0 if taut else 1.0
                leg = solve_ivp(
                    self.slope, (t, stop), y, "DOP853", args=(taut,), rtol=tolerance, atol=1e-2 * tolerance,
                    events=crossing, first_step=min(1e-5, stop - t), max_step=2e-3,
                )  # fmt: skip
                t, y = float(leg.t[-1]), leg.y[:, -1]
                if leg.status == 1:
                    switched.append(t)
                    taut = not taut
            if stop in ends:
                found.append(y)
        return switched, np.array(found)
