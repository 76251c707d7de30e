#include "forward_methods.hpp"

#include <fmt/format.h>

#include "rivals.hpp"

namespace atlas {
namespace {

using Rival = Answer (*)(const ForwardScene&, const WaveTimes&, double);

void add_settings(std::vector<ForwardMethod>& methods, const std::string& family, Rival rival,
                  const std::vector<double>& settings) {
  for (const double setting : settings) {
    methods.push_back({family, fmt::format("{:g}", setting), [rival, setting](const auto& scene, const auto& times) {
                         return rival(scene, times, setting);
                       }});
  }
}

}  // namespace

std::vector<ForwardMethod> forward_methods() {
  std::vector<ForwardMethod> methods{{"sawtooth limit", "", run_sawtooth},
                                     {"undamped closed form", "", run_undamped},
                                     {"paper's approximation", "", run_paper},
                                     {"exact damped", "", run_damped},
                                     {"velocity tier", "", run_velocity}};
  add_settings(methods, "RK4, sign switching", run_sign_switching, {0.3, 0.1, 0.03, 0.01, 0.003, 0.001});
  add_settings(methods, "time stepping (Moreau)", run_time_stepping, {0.1, 0.03, 0.01, 0.003, 0.001});
  add_settings(methods, "ODE 5(4), event location", run_event_location, {1e-3, 1e-5, 1e-7, 1e-9, 1e-11});
  add_settings(methods, "switch model (Leine)", run_switch_model, {1e-2, 1e-3, 1e-4, 1e-5, 1e-6});
  add_settings(methods, "tanh-smoothed", run_smoothed, {1e-2, 1e-3, 1e-4, 1e-5});
  return methods;
}

}  // namespace atlas
