#include "document_rules.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <string_view>

namespace test {
namespace {

using nlohmann::json;

constexpr std::array<std::string_view, 17> kNotNegative{"stiffness_N_per_m",
                                                        "friction_difference_N",
                                                        "friction_coefficient_difference",
                                                        "natural_frequency_rad_per_s",
                                                        "mass_kg",
                                                        "damping_ratio",
                                                        "damping_coefficient_N_s_per_m",
                                                        "lambda",
                                                        "lambda_critical",
                                                        "critical_speed_m_per_s",
                                                        "periodic_displacement_m",
                                                        "pattern_spacing_m",
                                                        "micro_vibration_spacing_m",
                                                        "impulse_rate_per_m",
                                                        "spacing_m",
                                                        "spacing_left_out_m",
                                                        "pattern_spacing_sd_m"};
constexpr std::array<std::string_view, 4> kShares{"sticking_degree", "false_alarm_probability", "whiteness_p",
                                                  "p_value"};

bool is_share(std::string_view key) {
  return std::find(kShares.begin(), kShares.end(), key) != kShares.end();
}

/// Times and frequencies by their unit, spreads and residuals by their name. The stretch that slides stands on the
/// recording's own clock, which may begin anywhere; a level falls or rises.
bool is_not_negative(std::string_view key) {
  const bool is_signed = key == "sliding_s" || key == "value_N_per_s" || key == "value_per_s";
  const bool by_unit = key.ends_with("_Hz") || (key.ends_with("_s") && !is_signed) || key == "harmonics";
  const bool by_name = key.find("_sd_") != key.npos || key.find("rms") != key.npos || key == "force_drop_N";
  return by_unit || by_name || is_share(key) ||
         std::find(kNotNegative.begin(), kNotNegative.end(), key) != kNotNegative.end();
}

/// Value, error and interval of one quantity, whatever their keys.
struct Quantity {
  json value, error, interval;
};

class Walk {
 public:
  std::vector<std::string> breaches;

  void visit(const json& node, const std::string& key, const std::string& place) {
    if (node.is_number()) check_number(node.get<double>(), key, place);
    if (node.is_string()) demand(!says_not_a_number(node.get<std::string>()), place, "a sentence: " + node.dump());
    if (node.is_object()) visit_object(node, key, place);
    if (!node.is_array()) return;
    for (std::size_t i = 0; i < node.size(); ++i) visit(node[i], key, place + "." + std::to_string(i));
  }

 private:
  void demand(bool holds, const std::string& place, const std::string& what) {
    if (!holds) breaches.push_back(place + ": " + what);
  }

  void check_number(double number, const std::string& key, const std::string& place) {
    demand(number >= 0.0 || !is_not_negative(key), place, "below 0: " + std::to_string(number));
    demand(number <= 1.0 || !is_share(key), place, "above 1: " + std::to_string(number));
  }

  void visit_object(const json& node, const std::string& key, const std::string& place) {
    if (node.contains("value"))
      check_quantity({node["value"], node.value("se", json()), node.value("ci95", json())}, place);
    if (node.contains("value_Hz")) {
      check_quantity({node["value_Hz"], node.value("se_Hz", json()), node.value("ci95_Hz", json())}, place);
    }
    for (const char* const rate : {"value_N_per_s", "value_per_s"}) {
      if (!node.contains(rate) || node[rate].is_null()) continue;
      check_quantity({node[rate], node.value("se", json()), node.value("ci95", json())}, place);
    }
    if (node.contains("status") && node.contains("note")) check_status(node, place);
    for (const auto& [name, member] : node.items()) {
      const bool is_of_parent = name == "value" || name == "ci95";
      visit(member, is_of_parent ? key : name, place + "." + name);
    }
  }

  void check_quantity(const Quantity& quantity, const std::string& place) {
    const auto& [value, error, interval] = quantity;
    if (error.is_number()) {
      demand(error.get<double>() >= 0.0, place, "a negative error");
      demand(value.is_number(), place, "an error without a value");
    }
    if (!interval.is_array()) return;
    demand(interval.size() == 2 && interval[0].is_number() && interval[1].is_number(), place,
           "an interval without ends");
    demand(interval[0] <= interval[1], place, "an interval upside down");
    demand(!value.is_number() || (interval[0] <= value && value <= interval[1]), place,
           value.dump() + " outside " + interval.dump());
  }

  void check_status(const json& node, const std::string& place) {
    const bool is_known = node["status"] != "unidentified";
    const bool has_value = is_known && node["status"] != "bounded";
    demand(has_value == node["value"].is_number(), place,
           node["status"].dump() + " with value " + node["value"].dump());
    demand(!is_known || node["ci95"].is_array(), place, node["status"].dump() + " without an interval");
    demand(is_known || !node["note"].get<std::string>().empty(), place, "unidentified without a reason");
  }
};

/// Parameters that are identified beside a warning that puts them in question, or outside of a contradicting value.
std::vector<std::string> contradictions_of(const json& document) {
  std::vector<std::string> breaches;
  if (!document.is_object() || !document.contains("warnings") || !document.contains("parameters")) return breaches;
  const json& parameters = document["parameters"];
  const auto check = [&](const std::string& why, std::initializer_list<const char*> names) {
    for (const char* const name : names) {
      if (parameters.contains(name) && parameters[name]["status"] == "identified") {
        breaches.push_back(std::string(name) + " identified beside " + why);
      }
    }
  };
  for (const json& warning : document["warnings"]) {
    const auto code = warning["code"].get<std::string>();
    if (code == "implausible_units" || code.starts_with("speed_differs")) {
      check(code, {"stiffness_N_per_m", "mass_kg", "damping_coefficient_N_s_per_m"});
    }
    if (code == "model_misfit") check(code, {"natural_frequency_rad_per_s", "mass_kg", "damping_ratio"});
  }
  const auto check_audit = [&](const json& audited) {
    for (const json& pair : audited.value("audit", json::array())) {
      const bool is_of_stiffness = pair["pair"] == "stiffness_and_sticks" ||
                                   pair["pair"] == "stiffness_and_other_sticks" ||
                                   pair["pair"] == "speed_and_displacement";
      if (pair["contradicts"] && is_of_stiffness) {
        check(pair["pair"].get<std::string>(), {"stiffness_N_per_m", "mass_kg"});
      }
    }
  };
  check_audit(document);
  for (const json& recording : document.value("recordings", json::array())) check_audit(recording);
  return breaches;
}

}  // namespace

std::vector<std::string> breaches_of(const json& document) {
  Walk walk;
  walk.visit(document, "", "document");
  const std::vector<std::string> more = contradictions_of(document);
  walk.breaches.insert(walk.breaches.end(), more.begin(), more.end());
  return walk.breaches;
}

bool says_not_a_number(const std::string& text) {
  const auto is_letter = [&text](std::size_t i) {
    return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) != 0 || text[i] == '_');
  };
  for (const char* const word : {"inf", "nan"}) {
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) {
      if (!is_letter(at + 3) && (at == 0 || !is_letter(at - 1))) return true;
    }
  }
  return false;
}

std::string without_scripts(std::string page) {
  for (std::size_t begin = 0; (begin = page.find("<script")) != std::string::npos;) {
    const std::size_t end = page.find("</script>", begin);
    page.erase(begin, end == std::string::npos ? end : end - begin + 9);
  }
  return page;
}

}  // namespace test
