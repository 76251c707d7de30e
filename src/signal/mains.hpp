#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "signal/transform.hpp"
#include "slipfit/core/recording.hpp"

namespace slipfit::signal {

/// A peak of a spectrum where the mains or one of its harmonics would be.
struct MainsLine {
  double frequency_Hz = 0.0;
  double mains_Hz = 0.0;  ///< 50 or 60
  int order = 1;
  double width_Hz = 0.0;  ///< half width that the line takes
  double error_Hz = 0.0;  ///< up to which its frequency is known, in the spectrum of a trace
};

/// Lines four times (in amplitude) above their neighbours at multiples of 50 or of 60 Hz, whichever has more power in
/// them: a laboratory has one mains. `known_Hz`: lines that are no longer in the spectrum.
std::vector<MainsLine> find_mains(std::span<const double> power, double bin_Hz, double resolution_Hz,
                                  std::span<const double> known_Hz = {});

/// The highest peak at `lowest_Hz` or above, where it is as narrow as a line and stands out of its surroundings more
/// than noise does once in a thousand recordings.
std::optional<double> strongest_line(std::span<const double> power, double bin_Hz, double resolution_Hz,
                                     double lowest_Hz);

/// Returns the lines that are the mains' in the spectrum of this trace: at its frequency within their errors, and with
/// their energy spread over the recording. A motion's may be near it, die out, or come once.
std::vector<MainsLine> lasting_mains(std::vector<MainsLine> lines, const UniformTrace& trace);

/// "mains 50 Hz", "3rd harmonic of 50 Hz mains".
std::string describe(const MainsLine& line);

/// Returns true if it is a multiple of 50 or 60 Hz within the accuracy of the mains (0.2 %) and of the recording.
bool is_of_mains(double frequency_Hz, double resolution_Hz);

/// The spectrum with the line replaced by the level around it.
void flatten(std::vector<double>& power, double bin_Hz, double resolution_Hz, const MainsLine& line);

/// 50 or 60 Hz where a multiple of the frequency, up to `harmonics`, is nearer to it than 1.5 resolutions: over the
/// whole duration the two drift apart by no more than one and a half turns.
std::optional<double> mains_in_step(double frequency_Hz, int harmonics, double duration_s);

/// The lines, without those of a mains with which the counted slips agree.
std::vector<MainsLine> without_hinted(std::vector<MainsLine> lines, std::optional<double> hint_Hz);

/// Returns true if a frequency is within the width of a line, or within `reach_Hz` if that is larger.
bool is_on_line(const std::vector<MainsLine>& lines, double frequency_Hz, double reach_Hz);

/// The force without lines of the mains, for looking at, not for fitting: cosine and sine of each under a Hann window,
/// which keeps the cycles' own lines out.
struct Dehummed {
  std::vector<double> lines_Hz;  ///< empty: none is significant, or the mains is slower than 4 turns
  std::vector<double> force;
  double swing = 0.0;  ///< peak to peak, the largest line
};

Dehummed without_mains(const Recording& recording);

}  // namespace slipfit::signal
