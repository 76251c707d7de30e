#!/usr/bin/env python3
"""Writes relaxing_spring.csv: slips that repeat on a spring of which a share relaxes, integrated numerically (docs/model.md (25c)).

One cycle after the other from a spring at rest until the force that relaxes repeats to 1e-13. In units of 1/w_n and k V/w_n.
"""
import math
import pathlib

from scipy.integrate import solve_ivp
from scipy.optimize import brentq

ROWS = [(z0, zeta, share, time) for z0 in (3.0, 8.0, 30.0) for zeta in (0.02, 0.15) for share in (0.05, 0.3, 0.6) for time in (0.5, 2.0, 10.0, 60.0)]


def slip(z0, zeta, share, time, relaxing):
    def rates(_, y):
        return [y[1] - y[2] / time, -y[0] - 2 * zeta * y[1], share * y[1] - y[2] / time]

    def rest(tau, y):
        return y[1] - 1 if tau > 0.5 else -1.0

    rest.terminal, rest.direction = True, 1
    motion = solve_ivp(rates, [0, 60], [z0, 1, relaxing], method="DOP853", events=rest, rtol=1e-13, atol=1e-13, dense_output=True)
    return motion.t_events[0], motion


def cycle(z0, zeta, share, time):
    relaxing = share * time
    for _ in range(5000):
        ends, motion = slip(z0, zeta, share, time, relaxing)
        if not len(ends):
            return None
        trough, _, left = motion.sol(ends[0])
        regained = share * time - left

        def force(stick):
            return trough + (1 - share) * stick + regained * -math.expm1(-stick / time)

        stick = brentq(lambda x: force(x) - z0, 0, 2 * (z0 - trough) / (1 - share), xtol=1e-13, rtol=1e-15)
        after = share * time - regained * math.exp(-stick / time)
        if abs(after - relaxing) < 1e-13 * max(1.0, abs(after)):
            return ends[0], ends[0] + stick, trough, motion.sol(0.5 * ends[0])[0], force(0.5 * stick)
        relaxing = after
    raise RuntimeError("slips do not repeat")


def main():
    with open(pathlib.Path(__file__).with_suffix(".csv"), "w", encoding="utf-8") as table:
        table.write("# slips that repeat on a spring of which a share relaxes; forces at the end and in the middle of the slip, in the middle of the stick\n")
        table.write("z0,zeta,share,time,t_slip,period,trough,half_slip,half_stick\n")
        for row in ROWS:
            found = cycle(*row)
            if found:
                table.write(",".join(f"{value:.13g}" for value in (*row, *found)) + "\n")


if __name__ == "__main__":
    main()
