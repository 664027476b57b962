"""pyecoregen's generator at work on our template; this module alone needs the extra ``extend``."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Protocol

from jinja2 import Environment
from multigen.jinja import JinjaGenerator
from pyecoregen.ecore import EcorePackageModuleTask, EcoreTask

from mmrs_core.generation.environment import environment_in, rendered
from mmrs_core.generation.stubs.view import docstring, module_view
from mmrs_core.languages.metaclass import Package
from mmrs_core.resources import shipped


class EPackage(Protocol):
    """What is needed of pyecore's class of that name."""

    nsURI: str  # noqa: N815  # pyecore's name

    def eRoot(self) -> EPackage:
        """Return the package at the top of those that it stands in."""


class StubTask(EcoreTask):  # type: ignore[misc]  # pyecoregen has no types
    """Makes the stub of each package that is asked for, and keeps its text: who writes wants all of them.

    Attributes:
        texts: of the files, by path.
    """

    template_name = "module.pyi.jinja"
    element_type = EcorePackageModuleTask.element_type
    environment: Environment

    def __init__(self, packages: Iterable[Package], modules: Mapping[str, str]) -> None:
        super().__init__(formatter=_ended)
        self._packages = {package.ns_uri: package for package in packages}
        self._modules = modules
        self.texts: dict[Path, str] = {}

    def filtered_elements(self, model: EPackage) -> Iterator[EPackage]:
        """Yield a package and those that stand in it, as far as they were asked for."""
        return (each for each in super().filtered_elements(model) if each.nsURI in self._packages)

    def relative_path_for_element(self, element: EPackage) -> str:
        """Return the name of the file for a package; all are in one folder, as modules of one package."""
        return f"{self._modules[element.nsURI].rpartition('.')[2]}.pyi"

    def create_template_context(self, element: EPackage) -> dict[str, object]:
        """Return what the template knows: the element, and our view of it with the names in Python."""
        view = module_view(self._packages[element.nsURI], self._modules)
        context: dict[str, object] = super().create_template_context(element=element, **view)
        return context

    def generate_file(self, element: EPackage, filepath: str) -> None:
        """Keep the text for a file.

        Raises:
            InternalError: if the template is broken.
        """
        text = rendered(self.environment, self.template_name, self.create_template_context(element))
        self.texts[Path(filepath)] = self.formatter(text)


class StubGenerator(JinjaGenerator):  # type: ignore[misc]  # multigen has no types
    """Runs a task in our environment, which is strict about names and lets no text through unencoded.

    Built on what pyecoregen's ``EcoreGenerator`` is built on, without that one's renaming of everything.
    """

    def __init__(self, task: StubTask) -> None:
        self.tasks = (task,)
        super().__init__()

    def create_environment(self) -> Environment:
        """Return the environment of our template."""
        filters: dict[str, Callable[..., str]] = {"code": str, "docstring": docstring}
        return environment_in(shipped("codegen_templates") / "python-stubs", filters)


def stub_texts(packages: Iterable[Package], modules: Mapping[str, str], folder: Path) -> Mapping[Path, str]:
    """Return the stubs of some packages by the files that they belong into, in the order of the packages.

    Args:
        packages: the metamodels.
        modules: the dotted name of the module for each nsURI that the metamodels have or refer to. One
            without a dot is imported as it is.
        folder: of the files; made where it is missing.
    """
    wanted = tuple(packages)
    task = StubTask(wanted, modules)
    generator = StubGenerator(task)
    elements: list[EPackage] = [package.epackage for package in wanted]
    for root in dict.fromkeys(element.eRoot() for element in elements):
        generator.generate(root, str(folder))
    return {path: task.texts[path] for path in (folder / task.relative_path_for_element(e) for e in elements)}


def _ended(text: str) -> str:
    """Return a text with one line break at its end."""
    return text.rstrip("\n") + "\n"
