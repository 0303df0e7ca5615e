"""A rigid head that is free to turn in the wind, of one coordinate: torque of the air against it, and a brake.

The jib's relative normal wind is a - omega x. Its square with its sign is integrated with the lever x as a
polynomial, on both sides of where it changes its sign. The head slips against the brake or sticks; SciPy integrates.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import Polynomial
from scipy.integrate import solve_ivp


@dataclass
class Weathervane:
    """Inertia [kg m^2], brake [N m], wind towards x [m/s], bars as (begin, end, drag per squared speed and length)
    along the jib [m, kg/m^2], points as (place, drag per squared speed) [m, kg/m]."""

    inertia: float
    brake: float
    wind: float
    bars: list
    points: list

    def torque(self, angle, rate):
        """Of the air [N m]."""
        across = -self.wind * np.sin(angle)
        found = sum(drag * x * abs(across - rate * x) * (across - rate * x) for x, drag in self.points)
        lever, through = Polynomial([0.0, 1.0]), Polynomial([across, -rate])
        work = (lever * through * through).integ()
        for begin, end, drag in self.bars:
            still = [across / rate] if rate and begin < across / rate < end else []
            ends = [begin, *still, end]
            for a, b in pairwise(ends):
                found += drag * np.sign(through(0.5 * (a + b))) * (work(b) - work(a))
        return found

    def swing(self, angle, longest=1000.0):
        """Turning points from rest at an angle on, as (time, angle), until the brake holds."""
        time, found = 0.0, []
        while time < longest:
            driving = self.torque(angle, 0.0)
            if abs(driving) <= self.brake:
                return found
            way = np.sign(driving)

            def slope(_, y, way=way):
                return [y[1], (self.torque(*y) - way * self.brake) / self.inertia]

            def stops(_, y, way=way):
                return way * y[1]

            stops.terminal, stops.direction = True, -1
            # Away from rest, where the event is met at once.
            first = 1e-6 * way
            run = solve_ivp(slope, (time, longest), [angle, first], "DOP853", events=stops, rtol=1e-11, atol=1e-13)
            time, angle = run.t[-1], run.y[0, -1]
            found.append((time, angle))
        return found
