#include <utility>

#include "io/arrays/tables.hpp"
#include "io/container/formats.hpp"
#include "io/message.hpp"

// In place of helper.cpp where no program can be started: what the program slipfit-hdf5 reads is read here.

namespace slipfit::reading {
namespace {

/// Returns the value of `work()`; a Refusal gets the name of the file.
template <class Work>
auto with_name(const std::string& name, const Work& work) {
  try {
    return work();
  } catch (const Refusal& refusal) {
    throw ThrownError({refusal.error().code, name + ": " + printable_utf8(refusal.error().message)});
  }
}

Container arrays_in(OpenArrays open_arrays, TextStream packed, const std::string& name) {
  const auto bytes = std::make_shared<const std::string>(read_all(packed, name));
  const ArrayFile file = with_name(name, [&] { return open_arrays(*bytes); });
  const auto open = [bytes, file, name](const std::optional<std::string>& variable) {
    ReadTable read = with_name(name, [&] { return file.read(variable); });
    TextStream text;
    text.bytes = text_of(std::move(read.table));
    text.assumed.push_back(table_was_read(read.name));
    return text;
  };
  return {open, [bytes, file, name] { return with_name(name, file.tables); }};
}

}  // namespace

HelperOutput run_helper(const Helper& helper, const FileHandle& /*input*/, const std::string& name) {
  throw ThrownError(
      {"not_built_in",
       name + ": " + helper.kind + ", which slipfit cannot read in a browser; export it as text, or use the program"});
}

FileHandle file_in_memory(ByteStream& /*stream*/, const std::string& /*name*/) {
  return {};  // no helper takes it
}

Container open_hdf5(TextStream packed, const std::string& name) {
  return arrays_in(open_hdf5_arrays, std::move(packed), name);
}

Container open_mat(TextStream packed, const std::string& name) {
  return arrays_in(open_mat_arrays, std::move(packed), name);
}

}  // namespace slipfit::reading
