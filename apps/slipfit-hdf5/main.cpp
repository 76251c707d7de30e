// slipfit-hdf5 mat|hdf5 FILE [VARIABLE]: numbers of a .mat or HDF5 file as CSV on standard output, for slipfit. A
// program of its own: these libraries take some fifty others with them, and a damaged file that ends them ends nothing
// else. The first line is "=NAME" of what was read, or "!CODE MESSAGE" of what is wrong. slipfit-hdf5 mat-all|hdf5-all
// FILE: the names of all tables, parted by tabs, in such a line, then each table after a line "=BYTES" or "!CODE
// MESSAGE".

#include <cstdio>
#include <exception>
#include <new>
#include <string_view>
#include <utility>

#include "../helper_limits.hpp"
#include "io/arrays/tables.hpp"

using namespace slipfit::reading;

namespace {

constexpr rlim_t kMostMemory = rlim_t{8} << 30U;
constexpr rlim_t kMostSeconds = 120;

bool write(std::string_view text) {
  return std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
}

int refuse(const std::string& line) {
  write("!" + line + "\n");
  std::fflush(stdout);
  return 1;
}

/// Calls `put` with one part of the table's text after the other until it returns false, and returns what it did.
template <class Put>
bool put_text(NumberTable table, const Put& put) {
  const auto text = text_of(std::move(table));
  std::vector<char> part(std::size_t{64} * 1024);
  while (const std::size_t count = text->read(part.data(), part.size())) {
    if (!put(std::string_view(part.data(), count))) return false;
  }
  return true;
}

bool write_table(ReadTable read) {
  return write("=" + read.name + "\n") && put_text(std::move(read.table), write);
}

bool write_measured_table(const ArrayFile& file, const std::string& name) {
  try {
    std::string all;
    put_text(file.read(name).table, [&](std::string_view part) { return !all.append(part).empty(); });
    return write("=" + std::to_string(all.size()) + "\n") && write(all);
  } catch (const Refusal& refusal) {
    return write("!" + refusal.error().code + " " + refusal.error().message + "\n");
  }
}

/// Leaves out tables whose names contain tabs or line ends: a user cannot choose them.
bool write_all_tables(const ArrayFile& file) {
  std::vector<std::string> names = file.tables();
  std::erase_if(names, [](const std::string& name) { return name.find_first_of("\t\n") != std::string::npos; });
  std::string line;
  for (const std::string& name : names) line += (line.empty() ? "=" : "\t") + name;
  bool written = write(line.empty() ? "=\n" : line + "\n") && std::fflush(stdout) == 0;
  for (const std::string& name : names) written = written && write_measured_table(file, name);
  return written;
}

int run(std::string_view kind, const char* name, const std::optional<std::string>& variable) {
  const std::string_view bytes = map_only_file(name);
  const ArrayFile file = kind.starts_with("mat") ? open_mat_arrays(bytes) : open_hdf5_arrays(bytes);
  const bool written = kind.ends_with("-all") ? write_all_tables(file) : write_table(file.read(variable));
  return written && std::fflush(stdout) == 0 ? 0 : 1;
}

/// Never throws.
int run_or_refuse(std::string_view kind, const char* name, const std::optional<std::string>& variable) {
  try {
    return run(kind, name, variable);
  } catch (const Refusal& refusal) {
    return refuse(refusal.error().code + " " + refusal.error().message);
  } catch (const std::bad_alloc&) {
    return refuse("container_too_large it needs more memory than is available; export a part of it as CSV");
  } catch (const std::exception& error) {
    return refuse(std::string("damaged_container ") + error.what());
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 4) return 2;
  end_with_slipfit();
  limit_resources(kMostMemory, kMostSeconds);
  end_program(run_or_refuse(argv[1], argv[2], argc > 3 ? std::optional<std::string>(argv[3]) : std::nullopt));
}
