#pragma once

namespace slipfit {

/// The conditions of a recording that was made or is planned.
struct RecordingPlan {
  double speed_m_per_s = 0.0;
  double sample_rate_Hz = 0.0;
  double duration_s = 0.0;
};

}  // namespace slipfit
