#include <emscripten/emscripten.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../slipfit/output.hpp"
#include "../slipfit/program.hpp"
#include "slipfit/core/remedy.hpp"

namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Outcome& outcome) {
  Json json{{"exit_code", static_cast<int>(outcome.exit)}, {"error", nullptr}};
  if (outcome.message.empty()) return json;
  const std::string remedy = slipfit::remedy_of({outcome.code, outcome.message});
  json["error"] = {{"code", outcome.code},
                   {"message", outcome.message},
                   {"remedy", remedy.empty() ? Json() : Json(remedy)},
                   {"exit_code", json["exit_code"]}};
  return json;
}

}  // namespace

/// Runs the command line `words` of {"words": [...], "outputs": [...]}; with the outputs, which reports do not show.
/// Returns {"exit_code": .., "error": null or {..}}; the text lives until the next call.
extern "C" EMSCRIPTEN_KEEPALIVE const char* slipfit_run(const char* request) {
  static std::string answer;
  Outcome outcome{ExitCode::WrongUsage, "the request is no JSON of a command line", "wrong_usage"};
  const Json parsed = Json::parse(request, nullptr, false);
  if (!parsed.is_discarded()) {
    auto words = parsed.value("words", std::vector<std::string>{});
    const std::string command_line = shell_line(words);
    for (const Json& output : parsed.value("outputs", Json::array())) words.push_back(output.get<std::string>());
    outcome = run_program(std::move(words), command_line);
  }
  answer = to_json(outcome).dump(-1, ' ', false, Json::error_handler_t::replace);
  return answer.c_str();
}
