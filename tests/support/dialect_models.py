"""Random models of a dialect that a mapping declares, written as XMI and in every spelling of JSON."""

import json
from random import Random
from xml.sax.saxutils import quoteattr

from mmrs_flyaq.sources.structure import Sort, Structure

LETTERS = "abcXYZ019 _-äß"


def concrete(structure: Structure, kind: str) -> list[str]:
    """Return the classes without subclasses that are of a kind."""
    heirs = [name for name in structure.classes if kind in structure.ancestry(name)]
    above = {base for name in structure.classes for base in structure.classes[name].supertypes}
    return [name for name in heirs if name not in above] or [kind]


def random_model(random: Random, structure: Structure, kind: str, depth: int = 0):
    """Return an element: (class, attributes, elements, references)."""
    chosen = random.choice(concrete(structure, kind))
    attributes, elements, references = {}, {}, []
    for feature in structure.features(chosen):
        if random.random() < 0.15:
            continue
        if feature.sort is Sort.ATTRIBUTE:
            attributes[feature.name] = random_value(random, feature.type)
        elif feature.sort is Sort.REFERENCE:
            references.append((feature.name, feature.many, random.randrange(50)))
        elif depth < 5:
            count = random.randrange(4) if feature.many else 1
            inner = [random_model(random, structure, feature.type, depth + 1) for _ in range(count)]
            if inner:
                elements[feature.name] = (feature.many, inner)
    return chosen, attributes, elements, references


def random_value(random: Random, kind: str):
    """Return a value of an attribute; numbers are often whole, and now and then 0."""
    if kind == "number":
        return random.choice((0, random.randint(-3, 200), round(random.uniform(-90, 90), 4)))
    if kind == "truth":
        return random.random() < 0.5
    if "|" in kind:
        return random.choice([word.strip() for word in kind.split("|")])
    return "".join(random.choice(LETTERS) for _ in range(random.randint(1, 8)))


def paths(model, path: str = "/"):
    """Yield the path of every element."""
    yield path
    for name, (many, inner) in model[2].items():
        for index, each in enumerate(inner):
            yield from paths(each, f"{path}/@{name}.{index}" if many else f"{path}/@{name}")


def as_xmi(model, uris) -> str:
    """Write a model as EMF does."""
    kind = model[0]
    spaces = " ".join(f'xmlns:{prefix}="{uri}"' for prefix, uri in uris.items())
    head = f'xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" {spaces}'
    everything = sorted(paths(model))
    body = _attributes(model, everything), _inner(model, everything)
    return f"<{kind.replace('.', ':')} {head}{body[0]}>{body[1]}</{kind.replace('.', ':')}>"


def _attributes(model, everything) -> str:
    texts = {name: _text(value) for name, value in model[1].items()}
    texts |= {name: everything[pick % len(everything)] for name, _, pick in model[3]}
    return "".join(f" {name}={quoteattr(text)}" for name, text in texts.items())


def _text(value) -> str:
    return str(value).lower() if isinstance(value, bool) else str(value)


def _inner(model, everything) -> str:
    parts = []
    for name, (_, inner) in model[2].items():
        for each in inner:
            package, _, kind = each[0].partition(".")
            body = _attributes(each, everything), _inner(each, everything)
            parts.append(f'<{name} xsi:type="{package}:{kind}"{body[0]}>{body[1]}</{name}>')
    return "".join(parts)


def as_json(model, uris, spelling: str) -> str:
    """Write a model as the JSON exporter did; spelling is one of prefix, uri and file."""
    everything = sorted(paths(model))
    top = _object(model, uris, spelling, everything)
    return json.dumps(({"@ns": uris} if spelling == "prefix" else {}) | top, indent=1)


def _class(kind: str, uris, spelling: str) -> str:
    package, _, name = kind.partition(".")
    heads = {
        "prefix": f"{package}://",
        "uri": f"{uris[package]}#//",
        "file": f"file:/C:/x/{package}.ecore#//",
    }
    return heads[spelling] + name


def _object(model, uris, spelling: str, everything) -> dict[str, object]:
    found: dict[str, object] = {"eClass": _class(model[0], uris, spelling)} | model[1]
    for name, many, pick in model[3]:
        link = {"$ref": everything[pick % len(everything)]}
        found[name] = [link] if many else link
    for name, (many, inner) in model[2].items():
        objects = [_object(each, uris, spelling, everything) for each in inner]
        found[name] = objects if many else objects[0]
    return found
