#pragma once

#include <string>

#include "slipfit/pipeline.hpp"

namespace slipfit {

struct Judgement {
  Verdict verdict = Verdict::Undetermined;
  std::string reason;
  bool model_fits = false;  ///< the fitted cycles are the model's: its parameters mean something
};

/// Median interval between slips in periods of the mains, 50 or 60 Hz, whichever is nearer; 0 below 2 slips.
double mains_share(const Segmentation& segmentation);

/// Of the detected slips; 0 where there are none.
double median_drop(const Segmentation& segmentation);

/// Sudden falls after slow rises, in nearly all cycles: what makes stick-slip, whatever model fits it.
bool slips_are_sudden(const Segmentation& segmentation);

/// Falls well above the noise and quicker than a sine's: counting them gives the frequency of slips, not of noise or
/// hum.
bool slips_stand_out(const Segmentation& segmentation);

/// What the fitted cycles show. `fit` empty: too few cycles could be fitted.
Judgement judge_fit(const Recording& recording, const Segmentation& segmentation, const SpectralFrequency& spectral,
                    const FitResult* fit);

/// A guess from the detected cycles alone (no model fit).
Judgement judge_shape(const Recording& recording, const Segmentation& segmentation, const SpectralFrequency& spectral);

}  // namespace slipfit
