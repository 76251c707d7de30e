#include "slipfit/fit/parameter.hpp"

#include <algorithm>

namespace slipfit {
namespace {

using Id = ParameterId;

// identified_below: 5 % for what straight ramps and the timing of slips determine, 10 % for forces and what follows
// from two of them, a quarter for what only the shape of a slip determines. These are conventions; the coverage of what
// they let through is in docs/accuracy.md.
constexpr std::array kTable{
    ParameterInfo{Id::Stiffness, "stiffness_N_per_m", "tangential stiffness k", "N/m", kNotNegative, 0.05, true},
    ParameterInfo{Id::StiffnessExponent, "stiffness_exponent", "stiffness exponent p, k ~ V^p", "", kAnyNumber, 0.25},
    ParameterInfo{Id::StiffnessRatio, "stiffness_ratio", "k at the end of the path over k at its start", "",
                  kNotNegative, 0.1},
    ParameterInfo{Id::FrictionDifference, "friction_difference_N", "friction drop F_s - F_k", "N", kNotNegative, 0.1},
    ParameterInfo{Id::FrictionCoefficientDifference, "friction_coefficient_difference",
                  "drop of the friction coefficient", "", kNotNegative, 0.1},
    ParameterInfo{Id::Ageing, "ageing_N", "ageing rate B of static friction", "N", kAnyNumber, 0.25},
    ParameterInfo{Id::AgeingTime, "ageing_time_s", "ageing cut-off time t_c", "s", kNotNegative, 0.25},
    ParameterInfo{Id::StaticFriction, "static_friction_N", "static friction F_s", "N", kAnyNumber, 0.1, false, true},
    ParameterInfo{Id::StaticFrictionCoefficient, "static_friction_coefficient", "static friction coefficient", "",
                  kAnyNumber, 0.1, false, true},
    ParameterInfo{Id::KineticFriction, "kinetic_friction_N", "kinetic friction F_k", "N", kAnyNumber, 0.1, false, true},
    ParameterInfo{Id::KineticFrictionCoefficient, "kinetic_friction_coefficient", "kinetic friction coefficient", "",
                  kAnyNumber, 0.1, false, true},
    ParameterInfo{Id::NaturalFrequency, "natural_frequency_rad_per_s", "natural frequency w_n", "rad/s", kNotNegative,
                  0.05, true},
    ParameterInfo{Id::Mass, "mass_kg", "effective mass m", "kg", kNotNegative, 0.1},
    ParameterInfo{Id::DampingRatio, "damping_ratio", "damping ratio zeta", "", kShare, 0.25, true},
    ParameterInfo{Id::DampingCoefficient, "damping_coefficient_N_s_per_m", "damping coefficient c", "N s/m",
                  kNotNegative, 0.25},
    ParameterInfo{Id::FrictionSlope, "friction_slope_N_s_per_m", "slope f1 alpha of F_k at v = 0", "N s/m", kAnyNumber,
                  0.25},
    ParameterInfo{Id::Alpha, "alpha_s_per_m", "velocity dependence alpha", "s/m", kAnyNumber, 0.25},
    ParameterInfo{Id::F0, "f0_N", "friction at high speed f0", "N", kAnyNumber, 0.25},
    ParameterInfo{Id::F1, "f1_N", "velocity-dependent friction f1", "N", kAnyNumber, 0.25},
    ParameterInfo{Id::Mu0, "mu0", "friction coefficient mu0", "", kAnyNumber, 0.25},
    ParameterInfo{Id::Mu1, "mu1", "friction coefficient mu1", "", kAnyNumber, 0.25},
    ParameterInfo{Id::SensorAverage, "sensor_average_s", "sensor averaging time T_b", "s", kNotNegative, 0.25},
    ParameterInfo{Id::SlipDistance, "slip_distance_m", "slip-weakening distance D_c", "m", kNotNegative, 0.25},
    ParameterInfo{Id::ReloadForce, "reload_force_N", "force recovery after a slip, A", "N", kNotNegative, 0.25},
    ParameterInfo{Id::ReloadLength, "reload_length_m", "recovery length l", "m", kNotNegative, 0.25},
    ParameterInfo{Id::Relaxation, "relaxation", "share of k that relaxes", "", kShare, 0.25},
    ParameterInfo{Id::RelaxationTime, "relaxation_time_s", "relaxation time t_r", "s", kNotNegative, 0.25}};

}  // namespace

std::span<const ParameterInfo> parameter_table() {
  return kTable;
}

const ParameterInfo& info(ParameterId id) {
  return kTable[static_cast<std::size_t>(id)];
}

std::optional<ParameterId> parameter_with_key(std::string_view key) {
  const auto* const found =
      std::find_if(kTable.begin(), kTable.end(), [key](const auto& row) { return row.key == key; });
  return found == kTable.end() ? std::nullopt : std::optional(found->id);
}

}  // namespace slipfit
