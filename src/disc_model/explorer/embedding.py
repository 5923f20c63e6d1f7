"""Pictures within the explorer's page."""

import base64
import io
from pathlib import Path

from PIL import Image, ImageOps

PICTURE_WIDTH = 1100  # width of a page-wide figure, pixels; narrower ones are scaled alike
PAGE_WIDTH = 2055  # width of such a figure as drawn, pixels
QUALITY = 80


def embedded(file: Path) -> str:
    """A picture, reduced in size, as a data URL."""
    with Image.open(file) as picture:
        small = ImageOps.scale(
            picture.convert("RGB"), PICTURE_WIDTH / PAGE_WIDTH, Image.Resampling.LANCZOS
        )
    buffer = io.BytesIO()
    small.save(buffer, "WEBP", quality=QUALITY, method=6)
    return f"data:image/webp;base64,{base64.b64encode(buffer.getvalue()).decode('ascii')}"
