#pragma once

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "slipfit/core/recording.hpp"
#include "support/recordings.hpp"

/// Traces for the tests of this folder: generated ones, and the ones that stand beside the checkout.
namespace traces {

using Generator = std::mt19937_64;

inline slipfit::Recording recording(std::vector<double> time_s, std::vector<double> force) {
  return test::recording_of(std::move(time_s), std::move(force), 1e-3);
}

inline std::vector<double> clock(std::size_t samples, double rate_Hz) {
  std::vector<double> time_s(samples);
  for (std::size_t i = 0; i < samples; ++i) time_s[i] = static_cast<double>(i) / rate_Hz;
  return time_s;
}

/// Ramps of slope 1 a period with sudden falls; every period is drawn on its own, so its scatter adds up.
struct SawTooth {
  double frequency_Hz = 1.0;
  double jitter = 0.0;      ///< relative scatter of a period
  double slip_share = 0.0;  ///< of the period that the fall takes
};

inline std::vector<double> saw_tooth(const SawTooth& shape, const std::vector<double>& time_s, Generator& generator) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform;
  const double usual = 1.0 / shape.frequency_Hz;
  double start = time_s.front() - uniform(generator) * usual;
  double period = usual;
  std::vector<double> force;
  force.reserve(time_s.size());
  for (const double t : time_s) {
    while (t >= start + period) {
      start += period;
      period = usual * std::max(0.2, 1.0 + shape.jitter * normal(generator));
    }
    const double ramp = (t - start) / usual;
    const double fall = shape.slip_share > 0.0 ? std::min(1.0, (t - start) / (usual * shape.slip_share)) : 1.0;
    force.push_back(ramp + (1.0 - fall));
  }
  return force;
}

inline void add_noise(std::vector<double>& force, double rms, Generator& generator) {
  std::normal_distribution<double> normal;
  for (double& value : force) value += rms * normal(generator);
}

inline void add_sine(std::vector<double>& force, const std::vector<double>& time_s, double frequency_Hz,
                     double amplitude) {
  for (std::size_t i = 0; i < force.size(); ++i) {
    force[i] += amplitude * std::sin(2.0 * std::numbers::pi * frequency_Hz * time_s[i]);
  }
}

/// x_i = memory x_(i-1) + white noise; memory 1 is a random walk.
inline std::vector<double> noise_with_memory(std::size_t samples, double memory, Generator& generator) {
  std::normal_distribution<double> normal;
  std::vector<double> force(samples);
  double value = 0.0;
  for (double& sample : force) sample = value = memory * value + normal(generator);
  return force;
}

/// First and last column of a plain CSV file; rows that are not numbers are left out. Empty: no such file.
inline std::optional<slipfit::Recording> load(const std::string& path) {
  std::ifstream file(path);
  if (!file) return std::nullopt;
  std::vector<double> time_s;
  std::vector<double> force;
  for (std::string line; std::getline(file, line);) {
    const std::string last = line.substr(line.rfind(',') + 1);
    char* end = nullptr;
    const double t = std::strtod(line.c_str(), &end);
    if (end == line.c_str()) continue;
    const double f = std::strtod(last.c_str(), &end);
    if (end == last.c_str() || !std::isfinite(f) || (!time_s.empty() && t < time_s.back())) continue;
    time_s.push_back(t);
    force.push_back(f);
  }
  return recording(std::move(time_s), std::move(force));
}

/// Rows of a CSV table by column name.
inline std::vector<std::map<std::string, std::string>> load_table(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> names;
  std::vector<std::map<std::string, std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    std::vector<std::string> values;
    for (std::string cell; std::getline(cells, cell, ',');) values.push_back(cell);
    if (names.empty()) {
      names = values;
      continue;
    }
    std::map<std::string, std::string> row;
    for (std::size_t i = 0; i < std::min(names.size(), values.size()); ++i) row[names[i]] = values[i];
    rows.push_back(std::move(row));
  }
  return rows;
}

inline std::string shared(const std::string& path) {
  return std::string(SLIPFIT_SHARED_DIR) + "/data/" + path;
}

}  // namespace traces
