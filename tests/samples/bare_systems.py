"""Systems of equations that are no cranes."""

import numpy as np

from towercrane.simulation.system import System


def plain_system(equations, size, constants=None, guards=()):
    return System(
        equations=equations,
        size=size,
        guards=guards,
        floors=np.zeros(len(guards)),
        scale=np.ones(size),
        constants=constants,
    )
