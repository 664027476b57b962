"""Forms of .ecore files that EMF reads, and files that it calls faulty, each with the files it refers to."""

from mmrs_core.languages.datatypes import ECORE, XML_TYPES

NAMESPACES = (
    'xmlns:xmi="http://www.omg.org/XMI" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" '
    f'xmi:version="2.0" xmlns:ecore="{ECORE}"'
)
TYPES = f"{XML_TYPES}#//"


def packaged(body, uri="urn:a"):
    head = f'name="{uri[4:]}" nsURI="{uri}" nsPrefix="{uri[4:]}"'
    return f"<ecore:EPackage {NAMESPACES} {head}>{body}</ecore:EPackage>"


def classed(called, body="", rest=""):
    return f'<eClassifiers xsi:type="ecore:EClass" name="{called}" {rest}>{body}</eClassifiers>'


def attribute(called, kind="EInt", rest=""):
    kind = kind if "#" in kind else f"{ECORE}#//{kind}"
    ecore = f'eType="ecore:EDataType {kind}"'
    return f'<eStructuralFeatures xsi:type="ecore:EAttribute" name="{called}" {ecore} {rest}/>'


def reference(called, kind, rest=""):
    kind = f'eType="{kind}"' if kind else ""
    return f'<eStructuralFeatures xsi:type="ecore:EReference" name="{called}" {kind} {rest}/>'


def generic(called, kind, content):
    head = f'<eStructuralFeatures xsi:type="ecore:{kind}" name="{called}">'
    return f"{head}<eGenericType {content}/></eStructuralFeatures>"


def linked(called, content):
    return f'<eStructuralFeatures xsi:type="ecore:EReference" name="{called}">{content}</eStructuralFeatures>'


B = {"b.ecore": packaged(classed("B", attribute("x") + reference("f", "#//B", 'xmi:id="_f"')), "urn:b")}
B_WITH_ID = {"b.ecore": B["b.ecore"].replace("<eClassifiers ", '<eClassifiers xmi:id="_b" ')}
TWO_ROOTS = (
    f'<xmi:XMI {NAMESPACES}><ecore:EPackage name="one" nsURI="urn:1" nsPrefix="one">'
    f'{classed("A", attribute("x"))}</ecore:EPackage><ecore:EPackage name="two" nsURI="urn:2" nsPrefix="two">'
    f"{classed('B', reference('r', '#/0/A') + reference('s', '#/1/B') + reference('t', '#//A'))}"
    "</ecore:EPackage></xmi:XMI>"
)
NUMBER = f'<eType xsi:type="ecore:EDataType" href="{ECORE}#//EInt"/>'
BOUND = '<eTypeParameters name="T"><eBounds eClassifier="#//Animal"/></eTypeParameters>'
CHAINED = '<eTypeParameters name="U"><eBounds eTypeParameter="#//Box/T"/></eTypeParameters>'
ARGUMENTS = '<eTypeArguments eClassifier="#//Animal"/>' * 3
BOX = "".join(
    (
        '<eClassifiers xsi:type="ecore:EClass" name="Box">',
        f'{BOUND}{CHAINED}<eTypeParameters name="V" xmi:id="_v"/>',
        generic("bounded", "EReference", 'eTypeParameter="#//Box/T"'),
        generic("chained", "EReference", 'eTypeParameter="#//Box/U"'),
        generic("free", "EReference", 'eTypeParameter="_v"'),
        generic("position", "EReference", 'eTypeParameter="#//Box/@eTypeParameters.0"'),
        generic("value", "EAttribute", 'eTypeParameter="#//Box/V"'),
        "</eClassifiers>",
    )
)
FORMS = {
    "types by href": {
        **B,
        "a.ecore": packaged(
            classed(
                "A",
                linked("r", '<eType xsi:type="ecore:EClass" href="b.ecore#//B"/>')
                + f'<eStructuralFeatures xsi:type="ecore:EAttribute" name="n">{NUMBER}</eStructuralFeatures>',
            )
        ),
    },
    "supertypes by href": {**B, "a.ecore": packaged(classed("A", '<eSuperTypes href="b.ecore#//B"/>'))},
    "opposites by href": {
        "a.ecore": packaged(
            classed("A", reference("b", "#//B", 'containment="true" eOpposite="#//B/a"'))
            + classed(
                "B", linked("a", '<eType href="#//A" xsi:type="ecore:EClass"/><eOpposite href="#//A/b"/>')
            )
        )
    },
    "references by id": {
        "a.ecore": packaged(
            classed("B", attribute("x"), 'xmi:id="_1"')
            + classed("A", reference("r", "_1") + linked("s", '<eType xmi:idref="_1"/>'), 'eSuperTypes="_1"')
            + '<eClassifiers xsi:type="ecore:EEnum" xmi:id="_e" name="E"><eLiterals name="P"/></eClassifiers>'
            + classed("D", '<eStructuralFeatures xsi:type="ecore:EAttribute" name="e" eType="_e"/>')
        )
    },
    "references by id in another file": {
        **B_WITH_ID,
        "a.ecore": packaged(
            classed("A", reference("r", "ecore:EClass b.ecore#_b"), 'eSuperTypes="b.ecore#_b"')
        ),
    },
    "references by position": {
        **B,
        "a.ecore": packaged(
            f'<eSubpackages name="s" nsURI="urn:a:s" nsPrefix="s">{classed("S")}</eSubpackages>'
            + classed("B")
            + classed(
                "A",
                reference("r", "#//@eClassifiers.0")
                + reference("s", "#//@eSubpackages.0/S")
                + reference("t", "#//@eClassifiers[name='B']")
                + reference("u", "ecore:EClass b.ecore#//@eClassifiers.0"),
            )
        ),
    },
    "names in percent": {
        "a.ecore": packaged(
            classed("Bä") + classed("A", reference("r", "#//B%C3%A4") + reference("s", "#//Bä"))
        )
    },
    "no hash": {"a.ecore": packaged(classed("B") + classed("A", reference("r", "//B")))},
    "the type by xmi:type": {
        "a.ecore": packaged(classed("A", attribute("x")).replace("xsi:type", "xmi:type"))
    },
    "XMI 2.1": {
        "a.ecore": packaged(classed("A", attribute("x")))
        .replace("http://www.omg.org/XMI", "http://schema.omg.org/spec/XMI/2.1")
        .replace("xsi:type", "xmi:type")
    },
    "the default namespace": {
        "a.ecore": packaged(classed("A", attribute("x")))
        .replace("ecore:", "")
        .replace("xmlns:ecore", "xmlns")
        .replace("xmlns=", f'xmlns:e="{ECORE}" xmlns=')
        .replace('"EDataType ', '"e:EDataType ')
    },
    "attributes as elements": {
        "a.ecore": packaged(
            classed(
                "A",
                '<eStructuralFeatures xsi:type="ecore:EAttribute"><name>x</name><lowerBound>1</lowerBound>'
                f"<unsettable>true</unsettable>{NUMBER}</eStructuralFeatures>",
            )
        )
    },
    "several packages in one file": {"a.ecore": TWO_ROOTS},
    "several packages in another file": {
        "b.ecore": TWO_ROOTS,
        "a.ecore": packaged(
            classed(
                "A", reference("r", "ecore:EClass b.ecore#/1/B") + reference("s", "ecore:EClass b.ecore#//A")
            )
        ),
    },
    "a package inside that lies elsewhere": {
        **B,
        "a.ecore": packaged(
            '<eSubpackages href="b.ecore#/"/>' + classed("A", reference("r", "ecore:EClass b.ecore#//B"))
        ),
    },
    "generics": {
        "a.ecore": packaged(
            classed("Animal", attribute("n", "EString"))
            + BOX
            + classed("Cage", f'<eGenericSuperTypes eClassifier="#//Box">{ARGUMENTS}</eGenericSuperTypes>')
        )
    },
    "generics by href": {
        "a.ecore": packaged(
            classed("B")
            + classed(
                "A",
                '<eGenericSuperTypes><eClassifier xsi:type="ecore:EClass" href="#//B"/></eGenericSuperTypes>'
                + linked(
                    "r", '<eGenericType><eClassifier xsi:type="ecore:EClass" href="#//B"/></eGenericType>'
                ),
            )
        )
    },
    "unspecified bounds": {
        "a.ecore": packaged(
            classed(
                "A",
                attribute("x", rest='upperBound="-2"')
                + attribute("y", rest='upperBound="-2" defaultValueLiteral="4" lowerBound="+1"')
                + attribute("z", rest='upperBound="-1" unsettable="TRUE"'),
            )
        )
    },
    "defaults in Java's notation": {
        "a.ecore": packaged(
            classed(
                "A",
                attribute("x", "EDouble", 'defaultValueLiteral="0x1p3"')
                + attribute("y", "EInt", 'defaultValueLiteral="+0007"')
                + attribute("z", "EBigInteger", f'defaultValueLiteral="{"9" * 5000}"'),
            )
        )
    },
    "empty literals": {
        "a.ecore": packaged(
            '<eClassifiers xsi:type="ecore:EEnum" name="E"><eLiterals name="P"/>'
            '<eLiterals name="Q" value="-2147483648" literal=""/></eClassifiers>'
        )
    },
    "types of Java": {
        "a.ecore": packaged(
            classed(
                "A",
                "".join(
                    attribute(f"x{kind}", kind, 'transient="true"')
                    for kind in (
                        "EResource",
                        "EResourceSet",
                        "EEnumerator",
                        "EDiagnosticChain",
                        "EFeatureMap",
                    )
                ),
            )
        )
    },
    "references into Ecore": {
        "a.ecore": packaged(
            classed(
                "A",
                "".join(
                    reference(f"x{kind}", f"ecore:EClass {ECORE}#//{kind}", rest)
                    for kind, rest in (
                        ("EClass", ""),
                        ("EPackage", 'containment="true"'),
                        ("EClassifier", 'upperBound="-1"'),
                        ("EModelElement", ""),
                        ("EObject", ""),
                    )
                ),
                f'eSuperTypes="{ECORE}#//EAnnotation"',
            )
        )
    },
    "anything of XML": {
        "a.ecore": packaged(
            classed("A", reference("x", f"ecore:EClass {TYPES}AnyType", 'containment="true"'))
        )
    },
}
REFUSED = {
    "a bound that is too large": (
        classed("A", attribute("x", rest='upperBound="99999999999"')),
        "upperBound",
    ),
    "a bound in Python's notation": (classed("A", attribute("x", rest='lowerBound="1_0"')), "lowerBound"),
    "a bound after a blank": (classed("A", attribute("x", rest='lowerBound=" 1"')), "lowerBound"),
    "a flag that is yes": (classed("A", attribute("x", rest='unsettable="yes"')), "unsettable: 'yes'"),
    "a flag that is empty": (classed("A", attribute("x", rest='ordered=""')), "ordered: ''"),
    "an unknown id": (classed("A", reference("r", "_9")), "eType: '_9' leads to no element"),
    "a name": (classed("A", reference("r", "A")), "eType: 'A' leads to no element"),
    "a type without an address": (classed("A", linked("r", "<eType>#//A</eType>")), "eType: leads nowhere"),
    "a feature of no kind": (classed("A", '<eStructuralFeatures name="r" eType="#//A"/>'), "no xsi:type"),
    "an unknown parameter": (
        classed("A", generic("r", "EReference", 'eTypeParameter="#//A/T"')),
        "no type parameter of A",
    ),
    "a value of an enumeration": (
        '<eClassifiers xsi:type="ecore:EEnum" name="E">'
        '<eLiterals name="P" value="99999999999"/></eClassifiers>',
        "value: '99999999999'",
    ),
    "two classifiers of one name": (classed("A") + classed("A"), "EClass A is declared twice"),
}
