"""A real browser shows the page: its script runs, and nothing is fetched."""

import re

import pytest

from mmrs_core.pictures.preview.page import page

pytestmark = pytest.mark.peer


def test_the_player_puts_every_robot_at_its_home(in_browser, picture):
    from mmrs_core.pictures.preview.projection import projection_of

    dom, complaints = in_browser(page(picture))
    dots = re.findall(r'<circle class="dot"[^>]* cx="([\d.]+)" cy="([\d.]+)"', dom)
    expected = [projection_of(picture).place(robot.home) for robot in picture.robots]
    assert [tuple(map(float, dot)) for dot in dots] == [pytest.approx(place) for place in expected]
    assert complaints == []


def test_hostile_names_run_nothing(in_browser, picture_named):
    bait = "<img src=x onerror=document.body.dataset.caught=1><script>document.body.dataset.caught=1</script>"
    dom, complaints = in_browser(page(picture_named(Alba=bait, field=bait, mission=f"</script>{bait}")))
    assert "data-caught" not in dom
    assert complaints == []


def test_the_map_zooms_and_layers_go_off_and_time_moves(in_browser, picture):
    user = """<script>
      const map = document.querySelector("svg.map");
      map.dispatchEvent(new WheelEvent("wheel", {deltaY: -400, clientX: 300, clientY: 300}));
      const box = document.querySelector("[data-toggle=labels]");
      box.checked = false;
      box.dispatchEvent(new Event("change"));
      const robot = document.querySelector("[data-toggle-robot='1']");
      robot.checked = false;
      robot.dispatchEvent(new Event("change"));
      const slider = document.getElementById("time");
      slider.value = 31;
      slider.dispatchEvent(new Event("input"));
    </script></body>"""
    dom, complaints = in_browser(page(picture).replace("</body>", user))
    assert complaints == []
    view = [float(part) for part in re.search(r'class="map"[^>]*viewBox="([^"]+)"', dom).group(1).split()]
    assert 0 < view[2] < 1000
    assert re.search(r'class="layer labels off"', dom)
    assert dom.count('class="robot off"') == 3
    assert ">0:31</output>" in dom
