"""The command line: cases, tables, files, and what is handed to Snakemake."""

import sys
from pathlib import Path

import pytest

import disc_model as dm
from disc_model import cli
from tests.processes import run

SHORT = "run N=200 Omega=50 n_diameters=1 --t-end 0.05"


class Command:
    """The command line, run in this process."""

    def __init__(self, capsys: pytest.CaptureFixture[str]) -> None:
        self.capsys = capsys

    def run(self, *arguments: str, code: int) -> str:
        """What a command prints, which ends with this exit code."""
        with pytest.raises(SystemExit) as ended:
            cli.main(list(arguments))
        assert int(ended.value.code or 0) == code
        shown = self.capsys.readouterr()
        return shown.out + shown.err

    def out(self, *arguments: str) -> str:
        """What a command prints that must succeed."""
        return self.run(*arguments, code=0)

    def error(self, *arguments: str) -> str:
        """What a command says that must be refused."""
        return self.run(*arguments, code=2)


@pytest.fixture
def command(capsys: pytest.CaptureFixture[str]) -> Command:
    return Command(capsys)


@pytest.mark.parametrize(
    ("line", "code", "said"),
    [
        ("floquet N=-1 Omega=x", 2, "error: N=-1: must be >= 0; Omega='x': must be a number"),
        ("floquet N=1 Omega=1 b", 2, "error: b: must be NAME=VALUE, such as N=385\n"),
        ("floquet N=1 --tool 1", 2, "error: --tool: must be NAME=VALUE"),
        ("floquet N=0 Omega=0", 1, "Nothing ever slips"),
        ("sliding N=0 Omega=0", 1, "The disc is not driven"),
        ("modes b=0.05", 2, "error: r_0=0.1: must be <= b=0.05\n"),
        ("modes disc=none.csv", 2, "none.csv"),
        ("run N=1 Omega=1", 2, "--t-end"),
        ("run N=1 Omega=1 --t-end 1kg", 2, "error: t_end='1kg': must be a number in s"),
        (f"{SHORT} --save x.txt", 2, "error: path='x.txt': must end in .nc"),
        ("run N=1e3 Omega=100 mu_s=20 mu_k=20 k_p=1e6 --t-end 1", 1, "paradox"),
        ("study none.yaml", 2, "error: none.yaml"),
        ("--version", 0, f"disc_model {dm.__version__}"),
    ],
)
def test_what_goes_wrong_is_named(command: Command, line: str, code: int, said: str) -> None:
    assert said in command.run(*line.split(), code=code)


def test_run_agrees_with_simulate(command: Command) -> None:
    out = command.out(
        *["run", "N=385", "Omega=15.1", "--t-end", "0.3", "--tol", "1e-8"], "k_p=15 kN/m"
    )
    result = dm.simulate(dm.Parameters(N=385, Omega=15.1, k_p=1.5e4), 0.3, tol=1e-8)
    assert f"events              {result.statistics['n_events']:.0f}\n" in out
    assert f"key                 {result.parameters.key}" in out


def test_a_run_is_drawn_and_saved(command: Command, tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    options = f"--plot {tmp_path}/run.png --save {tmp_path}/run.nc --csv {folder}"
    command.out(*SHORT.split(), *options.split())
    assert (tmp_path / "run.png").read_bytes().startswith(b"\x89PNG")
    assert dm.Result.load(tmp_path / "run.nc").t_end == 0.05
    assert (tmp_path / "folder" / "events.csv").is_file()


@pytest.mark.compiled
def test_tables_have_the_numbers_of_the_functions(command: Command) -> None:
    case = dm.Parameters(N=385, Omega=15)
    rate = dm.floquet(case).growth_rate
    assert f"growth rate {rate:.6g} 1/s" in command.out("floquet", "N=385", "Omega=15")
    sliding = command.out("sliding", "N=385", "Omega=15")
    for value in dm.steady_sliding(case).eigenvalues.real:
        assert f"{value:.6g}" in sliding
    modes = command.out("modes")
    for omega in [*dm.plate_modes(case)["omega"], *dm.coupled_natural_frequencies(case)]:
        assert f"{omega:.6g}" in modes


def test_pictures_are_files_whatever_a_notebook_has_chosen(tmp_path: Path) -> None:
    picture = tmp_path / "run.png"
    command = [sys.executable, "-m", "disc_model", *SHORT.split(), "--plot", picture]
    run(*command, MPLBACKEND="module://no_such_module.backend")
    assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("end", "code"), [(SystemExit(0), 0), (SystemExit(1), 1), (KeyboardInterrupt(), 130)]
)
def test_a_study_is_handed_to_snakemake(
    command: Command, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, end: BaseException, code: int
) -> None:
    called: list[str] = []

    def snakemake(arguments: list[str]) -> None:
        called.extend(arguments)
        raise end

    monkeypatch.setattr("snakemake.cli.main", snakemake)
    mine = tmp_path / "mine.yaml"
    mine.write_text("{study: s, quantity: floquet, base: {N: 385}, axes: {Omega: [12, 15]}}")
    options = ["-j2", "--unlock", "-d", "folder", "--target", "bench", "-n"]
    command.run("study", str(mine), *options, code=code)
    assert Path(called[called.index("-s") + 1]).is_file()
    assert called[called.index("-d") + 1] == "folder"
    assert {"-j2", "--unlock", "bench", "-n"} <= {*called}
    assert called[-2:] == ["--configfile", str(mine)]
