#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "slipfit/core/result.hpp"
#include "slipfit/core/units.hpp"
#include "slipfit/io/manifest_entry.hpp"

namespace slipfit::reading {

/// What can be said about a recording: the one table of manifests, the command line and programs that say it as text.
struct ManifestField {
  enum class Bound { AboveZero, NotNegative, None };
  enum class Need { Nothing, Column, Value };  ///< of a manifest
  using SetNumber = void(ManifestEntry&, double);
  using SetText = std::optional<Error>(ManifestEntry&, const std::string&);

  RecordingOption said;
  std::string_view suffix{};             ///< behind the column's name: its SI unit
  std::optional<Dimension> dimension{};  ///< empty: text
  Bound bound = Bound::None;
  SetNumber* set_number = nullptr;  ///< nothing and `dimension`: a window
  SetText* set_text = nullptr;
  Need need = Need::Nothing;

  [[nodiscard]] std::string full_name() const { return std::string(said.column) + std::string(suffix); }
};

std::span<const ManifestField> manifest_fields();

/// The text with the manifest's columns in place of the options of the command line that say the same.
std::string with_columns_for_options(std::string text);

}  // namespace slipfit::reading
