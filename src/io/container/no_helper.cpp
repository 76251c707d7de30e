#include <utility>

#include "io/arrays/tables.hpp"
#include "io/container/formats.hpp"
#include "io/message.hpp"

// In place of helper.cpp where no program can be started: what the program slipfit-hdf5 reads is read here.

namespace slipfit::reading {
namespace {

using ReadTable = NumberTable(std::string file, const std::optional<std::string>& variable, std::string& chosen);

TextStream open_arrays(ReadTable* read, TextStream packed, const std::string& name, const ContainerChoice& choice) {
  std::string file = read_all(packed, name);
  try {
    TextStream text;
    std::string chosen;
    text.bytes = text_of(read(std::move(file), choice.variable, chosen));
    text.assumed.push_back("Of the file '" + printable(chosen) + "' was read.");
    return text;
  } catch (const Refusal& refusal) {
    throw ThrownError({refusal.error().code, name + ": " + printable(refusal.error().message)});
  }
}

}  // namespace

HelperOutput run_helper(const Helper& helper, TextStream /*input*/, const std::string& name) {
  throw ThrownError(
      {"not_built_in",
       name + ": " + helper.kind + ", which slipfit cannot read in a browser; export it as text, or use the program"});
}

TextStream open_hdf5(TextStream packed, const std::string& name, const ContainerChoice& choice) {
  return open_arrays(read_hdf5, std::move(packed), name, choice);
}

TextStream open_mat(TextStream packed, const std::string& name, const ContainerChoice& choice) {
  return open_arrays(read_mat, std::move(packed), name, choice);
}

}  // namespace slipfit::reading
