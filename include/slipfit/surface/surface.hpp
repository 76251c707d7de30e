#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "slipfit/core/estimate.hpp"
#include "slipfit/core/recording.hpp"
#include "slipfit/core/result.hpp"

namespace slipfit {

/// Heights along a worn track at equal distances; NaN where nothing was measured.
struct Profile {
  std::string file;
  double pitch_m = 0.0;
  std::vector<double> height;       ///< in metres, or grey values
  bool height_in_metres = true;     ///< false: grey values of an image, or heights without a unit
  std::size_t rows = 1;             ///< averaged across the direction of sliding
  std::optional<double> along_rad;  ///< direction of sliding from the x axis of an areal measurement
  /// The number of samples after which the encoding of the file repeats (the blocks of JPEG): a spacing equal to it is
  /// not reported.
  std::optional<double> block_samples;
  std::vector<std::string> assumed;
  std::vector<InputFile> inputs;  ///< that were read
};

/// Properties of the file that the user states; everything left empty is detected and listed in `Profile::assumed`.
struct ProfileOptions {
  std::optional<double> unit_m;         ///< of lengths and heights of a text without units
  std::optional<double> pitch_m;        ///< of a text of heights alone
  std::optional<double> pixel_m;        ///< of an image
  std::optional<double> along_rad;      ///< direction of sliding from the x axis of an areal measurement
  std::optional<std::string> x_column;  ///< name, or 1-based number as text
  std::optional<std::string> z_column;
};

/// Reads a text with heights, X3P (ISO 25178-72), SDF (ISO 25178-71), PNG, TIFF or JPEG. Errors contain file and remedy
/// in one line; docs/formats.md lists their codes.
Result<Profile> read_profile(const std::filesystem::path& file, const ProfileOptions& options = {});

/// The pattern along the profile. Periodic: distances scatter by less than a fifth; irregular: by more, but the mean is
/// known; none: nothing more regular than on a random surface; undetermined: a pattern without sufficient evidence.
enum class SurfaceStatus { Periodic, Irregular, None, Undetermined };

/// The method that determined the spacing: the ridges, or the lines of the spectrum.
enum class SurfaceMethod { Ridges, Comb };

struct Surface {
  SurfaceStatus status = SurfaceStatus::Undetermined;
  Estimate spacing_m;                     ///< mean distance of the ridges: of all that the same rubbing would leave
  Estimate fine_spacing_m;                ///< of a finer pattern on the same track
  Estimate ridge_height;                  ///< peak over the next valley, in metres or grey values
  Estimate begin_spacing_m;               ///< of a straight line through the distances, at the first ridge
  Estimate end_spacing_m;                 ///< at the last ridge
  std::optional<double> spacing_sd_m;     ///< from ridge to ridge, what locating them adds included
  std::optional<double> rsm_m;            ///< RSm of ISO 21920-2 (ISO 4287)
  std::optional<double> asymmetry;        ///< median length of a rise over that of a fall, in the direction of x
  std::optional<double> cutoff_m;         ///< of the Gaussian filter (ISO 16610-21) that took form and waviness
  std::optional<double> smoothed_over_m;  ///< of the one that took the roughness before ridges were counted
  std::size_t ridges = 0;
  std::vector<double> ridge_places_m;   ///< from the first sample
  std::optional<SurfaceMethod> method;  ///< empty where there is no spacing
  Warnings warnings;
};

/// Measures the pattern of a profile. Errors: too_few_points, constant_profile, too_many_holes, too_few_ridges.
Result<Surface> measure_surface(const Profile& profile);

}  // namespace slipfit
