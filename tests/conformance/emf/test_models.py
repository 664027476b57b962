from __future__ import annotations

import random
from pathlib import Path

import pytest

from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.element import metaclass_of
from mmrs_core.languages.metamodels.export import export_metamodels, exported_names
from mmrs_core.languages.reading import read_model
from mmrs_core.languages.writing import to_xmi, write_model

pytestmark = pytest.mark.peer

ZOO = "urn:test:zoo"
HEAD = (
    '<zoo:Zoo xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
    'xmi:version="2.0" xmlns:zoo="urn:test:zoo" xmlns:wing="urn:test:zoo:wing" '
)
RICH = """name="&lt;&amp;&quot;' &#xA;&#x9;>" star="//@animals.0" favourites="//@animals.2 //@animals.0">
<animals xsi:type="zoo:Lion" name="L" mood="is-hungry" hungry="ANGRY" age="0" teeth="30"
  keptBy="B2 B1" weight="1e-5"
  born="2024-05-01T10:11:12.123+0000" chip="0AFF" cage="-12" price="1.50" speed="2.5" steps="7"
  grade="x" shade="a">
  <moods>is-calm</moods><tags>a &lt;b> ]]&gt;</tags><tags></tags><weights>1e7</weights>
  <cubs xsi:type="zoo:Otter" name="cub" mate="//@animals.1"/>
</animals>
<animals xsi:type="zoo:Otter" name="O" depth="0.0"/>
<animals xsi:type="wing:Parrot" name="P" xmi:id="_p"><nest eggs="2"/></animals>
<keepers badge="B1" keeps="//@animals.0"/><keepers badge="B2" deputy="B1" keeps="//@animals.1 //@animals.0"/>
<keepers/>
<notes key="k" value="v"/><notes/>
</zoo:Zoo>"""


@pytest.fixture
def judge(referee, registry, metamodels, zoo_file, tmp_path):
    """Return a function that has EMF read and write files, and returns the faults and the texts it wrote."""

    def judge(*files):
        arguments = []
        for file in files:
            arguments += ["--", "save", file, tmp_path / f"{file.name}.emf"]
        verdict = referee(*metamodels, zoo_file, *arguments)
        return verdict.faults, [(tmp_path / f"{file.name}.emf").read_bytes() for file in files]

    return judge


def test_emf_writes_what_we_write(judge, registry, tmp_path):
    (tmp_path / "rich.xmi").write_text(HEAD + RICH)
    model = read_model(tmp_path / "rich.xmi", registry)
    assert model.diagnostics == ()
    assert check_conformance(model, registry) == ()
    write_model(model.roots, tmp_path / "ours.xmi", registry)
    faults, (theirs,) = judge(tmp_path / "ours.xmi")
    assert faults == []
    assert theirs == (tmp_path / "ours.xmi").read_bytes()


def test_emf_reads_our_nil_though_it_would_not_write_it(judge, registry, tmp_path):
    (tmp_path / "nil.xmi").write_text(
        f'{HEAD}><animals xsi:type="zoo:Lion" name="l"><motto xsi:nil="true"/></animals></zoo:Zoo>'
    )
    write_model(read_model(tmp_path / "nil.xmi", registry).roots, tmp_path / "ours.xmi", registry)
    assert b'<motto xsi:nil="true"/>' in (tmp_path / "ours.xmi").read_bytes()
    faults, (theirs,) = judge(tmp_path / "ours.xmi")
    assert faults == []
    assert b"motto" not in theirs


EXAMPLES = sorted((Path(__file__).parents[3] / "examples").rglob("*.xmi"))


def test_emf_accepts_every_example_and_writes_it_as_we_do(judge, registry, tmp_path):
    assert len(EXAMPLES) > 10
    files = []
    for index, example in enumerate(EXAMPLES):
        model = read_model(example, registry, root=example.parents[1])
        assert model.diagnostics == ()
        files.append(tmp_path / f"{index}.xmi")
        write_model(model.roots, files[-1], registry)
    faults, theirs = judge(*files)
    assert faults == []
    for example, file, text in zip(EXAMPLES, files, theirs, strict=True):
        assert text == file.read_bytes(), example


def test_emf_writes_references_to_other_files_as_we_do(judge, registry, tmp_path):
    lion = '<animals xsi:type="zoo:Lion" name="l"/>'
    (tmp_path / "far.xmi").write_text(f'{HEAD} name="far">{lion}</zoo:Zoo>')
    (tmp_path / "near.xmi").write_text(
        f'{HEAD} name="near">{lion}<star xsi:type="zoo:Lion" href="far.xmi#//@animals.0"/>'
        '<favourites xsi:type="zoo:Lion" href="far.xmi#//@animals.0"/>'
        '<favourites xsi:type="zoo:Lion" href="#//@animals.0"/></zoo:Zoo>'
    )
    model = read_model(tmp_path / "near.xmi", registry)
    write_model(model.roots, tmp_path / "ours.xmi", registry)
    faults, (theirs,) = judge(tmp_path / "ours.xmi")
    assert faults == []
    assert theirs == (tmp_path / "ours.xmi").read_bytes()


def test_emf_writes_several_roots_as_we_do(judge, registry, tmp_path):
    lions = [registry.create(ZOO, "Lion", name=name) for name in "ab"]
    lions[0].mate = lions[1]
    write_model([*lions, registry.create(ZOO, "Zoo", star=lions[1])], tmp_path / "ours.xmi", registry)
    faults, (theirs,) = judge(tmp_path / "ours.xmi")
    assert faults == []
    assert theirs == (tmp_path / "ours.xmi").read_bytes()


def test_eclipse_opens_a_model_by_schema_location_alone(referee, registry, tmp_path):
    export_metamodels(registry, tmp_path / "metamodels")
    locations = {uri: f"metamodels/{name}" for uri, name in exported_names(registry).items()}
    move = registry.create("urn:mmrs:multicopter:1.0", "Land", name="l")
    robot = registry.create("urn:mmrs:behaviour:1.0", "Robot", id="r", typeName="t", moves=[move])
    made = registry.create("urn:mmrs:behaviour:1.0", "Behaviour", robots=[robot])
    write_model([made], tmp_path / "b.xmi", registry, schema_location=locations)
    assert referee("--unregistered", "--", "check", tmp_path / "b.xmi").faults == []
    write_model([made], tmp_path / "without.xmi", registry)
    assert not referee("--unregistered", "--", "check", tmp_path / "without.xmi").accepted


@pytest.mark.parametrize("count", [40, pytest.param(400, marks=pytest.mark.thorough)])
def test_emf_writes_random_models_as_we_do(judge, registry, tmp_path, count):
    files = []
    for seed in range(count):
        file = tmp_path / f"{seed}.xmi"
        write_model([RandomModel(registry, seed).root()], file, registry)
        files.append(file)
    faults, theirs = judge(*files)
    assert [
        fault for fault in faults if "required feature" not in fault and "must have at least" not in fault
    ] == []
    for file, text in zip(files, theirs, strict=True):
        assert text == file.read_bytes(), file.name


@pytest.mark.parametrize("count", [40, pytest.param(400, marks=pytest.mark.thorough)])
def test_emf_misses_the_same_required_values(referee, registry, metamodels, zoo_file, tmp_path, count):
    files = []
    for seed in range(count):
        files.append(tmp_path / f"{seed}.xmi")
        write_model([RandomModel(registry, seed).root()], files[-1], registry)
    arguments = [part for file in files for part in ("--", "check", file)]
    verdict = referee(*metamodels, zoo_file, *arguments)
    for file in files:
        model = read_model(file, registry)
        ours = {fault.code for fault in check_conformance(model, registry)}
        theirs = [fault for fault in verdict.faults if fault.startswith(f"{file.name}:")]
        assert bool(ours) == bool(theirs), (file.name, ours, theirs)


WRONG = {
    "unknown feature": 'bogus="1">',
    "unknown class": '><animals xsi:type="zoo:Tiger" name="t"/>',
    "abstract class": '><animals name="t"/>',
    "wrong literal": '><animals xsi:type="zoo:Lion" name="l" mood="HUNGRY"/>',
    "wrong truth value": '><animals xsi:type="zoo:Lion" name="l" tame="yes"/>',
    "wrong number": '><animals xsi:type="zoo:Lion" name="l" weight="inf"/>',
    "underscores": '><animals xsi:type="zoo:Lion" name="l" teeth="1_000"/>',
    "spaces": '><animals xsi:type="zoo:Lion" name="l" teeth=" 5 "/>',
    "overflow": '><animals xsi:type="zoo:Lion" name="l" teeth="4294967296"/>',
    "wrong bytes": '><animals xsi:type="zoo:Lion" name="l" cage="128"/>',
    "dangling": 'star="//@animals.0">',
    "missing name": '><animals xsi:type="zoo:Lion"/>',
    "wrong class": '><animals xsi:type="zoo:Keeper"/>',
    "wrong target": 'star="//@keepers.0"><keepers/>',
    "too many": '><animals xsi:type="zoo:Lion" name="l" weights="1 2 3 4"/>',
    "duplicate id": '><keepers badge="a"/><keepers badge="a"/>',
    "unknown namespace": '><animals xmlns:o="urn:other" xsi:type="o:Cat"/>',
}
RIGHT = {
    "comment": "><!-- c --><?pi?>",
    "nested prefix": '><animals xmlns:w="urn:test:zoo:wing" xsi:type="w:Parrot" name="p"/>',
    "java numbers": '><animals xsi:type="zoo:Lion" name="l" weight="1.5d" speed="NaN" tame="TRUE"/>',
    "attribute list": '><animals xsi:type="zoo:Lion" name="l" tags="a b" moods="is-calm ANGRY"/>',
    "ids": '><keepers badge="a" deputy="b"/><keepers badge="b"/>',
    "nil": '><animals xsi:type="zoo:Lion" name="l"><motto xsi:nil="true"/></animals>',
    "extension": '><xmi:Extension extender="x"><a/></xmi:Extension>',
    "one-sided pair": '><animals xsi:type="zoo:Lion" name="a"/>'
    '<animals xsi:type="zoo:Lion" name="b" mateOf="//@animals.0"/>',
}


def test_emf_and_we_refuse_and_accept_the_same(referee, registry, metamodels, zoo_file, tmp_path):
    cases = {**WRONG, **RIGHT}
    files = {}
    for index, (title, text) in enumerate(cases.items()):
        files[title] = tmp_path / f"{index}.xmi"
        files[title].write_text(f"{HEAD}{text}</zoo:Zoo>")
    arguments = [part for file in files.values() for part in ("--", "check", file)]
    verdict = referee(*metamodels, zoo_file, *arguments)
    refused = {fault.partition(":")[0] for fault in verdict.faults}
    theirs = {title: file.name in refused for title, file in files.items()}
    ours = {}
    for title, file in files.items():
        model = read_model(file, registry)
        found = (*model.diagnostics, *check_conformance(model, registry))
        ours[title] = any(fault.severity.value == "error" and fault.code != "ECO009" for fault in found)
    assert ours == {title: title in WRONG for title in cases}
    assert theirs == ours


class RandomModel:
    """A random model of all metamodels; it may lack required values, but each value is right for its type."""

    TEXTS = ("", "a", "a b", "<&>\"'", "ä\n\t€", "]]>", " x ", "😀")
    VALUES = {
        str: TEXTS,
        float: (0.0, -0.0, 1.5, 1e7, 1e-3, 1e-4, 123456.789, -9.87e22, 42.36928, 13.349674, 1 / 3),
        int: (0, 1, -1, 100),
        bool: (True, False),
    }

    def __init__(self, registry, seed):
        self.random = random.Random(seed)
        self.registry = registry
        self.metaclasses = [
            metaclass
            for package in registry.packages
            for metaclass in package.metaclasses
            if metaclass.implementation and metaclass.name != "Odd"
        ]
        self.roots = [kind for kind in self.metaclasses if any(each.containment for each in kind.features)]
        self.elements = []

    def root(self):
        found = self.tree(self.random.choice(self.roots), 0)
        for element in self.elements:
            self.refer(element)
        return found

    def tree(self, metaclass, depth):
        element = metaclass.interface()
        self.elements.append(element)
        for feature in metaclass.features:
            if feature.is_reference and feature.containment and depth < 3:
                kinds = [kind for kind in self.metaclasses if feature.type.key in kind.ancestry]
                count = self.random.choice((0, 1, 2, 3)) if feature.many else self.random.choice((0, 1))
                made = [self.tree(self.random.choice(kinds), depth + 1) for _ in range(count if kinds else 0)]
                setattr(element, feature.attribute, made if feature.many else made[0] if made else None)
            elif not feature.is_reference and self.random.random() < 0.5:
                self.value(element, feature)
        return element

    def value(self, element, feature):
        if getattr(feature.type, "names", None):
            choices = feature.type.names
        elif feature.is_id:
            choices = (f"id{len(self.elements)}",)
        elif (
            feature.type.name in ("EFloat", "Colour")
            or feature.type.python not in self.VALUES
            or feature.name == "grade"
        ):
            return
        else:
            choices = self.VALUES[feature.type.python]
        if feature.many:
            count = self.random.randrange(3)
            values = self.random.sample(choices, min(count, len(choices)))
            setattr(element, feature.attribute, values)
        else:
            setattr(element, feature.attribute, self.random.choice(choices))

    def refer(self, element):
        for feature in metaclass_of(element).features:
            if not feature.is_reference or feature.containment or feature.is_container:
                continue
            targets = [target for target in self.elements if feature.type.accepts(target)]
            if feature.name in ("mate", "mateOf"):  # EMF drops a pair that is each other's mate both ways
                targets = [target for target in targets if target.mate is None and target.mateOf is None]
                targets = [target for target in targets if target is not element and element.mateOf is None]
            if not targets or self.random.random() < 0.4:
                continue
            if feature.many:
                setattr(element, feature.attribute, self.random.sample(targets, min(2, len(targets))))
            else:
                setattr(element, feature.attribute, self.random.choice(targets))


def test_the_random_models_are_worth_their_name(registry):
    texts = {to_xmi([RandomModel(registry, seed).root()], registry) for seed in range(40)}
    assert len(texts) > 30
    assert max(map(len, texts)) > 2500
