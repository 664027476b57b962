import time

import pytest
from hub import Hub

from mmrs_runtime.clock import Clock
from mmrs_runtime.injection import Rehearsal, injections

pytestmark = pytest.mark.real_time("parts of flights")


class End:
    """One end of a bus that answers everything, and remembers whom it has seen come and go."""

    def __init__(self) -> None:
        self.served: list[str] = []
        self.there: set[str] = set()

    def serve(self, owner: str, sender: str, request: str) -> str:
        self.served.append(request)
        return f"{owner} answers {request}"

    def noticed(self, robot: str, here: bool) -> None:
        (self.there.add if here else self.there.discard)(robot)

    def shown(self, robot: str) -> str:
        return ""


class Pair:
    """Alpha, behind the faults, and beta."""

    def __init__(self, text: str, clock: Clock | None = None) -> None:
        hub = Hub()
        self.rehearsal = Rehearsal(injections([text], {"alpha": "", "beta": ""}), clock or Clock(), print)
        self.alpha, self.beta = End(), End()
        self.carrier = self.rehearsal.wrap_carrier(hub.plug(), ["alpha"])
        self.other = hub.plug()
        self.carrier.open(self.alpha)
        self.other.open(self.beta)
        self.carrier.appear("alpha")
        self.other.appear("beta")
        self.answers: list[str] = []

    def ask(self, times: int = 1) -> None:
        for number in range(times):
            self.carrier.ask("alpha", "beta", str(number), self.answers.append)


def test_without_faults_of_the_bus_the_carrier_is_the_carrier():
    rehearsal, carrier = Rehearsal(injections(["loss=1"], {}), Clock(), print), Hub().plug()
    assert rehearsal.wrap_carrier(carrier, ["alpha"]) is carrier


def test_requests_and_answers_are_lost():
    pair = Pair("bus-loss=0.2")
    pair.ask(1000)
    assert 740 < len(pair.beta.served) < 860
    assert 0.74 < len(pair.answers) / len(pair.beta.served) < 0.86


def test_requests_and_answers_come_twice():
    pair = Pair("bus-duplicate=0.5")
    pair.ask(1000)
    assert 1400 < len(pair.beta.served) < 1600
    assert len(pair.answers) > 1.4 * len(pair.beta.served)


def test_a_message_that_is_late_comes_late():
    pair = Pair("bus-delay=2", Clock(speedup=10.0))
    begun = time.monotonic()
    pair.ask()
    assert pair.answers == []
    while not pair.answers and time.monotonic() < begun + 5.0:
        time.sleep(0.01)
    assert pair.answers == ["beta answers 0"]
    assert time.monotonic() - begun >= 0.39


def test_a_cut_bus_lets_nothing_through_and_nobody_sees_the_other_until_it_is_mended():
    pair = Pair("bus-cut@1000")
    pair.carrier.cut()
    pair.ask()
    pair.other.ask("beta", "alpha", "x", pair.answers.append)
    assert (pair.beta.served, pair.alpha.served) == ([], [])
    assert (pair.alpha.there, pair.beta.there) == (set(), set())
    pair.answers.clear()
    pair.carrier.mend()
    pair.ask()
    assert (pair.alpha.there, pair.beta.there, pair.answers) == ({"beta"}, {"alpha"}, ["beta answers 0"])


def test_a_bus_is_cut_and_mended_at_its_time():
    clock = Clock(speedup=50.0)
    pair = Pair("bus-cut@20+30", clock)
    pair.rehearsal.start()
    seen: dict[str, set[bool]] = {"before": set(), "cut": set(), "after": set()}
    while not seen["after"]:
        since, there, until = clock.now(), bool(pair.alpha.there), clock.now()
        if until < 20.0:
            seen["before"].add(there)
        elif since > 30.0 and until < 50.0:
            seen["cut"].add(there)
        elif since > 70.0:
            seen["after"].add(there)
        time.sleep(0.01)
    pair.rehearsal.close()
    assert seen == {"before": {True}, "cut": {False}, "after": {True}}


def test_robots_of_one_process_have_no_bus_to_make_faulty():
    with pytest.raises(ValueError, match="use no bus"):
        injections(["bus-cut@5"], {}, alone=True)


def test_faults_of_the_bus_are_those_of_all_robots_of_the_process():
    with pytest.raises(ValueError, match="concerns all robots"):
        injections(["alpha:bus-loss=0.5"], {"alpha": ""})
