"""Families that are fitted as several parts or compared with a load: strokes to and fro, runs that begin at rest under a load, and five speeds one
after another in one file, with friction that falls with the speed. Truths are the parameters, and the coefficients of the first and mean peak."""
from scenes import Model, Scene, families, np, simulate

SCATTER = 0.04  # of F_s - F_k, relative


class _Slider:
    """A slider with about `slips` slips in a stroke, well sampled."""

    def __init__(self, rng, slips=20):
        self.rng = rng
        self.k, self.omega, self.fk = rng.uniform(200, 2000), rng.uniform(60, 150), rng.uniform(0.5, 2.0)
        self.drop = rng.uniform(0.2, 0.6) * self.fk
        self.zeta = rng.uniform(0.03, 0.2)
        self.speed = self.drop / self.k * self.omega / rng.uniform(8, 20)
        self.step = 1 / (6 * self.omega)
        self.samples = int(slips * 2 * self.drop / (self.k * self.speed) / self.step)

    def factors(self):
        return 1 + SCATTER * self.rng.standard_normal(200)

    def force(self, speed, start_force, factors, fall=0.0, **terms):
        """Of one way; `fall`: of the kinetic friction with the speed."""
        model = Model(stiffness=self.k, omega=self.omega, damping_ratio=self.zeta, **terms)
        return simulate(model, self.step, speed, self.fk + self.drop, self.fk - fall, factors, start_force).force

    def scene(self, force, options, speed=None, **parameters):
        truth = {"stiffness_N_per_m": self.k, "natural_frequency_rad_per_s": self.omega, "damping_ratio": self.zeta, "kinetic_friction_N": self.fk,
                 "friction_difference_N": self.drop, **parameters}
        noise = 0.01 * self.drop * self.rng.standard_normal(len(force))
        return Scene(self.step * np.arange(len(force)), force + noise,
                     {"kind": "joint", "speed_m_per_s": self.speed if speed is None else None, "frequency_Hz": None, "spacing_m": None,
                      "parameters": truth, "options": [*options, "--zero", "0"]}, speed_m_per_s=speed)


def strokes(rng, slips=20):
    """Six strokes; the spring is loaded the other way from where the stroke before left it, the first begins at rest."""
    slider, parts, end = _Slider(rng, slips), [], 0.0
    for side in (1, -1) * 3:
        one = slider.force(np.full(slider.samples, slider.speed), -end, slider.factors())
        end = one[-1]
        parts.append(side * one)
    return slider.scene(np.concatenate(parts), ["--strokes"])


def from_rest(rng):
    """The load is twice F_s. The spring shows F_s less the viscous force of the frame at the driving speed, 2 zeta k V / omega."""
    slider = _Slider(rng)
    factors, static = slider.factors(), slider.fk + slider.drop
    force = slider.force(np.full(slider.samples, slider.speed), 0.0, factors)
    first = slider.fk + factors[0] * slider.drop - 2 * slider.zeta * slider.k * slider.speed / slider.omega
    return slider.scene(force, ["--normal-force", f"{2 * static!r}"], static_first_peak=first / (2 * static), static_mean_peak=0.5)


def segments(rng):
    """F_k(v) = F_k + f1 (exp(alpha v) - 1), which slips see."""
    slider = _Slider(rng)
    scale = slider.drop / slider.k * slider.omega
    f1, alpha = rng.uniform(0.2, 0.5) * slider.drop, -1 / (rng.uniform(0.15, 0.4) * scale)
    speeds = scale / np.geomspace(20, 4, 5)
    speed = np.repeat(speeds, [int(40 * slider.drop / (slider.k * v) / slider.step) for v in speeds])
    force = slider.force(speed, 0.0, 1 + SCATTER * rng.standard_normal(1000), f1, stribeck_force=f1, stribeck_speed=-1 / alpha)
    return slider.scene(force, ["--segments"], speed, alpha_s_per_m=alpha)


FAMILIES = families(
    strokes, from_rest, segments,
    short_strokes=lambda rng: strokes(rng, 10),
)
