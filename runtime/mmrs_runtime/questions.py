"""Questions that the choices of a robot ask, and what people answer: each answer decides one choice."""

from __future__ import annotations

import threading
from collections.abc import Iterable, Iterator, Mapping

from .conditions import is_standard, question_of


class OperatorAnswers(Mapping[str, bool]):
    """Answers by question, as they were at one moment; remembers which of them were looked at."""

    def __init__(self, answers: Mapping[str, bool]) -> None:
        """Remember answers of which none was looked at."""
        self.used: set[str] = set()
        self._answers = dict(answers)

    def __getitem__(self, question: str) -> bool:
        """Return an answer, which is used by that."""
        answer = self._answers[question]
        self.used.add(question)
        return answer

    def __iter__(self) -> Iterator[str]:
        """Yield the questions."""
        return iter(self._answers)

    def __len__(self) -> int:
        """Return how many answers there are."""
        return len(self._answers)


class Questions:
    """What one robot may be answered, and has been; from any thread.

    An answer counts for one choice: the one that waits for it, or the next one that asks. The choice that
    it decides uses it up, so that a choice that comes round again asks again.

    Attributes:
        asked: what a choice waits to be answered now; empty: nothing.
    """

    def __init__(self, conditions: Iterable[str] = ()) -> None:
        """Take the identifiers of the conditions that the robot's choices have."""
        named = tuple(conditions)
        self.asked = ""
        self._questions = sorted({question for each in named if (question := question_of(each))})
        # Functions of the user's may look for answers to questions that only they know.
        self._any = not all(map(is_standard, named))
        self._answers: dict[str, bool] = {}
        self._lock = threading.Lock()

    def give(self, question: str, answer: bool) -> str:
        """Take an answer, in place of an earlier one; return why it is not wanted, empty where it is."""
        if question not in self._questions and not self._any:
            asked = ", ".join(map(ascii, self._questions))
            return f"no choice asks {question!r}; {f'there is {asked}' if asked else 'none asks anything'}"
        with self._lock:
            self._answers[question] = answer
        return ""

    def answers(self) -> OperatorAnswers:
        """Return the answers that no choice has used up."""
        with self._lock:
            return OperatorAnswers(self._answers)

    def use_up(self, answers: OperatorAnswers) -> None:
        """Forget the answers by which a choice was decided."""
        with self._lock:
            for question in answers.used:
                self._answers.pop(question, None)
