#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "report/html/figure.hpp"
#include "report/html/scaling.hpp"

namespace slipfit::html {
namespace {

using chart::Colour, chart::Point, chart::Shape, chart::Stroke;

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
  chart::Panel panel;
  panel.height_px = 280.0;
  Span heights;
  for (const Point& point : points) heights.add(point.y);
  panel.x = {"frequency [Hz]", points.front().x, points.back().x, chart::Scale::Logarithmic};
  panel.y = {label_with_unit("rms per bin", unit.unit), std::max(heights.low(), kDepth * heights.high()) / 1.5,
             heights.high() * 3.0, chart::Scale::Logarithmic};
  panel.lines.push_back({"spectrum of the force", Colour::Grey, Stroke::Solid, points, 1.1});

  const FrequencyReport& frequency = source.analysis.frequency;
  chart::Markers harmonics{"harmonics found", Colour::Green, Shape::Ring, {}};
  for (std::size_t i = 0; i < std::min(frequency.spectral.harmonics_Hz.size(), kMostHarmonics); ++i) {
    const double at_Hz = frequency.spectral.harmonics_Hz[i];
    harmonics.points.push_back({at_Hz, height_at(spectrum, at_Hz, unit.per_SI)});
  }
  if (!harmonics.points.empty()) panel.markers.push_back(harmonics);
  chart::Markers suspicious{"suspicious lines", Colour::Vermillion, Shape::Triangle, {}};
  for (const SuspiciousLine& line : frequency.spectral.suspicious_lines) {
    suspicious.points.push_back({line.frequency_Hz, height_at(spectrum, line.frequency_Hz, unit.per_SI)});
  }
  if (!suspicious.points.empty()) panel.markers.push_back(suspicious);
  if (frequency.quoted.value) {
    const double at_Hz = *frequency.quoted.value;
    panel.lines.push_back({fmt::format("chosen frequency, {} Hz", with_error(frequency.quoted)),
                           Colour::Blue,
                           Stroke::Dashed,
                           {{at_Hz, panel.y.low}, {at_Hz, panel.y.high}},
                           1.6});
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
  if (pairs.size() <= kMostPairs) return pairs;
  std::vector<Point> chosen;
  for (std::size_t i = 0; i < kMostPairs; ++i) chosen.push_back(pairs[i * pairs.size() / kMostPairs]);
  return chosen;
}

chart::Panel pairs_panel(const Source& source, const std::vector<Point>& pairs) {
  const std::string unit = source.force_unit.unit;
  const Estimate& reflection = source.background.reflection;
  Span peaks;
  Span troughs;
  for (const Point& pair : pairs) {
    peaks.add(pair.x);
    troughs.add(pair.y);
  }
  chart::Panel panel;
  panel.x = peaks.linear_axis(label_with_unit("peak above kinetic friction", unit));
  troughs.add(-*reflection.value * peaks.low());
  troughs.add(-*reflection.value * peaks.high());
  troughs.add(-peaks.high());
  panel.y = troughs.linear_axis(label_with_unit("trough above kinetic friction", unit));
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

}  // namespace slipfit::html
