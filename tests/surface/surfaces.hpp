#pragma once

#include <cstddef>
#include <functional>
#include <random>

#include "slipfit/surface/surface.hpp"

namespace test {

/// Ridges one after another whose widths scatter about `spacing` samples, each a straight rise with a steep end, with
/// white roughness. Heights of 1 um, pitch of 1 um.
struct Ridged {
  double spacing = 40.0;
  double scatter = 0.0;
  double roughness = 0.0;
  double count = 40.0;
};

inline slipfit::Profile ridged_profile(const Ridged& ridged, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  slipfit::Profile profile;
  profile.file = "simulated";
  profile.pitch_m = 1e-6;
  double begin = -ridged.spacing * std::uniform_real_distribution<double>()(generator);
  double end = begin;
  const auto points = static_cast<std::size_t>(ridged.spacing * ridged.count);
  for (std::size_t i = 0; i < points; ++i) {
    const auto place = static_cast<double>(i);
    while (end <= place) {
      begin = end;
      end += ridged.spacing * std::max(0.1, 1.0 + ridged.scatter * normal(generator));
    }
    const double part = (place - begin) / (end - begin);
    const double height = part < 0.9 ? part / 0.9 : (1.0 - part) / 0.1;
    profile.height.push_back(1e-6 * (height + ridged.roughness * normal(generator)));
  }
  return profile;
}

inline slipfit::Profile profile_of(std::size_t points, const std::function<double(std::size_t)>& height_m) {
  slipfit::Profile profile;
  profile.file = "simulated";
  profile.pitch_m = 1e-6;
  for (std::size_t i = 0; i < points; ++i) profile.height.push_back(height_m(i));
  return profile;
}

}  // namespace test
