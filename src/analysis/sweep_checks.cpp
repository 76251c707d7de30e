#include "analysis/sweep_checks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "core/statistics.hpp"
#include "core/thresholds.hpp"
#include "core/unknown.hpp"
#include "fit/report/recording_findings.hpp"
#include "signal/smoothing.hpp"
#include "slipfit/core/range.hpp"

namespace slipfit {

namespace {

struct Point {
  double log_speed = 0.0;
  double log_frequency = 0.0;
  double log_frequency_se = 0.0;
  double stick_share = 0.0;
  std::optional<double> log_fall;  ///< where the sampling resolves it
};

std::optional<Point> point_of(const Recording& recording, const Analysis& analysis) {
  // Frequencies that are not reported because they may not be slips are decided by the comparison of speeds.
  const FrequencyReport& report = analysis.frequency;
  const Estimate spectral{report.spectral.value_Hz, report.spectral.standard_error_Hz, {}, {}};
  const Estimate& frequency = report.quoted.value ? report.quoted : spectral;
  const std::optional<double> fall_s =
      analysis.cycles.slip_time_s ? analysis.cycles.slip_time_s : analysis.cycles.fall_time_s;
  if (!frequency.value || !frequency.standard_error || !fall_s) return std::nullopt;
  Point point;
  point.log_speed = std::log(recording.conditions().speed_m_per_s);
  point.log_frequency = std::log(*frequency.value);
  point.log_frequency_se = *frequency.standard_error / *frequency.value;
  point.stick_share = analysis.cycles.sticking_degree.value_or(0.0);
  if (*fall_s > thresholds::kSamplesOfFall * recording.sample_interval_s()) point.log_fall = std::log(*fall_s);
  return point;
}

/// Swings of a few samples, or seen through a long average, show no sticks whether there are any or not. A fall that is
/// averaged is known to a step of the clock.
bool slides(const Recording& recording, const Analysis& analysis, double average_s) {
  if (analysis.motion == MotionClass::SteadySliding) return true;
  const std::optional<double> frequency_Hz = analysis.frequency.quoted.value;
  return analysis.motion == MotionClass::OscillatorySlip && frequency_Hz &&
         *frequency_Hz * recording.sample_interval_s() * thresholds::kWellSampled < 1.0 &&
         *frequency_Hz * (average_s + recording.sample_interval_s()) < thresholds::kAverageOfSwing;
}

/// Returns true if the fit determines at least one parameter.
bool has_values(const Analysis& analysis) {
  return analysis.fit && std::ranges::any_of(analysis.fit->parameters, [](const Parameter& parameter) {
           return parameter.estimate.value.has_value();
         });
}

/// Stick-slip at one speed has one frequency, to the scatter of a surface.
Warnings check_frequency_at_one_speed(const std::vector<Point>& points) {
  const auto by_frequency = [](const Point& a, const Point& b) { return a.log_frequency < b.log_frequency; };
  const auto [low, high] = std::ranges::minmax_element(points, by_frequency);
  const double factor = std::exp(high->log_frequency - low->log_frequency);
  if (!(factor > thresholds::kOneSpeedFrequencies)) return {};
  return {{"frequency_differs_at_one_speed",
           fmt::format(
               "the stated speeds are nearly equal, but the frequencies differ by a factor of {:.2g}: check the speeds",
               factor)}};
}

SweepRole role_of(const Recording& recording, const Analysis& analysis) {
  // At the contact the sensor sees F_k(v) itself in a slip, and jumps: no force to fit together with the others.
  if (recording.conditions().force_view == ForceView::Contact) return SweepRole::LeftOut;
  if (analysis.motion == MotionClass::StickSlip) return has_values(analysis) ? SweepRole::Cycles : SweepRole::LeftOut;
  return analysis.motion == MotionClass::SteadySliding ? SweepRole::Steady : SweepRole::LeftOut;
}

/// Returns the number of samples in the fall of a slip, with those of the averaging time that the fit found.
double samples_per_fall(const Recording& recording, const FitResult& fit) {
  const double average_s = fit.estimate_of(ParameterId::SensorAverage).value.value_or(0.0);
  return fit.diagnostics.samples_per_slip + average_s / recording.sample_interval_s();
}

/// Returns true for stick-slip whose slips are too poorly sampled for their shape, even together.
bool is_unresolved(const Recording& recording, const Analysis& analysis) {
  return role_of(recording, analysis) == SweepRole::Cycles && analysis.fit->tier == Tier::Sawtooth &&
         analysis.fit->diagnostics.samples_per_slip > 0.0 &&
         samples_per_fall(recording, *analysis.fit) < thresholds::kResolvedSamples;
}

}  // namespace

std::vector<SweepRole> roles_of(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses) {
  std::vector<SweepRole> roles;
  std::vector<double> resolved_speeds;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Recording& recording = entries[i].recording;
    roles.push_back(role_of(recording, analyses[i]));
    if (roles[i] != SweepRole::Cycles || is_unresolved(recording, analyses[i])) continue;
    resolved_speeds.push_back(recording.conditions().speed_m_per_s);
  }
  if (resolved_speeds.empty() || !(ratio_of_ends(resolved_speeds) > thresholds::kLeastSpeedRatio)) return roles;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (is_unresolved(entries[i].recording, analyses[i])) roles[i] = SweepRole::LeftOut;
  }
  return roles;
}

Warnings check_resolution(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses,
                          const std::vector<SweepRole>& roles) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const bool is_left_out = roles[i] == SweepRole::LeftOut && is_unresolved(entries[i].recording, analyses[i]);
    if (is_left_out) names.push_back("'" + entries[i].id + "'");
  }
  if (names.empty()) return {};
  return {{"slips_not_resolved",
           fmt::format("left out of the joint fit because a slip has fewer than {:.1f} samples: {}; sample faster",
                       thresholds::kResolvedSamples, fmt::join(names, ", "))}};
}

std::string describe_roles(const std::vector<SweepRole>& roles) {
  const auto count = [&](SweepRole role) { return std::ranges::count(roles, role); };
  return fmt::format("{} with stick-slip cycles, {} sliding steadily, {} left out{}", count(SweepRole::Cycles),
                     count(SweepRole::Steady), count(SweepRole::LeftOut),
                     count(SweepRole::Cycles) < 2 ? "; a joint fit needs two with cycles, preferably at speeds a "
                                                    "factor of 3 apart (slipfit fit FILE --speed V fits a single one)"
                                                  : "");
}

ObservedEnd observed_end(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses,
                         const FitResult& result) {
  const std::optional<fit::FittedAverage> found = fit::found_average(result);
  const double fitted_s = found ? found->seconds : 0.0;
  ObservedEnd end;
  double fastest_open = 0.0;  // that sticks, or may
  std::vector<double> sliding;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const Conditions& conditions = entries[i].recording.conditions();
    const double speed = conditions.speed_m_per_s;
    const MotionClass motion = analyses[i].motion;
    if (motion == MotionClass::StickSlip) end.sticks_m_per_s = std::max(speed, end.sticks_m_per_s.value_or(0.0));
    if (slides(entries[i].recording, analyses[i], conditions.sensor_average_s.value_or(fitted_s))) {
      sliding.push_back(speed);
    } else if (motion == MotionClass::StickSlip || motion == MotionClass::OscillatorySlip) {
      fastest_open = std::max(speed, fastest_open);
    }
  }
  for (const double speed : sliding) {
    if (speed > fastest_open) end.slides_m_per_s = std::min(speed, end.slides_m_per_s.value_or(speed));
  }
  return end;
}

Warnings check_level_repeats(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses) {
  std::vector<double> paths_m, times_s;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    for (const ShortTest& test : analyses[i].tests) {
      if (test.kind != TestKind::LevelRepeats || !test.p_value || *test.p_value > thresholds::kProven) continue;
      paths_m.push_back(*test.value);
      times_s.push_back(*test.value / entries[i].recording.conditions().speed_m_per_s);
    }
  }
  if (paths_m.size() < 2) return {};
  const auto is_one = [](const std::vector<double>& values) {
    const auto [least, most] = std::ranges::minmax_element(values);
    return *most < (1.0 + thresholds::kAlike) * *least;
  };
  if (is_one(paths_m) == is_one(times_s)) return {};
  const std::string what =
      is_one(paths_m)
          ? fmt::format("every {:.3g} mm of sliding at every speed: texture of the counterface", 1e3 * paths_m.front())
          : fmt::format("every {:.3g} s at every speed: a wave of the drive or of the sensor", times_s.front());
  return {{"level_repeats", fmt::format("the force level of {} recordings repeats {}", paths_m.size(), what)}};
}

std::vector<Analysis> without_passing_patterns(std::vector<Analysis> analyses, const Warnings& warnings) {
  const auto speaks_against = [](const Warning& warning) { return warning.code == "frequency_does_not_follow_speed"; };
  if (std::ranges::none_of(warnings, speaks_against)) return analyses;
  for (Analysis& analysis : analyses) {
    const bool moves = analysis.motion == MotionClass::StickSlip || analysis.motion == MotionClass::OscillatorySlip;
    if (!moves || has_values(analysis)) continue;
    analysis.motion = MotionClass::Undetermined;
    analysis.motion_reason =
        "compared with the other recordings, the repetition does not depend on speed as stick-slip does";
    analysis.frequency.quoted = unknown("the recordings at other speeds show that these are not slips");
    analysis.frequency.method = FrequencyMethod::None;
    const Estimate no_spacing = unknown("no frequency, no spacing");
    analysis.derived.pattern_spacing_m = analysis.derived.impulse_rate_per_m = no_spacing;
    analysis.derived.pattern_spacing_sd_m.reset();
  }
  return analyses;
}

Warnings check_frequency_follows_speed(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (const auto point = point_of(entries[i].recording, analyses[i])) points.push_back(*point);
  }
  if (points.size() < 2) return {};
  const auto by_speed = [](const Point& a, const Point& b) { return a.log_speed < b.log_speed; };
  const auto [slow, fast] = std::ranges::minmax_element(points, by_speed);
  const double span = fast->log_speed - slow->log_speed;
  if (span < std::log(thresholds::kLeastSpeedRatio)) return check_frequency_at_one_speed(points);
  const double power = (fast->log_frequency - slow->log_frequency) / span;
  const double power_se = std::hypot(fast->log_frequency_se, slow->log_frequency_se) / span;
  // The stick time goes as 1 / V, the slip time hardly changes: f goes as V to the power of the sticking degree.
  const double expected = std::min(slow->stick_share, fast->stick_share);
  if (expected > 0.3 && power + 2.0 * power_se < 0.5 * expected) {
    return {{"frequency_does_not_follow_speed",
             fmt::format("the frequency varies as the speed to the power {:.2f}; with sticks of this length the "
                         "exponent would be at least {:.2f}: a control loop or a resonance, not stick-slip",
                         power, expected)}};
  }
  if (slow->log_fall && fast->log_fall) {
    const double fall_power = (*fast->log_fall - *slow->log_fall) / span;
    // A slip is half an oscillation at any speed. A shape that is fixed in space passes in a time as 1 / V.
    if (fall_power < -0.5 && power > 0.5) {
      const double spacing_mm = 1e3 * std::exp(fast->log_speed - fast->log_frequency);
      return {{"frequency_does_not_follow_speed",
               fmt::format("frequency does not depend on speed as in stick-slip: rise and fall both become shorter "
                           "with speed and V/f remains {:.3g} mm: a pattern or a rotation of the counterface",
                           spacing_mm)}};
    }
  }
  return {};
}

namespace {

/// The distance of a recording from the others.
struct Apart {
  std::size_t recording = 0;
  double distance = 0.0;  ///< relative, or ln of a ratio; levels in units of F_s - F_k
  double errors = 0.0;    ///< the same in errors, >= 0
};

/// The number of recordings that have to agree; all others for levels, whose unit is not shared and whose zeros may
/// differ.
enum class Agreeing { Half, AllOthers };

/// Returns true if a line over ln V explains nearly all differences.
bool go_with_speed(std::span<const SweepEntry> entries, std::span<const Apart> recordings) {
  std::vector<double> places;
  std::vector<double> distances;
  for (const Apart& one : recordings) {
    places.push_back(std::log(entries[one.recording].recording.conditions().speed_m_per_s));
    distances.push_back(one.distance);
  }
  const LineSums line = line_sums(places, distances);
  return line.square > 0.0 && line.slope() * line.cross >= thresholds::kGoesWithSpeed * line.scatter;
}

/// Returns the recording that differs most, if enough others agree.
std::optional<Apart> furthest(std::span<const SweepEntry> entries, std::vector<Apart> recordings, Agreeing agreeing) {
  if (recordings.size() < thresholds::kFewestRecordings) return std::nullopt;
  std::ranges::sort(recordings, [](const Apart& a, const Apart& b) { return a.errors > b.errors; });
  const Apart& first = recordings.front();
  const Apart& other = recordings[agreeing == Agreeing::Half ? recordings.size() / 2 : 1];
  const bool beyond = first.errors > thresholds::kOfManySigmas && std::abs(first.distance) > thresholds::kLeftOutShare;
  const bool is_distinct = beyond && first.errors > thresholds::kDistinctRatio * other.errors;
  // A trend with the speed, with this recording and without it, is no fault of one recording.
  const auto others = std::span(recordings).subspan(1);
  const bool is_trend = go_with_speed(entries, recordings) && go_with_speed(entries, others);
  return is_distinct && !is_trend ? std::optional(first) : std::nullopt;
}

/// Spacing predicted without a recording over the one that it shows.
std::optional<Apart> by_spacing(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses,
                                const SweepFit& fit) {
  std::vector<Apart> recordings;
  for (std::size_t i = 0; i < analyses.size(); ++i) {
    const Estimate& measured = analyses[i].derived.pattern_spacing_m;
    const Estimate& predicted = fit.points[i].spacing_left_out_m;
    if (!measured.standard_error || !predicted.standard_error) continue;
    const double distance = std::log(*predicted.value / *measured.value);
    const double error =
        std::hypot(*measured.standard_error / *measured.value, *predicted.standard_error / *predicted.value);
    recordings.push_back({i, distance, std::abs(distance) / error});
  }
  return furthest(entries, std::move(recordings), Agreeing::Half);
}

/// A parameter of a recording's own fit.
struct FittedValue {
  std::size_t recording = 0;
  double value = 0.0;
  double standard_error = 1.0;
};

std::vector<FittedValue> fitted_values(ParameterId id, const std::vector<Analysis>& analyses, const SweepFit& fit) {
  std::vector<FittedValue> values;
  for (std::size_t i = 0; i < analyses.size(); ++i) {
    if (!analyses[i].fit || fit.points[i].cycles_used == 0) continue;
    const Estimate own = analyses[i].fit->estimate_of(id);
    if (!own.value || !own.standard_error || !(*own.standard_error > 0.0)) continue;
    values.push_back({i, *own.value, *own.standard_error});
  }
  return values;
}

double middle_of(const std::vector<FittedValue>& values) {
  std::vector<double> numbers;
  numbers.reserve(values.size());
  for (const FittedValue& own : values) numbers.push_back(own.value);
  return signal::median(numbers);
}

/// Returns the distances from the middle of all recordings, in a unit.
std::vector<Apart> from_middle(const std::vector<FittedValue>& values, double middle, double unit) {
  std::vector<Apart> apart;
  for (const FittedValue& own : values) {
    const double off = own.value - middle;
    apart.push_back({own.recording, off / unit, std::abs(off) / own.standard_error});
  }
  return apart;
}

std::optional<Apart> by_stiffness(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses,
                                  const SweepFit& fit) {
  if (fit.result.find(ParameterId::Relaxation) != nullptr)
    return std::nullopt;  // the slope of a stick depends on how long it lasts
  std::vector<FittedValue> values = fitted_values(ParameterId::Stiffness, analyses, fit);
  if (values.empty()) return std::nullopt;
  for (FittedValue& own : values) {
    if (!fit.result.estimate || !fit.result.estimate->stiffness_trend) break;
    const double speed_m_per_s = entries[own.recording].recording.conditions().speed_m_per_s;
    const double growth = std::exp(fit.result.estimate->stiffness_trend->log_growth_at(speed_m_per_s));
    own.value /= growth;
    own.standard_error /= growth;
  }
  const double middle = middle_of(values);
  return furthest(entries, from_middle(values, middle, middle), Agreeing::Half);
}

/// In units of F_s - F_k, at the mean load where loads are known.
std::optional<Apart> by_level(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses,
                              const SweepFit& fit) {
  const Estimate unit = fit.result.friction_difference();
  if (fit.level_shared || !unit.value) return std::nullopt;
  std::vector<FittedValue> values = fitted_values(ParameterId::KineticFriction, analyses, fit);
  if (values.empty()) return std::nullopt;
  for (FittedValue& own : values) {
    const std::optional<double> load_N = entries[own.recording].recording.conditions().normal_force_N;
    if (!load_N || !fit.result.estimate || !fit.result.estimate->normal_force_N) continue;
    own.value *= *fit.result.estimate->normal_force_N / *load_N;
    own.standard_error *= *fit.result.estimate->normal_force_N / *load_N;
  }
  return furthest(entries, from_middle(values, middle_of(values), *unit.value), Agreeing::AllOthers);
}

const char* side_of(const Apart& apart) {
  return apart.distance > 0.0 ? "above" : "below";
}

}  // namespace

Warnings check_agreement(std::span<const SweepEntry> entries, const std::vector<Analysis>& analyses,
                         const SweepFit& fit) {
  const auto warning = [&entries](std::size_t recording, const std::string& shown) {
    return Warning{
        "recording_disagrees",
        fmt::format("recording '{}' disagrees with the others: {}; check its speed, its unit and its file, and "
                    "fit without it",
                    entries[recording].id, shown)};
  };
  if (const auto apart = by_stiffness(entries, analyses, fit)) {
    return {warning(apart->recording, fmt::format("its stiffness is {:.3g} % {} theirs (k is proportional to 1/V)",
                                                  100.0 * std::abs(apart->distance), side_of(*apart)))};
  }
  if (const auto apart = by_spacing(entries, analyses, fit)) {
    return {warning(apart->recording, fmt::format("a fit without it predicts a spacing {:.3g} times the measured one",
                                                  std::exp(apart->distance)))};
  }
  if (const auto apart = by_level(entries, analyses, fit)) {
    return {warning(apart->recording, fmt::format("its force level is {:.3g} times F_s - F_k {} theirs",
                                                  std::abs(apart->distance), side_of(*apart)))};
  }
  return {};
}

Warnings check_duplicates(std::span<const SweepEntry> entries) {
  Warnings warnings;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const auto one = entries[i].recording.force();
      const auto other = entries[j].recording.force();
      if (!std::ranges::equal(one, other)) continue;
      warnings.push_back(
          {"recording_repeated",
           fmt::format(
               "recordings '{}' and '{}' have the same samples: one is counted twice or listed with wrong conditions",
               entries[j].id, entries[i].id)});
      break;
    }
  }
  return warnings;
}

namespace {

constexpr double kSameSpeed = 0.01;

struct RepeatedQuantity {
  const char* name;
  const char* words;
  const char* unit;
  Range range;
  std::optional<double> (*of)(const Recording&, const Analysis&);
};

/// While it slides.
std::optional<double> mean_force(const Recording& recording, const Analysis& analysis) {
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < recording.size(); ++i) {
    const double time_s = recording.time_s()[i];
    if (time_s < analysis.sliding.begin_s || time_s > analysis.sliding.end_s) continue;
    sum += recording.force()[i];
    ++count;
  }
  return count > 0 ? std::optional(sum / static_cast<double>(count)) : std::nullopt;
}

constexpr std::array kQuantities = std::to_array<RepeatedQuantity>({
    {"frequency_Hz", "frequency", "Hz", kNotNegative,
     [](const Recording&, const Analysis& a) { return a.frequency.quoted.value; }},
    {"pattern_spacing_m", "spacing", "m", kNotNegative,
     [](const Recording&, const Analysis& a) { return a.derived.pattern_spacing_m.value; }},
    {"stick_stiffness_N_per_m", "slope of the sticks / V", "N/m", kNotNegative,
     [](const Recording&, const Analysis& a) { return a.cycles.stick_stiffness.value; }},
    {"peak_force_N", "peak force", "N", kAnyNumber,
     [](const Recording&, const Analysis& a) { return a.cycles.peak_force; }},
    {"force_drop_N", "force drop", "N", kNotNegative,
     [](const Recording&, const Analysis& a) { return a.cycles.force_drop; }},
    {"mean_force_N", "mean force", "N", kAnyNumber, mean_force},
});

bool are_at_one_speed(std::span<const SweepEntry> entries) {
  const auto speed = [](const SweepEntry& entry) { return entry.recording.conditions().speed_m_per_s; };
  const auto [slow, fast] =
      std::ranges::minmax_element(entries, [&](const auto& a, const auto& b) { return speed(a) < speed(b); });
  return speed(*fast) <= (1.0 + kSameSpeed) * speed(*slow);
}

}  // namespace

std::vector<Repeat> compare_repeats(std::span<const SweepEntry> entries, std::span<const Analysis> analyses) {
  std::vector<Repeat> repeats;
  if (entries.size() < 2 || !are_at_one_speed(entries)) return repeats;
  for (const RepeatedQuantity& quantity : kQuantities) {
    std::vector<double> values;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (const auto value = quantity.of(entries[i].recording, analyses[i])) values.push_back(*value);
    }
    if (values.size() < 2) continue;
    const MeanAndSpread spread = describe(values);
    Estimate mean = symmetric(spread.mean, spread.sd / std::sqrt(spread.count), spread.count - 1.0);
    mean = within(std::move(mean), quantity.range);
    repeats.push_back({quantity.name, quantity.words, quantity.unit, values.size(), mean, spread.sd});
  }
  return repeats;
}

}  // namespace slipfit
