// slipfit-hdf5 mat|hdf5 FILE [VARIABLE]: numbers of a .mat or HDF5 file as CSV on standard output, for slipfit. A
// program of its own: these libraries take some fifty others with them, and a damaged file that ends them ends nothing
// else. The first line is "=NAME" of what was read and, behind tabs, the names of all tables, or "!CODE MESSAGE" of
// what is wrong. slipfit-hdf5 mat-all|hdf5-all FILE: all tables, one after another: a line "=NAME", and for each piece
// of the CSV its number of bytes in a line, the last one 0; or, instead, a line "!CODE MESSAGE".

#include <cstdio>
#include <exception>
#include <functional>
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

/// Hands the text on in pieces.
template <class Write>
bool copy(NumberTable table, const Write& write_piece) {
  const auto text = text_of(std::move(table));
  std::vector<char> part(std::size_t{64} * 1024);
  bool written = true;
  while (written) {
    const std::size_t count = text->read(part.data(), part.size());
    if (count == 0) break;
    written = write_piece(std::string_view(part.data(), count));
  }
  return written;
}

/// Names with tabs or line ends are left out: no choice of a user could be that.
std::string line_of_names(const std::string& first, const std::vector<std::string>& others) {
  std::string line = "=" + first;
  for (const std::string& name : others) {
    if (name.find_first_of("\t\n") == std::string::npos) line += "\t" + name;
  }
  return line + "\n";
}

int read_one(std::string_view kind, std::string_view file, const std::optional<std::string>& variable) {
  auto* const read = kind == "mat" ? read_mat : read_hdf5;
  ReadTable found = read(file, variable);
  const bool written = write(line_of_names(found.name, found.all)) && copy(std::move(found.table), write);
  return written && std::fflush(stdout) == 0 ? 0 : 1;
}

int read_all_tables(std::string_view kind, std::string_view file) {
  bool written = true;
  const auto write_piece = [](std::string_view piece) {
    return write(std::to_string(piece.size()) + "\n") && write(piece);
  };
  auto* const take_all = kind == "mat-all" ? take_all_of_mat : take_all_of_hdf5;
  take_all(file, [&](const std::string& name, const std::function<NumberTable()>& read) {
    if (!written || name.find('\n') != std::string::npos) return;
    written = write("=" + name + "\n");
    try {
      written = written && copy(read(), write_piece) && write("0\n");
    } catch (const Refusal& refusal) {
      written = write("!" + refusal.error().code + " " + refusal.error().message + "\n");
    }
  });
  return written && std::fflush(stdout) == 0 ? 0 : 1;
}

int run(std::string_view kind, const char* name, const std::optional<std::string>& variable) {
  const std::string_view file = map_only_file(name);
  return kind.ends_with("-all") ? read_all_tables(kind, file) : read_one(kind, file, variable);
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
