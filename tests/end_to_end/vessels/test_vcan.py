"""Two processes on one computer hear each other on Linux' own virtual bus: in a kernel of Debian, in QEMU.

It needs `qemu-system-x86_64`, `busybox` (static), and a kernel with its modules: that of this computer, or a
package ``linux-image-VERSION-amd64`` of Debian's that ``dpkg -x`` has unpacked into a folder, which
`MMRS_KERNEL_ROOT` names. Kernels for clouds have no CAN. The guest reads Python and this project from this
computer's own files. It is emulated, so that it needs no rights and runs inside of other virtual machines.
"""

import lzma
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

pytestmark = [pytest.mark.real_time("vessels"), pytest.mark.thorough]

WANTED = ("virtio_pci", "9pnet_virtio", "9p", "can_raw", "vcan")
PAIR = Path(__file__).parents[2] / "support" / "vcan_pair.py"
INIT = """#!/bin/busybox sh
b=/bin/busybox
for each in {modules}; do $b insmod /$each.ko; done
$b mount -t 9p -o trans=virtio,version=9p2000.L,ro,cache=loose,msize=1048576 host /host
$b mount -t proc proc /host/proc
$b mount -t devtmpfs dev /host/dev
$b mount -t tmpfs tmp /host/tmp
$b ip link add dev vcan0 type vcan && $b ip link set vcan0 up
PYTHONPATH={path} $b chroot /host {python} -B {pair} vcan0
$b poweroff -f
"""


@pytest.fixture(scope="module")
def kernel() -> tuple[Path, Path]:
    """Return a kernel that knows vcan, and the folder of its modules."""
    root = Path(os.environ.get("MMRS_KERNEL_ROOT", "/"))
    for image in sorted(root.glob("boot/vmlinuz-*"), reverse=True):
        modules = root / "lib/modules" / image.name.removeprefix("vmlinuz-")
        if list(modules.glob("kernel/drivers/net/can/vcan.ko*")):
            return image, modules
    message = "no kernel with vcan is installed, and MMRS_KERNEL_ROOT names none: carries a virtual bus"
    return pytest.fail(message) if os.environ.get("MMRS_REQUIRE_PEERS") == "1" else pytest.skip(message)


def modules_of(folder: Path) -> Mapping[str, bytes]:
    """Return the wanted modules and those that they depend on, in the order in which they can be loaded."""
    files = {file.name.partition(".")[0].replace("-", "_"): file for file in folder.rglob("*.ko*")}
    found: dict[str, bytes] = {}

    def add(name: str) -> None:
        if name in found or name not in files:  # what is no module is part of the kernel
            return
        data = files[name].read_bytes()
        data = lzma.decompress(data) if files[name].suffix == ".xz" else data
        needs = re.search(rb"\0depends=([^\0]*)\0", data)
        for each in needs[1].decode().split(",") if needs else ():
            add(each.replace("-", "_"))
        found[name] = data

    for name in WANTED:
        add(name)
    return found


def archive(files: Mapping[str, bytes | None]) -> bytes:
    """Return files, and folders where there is no data, as an archive that a kernel unpacks (cpio, newc)."""

    def entries() -> Iterator[bytes]:
        for number, (name, data) in enumerate([*files.items(), ("TRAILER!!!", b"")]):
            mode = 0o040755 if data is None else 0o100755
            content = data or b""
            fields = (number, mode, 0, 0, 1, 0, len(content), 0, 0, 0, 0, len(name) + 1, 0)
            head = b"070701" + b"".join(b"%08X" % field for field in fields) + name.encode() + b"\0"
            yield head + b"\0" * (-len(head) % 4) + content + b"\0" * (-len(content) % 4)

    return b"".join(entries())


def test_two_processes_hear_each_other_on_linux_own_virtual_bus(kernel, need_program, tmp_path):
    qemu = need_program("qemu-system-x86_64", "boots a kernel with a virtual CAN bus")
    busybox = Path(need_program("busybox", "is the guest's first program"))
    image, folder = kernel
    modules = modules_of(folder)
    path = os.pathsep.join(each for each in sys.path if each)
    init = INIT.format(modules=" ".join(modules), path=shlex.quote(path), python=sys.executable, pair=PAIR)
    files = {
        "bin": None,
        "host": None,
        "dev": None,
        "bin/busybox": busybox.read_bytes(),
        "init": init.encode(),
    }
    initrd = tmp_path / "initrd"
    initrd.write_bytes(archive(files | {f"{name}.ko": data for name, data in modules.items()}))
    words = [
        *(qemu, "-accel", "tcg", "-m", "512", "-nographic", "-no-reboot", "-nic", "none"),
        *("-virtfs", "local,path=/,mount_tag=host,security_model=none,readonly=on,multidevs=remap"),
        *("-kernel", str(image), "-initrd", str(initrd), "-append", "console=ttyS0 quiet panic=-1"),
    ]
    done = subprocess.run(words, capture_output=True, text=True, timeout=300, stdin=subprocess.DEVNULL)
    assert "asked 10, answered 10, errors {}" in done.stdout, done.stdout + done.stderr
