"""Who makes the calls of a sweep or of a study: this thread, threads, processes, or an executor of
the user's, such as that of a cluster."""

from __future__ import annotations

import pickle
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from dataclasses import dataclass
from typing import Any

from disc_model.display import progress_bar
from disc_model.errors import Fault, ParameterError, require
from disc_model.units import is_whole


@dataclass(frozen=True)
class Workers:
    """Who makes calls that do not depend on each other; `checked_workers` makes it.

    Attributes
    ----------
    number : calls at a time, if there is no executor
    processes : whether they are made in processes of their own instead of threads
    executor : an object with the method `submit` of `concurrent.futures.Executor`, or with `map`
    progress : whether a bar on standard error shows how many calls are done
    """

    number: int
    processes: bool
    executor: Any
    progress: bool

    def results(
        self, call: Callable[[Any], Any], arguments: Sequence[Any], title: str
    ) -> list[Any]:
        """Return the results of a call for each argument, in their order.

        An error of a call ends all, and calls that have not begun are not made.

        Parameters
        ----------
        call : takes one argument
        arguments : what the calls are given
        title : stands beside the bar

        Raises
        ------
        ParameterError
            If the call cannot be sent to a process.
        """
        results = []
        with progress_bar(title, len(arguments), self.progress) as bar:
            for result in self._in_order(call, arguments):
                results.append(result)
                bar.advance()
        return results

    def _in_order(self, call: Callable[[Any], Any], arguments: Sequence[Any]) -> Iterator[Any]:
        """Yield the result for each argument as soon as those before it are there."""
        if self.executor is not None:
            yield from _results_of(self.executor, call, arguments)
        elif self.number == 1:
            yield from map(call, arguments)
        elif self.processes:
            _check_importable(call)
            with ProcessPoolExecutor(self.number) as pool:
                yield from _results_of(pool, call, arguments)
        else:
            with ThreadPoolExecutor(self.number) as pool:
                yield from _results_of(pool, call, arguments)


def checked_workers(workers: Any, processes: Any, executor: Any, progress: Any) -> Workers:
    """The workers that these arguments of `sweep` describe; raises `ParameterError`."""
    methods = [getattr(executor, name, None) for name in ("submit", "map")]
    usable = executor is None or any(callable(method) for method in methods)
    usable = usable and not isinstance(executor, type)
    alone = executor is None or (workers == 1 and not processes)
    require(
        (is_whole(workers) and workers >= 1, "workers", workers, "must be a whole number >= 1"),
        (isinstance(processes, bool), "processes", processes, "must be True or False"),
        (isinstance(progress, bool), "progress", progress, "must be True or False"),
        (usable, "executor", executor, "must have the method submit of concurrent.futures, or map"),
        (alone, "executor", executor, "takes the place of workers and processes: leave them out"),
    )
    return Workers(workers, processes, executor, progress)


def _results_of(
    executor: Any, call: Callable[[Any], Any], arguments: Sequence[Any]
) -> Iterator[Any]:
    """Yield the results of calls that an executor makes, in order."""
    if not hasattr(executor, "submit"):
        yield from executor.map(call, arguments)
        return
    waiting = deque(executor.submit(call, argument) for argument in arguments)
    try:
        while waiting:
            yield waiting[0].result()
            waiting.popleft()
    finally:
        for future in waiting:
            future.cancel()


def _check_importable(call: Callable[[Any], Any]) -> None:
    """Raise `ParameterError` if a call cannot be sent to another process."""
    try:
        pickle.dumps(call)
    except (pickle.PicklingError, AttributeError, TypeError) as error:
        rule = f"needs a function that other processes can import ({error})"
        raise ParameterError(Fault.of(("processes",), True, rule)) from None
