"""What takes its time for a small model must not take the square of it for a large one."""

import gc
import tracemalloc
from time import process_time
from weakref import WeakSet

import pytest

from mmrs_core.errors import UnreadableError
from mmrs_core.languages.conformance import check_conformance
from mmrs_core.languages.reading import read_text
from mmrs_core.languages.references.by_name import ReferenceNames
from mmrs_core.languages.registry import MetamodelSource, core_registry
from mmrs_core.languages.writing import to_xmi

HEAD = (
    '<ecore:EPackage xmi:version="2.0" xmlns:xmi="http://www.omg.org/XMI"'
    ' xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance"'
    ' xmlns:ecore="http://www.eclipse.org/emf/2002/Ecore" name="g" nsURI="urn:g" nsPrefix="g">'
)
GRAPH = (
    '<eClassifiers xsi:type="ecore:EClass" name="G">'
    '<eStructuralFeatures xsi:type="ecore:EReference" name="k" upperBound="-1" eType="#//N"'
    ' containment="true"/>'
    '<eStructuralFeatures xsi:type="ecore:EReference" name="s" upperBound="-1" eType="#//N"'
    ' eOpposite="#//N/r"/>'
    '</eClassifiers><eClassifiers xsi:type="ecore:EClass" name="N">'
    '<eStructuralFeatures xsi:type="ecore:EReference" name="r" upperBound="-1" eType="#//G"'
    ' eOpposite="#//G/s"/>'
    '<eStructuralFeatures xsi:type="ecore:EAttribute" name="n" lowerBound="1"'
    ' eType="ecore:EDataType http://www.eclipse.org/emf/2002/Ecore#//EString"/></eClassifiers>'
)
ROOT = (
    'xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xmlns:g="urn:g"'
)

SOUND = '<k n="a" r="/"/>'
Q = 'xmlns:q="urn:q"'


def graph_of(content, more=""):
    return f"<g:G {ROOT} {more}>{content}</g:G>".encode()


@pytest.fixture
def graph(tmp_path):
    file = tmp_path / "g.ecore"
    file.write_text(f"{HEAD}{GRAPH}</ecore:EPackage>")
    return core_registry().extended([MetamodelSource("urn:g", file)])


def seconds(work):
    begun = process_time()
    work()
    return process_time() - begun


def grows_evenly(work, size=1_000, times=16):
    """Return whether much more takes clearly less than the square would; a loaded machine may take thrice."""
    work(size)
    small = min(seconds(lambda: work(size)) for _ in range(3))
    most = max(small, 0.002) * times * 5
    return any(seconds(lambda: work(size * times)) < most for _ in range(2))


def test_many_references_to_one_place_with_another_end(graph):
    def read(count):
        assert len(read_text(graph_of(SOUND * count), "a.xmi", graph).roots[0].s) == count

    assert grows_evenly(read)


@pytest.mark.parametrize(
    "faulty", ['<k n="a" bogus=""/>', '<k n="a"><bogus/></k>', '<k n="a" r="//@k.99999999"/>']
)
def test_faults_in_one_long_list(graph, faulty):
    def read(count):
        text = graph_of(SOUND * count + faulty * (count // 8))
        assert len(read_text(text, "a.xmi", graph).diagnostics) == count // 8

    assert grows_evenly(read)


def test_faults_that_only_the_metamodel_tells(graph):
    def read(count):
        model = read_text(graph_of("<k/>" * (count // 2)), "a.xmi", graph)
        assert len(check_conformance(model, graph)) == count // 2

    assert grows_evenly(read)


def test_more_faults_than_anybody_reads_are_refused(graph):
    model = read_text(graph_of("<k/>" * 10_001), "a.xmi", graph)
    with pytest.raises(UnreadableError, match=r"more than 10000 faults; the first is: "):
        check_conformance(model, graph)


def test_long_words_in_what_is_not_installed(graph):
    def save(count):
        word = "0a" * count
        model = read_text(graph_of(f'<k xsi:type="q:T" b="{word}">{word}</k>', Q), "a.xmi", graph)
        assert word.encode() in to_xmi(model.roots, graph)

    assert grows_evenly(save, 20_000)


def test_prefixes_are_kept_only_where_they_are_used(graph):
    many = " ".join(f'xmlns:p{index}="urn:u"' for index in range(3_000))
    text = graph_of('<k xsi:type="q:T"/>' * 3_000, f"{Q} {many}")
    tracemalloc.start()
    try:
        read_text(text, "a.xmi", graph)
        assert tracemalloc.get_traced_memory()[1] < 60 * len(text)
    finally:
        tracemalloc.stop()


def test_metamodels_of_files_are_given_back(tmp_path):
    file = tmp_path / "g.ecore"
    file.write_text(f"{HEAD}{GRAPH}</ecore:EPackage>")
    classes: WeakSet[type] = WeakSet()
    for _ in range(5):
        registry = core_registry().extended([MetamodelSource("urn:g", file)])
        model = read_text(graph_of(SOUND * 40), "a.xmi", registry)
        assert check_conformance(model, registry) == ()
        to_xmi(model.roots, registry)
        classes.add(type(model.roots[0]))
    del registry, model
    gc.collect()
    assert len(classes) == 0


def test_long_names_are_not_repeated_in_every_message(graph):
    text = graph_of(f'<k n="{"a" * 200_000}">{"<bogus/>" * 2_000}</k>')
    tracemalloc.start()
    try:
        assert len(read_text(text, "a.xmi", graph).diagnostics) == 2_000
        assert tracemalloc.get_traced_memory()[1] < 60 * len(text)
    finally:
        tracemalloc.stop()


def test_a_namespace_longer_than_any_is_refused(graph):
    with pytest.raises(UnreadableError, match=r"a\.xmi:1: a namespace of more than 2000 characters"):
        read_text(graph_of('<k xsi:type="q:T"/>', f'xmlns:q="urn:{"a" * 2000}"'), "a.xmi", graph)


@pytest.mark.parametrize("name", ["cub", "cub {}"], ids=["of one name", "of many names"])
def test_references_by_name(zoo, zoo_text, name):
    cubs = f'<cubs xsi:type="zoo:Lion" name="{name}"/><cubs xsi:type="zoo:Lion" name="o" mate="{name}"/>'

    def read(count):
        families = (cubs.format(at, at) for at in range(count))
        herd = "".join(f'<animals xsi:type="zoo:Lion" name="l">{family}</animals>' for family in families)
        model = read_text(zoo_text(herd), "a.xmi", zoo)
        assert model.diagnostics == ()
        names = ReferenceNames(model.roots)
        to_xmi(model.roots, zoo, names=names)
        assert names.named == 2 * count  # of both ends

    assert grows_evenly(read)


def test_misspelt_names(zoo, zoo_text):
    def read(count):
        herd = "".join(
            f'<animals xsi:type="zoo:Lion" name="l{at}" mate="k{at}"/>' for at in range(count // 4)
        )
        assert len(read_text(zoo_text(herd), "a.xmi", zoo).diagnostics) == count // 4

    assert grows_evenly(read)


def test_a_long_misspelt_name(zoo, zoo_text):
    def read(length):
        long = "".join(chr(0x4E00 + at % 300) for at in range(length))
        lion = f'<animals xsi:type="zoo:Lion" name="{long}" mate="{long}c"/>'
        assert len(read_text(zoo_text(lion), "a.xmi", zoo).diagnostics) == 1

    assert grows_evenly(read, 5_000)
