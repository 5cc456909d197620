"""Properties that are computed once."""

from concurrent.futures import ThreadPoolExecutor
from threading import Barrier

from beamfem.cached_properties import cached_property


class Slow:
    def __init__(self, threads: int) -> None:
        self.together, self.made = Barrier(threads), list[object]()

    @cached_property
    def value(self) -> object:
        """A new object, which all threads make at the same time."""
        self.together.wait(timeout=10.0)
        self.made.append(object())
        return self.made[-1]


def test_threads_that_compute_a_value_at_once_get_the_same_one():
    slow = Slow(2)
    with ThreadPoolExecutor(2) as pool:
        one, other = pool.map(lambda _: slow.value, range(2))
    assert len(slow.made) == 2
    assert one is other is slow.value


def test_the_class_has_the_property_itself_and_its_docstring():
    assert isinstance(Slow.value, cached_property)
    assert Slow.value.__doc__.startswith("A new object")
