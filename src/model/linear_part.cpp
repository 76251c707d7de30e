#include "model/linear_part.hpp"

#include <array>
#include <cstddef>

namespace slipfit::model {

SlipPart linear_part(const PartTimes& times, const PartJet& z, const PartJet& slope, const LinearForce& force,
                     const PartJet& zeta, bool is_transmitted) {
  std::array<PartJet, kSeriesOrder + 2> series{z, slope};  // a term more, for the drag
  for (std::size_t n = 0; n + 2 < series.size(); ++n) {
    const auto order = static_cast<double>(n);
    PartJet sum = force.by_z * series[n] - 2.0 * zeta * (order + 1.0) * series[n + 1];
    if (n == 0) sum += force.constant;
    if (n == 1) sum += force.by_time;
    series[n + 2] = sum / ((order + 1.0) * (order + 2.0));
  }
  SlipPart part{times.begin, times.length, {}};
  for (std::size_t n = 0; n <= kSeriesOrder; ++n) {
    PartJet term = series[n];
    if (is_transmitted) term += 2.0 * zeta * (static_cast<double>(n) + 1.0) * series[n + 1];
    part.terms[n] = {term.a, term.v[0], term.v[1], term.v[2], 0.0};
  }
  return part;
}

}  // namespace slipfit::model
