"""Test the paper's motion: coefficients, (15) to (18), range of validity, and scenes."""

import json
import math
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import flint
import numpy as np
import pytest
import sympy as sp
from mpmath import mp, mpf, quad
from printed_sums import truncated_gamma
from shared_scenes import EXAMPLES, changed

import derivation.checks.effects
from derivation.checks.paper_law import in_doubles
from derivation.cli import main
from derivation.plate.impact.oracle import printed_motion as printed_motion_balls
from derivation.plate.impact.theory.impact import linear_motion, linearisation
from derivation.plate.vocabulary import BY_NAME as SYMBOLS
from derivation.plate.vocabulary import delta_0, m, v0, xi_k
from derivation.scene import SceneError, explain, indent, kernels, load, read, simulate
from derivation.scene.model import Model
from derivation.scene.output.comparison import MODES, compare
from generated.impact import impact
from generated.perturbation import PrintedMotion, printed_motion

PAPER = (0.13, 72.2, 1.0, 0.1, 1.0, 0.36e9, 0.43e9)
CASES = {
    "paper": PAPER,
    "thin": (1.3, 72.2, 0.0039, 1e-3, 1.0, 0.36e9, 0.43e9),
    "thick": (1.3, 72.2, 480.0, 1.0, 1.0, 0.36e9, 0.43e9),
}
Real = Callable[..., mpf]


@pytest.mark.parametrize("modes", [1, 25])
@pytest.mark.parametrize("name", CASES)
def test_coefficients_agree_with_truncated_sums(name: str, modes: int) -> None:
    with mp.workdps(30):
        gamma_2, gamma_3 = (truncated_gamma(k, modes, CASES[name]) for k in (2, 3))
        printed = printed_motion(*CASES[name], modes)
        derived = printed_motion(*CASES[name], modes, corrected=True)
        assert printed.xi_2 == derived.xi_2 == pytest.approx(float(1 / gamma_2), rel=1e-13)
        assert printed.xi_3 == pytest.approx(float(-gamma_3 / gamma_2**3), rel=1e-13)
        assert derived.xi_3 == pytest.approx(float(-gamma_3 / gamma_2 ** mpf("8/3")), rel=1e-13)


def test_published_sums_diverge() -> None:
    times = [printed_motion(*PAPER, modes).contact_time for modes in (100, 400, 1600, 6400)]
    assert (np.diff(times) > 0.2 * times[0]).all()


def theory(motion: PrintedMotion) -> tuple[Real, Real, mpf, mpf]:
    """Return the derived F and G as functions of delta_0, and amplitude and frequency of (15)."""
    values = {m: motion.m, v0: motion.v0, xi_k[2]: motion.xi_2, xi_k[3]: motion.xi_3}
    exact = {key: sp.Float(value, 40) for key, value in values.items()}
    F, G = (
        sp.lambdify(delta_0, formula.expression.subs(exact), "mpmath")
        for formula in linearisation()[:2]
    )
    peak = mpf(motion.v0) * mp.sqrt(mpf(motion.m) / motion.xi_2)
    return F, G, peak, mp.sqrt(mpf(motion.xi_2) / motion.m)


def correction(motion: PrintedMotion, t: mpf) -> mpf:
    """Return (16) by direct quadrature, a double integral over time."""
    F, G, peak, rate = theory(motion)

    def before(end: mpf) -> mpf:
        return quad(lambda x: F(peak * mp.sin(rate * x)), [0, end / 2, end])

    whole = before(t)
    return -quad(
        lambda x: G(peak * mp.sin(rate * x)) * mp.exp(before(x) - whole), [0, t / 2, t], maxdegree=4
    )


@pytest.mark.parametrize("corrected", [False, True])
def test_correction_agrees_with_equation_16(corrected: bool) -> None:
    motion = printed_motion(*PAPER, 100, corrected=corrected)
    t = 0.9 * motion.valid_until
    with mp.workdps(16):
        eta = float(correction(motion, mpf(t)))
    assert float(motion.corrected(t) - motion.linear(t)) == pytest.approx(eta, rel=1e-10)
    assert eta < 0


@pytest.mark.parametrize("fraction", [0.2, 0.9])
def test_arb_reference_agrees(fraction: float) -> None:
    """The Arb reference agrees with the direct integrals over time and the generated code."""
    motion = printed_motion(*PAPER, 100, corrected=True)
    t = fraction * motion.valid_until
    numbers = (motion.m, motion.v0, motion.xi_2, motion.xi_3)
    ball = printed_motion_balls.corrected(t, *numbers, digits=45)
    with mp.workdps(16):
        _, _, peak, rate = theory(motion)
        other = peak * mp.sin(rate * mpf(t)) + correction(motion, mpf(t))
    assert ball.rel_accuracy_bits() > 149
    assert abs(float(ball) - float(other)) < 1e-12 * motion.max_indentation
    assert abs(ball - float(motion.corrected(t))) < 1e-14 * motion.max_indentation


def test_arb_reference_ends_at_the_zero_of_the_radicand() -> None:
    motion = printed_motion(*PAPER, 100)
    numbers = (motion.m, motion.v0, motion.xi_2, motion.xi_3)
    with flint.ctx.workprec(100):
        last = printed_motion_balls.last_fraction(*numbers)
    assert float(last) == pytest.approx(motion.last, rel=1e-14)
    with pytest.raises(ValueError, match="has vanished"):
        printed_motion_balls.corrected(1.001 * motion.valid_until, *numbers)


@pytest.mark.parametrize("name", CASES)
@pytest.mark.parametrize("corrected", [False, True])
def test_eta_solves_its_equation_up_to_its_end(name: str, corrected: bool) -> None:
    """eta' + F eta + G = 0 holds, by finite differences with smaller steps near the end."""
    motion = printed_motion(*CASES[name], 100, corrected=corrected)
    F, G, _, _ = theory(motion)
    for left in (0.5, 0.1, 1e-2):
        t = (1 - left) * motion.valid_until
        step = 1e-2 * left * motion.valid_until
        times = t + step * np.array([-2.0, -1.0, 1.0, 2.0])
        eta = motion.corrected(times) - motion.linear(times)
        slope = (eta[0] - 8 * eta[1] + 8 * eta[2] - eta[3]) / (12 * step)
        at, here = float(motion.linear(t)), float(motion.corrected(t) - motion.linear(t))
        parts = float(F(at)) * here, float(G(at))
        assert slope + sum(parts) == pytest.approx(0, abs=1e-6 * max(map(abs, parts)))


def test_linear_motion_agrees_with_equation_15() -> None:
    motion = printed_motion(*PAPER, 50)
    values = {m: motion.m, v0: motion.v0, xi_k[2]: motion.xi_2}
    exact = sp.lambdify(SYMBOLS["t"].symbol, linear_motion().expression.subs(values))
    times = np.linspace(0, motion.contact_time, 7)
    np.testing.assert_allclose(
        motion.linear(times), exact(times), rtol=1e-14, atol=1e-14 * motion.max_indentation
    )
    assert motion.contact_time == pytest.approx(math.pi * math.sqrt(motion.m / motion.xi_2))
    assert motion.linear(motion.contact_time / 2) == pytest.approx(motion.max_indentation)
    # For a linear spring only the indentation depends on the speed.
    faster = printed_motion(*PAPER[:2], 3.0, *PAPER[3:], 50)
    assert faster.contact_time == motion.contact_time
    assert faster.max_indentation == pytest.approx(3 * motion.max_indentation, rel=1e-15)


@pytest.mark.parametrize("corrected", [False, True])
@pytest.mark.parametrize("modes", [1, 10, 100, 1000])
@pytest.mark.parametrize("name", CASES)
def test_correction_ends_before_the_turning_point(name: str, modes: int, corrected: bool) -> None:
    motion = printed_motion(*CASES[name], modes, corrected=corrected)
    assert motion.xi_3 > 0
    assert 0 < motion.valid_until < motion.contact_time / 2
    at = motion.linear(motion.valid_until)
    used = motion.xi_2 * at**2 + 0.75 * motion.xi_3 * at ** (8 / 3)
    assert used / (motion.m * motion.v0**2) == pytest.approx(1, rel=1e-13)
    times = np.linspace(0, motion.valid_until, 401)
    actual = motion.corrected(times)
    assert (np.diff(actual) > 0).all()  # the corrected motion has no turning point
    assert (actual <= motion.linear(times) + 1e-16 * motion.max_indentation).all()
    assert np.isnan(motion.corrected(np.nextafter(motion.valid_until, np.inf)))
    assert np.isnan(motion.corrected(-1e-9))


def test_published_exponent_depends_on_the_units() -> None:
    """In mm, t and s the derived motion is the same, but the published motion changes."""
    R, mass, speed, h, b, lam, mu = PAPER
    other = 1e3 * R, 1e-3 * mass, 1e3 * speed, 1e3 * h, 1e3 * b, 1e-6 * lam, 1e-6 * mu
    ours, theirs = (printed_motion(*x, 100, corrected=True) for x in (PAPER, other))
    assert theirs.valid_until == pytest.approx(ours.valid_until, rel=1e-13)
    ours, theirs = (printed_motion(*x, 100) for x in (PAPER, other))
    assert theirs.contact_time == pytest.approx(ours.contact_time, rel=1e-13)
    assert abs(theirs.valid_until / ours.valid_until - 1) > 0.1


@pytest.mark.filterwarnings("error")
def test_nan_outside_the_domain_and_for_extreme_numbers() -> None:
    for index in range(7):
        for bad in (0.0, -1e9, math.nan, math.inf, 1e-300):
            case = [*PAPER]
            case[index] = bad
            motion = printed_motion(*case, 10)
            actual = motion.corrected(1e-4), motion.valid_until, motion.last, motion.contact_time
            if bad != 1e-300 and (index, bad) != (5, 0.0):
                assert all(map(math.isnan, actual)), (index, bad)


def compared(**effects: object) -> dict[str, dict[str, object]]:
    return changed(effects=effects)


def test_comparison_is_the_generated_motion() -> None:
    result = simulate(read(compared(compare_paper_motion=True)))
    assert result.comparison is not None
    numbers = result.model.numbers
    linear, *broken = result.comparison.motions
    assert result.comparison.modes == MODES
    motion = printed_motion(*numbers, MODES)
    assert (linear.contact_time, linear.valid_until) == (motion.contact_time, None)
    assert linear.contact_time_difference == motion.contact_time / result.contact_time - 1
    for row, corrected in zip(broken, (False, True), strict=True):
        motion = printed_motion(*numbers, MODES, corrected=corrected)
        last = float(motion.corrected(motion.valid_until))
        assert (row.contact_time, row.contact_time_difference) == (None, None)
        assert (row.valid_until, row.valid_fraction, row.max_indentation) == (
            motion.valid_until, motion.valid_fraction, last,
        )  # fmt: skip
        assert row.max_indentation_difference == last / result.max_indentation - 1
        assert row.valid_fraction == pytest.approx(
            2 * motion.valid_until / motion.contact_time, rel=1e-14
        )


@pytest.mark.parametrize(
    "name", ["paper", "glass_pane", "concrete_floor", "pad", "block", "soft_layer"]
)
@pytest.mark.parametrize("rtol", [None, 1e-1, 1e-6])
def test_comparison_changes_no_result(name: str, rtol: float | None) -> None:
    data = load(EXAMPLES / f"{name}.toml").to_json()
    if rtol == 1e-6 or name == "paper":  # too small a tolerance for a plate with inertia
        data["effects"] = {**data.get("effects", {}), "inertia": False}
    without = simulate(read(data), rtol=rtol)
    data["effects"] = {**data.get("effects", {}), "compare_paper_motion": True}
    result = simulate(read(data), rtol=rtol)
    assert result.effects.law == without.effects.law
    assert result.effects.error == without.effects.error
    assert result.accuracy == without.accuracy
    assert result.warnings == without.warnings
    made, plain = result.to_json(), without.to_json()
    assert made.pop("paper_motion")["modes"] == MODES
    assert made.pop("scene") != plain.pop("scene")
    assert made == plain
    for one, other in zip(result.history(5), without.history(5), strict=True):
        np.testing.assert_array_equal(one, other)


def test_comparison_is_not_an_effect() -> None:
    """The comparison is not an effect: table, static contact and reference stay unchanged."""
    requested, plain = read(compared(compare_paper_motion=True)), read(compared())
    assert repr(explain(requested).effects) == repr(explain(plain).effects)  # NaN != NaN
    assert indent(requested, force=[10.0]) == indent(plain, force=[10.0])
    wanted = compared(compare_paper_motion=True), compared()
    one, other = (derivation.checks.effects.all_effects_impact(data) for data in wanted)
    assert one == other is not None
    assert in_doubles(requested).contact_time == in_doubles(plain).contact_time


def test_fast_methods_are_used_with_the_comparison(monkeypatch: pytest.MonkeyPatch) -> None:
    calls = []
    monkeypatch.setattr(kernels, "impact", lambda *x, **y: calls.append(x) or impact(*x, **y))
    simulate(read(compared(compare_paper_motion=True)))
    assert len(calls) == 1
    thick = {"radius": 1e3, "thickness": 2e3}
    result = simulate(read(changed(plate=thick, effects={"compare_paper_motion": True})), rtol=1e-2)
    assert result.accuracy.method == "hertz"
    assert len(calls) == 1


@pytest.mark.parametrize("wanted", ["auto", 1, "true"])
def test_values_accepted_by_the_key(wanted: object) -> None:
    with pytest.raises(SceneError, match=r"compare_paper_motion: expected .*true.*false"):
        read(compared(compare_paper_motion=wanted))


def test_output_contains_the_comparison(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "scene.toml"
    text = (EXAMPLES / "paper.toml").read_text()
    assert text.count("[effects]") == 1
    path.write_text(text.replace("[effects]", "[effects]\ncompare_paper_motion = true"))
    out = tmp_path / "out.json"
    assert main(["simulate", str(path), "--json", str(out)]) == 0
    shown = " ".join(capsys.readouterr().out.split())
    assert f"after {MODES} modes" in shown
    assert "For comparison only" in shown
    rows = json.loads(out.read_text())["paper_motion"]["motions"]
    assert [row["contact_time"] is None for row in rows] == [False, True, True]
    assert [row["valid_until"] is None for row in rows] == [True, False, False]
    html = simulate(load(path))._repr_html_()
    assert "linear term (15)" in html
    assert f"{rows[0]['contact_time']:.4g}" in html
    plain = simulate(load(EXAMPLES / "paper.toml"))
    assert plain.comparison is None
    assert "paper_motion" not in plain.to_json()
    assert "linear term (15)" not in plain._repr_html_()


@pytest.mark.parametrize("wanted", ["false", "true"])
def test_comparison_is_imported_only_on_request(wanted: str) -> None:
    program = f"""
import sys
from derivation.scene import explain, load, read, simulate
data = load({str(EXAMPLES / "paper.toml")!r}).to_json()
scene = read(data | {{"effects": {{"compare_paper_motion": {wanted.title()}, "inertia": False}}}})
explain(scene)
result = simulate(scene)
result.to_json(), result._repr_html_(), result.history()
for name in ("derivation.scene.output.comparison", "generated.perturbation"):
    assert (name in sys.modules) is {wanted.title()}, name
"""
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("size", [1e-200, 1e-60, 1e60])
@pytest.mark.filterwarnings("error")
def test_nan_is_null_in_json(size: float) -> None:
    """The motion is null in JSON where its sums exceed the double range."""
    made = compare(Model(size, 1.0, 1.0, size, size, 1.0, 1.0), 1.0, 1.0).to_json()
    assert json.loads(json.dumps(made, allow_nan=False)) == made


def test_modules_of_the_scene_do_not_mention_the_comparison(tmp_path: Path) -> None:
    path, out = tmp_path / "scene.toml", tmp_path / "made.py"
    text = (EXAMPLES / "paper.toml").read_text()
    path.write_text(text.replace("[effects]", "[effects]\ncompare_paper_motion = true"))
    assert main(["generate", "--scene", str(path), "--out", str(out)]) == 0
    assert "(14) to (18)" not in out.read_text()
