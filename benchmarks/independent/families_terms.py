"""Families of the terms that measured recordings ask for, alone and together: an average of the instrument, friction that
weakens over a slip distance, a rise after slips, a spring that relaxes."""
import math

from scenes import PARAMETERS, Scene, draw_rig, families, np, truth_of

FINE = 8  # steps of the simulator in one of the recording
FINER = 60  # where a slip has few samples


def _log_uniform(rng, low, high):
    return math.exp(rng.uniform(math.log(low), math.log(high)))


def _averaged(time_s, force, window_s, every):
    """Moving average over the window, exact for a force that is straight between samples, at every so many samples."""
    integral = np.concatenate([[0.0], np.cumsum(0.5 * (force[1:] + force[:-1]) * np.diff(time_s))])
    centre = time_s[(time_s > 0.5 * window_s) & (time_s < time_s[-1] - 0.5 * window_s)][::every]
    return centre, (np.interp(centre + 0.5 * window_s, time_s, integral) - np.interp(centre - 0.5 * window_s, time_s, integral)) / window_s


def _release(omega, zeta, force, step, seconds):
    """Free oscillation to 0 of a spring force that is let go at rest: values after the one given."""
    t = np.arange(1, int(seconds / step)) * step
    damped = math.sqrt(1 - zeta * zeta)
    return force * np.exp(-zeta * omega * t) * (np.cos(damped * omega * t) + zeta / damped * np.sin(damped * omega * t))


def _scene(rng, average=False, weakens=False, reloads=False, rings=None, relaxes=False, shortens=False, coarse=False):
    """`rings`: by which w_n of the slips differs from that of the ring-down after a release at the end; None: no release.
    `coarse`: 2 to 6 samples a slip, as loggers of testing machines take."""
    rig = draw_rig(rng, per_slip=(2, 6) if coarse else (20, 60), ratio=(5, 25))
    fine = FINER if coarse else FINE
    rig.step /= fine
    if weakens:
        rig.model.weakening_length = _log_uniform(rng, 0.02, 0.6) * rig.drop / rig.model.stiffness
    if reloads:
        rig.model.reload_force = rig.drop * rng.uniform(0.1, 0.3)
        rig.model.reload_length = rig.drop / rig.model.stiffness * rng.uniform(0.2, 0.5)
    if relaxes:
        rig.model.relax_share = _log_uniform(rng, 0.05, 0.7)
        rig.model.relax_time = _log_uniform(rng, 0.01, 10.0) * rig.period_s
    seconds = (rig.count + 2) * rig.period_s
    if shortens:  # k at the end of the path over k at its start
        rig.model.line_length = rig.speed * seconds / (1 - 1 / _log_uniform(rng, 1.05, 1.6) ** rng.choice([-1, 1]))
    motion = rig.run(seconds)
    window_s = _log_uniform(rng, 0.3, 6.0) / rig.model.omega if average else 0.0
    time_s, force, end_s = motion.time_s, motion.force, motion.time_s[-1]
    if rings:
        ring = _release(rings * rig.model.omega, rig.model.damping_ratio, force[-1], rig.step, rng.uniform(2, 4) * rig.period_s)
        force = np.concatenate([force, ring])
        time_s = np.arange(len(force)) * rig.step
    if average:
        time_s, force = _averaged(time_s, force, window_s, fine)
    else:
        time_s, force = time_s[::fine], force[::fine]
    stretch = (time_s[0], min(time_s[-1], end_s))
    truth = truth_of(rig, motion.slips, stretch, PARAMETERS)
    truth["slips_s"] = [slip - time_s[0] for slip in truth["slips_s"]]
    truth["stretch_s"] = [0.0, float(stretch[1] - stretch[0])]
    if average:
        truth["parameters"]["sensor_average_s"] = window_s
    truth["parameters"]["mass_kg"] = rig.model.stiffness / rig.model.omega**2
    if shortens:
        growth = 1 / (1 - rig.speed * np.array([truth["slips_s"][1], truth["slips_s"][-1], 0.4 * end_s, 0.6 * end_s]) / rig.model.line_length)
        middle = growth[2:]  # give or take a tenth of the path
        truth["parameters"]["stiffness_N_per_m"] = sorted(rig.model.stiffness * middle)
        truth["parameters"]["natural_frequency_rad_per_s"] = sorted(rig.model.omega * np.sqrt(middle))
        truth["parameters"]["damping_ratio"] = sorted(rig.model.damping_ratio / np.sqrt(middle))
        truth["parameters"]["stiffness_ratio"] = sorted([growth[1] / growth[0], 1 / (1 - rig.speed * end_s / rig.model.line_length)])
    if relaxes:  # k between the relaxed and the instantaneous one is right, and w_n goes with it
        for name in ("stiffness_N_per_m", "natural_frequency_rad_per_s", "damping_ratio"):
            del truth["parameters"][name]
        truth["stiffness_N_per_m"] = [rig.model.stiffness * (1 - rig.model.relax_share), rig.model.stiffness]
        truth["relax_time_in_periods"] = rig.model.relax_time / rig.period_s
    return Scene(time_s - time_s[0], force + rig.white(len(force)), truth)


FAMILIES = families(
    none=lambda rng: _scene(rng),
    average=lambda rng: _scene(rng, average=True),
    weakens=lambda rng: _scene(rng, weakens=True),
    reloads=lambda rng: _scene(rng, reloads=True),
    average_weakens=lambda rng: _scene(rng, average=True, weakens=True),
    average_reloads=lambda rng: _scene(rng, average=True, reloads=True),
    weakens_reloads=lambda rng: _scene(rng, weakens=True, reloads=True),
    average_weakens_reloads=lambda rng: _scene(rng, average=True, weakens=True, reloads=True),
    rings=lambda rng: _scene(rng, rings=1.0),
    average_rings=lambda rng: _scene(rng, average=True, rings=1.0),
    rings_otherwise=lambda rng: _scene(rng, rings=rng.uniform(1.15, 2.0)),  # another mode than that of the slips rings after the release
    shortens=lambda rng: _scene(rng, shortens=True),  # a line of which the drive takes or gives some: k changes along the path
    shortens_average=lambda rng: _scene(rng, shortens=True, average=True),
    coarse_average=lambda rng: _scene(rng, average=True, coarse=True),
    coarse_average_reloads=lambda rng: _scene(rng, average=True, reloads=True, coarse=True),
    relaxes=lambda rng: _scene(rng, relaxes=True),  # a standard linear solid in place of the spring, and the damper
)
