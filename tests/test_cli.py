"""The command line: options, summary, plot."""

import inspect
import logging
import os
import re
import sys
from pathlib import Path

import pytest
import snakemake.cli
import snakemake.workflow

import disc_model
from disc_model import Parameters, cli, simulate
from disc_model.cli import option_name
from disc_model.stability.sliding_modes import sliding_modes
from disc_model.studies.study import load_study
from tests.figures.made_up import campbell_study
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
    for name in ("run", "floquet", "modes", "study", "init", "--install-completion"):
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
    assert re.fullmatch(r"kernels compiled and cached: \d+\.\d s\n", command.out("compile"))
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


def test_events_are_written_as_text_and_a_dataset_in_another_format(
    command: Command, tmp_path: Path
) -> None:
    file = tmp_path / "run.nc"
    new_path = tmp_path / "new"
    out = command.out(*SHORT, "--csv", str(new_path), "--save", str(file))
    events_path = tmp_path / "new" / "events.csv"
    assert f"saved               {events_path}\n" in out
    assert events_path.read_text().startswith("time (s),kind,phase,")
    target = tmp_path / "run.mat"
    assert command.out("convert", str(file), str(target)) == f"saved               {target}\n"
    assert disc_model.load(target).identical(disc_model.load(file))
    assert "must end in .nc or .mat or .csv" in command.error("convert", str(file), "x.txt")
    assert "there is no such file" in command.error("convert", "none.nc", str(target))


def test_a_grid_is_converted_to_a_table(command: Command, tmp_path: Path) -> None:
    """Only the events and samples of a run could be written as text."""
    case = disc_model.Parameters(N=200, Omega=50, n_diameters=1)
    file = tmp_path / "grid.nc"
    disc_model.save(disc_model.sweep(disc_model.steady_sliding, case, N=[150, 200]), file)
    target = tmp_path / "grid.csv"
    command.out("convert", str(file), str(target))
    assert target.read_text().startswith("N (N),status,message,")


def test_one_of_several_tables_is_chosen(command: Command, tmp_path: Path) -> None:
    """Such a dataset was refused, with advice that is none for a terminal."""
    file = tmp_path / "campbell.nc"
    disc_model.save(campbell_study(), file)
    target = tmp_path / "crossings.csv"
    said = command.error("convert", str(file), str(target))
    assert "crossing_frequency" in said
    advice = said.split("; choose one, such as ")[1].split()
    assert advice[0] == "--variables"
    command.out("convert", str(file), str(target), "--variables", advice[1])
    head, *rows = target.read_text().splitlines()
    assert "crossing_frequency" in head
    assert len(rows) == 3
    assert advice[2:4] == ["or", "--variables"]
    command.out("convert", str(file), str(target), "--variables", advice[4])
    assert "growth_rate (s-1)" in target.read_text().splitlines()[0]
    assert "or the folder tables/" in said
    command.out("convert", str(file), f"{tmp_path}/tables/")
    assert (tmp_path / "tables" / "crossing.csv").exists()
    some = ("--variables", "growth_rate, stick_slip_frequency")
    command.out("convert", str(file), str(target), *some)
    assert target.read_text().startswith("Omega (rad s-1),growth_rate (s-1),stick_slip_frequency")
    said = command.error("convert", str(file), str(target), "--variables", "growth_rat")
    assert (
        "variables='growth_rat': is no variable of the dataset, did you mean growth_rate?" in said
    )


def test_a_file_of_groups_has_no_variables_to_choose(command: Command, tmp_path: Path) -> None:
    file = tmp_path / "run.nc"
    command.out(*SHORT, "--save", str(file))
    said = command.error("convert", str(file), str(tmp_path / "run.csv"))
    assert "must be one group to be a table" in said
    said = command.error("convert", str(file), str(tmp_path / "x.nc"), "--variables", "t_end")
    assert "has groups" in said


@pytest.mark.parametrize(
    ("option", "name", "rule"),
    [
        ("--csv", "/dev/null", "must be a folder, and is a file"),
        ("--save", "x.txt", "must end in .nc or .mat"),
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


@pytest.mark.parametrize("words", [("study",), ("list", "cases")])
def test_a_missing_study_is_told_in_one_line(command: Command, words: tuple[str, ...]) -> None:
    assert command.error(*words, "none.yaml") == "error: none.yaml: there is no such file\n"


STUDY = (Path(__file__).parent / "workflow" / "studies" / "braces.yaml").read_text()


@pytest.fixture
def mine(tmp_path: Path) -> Path:
    """A study of one's own."""
    path = tmp_path / "mine.yaml"
    path.write_text(STUDY)
    return path


@pytest.mark.parametrize(
    ("what", "parts"),
    [
        ("studies", ("mine", "floquet", "mu_s x mu_k", "4")),
        ("figures", ("growth", "heat_map", "seen", "history")),
        ("cases", ("A", "one case", "μ_k = 0.2", "1")),
    ],
)
def test_what_a_study_has_is_listed(
    command: Command, monkeypatch, mine: Path, what: str, parts: tuple
) -> None:
    monkeypatch.setenv("COLUMNS", "200")
    out = command.out("list", what, str(mine))
    for part in parts:
        assert part in out


def test_a_folder_is_laid_out_and_its_study_is_right(command: Command, tmp_path: Path) -> None:
    folder = tmp_path / "my own"
    assert f"cd '{folder}' && disc-model study my_study.yaml" in command.out("init", str(folder))
    study = load_study(folder / "my_study.yaml")
    assert study.grid is not None
    assert study.grid.n_points == 143
    assert (folder / "profiles" / "default" / "config.yaml").is_file()
    err = command.error("init", str(folder))
    assert "must not hold my_study.yaml, Snakefile, profiles/default/config.yaml yet" in err
    err = command.error("init", str(folder / "Snakefile"))  # a file
    assert "cannot be written (File exists)" in err


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


def test_a_dry_run_says_what_there_is_to_compute_and_by_which_options(
    command: Command, called: list[str], mine: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "160")
    options = ("--directory", str(mine.parent), "-j2", "-n")
    out = command.out("study", str(mine), *options)
    assert re.search(r"│ mine +│ floquet +│ 4 +│ 1 +│ less than 1 s │", out)
    assert re.search(r"│ mine +│ simulation +│ 1 +│ 1 +│ less than 1 s │", out)
    assert re.search(r"│ tol +│ 1e-12 +│ +│ tolerance of cycles", out)
    assert re.search(r"Estimated time: [\d.]+ s on 2 cores, to a factor of three", out)
    assert "less than 1 s on 2 cores" not in out  # a run of seconds by the start of its jobs
    folder = mine.parent / "results" / "mine" / "batches"
    folder.mkdir(parents=True)
    (folder / f"{next(iter(load_study(mine).grid.batches))}.nc").touch()  # type: ignore[union-attr]
    out = command.out("study", str(mine), *options)
    assert re.search(r"│ mine +│ floquet +│ 4 +│ 1, of which 1 is computed", out)
    assert len(called) > 0
    assert "plan of" not in command.out("study", str(mine), "--directory", str(mine.parent))


def test_a_folder_that_cannot_hold_results_is_refused(
    command: Command, called: list[str], mine: Path
) -> None:
    """Each ended in a traceback of Snakemake."""
    folders = {
        mine: "must be a folder, and is a file",
        mine / "below": "cannot be written (Not a directory)",
        mine.parent / ("x" * 300): "cannot be written (File name too long)",
    }
    for folder, rule in folders.items():
        err = command.error("study", str(mine), "--directory", str(folder))
        assert err == f"error: directory={str(folder)!r}: {rule}\n"
    assert called == []


def test_a_cache_is_found_where_there_is_no_home(
    command: Command, called: list[str], mine: Path, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """Snakemake ended in a traceback about its cache."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "own"))
    command.out("study", str(mine), "--directory", str(tmp_path))
    assert os.environ["XDG_CACHE_HOME"] == str(tmp_path / "own")
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    monkeypatch.setattr("platformdirs.user_cache_path", lambda *_: tmp_path / "file" / "cache")
    err = command.error("study", str(mine), "--directory", str(tmp_path))
    assert "must be a folder that can be written, because Snakemake keeps its cache there" in err
    assert len(called) > 0


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


@pytest.mark.parametrize(
    ("code", "options", "says"),
    [
        (0, ["--target", "explorer"], True),
        (1, ["--target", "explorer"], False),
        (0, ["--target", "explorer", "--unlock"], False),
        (0, ["--target", "gc"], False),
    ],
)
def test_the_page_of_all_points_is_named_where_it_was_made(
    command: Command,
    monkeypatch: pytest.MonkeyPatch,
    mine: Path,
    code: int,
    options: list[str],
    says: bool,
) -> None:
    """Nobody said where it is."""

    def ends(arguments: list[str]) -> None:
        sys.exit(code)

    monkeypatch.setattr("snakemake.cli.main", ends)
    found = command.run("study", str(mine), "-d", str(mine.parent), *options)
    page = mine.parent / "results" / mine.stem / "explorer.html"
    assert found[:2] == (code, f"explorer: {page}\n" if says else "")


@pytest.mark.parametrize("code", [0, 1])
def test_a_study_that_was_made_says_where_its_results_are(
    command: Command, monkeypatch: pytest.MonkeyPatch, mine: Path, code: int
) -> None:
    """The last words were those of Snakemake, on its log and the time."""
    folder = mine.parent / "results" / mine.stem
    (folder / "figures").mkdir(parents=True)
    (folder / f"{mine.stem}.nc").touch()
    for name in ("growth.png", "growth.pdf"):
        (folder / "figures" / name).touch()

    def ends(arguments: list[str]) -> None:
        sys.exit(code)

    monkeypatch.setattr("snakemake.cli.main", ends)
    found = command.run("study", str(mine), "-d", str(mine.parent))
    says = f"results: {folder} ({mine.stem}.nc, figures/growth.png)\n"
    assert found[:2] == (code, "" if code else says)


@pytest.mark.parametrize("older", ["mine.nc", "figures/growth.png"])
def test_a_run_says_that_it_leaves_an_older_page_of_all_points(
    command: Command, monkeypatch: pytest.MonkeyPatch, mine: Path, older: str
) -> None:
    """A page of former values stayed without a word."""

    def ends(arguments: list[str]) -> None:
        sys.exit(0)

    monkeypatch.setattr("snakemake.cli.main", ends)
    folder = mine.parent / "results" / mine.stem
    made = ["mine.nc", "figures/growth.png", "explorer.html"]
    for time, name in enumerate(made):
        _touched(folder / name, time)
    ran = ["study", str(mine), "-d", str(mine.parent)]
    assert "explorer.html" not in command.out(*ran)
    _touched(folder / older, len(made))
    remedy = f"disc-model study {mine} --directory {mine.parent} --target explorer"
    page = folder / "explorer.html"
    said = f"{page} is of an older state of the study; to make it anew: {remedy}"
    assert command.out(*ran).splitlines()[-1] == said
    assert "older state" not in command.out(*ran, "--target", "explorer")


def _touched(file: Path, time: float) -> None:
    """Make a file, and set its time."""
    file.parent.mkdir(parents=True, exist_ok=True)
    file.touch()
    os.utime(file, (time, time))


def test_pictures_are_files_whatever_a_notebook_has_chosen(tmp_path: Path) -> None:
    """A kernel in another environment chooses a module that is not here."""
    picture = tmp_path / "run.png"
    notebook = {"MPLBACKEND": "module://no_such_module.backend"}
    run(sys.executable, "-m", "disc_model", *SHORT, "--plot", picture, **notebook)
    assert picture.read_bytes().startswith(b"\x89PNG")


def test_the_advice_to_look_at_times_of_files_alone_is_not_passed_on() -> None:
    """`disc-model study -n` ended with advice of Snakemake by which stale results would stay."""
    said = inspect.getsource(snakemake.workflow.Workflow.log_provenance_info)
    advice = "use the command line option '--rerun-triggers mtime' (also see --help)."
    assert "--rerun-triggers mtime" in said, "Snakemake has other words now"
    for text, kept in ((advice, False), ("Job stats:", True)):
        record = logging.LogRecord("snakemake.logging", logging.INFO, "", 0, text, (), None)
        assert cli._is_told(record) == kept


@pytest.mark.parametrize("text", cli.NOT_TOLD[1:])
def test_how_snakemake_is_set_up_is_not_told(text: str) -> None:
    """Such lines stood between the tables of a plan and its end."""
    logging_parts = (snakemake.workflow.Workflow, snakemake.api.DAGApi)
    said = "".join(map(inspect.getsource, logging_parts))
    assert text in said, "Snakemake has other words now"
    record = logging.LogRecord("snakemake.logging", logging.INFO, "", 0, f"{text}.", (), None)
    assert not cli._is_told(record)


def test_batches_of_a_plan_say_how_many_are_computed() -> None:
    """A plan had "1, 1 there"."""
    assert cli._batches_text(4, 0) == "4"
    assert cli._batches_text(1, 1) == "1, of which 1 is computed"
    assert cli._batches_text(4, 3) == "4, of which 3 are computed"
