#include "report/document/document_context.hpp"

namespace slipfit::documents {

std::optional<double> checked_error(const JsonNode& node) {
  const std::optional<double> error = node.number();
  if (error && !(*error >= 0.0)) node.fail("a number >= 0 or null");
  return error;
}

std::optional<SpeedReach> reach(const JsonNode& document) {
  if (!document.has("model") || !document.member("model").has("speeds_m_per_s")) return std::nullopt;
  const JsonNode model = document.member("model");
  const JsonNode speeds = model.member("speeds_m_per_s");
  if (speeds.array_size() != 2) speeds.fail("[slowest, fastest]");
  SpeedReach reach{speeds.element(0).positive(), speeds.element(1).positive(), std::nullopt};
  if (reach.slowest_m_per_s > reach.fastest_m_per_s) speeds.fail("[slowest, fastest]");
  if (model.has("trend_beyond")) reach.trend = checked_error(model.member("trend_beyond"));
  return reach;
}

std::optional<double> normal_force_N(const JsonNode& document) {
  if (!document.has("model") || !document.member("model").has("normal_force_N")) return std::nullopt;
  return document.member("model").member("normal_force_N").positive();
}

/// [speed or null, speed or null]
ObservedEnd observed_end(const JsonNode& document) {
  if (!document.has("derived") || !document.member("derived").has("observed_end_m_per_s")) return {};
  const JsonNode ends = document.member("derived").member("observed_end_m_per_s");
  if (ends.array_size() != 2) ends.fail("[highest speed that sticks, lowest that does not]");
  return {checked_error(ends.element(0)), checked_error(ends.element(1))};
}

Warnings warnings(const JsonNode& document) {
  Warnings list;
  if (!document.has("warnings")) return list;
  const JsonNode nodes = document.member("warnings");
  for (std::size_t i = 0; i < nodes.array_size(); ++i) {
    const JsonNode warning = nodes.element(i);
    list.push_back({warning.member("code").text(), warning.member("message").text()});
  }
  return list;
}

std::vector<std::string> conditions(const JsonNode& document) {
  std::vector<std::string> texts;
  if (!document.has("model") || !document.member("model").has("conditional_on")) return texts;
  const JsonNode list = document.member("model").member("conditional_on");
  for (std::size_t i = 0; i < list.array_size(); ++i) texts.push_back(list.element(i).text());
  return texts;
}

}  // namespace slipfit::documents
