#include "batch/inputs.hpp"

#include <cstdint>
#include <nlohmann/json.hpp>
#include <system_error>

#include "slipfit/core/digest.hpp"

namespace slipfit::batch {
namespace {

using PlainJson = nlohmann::json;

InputState compare_input(const PlainJson& recording, const std::filesystem::path& file) {
  const PlainJson digest = recording.value("input_digest", PlainJson());
  const PlainJson bytes = recording.value("input_bytes", PlainJson());
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
  const PlainJson json = PlainJson::parse(document, nullptr, false);
  if (!json.is_object()) return InputState::Changed;
  PlainJson recordings = json.value("recordings", PlainJson::array());
  if (json.contains("recording")) recordings = PlainJson::array({PlainJson{{"recording", json["recording"]}}});
  if (recordings.size() != inputs.size()) return InputState::Changed;
  InputState state = InputState::Same;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const InputState found = compare_input(recordings[i].value("recording", PlainJson::object()), inputs[i]);
    if (found == InputState::Changed) return found;
    if (found == InputState::Gone) state = found;
  }
  return state;
}

}  // namespace slipfit::batch
