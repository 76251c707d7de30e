// The scatter of a few cycles as a weight in a joint fit.
#include "fit/sweep/sweep_data.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

using slipfit::fit::moderated_variances;
using slipfit::fit::SampleVariance;

TEST_CASE("a mean weighted by moderated variances of three values each scatters as that of equal weights") {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  constexpr int kSets = 400;
  constexpr std::size_t kSamples = 6;
  double square = 0.0;
  for (int set = 0; set < kSets; ++set) {
    std::vector<SampleVariance> samples;
    std::vector<double> means;
    for (std::size_t i = 0; i < kSamples; ++i) {
      const double a = normal(random), b = normal(random), c = normal(random);
      means.push_back((a + b + c) / 3.0);
      const double mean = means.back();
      samples.push_back({0.5 * (std::pow(a - mean, 2) + std::pow(b - mean, 2) + std::pow(c - mean, 2)), 3});
    }
    const std::vector<double> variances = moderated_variances(samples);
    double sum = 0.0, weights = 0.0;
    for (std::size_t i = 0; i < kSamples; ++i) {
      sum += means[i] / variances[i];
      weights += 1.0 / variances[i];
    }
    square += std::pow(sum / weights, 2);
  }
  // Equal weights give 1/18 with a relative standard error of sqrt(2/400) = 7 %; the variances of three values as they
  // are give 2.3 times as much.
  CHECK(square / kSets < 1.25 / 18.0);
}
