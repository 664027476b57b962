"""Paths lead to elements and values, or say where they break."""

import pytest

from mmrs_core.languages.query.search import NothingFoundError, find

ZOO = """
<animals xsi:type="zoo:Lion" name="Leo" teeth="28" weight="190.5" tame="true" mood="is-hungry">
  <tags>big</tags><tags>loud</tags>
</animals>
<animals xsi:type="zoo:Lion" name="Lea O'Neil" mate="//@animals.0" born="2020-01-01T00:00:00.000+0000"
    price="12.50" chip="0AFF" grade="97"/>
<animals xsi:type="zoo:Otter" name="Ot" depth="0.0"><cubs xsi:type="zoo:Otter" name="Otti"/></animals>
<animals xsi:type="far:Alien" xmlns:far="urn:far"/>
<keepers badge="k1" keeps="//@animals.0 //@animals.2"/>
<star href="#//@animals.2"/>
"""


@pytest.fixture
def roots(read_zoo):
    return read_zoo(ZOO).roots


@pytest.mark.parametrize(
    ("path", "found"),
    [
        ("", ["/"]),
        ("/", ["/"]),
        ("animals[1]", ["/animals[1]"]),
        ("animals[-2]", ["/animals[2]"]),
        ("animals", ["/animals[0]", "/animals[1]", "/animals[2]", "/animals[3]"]),
        ("animals[*].cubs", ["/animals[2]/cubs[0]"]),
        ("/animals[2]/cubs[0]", ["/animals[2]/cubs[0]"]),
        ("animals[name=Leo]", ["/animals[0]"]),
        ('animals[name="Lea O\'Neil"]', ["/animals[1]"]),
        ("animals[ teeth >= 28 ][0]", ["/animals[0]"]),
        ("animals[teeth<30]", ["/animals[0]"]),
        ("animals[teeth!=28]", ["/animals[1]", "/animals[2]", "/animals[3]"]),
        ("animals[tame=true]", ["/animals[0]"]),
        ("animals[mood=HUNGRY]", ["/animals[0]"]),
        ("animals[mood=is-hungry]", ["/animals[0]"]),
        ("animals[born<2021-01-01]", ["/animals[1]"]),
        ("animals[born=2020-01-01]", ["/animals[1]"]),
        ("animals[born=2020-01-01T02:00+02:00]", ["/animals[1]"]),
        ("animals[born>2019-12-31T23:59:59.5Z]", ["/animals[1]"]),
        ("animals[price>12]", ["/animals[1]"]),
        ("animals[price<=12.5]", ["/animals[1]"]),
        ("animals[price=12.5]", ["/animals[1]"]),
        ("animals[price<1e400]", ["/animals[1]"]),
        ("animals[weight=190.5]", ["/animals[0]"]),
        ("animals[weight>=1.905E2]", ["/animals[0]"]),
        ("animals[chip=0aff]", ["/animals[1]"]),
        ("animals[grade=a]", ["/animals[1]"]),
        ("animals[mate]", ["/animals[1]"]),
        ("animals[depth]", ["/animals[2]"]),
        ("animals[tags=loud].name", ["/animals[0]/name"]),
        ("animals[mate.name=Leo]", ["/animals[1]"]),
        ("animals[mate=Leo]", ["/animals[1]"]),
        ("animals[mate='/animals[0]']", ["/animals[1]"]),
        ("star", ["/animals[2]"]),
        ("star.cubs[0].name", ["/animals[2]/cubs[0]/name"]),
        ("keepers.keeps", ["/animals[0]", "/animals[2]"]),
        ("animals[0].tags[1]", ["/animals[0]/tags[1]"]),
        ("//Otter", ["/animals[2]", "/animals[2]/cubs[0]"]),
        ("//Otter[1]", ["/animals[2]/cubs[0]"]),
        ("//zoo:Lion", ["/animals[0]", "/animals[1]"]),
        ("//Animal[name=Otti]", ["/animals[2]/cubs[0]"]),
        ("//Swimmer", ["/animals[2]", "/animals[2]/cubs[0]"]),
        ("star//Otter", ["/animals[2]/cubs[0]"]),
        ("//@animals.2", ["/animals[2]"]),
        ("//@animals.2/@cubs.0", ["/animals[2]/cubs[0]"]),
        ("#//@keepers.0", ["/keepers[0]"]),
        ("/0", ["/"]),
        ("/0/animals[1]", ["/animals[1]"]),
        ("/0//Otter[0]", ["/animals[2]"]),
        ("'animals'[0]", ["/animals[0]"]),
    ],
)
def test_a_path_leads_to(roots, path, found):
    assert [match.path for match in find(roots, path)] == found


def test_a_star_leads_to_all_that_is_set(roots):
    found = [match.path for match in find(roots, "keepers[0].*")]
    assert found == ["/keepers[0]/badge", "/animals[0]", "/animals[2]"]


def test_values_come_with_the_element_they_belong_to(roots):
    (match,) = find(roots, "animals[0].weight")
    assert (match.value, match.owner) == (190.5, roots[0].animals[0])


def test_an_element_that_several_lead_to_is_found_once(roots):
    assert len(find(roots, "animals[*].zoo")) == 1


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("animls", "animls: no feature animls of Zoo; did you mean animals?"),
        ("animals[0].nam", "animals[0].nam: no feature nam of Lion; did you mean name?"),
        ("animals[nam=x]", "animals[nam=x]: no feature nam of Lion; did you mean name?"),
        ("animals.name.x", "animals.name.x: nothing is below a value"),
        ("animals.name[x=1]", "animals.name[x=1]: values have no features to ask for"),
        ("animals[weight>much]", "animals[weight>much]: 'much': not a number to compare with"),
        ("animals[name>3]", "animals[name>3]: name: no number and no date, cannot be compared by >"),
        (
            "animals[born>today]",
            "animals[born>today]: 'today': not a date such as 2024-05-01T10:11:12.123+0200",
        ),
        ("animals[0", "animals[0: expected [2], [*], [name] or [name=value] here, after 'animals', not '[0'"),
        ("animals[]", "animals[]: expected [2], [*], [name] or [name=value] here, after 'animals', not '[]'"),
        ("animals..name", "animals..name: expected a name here, after 'animals.', not '.name'"),
        ("animals[0]name", "animals[0]name: expected . or / or [ here, after 'animals[0]', not 'name'"),
        ("animals/", "animals/: expected a name here, at the end"),
        ("//", "//: expected a name here, at the end"),
    ],
)
def test_a_broken_path_says_where_and_what_would_be_there(roots, path, message):
    with pytest.raises(ValueError) as caught:
        find(roots, path)
    assert str(caught.value) == message
    assert not isinstance(caught.value, NothingFoundError)


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("animals[9]", "animals[9]: nothing there; there is animals[0] to animals[3]"),
        ("animals[0].cubs[0]", "animals[0].cubs[0]: nothing there; cubs is empty"),
        ("animals[0].cubs.name", "animals[0].cubs: nothing there"),
        ("animals[name=Le]", "animals[name=Le]: none of 4 elements is so; did you mean Leo?"),
        ("//Lion[teeth>40]", "//Lion[teeth>40]: none of 2 elements is so"),
        (
            "animals[price>12.500000000000000001]",
            "animals[price>12.500000000000000001]: none of 4 elements is so",
        ),
        ("animals[weight<NaN]", "animals[weight<NaN]: none of 4 elements is so"),
        ("//Lin", "//Lin: no element of a class Lin in this model; did you mean Lion?"),
        ("/3", "/3: the model has 1 root"),
        ("//@animals.9", "//@animals.9: nothing there; there is animals[0] to animals[3]"),
    ],
)
def test_a_path_to_nothing_says_how_far_it_led(roots, path, message):
    with pytest.raises(NothingFoundError) as caught:
        find(roots, path)
    assert str(caught.value) == message


def test_paths_to_many_elements_are_found_in_time(zoo):
    root = zoo.create("urn:test:zoo", "Zoo")
    root.animals = [zoo.create("urn:test:zoo", "Lion", name=str(index)) for index in range(20_000)]
    assert len(find([root], "//Lion[name!=7]")) == 19_999
