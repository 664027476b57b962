"""Whole lines of logs, whatever a break has left behind them."""

import pytest

from mmrs_runtime.faults import FaultError
from mmrs_runtime.records.lines import keep_whole_lines, whole_lines
from mmrs_runtime.records.log import read

TOO_DEEP = b"[" * 200_000


@pytest.mark.parametrize("rest", [b"", b'{"seq": 2', b"\0\0\n", b"\xff\n\0"])
def test_what_was_cut_off_or_is_no_text_counts_as_no_line(tmp_path, rest):
    path = tmp_path / "r.jsonl"
    path.write_bytes(b"{}\n[]\n" + rest)
    assert whole_lines(path.read_bytes()) == [b"{}", b"[]"]
    keep_whole_lines(path)
    assert path.read_bytes() == b"{}\n[]\n"


def test_rubbish_before_a_whole_line_is_kept():
    assert whole_lines(b"\0\n{}\n") == [b"\0", b"{}"]


def test_a_line_that_is_too_deep_to_be_read_is_a_fault_of_the_log(tmp_path):
    path = tmp_path / "r.jsonl"
    path.write_bytes(TOO_DEEP + b"\n")
    with pytest.raises(FaultError, match=r"r\.jsonl:1: cannot be read") as fault:
        read(path)
    assert fault.value.event == "LOG_FAILED"
