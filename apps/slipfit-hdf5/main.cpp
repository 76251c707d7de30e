// slipfit-hdf5 mat|hdf5 FILE [VARIABLE]: numbers of a .mat or HDF5 file as CSV on standard output, for slipfit. A
// program of its own: these libraries take some fifty others with them, and a damaged file that ends them ends nothing
// else. The first line is "=NAME" of what was read, or "!CODE MESSAGE" of what is wrong.

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

int copy(NumberTable table, const std::string& chosen) {
  bool written = write("=" + chosen + "\n");
  const auto text = text_of(std::move(table));
  std::vector<char> part(std::size_t{64} * 1024);
  while (written) {
    const std::size_t count = text->read(part.data(), part.size());
    if (count == 0) break;
    written = write({part.data(), count});
  }
  return written && std::fflush(stdout) == 0 ? 0 : 1;
}

int run(std::string_view kind, const char* name, const std::optional<std::string>& variable) {
  std::string file = read_only_file(name);
  std::string chosen;
  auto* const read = kind == "mat" ? read_mat : read_hdf5;
  auto table = read(std::move(file), variable, chosen);
  return copy(std::move(table), chosen);
}

/// Never throws.
int run_or_refuse(std::string_view kind, const char* name, const std::optional<std::string>& variable) {
  try {
    return run(kind, name, variable);
  } catch (const Refusal& refusal) {
    return refuse(refusal.error().code + " " + refusal.error().message);
  } catch (const std::bad_alloc&) {
    return refuse("container_too_large it needs more memory than there is; export a part of it as CSV");
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
