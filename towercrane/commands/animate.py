"""The command `animate`: a moving picture of a run."""

from __future__ import annotations

from dataclasses import replace
from math import pi, sqrt
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer

from towercrane.commands.shared.skeleton import Task, begin, end_of_run
from towercrane.commands.shared.terminal import (
    ENDED_EARLY,
    Changes,
    fail,
    folder_for_results,
    held_interrupts,
    load_run,
    out_option,
    quantity,
    say,
    suggest,
    tell,
    with_bar,
    with_progress,
)
from towercrane.simulation import outcomes

if TYPE_CHECKING:
    from collections.abc import Callable

    import xarray as xr

    from towercrane.cases.case import Case
    from towercrane.report.film.film import Film
    from towercrane.report.film.playback import Playback
    from towercrane.simulation.run import Run
    from towercrane.simulation.system import Model

MOST_MAGNIFIED = 1e5

OPTIONS = {"start": "--from", "end": "--to", "speed": "--speed", "frames_per_second": "--frames-per-second"}
"""Where the parts of a playback come from."""

INCOMPLETE = "wanted a result with all that `towercrane run` writes, got one without"

FRAMES_PER_SWING = 8.0
"""Below which a swing of the load cannot be told from another."""


def animate(
    case: Annotated[
        str,
        typer.Argument(metavar="CASE", help="A case file, the name of a shipped case, or a result.nc of a run."),
    ],
    out: Annotated[Path | None, out_option("The film, .gif or (where there is ffmpeg) .mp4.", "FILE")] = None,
    changes: Changes = None,
    speed: Annotated[
        float | None,
        typer.Option("--speed", metavar="TIMES", help="Of real time; else such that the film lasts 30 s at most."),
    ] = None,
    frames_per_second: Annotated[float, typer.Option("--frames-per-second", metavar="N", help="Of the film.")] = 20.0,
    magnify: Annotated[
        float | None,
        typer.Option("--magnify", metavar="TIMES", help="The deformation; else 1, 2, 5, ..., as fits the picture."),
    ] = None,
    start: Annotated[str, typer.Option("--from", metavar="TIME", help='First moment, such as "10 s".')] = "0 s",
    end: Annotated[str | None, typer.Option("--to", metavar="TIME", help="Last moment; else the run's.")] = None,
) -> None:
    """Film a run: the crane from the side and from above.

    Its deformation is magnified, beside true scale.
    """
    finished = _finished(case, changes) if case.endswith(".nc") else None
    task = begin(case, changes) if finished is None else Task(case, [], _case_of(case, finished))
    task.say_notices()
    loaded = task.case
    if out is None:
        out = Path("results") / f"{loaded.name}.gif" if finished is None else Path(case).with_suffix(".gif")
    _check_film(out, frames_per_second)
    if magnify is not None and not 0.0 < magnify <= MOST_MAGNIFIED:
        fail(f"--magnify: wanted more than 0 and at most {MOST_MAGNIFIED:g}, got {magnify:g}")
    if finished is not None and len(finished["time"]) == 1:
        _nothing(loaded, finished)
    duration = loaded.run.duration if finished is None else float(finished["time"][-1])
    playback = _playback(duration, start, end, speed, frames_per_second)
    run = _run(loaded) if finished is None else None
    result = finished if run is None else run.dataset()
    assert result is not None
    if (over := float(result["time"][-1])) <= playback.start:
        _nothing(loaded, result)
    playback = replace(playback, end=min(playback.end, over))
    _film(case, loaded, result, None if run is None else run.model, playback, magnify, out)
    suggest(*(task.command("run") if finished is None else _slower(case, playback)))
    _exit(loaded, result)


def _finished(path: str, changes: list[str] | None) -> xr.Dataset:
    """A result file."""
    if changes:
        fail(f"--set {changes[0]}: wanted a case to change, got the finished result {path}")
    return load_run(path)


def _case_of(path: str, result: xr.Dataset) -> Case:
    from towercrane.cases.result_case import case_of

    try:
        return case_of(result)
    except ValueError as error:
        fail(f"{path}: {error}")


def _check_film(out: Path, frames_per_second: float) -> None:
    """Refuse a film that cannot be written before the work, not after it."""
    with held_interrupts():
        from towercrane.report.film.file import obstacle

    if out.is_dir():
        fail(f"--out {out}: wanted a file, got a folder")
    if reason := obstacle(out.suffix, frames_per_second):
        fail(f"--out {out}: {reason}")
    folder_for_results(out.parent)


def _playback(duration: float, start: str, end: str | None, speed: float | None, rate: float) -> Playback:
    """What is asked for, judged before anything is run."""
    from towercrane.report.film.playback import Playback, fitting_speed

    first, last = quantity("--from", start, "s"), duration if end is None else quantity("--to", end, "s")
    if first >= duration:
        fail(f"--from: wanted less than {duration:g} s, where the run ends, got {first:g} s")
    if last > duration * (1.0 + 1e-9):
        fail(f"--to: wanted at most {duration:g} s, where the run ends, got {last:g} s")
    try:
        return Playback(first, min(last, duration), fitting_speed(last - first) if speed is None else speed, rate)
    except ValueError as error:
        name, _, wrong = str(error).removeprefix("Playback.").partition(":")
        fail(f"{OPTIONS[name]}:{wrong}")


def _run(case: Case) -> Run:
    from towercrane.runs.run import record_case

    result = with_progress(case, record_case)
    if result.attrs["outcome"] == outcomes.INTERRUPTED:
        raise KeyboardInterrupt
    return result


def _film(
    source: str,
    case: Case,
    result: xr.Dataset,
    model: Model | None,
    playback: Playback,
    magnify: float | None,
    out: Path,
) -> None:
    """Draw and write the film; messages name its source, and a run has its model."""
    with held_interrupts() as ask:
        from towercrane.cases.models import poses_of
        from towercrane.report.film.film import Film
        from towercrane.runs.vibration import step_of

        try:
            poses = poses_of(case, result, playback.times, model)
            magnification = poses.fitting_magnification() if magnify is None else magnify
            film = Film(result, poses, playback, magnification)
        except ValueError as error:
            fail(f"{source}: {error}")
        except KeyError as error:
            fail(f"{source}: {INCOMPLETE}: {error.args[0]}")
        _save(film, out, playback, ask)
    drawn = f", deformation {magnification:g} times as large" if poses.deformation else ""
    span = f"{playback.start:g} to {playback.end:.6g} s at {playback.speed:g} times real time"
    tell(f"written to {out}: {film.frames} frames, {span}{drawn}")
    rows, swing = (
        step_of(result),
        2.0 * pi * sqrt(float(result["rope_length"].min()) / result.attrs["gravity"]),
    )
    if rows > swing / FRAMES_PER_SWING:
        say(
            f"the result's rows are {rows:g} s apart, too far for a load that swings in {swing:.2g} s: the film "
            "shows straight ways between them; run.output_step makes them finer"
        )
    if playback.step < 0.999 * rows:
        say(f"frames are closer than the {rows:g} s between the result's rows: run.output_step makes these finer")
    if playback.step > swing / FRAMES_PER_SWING:
        say(f"frames are {playback.step:g} s apart, too far for a load that swings in {swing:.2g} s: lower --speed")


def _save(film: Film, out: Path, playback: Playback, ask: Callable[[], None]) -> None:
    """Write the film, with a progress bar if somebody is looking; ``ask`` ends it after a frame."""
    from towercrane.report.film.file import save

    def run(progress: Callable[[int], None] = lambda done: None) -> None:
        def after(done: int) -> None:
            progress(done)
            ask()

        save(film, out, playback.frames_per_second, after)

    with_bar(f"{film.frames} frames", run, film.frames)


def _slower(path: str, playback: Playback) -> tuple[str, ...]:
    """The same film, half as fast."""
    span = ("--from", f"{playback.start:g}", "--to", f"{playback.end:g}")
    return ("animate", path, *span, "--speed", f"{0.5 * playback.speed:g}")


def _nothing(case: Case, result: xr.Dataset) -> NoReturn:
    """No film of a run that ended before it was to begin."""
    say("no film: nothing was left to show")
    _exit(case, result)
    raise typer.Exit(ENDED_EARLY)


def _exit(case: Case, result: xr.Dataset) -> None:
    """Exit codes as of `run`."""
    from towercrane.runs.summary import expected

    end_of_run(expected(case, result), result.attrs["outcome"], result.attrs["end_time"])
