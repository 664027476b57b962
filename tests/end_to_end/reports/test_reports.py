"""Reports of simulated runs, from models to the page."""

import json
import shutil
from html.parser import HTMLParser

import pytest

from mmrs_core.resources import shipped


class Page(HTMLParser):
    """What a page shows and refers to, and whether its elements are well nested."""

    VOID = frozenset({"meta", "br", "img", "input", "link"})

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.words, self.open, self.tags, self.references = [], [], [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        self.references += [value for name, value in attributes if name in ("src", "href", "xlink:href")]
        if tag not in self.VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag, attributes):
        self.handle_starttag(tag, attributes)
        if tag not in self.VOID:
            self.open.pop()

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if not {"style", "script"} & set(self.open):
            self.words.append(data)

    @property
    def text(self):
        return " ".join(" ".join(self.words).split())


@pytest.fixture
def page(mmrs, project):
    def made(*arguments):
        code, _, err = mmrs("report", project, *(arguments or (project / "logs",)), "-o", project / "r.html")
        assert code == 0, err
        return (project / "r.html").read_text("utf-8")

    return made


def test_the_report_lies_beside_the_logs_unless_told_otherwise(mmrs, project):
    code, out, _ = mmrs("report", project, project / "logs")
    assert code == 0
    assert out == f"written: {project / 'logs' / 'report.html'}\n"
    assert (project / "logs" / "report.html").is_file()


def test_the_page_refers_to_nothing_and_runs_nothing(page):
    parsed = Page(page())
    assert parsed.open == []
    assert parsed.references == []
    assert "script" not in parsed.tags


def test_a_simulation_says_so(page):
    assert "Simulated: no vehicle has flown this." in Page(page()).text


def test_a_run_as_planned_is_told_as_such(mmrs, project):
    code, out, _ = mmrs("report", project, project / "logs", "--json")
    told = json.loads(out)["report"]
    assert code == 0
    assert (told["outcome"], told["complaints"], told["simulated"]) == ("success", [], True)
    assert all(each["sideways"]["largest"] < 0.02 for each in told["deviations"])
    assert {robot["ending"] for robot in told["robots"]} == {"completed"}


def test_the_same_logs_make_the_same_page(page):
    assert page() == page()


def test_the_page_has_no_path_of_the_machine(page, project, tmp_path):
    box = project / "logs" / "left.blackbox.ndjson"
    secret = "00112233445566778899aabbccddeeff" * 2
    words = {"severity": "ERROR", "text": f"{tmp_path}/logs/x.jsonl: full; key {secret}"}
    line = {"run": "run-0", "robot": "left", "time": 1.0, "wall": "", "kind": "text", **words}
    box.write_text(box.read_text() + json.dumps(line) + "\n")
    text = page()
    assert "x.jsonl: full; key …" in text
    assert str(tmp_path) not in text
    assert secret not in text


def test_names_from_logs_are_never_markup(page, project):
    box = project / "logs" / "left.blackbox.ndjson"
    bait = "<script>alert(1)</script><b onclick=x>"
    line = {"run": "run-0", "robot": "left", "time": 1.0, "wall": "", "kind": "reported", "name": bait}
    box.write_text(box.read_text() + json.dumps({**line, "content": {bait: bait}}) + "\n")
    text = page()
    assert bait not in text
    assert bait in Page(text).text


def test_logs_without_black_boxes_are_reported_with_what_they_tell(page, project):
    for box in (project / "logs").glob("*.ndjson"):
        box.unlink()
    text = Page(page()).text
    assert "left: no black box with positions: its track is unknown" in text
    assert "Planned vs. flown" not in text


def test_a_missing_log_is_said_and_not_held_against_the_others(mmrs, project):
    (project / "logs" / "left.jsonl").unlink()
    code, out, _ = mmrs("report", project, project / "logs", "--json")
    told = json.loads(out)["report"]
    assert code == 0
    assert told["complaints"] == []
    assert "left: no log: what it did is unknown" in told["unknown"]
    assert any("cannot be judged" in each for each in told["unknown"])


def test_logs_of_another_behaviour_are_called_that(mmrs, project):
    log = project / "logs" / "left.jsonl"
    lines = log.read_text().splitlines(keepends=True)
    log.write_text("".join(line.replace('"label":"end"', '"label":"begin"') for line in lines))
    _, out, _ = mmrs("report", project, project / "logs", "--json")
    assert json.loads(out)["report"]["complaints"]


def test_a_robot_whose_motors_stopped_on_its_way_home_has_crashed_and_is_on_the_map(mmrs, page, project):
    log, box = project / "logs" / "left.jsonl", project / "logs" / "left.blackbox.ndjson"
    log.write_text("".join(log.read_text().splitlines(keepends=True)[:-4]))
    lines = box.read_text().splitlines(keepends=True)
    last = json.loads(next(line for line in reversed(lines) if '"fix"' in line))
    decided = {"what": "MOTORS_OFF", "why": "RETURN cannot be carried out", "response": "NOTHING"}
    del last["place"]
    box.write_text("".join([*lines, json.dumps({**last, "kind": "decision", **decided}) + "\n"]))
    _, out, _ = mmrs("report", project, project / "logs", "--json")
    assert json.loads(out)["report"]["robots"][0]["ending"] == "MOTORS_OFF"
    shown = page()
    assert "motors off" in Page(shown).text
    assert 'class="mark fault"' in shown


def test_damage_is_told_on_the_page(page, project):
    box = project / "logs" / "left.blackbox.ndjson"
    written = box.read_text()
    box.write_text(written[:-30])
    last = len(written.splitlines())
    assert f"left.blackbox.ndjson:{last}: cut off while it was written" in Page(page()).text


def test_without_types_and_place_the_report_says_what_is_missing(mmrs, project, tmp_path):
    alone = tmp_path / "alone"
    alone.mkdir()
    (project / "behaviour.xmi").rename(alone / "behaviour.xmi")
    code, out, err = mmrs("report", alone, project / "logs", "--json", "-o", alone / "r.html")
    assert code == 0, err
    unknown = json.loads(out)["report"]["unknown"]
    assert any("planned times and energy are unknown" in each for each in unknown)
    assert any("no context: " in each for each in unknown)


def test_a_report_replaces_no_log(mmrs, project):
    code, _, err = mmrs("report", project, project / "logs", "-o", project / "logs" / "left.blackbox.ndjson")
    assert code == 2
    assert "is read by this command" in err


def test_nothing_to_report_on_is_an_error(mmrs, project, tmp_path):
    (tmp_path / "empty").mkdir()
    code, _, err = mmrs("report", project, tmp_path / "empty")
    assert code == 3
    assert "contains no log and no black box" in err


def test_a_preview_of_logs_shows_what_was_flown_over_what_was_planned(mmrs, project):
    code, _, err = mmrs("preview", project, "--logs", project / "logs", "-o", project / "out")
    assert code == 0, err
    text = (project / "out" / "preview.html").read_text("utf-8")
    assert text.count('class="planned"') > 2
    assert '"times":' in text or '"times": ' in text
    assert "flown for" in text


def test_a_preview_of_logs_shows_the_tasks_of_the_mission_beside_the_behaviour(mmrs, tmp_path):
    project = shutil.copytree(shipped("examples") / "drone-and-rover", tmp_path / "yard")
    for order in (("plan", project), ("simulate", project, "-o", project / "logs")):
        assert mmrs(*order)[0] == 0
    assert mmrs("preview", project, "--logs", project / "logs", "-o", project / "out")[0] == 0
    text = (project / "out" / "preview.html").read_text("utf-8")
    assert "2 robots, 3 tasks, flown for" in text
    assert text.count('class="task-bar"') == 3
    assert "not drawn" not in text
    mission = project / "mission.xmi"
    mission.write_text(mission.read_text("utf-8").replace("<tasks ", '<tasks speed="x" ', 1), "utf-8")
    assert mmrs("preview", project, "--logs", project / "logs", "-o", project / "out")[0] == 0
    assert "not drawn: tasks: mission.xmi is not valid" in (project / "out" / "preview.html").read_text(
        "utf-8"
    )
    assert mmrs("report", project, project / "logs", "-o", project / "report.html")[0] == 0
    assert "not drawn: tasks: mission.xmi is not valid" in (project / "report.html").read_text("utf-8")


def test_a_replay_tells_where_robots_were(mmrs, project):
    code, out, _ = mmrs("replay", project, project / "logs", "--steps", "--json")
    told = json.loads(out)
    assert code == 0
    assert (told["boxes"], told["damages"]) == (2, [])
    assert len(told["where"]) == told["steps"]
    assert all(step["where"] is not None for step in told["where"])


def test_a_replay_tells_what_is_damaged_of_black_boxes_and_judges_the_logs(mmrs, project):
    box = project / "logs" / "left.blackbox.ndjson"
    box.rename(project / "logs" / "left.blackbox.0002.ndjson")
    code, out, err = mmrs("replay", project, project / "logs")
    assert code == 0
    assert out.startswith("accepted: success")
    assert "left.blackbox: part 1 of 2 is missing" in err
    assert "left.blackbox: its last part, left.blackbox.ndjson, is missing" in err
