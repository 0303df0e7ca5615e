"""Films: every frame in the file, drawn as a whole picture would be, and never half a file."""

import sys

import matplotlib as mpl
import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image

from towercrane.cases.case import load_case
from towercrane.cases.models import poses_of
from towercrane.report.film import file as film_file
from towercrane.report.film.film import Film
from towercrane.report.film.playback import Playback
from towercrane.runs.run import run_case

BASELINE_VERSION = "3.11."


def filmed(name, *changes, playback, magnification=None):
    case = load_case(name, changes)
    result = run_case(case)
    poses = poses_of(case, result, playback.times)
    return Film(result, poses, playback, magnification or poses.fitting_magnification())


@pytest.fixture(scope="module")
def film():
    """Nine frames of a crane that slews."""
    return filmed("qtz5613/slewing", "run.duration=8 s", playback=Playback(0.0, 8.0, 10.0, 10.0), magnification=5.0)


@pytest.fixture(scope="module")
def plane():
    """Frames of a crane in the plane, a third of a second apart in the film."""
    playback = Playback(0.0, 4.0, 3.0, 3.0)
    return filmed("qtz5613/condition-3", "run.duration=4 s", playback=playback)


@pytest.mark.skipif(not mpl.__version__.startswith(BASELINE_VERSION), reason="picture of another matplotlib")
@pytest.mark.mpl_image_compare(filename="film.png", tolerance=8, style="default")
def test_frame_of_a_slewing_crane(film):
    # The style of the comparison comes after the film's own.
    film.show(7)
    return film.figure


def test_frame_on_the_drawn_background_is_the_whole_picture(film, tmp_path):
    quick = film.pixels(5)[..., :3].astype(int)
    film.figure.savefig(tmp_path / "whole.png", dpi=100)
    with Image.open(tmp_path / "whole.png") as read:
        whole = np.asarray(read.convert("RGB")).astype(int)
    # What moves is drawn last; a frame of the axes under a line may differ, a missing or stale line would not pass.
    assert np.count_nonzero(abs(quick - whole).max(axis=-1) > 8) < 200


def test_same_frame_has_the_same_pixels_whatever_came_before(film):
    film.pixels(0)
    first = film.pixels(3).copy()
    film.pixels(8)
    assert np.array_equal(film.pixels(3), first)
    assert not np.array_equal(film.pixels(4), first)


def test_picture_states_scale_speed_and_assumptions(film, plane):
    for one, speed in ((film, 10), (plane, 3)):
        labels = [text.get_text() for text in one.figure.legends[0].get_texts()]
        assert labels[:3] == ["deformation × 5", "shaded: true scale", "undeformed"]
        side = one.figure.axes[0]
        assert side.get_title(loc="right") == f"played at {speed} × real time"
        assert "assumed" in one.figure._supxlabel.get_text()
        for axes in one.figure.axes:
            assert "[" in axes.get_xlabel()
            assert "[" in axes.get_ylabel()
    assert len(film.figure.axes) == 3
    assert len(plane.figure.axes) == 2


def test_scales_are_equal_and_hold_every_frame(film):
    film.pixels(0)
    for axes, seen in zip(film.figure.axes[:2], ((0, 2), (0, 1)), strict=True):
        box = axes.get_window_extent()
        across, up = np.ptp(axes.get_xlim()) / box.width, np.ptp(axes.get_ylim()) / box.height
        assert_allclose(across, up, rtol=1e-9)
        for lines in (film.poses.members, film.poses.magnified(5.0), {"load": film.poses.load[:, None]}):
            for line in lines.values():
                points = (film.poses.turned_back(line) if seen == (0, 2) else line)[..., seen]
                assert points[..., 0].min() > axes.get_xlim()[0]
                assert points[..., 0].max() < axes.get_xlim()[1]
                assert points[..., 1].min() > axes.get_ylim()[0]
                assert points[..., 1].max() < axes.get_ylim()[1]


def test_rope_is_drawn_from_the_true_trolley_to_the_load(film):
    film.show(6)
    above = film.figure.axes[1]
    ends = np.stack([film.poses.members["suspension"][6, 0], film.poses.load[6]])[:, :2]
    drawn = [line.get_xydata() for line in above.get_lines() if len(line.get_xdata()) == 2]
    assert any(np.allclose(points, ends, rtol=0, atol=1e-12) for points in drawn)


def test_gif_has_every_frame_for_its_time(film, plane, tmp_path):
    counted = []
    film_file.save(film, tmp_path / "film.gif", 10.0, counted.append)
    assert counted == list(range(1, 10))
    with Image.open(tmp_path / "film.gif") as read:
        assert (read.n_frames, read.size, read.info["loop"]) == (9, (960, 540), 0)
        stays = []
        for frame in range(9):
            read.seek(frame)
            stays.append(read.info["duration"])
            # A palette of 127 colours softens edges a little; a lost or stale part would be off by a lot.
            off = abs(np.asarray(read.convert("RGB")).astype(int) - film.pixels(frame)[..., :3])
            assert off.mean() < 0.5, frame
            assert np.count_nonzero(off.max(axis=-1) > 60) < 20, frame
    assert stays == [100] * 8 + [1100]
    # Thirds of a second round to hundredths without losing time.
    film_file.save(plane, tmp_path / "plane.gif", 3.0)
    with Image.open(tmp_path / "plane.gif") as read:
        stays = [(read.seek(frame), read.info["duration"])[1] for frame in range(read.n_frames)]
    assert stays == [330, 340, 330, 330, 1340]


def test_film_that_dies_leaves_the_old_one_and_nothing_else(film, tmp_path):
    path = tmp_path / "film.gif"
    path.write_bytes(b"the old one")

    def interrupt(done):
        if done == 3:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        film_file.save(film, path, 10.0, interrupt)
    assert path.read_bytes() == b"the old one"
    assert list(tmp_path.iterdir()) == [path]


def test_other_endings_and_rates_are_refused(film, tmp_path):
    with pytest.raises(ValueError, match=r"wanted a name that ends in \.gif or \.mp4, got \.avi"):
        film_file.save(film, tmp_path / "film.avi", 10.0)
    with pytest.raises(ValueError, match=r"wanted at most 50 frames per second in a \.gif, got 51"):
        film_file.save(film, tmp_path / "film.gif", 51.0)
    with mpl.rc_context({"animation.ffmpeg_path": "no-such-ffmpeg"}), pytest.raises(ValueError, match="ffmpeg"):
        film_file.save(film, tmp_path / "film.mp4", 10.0)
    assert not list(tmp_path.iterdir())


def ffmpeg(folder, does):
    """A program that stands for ffmpeg: the film is its last argument, the frames come on its input."""
    program = folder / "ffmpeg"
    program.write_text(f"#!{sys.executable}\nimport sys\n{does}\n", encoding="utf-8")
    program.chmod(0o755)
    return mpl.rc_context({"animation.ffmpeg_path": str(program)})


@pytest.mark.skipif(sys.platform == "win32", reason="a script is no program there")
def test_mp4_is_sent_to_ffmpeg_frame_by_frame(film, tmp_path):
    films = tmp_path / "films"
    copies = (
        "open(sys.argv[-1], 'wb').write(sys.stdin.buffer.read())\n"
        "print(sys.argv, file=open(sys.argv[0] + '.said', 'w'))"
    )
    with ffmpeg(tmp_path, copies):
        film_file.save(film, films / "film.mp4", 10.0)
    sent = np.frombuffer((films / "film.mp4").read_bytes(), np.uint8).reshape(-1, 540, 960, 4)
    assert len(sent) == 9
    assert np.array_equal(sent[4], film.pixels(4))
    said = (tmp_path / "ffmpeg.said").read_text("utf-8")
    assert "'960x540'" in said
    assert "'-framerate', '10.0'" in said
    # One that fails says why, and leaves what was there.
    with (
        ffmpeg(tmp_path, "sys.exit('unknown encoder')"),
        pytest.raises(OSError, match="ffmpeg failed: unknown encoder"),
    ):
        film_file.save(film, films / "film.mp4", 10.0)
    assert len((films / "film.mp4").read_bytes()) == sent.size
    assert [path.name for path in films.iterdir()] == ["film.mp4"]


def test_run_that_ends_early_says_so_in_its_last_frame():
    case = load_case("hard/slack-while-lowering")
    result = run_case(case)
    playback = Playback(0.0, float(result["time"][-1]), 0.05)
    film = Film(result, poses_of(case, result, playback.times), playback, 2.0)
    words = [text for text in film.figure.axes[0].texts if "ended" in text.get_text()]
    assert not words
    film.show(film.frames - 1)
    words = [text.get_text() for text in film.figure.axes[0].texts]
    assert "ended: slack rope" in words
    assert words[0] == "0.0280 s"


def test_collars_are_drawn_at_rest_and_named(plane):
    playback = Playback(0.0, 0.4, 1.0, 5.0)
    held = filmed("towers/tied-wind", "run.duration=0.4 s", "model.tower_modes=1", playback=playback)
    held.show(2)
    drawn = [line.get_xydata() for line in held.figure.axes[0].get_lines() if line.get_marker() == "s"]
    assert any(np.array_equal(places, [[0.0, 30.0], [0.0, 55.0]]) for places in drawn)
    assert "collars at rest" in [text.get_text() for text in held.figure.legends[0].get_texts()]
    assert "collars at rest" not in [text.get_text() for text in plane.figure.legends[0].get_texts()]


def test_ground_is_drawn_where_the_load_stands():
    film = filmed("qtz5613/lift-off", "run.duration=2 s", playback=Playback(0.0, 2.0, 2.0, 2.0), magnification=1.0)
    side = film.figure.axes[0]
    (label,) = [text for text in side.texts if text.get_text() == "ground under the load"]
    assert label.xy[1] == pytest.approx(film.poses.load[0, 2])
    assert label.xy[1] > 1.0
    assert any(list(line.get_ydata()) == [label.xy[1]] * 2 for line in side.lines)
