"""Two processes on one bus of this computer: one asks, the other answers, and it is told what was heard.

python vcan_pair.py CHANNEL [answers]
"""

import subprocess
import sys

from auv_vessel.wire.frame import Frame
from auv_vessel.wire.ports import open_port

COUNT = 10
SECONDS = 5.0


def answer(channel: str) -> None:
    """Answer so many frames, each with the next higher identifier."""
    with open_port("socketcan", channel) as port:
        print("listens", flush=True)
        for _ in range(COUNT):
            heard = port.receive(SECONDS)
            if heard is None:
                return
            port.send(Frame(heard.id + 1, heard.data, heard.extended))


def ask(channel: str) -> None:
    """Have another process answer, and print how many frames were asked and answered, and the errors."""
    words = [sys.executable, "-B", __file__, channel, "answers"]
    with (
        subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as other,
        open_port("socketcan", channel) as port,
    ):
        assert other.stdout is not None
        other.stdout.readline()
        answered = 0
        for number in range(COUNT):
            port.send(Frame(0x100 + 2 * number, bytes((number,))))
            heard = port.receive(SECONDS)
            answered += heard == Frame(0x101 + 2 * number, bytes((number,)))
        print(f"asked {COUNT}, answered {answered}, errors {dict(port.errors)}", flush=True)


if __name__ == "__main__":
    (answer if sys.argv[2:] == ["answers"] else ask)(sys.argv[1])
