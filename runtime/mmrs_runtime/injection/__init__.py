"""Faults made on purpose (``--inject``), so that people rehearse them on the links they will fly with."""

from __future__ import annotations

from .rehearsal import Note, Rehearsal
from .spec import HELP, Injection, Injections, injections

__all__ = ["HELP", "Injection", "Injections", "Note", "Rehearsal", "injections"]
