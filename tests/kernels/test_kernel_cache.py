"""Machine code on disk: never that of other sources, and never in the way of a solve."""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

import beamfem
from beamfem.kernels import cache, compiling
from beamfem.kernels import inertia_forces as inertia
from beamfem.kernels.band import band
from beamfem.kernels.bidirectional_lu import bidirectional_lu

KERNELS = Path(beamfem.__file__).parent / "kernels"
PLAIN = set(sys.stdlib_module_names) | {"numpy", "llvmlite", "platformdirs"}

# two files: `outer` inlines `inner`
INNER = "from small.compiling import inlined\n\n@inlined\ndef inner(x):\n    return {factor} * x\n"
OUTER = (
    "from small.compiling import routine\nfrom small.inner import inner\n\n"
    "@routine('d', 'd')\ndef outer(x):\n    return inner(x) + 1.0\n"
)
RUN = (
    "import sys; sys.path.insert(0, sys.argv[1])\n"
    "from small.compiler import machine\n"
    "if sys.argv[2]: machine.processor = lambda: (sys.argv[2], '')\n"
    "from small.outer import outer\nfrom small.cache import cache_folder\n"
    "print(outer(2.0), 0 if outer.compiled_here else 1, cache_folder())"
)


@pytest.fixture
def small(tmp_path):
    """A package of two kernels with our way of compiling."""
    package = tmp_path / "small"
    package.mkdir()
    (package / "__init__.py").touch()
    (package / "compiler").mkdir()
    own = map(KERNELS.joinpath, ("cache.py", "compiling.py", "pointers.py", "records.py"))
    for file in (*own, *KERNELS.glob("compiler/*.py")):
        text = file.read_text().replace("beamfem.kernels", "small")
        (package / file.relative_to(KERNELS)).write_text(text)
    (package / "inner.py").write_text(INNER.format(factor=3.0))
    (package / "outer.py").write_text(OUTER)
    return package


def surroundings(small):
    """Return the environment of a process whose user has a cache folder beside the package."""
    given = {name: os.environ[name] for name in ("PATH", "HOME") if name in os.environ}
    return given | {"XDG_CACHE_HOME": str(small.parent / "cache")}


def run(small, processor="", **environment):
    given = surroundings(small) | environment
    command = [sys.executable, "-B", "-c", RUN, str(small.parent), processor]
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
    assert Path(folder).exists()  # another installation may need it
    assert not list(small.rglob("*.code"))  # pip would leave it behind
    for old in (Path(folder), Path(folder).parent):
        os.utime(old, (0, 0))
    (small / "inner.py").write_text(INNER.format(factor=6.0))
    assert run(small)[:2] == (13.0, 0)
    assert not Path(folder).exists()
    assert Path(other).exists()


def test_machines_that_share_a_home_do_not_share_machine_code(small):
    here, there = run(small), run(small, "generic")
    assert there[:2] == (7.0, 0)
    assert there[2] != here[2]
    assert Path(there[2]).parent == Path(here[2]).parent
    assert run(small) == (7.0, 1, here[2])
    assert run(small, "generic") == (7.0, 1, there[2])
    for folder in here[2], there[2]:
        assert len(list(Path(folder).glob("*.code"))) == 1


@pytest.mark.parametrize(
    "damaged",
    [lambda code: b"", lambda code: code[:20], lambda code: code[:-1], lambda code: code[:99] + b"?" + code[100:]],
    ids=["empty", "shorter than its digest", "shorter by a byte", "a byte that changed"],
)
def test_a_damaged_file_of_machine_code_is_compiled_again(small, damaged):
    folder = Path(run(small)[2])
    for file in folder.iterdir():
        file.write_bytes(damaged(file.read_bytes()))
    assert run(small)[:2] == (7.0, 0)
    assert run(small)[:2] == (7.0, 1)


def test_a_folder_that_is_named_is_taken(small, tmp_path):
    named, older = str(tmp_path / "named"), str(tmp_path / "older")
    assert run(small, NUMBA_CACHE_DIR=older)[2].startswith(older)
    assert run(small, NUMBA_CACHE_DIR=older, BEAMFEM_CACHE_DIR=named)[2].startswith(named)


@pytest.mark.parametrize("home", ["/proc", None])
def test_without_a_place_to_write_work_goes_on(small, tmp_path, home):
    """A file in the place of the folder stands for one that takes no files: permissions do not stop root."""
    (tmp_path / "taken").touch()
    given = {"BEAMFEM_CACHE_DIR": str(tmp_path / "taken")} | ({"HOME": home} if home else {})
    assert run(small, **given) == (7.0, 0, "None")


def test_a_disk_that_is_full_while_compiling_is_no_error(tmp_path, monkeypatch):
    def full(source, to):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(cache, "cache_folder", lambda: tmp_path)
    monkeypatch.setattr(os, "replace", full)
    cache.keep("doubled", b"code")
    assert list(tmp_path.iterdir()) == []
    assert cache.found("doubled") is None


def test_a_user_without_a_home_has_no_folder_there(monkeypatch):
    def nowhere(*names, **options):
        raise RuntimeError("could not determine the home directory for '~/.cache'")

    for name in ("BEAMFEM_CACHE_DIR", "NUMBA_CACHE_DIR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setattr(cache, "user_cache_path", nowhere)
    assert list(cache._parents()) == []


def test_files_that_are_no_sources_are_left_alone(small):
    """Editors leave links to nowhere beside files that are not saved."""
    (small / ".#inner.py").symlink_to("me@host:1")
    (small / "folder.py").mkdir()
    value, _, folder = run(small)
    assert (value, folder) == (7.0, run(small)[2])
    assert folder != "None"


def test_a_folder_that_can_only_be_read_is_read(small):
    folder = Path(run(small)[2])
    prefix = "import small.cache; small.cache.cache_folder = lambda: None\n"
    command = [sys.executable, "-B", "-c", RUN.replace("from small.outer", prefix + "from small.outer", 1)]
    given = surroundings(small)
    done = subprocess.run([*command, str(small.parent), ""], capture_output=True, text=True, check=True, env=given)
    assert done.stdout.split()[:2] == ["7.0", "1"]
    assert folder.exists()


def test_sources_that_change_while_a_process_runs_leave_nothing_behind(small):
    """What they were when they were imported names the folder; what they are when a kernel is compiled is compiled."""
    change = "import pathlib; p = pathlib.Path(sys.argv[1]) / 'small' / 'inner.py'\n"
    change += "p.write_text(p.read_text() + '\\n# changed\\n')\n"
    command = [sys.executable, "-B", "-c", RUN.replace("print(", change + "print(", 1), str(small.parent), ""]
    given = surroundings(small)
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=given)
    assert done.stdout.split()[0] == "7.0"
    folder = Path(done.stdout.split(" ", 2)[2].strip())
    assert not list(folder.glob("*.code"))


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are not forked here")
def test_a_process_that_is_forked_while_another_thread_compiles_goes_on():
    code = (
        "import os, signal, threading, warnings; warnings.simplefilter('ignore')\n"
        "from beamfem.kernels import band, compiling\n"
        "begun, go_on = threading.Event(), threading.Event()\n"
        "def compiles():\n"
        "    with compiling._compiling: begun.set(); go_on.wait(0.3)\n"
        "thread = threading.Thread(target=compiles); thread.start(); begun.wait()\n"
        "child = os.fork()\n"
        "if child == 0: signal.alarm(20); os._exit(0 if band.band(3).solve_lower.address else 1)\n"
        "print(os.waitpid(child, 0)[1]); thread.join()\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60)
    assert done.stdout.strip() == "0"


def test_code_of_users_is_not_kept(tmp_path, monkeypatch):
    """The folder is named by the kernels of the package: what else is compiled may change without changing its name."""
    monkeypatch.setattr(cache, "cache_folder", lambda: tmp_path)

    @compiling.routine("d", "d")
    def doubled(x):
        return 2.0 * x

    assert doubled(3.0) == 6.0
    assert doubled.compiled_here
    assert list(tmp_path.iterdir()) == []


def test_threads_that_need_a_kernel_at_once_compile_it_once():
    calls = []

    @compiling.routine("d", "d")
    def tripled(x):
        return 3.0 * x

    counted = tripled.module
    tripled.module = lambda: calls.append(1) or counted()
    with ThreadPoolExecutor(8) as pool:
        assert list(pool.map(tripled, range(8))) == [3.0 * x for x in range(8)]
    assert calls == [1]


def test_what_is_compiled_comes_from_the_kernels_alone():
    """The content of that folder names the machine code, so that nothing from elsewhere may be inlined."""
    for file in KERNELS.rglob("*.py"):
        for line in file.read_text().splitlines():
            if line.startswith(("from ", "import ")):
                module = line.split()[1]
                assert module.split(".")[0] in PLAIN or module.startswith("beamfem.kernels"), f"{file.name}: {line}"


def test_no_two_kernels_share_a_name():
    """Machine code on disk is found by name. The functions of a band had one name for all half widths: of two processes
    that compiled different ones at once, one wrote its code in the place that the index of the other named, and models
    got the factors of another width."""
    found = {routine.name for half_width in range(20) for routine in band(half_width)}
    for half_width in range(20):
        found |= {routine.name for short in (True, False) for routine in bidirectional_lu(half_width, short)}
    assert len(found) == 3 * 10 + 2 * (10 + 9)
    for nodes in (2, 3):
        inertia.add_inertia.fixed(nodes=nodes, vectors=2, others=4)
    made = [routine for routine in compiling.Routine.made if routine.__module__.startswith("beamfem.kernels")]
    kernels = {(routine.name, _closed_over(routine.function)) for routine in made}  # threads may make one twice
    names = {name for name, _ in kernels}
    assert {f"beamfem.kernels.inertia_forces.add_inertia_nodes_{nodes}_vectors_2" for nodes in (2, 3)} <= names
    assert len(names) == len(kernels)


def _closed_over(function):
    """Return where a function is written, and the numbers that it is specialised for."""
    cells = function.__closure__ or ()
    return function.__code__, tuple(cell.cell_contents for cell in cells if isinstance(cell.cell_contents, int))


@pytest.mark.skipif(os.name != "posix", reason="owners and modes are those of POSIX")
@pytest.mark.parametrize("level", ["file", "folder", "folder above"])
@pytest.mark.parametrize("change", [lambda path: path.chmod(0o777), lambda path: path.chmod(0o775), "owner"])
def test_machine_code_that_others_could_write_is_not_run(small, level, change):
    folder = Path(run(small)[2])
    (code,) = folder.glob("*.code")
    place = {"file": code, "folder": folder, "folder above": folder.parent}[level]
    if change != "owner":
        change(place)
    elif os.geteuid() == 0:
        os.chown(place, 12345, -1)
    else:
        pytest.skip("only root can give a file away")
    value, hits, used = run(small)
    assert (value, hits) == (7.0, 0)
    assert used == (str(folder) if level == "file" else "None")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no FIFOs here")
@pytest.mark.parametrize("make", [os.mkfifo, os.mkdir, lambda path: os.symlink("/dev/zero", path)])
def test_what_is_no_regular_file_is_not_read_as_machine_code(small, make):
    (code,) = Path(run(small)[2]).glob("*.code")
    code.unlink()
    make(code)
    assert run(small)[:2] == (7.0, 0)


@pytest.mark.skipif(os.name != "posix", reason="modes are those of POSIX")
def test_a_lax_umask_does_not_open_the_cache(small):
    before = os.umask(0)
    try:
        folder = Path(run(small)[2])
    finally:
        os.umask(before)
    assert [path.stat().st_mode & 0o022 for path in (folder, folder.parent, *folder.iterdir())] == [0, 0, 0]
    assert run(small)[:2] == (7.0, 1)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="processes are not forked here")
@pytest.mark.parametrize("delay", [0.0, 0.02, 0.1])
def test_a_process_that_is_forked_while_kernels_are_compiled_compiles_its_own(tmp_path, delay):
    """With an empty cache: on Python 3.11 `functools.cached_property` holds a lock of its own meanwhile."""
    code = (
        "import os, signal, threading, time, warnings; warnings.simplefilter('ignore')\n"
        "from beamfem.kernels import band\n"
        "thread = threading.Thread(target=lambda: [band.band(n).solve_lower.address for n in (3, 4, 5, 6)])\n"
        f"thread.start(); time.sleep({delay}); child = os.fork()\n"
        "if child == 0: signal.alarm(20); os._exit(0 if band.band(7).solve_lower.address else 1)\n"
        "print(os.waitpid(child, 0)[1]); thread.join()\n"
    )
    given = os.environ | {"BEAMFEM_CACHE_DIR": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, timeout=60, env=given
    )
    assert done.stdout.strip() == "0"
