// Bytes -> Recording -> fit -> JSON, text, page and pictures. Eight bytes say how it was recorded, each pair behind
// them is a sample.
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "demand.hpp"
#include "document_rules.hpp"
#include "slipfit/background.hpp"
#include "slipfit/pipeline.hpp"
#include "slipfit/report/html.hpp"
#include "slipfit/report/json.hpp"
#include "slipfit/report/text.hpp"

namespace {

using nlohmann::json;

constexpr std::size_t kHeader = 8;
constexpr std::size_t kMostSamples = 4000;

/// 10^-12.7 .. 10^12.7: beyond every recording, but no input of a user is impossible.
double magnitude(std::uint8_t byte) {
  return std::pow(10.0, (static_cast<double>(byte) - 128.0) / 10.0);
}

/// Far from zero by 10^-12.7 .. 10^12.7 of `unit`, of either sign; no offset for most bytes.
double offset(std::uint8_t byte, double unit) {
  if (byte < 192) return 0.0;
  return (byte % 2 == 0 ? unit : -unit) * magnitude(static_cast<std::uint8_t>((byte - 192) * 4));
}

void demand_words(const std::string& what, const std::string& text) {
  fuzz::demand(!test::says_not_a_number(text), what + " has no infinite number");
}

void check_documents(const slipfit::Recording& recording, const slipfit::Analysis& analysis) {
  const json document = json::parse(slipfit::to_json(recording, analysis), nullptr, false);
  fuzz::demand(document.is_object(), "the result is one JSON document");
  for (const std::string& breach : test::breaches_of(document)) fuzz::demand(false, breach);
  demand_words("the text", slipfit::to_text(recording, analysis));
  const slipfit::Background background = slipfit::gather_background(recording, analysis);
  demand_words("the page", test::without_scripts(slipfit::to_html(recording, analysis, background, {})));
  for (const slipfit::PictureFile& picture : slipfit::report_pictures(recording, analysis, background)) {
    demand_words(picture.name, picture.content);
  }
}

std::optional<slipfit::Recording> recording_from(const std::uint8_t* data, std::size_t size) {
  if (size < kHeader) return std::nullopt;
  const double interval_s = magnitude(data[0]);
  const double force_scale = magnitude(data[1]) / 1000.0;
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = magnitude(data[2]);
  if (data[3] & 1U) conditions.normal_force_N = magnitude(data[4]);
  if (data[3] & 2U) conditions.zero_force_N = 0.0;
  if (data[3] & 4U) conditions.force_view = slipfit::ForceView::Transmitted;
  if (data[3] & 8U) conditions.force_view = slipfit::ForceView::Contact;
  if (data[3] & 16U) conditions.quantity = slipfit::ForceQuantity::FrictionCoefficient;
  const double jitter = data[5] < 128 ? 0.0 : 1.0;
  std::vector<double> time_s;
  std::vector<double> force;
  double now_s = offset(data[6], interval_s);
  const double level = offset(data[7], force_scale);
  for (std::size_t i = kHeader; i + 1 < size && force.size() < kMostSamples; i += 2) {
    std::int16_t sample = 0;
    std::memcpy(&sample, data + i, sizeof sample);
    time_s.push_back(now_s);
    force.push_back(level + force_scale * sample);
    // On an uneven clock a sample's low bits stretch the step behind it; 0 repeats the time.
    now_s += interval_s * (jitter > 0.0 ? (sample & 3) * 0.5 : 1.0);
  }
  auto recording = slipfit::Recording::create(std::move(time_s), std::move(force), conditions);
  if (recording) return std::move(recording).value();
  fuzz::demand_readable(recording.error());
  return std::nullopt;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::optional<slipfit::Recording> recording = recording_from(data, size);
  if (!recording) return 0;
  slipfit::FitOptions options;
  options.curve = true;
  check_documents(*recording, slipfit::analyze_and_fit(*recording, options));
  check_documents(*recording, slipfit::analyze(*recording));
  return 0;
}
