// replay_TARGET FOLDER...: the target over every file there, without a fuzzer. A fault ends the program.
#include <chrono>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <vector>

#include "demand.hpp"

namespace {

constexpr std::chrono::seconds kLongest{20};  // under sanitizers, on a busy machine; a fit takes milliseconds

void replay(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  const auto start = std::chrono::steady_clock::now();
  std::cerr << file.string() << std::endl;  // before it may end the program
  (void)LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  fuzz::demand(std::chrono::steady_clock::now() - start < kLongest, "an input ends within 20 s");
}

}  // namespace

int main(int argc, char** argv) {
  std::size_t files = 0;
  for (int i = 1; i < argc; ++i) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(argv[i])) {
      if (!entry.is_regular_file()) continue;
      replay(entry.path());
      ++files;
    }
  }
  std::cout << files << " inputs\n";
  return files > 0 ? 0 : 1;
}
