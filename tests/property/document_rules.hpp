#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace test {

/// What a document promises whatever the recording was, and this one breaks: a value lies in its interval, the interval
/// in the range of its quantity, no error stands without a value, a status fits what is known, and no sentence has an
/// infinite number in it. One line a breach.
std::vector<std::string> breaches_of(const nlohmann::json& document);

/// "inf" or "nan" as a word of its own.
bool says_not_a_number(const std::string& text);

/// A page without its scripts: packed numbers there may spell anything.
std::string without_scripts(std::string page);

}  // namespace test
