#include "quantities.hpp"

#include <algorithm>

#include "slipfit/fit/parameter.hpp"

double quantity(const std::string& option, const std::string& text, slipfit::Dimension dimension, Limits limits) {
  const auto parsed = slipfit::parse_quantity(text, dimension);
  if (!parsed) refuse("{}: {}", option, parsed.error().message);
  const double value = parsed.value();
  if (limits == Limits::AboveZero && !(value > 0.0)) refuse("{}: '{}' is not above zero", option, text);
  if (limits == Limits::NotNegative && !(value >= 0.0)) refuse("{}: '{}' is below zero", option, text);
  return value;
}

std::string key_of_parameter(const std::string& text) {
  const slipfit::ParameterInfo* found = nullptr;  // of several the one with the fewest words: "F_s - F_k" ends with F_k
  for (const slipfit::ParameterInfo& parameter : slipfit::parameter_table()) {
    const bool has_symbol = parameter.words.ends_with(" " + text);
    if (has_symbol && (found == nullptr || parameter.words.size() < found->words.size())) found = &parameter;
  }
  return found == nullptr ? text : std::string(found->key);
}

slipfit::FitOptions fit_options_from(const std::string& tier, const std::vector<std::string>& fixed,
                                     slipfit::FitKind kind) {
  std::vector<std::string> with_keys;
  for (const std::string& text : fixed) {
    const std::size_t end = std::min(text.find('='), text.size());
    with_keys.push_back(key_of_parameter(text.substr(0, end)) + text.substr(end));
  }
  return value_or_fail(slipfit::parse_fit_options(tier, with_keys, kind));
}
