"""The simulator of simulator.cpp for Python: compiled on first use, shares no code with slipfit. Needs numpy and g++."""
import ctypes
import dataclasses
import hashlib
import pathlib
import subprocess
import tempfile

import numpy as np

SOURCE = pathlib.Path(__file__).with_name("simulator.cpp")
SLIP = np.dtype([("onset_s", float), ("end_s", float), ("onset_force", float), ("end_force", float)])
DOUBLES = np.ctypeslib.ndpointer(float, flags="C_CONTIGUOUS")


class Model(ctypes.Structure):
    _fields_ = [(name, ctypes.c_double) for name in (
        "stiffness omega damping_ratio stribeck_force stribeck_speed quadratic weakening_length ageing ageing_time "
        "creep_force creep_share reload_force reload_length stiffening sensor_omega sensor_damping precursor_at "
        "precursor_share aftershock_s aftershock_share velocity_law ageing_law "
        "relax_share relax_time servo_compliance servo_time slow_share slow_time heat_slope heat_time line_length load_slope").split()]


class Course(ctypes.Structure):
    _fields_ = [(name, ctypes.c_void_p) for name in ("speed", "static_friction", "kinetic_friction", "slip_factor")] + [
        ("samples", ctypes.c_long), ("factors", ctypes.c_long), ("step", ctypes.c_double), ("substeps", ctypes.c_int)]


def load():
    digest = hashlib.sha1(SOURCE.read_bytes() + SOURCE.with_suffix(".hpp").read_bytes()).hexdigest()[:12]
    library = pathlib.Path(tempfile.gettempdir()) / f"slipfit_simulator_{digest}.so"
    if not library.exists():
        made = library.with_suffix(f".{id(digest)}")
        subprocess.run(["g++", "-O2", "-std=c++20", "-shared", "-fPIC", "-o", made, SOURCE], check=True)
        made.rename(library)
    return ctypes.CDLL(str(library))


LIBRARY = load()


@dataclasses.dataclass
class Motion:
    """What was simulated: force at every sample before noise, the slips, and the position of the drive."""
    time_s: np.ndarray
    force: np.ndarray
    slips: np.ndarray
    drive_m: np.ndarray = None


def simulate(model, step, speed, static_friction, kinetic_friction, factors=(1.0,), start_force=0.0):
    """`speed` (m/s), and both frictions (N), one value a sample; `factors`: F_s - F_k of each slip over its mean."""
    columns = [np.ascontiguousarray(np.broadcast_to(c, speed.shape), float) for c in (speed, static_friction, kinetic_friction)]
    factors = np.ascontiguousarray(factors, float)
    fastest = max(model.omega, model.sensor_omega)
    if model.weakening_length > 0:  # the slip begins as exp(t times this); a step over its kink is wrong by the square of the step
        fastest *= 10 * np.sqrt(max(1.0, np.max(columns[1] - columns[2]) / (model.stiffness * model.weakening_length)))
    substeps = max(1, int(np.ceil(step * fastest / 0.05)))
    course = Course(*[c.ctypes.data for c in columns], factors.ctypes.data, len(speed), len(factors), step, substeps)
    force, behind = np.zeros(len(speed)), np.zeros(len(speed))
    slips = np.zeros(5000, SLIP)
    run = LIBRARY.simulate
    run.restype = ctypes.c_long
    run.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_double, DOUBLES, DOUBLES, ctypes.c_void_p, ctypes.c_long]
    count = run(ctypes.byref(model), ctypes.byref(course), start_force, force, behind, slips.ctypes.data, len(slips))
    drive_m = np.concatenate([[0.0], np.cumsum(columns[0])[:-1]]) * step - behind
    return Motion(np.arange(len(speed)) * step, force, slips[:count], drive_m)


def simulate_lugre(k, omega, zeta, fs, fk, stribeck_speed, sigma0, sigma1, speed, step, samples):
    force = np.zeros(samples)
    run = LIBRARY.simulate_lugre
    run.argtypes = [ctypes.c_double] * 10 + [ctypes.c_long, ctypes.c_int, DOUBLES]
    mass = k / omega**2
    substeps = max(1, int(np.ceil(step * np.sqrt((sigma0 + k) / mass) / 0.1)))
    run(k, omega, zeta, fs, fk, stribeck_speed, sigma0, sigma1, speed, step, samples, substeps, force)
    return force


def write_csv(path, time_s, force, displacement_m=None, normal_N=None, speed_m_per_s=None):
    """Time and force, and a column of each of the others that is given."""
    others = [("displacement_mm", "%.9g", None if displacement_m is None else 1e3 * displacement_m), ("normal_force_N", "%.7g", normal_N),
              ("speed [m/s]", "%.17g", speed_m_per_s)]
    others = [column for column in others if column[2] is not None]
    if others:
        names, formats, values = zip(*others)
        np.savetxt(path, np.c_[(time_s, force, *values)], fmt=("%.9g", "%.7g", *formats), delimiter=",",
                   header=",".join(("time_s", "force_N", *names)), comments="")
        return
    run = LIBRARY.write_csv
    run.argtypes = [ctypes.c_char_p, DOUBLES, DOUBLES, ctypes.c_long]
    time_s, force = (np.ascontiguousarray(c, float) for c in (time_s, force))
    if run(str(path).encode(), time_s, force, len(time_s)):
        raise OSError(f"cannot write {path}")
