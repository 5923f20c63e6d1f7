"""The command line: options, summary, plot."""

import re
import sys
from pathlib import Path

import pytest

import disc_model
from disc_model import Parameters, cli, simulate
from disc_model.cli import option_name
from disc_model.stability.sliding import sliding_modes
from tests.processes import run

BASE = ("--N", "385", "--Omega", "15.1")
SMALL_BASE = ("--N", "200", "--Omega", "50", "--n-diameters", "1")
SHORT = ("run", *SMALL_BASE, "--t-end", "0.05")


class Command:
    """The command line, run in this process."""

    def __init__(self, capsys: pytest.CaptureFixture[str]) -> None:
        self.capsys = capsys

    def run(self, *arguments: str) -> tuple[int, str, str]:
        """Exit code, stdout and stderr."""
        with pytest.raises(SystemExit) as ended:
            cli.main(list(arguments))
        shown = self.capsys.readouterr()
        return int(ended.value.code or 0), shown.out, shown.err

    def out(self, *arguments: str) -> str:
        """What a command prints that must succeed."""
        code, out, _ = self.run(*arguments)
        assert code == 0
        return out

    def error(self, *arguments: str) -> str:
        """What a command says that must be refused: one line, with exit code 2."""
        code, out, err = self.run(*arguments)
        assert code == 2
        assert out == ""
        assert err.startswith("error: ")
        assert err.count("\n") == 1
        return err


@pytest.fixture
def command(capsys: pytest.CaptureFixture[str]) -> Command:
    return Command(capsys)


def test_every_option_reaches_the_parameters(command: Command) -> None:
    """A bad value given to each option comes back in the one message, under the parameter's
    name."""
    names = Parameters.model_fields.keys() - {"disc"}
    err = command.error(
        "run", *(part for name in names for part in (option_name(name), "bad")), "--t-end", "1"
    )
    for name in names:
        assert f"{name}='bad'" in err


def test_help_shows_units_defaults_choices_and_the_version(
    command: Command, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    out = command.out("run", "--help")
    for part in ("(N m s)", "as_published|orthonormal", "unilateral|bilateral"):
        assert part in out
    assert re.findall(r"╭─ ([\w ]+) ─", out) == ["Options", "Case"]
    out = command.out()
    assert out == command.out("--help")
    for name in ("run", "floquet", "modes", "study", "--install-completion"):
        assert name in out
    assert command.out("--version") == f"disc_model {disc_model.__version__}\n"


def test_run_agrees_with_simulate(command: Command) -> None:
    code, out, err = command.run("run", *BASE, "--t-end", "0.3", "--k-p", "1.5e4", "--tol", "1e-8")
    assert code == 0
    assert err == ""
    parts = (
        "status              ok",
        "first separation    none",
        "stick_to_slip",
        "time in slip",
        "wall time",
    )
    for part in (*parts, "energy residual"):
        assert part in out
    result = simulate(Parameters(N=385, Omega=15.1, k_p=1.5e4), 0.3, tol=1e-8)
    assert f"events              {result.statistics['events']}\n" in out
    assert f"key                 {result.parameters.key}" in out


def test_module_runs_as_a_program() -> None:
    done = run(sys.executable, "-m", "disc_model", "modes", "--b", "0.05", fails=True)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr == "error: r_0=0.1: must be <= b=0.05\n"


def test_the_heads_of_modes_are_whole_in_80_columns(
    command: Command, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    table = disc_model.Disc(
        diameters=[0, 12], omega=[9_876.543, 98_765.432], amplitude=[1.23456, 12.3456]
    )
    path = tmp_path / "disc.csv"
    table.to_csv(path)
    out = command.out("modes", "--disc", str(path), "--r-0", "0.11")
    assert "…" not in out
    for word in ("amplitude", "98765.432", "12.346", "damping"):
        assert word in out


def test_modes_tell_which_slider_is_at_rest_on_the_disc(command: Command) -> None:
    """A slider that nobody had given was not said."""
    assert "(slider of 100 g on 50 kN/m)" in command.out("modes")
    lighter = command.out("modes", "--m", "0.02", "--k", "2e4")
    assert "(slider of 20 g on 20 kN/m)" in lighter


@pytest.mark.compiled
def test_floquet_says_whether_the_quiet_motion_lasts(command: Command) -> None:
    rate = disc_model.floquet(Parameters(N=385, Omega=15)).growth_rate
    out = command.out("floquet", "--N", "385", "--Omega", "15")
    assert f"growth rate         {rate:.6g} 1/s (small disturbances die out)" in out
    code, out, _ = command.run("floquet", "--N", "0", "--Omega", "0")
    assert code == 1
    assert "advice" in out
    assert "steady sliding      The disc is not driven" in out  # a growth rate of nan was printed


def test_sliding_prints_the_modes_in_the_slider_s_frame(command: Command) -> None:
    p = Parameters(N=200, Omega=20)
    out = command.out("sliding", "--N", "200", "--Omega", "20")
    modes = sliding_modes(p, disc_model.steady_sliding(p))
    for frequency in modes.frequency:
        assert f"{frequency:.4f}" in out
    assert out.count("in the plane") == (modes.diameters < 0).sum() == 1
    code, out, _ = command.run("sliding", "--N", "0", "--Omega", "0")
    assert code == 1
    assert "The disc is not driven" in out


def test_a_run_is_drawn_and_saved_and_one_that_does_not_end_is_told(
    command: Command, tmp_path: Path
) -> None:
    run_path = tmp_path / "run.png"
    picture = str(run_path)
    run_file = tmp_path / "run.nc"
    file = str(run_file)
    out = command.out(*SHORT, "--plot", picture, "--save", file)
    assert f"saved               {file}\nfigure              {picture}\n" in out
    assert Path(picture).read_bytes().startswith(b"\x89PNG")
    assert disc_model.Result.load(file).t_end == 0.05
    assert "must be the name of a file" in command.error(*SHORT, "--save", str(tmp_path))
    steep = ("--N", "1e3", "--Omega", "100", "--mu-s", "20", "--mu-k", "20", "--k-p", "1e6")
    code, out, _ = command.run("run", *steep, "--t-end", "1")
    assert code == 1
    assert "status              paradox" in out


@pytest.mark.parametrize(
    ("option", "name", "rule"),
    [
        ("--csv", "/dev/null", "must be the name of a folder: File exists"),
        ("--save", "x.txt", "must end in .nc"),
        ("--save", "/dev/null", "must be the name of a file"),
        ("--save", "no/x.nc", "must be the name of a file in a folder that exists"),
        ("--save", f"{'x' * 300}.nc", "must be the name of a file: File name too long"),
        ("--plot", "x.txt", "must end in one of "),
        ("--plot", "no/x.png", "must be the name of a file in a folder that exists"),
    ],
)
def test_a_file_that_cannot_be_written_is_refused_before_the_simulation(
    command: Command,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    option: str,
    name: str,
    rule: str,
) -> None:
    """The suffix was looked at after it."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(
        "disc_model.simulation.api.simulate", lambda *_, **__: pytest.fail("it runs")
    )
    err = command.error(*SHORT, option, name)
    assert re.search(rf"{option.strip('-')}='.*: {re.escape(rule)}", err)


@pytest.mark.parametrize(
    "backend",
    ["module://matplotlib_inline.backend_inline", pytest.param("unknown", marks=pytest.mark.slow)],
)
def test_a_backend_of_a_notebook_does_not_matter(tmp_path: Path, backend: str) -> None:
    """Matplotlib refused it, and the name of the picture was blamed."""
    picture = tmp_path / "run.png"
    options = [sys.executable, "-m", "disc_model", *SHORT, "--plot", picture]
    run(*options, MPLBACKEND=backend)
    assert picture.read_bytes().startswith(b"\x89PNG")


STUDY = (Path(__file__).parent / "workflow" / "studies" / "braces.yaml").read_text()


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    """A study of one's own."""
    path = tmp_path / "mine.yaml"
    path.write_text(STUDY)
    return path


@pytest.fixture
def called(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What Snakemake is called with, instead of calling it."""
    told: list[str] = []
    monkeypatch.setattr("snakemake.cli.main", told.extend)
    return told


def test_a_study_is_handed_to_snakemake(command: Command, called: list[str], mine: Path) -> None:
    folder = str(mine.parent)
    options = ("--cores", "2", "--unlock", "--directory", folder, "--target", "bench")
    command.out("study", str(mine), *options, "-n")
    assert Path(called[called.index("-s") + 1]).is_file()
    assert called[-2:] == ["--configfile", str(mine)]
    assert {"-j2", "--unlock", "bench", "--dry-run", "--directory", folder} <= {*called}


def test_a_wrong_study_is_told_before_snakemake_starts(
    command: Command, called: list[str], mine: Path
) -> None:
    """With one fault a line, as Snakemake shows them."""
    mine.write_text(STUDY.replace("mu_k: [0.1, 0.2]", "mu: [1]").replace("floquet", "flo"))
    code, out, err = command.run("study", str(mine))
    head, *faults = err.splitlines()
    assert code == 2
    assert out == ""
    assert head == f"error: {mine}: 2 faults"
    assert [fault.split(":")[0] for fault in faults] == ["  quantity='flo'", "  axes.mu"]
    assert called == []


def test_the_exit_code_of_snakemake_is_passed_on(
    command: Command, monkeypatch: pytest.MonkeyPatch, mine: Path
) -> None:
    def fails(arguments: list[str]) -> None:
        sys.exit(1)

    def interrupted(arguments: list[str]) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("snakemake.cli.main", fails)
    assert command.run("study", str(mine), "-d", str(mine.parent)) == (1, "", "")
    monkeypatch.setattr("snakemake.cli.main", interrupted)
    code, _, err = command.run("study", str(mine), "-d", str(mine.parent))
    assert code == 130
    assert err.split()[-1] == "interrupted"


def test_pictures_are_files_whatever_a_notebook_has_chosen(tmp_path: Path) -> None:
    """A kernel in another environment chooses a module that is not here."""
    picture = tmp_path / "run.png"
    notebook = {"MPLBACKEND": "module://no_such_module.backend"}
    run(sys.executable, "-m", "disc_model", *SHORT, "--plot", picture, **notebook)
    assert picture.read_bytes().startswith(b"\x89PNG")
