#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "failure.hpp"

/// A file that an option names, and the option for messages.
struct OutputFile {
  std::string option;
  std::string file;
};

/// The options of every command that writes a document or files.
struct DocumentOptions {
  bool json = false;
  bool quiet = false;
  bool details = false;             ///< prints all results as text instead of the summary
  std::vector<OutputFile> outputs;  ///< that were named; --out: of the document
  std::string command_line;         ///< as typed, for reports

  /// Returns whether the output was named.
  [[nodiscard]] bool has(const std::string& option) const;
  /// Says a message, but with --quiet.
  void notify(const std::string& message) const;
};

/// --json, --out and --quiet; `text` is the word for the document without --json in the help.
void add_document_options(CLI::App& command, DocumentOptions& options, const std::string& text);
/// --quiet
void add_quiet_option(CLI::App& command, DocumentOptions& options);
/// An option that names a further file.
void add_output_option(CLI::App& command, DocumentOptions& options, const std::string& option, const std::string& help);
/// --report
void add_report_option(CLI::App& command, DocumentOptions& options);

/// Throws Failure(WrongUsage): pages are HTML, whatever the name says.
[[noreturn]] void refuse_report_name(const std::string& file);
/// Refuses a name with the ending of another kind of file ("x.pdf").
void check_report_name(const std::string& file);

/// Checks outputs before any work: throws Failure(WrongUsage) if an output is the input (empty without one), is named
/// twice, is a folder, or has no folder.
void check_outputs(const std::vector<OutputFile>& outputs, const std::string& input,
                   const std::string& words_for_input = "recording");

/// Made where it is missing, but not its parent folders: a mistyped path creates nothing. Throws Failure(WrongUsage).
void make_folder(const OutputFile& folder);

/// Writes through a temporary file next to it and a rename: readers see the old content or the new, never a part.
/// What is no regular file (a pipe, /dev/stdout) is written directly.
void write_file(const OutputFile& output, const std::string& content);

/// Writes each file and says so; the document, which is the content of --out, goes to standard output without --out.
void write_results(const DocumentOptions& options,
                   const std::function<std::string(const std::string& option)>& content_of);

/// Writes the documents of one recording or several, each with its line end: one stays as it is; several are texts one
/// below the other, or one JSON array. An error of the only one is thrown with the exit code for its code; others are
/// said at once. Throws Failure(RecordingsFailed) at the end where recordings failed, Failure(BadRecording) where all
/// did.
void write_each(const DocumentOptions& options, std::size_t count,
                const std::function<slipfit::Result<std::string>(std::size_t)>& document_of,
                ExitCode (*exit_code_for)(const std::string& code));

void write_standard_output(const std::string& content);

/// A message to standard error, "slipfit: ...", on one line.
void say(const std::string& message);

/// A command as a shell takes it: `slipfit` and the words after the first, quoted where they must be.
std::string shell_line(const std::vector<std::string>& words);
/// The command that drafts a manifest of files and folders.
std::string manifest_command(const std::vector<std::string>& paths);
