"""The command `animate`: films of cases and of results, refusals before the work, exit codes of `run`."""

from dataclasses import replace

import matplotlib as mpl
import pytest
from PIL import Image
from typer.testing import CliRunner

from towercrane.cases.case import load_case
from towercrane.cli import app
from towercrane.report.film import file as film_file
from towercrane.results import files as results
from towercrane.runs import run as running
from towercrane.runs.run import record_case, run_case

CASE = "qtz5613/condition-3"
SHORT = ("--set", "run.duration=3 s")


def animate(*arguments):
    return CliRunner().invoke(app, ["animate", *map(str, arguments)])


def frames(path):
    with Image.open(path) as film:
        return film.n_frames


def test_case_is_run_and_filmed(tmp_path):
    out = tmp_path / "new" / "film.gif"
    done = animate(CASE, *SHORT, "--out", out, "--frames-per-second", 4, "--from", "500 ms", "--to", 2)
    assert done.exit_code == 0, done.output
    assert frames(out) == 7
    first, last = done.stdout.splitlines()
    assert first == f"written to {out}: 7 frames, 0.5 to 2 s at 1 times real time, deformation 5 times as large"
    assert last == "next: towercrane run qtz5613/condition-3 --set 'run.duration=3 s'"
    assert [path.name for path in out.parent.iterdir()] == ["film.gif"]


@pytest.fixture(scope="module")
def result(tmp_path_factory):
    path = tmp_path_factory.mktemp("result") / "result.nc"
    results.save(run_case(load_case("slewing/basic/example-1", ["run.duration=2 s"])), path)
    return path


def test_finished_result_is_filmed_beside_itself_without_a_run(result, monkeypatch):
    monkeypatch.setattr(running, "record_case", None)
    done = animate(result, "--speed", 4, "--magnify", 3)
    assert done.exit_code == 0, done.output
    assert frames(result.with_suffix(".gif")) == 11
    assert "2 s at 4 times real time, deformation 3 times as large" in done.stdout
    assert done.stdout.splitlines()[-1] == f"next: towercrane animate {result} --from 0 --to 2 --speed 2"


def test_frames_closer_than_rows_and_too_far_for_a_swing_are_named(result):
    close = animate(result, "--speed", 0.1, "--to", 0.1)
    assert "frames are closer than the 0.01 s between the result's rows" in close.output
    far = animate(result, "--speed", 10, "--frames-per-second", 5)
    assert "frames are 2 s apart, too far for a load that swings in 2.8 s" in far.output


def test_film_of_a_run_that_ends_early_ends_there(tmp_path):
    out = tmp_path / "film.gif"
    done = animate("hard/slack-while-lowering", "--out", out, "--speed", 0.1)
    assert done.exit_code == 3
    assert "the run ended at 0.027992 s: slack rope" in done.output
    assert frames(out) == 7
    late = animate("hard/slack-while-lowering", "--out", tmp_path / "late.gif", "--from", 1)
    assert late.exit_code == 3
    assert "no film: nothing was left to show" in late.output
    assert not (tmp_path / "late.gif").exists()
    case = load_case("hard/buckled")
    results.save(run_case(case), tmp_path / "buckled.nc")
    at_once = animate(tmp_path / "buckled.nc")
    assert at_once.exit_code == 3
    assert "no film" in at_once.output


def test_run_that_is_not_what_its_case_expects_is_filmed_and_named(tmp_path):
    out = tmp_path / "film.gif"
    done = animate("hard/slack-while-lowering", "--set", "expect.outcome=finished", "--out", out, "--speed", 0.1)
    assert done.exit_code == 1
    assert 'expected the outcome "finished", got "slack rope"' in done.output
    assert frames(out) == 7


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--speed", 0], "--speed: wanted 0.001 to 1000 times real time, got 0"),
        (["--speed", "nan"], "--speed: wanted"),
        (["--frames-per-second", 0], "--frames-per-second: wanted 1 to 100, got 0"),
        (["--frames-per-second", 60], "wanted at most 50 frames per second in a .gif, got 60"),
        (["--magnify", 0], "--magnify: wanted more than 0 and at most 100000, got 0"),
        (["--magnify", "nan"], "--magnify: wanted"),
        (["--from", "10 s", "--to", "5 s"], "--to: wanted more than 10 s, the start, got 5 s"),
        (["--from", "10 m"], '--from: wanted a time, such as "120 s" (a plain number is in s), got "10 m"'),
        (["--from", "soon"], "--from: wanted a time"),
        (["--from", "-1"], "--from: wanted zero or more seconds, got -1 s"),
        (["--from", 120], "--from: wanted less than 120 s, where the run ends, got 120 s"),
        (["--to", "1 h"], "--to: wanted at most 120 s, where the run ends, got 3600 s"),
        (["--to", "inf"], "--to: wanted a finite number: a time"),
        (["--speed", 0.01], "at most 6000 frames, got 0.01, at which they take 240000"),
        (["--out", "film.avi"], "--out film.avi: wanted a name that ends in .gif or .mp4, got .avi"),
        (["--out", "film.mp4"], "ffmpeg, which writes .mp4, is not installed"),
        (["--out", "."], "--out .: wanted a file, got a folder"),
        (["--out", "file/film.gif"], "--out file: wanted a folder, file is a file"),
    ],
)
def test_bad_input_is_refused_before_the_run(arguments, said, tmp_path, monkeypatch):
    monkeypatch.setattr(running, "record_case", None)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").touch()
    with mpl.rc_context({"animation.ffmpeg_path": "no-such-ffmpeg"}):
        done = animate(CASE, *arguments)
    assert done.exit_code == 2
    assert said in done.output
    assert len(done.output.splitlines()) == 1
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_files_that_are_no_results_are_refused(result, tmp_path):
    done = animate(tmp_path / "result.nc")
    assert (done.exit_code, "got no file" in done.output) == (2, True)
    (tmp_path / "text.nc").write_text("no data set", encoding="utf-8")
    done = animate(tmp_path / "text.nc")
    assert (done.exit_code, "a file that cannot be read" in done.output) == (2, True)
    read = results.load(result)
    results.save(read.drop_vars("tower_x", errors="ignore").drop_vars("jib_vertical"), tmp_path / "less.nc")
    done = animate(tmp_path / "less.nc")
    assert (done.exit_code, "wanted a result with jib_vertical" in done.output) == (2, True)
    read.attrs.pop("case_text")
    results.save(read, tmp_path / "caseless.nc")
    done = animate(tmp_path / "caseless.nc")
    assert (done.exit_code, "wanted a result that holds its case" in done.output) == (2, True)
    results.save(read.isel(time=0, drop=True), tmp_path / "timeless.nc")
    done = animate(tmp_path / "timeless.nc")
    assert (done.exit_code, "got another data set" in done.output) == (2, True)
    done = animate(result, "--set", "payload.mass=1 kg")
    assert (done.exit_code, "wanted a case to change" in done.output) == (2, True)


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda read: read.drop_vars("rope_length"), "without: "),
        (lambda read: read.isel(time=slice(None, None, -1)), "times that increase from row to row"),
        (lambda read: read.assign(tower_tip_tilt=read["time"] / 0.0 * 0.0), "tower_tip_tilt: wanted finite values"),
    ],
)
def test_numbers_that_make_no_run_are_refused(result, tmp_path, spoil, said):
    results.save(spoil(results.load(result)), tmp_path / "spoilt.nc")
    done = animate(tmp_path / "spoilt.nc")
    assert done.exit_code == 2
    assert said in done.output


def test_interrupt_leaves_no_half_film(tmp_path, monkeypatch):
    def interrupted(self, pixels):
        raise KeyboardInterrupt

    monkeypatch.setattr(film_file.GifWriter, "add", interrupted)
    done = animate(CASE, *SHORT, "--out", tmp_path / "film.gif")
    assert done.exit_code == 130
    assert not list(tmp_path.iterdir())


def test_interrupted_run_makes_no_film(tmp_path, monkeypatch):
    def interrupted(case, progress=None):
        return replace(found := record_case(case), attrs=found.attrs | {"outcome": "interrupted"})

    monkeypatch.setattr(running, "record_case", interrupted)
    done = animate(CASE, *SHORT, "--out", tmp_path / "film.gif")
    assert done.exit_code == 130
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["qtz5613/gusts-working", "qtz5613/gusts-parked"])
def test_a_result_of_a_run_in_recorded_wind_is_filmed_like_its_case(name, tmp_path):
    runner = CliRunner()
    made = runner.invoke(app, ["run", name, "--set", "run.duration=1 s", "--no-pictures", "--out", str(tmp_path)])
    assert (tmp_path / "result.nc").exists(), made.output
    done = runner.invoke(app, ["animate", str(tmp_path / "result.nc"), "--out", str(tmp_path / "film.gif")])
    assert done.exit_code == 0, (done.output, done.exception)
    assert (tmp_path / "film.gif").stat().st_size > 0
