"""What every kind of crane declares of itself, once."""

from __future__ import annotations

from dataclasses import dataclass, field
from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Iterator, Mapping

    from towercrane.cranes.parts.poses import Poses
    from towercrane.cranes.parts.turbulence.field import Places
    from towercrane.schema.faults import Fault
    from towercrane.schema.provenance import Assumption
    from towercrane.schema.ranges import Range
    from towercrane.schema.targets import Targets
    from towercrane.simulation.system import Model

    Tree = dict[str, Any]


class Signals(NamedTuple):
    """Output that shows the structure's vibration, and those that show the load's swing: the first that a run has."""

    vibration: str
    swings: tuple[str, ...]


class Panel(NamedTuple):
    """One row of a picture: its label with the unit, the factor that brings values to it, and its lines by name."""

    label: str
    factor: float
    lines: dict[str, str]


Pictures = dict[str, tuple[str, tuple[Panel, ...]]]
"""Title and panels over time of each picture by the name of its file."""


class Natural(NamedTuple):
    """Natural frequencies [Hz], the kind of each where kinds are told apart, and for each output that shows a swing
    of the load the index of its mode."""

    frequencies: list[float]
    kinds: list[str]
    swings: dict[str, int]

    @property
    def swing_mode(self) -> int | None:
        """Which of them is the load's swing, of several the one along the jib, counted from 1."""
        return next(iter(self.swings.values())) + 1 if self.swings else None


class Track(NamedTuple):
    """What something runs along: name of its motion, length of its track [m] in a case as written, None where it is
    not known, and the track in a word."""

    name: str
    length: Callable[[dict[str, Any]], float | None]
    along: str


@dataclass(frozen=True)
class Drives:
    """What a case moves besides the rope.

    Parameters
    ----------
    height : callable
        Height that the rope hangs from [m], of a case as written; None where it is not known.
    height_is : str
        That height in words.
    tracks : tuple of Track
        What runs along a straight line.
    joints : tuple of tuple of str
        What turns; of several names for one joint the first that the case has, or else the last.
    fastest_turn : float
        Largest plausible speed of a turn that states none [rad/s].
    wind : bool
        Whether a wind may blow.
    earthquake : bool
        Whether the ground may move.
    limits : dict of str to callable
        Lowest and highest angle of joints that have such [rad], of a case as written; None where they are not known.
    """

    height: Callable[[Tree], float | None]
    height_is: str
    tracks: tuple[Track, ...] = ()
    joints: tuple[tuple[str, ...], ...] = ()
    fastest_turn: float = 5.0
    wind: bool = False
    earthquake: bool = False
    limits: Mapping[str, Callable[[Tree], tuple[float | None, float | None]]] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Kind:
    """A kind of crane. Its parts that compute are loaded where they are asked for, see `later`.

    Parameters
    ----------
    name : str
    tables : type of Table
        All tables of a case, one of :data:`towercrane.cranes.registry.AnyCase`.
    drives : Drives
    drives_in : callable, optional
        Those of a case as written, where cases differ in them.
    signals : Signals
    pictures : str or dict
        Module of :mod:`towercrane.report.plots.runs` that draws its runs, or panels that need none of their own.
    build : callable
        Model of a case's tables; keyword arguments replace what the case chose.
    poses : callable
        Of its model, its tables, a result and times, see :class:`towercrane.cranes.parts.poses.Poses`.
    checks : tuple of callable
        Faults of a case as written that no single value shows.
    ranges : tuple of Range
        Plausible values that are not those of other kinds.
    computed : callable, optional
        Assumptions for values that its tables do not state and that others of them give.
    idle : callable, optional
        Beginnings of keys of its tables that do not enter the equations of motion.
    natural : callable, optional
        `Natural` of its model and the values of its drives; without it the linear model is asked.
    lengths : callable, optional
        Length of the member that each deflection in a result is of [m], of its model.
    targets : callable, optional
        Errors that its tables ask for, by output.
    outputs : callable, optional
        Names of all outputs that its runs may have, where scenes differ in them.
    made_of : callable, optional
        Text of a model that is equal for those which differ in their load alone and are each other `with_load`.
    plain : callable, optional
        Whether another load, and another rope that rests, change nothing else of a run; of its tables.
    modes : callable, optional
        Kinds of modes that move, of its tables, by the key of the table "model" that counts them.
    left_out : callable, optional
        What a scene leaves out because nothing excites it, of its tables, in sentences.
    notices : callable, optional
        What of a run nobody would expect, of its tables and the model that was run, in sentences.
    sways : dict of str to str
        Outputs that show the load's swing, and which way each is: shown in films, and where models are compared.
    serves : frozenset of str
        What it can be used for besides what every kind can: the studies "modes", "map", "lattice", "compare",
        "verify", "shape" and "lift"; "members" for pictures of its members' modes beside those of a run.
    wind_places : callable, optional
        Where a wind that differs from place to place blows, of its tables.
    refuses : callable, optional
        Which of them cases of these tables cannot be used for, and why.
    """

    name: str
    tables: type[Any]
    drives: Drives
    signals: Signals
    pictures: str | Pictures
    build: Callable[..., Model]
    poses: Callable[..., Poses]
    checks: tuple[Callable[[Tree], Iterator[Fault]], ...] = ()
    ranges: tuple[Range, ...] = ()
    computed: Callable[[Any], Iterator[Assumption]] | None = None
    idle: Callable[..., Iterator[str]] | None = None
    natural: Callable[..., Natural] | None = None
    lengths: Callable[[Any], dict[str, float]] | None = None
    targets: Callable[[Any], Targets] | None = None
    outputs: Callable[[], Collection[str]] | None = None
    made_of: Callable[[Any], str] | None = None
    plain: Callable[[Any], bool] | None = None
    modes: Callable[[Any], dict[str, str]] | None = None
    left_out: Callable[[Any], list[str]] | None = None
    notices: Callable[[Any, Any], list[str]] | None = None
    sways: Mapping[str, str] = field(default_factory=dict)
    serves: frozenset[str] = frozenset()
    drives_in: Callable[[Tree], Drives] | None = None
    refuses: Callable[[Any], Mapping[str, str]] | None = None
    wind_places: Callable[[Any], Places] | None = None

    def drives_of(self, tree: Tree) -> Drives:
        """What a case as written moves besides the rope."""
        return self.drives if self.drives_in is None else self.drives_in(tree)

    def refusal(self, use: str, tables: Any) -> str:
        """Why a case of this kind cannot be used so, of its tables; nothing where it can."""
        if use == "verify" and tables.start.from_:
            return "a richer model cannot go on from where the run of this one does"
        return self.refuses(tables).get(use, "") if self.refuses is not None else ""


def later(module: str, name: str) -> Callable[..., Any]:
    """A function of a module that is imported with the first call."""

    def call(*arguments: Any, **options: Any) -> Any:
        return getattr(import_module(module), name)(*arguments, **options)

    return call
