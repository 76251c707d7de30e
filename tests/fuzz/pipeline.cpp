// Bytes -> Recording -> fit -> JSON. Eight bytes say how it was recorded, each pair behind them is a sample.
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "demand.hpp"
#include "slipfit/pipeline.hpp"
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

/// Value, standard error and interval wherever the document has them: in order, and never negative errors.
void check(const json& node, const std::string& place) {
  if (node.is_object() && node.contains("ci95") && node["ci95"].is_array()) {
    const json& bounds = node["ci95"];
    fuzz::demand(bounds.size() == 2, place + ": two bounds");
    if (bounds[0].is_number() && bounds[1].is_number()) {
      fuzz::demand(bounds[0].get<double>() <= bounds[1].get<double>(), place + ": bounds in order");
    }
  }
  if (node.is_object() && node.contains("se") && node["se"].is_number()) {
    fuzz::demand(node["se"].get<double>() >= 0.0, place + ": standard error >= 0");
    fuzz::demand(node.contains("value") && node["value"].is_number(), place + ": no standard error without a value");
  }
  for (const auto& [key, member] : node.items()) {
    if (member.is_structured()) check(member, place + "." + key);
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
  double now_s = 0.0;
  for (std::size_t i = kHeader; i + 1 < size && force.size() < kMostSamples; i += 2) {
    std::int16_t sample = 0;
    std::memcpy(&sample, data + i, sizeof sample);
    time_s.push_back(now_s);
    force.push_back(force_scale * sample);
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
  const slipfit::Analysis analysis = slipfit::analyze_and_fit(*recording, {});
  const json document = json::parse(slipfit::to_json(*recording, analysis), nullptr, false);
  fuzz::demand(document.is_object(), "the result is one JSON document");
  check(document, "fit");
  (void)slipfit::to_text(*recording, analysis);
  return 0;
}
