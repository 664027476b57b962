"""The thread that has a vehicle do things: interruptions, pauses, faults."""

import threading
import time

import pytest

from mmrs_mavlink.driving.worker import Job, Worker
from mmrs_runtime.faults import CRASHED, LINK_LOST, FaultError


class Yard:
    """A worker, and what it did."""

    def __init__(self):
        self.did, self.news, self.trouble = [], threading.Event(), None
        self.halt, self.go_on = self.do("halted"), self.do("went on")
        self.worker = Worker("of a test", self.watch, self.watch, lambda: self.halt(), lambda: self.go_on())
        self.worker.changed = self.news.set

    def watch(self):
        if self.trouble is not None:
            raise self.trouble

    def do(self, word):
        return lambda: self.did.append(word)

    def wait(self, word, seconds=30.0):
        """Return a part of a job that takes time, as waits for vehicles do."""

        def part():
            self.did.append(word)
            until = time.monotonic() + seconds
            while time.monotonic() < until:
                self.worker.guard()
                time.sleep(0.001)

        return part

    def until(self, test):
        end = time.monotonic() + 20.0
        while not test():
            assert time.monotonic() < end, self.did
            time.sleep(0.002)


@pytest.fixture
def yard():
    made = Yard()
    yield made
    made.worker.close()


def test_parts_are_done_in_order_and_the_end_is_told(yard):
    yard.worker.begin(Job(yard.do("one"), yard.do("two")))
    assert yard.news.wait(20.0)
    assert yard.did == ["one", "two"]
    assert yard.worker.done


def test_a_new_job_ends_the_old_one_at_once(yard):
    yard.worker.begin(Job(yard.wait("old"), yard.do("never")))
    yard.until(lambda: yard.did == ["old"])
    yard.worker.begin(Job(yard.do("new")))
    yard.until(lambda: yard.worker.done)
    assert yard.did == ["old", "new"]


def test_a_pause_halts_and_the_interrupted_part_is_begun_again(yard):
    yard.worker.begin(Job(yard.do("before"), yard.wait("under way", 0.3), yard.do("after")))
    yard.until(lambda: "under way" in yard.did)
    yard.worker.pause()
    yard.until(lambda: yard.worker.halted)
    assert not yard.worker.done
    yard.worker.resume()
    yard.until(lambda: yard.worker.done)
    assert yard.did == ["before", "under way", "halted", "went on", "under way", "after"]


def test_a_second_pause_while_it_goes_on_again_halts_once_more(yard):
    yard.go_on = yard.wait("goes on")
    yard.worker.pause()
    yard.until(lambda: yard.worker.halted)
    yard.worker.resume()
    yard.until(lambda: "goes on" in yard.did)
    yard.worker.pause()
    assert not yard.worker.halted
    yard.until(lambda: yard.worker.halted)
    assert yard.did == ["halted", "goes on", "halted"]


def test_a_halt_that_something_new_overtakes_does_not_count(yard):
    yard.halt = lambda: yard.worker.begin(Job(yard.do("new")), afresh=True)
    yard.worker.pause()
    yard.until(lambda: yard.worker.done and "new" in yard.did)
    assert yard.did == ["new"]
    assert not yard.worker.halted


def test_a_job_given_while_it_pauses_waits(yard):
    yard.worker.pause()
    yard.until(lambda: yard.worker.halted)
    yard.worker.begin(Job(yard.do("later")))
    time.sleep(0.2)
    assert yard.did == ["halted"]
    yard.worker.resume()
    yard.until(lambda: yard.worker.done)
    assert yard.did == ["halted", "went on", "later"]


def test_a_fault_ends_the_job_and_stays(yard):
    yard.worker.begin(Job(yard.wait("under way")))
    yard.until(lambda: yard.did)
    yard.trouble = FaultError(LINK_LOST, "silence")
    assert yard.news.wait(20.0)
    assert yard.worker.fault is yard.trouble


def test_a_fault_is_noticed_while_there_is_nothing_to_do(yard):
    yard.trouble = FaultError(LINK_LOST, "silence")
    assert yard.news.wait(20.0)
    assert yard.worker.fault is yard.trouble


def test_nothing_more_is_done_after_a_fault_until_something_is_begun_afresh(yard):
    yard.trouble = FaultError(LINK_LOST, "silence")
    assert yard.news.wait(20.0)
    yard.trouble = None
    yard.worker.begin(Job(yard.do("no")))
    time.sleep(0.2)
    assert yard.did == []
    yard.worker.begin(Job(yard.do("yes")), afresh=True)
    yard.until(lambda: yard.worker.done)
    assert yard.did == ["yes"]
    assert yard.worker.fault is None


@pytest.mark.parametrize("error", [ZeroDivisionError("by zero"), SystemExit(0)])
def test_what_a_part_raises_is_told_as_a_fault_of_the_robot_and_the_thread_lives_on(yard, error):
    def fail():
        raise error

    told = []
    yard.worker.failed = told.append
    yard.worker.begin(Job(fail))
    assert yard.news.wait(20.0)
    assert yard.worker.fault.event == CRASHED
    assert told == [error]
    yard.worker.begin(Job(yard.do("more")), afresh=True)
    yard.until(lambda: yard.did == ["more"])


def test_parts_can_be_put_in_while_one_is_done(yard):
    job = Job()
    job.append(lambda: job.then(yard.do("b"), yard.do("c")))
    job.append(yard.do("d"))
    job.first(yard.do("a"))
    yard.worker.begin(job)
    yard.until(lambda: yard.worker.done)
    assert yard.did == ["a", "b", "c", "d"]


def test_a_vehicle_that_was_told_to_halt_goes_on_once_it_was_told_so(yard):
    standing, going = threading.Event(), threading.Event()
    yard.halt, yard.go_on = yard.wait("brakes"), lambda: going.wait(20.0)
    yard.worker.begin(Job(standing.set))
    assert standing.wait(20.0)
    yard.worker.pause()
    yard.until(lambda: "brakes" in yard.did)
    assert not yard.worker.goes_on
    yard.worker.resume()
    assert yard.worker.goes_on
    going.set()
    yard.until(lambda: not yard.worker.goes_on)
