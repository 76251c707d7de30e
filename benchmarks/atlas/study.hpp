#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

// What all studies of the atlas share: effort, timing, medians, files.

namespace atlas {

enum class Effort { Quick, Full };

struct File {
  std::string name;
  std::string content;
};

/// CPU seconds of this thread: other work on the machine disturbs them less than the clock on the wall.
double cpu_now_s();

/// CPU seconds of one call: median of `repeats` batches, each long enough for the clock.
double time_call_s(const std::function<void()>& call, std::size_t repeats);

/// Empty: not finite.
double median_of(std::vector<double> values);

/// Spread that 68 % of normal errors would have: 1.4826 times the median size. Wild errors do not move it.
double robust_size(std::vector<double> errors);

/// Even steps of the logarithm, both ends included.
std::vector<double> log_spaced(double low, double high, std::size_t count);

/// "" for what is not finite.
std::string cell(double value);

std::vector<File> study_forward(Effort effort);
std::vector<File> study_frequency(Effort effort);
std::vector<File> study_fits(Effort effort);
std::vector<File> map_failures(Effort effort);
/// Of fits, where an average of the sensor or friction that weakens bends the slips.
std::vector<File> map_term_failures(Effort effort);

}  // namespace atlas
