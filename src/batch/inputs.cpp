#include "batch/inputs.hpp"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <system_error>

#include "slipfit/core/digest.hpp"

namespace slipfit::batch {
namespace {

using Json = nlohmann::json;

InputState compare_input(const Json& recording, const std::filesystem::path& file) {
  const Json digest = recording.value("input_digest", Json());
  const Json bytes = recording.value("input_bytes", Json());
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  if (error) return InputState::Gone;
  if (!digest.is_string() || bytes != size) return InputState::Changed;
  const auto now = digest_of_file(file.string());
  if (!now) return InputState::Gone;
  return digest == now->text() ? InputState::Same : InputState::Changed;
}

}  // namespace

InputState compare_inputs(const std::string& document, const std::vector<std::filesystem::path>& inputs) {
  const Json json = Json::parse(document, nullptr, false);
  if (!json.is_object()) return InputState::Changed;
  Json recordings = json.value("recordings", Json::array());
  if (json.contains("recording")) recordings = Json::array({Json{{"recording", json["recording"]}}});
  if (recordings.size() != inputs.size()) return InputState::Changed;
  InputState state = InputState::Same;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const InputState found = compare_input(recordings[i].value("recording", Json::object()), inputs[i]);
    if (found == InputState::Changed) return found;
    if (found == InputState::Gone) state = found;
  }
  return state;
}

}  // namespace slipfit::batch
