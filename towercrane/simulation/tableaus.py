"""Runge-Kutta pairs as data: each declares its orders, so that tests check the declaration.

Sources: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd ed. (1993), section II.5 (5(4)
pair of Dormand and Prince; DOP853) and the coefficients of their program dop853.f.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    Floats = NDArray[np.float64]


REACH_USED = 0.9
"""Part of a pair's reach that its steps use: the fastest vibration is known for small motions only."""


@dataclass(frozen=True, eq=False)
class Tableau:
    """Explicit Runge-Kutta pair whose last regular stage is the slope at the end of the step.

    Parameters
    ----------
    name : str
        Name in case files.
    order : int
        Order of the solution that is carried on.
    error_order : int
        Order of the error estimate: a step's estimate falls like h^(error_order + 1).
    dense_order : int
        Order of the dense output.
    stages : int
        Stages s of a step; stage s (counted from 0) is the slope at its end.
    a : ndarray, shape (m, m)
        Strictly lower triangular. Row s holds the weights of the step itself; rows beyond belong to the stages
        that only dense output needs.
    c : ndarray, shape (m,)
        Nodes.
    error : ndarray, shape (1 or 2, s + 1)
        Weights of the error estimate; two rows are combined as in dop853.f.
    dense : ndarray, shape (m, degree)
        y(x) = y0 + h sum_i K_i sum_d dense[i, d] x^(d + 1) for 0 <= x <= 1.
    reach : float
        Largest step times angular frequency of a vibration at which no such step makes it grow; none where every
        long step does.
    """

    name: str
    order: int
    error_order: int
    dense_order: int
    stages: int
    a: Floats
    c: Floats
    error: Floats
    dense: Floats
    reach: float = np.inf

    def longest_step(self, fastest: Callable[[], float] | None) -> float:
        """Longest step that feeds no vibration [s]: the error estimate sees it late.

        Parameters
        ----------
        fastest : callable or None
            Angular frequency of the fastest vibration [rad/s], as in :class:`towercrane.simulation.system.System`.
        """
        if fastest is None or np.isinf(self.reach):
            return np.inf
        frequency = fastest()
        return REACH_USED * self.reach / frequency if frequency > 0.0 else np.inf


def _square(rows: tuple[tuple[float, ...], ...]) -> Floats:
    square = np.zeros((len(rows), len(rows)))
    for i, row in enumerate(rows):
        square[i, : len(row)] = row
    return square


def _dop853_dense(b: Floats, d: Floats) -> Floats:
    """Weights of Hairer's nested dense output, expanded to powers of x.

    y = y0 + x (F0 + (1 - x) (F1 + x (F2 + (1 - x) (F3 + x (F4 + (1 - x) (F5 + x F6)))))).
    """
    stages = d.shape[1]
    parts = np.zeros((7, stages))
    parts[0, :12] = b
    parts[1] = -parts[0]
    parts[1, 0] += 1.0
    parts[2] = 2.0 * parts[0]
    parts[2, [0, 12]] -= 1.0
    parts[3:] = d
    rising, falling = np.array([0.0, 1.0]), np.array([1.0, -1.0])
    dense, factor = np.zeros((stages, 7)), rising
    for number, part in enumerate(parts):
        dense[:, : len(factor) - 1] += np.outer(part, factor[1:])
        factor = np.convolve(factor, falling if number % 2 == 0 else rising)
    return dense


# fmt: off
_DOP853_A = (
    (),
    (0.05260015195876773,),
    (0.0197250569845379, 0.0591751709536137),
    (0.02958758547680685, 0, 0.08876275643042054),
    (0.2413651341592667, 0, -0.8845494793282861, 0.924834003261792),
    (0.037037037037037035, 0, 0, 0.17082860872947386, 0.12546768756682242),
    (0.037109375, 0, 0, 0.17025221101954405, 0.06021653898045596, -0.017578125),
    (0.03709200011850479, 0, 0, 0.17038392571223998, 0.10726203044637328, -0.015319437748624402,
     0.008273789163814023),
    (0.6241109587160757, 0, 0, -3.3608926294469414, -0.868219346841726, 27.59209969944671,
     20.154067550477894, -43.48988418106996),
    (0.47766253643826434, 0, 0, -2.4881146199716677, -0.590290826836843, 21.230051448181193,
     15.279233632882423, -33.28821096898486, -0.020331201708508627),
    (-0.9371424300859873, 0, 0, 5.186372428844064, 1.0914373489967295, -8.149787010746927,
     -18.52006565999696, 22.739487099350505, 2.4936055526796523, -3.0467644718982196),
    (2.273310147516538, 0, 0, -10.53449546673725, -2.0008720582248625, -17.9589318631188, 27.94888452941996,
     -2.8589982771350235, -8.87285693353063, 12.360567175794303, 0.6433927460157636),
    (0.054293734116568765, 0, 0, 0, 0, 4.450312892752409, 1.8915178993145003, -5.801203960010585,
     0.3111643669578199, -0.1521609496625161, 0.20136540080403034, 0.04471061572777259),
    (0.056167502283047954, 0, 0, 0, 0, 0, 0.25350021021662483, -0.2462390374708025, -0.12419142326381637,
     0.15329179827876568, 0.00820105229563469, 0.007567897660545699, -0.008298),
    (0.03183464816350214, 0, 0, 0, 0, 0.028300909672366776, 0.053541988307438566, -0.05492374857139099, 0,
     0, -0.00010834732869724932, 0.0003825710908356584, -0.00034046500868740456, 0.1413124436746325),
    (-0.42889630158379194, 0, 0, 0, 0, -4.697621415361164, 7.683421196062599, 4.06898981839711,
     0.3567271874552811, 0, 0, 0, -0.0013990241651590145, 2.9475147891527724, -9.15095847217987),
)
_DOP853_C = (0, 0.05260015195876773, 0.0789002279381516, 0.1183503419072274, 0.2816496580927726,
     0.3333333333333333, 0.25, 0.3076923076923077, 0.6512820512820513, 0.6, 0.8571428571428571, 1.0, 1.0,
     0.1, 0.2, 0.7777777777777778)
_DOP853_ERROR = (
    (0.01312004499419488, 0, 0, 0, 0, -1.2251564463762044, -0.4957589496572502, 1.6643771824549864,
     -0.35032884874997366, 0.3341791187130175, 0.08192320648511571, -0.022355307863886294, 0),
    (-0.18980075407240762, 0, 0, 0, 0, 4.450312892752409, 1.8915178993145003, -5.801203960010585,
     -0.4226823213237919, -0.1521609496625161, 0.20136540080403034, 0.02265179219836082, 0),
)
_DOP853_D = (
    (-8.428938276109013, 0, 0, 0, 0, 0.5667149535193777, -3.0689499459498917, 2.38466765651207,
     2.117034582445028, -0.871391583777973, 2.2404374302607883, 0.6315787787694688,
     -0.08899033645133331, 18.148505520854727, -9.194632392478356, -4.436036387594894),
    (10.427508642579134, 0, 0, 0, 0, 242.28349177525817, 165.20045171727028, -374.5467547226902,
     -22.113666853125306, 7.733432668472264, -30.674084731089398, -9.332130526430229,
     15.697238121770845, -31.139403219565178, -9.35292435884448, 35.81684148639408),
    (19.985053242002433, 0, 0, 0, 0, -387.0373087493518, -189.17813819516758, 527.8081592054236,
     -11.57390253995963, 6.8812326946963, -1.0006050966910838, 0.7777137798053443, -2.778205752353508,
     -60.19669523126412, 84.32040550667716, 11.99229113618279),
    (-25.69393346270375, 0, 0, 0, 0, -154.18974869023643, -231.5293791760455, 357.6391179106141,
     93.40532418362432, -37.45832313645163, 104.0996495089623, 29.8402934266605, -43.53345659001114,
     96.32455395918828, -39.17726167561544, -149.72683625798564),
)

_DOPRI5_A = (
    (),
    (1 / 5,),
    (3 / 40, 9 / 40),
    (44 / 45, -56 / 15, 32 / 9),
    (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729),
    (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656),
    (35 / 384, 0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84),
)
_DOPRI5_C = (0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1, 1)
_DOPRI5_ERROR = ((-71 / 57600, 0, 71 / 16695, -71 / 1920, 17253 / 339200, -22 / 525, 1 / 40),)
_DOPRI5_DENSE = (
    (1, -8048581381 / 2820520608, 8663915743 / 2820520608, -12715105075 / 11282082432),
    (0, 0, 0, 0),
    (0, 131558114200 / 32700410799, -68118460800 / 10900136933, 87487479700 / 32700410799),
    (0, -1754552775 / 470086768, 14199869525 / 1410260304, -10690763975 / 1880347072),
    (0, 127303824393 / 49829197408, -318862633887 / 49829197408, 701980252875 / 199316789632),
    (0, -282668133 / 205662961, 2019193451 / 616988883, -1453857185 / 822651844),
    (0, 40617522 / 29380423, -110615467 / 29380423, 69997945 / 29380423),
)
# fmt: on

DOPRI5 = Tableau(
    name="dopri5",
    order=5,
    error_order=4,
    dense_order=4,
    stages=6,
    a=_square(_DOPRI5_A),
    c=np.array(_DOPRI5_C, dtype=float),
    error=np.array(_DOPRI5_ERROR),
    dense=np.array(_DOPRI5_DENSE),
)

DOP853 = Tableau(
    name="dop853",
    order=8,
    error_order=7,
    dense_order=7,
    stages=12,
    a=_square(_DOP853_A),
    c=np.array(_DOP853_C),
    error=np.array(_DOP853_ERROR),
    dense=_dop853_dense(np.array(_DOP853_A[12]), np.array(_DOP853_D)),
    reach=5.96,
)

TABLEAUS = {tableau.name: tableau for tableau in (DOP853, DOPRI5)}
