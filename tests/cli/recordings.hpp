#pragma once

#include <functional>
#include <string>

namespace test {

/// CSV of time_s,force_N with `samples` rows; force_N(time_s) gives the force.
std::string recording_csv(std::size_t samples, double sample_rate_Hz, const std::function<double(double)>& force_N);

/// A saw-tooth with a fall of one tenth of the period: stick-slip to any eye. 10 N to 15 N.
double sawtooth_N(double time_s, double period_s);

/// A sweep in one file: the saw-tooth for 4 s each at 10, 20 and 40 mm/s, with a column of speeds; 2.5, 5 and 10 Hz.
std::string segments_csv();

/// What `slipfit simulate` says about a slider with plain stick-slip at 0.02 m/s (about 5 Hz): 4 s at 1 kHz, noise 0.02
/// N.
std::string simulated_csv(const std::string& seed);

}  // namespace test
