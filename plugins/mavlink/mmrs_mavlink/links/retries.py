"""How often to send what is not answered, and how long to wait for an answer."""

from __future__ import annotations

from dataclasses import dataclass

TRIES = 5
ANSWER_SECONDS = 1.5
ITEM_SECONDS = 0.25


@dataclass(frozen=True, slots=True)
class Retries:
    """How often to send at most what is not answered, and how long to wait each time.

    As the mission protocol publishes them (https://mavlink.io/en/services/mission.html); slow radios
    need more.

    Attributes:
        tries: how often to send.
        answer: seconds for an answer.
        item: seconds for an item of a mission that is read back.
    """

    tries: int = TRIES
    answer: float = ANSWER_SECONDS
    item: float = ITEM_SECONDS
