"""A plug-in's robot that flies, but names no vehicle, is refused by the name of its kind."""

import shutil
from dataclasses import replace
from pathlib import Path

import pytest

from mmrs_core.cli import run
from mmrs_core.cli.settings import Settings
from mmrs_core.hookspecs import hookimpl
from mmrs_core.languages.registry import MetamodelSource
from mmrs_core.plugins import load_plugins

HANDWRITTEN = Path(__file__).parents[3] / "examples" / "handwritten"
KITES = "urn:kites:1.0"
ECORE = f"""<?xml version="1.0" encoding="UTF-8"?>
<ecore:EPackage xmi:version="2.0" name="kites" nsURI="{KITES}" nsPrefix="kites"
    xmlns:xmi="http://www.omg.org/XMI"
    xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"
    xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore">
  <eClassifiers xsi:type="ecore:EClass" name="Kite" eSuperTypes="urn:mmrs:multicopter:1.0#//Drone"/>
</ecore:EPackage>
"""


@pytest.fixture
def kites(tmp_path, monkeypatch, contributions):
    """Return a folder with a behaviour of kites, whose plug-in is installed."""
    ecore = tmp_path / "kites.ecore"
    ecore.write_text(ECORE)
    drone = contributions.robot_kinds["urn:mmrs:multicopter:1.0", "Drone"]

    class Plugin:
        @staticmethod
        @hookimpl
        def mmrs_metamodels():
            return (MetamodelSource(KITES, ecore, "mmrs-kites"),)

        @staticmethod
        @hookimpl
        def mmrs_robot_kinds():
            return (replace(drone, name="kite", metaclass=(KITES, "Kite"), vehicle=""),)

    monkeypatch.setattr(Settings, "plugins", lambda settings: load_plugins(extra={"kites": Plugin()}))
    folder = tmp_path / "kites"
    shutil.copytree(HANDWRITTEN, folder)
    for file in (folder / "robots").iterdir():
        text = file.read_text().replace("multicopter:Drone ", "kites:Kite ")
        text = text.replace("</multicopter:Drone>", "</kites:Kite>")
        file.write_text(text.replace(" xmlns:multicopter", f' xmlns:kites="{KITES}" xmlns:multicopter', 1))
    return folder


@pytest.mark.parametrize(
    "command",
    [
        ["sitl", "--for", "0.1"],
        ["run", "--connect", "left=udpin:127.0.0.1:1", "--connect", "right=udpin:127.0.0.1:2"],
        ["generate", "--target", "mavlink-python", "-o", "code"],
    ],
)
def test_a_kind_that_names_no_vehicle_is_refused_by_its_name(kites, capsys, monkeypatch, tmp_path, command):
    monkeypatch.chdir(tmp_path)
    assert run([command[0], str(kites), *command[1:]]) == 1
    said = capsys.readouterr().err
    assert (
        "robot 'left': is of kind 'kite', which names no vehicle; known are copter, ground, rover, sub"
        in said
    )
    assert [*tmp_path.glob("code"), *tmp_path.glob("logs/*.jsonl")] == []
