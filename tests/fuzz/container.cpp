// Bytes as a container: raw, or (first byte) as the text in a gzip file, the sheet of a workbook or its shared strings,
// which a fuzzer would not get past the checksums. Either a recording, or one line that says why not.
#include <minizip/zip.h>
#include <zlib.h>

#include <string>
#include <string_view>

#include "demand.hpp"
#include "memory_file.hpp"
#include "slipfit/io/file_info.hpp"
#include "slipfit/io/recording_reader.hpp"

namespace {

constexpr std::string_view kBook =
    R"(<workbook xmlns:r="x"><sheets><sheet name="a" sheetId="1" r:id="r1"/></sheets></workbook>)";
constexpr std::string_view kLinks =
    R"(<Relationships><Relationship Id="r1" Target="worksheets/sheet1.xml"/></Relationships>)";
constexpr std::string_view kSheet =
    R"(<worksheet><sheetData><row><c t="s"><v>0</v></c><c t="s"><v>1</v></c></row><row><c><v>0</v></c><c><v>1</v></c></row></sheetData></worksheet>)";

void add_member(zipFile archive, const char* name, std::string_view content) {
  zipOpenNewFileInZip(archive, name, nullptr, nullptr, 0, nullptr, 0, nullptr, Z_DEFLATED, 1);
  zipWriteInFileInZip(archive, content.data(), static_cast<unsigned>(content.size()));
  zipCloseFileInZip(archive);
}

void write_workbook(const std::string& file, std::string_view sheet, std::string_view strings) {
  zipFile const archive = zipOpen64(file.c_str(), APPEND_STATUS_CREATE);
  if (archive == nullptr) std::abort();
  add_member(archive, "xl/workbook.xml", kBook);
  add_member(archive, "xl/_rels/workbook.xml.rels", kLinks);
  add_member(archive, "xl/worksheets/sheet1.xml", sheet);
  add_member(archive, "xl/sharedStrings.xml", strings);
  zipClose(archive, nullptr);
}

void write_gzip(const std::string& file, std::string_view content) {
  gzFile const archive = gzopen(file.c_str(), "wb1");
  if (archive == nullptr) std::abort();
  gzwrite(archive, content.data(), static_cast<unsigned>(content.size()));
  gzclose(archive);
}

void read(const std::string& file, const slipfit::ReadOptions& options) {
  slipfit::Conditions conditions;
  conditions.speed_m_per_s = 0.01;
  const auto recording = slipfit::read_recording(file, conditions, options);
  if (!recording) return fuzz::demand_readable(recording.error());
  fuzz::demand(recording.value().sample_interval_s() > 0.0, "there is a sample interval");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view rest(reinterpret_cast<const char*>(data) + 1, size - 1);
  const bool is_packed = data[0] >= '1' && data[0] <= '3';
  const fuzz::MemoryFile file(data + (is_packed ? size : 0), is_packed ? 0 : size);
  if (data[0] == '1') write_gzip(file.name(), rest);
  if (data[0] == '2') write_workbook(file.name(), rest, "<sst><si><t>time</t></si><si><t>force</t></si></sst>");
  if (data[0] == '3') write_workbook(file.name(), kSheet, rest);
  read(file.name(), {});
  slipfit::ReadOptions options;
  options.variable = "Run";
  read(file.name(), options);
  options.variable.reset();
  options.sheet = "1";
  read(file.name(), options);
  if (const auto info = slipfit::inspect_recording(file.name()); !info) fuzz::demand_readable(info.error());
  return 0;
}
