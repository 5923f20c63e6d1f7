"""Branches of the cycle that the published start follows: connected points at which it goes on from one to the next."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

LARGE = 0.02
"""Share of a map's points from which on a branch is named."""
NAMES = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"

Mask = NDArray[np.bool_]


def branches(followed: Mask, up: Mask, right: Mask) -> NDArray[np.int64]:
    """Number of the branch at each point, the largest 0; -1 where no cycle is followed: shape (rows, columns).

    up, right : whether the cycle goes on into the point of the next row, or column; shape (rows, columns)
    """
    number = np.arange(followed.size).reshape(followed.shape)
    here = np.concatenate([number[:-1][up[:-1]], number[:, :-1][right[:, :-1]]])
    there = np.concatenate([number[1:][up[:-1]], number[:, 1:][right[:, :-1]]])
    graph = coo_array((np.ones(len(here)), (here, there)), shape=(followed.size,) * 2)
    _, labels = connected_components(graph, directed=False)
    sizes = np.bincount(labels[followed.ravel()], minlength=labels.max() + 1)
    rank = np.empty_like(sizes)
    rank[np.argsort(-sizes, kind="stable")] = np.arange(len(sizes))
    return np.where(followed, rank[labels].reshape(followed.shape), -1)


def named(labels: NDArray[np.int64]) -> Iterator[tuple[str, int, int]]:
    """Names of the large branches, the largest A, each with row and column of the point nearest to its middle."""
    for label, name in enumerate(NAMES):
        places = np.argwhere(labels == label)
        if len(places) < LARGE * labels.size:
            return
        row, column = places[np.argmin(np.sum((places - places.mean(axis=0)) ** 2, axis=1))]
        yield name, int(row), int(column)
