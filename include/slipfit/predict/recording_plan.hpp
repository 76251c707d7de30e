#pragma once

namespace slipfit {

/// How a recording was made, or would be.
struct RecordingPlan {
  double speed_m_per_s = 0.0;
  double sample_rate_Hz = 0.0;
  double duration_s = 0.0;
};

}  // namespace slipfit
