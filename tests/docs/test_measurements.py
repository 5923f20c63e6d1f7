"""The page on measurements says what the comparisons give."""

import hashlib
import math
import re

import numpy as np
import pytest
from docs.measurements import load, report, resonances, robustness, signals, stick_slip, wheel
from docs.measurements.signals import LEAST_FALLS

import disc_model as dm

PAGE = report.PAGE.read_text(encoding="utf-8")
SENTENCES = " ".join(PAGE.split())
NUMBER = re.compile(r"\d+(?:\.\d+)?")
QUICK = [name for name in report.SECTIONS if name != "spread"]
CALIBRATION = stick_slip.name(stick_slip.CALIBRATION)
PAGES = ("measurements.md", "findings.md", "note.md", "../README.md")
"""Pages that sum up the comparisons."""


def check_table(name: str) -> None:
    """The same words, and numbers to two units of their last digits: three are shown."""
    found = report.marked(name).search(PAGE)
    assert found is not None
    shown = found[0]
    computed = report.SECTIONS[name]()
    assert NUMBER.sub("", shown) == NUMBER.sub("", computed)
    numbers = [np.array(NUMBER.findall(text), dtype=float) for text in (shown, computed)]
    # errors of shapes, from 0.028 on, are shown with three decimals
    assert numbers[0] == pytest.approx(numbers[1], rel=0.02, abs=1e-3)


def span(values: list[float], form: str = ".2f") -> str:
    """Return the least and the largest value as the page says them."""
    least = min(values)
    greatest = max(values)
    return f"{least:{form}} to {greatest:{form}}"


def said_on(name: str) -> str:
    """Return the text of a page of the documentation without its line breaks."""
    return " ".join((report.DOCS / name).read_text(encoding="utf-8").split())


def fastest() -> list[tuple[int, int]]:
    """Return the runs at the highest speed."""
    return [run for run in stick_slip.runs() if run[1] == stick_slip.FASTEST]


@pytest.fixture(scope="module")
def ratios() -> dict[float, list[robustness.Ratio]]:
    return robustness.ratios()


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
@pytest.mark.parametrize("name", QUICK)
def test_tables_of_the_page_are_computed(name: str) -> None:
    check_table(name)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
def test_the_spread_of_slips_is_computed() -> None:
    check_table("spread")
    agreeing = []
    for least_fall in LEAST_FALLS:
        agreeing.append([each.what for each in stick_slip.spreads(least_fall) if each.agrees])
    assert agreeing[0] == agreeing[1]
    assert agreeing[1] == agreeing[2]
    assert len(agreeing[0]) == 4
    assert "in that run, it agrees in four:" in SENTENCES
    medians = stick_slip.medians()
    agree = agreeing[0]
    falls = [each.ratio for each in medians["fall"] if each.what in agree]
    assert f"medians of the same falls are {span(falls)} times too large" in SENTENCES


def test_the_spread_of_slips_agrees_more_often_if_it_is_carried_over() -> None:
    for least_fall in LEAST_FALLS:
        carried = stick_slip.carried_spreads(least_fall)
        assert len(carried) == 7
        assert [each.what for each in carried if not each.agrees] == ["168 N/m, 42 µm/s"]
    carried = stick_slip.carried_spreads()
    said = f"{carried[0].predicted:.4f}, agrees as it is in six of seven runs"
    assert said in SENTENCES
    ratios = [f"{each.ratio:.2f}" for each in carried]
    assert ratios == ["2.42", "1.29", "1.14", "1.23", "1.14", "1.27", "0.77"]


def test_cells_that_fitted_numbers_make_are_marked() -> None:
    """The calibrating run's own row in each table that predicts from its friction."""
    marks = {"slips": ["fitted"] * 2, "thresholds": ["fitted"] * 2}
    for name, expected in marks.items():
        shown = report.marked(name).search(PAGE)
        assert shown is not None
        row = next(line for line in shown[0].splitlines() if f"| {CALIBRATION} |" in line)
        cells = [cell.strip() for cell in row.split("|")]
        assert [cell for cell in cells if cell in expected] == expected, name
    shown = report.marked("spread").search(PAGE)
    assert shown is not None
    assert CALIBRATION not in shown[0]
    # by the constants that were found from it, its force before a slip is the measured one
    identical = stick_slip.friction()[0]
    assert stick_slip.force_before(stick_slip.CALIBRATION) == pytest.approx(identical, abs=1e-4)


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
def test_the_picture_shows_no_fitted_number_as_predicted() -> None:
    figure = report.draw_slips()
    predicted = []
    for axis in figure.axes:
        diamonds = [line for line in axis.lines if line.get_marker() == "D"]
        shown = [line for line in diamonds if np.isfinite(line.get_ydata()).all()]
        predicted.append(len(shown))
    others = len(stick_slip.others())
    assert predicted == [others + 1, others, others]
    assert [text.get_text() for axis in figure.axes for text in axis.texts] == ["fitted"] * 2
    named = [text.get_text() for text in figure.legends[0].get_texts()]
    assert named == ["measured: median and quartiles", "predicted"]


def test_the_plan_has_not_changed() -> None:
    """The rows of its table are those of the commit that the page names, before any comparison."""
    assert "commit `060375d1`, twelve minutes before that of the comparisons" in SENTENCES
    plan = PAGE.split("## The plan")[1].split("## Sources")[0]
    rows = "".join(f"{line}\n" for line in plan.splitlines() if line.startswith("| "))
    digest = hashlib.sha256(rows.encode()).hexdigest()
    assert digest == "716a5ca1ffd2c01a65e9ae09b96be412911e434bae5617c30e310ba10236b0dc"


# ---- What the page says of slips


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
def test_the_headline_on_slips_holds_with_every_least_fall(
    ratios: dict[float, list[robustness.Ratio]],
) -> None:
    falls = []
    fast = []
    for column in ratios.values():
        falls += [each for each in column if each.what.startswith("fall")]
        fast += [each for each in column if re.match("period.* 4300 ", each.what)]
    assert {each.verdict for each in falls} == {"no"}
    assert {each.verdict for each in fast} == {"no"}
    assert len(falls) == 7 * len(LEAST_FALLS)
    assert len(fast) == 3 * len(LEAST_FALLS)
    too_far = span([each.value for each in falls])
    too_long = span([each.value for each in fast])
    assert f"the force falls {too_far} times too far" in SENTENCES
    assert f"highest speed periods are {too_long} times too long" in SENTENCES
    assert f"**, {too_far} times, with every least fall" in SENTENCES
    assert f"**, {too_long} times, with every least fall" in SENTENCES


def test_no_constants_of_friction_give_the_fast_periods_nor_two_falls() -> None:
    """The least of a block with the stated mass and stiffness exceeds the measured, with its
    interval."""
    beyond = {}
    for least_fall in LEAST_FALLS:
        for quantity in ("period", "fall"):
            ratios = [robustness.least(quantity, run, least_fall) for run in stick_slip.others()]
            beyond[quantity, least_fall] = {
                each.what.removeprefix(f"{quantity}, ") for each in ratios if each.low > 1
            }
    periods = set.intersection(*(beyond["period", least_fall] for least_fall in LEAST_FALLS))
    assert periods == {stick_slip.name(run) for run in fastest()}
    for least_fall in LEAST_FALLS:
        assert beyond["fall", least_fall] == {"1002 N/m, 4300 µm/s", "2254 N/m, 4300 µm/s"}

    values = {}
    for run in ((1002, 4300), (2254, 4300)):
        every = [robustness.least("fall", run, least_fall) for least_fall in LEAST_FALLS]
        values[run] = every
    stiff = [each.value for each in values[2254, 4300]]
    middle = {f"{each.value:.2f}" for each in values[1002, 4300]}
    assert len(middle) == 1
    said = f"this is {middle.pop()} times the measured fall at 1002 N/m, and {span(stiff)} times at"
    assert said in SENTENCES
    assert "These periods and two of the seven falls are out of reach of any two" in SENTENCES
    # the planned tolerance, which one of the two keeps
    assert values[1002, 4300][0].value < 1 + stick_slip.MEDIANS < min(stiff)
    assert "of these two, the first is within the planned 20 %" in SENTENCES


def test_the_least_of_any_friction_is_that_of_the_simulated_block() -> None:
    """With a difference of static and kinetic friction that is nearly none."""
    run = (1002, 4300)
    table = stick_slip.predicted(run, 0.2901, 0.29)
    least = stick_slip.swing(run, 0.0)
    # as in the comparison with the closed form: samples of 0.5 ms, and the median over 2.5 ms
    assert stick_slip.period(table) == pytest.approx(float(least.period), abs=1 / signals.RATE)
    assert stick_slip.fall(table) == pytest.approx(float(least.fall), rel=0.02)
    for difference in (0.01, 0.04, 0.2):
        other = stick_slip.swing(run, difference)
        assert other.period > least.period
        assert other.fall > least.fall


def count_within(ratios: list[float]) -> int:
    """Return how many ratios come within the tolerance of medians."""
    return sum(abs(ratio - 1) <= stick_slip.MEDIANS for ratio in ratios)


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
def test_what_needs_no_model_is_compared_as_the_page_says() -> None:
    medians = stick_slip.medians()
    plain = stick_slip.baselines()
    model = {}
    for quantity in ("fall", "period"):
        others = [each for each in medians[quantity] if each.what != CALIBRATION]
        assert [each.what for each in others] == [each.what for each in plain]
        model[quantity] = [each.ratio for each in others]
    carried = [each.fall for each in plain]
    scaled = [each.period for each in plain]
    free = [each.least_period for each in plain]

    counts = [count_within(each) for each in (model["fall"], carried)]
    assert counts == [0, 1]
    assert "none of seven agrees by the model, and one if carried over" in SENTENCES
    counts = [count_within(each) for each in (model["period"], scaled, free)]
    assert counts == [0, 1, 2]
    assert "none agrees by the model, one by 1/(k v), and two by a free swing" in SENTENCES


def test_stiffness_by_the_rise_of_the_force_is_what_the_page_says() -> None:
    found = [f"{stick_slip.stick_stiffness(run):.0f}" for run in ((168, 42), (1002, 42))]
    said = f"springs of {found[0]} and {found[1]} N/m, where 168 and 1002 are stated"
    assert said in SENTENCES


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
def test_stiffness_by_the_rise_of_the_force_is_that_of_a_simulated_spring() -> None:
    run = (1002, 42)
    table = stick_slip.predicted(run, 0.333, 0.290)
    rise = table["before"].to_numpy()[1:] - table["after"].to_numpy()[:-1]
    lasting = np.diff(table["start_s"]) - table["duration_s"].to_numpy()[:-1]
    weight = stick_slip.MASS * stick_slip.GRAVITY
    stiffness = np.median(rise * weight / (1e-6 * run[1] * lasting))
    # a slip lasts longer than from 5 to 95 % of its fall, by 4 ms of 600 ms
    assert stiffness == pytest.approx(run[0], rel=0.02)


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
def test_verdicts_that_depend_on_the_least_fall_are_said_to(
    ratios: dict[float, list[robustness.Ratio]],
) -> None:
    counts = []
    for least_fall in LEAST_FALLS:
        periods = stick_slip.medians(least_fall)["period"]
        counts.append(sum(each.agrees for each in periods))
    assert f"periods, {counts[0]}, {counts[1]} and {counts[2]} are within 20 %" in SENTENCES
    slowest = []
    for column in ratios.values():
        slowest += [each.value for each in column if each.what == "period, 168 N/m, 42 µm/s"]
    assert f"the ratio goes from {slowest[0]:.2f} to {slowest[2]:.2f}" in SENTENCES
    durations = [each for each in ratios[signals.FALL] if each.what.startswith("duration")]
    verdicts = [each.verdict for each in durations]
    assert verdicts.count("yes") == 1
    assert verdicts.count("no") == 2
    assert verdicts.count("undecided") == 5
    firm = (
        "one of eight, 1002 N/m at 1100 µm/s, agrees firmly if mass and stiffness are exact; two "
    )
    assert firm in SENTENCES
    assert durations[verdicts.index("yes")].what == "duration, 1002 N/m, 1100 µm/s"
    shortest = min(each.measured for each in stick_slip.medians()["duration"])
    percent = 100 / signals.RATE / shortest
    assert f"a sample is {percent:.0f} % of the shortest" in SENTENCES


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
def test_sentences_on_slips_are_computed() -> None:
    mu_s, mu_k = stick_slip.friction()
    assert f"{mu_s:.3f} and {mu_k:.3f}, are medians" in SENTENCES
    shorter = []
    for least_fall in LEAST_FALLS:
        for stiffness in stick_slip.STIFFNESSES:
            swing = 2 * np.pi * np.sqrt(stick_slip.MASS / stiffness)
            table = stick_slip.measured((stiffness, stick_slip.FASTEST), least_fall)
            shorter.append(100 * (1 - stick_slip.period(table) / swing))
    assert f"periods are {span(shorter, '.0f')} % shorter than a free swing" in SENTENCES
    sliding = stick_slip.record(stick_slip.SLIDING)
    assert sliding["quantum"] > signals.FALL / 3
    counts = f"{sliding['slips_0.02']:.0f} slips, "
    counts += f"{sliding['slips_0.02'] / sliding['length_s']:.0f} in a second"
    assert counts in SENTENCES
    assert f"with 0.04 it has {sliding['slips_0.04']:.0f}." in SENTENCES


def test_friction_of_the_runs_differs_as_the_page_says() -> None:
    equal = f"{stick_slip.friction((1002, 4300))[1]:.3f} against {stick_slip.friction()[1]:.3f}"
    assert f"kinetic friction does carry over, {equal}, and yet the fall" in SENTENCES
    own = stick_slip.record(stick_slip.CALIBRATION)["mean_force"]
    ratios = [stick_slip.record(run)["mean_force"] / own for run in stick_slip.others()]
    said = f"whatever the mass and the stiffness, is {span(ratios)} times that of the calibrating"
    assert said in SENTENCES


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
def test_the_yet_larger_fall_is_that_of_the_table() -> None:
    falls = {each.what: each.ratio for each in stick_slip.medians()["fall"]}
    assert f"fall is {falls['1002 N/m, 4300 µm/s']:.2f} times too large" in SENTENCES


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
@pytest.mark.parametrize("mass", [0.02, stick_slip.MASS])
def test_the_mean_force_is_kinetic_friction_whatever_the_mass(mass: float) -> None:
    for run in ((168, 4300), (1002, 1100)):
        result = stick_slip.simulated(run, 0.35, 0.30, mass)
        p = result.parameters
        force = p.k_p * p.r_0 * result["late"]["psi"].to_numpy() / p.N
        # of some twelve periods, the first and the last in part: a twelfth of a swing of 0.06
        assert np.mean(force) == pytest.approx(0.30, abs=5e-3)


def test_the_force_before_a_slip_is_compared_with_that_of_two_constants() -> None:
    """It is static friction only where v sqrt(k m) / m g is far less than the difference of both."""
    static, kinetic = stick_slip.friction()
    weight = stick_slip.MASS * stick_slip.GRAVITY
    terms = {}
    expected = {}
    for run in stick_slip.runs():
        stiffness, speed = run
        terms[run] = 1e-6 * speed * math.sqrt(stiffness * stick_slip.MASS) / weight
        expected[run] = kinetic + math.hypot(static - kinetic, terms[run])
        assert stick_slip.force_before(run) == pytest.approx(expected[run], rel=1e-12)
        assert stick_slip.force_of_speed(run) == pytest.approx(terms[run], rel=1e-12)
    fast = [run for run in terms if run[1] == stick_slip.FASTEST]
    assert [f"{expected[run]:.3f}" for run in fast] == ["0.344", "0.380", "0.416"]

    slow = f"{terms[stick_slip.CALIBRATION]:.4f} against {static - kinetic:.3f}"
    assert f"It is {slow} in the calibrating run" in SENTENCES


def test_period_and_fall_are_one_disagreement_where_the_block_mostly_sticks() -> None:
    static, kinetic = stick_slip.friction()
    difference = static - kinetic
    shares = {run: stick_slip.swing(run, difference).stick for run in stick_slip.runs()}
    for run, share in shares.items():
        if run[1] == 42:
            assert share > 0.95
    others = [share for run, share in shares.items() if run[1] != 42]
    assert max(others) < 0.8


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
def test_the_model_sticks_and_slips_in_every_run() -> None:
    for run in (*stick_slip.runs(), stick_slip.SLIDING):
        assert 0.05 < stick_slip.stick_share(run) < 0.995
    # one run in which the source finds no stick; neither the one that it calls inertial nor the
    # calibrating one is judged
    regimes = stick_slip.sticks()
    assert len(regimes) == 7
    assert CALIBRATION not in {each.what for each in regimes}
    assert sum(each.agrees for each in regimes) == 6
    assert "the six runs that agree, besides the calibrating one, show nothing" in SENTENCES
    assert [each.what for each in regimes if not each.agrees] == ["2254 N/m, 42 µm/s"]


# ---- What the pages say of discs and loads


def test_sentences_on_shapes_are_computed() -> None:
    errors = wheel.shapes()
    for each in errors:
        assert each.real < wheel.SHAPES
    failing = [each for each in errors if each.complex >= wheel.SHAPES]
    assert [each.mode for each in failing] == ["4 nodal diameters"]
    values = f"{failing[0].complex:.3f} as read at the peak, and with {failing[0].alone:.3f} in the"
    assert f"this mode fails, with {values} residues of one fitted mode" in SENTENCES
    for each in errors:
        if each not in failing:
            assert max(each.real, each.complex, each.alone, each.fitted) < wheel.SHAPES
    pair = wheel.peaks("2 fitted").loc[4]
    first, second = pair["frequency_Hz"]
    assert f"finds {first:.1f} and {second:.1f} Hz" in SENTENCES
    rest = 100 * pair["rest"].iloc[0]
    alone = 100 * wheel.peaks("1 fitted")["rest"][4]
    assert f"leaves {rest:.2f} % of the response where one mode leaves {alone:.1f} %" in SENTENCES


def test_the_page_names_the_peaks_that_were_left_out() -> None:
    left_out = wheel.omitted()
    assert left_out["diameters"].tolist() == [0, 4]
    assert (left_out["error_real"] >= wheel.SHAPES).all()
    said = {}
    for column, form in (("frequency_Hz", ".0f"), ("error_real", ".3f"), ("error_complex", ".3f")):
        said[column] = " and ".join(f"{value:{form}}" for value in left_out[column])
    heights = " and ".join(f"{100 * value:.0f}" for value in left_out["strength"])
    assert f"at {said['frequency_Hz']} Hz, with {heights} % of the height" in SENTENCES
    assert f"{said['error_real']} in the real parts and {said['error_complex']} in" in SENTENCES
    ratios = " and ".join(f"{100 * value:.2f}" for value in left_out["damping_ratio"])
    assert f"the two peaks that were left out have {ratios} %" in SENTENCES
    assert f"the two weaker peaks, with {ratios} %, were left out" in SENTENCES
    # of the planned modes it falls, by what was found here
    planned = wheel.peaks("read")["damping_ratio"]
    assert planned.is_monotonic_decreasing
    assert left_out["damping_ratio"].min() > planned.max()


def test_each_page_says_how_many_shapes_agree() -> None:
    shapes = wheel.shapes()
    agreeing = [each for each in shapes if max(each.real, each.complex) < wheel.SHAPES]
    left_out = wheel.omitted()
    assert (left_out[["error_real", "error_complex"]].max(axis=1) >= wheel.SHAPES).all()
    assert len(agreeing) == 3
    every = [max(each.real, each.complex, each.alone, each.fitted) for each in shapes]
    assert sum(error < wheel.SHAPES for error in every) == 3
    assert "three agree with every choice" in SENTENCES
    assert len(shapes) + len(left_out) == 6
    clause = "three of six shapes of a wheel agree over the measured half of the rim"
    for name in PAGES:
        assert clause in said_on(name).replace("Three", "three"), name
    for name in ("measurements.md", "findings.md", "note.md"):
        text = said_on(name)
        assert "split pair" in text, name
        assert re.search("two weaker peaks,? fail", text), name
    assert "over half the rim, 0 to 165° from the hammer" in SENTENCES


def test_sentences_on_frequencies_are_computed() -> None:
    frequencies = wheel.frequencies()
    agree = [each.agrees for each in frequencies]
    assert agree == [True] * 4 + [False]
    low = span([100 * (1 - each.ratio) for each in frequencies], ".0f")
    # the same words on each page that speaks of it
    for name in PAGES:
        sentence = f"ratios of frequencies of a uniform plate are {low} % low"
        assert sentence in said_on(name).replace("Ratios", "ratios"), name
    soft = wheel.frequencies(0.25)
    assert [each.agrees for each in soft].count(True) == 2
    assert "with a Poisson's ratio of 0.25, two are" in SENTENCES
    squares = wheel.squares()
    assert f"alone gives ratios of {span(squares)}, of which one is within 5 %" in SENTENCES
    assert sum(abs(ratio - 1) <= wheel.FREQUENCIES for ratio in squares) == 1
    assert f"the fit gives {wheel.thickness('wheel'):.0f} mm" in SENTENCES
    bronze = f"{wheel.thickness('bronze disc'):.1f} mm"
    assert f"the fitted thickness is {bronze}, but the body is 87 mm high." in SENTENCES
    assert min(wheel.BRONZE.values()) > wheel.BRONZE_ONE
    assert f"at {wheel.BRONZE_ONE} Hz, below all others" in SENTENCES


def test_sentences_on_damping_and_loads_are_computed() -> None:
    laws = wheel.damping()
    for each in laws:
        assert not each.agrees
    highest = max(each.ratio for each in laws)
    assert f"up to {highest:.0f} times too high" in SENTENCES
    constant = [each.ratio for each in laws if each.what.endswith("damping_ratio")]
    assert f"up to {max(constant):.1f} times too high" in SENTENCES
    ranges = load.ranges()
    differs = f"differs between loads by {span(list(ranges.values()))} times within a series"
    assert SENTENCES.count(differs) == 2
    largest = (1 + load.CONSTANT) / (1 - load.CONSTANT)
    assert min(ranges.values()) > largest
    assert f"at most {largest:.2f} times the least" in SENTENCES
    for name, rows in load.series().items():
        # the order of the test is told for the nanotribometer only, and follows the load
        known = rows["sequence"].is_monotonic_increasing and rows["sequence"].is_unique
        assert known == name.startswith("Nanotribometer")
    last = list(load.series().values())[-1]["friction"].to_numpy()
    assert last.size == 8
    assert last[4] == last.max()
    assert (
        "of eight the fifth, where in the last series friction happens to be largest" in SENTENCES
    )


def test_what_was_not_found_is_said_to_be_a_search() -> None:
    for name in ("measurements.md", "findings.md"):
        assert "was found" in said_on(name)
        assert "measurement of separation, impacts or squeal" in said_on(name)
        assert "no public measurement of separation, impacts or squeal states" not in said_on(name)
    assert "They were not exhaustive" in SENTENCES


def test_damping_that_students_found_does_not_change_the_verdict() -> None:
    ratios = [f"{100 * ratio:.3f}" for ratio in wheel.STUDENTS.values()]
    assert f"found {', '.join(ratios[:-1])} and {ratios[-1]} %" in SENTENCES
    laws = wheel.damping(wheel.STUDENTS)
    assert len(laws) == 6
    for each in laws:
        assert not each.agrees


# ---- What the page on fits says of its numbers


def test_numbers_of_the_page_on_fits_are_said_to_be_computed() -> None:
    text = said_on("howto/fit.md")
    case = dm.Parameters(N=385, Omega=14, mu_s=0.42, k_p=19e3)
    assert "computed with `mu_s` = 0.42 and `k_p` = 19 kN/m" in text
    exact = {speed: slipping(case.replace(Omega=speed)) for speed in (12, 13, 14, 14.8)}
    errors = []
    for place, name in enumerate(("periods", "slips")):
        shown = re.search(name + r" = \{(.*?)\}", text)
        assert shown is not None
        for pair in shown[1].split(", "):
            speed, value = pair.split(": ")
            errors.append(abs(float(value) - exact[float(speed)][place]))
    assert len(errors) == 6
    assert f"have errors of up to {1e3 * max(errors):.3f} ms" in text


def slipping(case: dm.Parameters) -> tuple[float, float]:
    """Return the period and the duration of slip (s) of the stick-slip cycle of a case."""
    cycle = dm.floquet(case)
    return cycle.period, cycle.period * (1 - cycle.stick_fraction)


# ---- The methods of the comparisons


def test_slips_of_a_known_force_are_found() -> None:
    """A saw tooth that rises in 0.4 s and falls by 0.1 in a half wave of 20 ms."""
    rise = 800
    fall = 40
    periods = 5
    up = np.linspace(0.2, 0.3, rise, endpoint=False)
    angles = np.linspace(0, np.pi, fall, endpoint=False)
    down = 0.25 + 0.05 * np.cos(angles)
    force = np.tile(np.concatenate([up, down]), periods)
    force += 1e-3 * np.random.default_rng(0).normal(size=force.size)
    found = signals.slips(force)
    assert len(found) in (periods - 1, periods)  # the last one is not ended by a rise
    for slip in found:
        # noise of 0.001, of which the extremes of some samples are taken
        assert slip.before == pytest.approx(0.3, abs=4e-3)
        assert slip.after == pytest.approx(0.2, abs=4e-3)
        # from 5 to 95 % of a half wave: 1 - 2 acos(0.9) / pi of it; samples are 0.5 ms apart
        missed = 2 * np.arccos(0.9) / np.pi
        duration = 0.02 * (1 - missed)
        assert slip.duration == pytest.approx(duration, abs=2e-3)


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
def test_friction_is_found_from_slips_of_a_simulated_block() -> None:
    """At a low speed; the block then swings about the kinetic force."""
    run = (1002, 42)
    table = stick_slip.predicted(run, 0.35, 0.30)
    static, kinetic = stick_slip.coefficients(table)
    # samples are 0.5 ms apart, in a slip of 17 ms
    assert np.median(static) == pytest.approx(0.35, abs=1e-3)
    assert np.median(kinetic) == pytest.approx(0.30, abs=2e-3)
    swing = np.pi * np.sqrt(stick_slip.MASS / run[0])
    part = 1 - 2 * np.arccos(0.9) / np.pi
    duration = stick_slip.duration(table)
    assert duration == pytest.approx(part * swing, abs=1e-3)


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
@pytest.mark.parametrize("run", stick_slip.runs(), ids=stick_slip.name)
def test_the_closed_form_agrees_with_the_simulated_block(run: tuple[int, int]) -> None:
    static, kinetic = stick_slip.friction()
    swing = stick_slip.swing(run, static - kinetic)
    table = stick_slip.predicted(run, static, kinetic)
    # a sample of 0.5 ms at either end; the median over 2.5 ms cuts extremes of a swing of 23 ms
    # by omega^2 t^2 / 2 of their amplitude, at most 1.6 %
    period = stick_slip.period(table)
    sample = 1 / signals.RATE
    assert period == pytest.approx(swing.period, abs=sample)
    assert stick_slip.fall(table) == pytest.approx(swing.fall, rel=0.02)
    # half of the fall lies above the kinetic friction
    before = float(np.median(table["before"]))
    assert before == pytest.approx(stick_slip.force_before(run), abs=0.01 * float(swing.fall))


@pytest.mark.filterwarnings("ignore::disc_model.ImplausibleValue")
@pytest.mark.parametrize("run", stick_slip.runs(), ids=stick_slip.name)
def test_friction_does_not_change_durations(run: tuple[int, int]) -> None:
    found = []
    for difference in (0.02, 0.04, 0.08):
        found.append(stick_slip.duration(stick_slip.predicted(run, 0.29 + difference, 0.29)))
    angle = np.pi - 2 * np.arccos(0.9)
    stiffness = run[0]
    part = angle * np.sqrt(stick_slip.MASS / stiffness)
    assert np.ptp(found) <= 1 / signals.RATE + 1e-12
    # each end of a duration is rounded to a sample, outwards
    samples = 2 / signals.RATE
    assert found == pytest.approx([part] * 3, abs=samples)


def test_intervals_of_a_known_scatter_contain_the_median() -> None:
    """In 95 % of samples; of 200, between 181 and 198 with a probability of 0.99."""
    generator = np.random.default_rng(1)
    inside = 0
    for _ in range(200):
        sample = generator.normal(size=200)
        low, high = np.percentile(robustness.medians_of_draws(sample, generator), [2.5, 97.5])
        inside += low <= 0.0 <= high
    assert 181 <= inside <= 198


@pytest.mark.parametrize(
    ("low", "high", "verdict"),
    [
        (0.85, 1.15, "yes"),
        (0.75, 0.85, "undecided"),
        (1.15, 1.25, "undecided"),
        (0.7, 1.3, "undecided"),
        (0.5, 0.7, "no"),
        (1.25, 1.4, "no"),
    ],
)
def test_an_interval_across_the_tolerance_decides_nothing(
    low: float, high: float, verdict: str
) -> None:
    middle = (low + high) / 2
    ratio = robustness.Ratio("", middle, low, high)
    assert ratio.verdict == verdict


def test_two_close_modes_are_found_from_responses() -> None:
    """A split pair with four nodal diameters, turned by 10 degrees against the hammer."""
    frequency = np.arange(2820.0, 2880.0, 0.3333)
    angles = np.radians(np.arange(0, 180, 15))
    turned = np.radians(10)
    around = 4 * (angles - turned)
    shapes = [np.cos(around), np.sin(around)]
    omega = 2 * np.pi * frequency[:, None]
    response = np.zeros((frequency.size, angles.size), dtype=complex)
    for natural, ratio, shape in zip((2848.5, 2859.0), (0.0055, 0.0049), shapes, strict=True):
        own = 2 * np.pi * natural
        stiffness = own**2 - omega**2
        damping = 2j * ratio * own * omega
        mode = -(omega**2) / (stiffness + damping)
        response = response + mode * shape[0] * shape

    found = resonances.resonances(frequency, response, 2)
    assert found.frequency == pytest.approx([2848.5, 2859.0], abs=1e-3)
    assert found.damping == pytest.approx([0.0055, 0.0049], rel=1e-3)
    assert found.rest < 1e-6
    total = resonances.residues(found, frequency, response).sum(axis=0)
    shape = resonances.harmonic(4, angles)
    assert resonances.shape_error(total / total[0], shape) < 1e-4

    # one mode neither fits nor has a shape that is real
    one = resonances.resonances(frequency, response, 1)
    assert one.rest > 0.02
    alone = resonances.residues(one, frequency, response)[0]
    assert resonances.shape_error(alone / alone[0], shape) > 0.02


def test_errors_of_shapes_see_what_is_not_in_phase() -> None:
    angles = np.radians(np.arange(0, 180, 15))
    shape = resonances.harmonic(3, angles)
    moved = shape + 0.2j * (angles > 0)
    error = resonances.shape_error(moved.real, shape)
    assert error == pytest.approx(0.0, abs=1e-12)
    assert resonances.shape_error(moved, shape) == pytest.approx(0.2, rel=1e-12)


def test_shapes_on_the_rim_are_harmonics() -> None:
    angles = np.radians(np.arange(0, 180, 15))
    model = wheel.shape(3, angles)
    assert model == pytest.approx(resonances.harmonic(3, angles), abs=1e-12)


def test_a_small_clamp_leaves_a_free_plate() -> None:
    """Frequencies of a free circular plate with nu = 0.3: lambda^2 of 5.358, 12.44, 21.84
    (text books, four digits)."""
    p = wheel.plate("wheel", 667.35, 4, 0.3)
    modes = dm.plate_modes(p).set_index("diameters")["omega"]
    area_mass = p.rho * p.h
    scale = p.b**2 * np.sqrt(area_mass / p.D)
    values = [modes[l] * scale for l in (2, 3, 4)]
    assert values == pytest.approx([5.358, 12.44, 21.84], rel=1e-3)
