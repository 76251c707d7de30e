#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <regex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/container/cursor.hpp"
#include "io/container/table_text.hpp"
#include "io/message.hpp"

// The format of NumPy's save(), as numpy.lib.format describes it: a line of Python that states type, order and shape of
// an array, then its numbers.

namespace slipfit::reading {
namespace {

using namespace std::string_view_literals;

/// The kinds of numbers. A file names them so, after a sign for the order of their bytes.
constexpr std::array kArrayTypes{number_type<float>("f4"sv),         number_type<double>("f8"sv),
                                 number_type<std::int8_t>("i1"sv),   number_type<std::int16_t>("i2"sv),
                                 number_type<std::int32_t>("i4"sv),  number_type<std::int64_t>("i8"sv),
                                 number_type<std::uint8_t>("u1"sv),  number_type<std::uint16_t>("u2"sv),
                                 number_type<std::uint32_t>("u4"sv), number_type<std::uint64_t>("u8"sv)};

/// Describes a number of a row: its column, its place in the row and how it is read.
struct Field {
  std::string name;  ///< empty: none is stated
  std::size_t offset = 0;
  std::endian order = std::endian::little;
  const NumberType<std::string_view>* type = nullptr;
};

/// Holds what the first line of an array states.
struct NpyHeader {
  std::vector<Field> fields;
  std::size_t row_bytes = 0;
  std::size_t rows = 0;
  std::size_t row_step = 0;  ///< bytes from a row to the next of the same column
  std::string_view numbers;  ///< all bytes after the line
};

ThrownError no_table(const std::string& name, const std::string& what) {
  return ThrownError(
      {"damaged_container",
       fmt::format("{}: the NumPy file contains {}; save an array of real numbers with one or two dimensions", name,
                   what)});
}

/// Returns the line of Python at the beginning of the file. Throws Damaged.
std::string_view line_of_header(Cursor& file) {
  constexpr std::size_t kMagic = 6;
  constexpr std::size_t kLongest = 10000;  // of a line that NumPy reads
  file.bytes(kMagic);
  const bool is_first_version = file.number<std::uint8_t>() == 1;
  file.number<std::uint8_t>();  // minor version
  const std::size_t length = is_first_version ? file.number<std::uint16_t>() : file.number<std::uint32_t>();
  if (length > kLongest) throw Damaged{};
  return file.bytes(length);
}

/// Returns the text of an entry of the dictionary that the line of Python is. Throws Damaged.
std::string entry_of(const std::string& line, const std::string& pattern) {
  std::smatch match;
  if (!std::regex_search(line, match, std::regex(pattern))) throw Damaged{};
  return match[1];
}

std::vector<std::size_t> shape_of(const std::string& line) {
  const std::string extents = entry_of(line, R"('shape':\s*\(([0-9, ]*)\))");
  const std::regex number("[0-9]{1,18}");
  std::vector<std::size_t> shape;
  for (std::sregex_iterator one(extents.begin(), extents.end(), number), end; one != end; ++one) {
    shape.push_back(std::stoull(one->str()));
  }
  return shape;
}

/// Throws Damaged. Error: damaged_container, for what is no table of numbers.
NpyHeader npy_header(std::string_view file, const std::string& name) {
  NpyHeader header;
  Cursor cursor(file, std::endian::little);
  const std::string line(line_of_header(cursor));
  header.numbers = cursor.rest();
  const std::vector<std::size_t> shape = shape_of(line);
  const std::string types = entry_of(line, R"('descr':\s*('[^']*'|\[[^\]]*\]))");
  const bool has_names = types.front() == '[';
  if (shape.empty() || shape.size() > (has_names ? 1U : 2U)) {
    throw no_table(name, fmt::format("an array of {} dimensions", shape.size()));
  }
  header.rows = shape.front();
  const std::size_t columns = shape.size() > 1 ? std::min(shape.back(), file.size()) : 1;
  const std::regex field(has_names ? R"(\('([^']*)',\s*'([^']*)'\))" : "()'([^']*)'");
  for (std::sregex_iterator one(types.begin(), types.end(), field), end; one != end; ++one) {
    const std::string type_name = (*one)[2];
    const auto* const type =
        find_type(kArrayTypes, std::string_view(type_name).substr(std::min<std::size_t>(1, type_name.size())));
    if (type == nullptr) throw no_table(name, fmt::format("values of the type '{}'", printable_utf8(type_name)));
    const std::endian order = type_name.front() == '>' ? std::endian::big : std::endian::little;
    for (std::size_t i = 0; i < columns; ++i) {
      header.fields.push_back({(*one)[1], header.row_bytes, order, type});
      header.row_bytes += type->bytes;
    }
  }
  if (header.fields.empty() || header.rows > header.numbers.size() / header.row_bytes) throw Damaged{};
  header.row_step = header.row_bytes;
  if (!has_names && line.find("'fortran_order': True") != std::string::npos) {
    header.row_step = header.row_bytes / columns;
    for (Field& one : header.fields) one.offset *= header.rows;
  }
  return header;
}

NumberTable table_of(std::string_view file, const std::string& name) {
  const NpyHeader header = npy_header(file, name);
  NumberTable table;
  for (const Field& field : header.fields) {
    if (!field.name.empty()) table.names.push_back(field.name);
    std::vector<double>& column = table.columns.emplace_back();
    column.reserve(header.rows);
    for (std::size_t row = 0; row < header.rows; ++row) {
      Cursor cursor(header.numbers.substr(field.offset + row * header.row_step), field.order);
      column.push_back(field.type->read(cursor));
    }
  }
  return table;
}

}  // namespace

Container open_npy(TextStream packed, const std::string& name) {
  const std::string file = read_all(packed, name);
  TextStream text;
  try {
    text.bytes = text_of(table_of(file, name));
  } catch (const Damaged&) {
    throw damaged(name, "the NumPy file is cut off or damaged");
  }
  return one_table(std::move(text));
}

}  // namespace slipfit::reading
