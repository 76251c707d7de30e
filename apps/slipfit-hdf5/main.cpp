// slipfit-hdf5 mat|hdf5 FILE [VARIABLE]: numbers of a .mat or HDF5 file as CSV on standard output, for slipfit. A
// program of its own: these libraries take some fifty others with them, and a damaged file that ends them ends nothing
// else. The first line is "=NAME" of what was read, or "!CODE MESSAGE" of what is wrong. slipfit-hdf5
// mat-tables|hdf5-tables FILE: the names of all tables, parted by tabs, in such a line.

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

bool write_table(ReadTable read) {
  bool written = write("=" + read.name + "\n");
  const auto text = text_of(std::move(read.table));
  std::vector<char> part(std::size_t{64} * 1024);
  while (written) {
    const std::size_t count = text->read(part.data(), part.size());
    if (count == 0) break;
    written = write({part.data(), count});
  }
  return written;
}

/// Names with tabs or line ends are left out: no choice of a user could be that.
bool write_names(const std::vector<std::string>& names) {
  std::string line = "=";
  for (const std::string& name : names) {
    if (name.find_first_of("\t\n") == std::string::npos) line += (line.size() == 1 ? "" : "\t") + name;
  }
  return write(line + "\n");
}

int run(std::string_view kind, const char* name, const std::optional<std::string>& variable) {
  const std::string_view file = map_only_file(name);
  const ArrayFormat& format = kind.starts_with("mat") ? kMat : kHdf5;
  const bool written =
      kind.ends_with("-tables") ? write_names(format.tables(file)) : write_table(format.read(file, variable));
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
