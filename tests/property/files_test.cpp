// How a recording is written down does not change what it says: zero, unit, locale.
#include <fmt/format.h>

#include <catch2/catch.hpp>
#include <clocale>
#include <cstdlib>
#include <functional>
#include <locale>
#include <string>
#include <utility>

#include "run_program.hpp"
#include "scenes.hpp"
#include "slipfit/io/recording_reader.hpp"
#include "slipfit/report/json.hpp"

using namespace slipfit;
using test::Scene;

namespace {

constexpr std::uint64_t kFirstWritten = 821;
constexpr std::uint64_t kLastWritten = 826;

std::string rows(const Scene& scene, const std::function<std::string(double, double)>& row) {
  std::string text;
  for (std::size_t i = 0; i < scene.time_s.size(); ++i) text += row(scene.time_s[i], scene.force_N[i]);
  return text;
}

std::string plain(const Scene& scene) {
  return "time_s,force_N\n" + rows(scene, [](double t, double f) { return fmt::format("{},{}\n", t, f); });
}

Analysis analyse_text(const std::string& text, const Conditions& conditions) {
  const test::TemporaryFolder folder;
  const auto recording = read_recording(folder.file("scene.csv", text), conditions);
  INFO((recording ? std::string() : recording.error().message));
  REQUIRE(recording);
  return analyze_and_fit(recording.value());
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

/// Decimal comma in C++ and, where the sources of locales are installed (Debian: locales), in C.
class CommaLocale {
 public:
  CommaLocale() : before_(std::locale::global(std::locale(std::locale(), new Comma))) {
    const std::string name = "de_DE.UTF-8";
    (void)test::run_program("localedef", {"-i", "de_DE", "-f", "UTF-8", locales_.path(name)});
    ::setenv("LOCPATH", locales_.path("").c_str(), 1);
    in_c_ = std::setlocale(LC_ALL, name.c_str()) != nullptr;
  }
  ~CommaLocale() {
    std::locale::global(before_);
    std::setlocale(LC_ALL, "C");
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;
  [[nodiscard]] bool in_c() const { return in_c_; }

 private:
  struct Comma : std::numpunct<char> {
    [[nodiscard]] char do_decimal_point() const override { return ','; }
    [[nodiscard]] char do_thousands_sep() const override { return '.'; }
    [[nodiscard]] std::string do_grouping() const override { return "\3"; }
  };
  test::TemporaryFolder locales_;
  std::locale before_;
  bool in_c_ = false;
};

}  // namespace

TEST_CASE("a known zero removes a constant added to the force") {
  const Scene scene = test::random_scene(GENERATE(range(kFirstWritten, kLastWritten + 1)));
  const double zero_N = GENERATE(0.5, -3.0, 100.0);
  CAPTURE(scene.described, zero_N);
  Scene lifted = scene;
  for (double& force : lifted.force_N) force += zero_N;
  lifted.conditions.zero_force_N = zero_N;
  test::check_same(analyse_text(plain(scene), scene.conditions), analyse_text(plain(lifted), lifted.conditions));
}

TEST_CASE("a program whose locale has a decimal comma gets the same document") {
  const Scene scene = test::random_scene(kFirstWritten);
  CAPTURE(scene.described);
  const test::TemporaryFolder folder;
  const std::string file = folder.file("scene.csv", replaced(plain(scene), "time_s,force_N", "time [ms],force [mN]"));
  const auto document = [&] {
    const auto recording = read_recording(file, scene.conditions);
    REQUIRE(recording);
    return to_json(recording.value(), analyze_and_fit(recording.value()));
  };
  const std::string expected = document();
  const CommaLocale comma;
  if (!comma.in_c()) WARN("no locale with a decimal comma on this machine: only C++ was turned, not C");
  CHECK(document() == expected);
}
