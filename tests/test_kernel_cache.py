"""Machine code on disk: never that of other sources, and never in the way of a solve."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from numba import types

import beamfem
from beamfem.kernels import cache, compiling
from beamfem.kernels.band import band

KERNELS = Path(beamfem.__file__).parent / "kernels"
PLAIN = {
    "numba",
    "operator",
    "numpy",
    "math",
    "ctypes",
    "inspect",
    "llvmlite",
    "time",
    "typing",
    "hashlib",
    "sys",
    "pickle",
    "shutil",
    "tempfile",
    "collections.abc",
    "functools",
    "pathlib",
}

# two files: `outer` inlines `inner`
INNER = "from numba import njit\n\n@njit(forceinline=True, _nrt=False)\ndef inner(x):\n    return {factor} * x\n"
OUTER = (
    "from numba import types\nfrom small.compiling import routine\nfrom small.inner import inner\n\n"
    "@routine('d', types.float64)\ndef outer(x):\n    return inner(x) + 1.0\n"
)
RUN = (
    "import sys; sys.path.insert(0, sys.argv[1])\n"
    "from small.outer import outer\nfrom small.cache import cache_folder\n"
    "print(outer(2.0), 0 if outer.compiled_here else 1, cache_folder())"
)


@pytest.fixture
def small(tmp_path):
    """A package of two kernels with our way of compiling."""
    package = tmp_path / "small"
    package.mkdir()
    (package / "__init__.py").touch()
    for name in ("cache.py", "compiling.py", "lanes.py", "pointers.py"):
        (package / name).write_text((KERNELS / name).read_text().replace("beamfem.kernels", "small"))
    (package / "inner.py").write_text(INNER.format(factor=3.0))
    (package / "outer.py").write_text(OUTER)
    return package


def run(small, **environment):
    given = {name: os.environ[name] for name in ("PATH", "HOME") if name in os.environ} | environment
    command = [sys.executable, "-B", "-c", RUN, str(small.parent)]
    done = subprocess.run(command, capture_output=True, text=True, env=given, check=False)
    assert done.returncode == 0, done.stderr
    value, hits, folder = done.stdout.strip().split(" ", 2)
    return float(value), int(hits), folder


def test_a_change_of_an_inlined_kernel_is_noticed(small):
    assert run(small)[:2] == (7.0, 0)
    value, hits, folder = run(small)
    assert (value, hits) == (7.0, 1)
    before = (small / "inner.py").stat()
    (small / "inner.py").write_text(INNER.format(factor=5.0))
    os.utime(small / "inner.py", ns=(before.st_atime_ns, before.st_mtime_ns))  # same size, same time
    value, hits, other = run(small)
    assert (value, hits) == (11.0, 0)
    assert other != folder
    assert not Path(folder).exists()  # nobody needs it any more


def test_machines_that_share_a_home_do_not_share_machine_code(small):
    """Numba chooses a file for new code from an index that another machine may be writing just then."""
    here, there = run(small), run(small, NUMBA_CPU_NAME="generic")
    assert there[:2] == (7.0, 0)
    assert there[2] != here[2]
    assert Path(there[2]).parent == Path(here[2]).parent
    assert run(small) == (7.0, 1, here[2])
    assert run(small, NUMBA_CPU_NAME="generic") == (7.0, 1, there[2])
    for folder in here[2], there[2]:
        assert len(list(Path(folder).glob("*.nbc"))) == 1


def test_a_damaged_file_of_machine_code_is_compiled_again(small):
    folder = Path(run(small)[2])
    for file in folder.iterdir():
        file.write_bytes(file.read_bytes()[:50])
    assert run(small)[:2] == (7.0, 0)
    assert run(small)[:2] == (7.0, 1)


def test_a_folder_that_is_named_is_taken(small, tmp_path):
    assert run(small, NUMBA_CACHE_DIR=str(tmp_path / "named"))[2].startswith(str(tmp_path / "named"))


@pytest.mark.parametrize("home", ["/proc", None])
def test_without_a_place_to_write_work_goes_on(small, tmp_path, home):
    """A file in the place of the folder stands for one that takes no files: permissions do not stop root."""
    (tmp_path / "taken").touch()
    given = {"NUMBA_CACHE_DIR": str(tmp_path / "taken")} | ({"HOME": home} if home else {})
    assert run(small, **given) == (7.0, 0, "None")


def test_a_disk_that_is_full_while_compiling_is_no_error(small, monkeypatch):
    def full(self, sig, data):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(cache.FunctionCache, "save_overload", full)

    @compiling.routine("d", types.float64)
    def doubled(x):
        return 2.0 * x

    assert doubled(3.0) == 6.0


def test_what_is_compiled_comes_from_the_kernels_alone():
    """The content of that folder names the machine code, so that nothing from elsewhere may be inlined."""
    for file in KERNELS.rglob("*.py"):
        for line in file.read_text().splitlines():
            if line.startswith(("from ", "import ")):
                module = line.split()[1]
                assert module in PLAIN or module.startswith(("beamfem.kernels", "numba.")), f"{file.name}: {line}"


def test_no_two_kernels_share_a_name():
    """Machine code on disk is found by name. The functions of a band had one name for all half widths: of two processes
    that compiled different ones at once, one wrote its code in the place that the index of the other named, and models
    got the factors of another width."""
    for half_width in range(20):
        band(half_width)
    names = [routine.name for routine in compiling.Routine.made if routine.__module__.startswith("beamfem.kernels")]
    assert len({name for name in names if ".band." in name}) == 3 * 7
    assert len(set(names)) == len(names)
