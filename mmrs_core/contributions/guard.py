"""The guard of plug-ins: failures of their functions name them."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import Any, TypeVar

from mmrs_core.errors import MmrsError, PluginError

Descriptor = TypeVar("Descriptor")


@dataclass(frozen=True, slots=True, eq=False)
class Guarded:
    """A function of a plug-in, whose failures name the plug-in; equal to the function itself.

    Errors of this package pass: contracts allow plug-ins to raise them. What the function yields later is
    guarded, too.

    Attributes:
        function: the plug-in's own.
        label: plug-in, distribution and contribution, for messages.
    """

    function: Callable[..., Any]
    label: str

    def __call__(self, *arguments: Any, **named: Any) -> Any:
        """Return what the function returns.

        Raises:
            PluginError: if it raises anything but an error of this package.
        """
        try:
            result = self.function(*arguments, **named)
        except MmrsError:
            raise
        except Exception as error:
            raise self._failure(error) from error
        return self._guarded(result) if isinstance(result, Iterator) else result

    def __eq__(self, other: object) -> bool:
        """Return whether both are the same function, guarded or not."""
        return self.function == (other.function if isinstance(other, Guarded) else other)

    def __hash__(self) -> int:
        """Return the function's own."""
        return hash(self.function)

    def _guarded(self, result: Iterator[object]) -> Iterator[object]:
        try:
            yield from result
        except MmrsError:
            raise
        except Exception as error:
            raise self._failure(error) from error

    def _failure(self, error: Exception) -> PluginError:
        return PluginError(f"{self.label} fails: {error!r}")


def guarded(descriptor: Descriptor, label: str) -> Descriptor:
    """Return a descriptor whose functions name the plug-in when they fail.

    >>> from mmrs_core.contributions.execution import Condition
    >>> guarded(Condition("windy", lambda state: 1 / 0), "condition 'windy' of 'kites'").holds(0)
    Traceback (most recent call last):
    ...
    mmrs_core.errors.PluginError: condition 'windy' of 'kites' fails: ZeroDivisionError('division by zero')
    """
    if not is_dataclass(descriptor) or isinstance(descriptor, type):
        return descriptor
    held = ((field.name, getattr(descriptor, field.name)) for field in fields(descriptor))
    functions = ((name, value) for name, value in held if callable(value) and not isinstance(value, type))
    return replace(descriptor, **{name: Guarded(value, label) for name, value in functions})
