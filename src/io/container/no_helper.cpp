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

TextStream text_of_table(NumberTable table, const std::string& name) {
  TextStream text;
  text.bytes = text_of(std::move(table));
  text.assumed.push_back("Of the file '" + printable_utf8(name) + "' was read.");
  return text;
}

using ReadOne = ReadTable(std::string_view file, const std::optional<std::string>& variable);

TextStream open_arrays(ReadOne* read, TextStream packed, const std::string& name, const ContainerChoice& choice) {
  const std::string file = read_all(packed, name);
  ReadTable found = with_name(name, [&] { return read(file, choice.variable); });
  TextStream text = text_of_table(std::move(found.table), found.name);
  text.tables = std::move(found.all);
  return text;
}

using TakeAll = void(std::string_view file, const TakeTable& take);

void visit_arrays_of(TakeAll* take_all, TextStream packed, const std::string& name, const TableVisitor& visit) {
  const std::string file = read_all(packed, name);
  with_name(name, [&] {
    take_all(file, [&](const std::string& table, const std::function<NumberTable()>& read) {
      visit({table, [&] { return text_of_table(with_name(name, read), table); }});
    });
  });
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

void visit_hdf5(TextStream packed, const std::string& name, const TableVisitor& visit) {
  visit_arrays_of(take_all_of_hdf5, std::move(packed), name, visit);
}

void visit_mat(TextStream packed, const std::string& name, const TableVisitor& visit) {
  visit_arrays_of(take_all_of_mat, std::move(packed), name, visit);
}

}  // namespace slipfit::reading
