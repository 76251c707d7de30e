#include "report/document/document_context.hpp"

namespace slipfit::documents {

std::optional<double> checked_error(const JsonNode& node) {
  const std::optional<double> error = node.number();
  if (error && !(*error >= 0.0)) node.fail("a number >= 0 or null");
  return error;
}

std::optional<SpeedReach> reach(const JsonNode& document) {
  const auto speeds = document.known("model", "speeds_m_per_s");
  if (!speeds) return std::nullopt;
  if (speeds->array_size() != 2) speeds->fail("[slowest, fastest]");
  SpeedReach reach{speeds->element(0).positive(), speeds->element(1).positive(), std::nullopt};
  if (reach.slowest_m_per_s > reach.fastest_m_per_s) speeds->fail("[slowest, fastest]");
  if (const auto trend = document.known("model", "trend_beyond")) reach.trend = checked_error(*trend);
  return reach;
}

std::optional<double> normal_force_N(const JsonNode& document) {
  const auto load = document.known("model", "normal_force_N");
  return load ? std::optional(load->positive()) : std::nullopt;
}

/// [speed or null, speed or null]
ObservedEnd observed_end(const JsonNode& document) {
  const auto ends = document.known("derived", "observed_end_m_per_s");
  if (!ends) return {};
  if (ends->array_size() != 2) ends->fail("[highest speed that sticks, lowest that does not]");
  return {checked_error(ends->element(0)), checked_error(ends->element(1))};
}

Warnings warnings(const JsonNode& document) {
  Warnings list;
  const auto nodes = document.known("warnings");
  for (std::size_t i = 0; nodes && i < nodes->array_size(); ++i) {
    const JsonNode warning = nodes->element(i);
    list.push_back({warning.member("code").text(), warning.member("message").text()});
  }
  return list;
}

std::vector<std::string> conditions(const JsonNode& document) {
  std::vector<std::string> texts;
  const auto list = document.known("model", "conditional_on");
  for (std::size_t i = 0; list && i < list->array_size(); ++i) texts.push_back(list->element(i).text());
  return texts;
}

}  // namespace slipfit::documents
