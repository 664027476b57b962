"""Reading code as people write it who know pyecore: each function is a snippet, given the roots of models."""

from collections import Counter
from pathlib import Path

from pyecore.ecore import EcoreUtils, EEnum
from pyecore.utils import DynamicEPackage

MISSION = "urn:mmrs:mission:1.0"


def name_of_the_class(m):
    return [root.eClass.name for root in (m.mission, m.context, m.robot, m.behaviour)]


def class_of_the_class(m):
    return m.mission.eClass.eClass.eClass.name


def language_of_each_task(m):
    return [(task.eClass.ePackage.nsPrefix, task.eClass.name) for task in m.mission.tasks]


def own_features_of_the_class(m):
    return [(feature.name, feature.many) for feature in m.robot.eClass.eStructuralFeatures]


def all_features_of_the_class(m):
    return [feature.name for feature in m.mission.tasks[0].eClass.eAllStructuralFeatures()]


def what_is_attribute_and_what_reference(m):
    kind = m.behaviour.robots[0].eClass
    return {each.name for each in kind.eAllAttributes()}, {each.name for each in kind.eAllReferences()}


def supertypes(m):
    return {above.name for above in m.mission.tasks[0].eClass.eAllSuperTypes()}


def types_of_attributes(m):
    return {attribute.name: attribute.eType.name for attribute in m.robot.eClass.eAllAttributes()}


def bounds_of_references(m):
    return {each.name: (each.lowerBound, each.upperBound) for each in m.behaviour.eClass.eReferences}


def literals_of_enumerations(m):
    kinds = [each.eType for each in m.mission.eClass.eAllAttributes() if isinstance(each.eType, EEnum)]
    return {kind.name: [literal.name for literal in kind.eLiterals] for kind in kinds}


def opposite_of_a_containment(m):
    return [each.eOpposite for each in m.mission.eClass.eReferences if each.containment]


def values_by_attribute(m):
    return m.mission.name, m.mission.tasks[0].robotsWanted, m.mission.team.robots[1].home.latitude


def value_by_name(m):
    return m.mission.eGet("name"), m.context.eGet("crs")


def value_by_feature(m):
    task = m.mission.tasks[1]
    return task.eGet(task.eClass.findEStructuralFeature("frontOverlap"))


def value_by_getattr(m):
    return {
        each.name: getattr(m.robot.operatingTemperature, each.name)
        for each in m.robot.operatingTemperature.eClass.eAllAttributes()
    }


def feature_with_the_name_of_a_keyword(m):
    return [link.eGet("from").name for link in m.behaviour.robots[0].moveTransitions]


def set_attributes(m):
    values = {}
    for attribute in m.mission.eClass.eAllAttributes():
        if m.mission.eIsSet(attribute) and not attribute.many:
            values[attribute.name] = m.mission.eGet(attribute)
    return values


def set_features_of_everything(m):
    return Counter(
        feature.name
        for element in m.behaviour.eAllContents()
        for feature in element.eClass.eAllStructuralFeatures()
        if element.eIsSet(feature)
    )


def is_set_by_name(m):
    return m.mission.eIsSet("reserve"), m.mission.eIsSet("altitudeReference"), m.context.eIsSet("origin")


def default_where_nothing_was_said(m):
    overlap = m.mission.tasks[0].eClass.findEStructuralFeature("sideOverlap")
    return overlap and (overlap.get_default_value(), m.mission.tasks[0].eGet(overlap))


def texts_of_enumerations(m):
    return [str(robot.eGet("travelMode")) for robot in m.behaviour.robots], str(m.mission.altitudeReference)


def values_of_a_list(m):
    return list(m.behaviour.acceptedUnknowns), [str(each) for each in m.robot.rangingSystem]


def length_and_places(m):
    moves = m.behaviour.robots[0].moves
    return len(moves), moves[0].name, moves[-1].name, moves.index(moves[3]), moves[2] in moves


def slice_of_a_list(m):
    return [move.name for move in m.behaviour.robots[1].moves[1:4]]


def empty_lists(m):
    return len(m.mission.policies), list(m.mission.policies), m.mission.eIsSet("policies")


def container(m):
    return m.mission.team.robots[0].eContainer(), m.mission.eContainer()


def containment_feature(m):
    feature = m.mission.team.robots[0].eContainmentFeature()
    return feature.name, feature.eContainingClass.name, m.mission.eContainmentFeature()


def children(m):
    return sorted(child.eURIFragment() for child in m.mission.eContents)


def children_know_their_container(m):
    return all(child.eContainer() is m.context for child in m.context.eContents)


def all_contents_counted(m):
    return Counter(element.eClass.name for element in m.mission.eAllContents())


def all_contents_of_one_reference(m):
    return [shell.eURIFragment() for shell in m.context.obstacles[0].eAllContents()]


def first_of_a_class(m):
    return next(
        each for each in m.behaviour.eAllContents() if each.eClass.name == "Choice"
    ).conditionIdentifier


def elements_of_a_class(m):
    robot = m.packages[MISSION].getEClassifier("Robot")
    return [each.name for each in m.mission.eAllContents() if each.eClass is robot]


def elements_of_a_supertype(m):
    task = m.packages[MISSION].getEClassifier("Task")
    return sorted(each.name for each in m.mission.eAllContents() if task in each.eClass.eAllSuperTypes())


def classes_by_dynamic_package(m):
    language = DynamicEPackage(m.packages[MISSION])
    return [each.name for each in m.mission.tasks if each.eClass is language.Join]


def classifiers_of_the_package(m):
    return [(each.name, each.eClass.name) for each in m.mission.eClass.ePackage.eClassifiers]


def documentation_of_the_class(m):
    note = m.mission.eClass.getEAnnotation("http://www.eclipse.org/emf/2002/GenModel")
    return note.details["documentation"]


def class_is_that_of_the_package(m):
    return m.mission.eClass is m.packages[MISSION].getEClassifier("Mission")


def depth(m):
    def below(element):
        return 1 + max(map(below, element.eContents), default=0)

    return below(m.mission), below(m.robot)


def way_up(m):
    way, element = [], m.context.obstacles[1].shell[2]
    while element.eContainer() is not None:
        way.append(element.eContainmentFeature().name)
        element = element.eContainer()
    return way


def root_of_what_is_inside(m):
    return {
        EcoreUtils.get_root(each) is m.mission for each in m.mission.eAllContents()
    }, m.mission.team.eRoot()


def fragments(m):
    return sorted(each.eURIFragment() for each in (m.behaviour, *m.behaviour.eAllContents()))


def cross_references(m):
    found = []
    for element in m.behaviour.eAllContents():
        for reference in element.eClass.eAllReferences():
            if not reference.containment and not reference.many and element.eGet(reference) is not None:
                place = element.eURIFragment(), reference.name
                found.append((*place, element.eGet(reference).eURIFragment()))
    return sorted(found)


def who_refers_to_it(m):
    slot = m.behaviour.robots[0].slots[0]
    return sorted(
        each.eURIFragment()
        for each in m.behaviour.eAllContents()
        for reference in each.eClass.eAllReferences()
        if not reference.many and not reference.containment and each.eGet(reference) is slot
    )


def reference_into_another_file(m):
    return [task.group.rows for task in m.mission.tasks if task.eClass.name == "ThermalRowTask"]


def file_of_what_is_referred_to(m):
    group = m.mission.tasks[0].group
    return Path(group.eResource.uri.normalize()).name, group.eURIFragment()


def resource_of_everything(m):
    return {each.eResource is m.mission.eResource for each in m.mission.eAllContents()}


def uri_of_the_resource(m):
    uri = m.robot.eResource.uri
    return uri.plain, uri.last_segment, uri.extension


def contents_of_the_resource(m):
    return len(m.mission.eResource.contents), m.mission.eResource.contents[0] is m.mission


def model_as_a_tree_of_texts(m):
    def shown(element):
        reference = element.eContainmentFeature()
        head = f"{reference.name if reference else ''}:{element.eClass.name}"
        return [head, *sorted(map(shown, element.eContents))]

    return shown(m.robot)


def model_as_a_dictionary(m):
    def told(element):
        said = {"eClass": element.eClass.name}
        for feature in element.eClass.eAllStructuralFeatures():
            if element.eIsSet(feature):
                value = element.eGet(feature)
                values = list(value) if feature.many else [value]
                if feature.is_attribute:
                    said[feature.name] = [str(each) for each in values]
                elif feature.containment:
                    said[feature.name] = [told(each) for each in values]
                else:
                    said[feature.name] = [each.eURIFragment() for each in values]
        return said

    return [told(root) for root in (m.mission, m.context, m.robot, m.behaviour)]


SNIPPETS = [each for each in list(globals().values()) if getattr(each, "__module__", "") == __name__]
