"""The driver on its page drives: its code is installed, generates, and moves a kart that the test is."""

import os
import socketserver
import subprocess
import threading
from pathlib import Path

import pytest
from code_blocks import blocks_of
from warm_python import python

from mmrs_core.behaviour.log import read_logs

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "driver.md"
PATIENCE = 60.0
METADATA = "Metadata-Version: 2.4\nName: kart\nVersion: 1.0\nRequires-Dist: mmrs-runtime\n"
WHEEL = "Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n"


class KartHandler(socketserver.StreamRequestHandler):
    """What a kart answers; it stays on its way as long as the test says."""

    def handle(self):
        for line in self.rfile:
            word, *numbers = line.decode().split()
            self.server.heard.append(line.decode().strip())
            if word == "GO" and self.server.hangs_up:
                return
            if word == "GO" and (self.server.arrives or numbers[:2] == ["0", "0"]):
                self.wfile.write(f"AT {numbers[0]} {numbers[1]}\nTHERE\n".encode())
            elif word == "STOP":
                self.wfile.write(b"STOPPED\n")


@pytest.fixture
def kart():
    """Return a kart that listens, and what it has heard."""
    with socketserver.ThreadingTCPServer(("127.0.0.1", 0), KartHandler) as server:
        server.where = f"127.0.0.1:{server.server_address[1]}"
        server.daemon_threads, server.heard, server.arrives, server.hangs_up = True, [], True, False
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield server
        server.shutdown()


@pytest.fixture(scope="module")
def yard(tmp_path_factory):
    """Return a folder with the page's files, their distribution installed, and the code generated."""
    folder = tmp_path_factory.mktemp("yard")
    titled = [block for block in blocks_of(PAGE.read_text(encoding="utf-8"), PAGE.name) if block.title]
    for block in titled:
        (folder / block.title).parent.mkdir(parents=True, exist_ok=True)
        (folder / block.title).write_text(block.text, encoding="utf-8")
    described = folder / "kart-1.0.dist-info"
    described.mkdir()
    (described / "METADATA").write_text(METADATA)
    (described / "WHEEL").write_text(WHEEL)
    (described / "entry_points.txt").write_text("[mmrs.plugins]\nkart = kart.target\n")
    names = [block.title for block in titled if block.title.startswith("kart/")]
    names += ["kart-1.0.dist-info/METADATA", "kart-1.0.dist-info/WHEEL"]
    (described / "RECORD").write_text("".join(f"{name},,\n" for name in names))
    done = command(folder, "mmrs_core", "generate", "round", "--target", "kart", "-o", "code")
    assert done.returncode == 0, done.stdout + done.stderr
    return folder


def command(folder, module, *arguments):
    """Run a command where the page's distribution is installed."""
    call = [python(), "-m", module, *arguments]
    return subprocess.run(
        call, cwd=folder, env=_env(folder), capture_output=True, text=True, timeout=PATIENCE
    )


def _env(folder):
    return os.environ | {"PYTHONPATH": str(folder)}


def drive(yard, kart, log, *more):
    """Begin to drive the kart that listens at HOST:PORT; return the process."""
    call = [python(), "fleet.py", "--kart", kart, "--log", str(log), *more]
    return subprocess.Popen(
        call, cwd=yard / "code", env=_env(yard), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )


def test_a_kart_drives_its_round_and_its_log_replays(yard, kart, tmp_path):
    process = drive(yard, kart.where, tmp_path)
    said, _ = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0, said
    assert [line.split()[1:3] for line in kart.heard] == [["8.0", "3.0"], ["0.0", "0.0"]]
    assert kart.heard[0].split()[3] == "2.0"
    done = command(yard, "mmrs_core", "replay", "round", str(tmp_path))
    assert done.returncode == 0, done.stdout + done.stderr


def test_a_kart_is_sent_home_by_an_order(yard, kart, tmp_path):
    kart.arrives = False
    process = drive(yard, kart.where, tmp_path)
    with process:
        while not kart.heard:
            assert process.poll() is None, process.stdout.read()
        order = command(yard, "mmrs_core", "control", "return", "Kit", "--log", str(tmp_path))
        assert order.returncode == 0, order.stdout + order.stderr
        said, _ = process.communicate(timeout=PATIENCE)
    assert kart.heard[1:] == ["GO 0 0 1"]
    assert "ORDERED" in said
    assert [step.detail for step in read_logs([tmp_path])][-1] == "ORDERED"


def test_a_kart_that_hangs_up_is_a_lost_link(yard, kart, tmp_path):
    kart.hangs_up = True
    said, _ = drive(yard, kart.where, tmp_path).communicate(timeout=PATIENCE)
    assert "LINK_LOST: the kart has hung up" in said
    assert [step.detail for step in read_logs([tmp_path])][-1] == "LINK_LOST"


def test_nobody_who_listens_is_told_and_a_dry_run_needs_nobody(yard, tmp_path):
    process = drive(yard, "127.0.0.1:9", tmp_path / "nobody")
    said, _ = process.communicate(timeout=PATIENCE)
    assert process.returncode == 5, said
    assert "refused" in said
    process = drive(yard, "nowhere", tmp_path / "nowhere")
    said, _ = process.communicate(timeout=PATIENCE)
    assert process.returncode == 2, said
    assert "--kart nowhere: expected HOST:PORT" in said
    process = drive(yard, "127.0.0.1:9", tmp_path / "dry", "--dry-run")
    said, _ = process.communicate(timeout=PATIENCE)
    assert process.returncode == 0, said


def test_the_folder_carries_the_wheel_of_the_driver(yard):
    wheels = {wheel.name.partition("-")[0] for wheel in (yard / "code" / "wheels").iterdir()}
    assert wheels == {"kart", "mmrs_runtime"}
    assert (yard / "code" / "README.md").read_text().startswith("# Controllers of Round")


def test_other_robots_are_refused(yard):
    barges = yard / "barges"
    (barges / "robots").mkdir(parents=True)
    for name, now, then in (
        ("behaviour.xmi", 'typeName="Kart"', 'typeName="Barge"'),
        ("robots/kart.xmi", 'name="Kart"', 'name="Barge"'),
        ("context.xmi", "Yard", "Harbour"),
    ):
        (barges / name).write_text((yard / "round" / name).read_text().replace(now, then))
    done = command(yard, "mmrs_core", "generate", "barges", "--target", "kart", "-o", "other")
    assert done.returncode == 1, done.stdout + done.stderr
    assert "robot 'Kit': is no kart" in done.stderr
