"""Injected faults (``--inject``), for rehearsals on the links of the real flight."""

from __future__ import annotations

from .rehearsal import Note, Rehearsal, noted_in
from .spec import HELP, Injection, Injections, injections

__all__ = ["HELP", "Injection", "Injections", "Note", "Rehearsal", "injections", "noted_in"]
