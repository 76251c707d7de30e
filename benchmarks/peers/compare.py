#!/usr/bin/env python3
"""How long slipfit and two fits by scipy take for the same recording, and how far off they end.

compare.py SLIPFIT [--runs N] [--samples N] [--cycles N]

The peers, all by scipy's least_squares, from starts within 0.05 % of the truth where they do not look for their own:
  blocks            the model that slipfit fits (own onset and force for every cycle), evaluated by numpy in closed form
  blocks, sparse    the same, told which parameter moves which samples
  whole trace       one onset and F_s - F_k for all cycles: faster, and wrong where static friction scatters or the start
                    is off by more than 1 / (10 cycles) (docs/validation.md)
  whole trace, own search    the same from a start that the trace gives: FFT, slopes, trials, parts of growing length
  solve_ivp         the whole trace with every slip integrated to its event; differences for the derivatives are taken wide
                    enough (1e-5) for the integrator's error not to drown them
The peers' times are processor times of the fit alone. slipfit's are two: the processor time of the command, reading and
both of its threads included, less that of its start (--version); and the time of its fit alone (--timing, wall clock).
Needs python3-scipy.
"""

import json
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy
from scipy.integrate import solve_ivp
from scipy.optimize import brentq, least_squares

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from study import cost, parser  # noqa: E402

TRUTH = {"stiffness_N_per_m": 5000.0, "natural_frequency_rad_per_s": 900.0, "damping_ratio": 0.05,
         "friction_difference_N": 1.0}
KINETIC_N, SPEED, NOISE_N = 3.0, 0.01, 0.01
START_OFF = numpy.array([4e-4, -4e-4, 5e-4, 4e-4])  # relative; beyond 1 / (10 cycles) of the period: a false minimum


def cycle_of(k, omega, zeta, drop):
    """Slip and stick: start z0, end of slip tau_end and z_end, period in scaled time; model.md (1)-(5)."""
    lam = omega * drop / (k * SPEED)
    b = numpy.sqrt(1.0 - zeta * zeta)
    z0 = lam - 2.0 * zeta

    def z(tau):
        return numpy.exp(-zeta * tau) * (z0 * numpy.cos(b * tau) + (1.0 + zeta * z0) / b * numpy.sin(b * tau))

    def rate(tau):
        return numpy.exp(-zeta * tau) * (numpy.cos(b * tau) - (z0 + zeta) / b * numpy.sin(b * tau))

    fastest = numpy.arctan2(b * lam, zeta * lam - 1.0) / b
    tau_end = brentq(lambda tau: rate(tau) - 1.0, fastest, fastest + numpy.pi / b, xtol=1e-14)
    return z, z0, tau_end, z(tau_end), tau_end + z0 - z(tau_end)


def closed_form(p, time_s):
    k, omega, zeta, drop, level, onset_s = p
    z, z0, tau_end, z_end, period = cycle_of(k, omega, zeta, drop)
    tau = numpy.mod(omega * (time_s - onset_s), period)
    return level + k * SPEED / omega * numpy.where(tau < tau_end, z(tau), z_end + tau - tau_end)


def integrated(p, time_s):
    """The same by solve_ivp: every slip from its start to its end, found as an event."""
    k, omega, zeta, drop, level, onset_s = p
    u_start = drop / k - 2.0 * zeta / omega * SPEED  # extension beyond F_k / k: a slip starts at F_s - c V

    def motion(_, state):
        return [state[1], -omega * omega * state[0] - 2.0 * zeta * omega * state[1]]

    def sticks(_, state):
        return state[1] - SPEED

    sticks.terminal, sticks.direction = True, 1.0
    force = numpy.empty_like(time_s)
    period_s = cycle_of(k, omega, zeta, drop)[4] / omega
    start_s = onset_s - period_s * numpy.ceil((onset_s - time_s[0]) / period_s)
    while start_s < time_s[-1]:
        # A little slower than the drive: exactly at its speed the end would be found at once.
        slip = solve_ivp(motion, (0.0, 7.0 / omega), [u_start, SPEED * (1.0 - 1e-9)], events=sticks, dense_output=True,
                         rtol=1e-8, atol=1e-12)
        end_s = slip.t_events[0][-1]
        u_end = slip.sol(end_s)[0]
        next_s = start_s + end_s + (u_start - u_end) / SPEED
        here = (time_s >= start_s) & (time_s < next_s)
        tau_s = time_s[here] - start_s
        extension = u_end + SPEED * (tau_s - end_s)
        slides = tau_s < end_s
        if slides.any():
            extension[slides] = slip.sol(tau_s[slides])[0]
        force[here] = level + k * extension
        start_s = next_s
    return force


class Blocks:
    """What slipfit fits: k, w_n, zeta, the level, and for every cycle its own onset and force there."""

    def __init__(self, whole, time_s):
        k, omega, zeta, drop, level, onset_s = whole
        _, z0, _, _, period = cycle_of(k, omega, zeta, drop)
        period_s = period / omega
        first = numpy.ceil((time_s[0] - onset_s) / period_s - 0.5)
        last = numpy.floor((time_s[-1] - onset_s) / period_s + 0.5)
        onsets_s = onset_s + period_s * numpy.arange(first, last + 1.0)
        # A window reaches from the middle of one stick to that of the next, about a quarter period after the slip.
        self.cycle = numpy.clip(numpy.searchsorted(onsets_s - 0.5 * period_s, time_s) - 1, 0, len(onsets_s) - 1)
        self.count = len(onsets_s)
        forces = numpy.full(self.count, k * SPEED / omega * z0)
        self.start = numpy.concatenate([[k, omega, zeta, level], onsets_s, forces])

    def __call__(self, p, time_s):
        k, omega, zeta, level = p[:4]
        b = numpy.sqrt(1.0 - zeta * zeta)
        scale = k * SPEED / omega
        z0 = p[4 + self.count:] / scale
        slope = (z0 + zeta) / b
        lam = z0 + 2.0 * zeta
        low = numpy.arctan2(b * lam, zeta * lam - 1.0) / b
        high = low + numpy.pi / b
        for _ in range(45):  # the end of slip of all cycles at once, by bisection
            middle = 0.5 * (low + high)
            above = numpy.exp(-zeta * middle) * (numpy.cos(b * middle) - slope * numpy.sin(b * middle)) > 1.0
            high = numpy.where(above, middle, high)
            low = numpy.where(above, low, middle)

        def z(tau, z0):
            return numpy.exp(-zeta * tau) * (z0 * numpy.cos(b * tau) + (1.0 + zeta * z0) / b * numpy.sin(b * tau))

        end, z_end = low[self.cycle], z(low, z0)[self.cycle]
        own = z0[self.cycle]
        tau = omega * (time_s - p[4:4 + self.count][self.cycle])
        inside = z(numpy.clip(tau, 0.0, end), own)
        return level + scale * numpy.where(tau < 0.0, own + tau, numpy.where(tau < end, inside, z_end + tau - end))

    def values(self, p):
        k, omega, zeta = p[:3]
        return [k, omega, zeta, numpy.mean(p[5 + self.count:-1]) + 2.0 * zeta * k * SPEED / omega]

    def sparsity(self, samples):
        from scipy.sparse import lil_matrix
        pattern = lil_matrix((samples, len(self.start)), dtype=int)
        pattern[:, :4] = 1
        rows = numpy.arange(samples)
        pattern[rows, 4 + self.cycle] = 1
        pattern[rows, 4 + self.count + self.cycle] = 1
        return pattern


def simulate(slipfit, folder, samples, cycles):
    period_s = cycle_of(5000.0, 900.0, 0.05, 1.0)[4] / 900.0
    file = folder + "/recording.csv"
    subprocess.run([slipfit, "simulate", "--stiffness", "5000", "--natural-frequency", "900", "--damping-ratio", "0.05",
                    "--static-friction", str(KINETIC_N + 1.0), "--kinetic-friction", str(KINETIC_N), "--speed", str(SPEED),
                    "--duration", repr(period_s * (cycles + 4)), "--sample-rate", repr(samples / cycles / period_s),
                    "--noise", str(NOISE_N), "--out", file, "--quiet"], check=True)
    rows = numpy.loadtxt(file, delimiter=",", skiprows=2)
    rows = rows[rows[:, 0] > 1.2 * (KINETIC_N + 1.0) / 5000.0 / SPEED][:samples]  # without the ramp from rest
    numpy.savetxt(file, rows, delimiter=",", header="time_s,force_N", comments="", fmt="%.9g")
    return file, rows[:, 0], rows[:, 1]


def good_start(time_s, force):
    start = numpy.array(list(TRUTH.values()) + [KINETIC_N, 0.0])
    start[:4] *= 1.0 + START_OFF
    period_s = cycle_of(*start[:4])[4] / start[1]
    # The phase by trial: what a look at the trace gives.
    trials = time_s[0] + numpy.linspace(0.0, period_s, 200, endpoint=False)
    costs = []
    first = time_s < time_s[0] + 10.0 * period_s
    for onset_s in trials:
        start[5] = onset_s
        costs.append(numpy.sum((closed_form(start, time_s[first]) - force[first]) ** 2))
    start[5] = trials[int(numpy.argmin(costs))]
    return start


def residuals(model, p, time_s, force):
    """Large where the step left stick-slip."""
    try:
        return model(p, time_s) - force
    except (ValueError, RuntimeError):
        return numpy.full_like(force, 10.0 * numpy.ptp(force))


def searched_start(time_s, force):
    """A start from the trace alone: period by FFT, k by slopes, phase and w_n by trial; then fits of longer and longer parts."""
    step_s = (time_s[-1] - time_s[0]) / (len(time_s) - 1)
    length = 8 * len(force)
    power = numpy.abs(numpy.fft.rfft((force - numpy.mean(force)) * numpy.hanning(len(force)), length)) ** 2
    begin = int(3.0 * length / len(force))
    peak = begin + int(numpy.argmax(power[begin:]))
    period_s = length * step_s / peak
    lag = max(1, int(0.05 * period_s / step_s))
    k = numpy.median(force[lag:] - force[:-lag]) / (lag * step_s * SPEED)  # most of the time it sticks
    fall = numpy.ptp(numpy.percentile(force - numpy.polyval(numpy.polyfit(time_s, force, 1), time_s), (1.0, 99.0)))
    slip_s = max(period_s - fall / (k * SPEED), 0.03 * period_s)
    first = time_s < time_s[0] + 6.0 * period_s
    best = None
    for omega in 1.05 * numpy.pi / slip_s * numpy.array([0.6, 0.8, 1.0, 1.3, 1.7, 2.3]):
        def longer(drop):
            return cycle_of(k, omega, 0.05, drop)[4] / omega - period_s
        low, high = 1.5 * k * SPEED / omega, 2.0 * fall  # 1.5: stick-slip for certain
        if high <= low or longer(low) * longer(high) > 0.0:
            continue
        drop = brentq(longer, low, high)
        level = numpy.mean(force[first])
        for onset_s in time_s[0] + numpy.linspace(0.0, period_s, 60, endpoint=False):
            start = numpy.array([k, omega, 0.05, drop, level, onset_s])
            misfit = closed_form(start, time_s[first]) - force[first]
            start[4] -= numpy.mean(misfit)
            if best is None or numpy.var(misfit) < best[0]:
                best = numpy.var(misfit), start
    start = best[1]
    cycles = 6.0
    while cycles * period_s < time_s[-1] - time_s[0]:
        part = time_s < time_s[0] + cycles * period_s
        start = least_squares(lambda p: residuals(closed_form, p, time_s[part], force[part]), start, x_scale=numpy.abs(start) + 1e-3).x
        cycles *= 3.0
    return start


def fit_with_search(time_s, force):
    begin = time.process_time()
    start = searched_start(time_s, force)
    seconds = time.process_time() - begin
    fit_s, result = fit(closed_form, start, time_s, force)
    return seconds + fit_s, result


def fit(model, start, time_s, force, **options):
    begin = time.process_time()
    result = least_squares(lambda p: residuals(model, p, time_s, force) / NOISE_N, start, x_scale=numpy.abs(start) + 1e-3, **options)
    return time.process_time() - begin, result


def errors(values):
    return {name: f"{value / truth - 1.0:+.1e}" for (name, truth), value in zip(TRUTH.items(), values)}


def report(name, ours, values, seconds, result):
    whole_s, fit_s = ours
    rms = numpy.sqrt(2.0 * result.cost / len(result.fun))
    print(f"{name}: {1e3 * seconds:.0f} ms, {len(result.x)} parameters, {result.nfev} steps, residual {rms:.3f} of the noise, "
          f"errors {errors(values(result.x))}, ratio {seconds / whole_s:.0f} over the command, {seconds / fit_s:.0f} over the fit")


def fit_by_slipfit(slipfit, file):
    start, whole = cost(slipfit, "--version"), cost(slipfit, "fit", file, "--speed", SPEED, "--json", "--timing")
    document = json.loads(whole.out)
    return whole.cpu_s - start.cpu_s, document["timing"]["fit_s"], [document["parameters"][name]["value"] for name in TRUTH]


def main():
    words = parser(__doc__)
    words.add_argument("slipfit")
    words.add_argument("--runs", type=int, default=21)
    words.add_argument("--samples", type=int, default=10000)
    words.add_argument("--cycles", type=int, default=100)
    arguments = words.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        file, time_s, force = simulate(arguments.slipfit, folder, arguments.samples, arguments.cycles)
        runs = [fit_by_slipfit(arguments.slipfit, file) for _ in range(arguments.runs)]
        ours = [numpy.median([seconds[i] for seconds in runs]) for i in (0, 1)]
        print(f"{len(time_s)} samples, {arguments.cycles} cycles, noise {NOISE_N} N")
        print(f"slipfit: command {1e3 * ours[0]:.1f} ms, fit alone {1e3 * ours[1]:.1f} ms, errors {errors(runs[0][2])}")
        start = good_start(time_s, force)
        blocks = Blocks(start, time_s)
        report("blocks", ours, blocks.values, *fit(blocks, blocks.start, time_s, force))
        report("blocks, sparse", ours, blocks.values,
               *fit(blocks, blocks.start, time_s, force, jac_sparsity=blocks.sparsity(len(time_s))))
        report("whole trace", ours, lambda p: p, *fit(closed_form, start, time_s, force))
        report("whole trace, own search", ours, lambda p: p, *fit_with_search(time_s, force))
        off = numpy.max(numpy.abs(integrated(start, time_s) - closed_form(start, time_s)))
        print(f"solve_ivp is off the closed form by {off:.1e} N at most")
        report("solve_ivp", ours, lambda p: p, *fit(integrated, start, time_s, force, diff_step=1e-5))


if __name__ == "__main__":
    main()
