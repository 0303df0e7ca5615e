"""The program as a process: endings that nobody sees from inside, and files that are kept whatever happens."""

import gc
import json
import os
import shutil
import signal
import subprocess
import sys

import pytest
from typer.testing import CliRunner

import modal
import towercrane
from towercrane.__main__ import main
from towercrane.cli import app
from towercrane.commands.shared.skeleton import Task
from towercrane.report.folder import write_run
from towercrane.report.plots.style import figure_of
from towercrane.results import files as results

RUN = ("run", "qtz5613/condition-3", "--no-pictures", "--set", "run.duration=1 s")
posix = pytest.mark.skipif(os.name == "nt", reason="signals, limits and links of POSIX")


def start(*arguments, cwd=None, before="", **environment):
    """The program in a process of its own, after some lines of Python."""
    code = f"import os, signal, sys\n{before}\nfrom towercrane.__main__ import main\nmain()"
    return subprocess.Popen(
        [sys.executable, "-c", code, *arguments],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, encoding="utf-8", cwd=cwd, env={**os.environ, **environment},
    )  # fmt: skip


def program(*arguments, **options):
    with start(*arguments, **options) as process:
        out, err = process.communicate(timeout=120)
    assert "Traceback" not in err, err
    return process.returncode, out, err


@pytest.mark.parametrize("package", [modal, towercrane], ids=lambda package: package.__name__)
def test_every_public_name_is_found_where_the_package_looks_for_it(package):
    assert {name for name in package.__all__ if getattr(package, name).__name__ != name} == set()


@posix
def test_full_disk_is_one_line_and_the_old_files_stay(tmp_path):
    assert program(*RUN, "--csv", "--out", str(tmp_path))[0] == 0
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    # Where no disk is small enough, a limit of the process on the size of its files does the same.
    limit = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))"
    code, out, err = program(*RUN, "--set", "payload.mass=900 kg", "--out", str(tmp_path), before=limit)
    assert code == 2
    assert out == ""
    assert err == f"{tmp_path}: cannot be written, what was there stays: File too large\n"
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before


@pytest.mark.skipif(sys.platform != "linux" or not shutil.which("mount"), reason="a disk of its own")
def test_full_file_system_keeps_the_old_files(tmp_path):
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=100k", "tmpfs", str(tmp_path)], capture_output=True)
    if mounted.returncode:
        pytest.skip("only an administrator may mount a small file system")
    try:
        (tmp_path / "result.nc").write_bytes(b"old")
        code, _, err = program(*RUN, "--set", "run.output_step=1 ms", "--out", str(tmp_path))
        assert (code, err) == (2, f"{tmp_path}: cannot be written, what was there stays: No space left on device\n")
        assert [path.name for path in tmp_path.iterdir()] == ["result.nc"]
        assert (tmp_path / "result.nc").read_bytes() == b"old"
    finally:
        subprocess.run(["umount", str(tmp_path)], check=True)


@posix
def test_reader_that_has_gone_ends_the_program_as_its_signal_would():
    with start("cases") as process:
        process.stdout.close()
        err = process.stderr.read()
    assert (process.returncode, err) == (128 + signal.SIGPIPE, "")


@posix
def test_output_that_cannot_be_written_is_said():
    code = "from towercrane.__main__ import main; main()"
    with open("/dev/full", "w", encoding="utf-8") as full:
        done = subprocess.run([sys.executable, "-c", code, "cases"], stdout=full, stderr=subprocess.PIPE, text=True)
    assert (done.returncode, done.stderr) == (2, "cannot write the output: No space left on device\n")


@posix
@pytest.mark.parametrize("raised", ["ImportError", "SystemError", "KeyboardInterrupt"])
def test_interrupt_that_a_library_turns_into_another_error_is_an_interrupt(raised):
    # A library's loading is where Ctrl-C comes out as something else.
    before = f"""
from importlib.abc import MetaPathFinder
class Interrupted(MetaPathFinder):
    def find_spec(self, name, path, target=None):
        if name == "towercrane.cases.shipped":
            try:
                os.kill(os.getpid(), signal.SIGINT)
            except KeyboardInterrupt as error:
                raise {raised}("in a library") from None
sys.meta_path.insert(0, Interrupted())
"""
    code, out, err = program("cases", before=before)
    assert (code, out, err) == (130, "", "interrupted\n")


@posix
def test_interrupt_while_pictures_are_drawn_keeps_the_run(tmp_path):
    before = """
import matplotlib.figure
init = matplotlib.figure.Figure.__init__
def interrupted(self, *arguments, **options):
    os.kill(os.getpid(), signal.SIGINT)
    init(self, *arguments, **options)
matplotlib.figure.Figure.__init__ = interrupted
"""
    code, _, err = program(*(part for part in RUN if part != "--no-pictures"), "--out", str(tmp_path), before=before)
    assert code == 130
    assert "kept in" in err
    assert results.load(tmp_path / "result.nc").attrs["outcome"] == "finished"
    assert json.loads((tmp_path / "summary.json").read_text("utf-8"))["outcome"] == "finished"


@posix
def test_temporary_files_of_processes_that_are_gone_are_cleared_and_no_others(tmp_path):
    with start("--version") as dead:
        dead.communicate()
    with results.replacing(tmp_path / "mine.txt") as alive:
        pattern = alive.name.replace(str(os.getpid()), "{}", 1)
        gone = tmp_path / pattern.format(dead.pid)
        kept = [tmp_path / name for name in (".towercrane", ".towercrane-else-1-abc.nc", f"{gone.name}.txt.old")]
        for path in (gone, *kept):
            path.write_bytes(b"half")
        with results.replacing(tmp_path / "new.txt") as temporary:
            temporary.write_text("new", "utf-8")
            # Killed here the process would leave this name, which is no other file's.
            assert temporary.name.startswith(".towercrane-")
        assert not gone.exists()
        assert alive.exists()
        assert all(path.exists() for path in kept)


def test_only_what_an_earlier_run_recorded_and_nobody_changed_is_removed(tmp_path):
    mine = ("plan.png", "tower.png", "modes.png", "result.csv")
    for name in mine:
        (tmp_path / name).write_bytes(b"mine")
    summary = {"outcome": "finished"}
    assert write_run(tmp_path, {}, summary)[1] == []
    write_run(tmp_path, {"plan.png": figure_of(1.0, 1.0), "result.csv": "1,2\n"}, summary)
    text, removed = write_run(tmp_path, {"swing.png": figure_of(1.0, 1.0)}, summary)
    assert removed == ["result.csv", "plan.png"]
    assert (tmp_path / "summary.json").read_text("utf-8") == f"{text}\n"
    assert list(json.loads(text)["files"]) == ["swing.png"]
    assert all((tmp_path / name).read_bytes() == b"mine" for name in ("tower.png", "modes.png"))
    (tmp_path / "swing.png").write_bytes(b"mine again")
    assert write_run(tmp_path, {}, summary)[1] == []
    assert (tmp_path / "swing.png").read_bytes() == b"mine again"


@pytest.mark.parametrize(
    "record", ["[]", "{", '{"files": 3}', '{"files": ["tower.png"]}', '{"files": {"tower.png": 3, "../out.txt": ""}}']
)
def test_record_that_is_none_removes_nothing(record, tmp_path):
    folder = tmp_path / "run"
    folder.mkdir()
    kept = [folder / "tower.png", tmp_path / "out.txt"]
    for path in kept:
        path.write_bytes(b"")
    (folder / "summary.json").write_text(record, "utf-8")
    assert write_run(folder, {}, {})[1] == []
    assert all(path.exists() for path in kept)


@posix
@pytest.mark.parametrize(
    ("out", "words"),
    [
        ("", "wanted a name"),
        ("link", "link is a link that leads nowhere"),
        ("link/run", "leads nowhere"),
        ("f/x", "is a file"),
    ],
)
def test_folder_that_cannot_be_is_refused_before_the_run(out, words, tmp_path, monkeypatch):
    (tmp_path / "link").symlink_to("nowhere")
    (tmp_path / "f").write_text("", "utf-8")
    monkeypatch.chdir(tmp_path)
    # Without equations nothing can begin.
    monkeypatch.setattr("towercrane.kernels.straight.written.written", None)
    for command in (("run", RUN[1], "--out"), ("modes", RUN[1], "--out"), ("figures", "--out"), ("cases", "copy")):
        done = CliRunner().invoke(app, [*command, out])
        assert (done.exit_code, done.stdout) == (2, "")
        assert words in done.output
        assert {path.name for path in tmp_path.iterdir()} == {"link", "f"}


def test_folder_in_place_of_a_file_is_refused_before_the_run(tmp_path, monkeypatch):
    monkeypatch.setattr("towercrane.kernels.straight.written.written", None)
    (tmp_path / "result.nc").mkdir()
    done = CliRunner().invoke(app, [*RUN, "--out", str(tmp_path)])
    assert done.exit_code == 2
    assert done.stderr == f"--out {tmp_path}: wanted a file, {tmp_path / 'result.nc'} is a folder\n"


ESCAPE = "\x1b[31mred\x07\u202e\x9b"


def inside(*arguments, monkeypatch):
    """Exit code of the program run in this process."""
    monkeypatch.setattr(sys, "argv", ["towercrane", *arguments])
    before = signal.getsignal(signal.SIGINT)
    try:
        with pytest.raises(SystemExit) as done:
            main()
    finally:
        signal.signal(signal.SIGINT, before)
        gc.unfreeze()
        gc.set_threshold(700)
    return done.value.code


@pytest.mark.parametrize(
    "arguments",
    [
        (*RUN, "--set", f"payload.{ESCAPE}=3"),
        (*RUN, "--set", f"solver.method={ESCAPE}"),
        (*RUN, f"--{ESCAPE}"),
        (*RUN, ESCAPE),
        ("run", ESCAPE),
        ("sweep", RUN[1], "--vary", ESCAPE),
        ("animate", f"{ESCAPE}.nc"),
        ("bench", "--subject", ESCAPE),
    ],
    ids=["key", "value", "option", "argument", "case", "vary", "result", "subject"],
)
def test_what_a_terminal_would_obey_is_spelled_out_in_messages(arguments, capsys, monkeypatch):
    assert inside(*arguments, monkeypatch=monkeypatch) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert all(line.isprintable() for line in err.splitlines())
    assert r"\x1b[31mred\x07\u202e\x9b" in err.replace(r"\u001b", r"\x1b").replace(r"\u0007", r"\x07")


def test_what_a_terminal_would_obey_is_spelled_out_in_tables(tmp_path, capsys, monkeypatch):
    title = r"\u001b[31m [red]x[/b] :smile: \u202e"
    assert inside(*RUN, "--set", f'title="{title}"', "--out", str(tmp_path), monkeypatch=monkeypatch) == 0
    out = capsys.readouterr().out
    assert all(line.isprintable() for line in out.splitlines())
    assert r"\x1b[31m [red]x[/b] :smile: \u202e" in out


def test_letters_that_a_terminal_lacks_are_shown_by_their_numbers(tmp_path):
    title = "Größe 中".encode().decode("ascii", "surrogateescape")
    code, out, _ = program(*RUN, "--set", f'title="{title}"', "--out", str(tmp_path), PYTHONIOENCODING="ascii")
    assert code == 0
    assert r"Gr\xf6\xdfe \u4e2d" in out
    assert results.load(tmp_path / "result.nc").attrs["title"] == "Größe 中"


@posix
def test_bytes_that_are_no_text_are_refused(tmp_path):
    code, out, err = program(*RUN, "--set", b'title="\xff"', cwd=tmp_path)
    assert (code, out) == (2, "")
    assert "text in UTF-8" in err
    assert r"\udcff" in err
    assert list(tmp_path.iterdir()) == []


def test_a_part_of_a_result_is_put_beside_an_earlier_whole_one(tmp_path):
    task = Task("some case", [], None, as_json=False, folder=tmp_path / "here")
    task.spare("summary.json")
    assert task.folder == tmp_path / "here"
    task.folder.mkdir()
    (task.folder / "summary.json").write_text("{}")
    task.spare("summary.json")
    assert task.folder == tmp_path / "here-interrupted"
