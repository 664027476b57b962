"""The control channel: who is heard, and what is answered."""

import json
import os
import socket
import stat
import subprocess
import sys
import threading
import time
from contextlib import ExitStack

import pytest
from signals_elsewhere import broken_off
from stalls import Stalls

from mmrs_runtime.control import CONNECTIONS, Control, Taken
from mmrs_runtime.orders.channels import CALL_SECONDS, Unreachable, asked_at_once, network
from mmrs_runtime.orders.ordering import give, main
from mmrs_runtime.orders.orders import Orders

pytestmark = pytest.mark.real_time("parts of flights")


ROBOTS = ("alpha", "beta")


@pytest.fixture
def orders():
    return Orders()


@pytest.fixture
def opened(tmp_path, orders):
    """Return a function that opens a channel; all are closed when the test is over."""
    with ExitStack() as stack:

        def open_channel(robots=ROBOTS, folder=tmp_path, **options):
            status = {"mode": "guided", "energy": 0.5}
            control = Control(folder, "run-0", robots, orders, lambda robot: status, **options)
            stack.callback(control.close)
            return control

        yield open_channel


@pytest.fixture
def robots(orders):
    """Return a function that has some robots obey all they are told, in a thread of their own."""
    over = threading.Event()
    threads = []

    def obey(*names, refuse=()):
        def work():
            while not over.is_set():
                for order in orders.taken():
                    for robot in set(order.robots) & set(names):
                        order.refuse(robot, refuse[robot]) if robot in refuse else order.confirm(robot)
                over.wait(0.005)

        threads.append(threading.Thread(target=work))
        threads[-1].start()

    yield obey
    over.set()
    for thread in threads:
        thread.join()


def ask(folder, **content):
    """Send one line to the channel in a folder, with its token unless another is given."""
    facts = json.loads((folder / "control.json").read_text("ascii"))
    with (
        socket.create_connection(("127.0.0.1", facts["port"])) as connection,
        connection.makefile("rwb") as file,
    ):
        file.write(json.dumps({"token": facts["token"], **content}).encode() + b"\n")
        file.flush()
        return json.loads(file.readline())


def test_every_robot_confirms_an_order_to_all(tmp_path, opened, robots):
    opened()
    robots(*ROBOTS)
    replies = list(give(tmp_path, "hold"))
    assert {reply["robot"] for reply in replies} == {"alpha", "beta"}
    assert all(reply["confirmed"] and reply["seconds"] < 1.0 for reply in replies)


def test_an_order_to_one_robot_is_not_heard_by_the_others(tmp_path, opened, robots):
    opened()
    robots("beta")
    (reply,) = give(tmp_path, "land", ["beta"])
    assert (reply["robot"], reply["confirmed"]) == ("beta", True)


def test_a_robot_that_does_not_answer_is_told_after_the_seconds_asked_for(tmp_path, opened):
    opened()
    (reply,) = give(tmp_path, "hold", ["alpha"], seconds=0.1)
    assert not reply["confirmed"]
    assert "no answer yet" in reply["why"]


def test_a_robot_that_refuses_says_why(tmp_path, opened, robots, capsys):
    opened()
    robots("alpha", refuse={"alpha": "is in the workshop"})
    assert main(["hold", "alpha", "--log", str(tmp_path)]) == 1
    assert capsys.readouterr().out == "'alpha': hold not confirmed (is in the workshop)\n"


def test_a_robot_that_has_ended_refuses_what_it_was_told_and_what_comes(tmp_path, opened, orders):
    opened()
    order = orders.give("hold", ["alpha"])
    orders.close("its program has ended")
    (reply,) = give(tmp_path, "hold", ["alpha"])
    assert order.refused == {"alpha": "its program has ended"}
    assert reply["why"] == "its program has ended"


def test_an_answer_is_given_with_its_question(tmp_path, opened, orders):
    opened()
    list(give(tmp_path, "answer", ["alpha"], question="is it safe", answer=True, seconds=0.1))
    (order,) = orders.taken()
    assert (order.kind, order.robots) == ("answer", ("alpha",))
    assert (order.question, order.answer) == ("is it safe", True)


def test_an_answer_to_everybody_is_for_those_who_take_it(tmp_path, opened, robots):
    opened()
    robots(*ROBOTS, refuse={"beta": "no choice asks 'is it safe'; none asks anything"})
    (reply,) = give(tmp_path, "answer", question="is it safe", answer=True)
    assert (reply["robot"], reply["confirmed"]) == ("alpha", True)


def test_status_tells_of_each_robot(tmp_path, opened, capsys):
    opened()
    assert main(["status", "--log", str(tmp_path)]) == 0
    assert capsys.readouterr().out.splitlines()[0] == "'alpha'  guided  battery 50%"


@pytest.mark.parametrize(
    ("encoding", "shown"), [("utf-8", "'Ärger'  guided"), ("ascii", "'\\xc4rger'  guided")]
)
def test_names_are_shown_as_they_are_written_where_the_terminal_can(tmp_path, opened, encoding, shown):
    opened(["Ärger"])
    order = [sys.executable, "-m", "mmrs_runtime.control", "status", "--log", str(tmp_path)]
    environment = {**os.environ, "PYTHONIOENCODING": encoding}
    done = subprocess.run(order, capture_output=True, env=environment, check=True, timeout=60)
    assert done.stdout.decode(encoding).startswith(shown)


def test_who_does_not_know_the_token_is_not_obeyed(tmp_path, opened, orders):
    opened()
    assert ask(tmp_path, token="guessed", order="land") == {"error": "token: is not that of this process"}
    assert orders.taken() == ()


def test_only_its_user_may_read_the_token(tmp_path, opened):
    opened()
    assert stat.S_IMODE((tmp_path / "control.json").stat().st_mode) == 0o600


@pytest.mark.parametrize(
    ("content", "complaint"),
    [
        ({"order": "explode"}, "order: 'explode' is none of hold"),
        ({"order": "hold", "robots": ["gamma"]}, "'gamma': no robot of this process"),
        ({"order": "hold", "robots": 7}, "robots: must be a list of names"),
        ({"order": "hold", "seconds": True}, "seconds: must be a number"),
        ({"order": "answer", "question": "is it safe"}, "answer: needs a question"),
    ],
)
def test_an_order_that_makes_no_sense_is_refused_in_words(tmp_path, opened, content, complaint):
    opened()
    assert complaint in ask(tmp_path, **content)["error"]


@pytest.fixture
def connected(tmp_path):
    """Return a function that connects to the channel and says nothing."""
    with ExitStack() as stack:

        def connect():
            port = json.loads((tmp_path / "control.json").read_text("ascii"))["port"]
            return stack.enter_context(socket.create_connection(("127.0.0.1", port), 10.0))

        yield connect


def test_clients_that_say_nothing_keep_no_order_from_the_robots(tmp_path, opened, robots, connected):
    opened(greeting_seconds=60.0)
    robots(*ROBOTS)
    for _ in range(3 * CONNECTIONS):
        connected()
    assert [reply["confirmed"] for reply in give(tmp_path, "land")] == [True, True]


@pytest.mark.parametrize("begun", [b"", b'{"token": '])
def test_a_client_that_gives_no_whole_order_in_time_is_hung_up_on(opened, connected, begun):
    opened(greeting_seconds=0.1)
    client = connected()
    client.sendall(begun)
    with client.makefile("rb") as file:
        assert json.loads(file.readline()) == {"error": "an order is one whole line within 0.1 s"}
        assert file.read() == b""


def test_a_client_that_gives_an_order_that_is_too_long_is_told_so(opened, connected):
    opened()
    with connected().makefile("rwb") as file:
        file.write(b" " * 300_000 + b"\n")
        file.flush()
        assert json.loads(file.readline()) == {"error": "an order is one line of less than 65536 bytes"}


def test_an_order_that_has_a_name_twice_is_refused(tmp_path, opened, connected):
    opened()
    token = json.loads((tmp_path / "control.json").read_text("ascii"))["token"]
    with connected().makefile("rwb") as file:
        file.write(f'{{"token": "{token}", "order": "hold", "order": "land"}}\n'.encode())
        file.flush()
        assert json.loads(file.readline()) == {"error": "'order' is there more than once"}


def test_a_client_may_give_one_order_after_the_other(tmp_path, opened, connected):
    opened()
    token = json.loads((tmp_path / "control.json").read_text("ascii"))["token"]
    with connected().makefile("rwb") as file:
        for order in ("explode", "status"):
            file.write(json.dumps({"token": token, "order": order}).encode() + b"\n")
            file.flush()
            said = json.loads(file.readline())
    assert said["robot"] == "alpha"


@pytest.mark.parametrize(
    "facts",
    [
        '{"port": 99999999, "token": "", "robots": ["beta"]}',
        '{"port": 7, "robots": 7}',
        '{"port": 0, "robots": {"alpha": 1}}',
        "[" * 9999,
        "[1]",
    ],
)
def test_an_announcement_of_any_shape_keeps_no_process_from_its_start(tmp_path, opened, facts):
    (tmp_path / "control-1.json").write_text(facts, "ascii")
    opened()
    assert len(list(give(tmp_path, "status"))) == 2


def test_processes_that_share_a_folder_are_all_heard(tmp_path, opened, robots):
    opened(["alpha"])
    opened(["beta"])
    robots(*ROBOTS)
    assert {reply["robot"] for reply in give(tmp_path, "hold")} == {"alpha", "beta"}


def left_by_a_killed_process(folder, robots, name="control-1.json", **where):
    """Announce a process that is not there any more."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        facts = {"port": server.getsockname()[1], "token": "old", "robots": robots, **where}
    (folder / name).write_text(json.dumps(facts), "ascii")


def test_the_announcement_of_a_process_that_was_killed_is_replaced(tmp_path, opened, robots):
    left_by_a_killed_process(tmp_path, ["alpha"], "control.json")
    opened()
    robots(*ROBOTS)
    assert len(list(give(tmp_path, "hold"))) == 2


def test_a_port_that_somebody_else_has_by_now_is_no_process_that_runs(tmp_path, opened):
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    with socket.create_server(("127.0.0.1", 0)) as stranger:
        port = stranger.getsockname()[1]
        facts = {"port": port, "token": "old", "pid": gone.pid, "robots": ["alpha"]}
        (tmp_path / "control.json").write_text(json.dumps(facts), "ascii")
        opened()
    assert json.loads((tmp_path / "control.json").read_text("ascii"))["pid"] == os.getpid()


def test_a_process_that_answers_runs_in_another_container_maybe(tmp_path, opened):
    opened(["alpha"])
    path = tmp_path / "control.json"
    gone = subprocess.Popen([sys.executable, "-c", ""])
    gone.wait()
    path.write_text(json.dumps(json.loads(path.read_text("ascii")) | {"pid": gone.pid}), "ascii")
    with pytest.raises(Taken):
        opened(["alpha"])


def test_a_killed_process_keeps_no_order_from_the_robots_of_others(tmp_path, opened, robots, capsys):
    opened()
    robots(*ROBOTS)
    left_by_a_killed_process(tmp_path, ["gamma"])
    replies = {reply["robot"]: reply for reply in give(tmp_path, "stop")}
    assert (replies["alpha"]["confirmed"], replies["beta"]["confirmed"]) == (True, True)
    assert (replies["gamma"]["confirmed"], replies["gamma"]["why"]) == (False, "its process no longer runs")
    assert main(["status", "--log", str(tmp_path)]) == 0
    assert "'gamma'  its process no longer runs" in capsys.readouterr().out


def test_a_process_that_hangs_keeps_no_order_from_the_robots_of_others(tmp_path, opened, robots):
    opened()
    robots(*ROBOTS)
    with socket.create_server(("127.0.0.1", 0)) as frozen:
        facts = {"port": frozen.getsockname()[1], "token": "", "robots": ["gamma"]}
        (tmp_path / "control-1.json").write_text(json.dumps(facts), "ascii")
        replies, begun = give(tmp_path, "hold", seconds=0.2), time.monotonic()
        assert {next(replies)["robot"], next(replies)["robot"]} == {"alpha", "beta"}
        assert time.monotonic() - begun < CALL_SECONDS
        last = next(replies)
    assert (last["robot"], last["why"]) == ("gamma", "its process does not answer")


def test_whoever_gives_an_order_need_not_wait_for_the_answer_of_a_process_that_hangs():
    stalls, begun = Stalls(), time.monotonic()
    with socket.create_server(("127.0.0.1", 0)) as frozen, broken_off():
        list(asked_at_once([(frozen.getsockname()[1], {"order": "hold", "robots": []})], seconds=1.0))
    assert time.monotonic() - begun < 3.0 + stalls.seconds


def test_a_robot_that_was_started_again_after_its_process_was_killed_is_told_once(tmp_path, opened, robots):
    opened()
    robots(*ROBOTS)
    left_by_a_killed_process(tmp_path, ["alpha"])
    assert [reply["confirmed"] for reply in give(tmp_path, "hold", ["alpha"])] == [True]


def test_of_a_process_on_another_machine_nobody_says_that_it_has_ended(tmp_path):
    left_by_a_killed_process(tmp_path, ["alpha"], machine="heron", network="of heron")
    with pytest.raises(
        Unreachable,
        match=r"'alpha': was started on 'heron', in another network.*it is unknown whether it runs",
    ):
        list(give(tmp_path, "hold"))


def test_a_channel_says_where_it_is(tmp_path, opened):
    opened()
    facts = json.loads((tmp_path / "control.json").read_text())
    assert (facts["machine"], facts["network"]) == (socket.gethostname(), network())


def test_where_all_processes_were_killed_nobody_can_be_reached(tmp_path):
    left_by_a_killed_process(tmp_path, ["alpha", "beta"])
    left_by_a_killed_process(tmp_path, ["gamma"], "control.json")
    words = "'alpha', 'beta': its process no longer runs; 'gamma': its process no longer runs"
    with pytest.raises(Unreachable, match=words):
        list(give(tmp_path, "hold"))


def test_whoever_is_started_takes_away_what_killed_processes_have_left(tmp_path, opened):
    left_by_a_killed_process(tmp_path, ["alpha"])
    left_by_a_killed_process(tmp_path, ["gamma"], "control.json")
    opened()
    assert [path.name for path in tmp_path.iterdir()] == ["control.json"]


def test_an_announcement_that_is_being_written_is_left_alone(tmp_path, opened):
    (tmp_path / "control.json").touch()
    opened()
    assert len(list(tmp_path.iterdir())) == 2
    assert len(list(give(tmp_path, "status"))) == 2


def test_a_robot_is_run_by_one_process_at_a_time(tmp_path, opened):
    opened()
    with pytest.raises(Taken, match=rf"'alpha' is run by process {os.getpid()} already \(control.json\)"):
        Control(tmp_path, "run-0", ["alpha", "gamma"], Orders(), lambda robot: {})
    assert [path.name for path in tmp_path.glob("control*.json")] == ["control.json"]


def test_nothing_is_left_of_a_channel_that_was_closed(tmp_path):
    Control(tmp_path, "run-0", ROBOTS, Orders(), lambda robot: {}).close()
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(Unreachable, match="no running robots"):
        list(give(tmp_path, "hold"))


def test_a_robot_that_nobody_runs_is_not_found(tmp_path, opened):
    opened()
    with pytest.raises(Unreachable, match="'gamma': not running; there are 'alpha', 'beta'"):
        list(give(tmp_path, "hold", ["gamma"]))
