"""The pages about capabilities are what trying gives; `--update-golden` writes them anew."""

from __future__ import annotations

from pathlib import Path

from capabilities_page import page_of
from mmrs_auv import plugin as auv
from mmrs_auv.targets.ada.target import ADA
from mmrs_auv.targets.can_c.target import CAN_C
from mmrs_auv.targets.can_python.target import CAN_PYTHON
from mmrs_imc.target import IMC
from mmrs_moos.target import MOOS
from mmrs_multicopter import plugin as multicopter

from mmrs_core.generation.capabilities.judging import capabilities_of
from mmrs_core.pipeline import capabilities
from mmrs_core.plugins import load_plugins
from mmrs_mavlink import plugin as mavlink

PAGE = Path(__file__).parents[2] / "docs" / "capabilities.md"
UNDER_WATER = PAGE.with_name("capabilities-underwater.md")


def test_the_page_is_current(update_golden):
    contributions = load_plugins(
        only_core=True, extra={"auv": auv, "mavlink": mavlink, "multicopter": multicopter}
    ).contributions
    descriptions = {name: target.description for name, target in contributions.targets.items()}
    tables = {name: capabilities(name, contributions)[name] for name in ("mavlink-python", "qgc-plan", "wpl")}
    made = page_of(tables, descriptions)
    if update_golden:
        PAGE.write_text(made, encoding="utf-8", newline="\n")
    assert PAGE.read_text(encoding="utf-8") == made


def test_the_page_about_plans_for_underwater_vehicles_is_current(update_golden):
    contributions = load_plugins().contributions
    targets = (ADA, CAN_C, CAN_PYTHON, IMC, MOOS)
    tables = {target.name: capabilities_of(target, contributions) for target in targets}
    page = page_of(tables, {target.name: target.description for target in targets})
    made = page.replace("# Capabilities of the targets\n", "# Capabilities: underwater vehicles\n", 1)
    if update_golden:
        UNDER_WATER.write_text(made, encoding="utf-8", newline="\n")
    assert UNDER_WATER.read_text(encoding="utf-8") == made
