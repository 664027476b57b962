import pytest

from mmrs_core.languages import mission
from mmrs_core.languages.element import container_of, containing_feature

ZOO = "urn:test:zoo"


@pytest.fixture
def make(zoo):
    def make(kind, **features):
        return zoo.create(ZOO, kind, **features)

    return make


def test_appending_takes_an_element_from_its_old_container():
    task = mission.Fork(name="f")
    one, other = mission.Mission(tasks=[task]), mission.Mission()
    other.tasks.append(task)
    assert one.tasks == []
    assert other.tasks == [task]
    assert container_of(task) is other


def test_moving_from_a_single_feature_empties_it(make):
    lion = make("Lion", name="l")
    one, other = make("Zoo", guest=lion), make("Zoo")
    other.guest = lion
    assert one.guest is None
    assert container_of(lion) is other


def test_moving_between_features_of_one_container(make):
    lion = make("Lion", name="l")
    zoo = make("Zoo", guest=lion)
    zoo.animals.append(lion)
    assert zoo.guest is None
    assert containing_feature(lion).name == "animals"
    assert lion.zoo is zoo
    zoo.guest = lion
    assert zoo.animals == []
    assert lion.zoo is None


@pytest.mark.parametrize(
    "take_out",
    [
        lambda tasks, task: tasks.remove(task),
        lambda tasks, task: tasks.pop(0),
        lambda tasks, task: tasks.clear(),
        lambda tasks, task: tasks.__delitem__(0),
        lambda tasks, task: tasks.__delitem__(slice(None)),
        lambda tasks, task: tasks.__setitem__(0, mission.Join()),
        lambda tasks, task: tasks.__setitem__(slice(0, 1), []),
    ],
)
def test_whoever_is_taken_out_has_no_container(take_out):
    task = mission.Fork()
    made = mission.Mission(tasks=[task])
    take_out(made.tasks, task)
    assert container_of(task) is None
    assert task not in made.tasks


@pytest.mark.parametrize(
    "put_in",
    [
        lambda made, task: made.tasks.append(task),
        lambda made, task: made.tasks.extend([task]),
        lambda made, task: made.tasks.insert(0, task),
        lambda made, task: made.tasks.__iadd__([task]),
        lambda made, task: made.tasks.__setitem__(slice(0, 0), [task]),
        lambda made, task: setattr(made, "tasks", [*made.tasks, task]),
    ],
)
def test_whoever_is_put_in_has_the_container(put_in):
    first, task = mission.Join(), mission.Fork()
    made = mission.Mission(tasks=[first])
    put_in(made, task)
    assert container_of(task) is container_of(first) is made
    assert len(made.tasks) == 2


def test_the_same_element_cannot_be_in_a_containment_twice():
    task = mission.Fork()
    made = mission.Mission(tasks=[task, mission.Join(), task])
    assert [type(each).__name__ for each in made.tasks] == ["Fork", "Join"]
    made.tasks.append(task)
    assert [type(each).__name__ for each in made.tasks] == ["Join", "Fork"]
    with pytest.raises(ValueError, match="cannot be in it twice"):
        made.tasks *= 2


def test_assigned_lists_are_copied():
    mine = [mission.Fork()]
    made = mission.Mission(tasks=mine)
    mine.clear()
    assert len(made.tasks) == 1


def test_nothing_contains_itself(make):
    cub = make("Lion", name="cub")
    mother = make("Lion", name="mother", cubs=[cub])
    with pytest.raises(ValueError, match=r"^mother: cannot be inside itself"):
        cub.cubs.append(mother)
    with pytest.raises(ValueError, match=r"^cub: cannot be inside itself"):
        cub.cubs = [cub]


def test_only_elements_can_be_contained():
    with pytest.raises(ValueError, match=r"^tasks: takes elements, not 'fork'"):
        mission.Mission().tasks.append("fork")
    with pytest.raises(ValueError, match=r"^team: takes elements"):
        mission.Mission(team="us")


def test_a_text_is_no_list_of_texts(make):
    with pytest.raises(ValueError, match=r"^tags: takes a list, not the text"):
        make("Lion", tags="abc")


def test_one_to_one_references_answer_each_other(make):
    one, other, third = make("Lion", name="1"), make("Lion", name="2"), make("Lion", name="3")
    one.mate = other
    assert other.mateOf is one
    third.mate = other
    assert one.mate is None
    assert other.mateOf is third
    third.mate = one
    assert other.mateOf is None
    one.mateOf = None
    assert third.mate is None


def test_many_to_many_references_answer_each_other(make):
    lion, keeper = make("Lion", name="l"), make("Keeper", badge="k")
    lion.keptBy.append(keeper)
    assert keeper.keeps == [lion]
    keeper.keeps.remove(lion)
    assert lion.keptBy == []
    keeper.keeps = [lion]
    assert lion.keptBy == [keeper]


def test_naming_the_container_moves_the_element(make):
    lion, one, other = make("Lion", name="l"), make("Zoo"), make("Zoo")
    lion.zoo = one
    assert one.animals == [lion]
    assert container_of(lion) is one
    lion.zoo = other
    assert one.animals == []
    assert other.animals == [lion]
    lion.zoo = None
    assert other.animals == []
    assert container_of(lion) is None
