"""How busy a bus is, in words."""

from __future__ import annotations

from collections.abc import Iterator

from auv_vessel.wire.load import Heard, Load


def table(designed: Load) -> Iterator[str]:
    """Yield a line for each message."""
    yield f"{'message':20} {'id':>5} {'period':>8} {'bits':>9} {'over by':>9}"
    for each in designed.shares:
        period = "-" if each.period is None else f"{each.period * 1000:.0f} ms"
        latest = "-" if each.latest is None else f"{each.latest * 1000:.2f} ms"
        bits = f"{each.shortest}-{each.longest}"
        yield f"{each.name:20} 0x{each.id:03X} {period:>8} {bits:>9} {latest:>9}"


def summary(designed: Load, found: Heard | None) -> Iterator[str]:
    """Yield how busy the bus is by design, and how busy it was if it was heard."""
    yield (
        f"by design: {designed.least:.1%} of the time without stuff bits, {designed.most:.1%} at most, "
        f"at {designed.bit_rate / 1000:g} kbit/s"
    )
    if found is not None:
        yield (
            f"as heard: {found.mean:.1%} on average ({found.frames} frames in {found.seconds:.1f} s); "
            f"in windows of {found.window * 1000:.0f} ms: median {found.median:.1%}, 99th percentile "
            f"{found.high:.1%}, most {found.peak:.1%}; {found.stuffing:.1f} stuff bits on 100"
        )
