#include "core/statistics.hpp"
#include "report/html/figure.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace slipfit::html {

namespace {

using chart::Colour, chart::Panel, chart::Point, chart::Shape, chart::Stroke;

/// A force over the time of a part of the recording, in the unit of the chart; `at`: its value at a sample, in SI.
template <class At>
std::vector<Point> over_time(const Source& source, SampleRange range, At at) {
  std::vector<double> values;
  for (std::size_t i = range.begin; i < range.end; ++i) values.push_back(source.force_unit.per_SI * at(i));
  return envelope(range.of(source.recording.time_s()), values, source.trace_columns);
}

/// A panel over the time of a part of the recording, as high as its first line.
Panel time_panel(const Source& source, SampleRange range, const std::string& label, std::vector<chart::Line> lines) {
  const std::span<const double> time_s = range.of(source.recording.time_s());
  Span span;
  span.add(lines.front().points);
  return {.x = {"time [s]", time_s.front(), time_s.back()}, .y = span.linear_axis(label), .lines = std::move(lines)};
}

Panel force_panel(const Source& source, SampleRange range, const std::string& label, double width_px) {
  std::vector<chart::Line> lines{{"measured", Colour::Grey, Stroke::Solid,
                                  over_time(source, range, [&](std::size_t i) { return source.recording.force()[i]; }),
                                  width_px}};
  if (has_fitted_curve(source.analysis)) {
    lines.push_back({"fit", Colour::Vermillion, Stroke::Solid,
                     over_time(source, range, [&](std::size_t i) { return source.fitted[i]; }), width_px + 0.4});
  }
  Panel panel = time_panel(source, range, label, std::move(lines));
  panel.height_px = 220.0;
  return panel;
}

Panel residual_panel(const Source& source, SampleRange range) {
  const auto residual = [&](std::size_t i) { return source.recording.force()[i] - source.fitted[i]; };
  Panel panel = time_panel(source, range, label_with_unit("residual", source.force_unit.unit),
                           {{"", Colour::Blue, Stroke::Solid, over_time(source, range, residual), 1.2}});
  panel.height_px = 90.0;
  return panel;
}

/// A few cycles in the middle of those that the fit uses (or of all).
SampleRange middle_cycles(const Source& source) {
  constexpr std::size_t kCyclesClose = 5;
  std::vector<const Cycle*> cycles;
  for (const Cycle& cycle : source.analysis.cycle_table) {
    if (cycle.used || source.analysis.cycles.used == 0) cycles.push_back(&cycle);
  }
  if (cycles.size() < 3) return {};
  const std::size_t count = std::min(kCyclesClose, cycles.size() - 1);
  const std::size_t first = (cycles.size() - 1 - count) / 2;
  return samples_between(source.recording, cycles[first]->trough_s, cycles[first + count]->trough_s);
}

/// Draws the part that slides on grey, unless it is all.
void mark_sliding(Panel& panel, const Source& source) {
  const TimeSpan& sliding = source.analysis.sliding;
  if (!(sliding.end_s - sliding.begin_s < source.recording.duration_s()) || !(sliding.end_s > sliding.begin_s)) return;
  panel.areas.push_back(
      rectangle("sliding", Colour::Grey, {sliding.begin_s, panel.y.low}, {sliding.end_s, panel.y.high}));
}

/// Marks the start and end of slips, by the fit or by the turning points.
void add_cycle_marks(Panel& panel, const Source& source) {
  const double scale = source.force_unit.per_SI;
  chart::Markers begin{"slip begins", Colour::Blue, Shape::Ring, {}};
  chart::Markers end{"slip ends", Colour::Blue, Shape::Cross, {}};
  for (const Cycle& cycle : source.analysis.cycle_table) {
    const double begin_s = slip_begin_s(cycle);
    const double end_s = slip_end_s(cycle);
    if (begin_s < panel.x.low || end_s > panel.x.high) continue;
    begin.points.push_back({begin_s, scale * cycle.onset_force.value_or(cycle.peak_force)});
    end.points.push_back({end_s, scale * cycle.trough_force});
  }
  panel.markers.push_back(begin);
  panel.markers.push_back(end);
}

Panel close_up(const Source& source, SampleRange range, const std::string& label) {
  constexpr std::size_t kFewSamples = 150;  // so few are drawn one by one
  Panel panel = force_panel(source, range, label, 1.6);
  panel.lines.front().name = "measured, enlarged";
  if (range.size() <= kFewSamples) {
    panel.markers.push_back({"", Colour::Grey, Shape::Speck, panel.lines.front().points});
  }
  add_cycle_marks(panel, source);
  return panel;
}

}  // namespace

std::vector<Panel> small_trace(const Source& source, const std::string& name) {
  const SampleRange all{0, source.recording.size()};
  std::vector<Panel> panels{force_panel(source, all, label_with_unit("force", source.force_unit.unit), 1.0)};
  panels.front().height_px = 80.0;
  panels.front().lines.front().name = name;
  if (!has_fitted_curve(source.analysis)) return panels;
  panels.front().x.label.clear();  // it is below the residual
  panels.push_back(residual_panel(source, all));
  panels.back().height_px = 75.0;
  return panels;
}

Figure trace_figure(const Source& source) {
  const Recording& recording = source.recording;
  const std::string label = label_with_unit(force_name_of(recording), source.force_unit.unit);
  const bool has_fit = has_fitted_curve(source.analysis);

  Figure figure{"trace", has_fit ? "The recording and the fit" : "The recording"};
  figure.guide = !has_fit ? "Measured force, without a fit."
                          : "Measured force, fitted force, and residual (measured minus fitted). The residual should "
                            "be noise; a pattern that repeats in every slip shows that the model lacks something.";
  chart::Chart chart{"Recording and fit", {}, {}};
  chart.panels.push_back(force_panel(source, {0, recording.size()}, label, 1.0));
  mark_sliding(chart.panels.back(), source);
  const SampleRange close = shows_cycles(source.analysis) ? middle_cycles(source) : SampleRange{};
  if (close.size() > 2) {
    chart.panels.push_back(close_up(source, close, label));
    if (has_fit) chart.panels.push_back(residual_panel(source, close));
  }
  figure.label =
      fmt::format("{} over {}, {}{}", force_name_of(recording), quantity_text(recording.duration_s(), "s"),
                  shows_cycles(source.analysis) ? fmt::format("{} slips marked", source.analysis.cycles.count)
                                                : std::string("steady sliding"),
                  has_fit ? ", with the fitted force and the residual" : ", without a fit");
  figure.chart = std::move(chart);
  return figure;
}

namespace {

/// A value in SI for each slip; not finite where it is not known. Evenly chosen where they are many.
chart::Panel panel_over_slips(const std::string& name, const DisplayUnit& unit, const std::vector<double>& values) {
  constexpr std::size_t kMostSlips = 1000;
  std::vector<Point> points;
  for (std::size_t i = 0; i < values.size(); i += values.size() / kMostSlips + 1) {
    points.push_back({static_cast<double>(i + 1), unit.per_SI * values[i]});
  }
  Span span;
  span.add(points);
  return {.x = {"number of the slip", 0.5, static_cast<double>(values.size()) + 0.5},
          .y = span.linear_axis(label_with_unit(name, unit.unit)),
          .height_px = 110.0,
          .lines = {{"", Colour::Blue, Stroke::Solid, std::move(points), 1.2}}};
}

/// Returns the work of the drive from each slip to the next, in J: the speed times the integral of the force over time
/// (trapezoids). Over a whole cycle the spring stores nothing, so that friction and damping dissipate it. Not a number
/// for the first slip. An unknown zero of the sensor shifts all values alike where the periods are equal.
std::vector<double> work_between_slips(const Recording& recording, const std::vector<Cycle>& cycles) {
  const auto time_s = recording.time_s();
  const auto force_N = recording.force();
  const auto sample_at = [&](double seconds) {
    return static_cast<std::size_t>(std::ranges::lower_bound(time_s, seconds) - time_s.begin());
  };
  std::vector<double> work_J{std::numeric_limits<double>::quiet_NaN()};
  std::size_t begin = sample_at(slip_begin_s(cycles.front()));
  for (std::size_t i = 1; i < cycles.size(); ++i) {
    const std::size_t end = std::min(sample_at(slip_begin_s(cycles[i])), time_s.size() - 1);
    double impulse_Ns = 0.0;
    for (; begin < end; ++begin) {
      impulse_Ns += 0.5 * (force_N[begin] + force_N[begin + 1]) * (time_s[begin + 1] - time_s[begin]);
    }
    work_J.push_back(recording.conditions().speed_m_per_s * impulse_Ns);
  }
  return work_J;
}

}  // namespace

Figure evolution_figure(const Source& source) {
  Figure figure{
      "evolution", "Evolution over the slips",
      "Peak force, force drop and period of each slip in order, and the work of the drive since the slip before it, "
      "which friction dissipates. A trend indicates wear, heating or drift of the sensor; a step indicates a change of "
      "the contact; a long period may be a slip that was not detected."};
  constexpr std::size_t kFewestSlips = 5;
  const std::vector<Cycle>& cycles = source.analysis.cycle_table;
  if (!shows_cycles(source.analysis) || cycles.size() < kFewestSlips)
    return figure.without_chart("There are too few slips to show how they change.");
  std::vector<double> peaks, drops, periods_s;
  double before_s = std::numeric_limits<double>::quiet_NaN();
  for (const Cycle& cycle : cycles) {
    const double begin_s = slip_begin_s(cycle);
    peaks.push_back(cycle.peak_force);
    drops.push_back(cycle.peak_force - cycle.trough_force);
    periods_s.push_back(begin_s - before_s);
    before_s = begin_s;
  }
  figure.chart =
      chart::Chart{figure.title,
                   {},
                   {panel_over_slips("peak force", source.force_unit, peaks),
                    panel_over_slips("force drop", source.force_unit, drops),
                    panel_over_slips("period", display_unit("s", source.analysis.cycles.period_s), periods_s)}};
  figure.label = fmt::format("peak force, force drop and period of {} slips", cycles.size());
  const Conditions& conditions = source.recording.conditions();
  if (conditions.speed_is_known && conditions.quantity == ForceQuantity::Force_N) {
    const std::vector<double> work_J = work_between_slips(source.recording, cycles);
    figure.chart->panels.push_back(panel_over_slips("work", display_unit("J", work_J.back()), work_J));
    figure.label += ", and the work between them";
  }
  return figure;
}

namespace {

constexpr int kSpectrumColumns = 600;       // on the logarithmic axis
constexpr double kDepth = 3e-5;             // of the highest line: below is noise
constexpr double kBelowFundamental = 20.0;  // where the axis begins
constexpr std::size_t kMostHarmonics = 20;

/// rms of the force in a bin, in the unit of the chart
double height_at(const Spectrum& spectrum, double frequency_Hz, double scale) {
  const auto bin = static_cast<std::size_t>(std::lround(frequency_Hz / spectrum.bin_Hz));
  double power = 0.0;
  for (std::size_t i = bin > 0 ? bin - 1 : 0; i <= bin + 1 && i < spectrum.power.size(); ++i) {
    power = std::max(power, spectrum.power[i]);
  }
  return scale * std::sqrt(power);
}

/// The highest bin of each column, so that no line is lost.
std::vector<Point> highest_bins(const Spectrum& spectrum, double low_Hz, double scale) {
  std::vector<Point> points;
  const double high_Hz = spectrum.bin_Hz * static_cast<double>(spectrum.power.size() - 1);
  const double columns_per_log = kSpectrumColumns / std::log(high_Hz / low_Hz);
  int last_column = -1;
  for (std::size_t i = 1; i < spectrum.power.size(); ++i) {
    const double frequency_Hz = spectrum.bin_Hz * static_cast<double>(i);
    if (frequency_Hz < low_Hz) continue;
    const Point point{frequency_Hz, scale * std::sqrt(spectrum.power[i])};
    const int column = static_cast<int>(columns_per_log * std::log(frequency_Hz / low_Hz));
    if (column != last_column) {
      points.push_back(point);
    } else if (point.y > points.back().y) {
      points.back() = point;
    }
    last_column = column;
  }
  return points;
}

chart::Panel spectrum_panel(const Source& source, const std::vector<Point>& points) {
  const DisplayUnit unit = source.force_unit;
  const Spectrum& spectrum = source.background.spectrum;
  Span heights;
  heights.add(points);
  Panel panel{.x = {"frequency [Hz]", points.front().x, points.back().x, chart::Scale::Logarithmic},
              .y = {label_with_unit("rms per bin", unit.unit), std::max(heights.low(), kDepth * heights.high()) / 1.5,
                    heights.high() * 3.0, chart::Scale::Logarithmic},
              .height_px = 280.0,
              .lines = {{"spectrum of the force", Colour::Grey, Stroke::Solid, points, 1.1}},
              .markers = {{"harmonics found", Colour::Green, Shape::Ring, {}},
                          {"suspicious lines", Colour::Vermillion, Shape::Triangle, {}}}};
  const auto mark = [&](chart::Markers& markers, double at_Hz) {
    markers.points.push_back({at_Hz, height_at(spectrum, at_Hz, unit.per_SI)});
  };
  const FrequencyReport& frequency = source.analysis.frequency;
  const std::vector<double>& harmonics_Hz = frequency.spectral.harmonics_Hz;
  for (std::size_t i = 0; i < std::min(harmonics_Hz.size(), kMostHarmonics); ++i)
    mark(panel.markers[0], harmonics_Hz[i]);
  for (const SuspiciousLine& line : frequency.spectral.suspicious_lines) mark(panel.markers[1], line.frequency_Hz);
  std::erase_if(panel.markers, [](const chart::Markers& markers) { return markers.points.empty(); });
  if (frequency.quoted.value) {
    panel.lines.push_back(line_up(panel, fmt::format("chosen frequency, {} Hz", with_error(frequency.quoted)),
                                  *frequency.quoted.value, Colour::Blue));
    panel.lines.back().width_px = 1.6;
  }
  return panel;
}

}  // namespace

Figure spectrum_figure(const Source& source) {
  Figure figure{"spectrum", "Frequency"};
  figure.guide =
      "Spectrum of the force. Regular cycles appear as a line with harmonics at its multiples; irregular cycles "
      "broaden the lines, and the frequency is then determined from the intervals between slips. Suspicious lines are "
      "mains hum or its multiples and were not interpreted as stick-slip.";
  const Spectrum& spectrum = source.background.spectrum;
  const FrequencyReport& frequency = source.analysis.frequency;
  const double low_Hz =
      std::max(spectrum.bin_Hz, frequency.quoted.value ? *frequency.quoted.value / kBelowFundamental : spectrum.bin_Hz);
  if (spectrum.power.size() > 2) {
    const std::vector<Point> points = highest_bins(spectrum, low_Hz, source.force_unit.per_SI);
    const bool has_force = std::ranges::any_of(points, [](const Point& point) { return point.y > 0.0; });
    if (points.size() > 2 && has_force) figure.chart = chart::Chart{"Spectrum", {}, {spectrum_panel(source, points)}};
  }
  if (!figure.chart) figure.absent = "The recording is too short or too constant for a spectrum.";
  figure.label = frequency.quoted.value
                     ? fmt::format("spectrum of the force; chosen frequency {} Hz, {} harmonics",
                                   with_error(frequency.quoted), frequency.spectral.harmonics_Hz.size())
                     : std::string("spectrum of the force; no frequency chosen");
  return figure;
}

namespace {

constexpr std::size_t kMostPairs = 1000;

/// Peak above F_k and trough relative to it, in the unit of the chart; evenly chosen where they are many.
std::vector<Point> pairs_of(const Source& source) {
  std::vector<Point> pairs;
  const double scale = source.force_unit.per_SI;
  for (const Cycle& cycle : source.analysis.cycle_table) {
    if (!cycle.used || !cycle.level_force) continue;
    pairs.push_back(
        {scale * (cycle.peak_force - *cycle.level_force), scale * (cycle.trough_force - *cycle.level_force)});
  }
  return evenly_chosen(pairs, kMostPairs);
}

chart::Panel pairs_panel(const Source& source, const std::vector<Point>& pairs) {
  const std::string unit = source.force_unit.unit;
  const Estimate& reflection = source.background.reflection;
  Span peaks;
  Span troughs;
  peaks.add(pairs, &Point::x);
  troughs.add(pairs);
  for (const double end : {-*reflection.value * peaks.low(), -*reflection.value * peaks.high(), -peaks.high()}) {
    troughs.add(end);
  }
  Panel panel{.x = peaks.linear_axis(label_with_unit("peak above kinetic friction", unit)),
              .y = troughs.linear_axis(label_with_unit("trough above kinetic friction", unit))};
  const double left = panel.x.low;
  const double right = panel.x.high;
  const auto line_to = [left, right](double ratio) {
    return std::vector<Point>{{left, -ratio * left}, {right, -ratio * right}};
  };
  if (reflection.ci95) {
    const double low = reflection.ci95->low;
    const double high = reflection.ci95->high;
    panel.areas.push_back({"95 % interval",
                           Colour::Blue,
                           chart::Fill::Plain,
                           {{left, -low * left}, {right, -low * right}, {right, -high * right}, {left, -high * left}},
                           kEdge_px});
  }
  panel.lines = {{fmt::format("fitted damping, slope -{:.3g}", *reflection.value), Colour::Vermillion, Stroke::Solid,
                  line_to(*reflection.value)},
                 {"no damping, slope -1", Colour::Black, Stroke::Dashed, line_to(1.0), 1.2}};
  panel.markers = {{"cycles", Colour::Grey, Shape::Speck, pairs}};
  return panel;
}

/// Returns true if averaging or lag of the sensor visibly reduces peaks and troughs. A lag tau reduces an amplitude by
/// sqrt(1 + (w_n tau)^2): by 0.5 % at the limit.
bool is_blunted(const Source& source) {
  constexpr double kVisibleLag = 0.1;  // of 1 / w_n
  const auto& fit = source.analysis.fit;
  if (!fit) return false;
  const Parameter* const average = fit->find(ParameterId::SensorAverage);
  if (average != nullptr && average->estimate.value != 0.0) return true;
  const Parameter* const omega = fit->find(ParameterId::NaturalFrequency);
  const std::optional<double> lag_s = source.recording.conditions().sensor_lag_s();
  if (!lag_s || omega == nullptr || !omega->estimate.value) return false;
  return *omega->estimate.value * *lag_s > kVisibleLag;
}

std::string reason_for_none(const Source& source, const std::vector<Point>& pairs) {
  const Estimate& reflection = source.background.reflection;
  if (source.analysis.motion != MotionClass::StickSlip)
    return "Without stick-slip cycles there are no pairs of peaks and troughs.";
  if (source.recording.conditions().force_view == ForceView::Contact) {
    return "A sensor at the contact measures the friction force: its trough does not show the extension of the spring.";
  }
  if (!reflection.value) {
    const std::string why = reflection.note.empty() ? "the fitted model has none" : reflection.note;
    return "The damping ratio is not known: " + why + ".";
  }
  if (is_blunted(source)) {
    return "Averaging or lag of the sensor reduces peaks and troughs: their ratio does not show the damping.";
  }
  return pairs.size() < 3 ? "There are too few fitted cycles." : "";
}

}  // namespace

Figure pairs_figure(const Source& source) {
  Figure figure{"pairs", "Damping from peaks and troughs",
                "Each point is one slip: the peak force above kinetic friction and the trough force below it. Without "
                "damping the trough mirrors the peak (dashed line). Damping reduces the trough by the factor exp(-pi "
                "zeta / sqrt(1 - zeta^2)): the points should follow the solid line."};
  const std::vector<Point> pairs = pairs_of(source);
  figure.absent = reason_for_none(source, pairs);
  if (!figure.absent.empty()) return figure;
  figure.chart = chart::Chart{"Peaks and troughs", {}, {pairs_panel(source, pairs)}};
  figure.label = fmt::format("trough against peak of {} slips, with the line of the fitted damping, slope -{:.3g}",
                             pairs.size(), *source.background.reflection.value);
  return figure;
}

namespace {

constexpr std::size_t kPhaseBins = 24;  // of the stick, and as many of the slip
constexpr std::size_t kFewestInBin = 3;

/// Holds the residual in a part of the cycle: its mean in each of the cycles.
using PhaseBin = std::vector<double>;

/// Adds the residuals of the samples between two times, which the bins divide evenly.
void add_residuals(const Source& source, double begin_s, double end_s, std::span<PhaseBin> bins) {
  if (!(end_s > begin_s)) return;
  std::vector<double> sums(bins.size(), 0.0);
  std::vector<double> counts(bins.size(), 0.0);
  const SampleRange range = samples_between(source.recording, begin_s, end_s);
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const double residual = source.recording.force()[i] - source.fitted[i];
    const double share = (source.recording.time_s()[i] - begin_s) / (end_s - begin_s);
    if (!std::isfinite(residual) || !(share >= 0.0 && share < 1.0)) continue;
    const auto bin = static_cast<std::size_t>(share * static_cast<double>(bins.size()));
    sums[bin] += source.force_unit.per_SI * residual;
    counts[bin] += 1.0;
  }
  for (std::size_t bin = 0; bin < bins.size(); ++bin) {
    if (counts[bin] > 0.0) bins[bin].push_back(sums[bin] / counts[bin]);
  }
}

/// Returns the residuals over the cycle: the bins of the stick, then those of the slip.
std::vector<PhaseBin> residuals_over_cycle(const Source& source) {
  std::vector<PhaseBin> bins(2 * kPhaseBins);
  const std::span<PhaseBin> all(bins);
  const Cycle* before = nullptr;
  for (const Cycle& cycle : source.analysis.cycle_table) {
    if (cycle.used && cycle.onset_s && cycle.end_s) {
      if (before != nullptr) add_residuals(source, *before->end_s, *cycle.onset_s, all.first(kPhaseBins));
      add_residuals(source, *cycle.onset_s, *cycle.end_s, all.last(kPhaseBins));
      before = &cycle;
    } else {
      before = nullptr;
    }
  }
  return bins;
}

}  // namespace

Figure residuals_figure(const Source& source) {
  Figure figure{
      "residuals", "What the model misses in every cycle",
      "Mean residual (force minus fitted force) over the stick, from -1 to 0, and the slip, from 0 to 1, with "
      "two standard errors of the mean over the cycles. Without a pattern the mean stays within them around "
      "zero; a pattern is what the model does not describe."};
  if (!shows_cycles(source.analysis) || !has_fitted_curve(source.analysis)) {
    return figure.without_chart("Without fitted cycles there are no residuals.");
  }
  const std::vector<PhaseBin> bins = residuals_over_cycle(source);
  chart::Line mean{"mean residual", Colour::Blue, Stroke::Solid, {}};
  chart::Area band{"two standard errors", Colour::Blue, chart::Fill::Plain, {}, kEdge_px};
  std::vector<Point> lower;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    if (bins[i].size() < kFewestInBin) continue;
    const MeanAndSpread residual = describe(bins[i]);
    const double phase = (static_cast<double>(i) + 0.5) / static_cast<double>(kPhaseBins) - 1.0;
    const double error = 2.0 * residual.sd / std::sqrt(residual.count);
    mean.points.push_back({phase, residual.mean});
    band.outline.push_back({phase, residual.mean + error});
    lower.push_back({phase, residual.mean - error});
  }
  if (mean.points.size() < 3) return figure.without_chart("There are too few fitted cycles.");
  band.outline.insert(band.outline.end(), lower.rbegin(), lower.rend());
  Span span;
  span.add(band.outline);
  span.add(0.0);
  Panel panel{.x = {"stick from -1 to 0, slip from 0 to 1", -1.0, 1.0},
              .y = span.linear_axis(label_with_unit("residual", source.force_unit.unit)),
              .height_px = 220.0,
              .areas = {std::move(band)},
              .lines = {{"", Colour::Grey, Stroke::Dashed, {{-1.0, 0.0}, {1.0, 0.0}}, 1.2}, std::move(mean)}};
  figure.label = fmt::format("mean residual over stick and slip of {} fitted cycles", source.analysis.cycles.used);
  figure.chart = chart::Chart{"Residual over the cycle", {}, {std::move(panel)}};
  return figure;
}

}  // namespace slipfit::html
