#include "output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>

#include "document_file.hpp"
#include "failure.hpp"
#include "slipfit/core/printable.hpp"

namespace fs = std::filesystem;

namespace {

[[noreturn]] void cannot_write(const OutputFile& output, int error_number) {
  refuse("{}: cannot write '{}': {}", output.option, output.file, std::strerror(error_number));
}

/// Returns 0, or the errno of the step that failed.
int write_all(File file, const std::string& content) {
  if (!file) return errno;
  errno = 0;
  const bool written = std::fwrite(content.data(), 1, content.size(), file.get()) == content.size();
  const bool flushed = written && std::fflush(file.get()) == 0;
  if (!flushed) return errno == 0 ? EIO : errno;
  return std::fclose(file.release()) == 0 ? 0 : errno;
}

/// Creates the file with the mode of `target` from the start: at no time can others read what the old one keeps
/// private.
File open_like(const fs::path& temporary, const fs::path& target) {
  struct stat status {};
  const bool exists = ::stat(target.c_str(), &status) == 0;
  const int descriptor =
      ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, exists ? mode_t{0600} : mode_t{0666});
  if (descriptor < 0) return nullptr;
  if (exists) (void)::fchmod(descriptor, status.st_mode & 0777U);  // some file systems have no modes
  return File(::fdopen(descriptor, "wb"));
}

/// Two names of one file, also where neither exists so far.
bool same_file(const fs::path& first, const fs::path& second) {
  std::error_code ignored;
  if (fs::equivalent(first, second, ignored)) return true;
  return fs::weakly_canonical(first, ignored) == fs::weakly_canonical(second, ignored);
}

void check_place(const OutputFile& output) {
  std::error_code ignored;
  const fs::path path(output.file);
  if (output.file.empty() || fs::is_directory(path, ignored)) {
    refuse("{}: '{}' is a folder, expected a file name", output.option, output.file);
  }
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  if (!fs::is_directory(folder, ignored)) {
    refuse("{}: cannot write '{}': the folder '{}' does not exist", output.option, output.file, folder.string());
  }
}

}  // namespace

bool DocumentOptions::has(const std::string& option) const {
  return std::any_of(outputs.begin(), outputs.end(),
                     [&option](const OutputFile& file) { return file.option == option; });
}

void DocumentOptions::notify(const std::string& message) const {
  if (!quiet) say(message);
}

void add_document_options(CLI::App& command, DocumentOptions& options, const std::string& text) {
  command.add_flag("--json", options.json, "Print one JSON document instead of the " + text);
  add_output_option(command, options, "--out", "Write the " + text + " or the JSON document to this file");
  add_quiet_option(command, options);
}

void add_quiet_option(CLI::App& command, DocumentOptions& options) {
  command.add_flag("--quiet", options.quiet, "Print only errors on standard error");
}

void add_output_option(CLI::App& command, DocumentOptions& options, const std::string& option,
                       const std::string& help) {
  command.add_option_function<std::string>(
      option,
      [&options, option](const std::string& file) {
        if (option == "--report") check_report_name(file);
        options.outputs.push_back({option, file});
      },
      help);
}

void refuse_report_name(const std::string& file) {
  refuse("--report: '{}' is not the name of an HTML page; use '{}'{}", file,
         fs::path(file).replace_extension(".html").string(),
         fs::path(file).extension() == ".pdf" ? " and print it to PDF from the browser" : "");
}

void check_report_name(const std::string& file) {
  const fs::path ending = fs::path(file).extension();
  if (!ending.empty() && ending != ".html" && ending != ".htm") refuse_report_name(file);
}

void add_report_option(CLI::App& command, DocumentOptions& options) {
  add_output_option(command, options, "--report", "Write a page with charts (one HTML file)");
}

void check_outputs(const std::vector<OutputFile>& outputs, const std::string& input,
                   const std::string& words_for_input) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    check_place(outputs[i]);
    if (!input.empty() && same_file(outputs[i].file, input)) {
      refuse("{}: '{}' is the {} itself, choose another file", outputs[i].option, outputs[i].file, words_for_input);
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (!same_file(outputs[i].file, outputs[j].file)) continue;
      refuse("{} and {} name the same file '{}', choose different files", outputs[j].option, outputs[i].option,
             outputs[i].file);
    }
  }
}

void make_folder(const OutputFile& folder) {
  std::error_code error;
  if (fs::is_directory(folder.file, error)) return;
  if (fs::exists(folder.file, error)) refuse("{}: '{}' is a file, expected a folder", folder.option, folder.file);
  fs::create_directory(folder.file, error);
  if (error) refuse("{}: cannot create the folder '{}': {}", folder.option, folder.file, error.message());
}

void write_file(const OutputFile& output, const std::string& content) {
  std::error_code error;
  const fs::path target = fs::exists(output.file, error) ? fs::canonical(output.file, error) : fs::path(output.file);
  if (fs::exists(target, error) && !fs::is_regular_file(target, error)) {
    const int failed = write_all(File(std::fopen(output.file.c_str(), "wb")), content);
    if (failed != 0) cannot_write(output, failed);
    return;
  }
  static int files_written = 0;
  const std::string name = fmt::format(".slipfit-{}-{}.tmp", ::getpid(), ++files_written);
  const fs::path temporary = target.parent_path() / name;
  int failed = write_all(open_like(temporary, target), content);
  if (failed == 0) {
    fs::rename(temporary, target, error);
    failed = error.value();
  }
  if (failed == 0) return;
  fs::remove(temporary, error);
  cannot_write(output, failed);
}

void write_results(const DocumentOptions& options,
                   const std::function<std::string(const std::string& option)>& content_of) {
  // Pages escape what they quote themselves; their scripts and styles stay as they are.
  const auto text_of = [&](const std::string& option) {
    return option == "--report" ? content_of(option) : slipfit::printable_lines(content_of(option));
  };
  for (const OutputFile& output : options.outputs) {
    write_file(output, text_of(output.option));
    options.notify(fmt::format("wrote '{}'", output.file));
  }
  if (!options.has("--out")) write_standard_output(text_of("--out"));
}

void write_each(const DocumentOptions& options, std::size_t count,
                const std::function<slipfit::Result<std::string>(std::size_t)>& document_of,
                ExitCode (*exit_code_for)(const std::string& code)) {
  const bool is_array = options.json && count > 1;
  std::string content;
  std::size_t written = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const slipfit::Result<std::string> document = document_of(i);
    if (!document) {
      if (count == 1) throw Failure(exit_code_for(document.error().code), document.error());
      say(document.error().message);
      continue;
    }
    if (written++ > 0) content += options.json ? ",\n" : "\n";
    content += is_array ? document.value().substr(0, document.value().find_last_not_of('\n') + 1) : document.value();
  }
  if (written == 0) throw Failure(ExitCode::BadRecording, fmt::format("none of {} recordings can be read", count));
  write_results(options, [&](const std::string&) { return is_array ? "[" + content + "]\n" : content; });
  if (written == count) return;
  throw Failure(ExitCode::RecordingsFailed, fmt::format("{} of {} recordings failed", count - written, count));
}

void write_standard_output(const std::string& content) {
  const bool written = std::fwrite(content.data(), 1, content.size(), stdout) == content.size();
  if (!written || std::fflush(stdout) != 0) {
    refuse("cannot write to standard output: {}", std::strerror(errno));
  }
}

void say(const std::string& message) {
  const std::string line = "slipfit: " + slipfit::printable(message) + "\n";
  (void)std::fwrite(line.data(), 1, line.size(), stderr);
}

std::string shell_line(const std::vector<std::string>& words) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-";
  std::string line = "slipfit";
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string& word = words[i];
    const bool is_plain = !word.empty() && word.find_first_not_of(kPlain) == std::string::npos;
    std::string quoted;
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    line += is_plain ? " " + word : " '" + quoted + "'";
  }
  return line;
}

std::string manifest_command(const std::vector<std::string>& paths) {
  std::vector<std::string> words{"slipfit", "manifest"};
  words.insert(words.end(), paths.begin(), paths.end());
  return shell_line(words);
}
