#pragma once

#include <cstddef>
#include <vector>

namespace slipfit::fit {

/// Variance of a sample of `count` values, above 0.
struct SampleVariance {
  double variance = 0.0;
  std::size_t count = 0;
};

/// Returns each variance drawn towards the one that the samples have in common. It is drawn the more the smaller its
/// sample is and the less the samples differ by more than chance explains: the empirical Bayes estimate of Smyth
/// (2004), Stat. Appl. Genet. Mol. Biol. 3(1), 3, section 6.2. As a weight the variance of three values misleads: where
/// these are alike by chance they outweigh all others.
std::vector<double> moderated_variances(const std::vector<SampleVariance>& samples);

}  // namespace slipfit::fit
