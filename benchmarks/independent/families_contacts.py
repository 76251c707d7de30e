"""Families of contacts and instruments beyond the model: springs that relax, friction that changes along the slip, a load that
follows the force, and filters of higher order."""
import math

from scipy.interpolate import CubicSpline
from scipy.signal import butter, lfilter, lfilter_zi

from families_outside import SHARED
from scenes import draw_rig, families, np, scene, simulate

K_AND_MASS = ("stiffness_N_per_m", "mass_kg")


def _relaxing(rng, shares, times):
    rig = draw_rig(rng)
    model = rig.model
    model.relax_share, model.relax_time = rng.uniform(*shares), rig.period_s * 10 ** rng.uniform(*times)
    return rig


def relaxing_solid(rng):
    """A standard linear solid in place of the spring."""
    rig = _relaxing(rng, (0.05, 0.6), (-2, 1))
    return scene(rig, rig.run(), known=K_AND_MASS)


def relaxing_prony(rng):
    """Two relaxation times, a decade or more apart."""
    rig = _relaxing(rng, (0.05, 0.3), (-2, -0.5))
    rig.model.slow_share, rig.model.slow_time = rng.uniform(0.05, 0.3), rig.model.relax_time * 10 ** rng.uniform(1, 2)
    return scene(rig, rig.run(), known=K_AND_MASS)


def relaxing_rubber(rng):
    """A relaxing spring, friction that falls over a slip distance, and slips that scatter."""
    rig = _relaxing(rng, (0.1, 0.4), (-1.5, 0.5))
    rig.model.weakening_length = rng.uniform(0.05, 0.3) * rig.drop / rig.model.stiffness
    return scene(rig, rig.run(factors=np.exp(0.05 * rng.standard_normal(200))), known=K_AND_MASS)


def flash_temperature(rng):
    """The heat of the slip lowers the kinetic friction by 5 to 50 % of F_s - F_k, and leaves within the stick."""
    rig = draw_rig(rng)
    slip_m = 2 * rig.drop / rig.model.stiffness
    rig.model.heat_slope = rng.uniform(0.05, 0.5) * rig.drop / slip_m
    rig.model.heat_time = math.pi / rig.model.omega * rng.uniform(0.5, 2)
    return scene(rig, rig.run(), known=SHARED)


def stribeck_minimum(rng):
    """Kinetic friction falls with the sliding speed and rises again within the speeds of a slip."""
    rig = draw_rig(rng)
    fastest = rig.drop / rig.model.stiffness * rig.model.omega
    rig.model.stribeck_force, rig.model.stribeck_speed = rig.drop * rng.uniform(0.1, 0.5), fastest * rng.uniform(0.05, 0.3)
    rig.drop += rig.model.stribeck_force
    rig.model.quadratic = rng.uniform(0.1, 0.4) * rig.drop / fastest**2
    return scene(rig, rig.run(), known=SHARED)


def _rough(rng, share):
    """A rough track: F_s scatters between the slips by 3 to 30 % of F_s - F_k, and F_k by `share` of it at the same places."""
    rig = draw_rig(rng)
    time_s, speed, static, kinetic = rig.course((rig.count + 1) * rig.period_s)
    spots = rng.standard_normal(rig.count + 3)[(time_s / rig.period_s).astype(int)]
    spots *= rig.drop * np.exp(rng.uniform(*np.log((0.03, 0.3))))
    motion = simulate(rig.model, rig.step, speed, static + spots, kinetic + share * spots, start_force=rig.start_force())
    return scene(rig, motion)


def _fixed_depth(rng):
    rig = draw_rig(rng)
    rig.model.load_slope = rng.choice([-1, 1]) * rng.uniform(0.03, 0.2)
    return rig


def fixed_depth(rng):
    """The bending of the holder changes the load as it changes the force."""
    rig = _fixed_depth(rng)
    return scene(rig, rig.run(), known=SHARED)


def fixed_depth_measured(rng):
    """The same with a column of the normal force."""
    rig = _fixed_depth(rng)
    motion = rig.run()
    result = scene(rig, motion, known=SHARED)
    load = rig.kinetic / rng.uniform(0.3, 1.0)
    share = 1 + rig.model.load_slope * (motion.force - rig.kinetic) / rig.kinetic
    result.normal_N = load * (share + 1e-3 * rng.standard_normal(len(share)))
    return result


def _corner_Hz(rig, rng, lowest, highest):
    return rig.model.omega / (2 * math.pi) * math.exp(rng.uniform(math.log(lowest), math.log(highest)))


def _filtered(rng, order):
    rig = draw_rig(rng, per_slip=(20, 60))
    motion = rig.run()
    cut_off_Hz = _corner_Hz(rig, rng, 3, 15)
    b, a = butter(order, min(0.9, 2 * cut_off_Hz * rig.step))
    force = motion.force + rig.white(len(motion.force))
    return scene(rig, motion, lfilter(b, a, force, zi=lfilter_zi(b, a) * force[0])[0], noise=False)


def filter_stated(rng):
    """An analogue filter of second to fourth order at 1 to 15 times the natural frequency, whose data sheet is at hand."""
    order, finer = int(rng.integers(2, 5)), 16
    rig = draw_rig(rng, per_slip=(20, 60))
    motion = rig.run()
    corner_Hz = _corner_Hz(rig, rng, 1, 15)
    b, a = butter(order, min(0.9, 2 * corner_Hz * rig.step / finer))
    fine_s = np.linspace(motion.time_s[0], motion.time_s[-1], finer * (len(motion.time_s) - 1) + 1)
    force = CubicSpline(motion.time_s, motion.force)(fine_s)
    shown = lfilter(b, a, force, zi=lfilter_zi(b, a) * force[0])[0][::finer]
    result = scene(rig, motion, shown)
    result.truth["options"] = ["--sensor-filter", f"{order}, {corner_Hz:.9g} Hz"]
    return result


FAMILIES = families(
    relaxing_solid, relaxing_prony, relaxing_rubber, flash_temperature, stribeck_minimum, fixed_depth, fixed_depth_measured, filter_stated,
    filter_second=lambda rng: _filtered(rng, 2),  # a Butterworth filter of second order at 3 to 15 times the natural frequency
    filter_third=lambda rng: _filtered(rng, 3),
    filter_fourth=lambda rng: _filtered(rng, 4),
    rough_5=lambda rng: _rough(rng, 0.05),
    rough_10=lambda rng: _rough(rng, 0.1),
    rough_30=lambda rng: _rough(rng, 0.3),
    rough_80=lambda rng: _rough(rng, 0.8),
)
