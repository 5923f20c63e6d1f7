"""Build a wheel with compiled kernels, for processors of the levels in `disc_model.engine.cache`."""

import os
import shutil
import subprocess
import sys
import sysconfig
import tempfile
from collections.abc import Iterable
from pathlib import Path

from disc_model.engine.cache import LEVELS, SHIPPED, VERSIONS, versions
from disc_model.kernels import USUAL

ROOT = Path(__file__).resolve().parents[2]


def compile_kernels(level: str, target: Path, kinds: Iterable[str] = USUAL) -> None:
    """Compile kinds of kernels into the folder of a level."""
    features, _ = LEVELS[level]
    with tempfile.TemporaryDirectory() as folder:
        chosen = {"NUMBA_CACHE_DIR": folder, "NUMBA_CPU_NAME": level, "NUMBA_CPU_FEATURES": features}
        subprocess.run([sys.executable, "-m", "disc_model", "compile", *kinds], env=os.environ | chosen, check=True)
        target.mkdir(parents=True)
        for path in Path(folder).rglob("*.kernel"):
            shutil.move(path, target)
    (target / VERSIONS).write_text(versions(), encoding="utf-8")
    files = list(target.glob("*.kernel"))
    print(f"{level}: {len(files)} kernels, {sum(path.stat().st_size for path in files) / 1e6:.2f} MB")


def main() -> None:
    try:
        for level in LEVELS:
            compile_kernels(level, SHIPPED / level)
        tags = (f"--python-tag=cp{sys.version_info[0]}{sys.version_info[1]}", f"--plat-name={sysconfig.get_platform()}")
        options = [f"--config-setting=--build-option={tag}" for tag in tags]
        build = [sys.executable, "-m", "build", "--wheel", "--no-isolation", *options]
        subprocess.run([*build, "--outdir", ROOT / "dist", ROOT], check=True)
    finally:
        shutil.rmtree(SHIPPED, ignore_errors=True)


if __name__ == "__main__":
    main()
