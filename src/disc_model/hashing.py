"""Names by content: one text for equal values, and its hash."""

import hashlib
import json
import math
from collections.abc import Mapping
from typing import Any


def content_key(text: str) -> str:
    """First 12 hexadecimal digits of the sha256 of a text."""
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def canonical_json(value: Any) -> str:
    """JSON with sorted keys; infinities as text, since JSON has none; -0.0 as 0.0."""

    def plain(item: Any) -> Any:
        if isinstance(item, float):
            return item + 0.0 if math.isfinite(item) else str(item)
        if isinstance(item, list | tuple):
            return [plain(value) for value in item]
        if isinstance(item, Mapping):
            return {str(key): plain(value) for key, value in item.items()}
        return item

    return json.dumps(plain(value), sort_keys=True, separators=(",", ":"), allow_nan=False)
