#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/endian/conversion.hpp>
#include <cstdint>
#include <cstring>
#include <regex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/container/table_text.hpp"
#include "slipfit/core/printable.hpp"

// The format of NumPy's save(), as numpy.lib.format describes it: a line of Python that states type, order and shape of
// an array, then its numbers.

namespace slipfit::reading {
namespace {

using Load = double(const char*);

template <class T, boost::endian::order Order>
double load(const char* bytes) {
  std::array<unsigned char, sizeof(T)> copy{};
  std::memcpy(copy.data(), bytes, copy.size());
  return static_cast<double>(boost::endian::endian_load<T, sizeof(T), Order>(copy.data()));
}

/// Holds a kind of number by its name without the order of its bytes.
struct ArrayType {
  std::string_view name;
  std::size_t size = 0;
  Load* little = nullptr;
  Load* big = nullptr;
};

template <class T>
constexpr ArrayType array_type(std::string_view name) {
  return {name, sizeof(T), load<T, boost::endian::order::little>, load<T, boost::endian::order::big>};
}

constexpr std::array kArrayTypes{
    array_type<float>("f4"),         array_type<double>("f8"),        array_type<std::int8_t>("i1"),
    array_type<std::int16_t>("i2"),  array_type<std::int32_t>("i4"),  array_type<std::int64_t>("i8"),
    array_type<std::uint8_t>("u1"),  array_type<std::uint16_t>("u2"), array_type<std::uint32_t>("u4"),
    array_type<std::uint64_t>("u8"),
};

/// Describes a number of a row: its column, its place in the row and how it is read.
struct Field {
  std::string name;  ///< empty: none is stated
  std::size_t offset = 0;
  Load* value_at = nullptr;
};

/// Holds what the first line of an array states.
struct Header {
  std::vector<Field> fields;
  std::size_t row_bytes = 0;
  std::size_t rows = 0;
  std::size_t row_step = 0;  ///< bytes from a row to the next of the same column
  std::size_t begin = 0;     ///< of the numbers in the file
};

/// Returns the type of "<f8", or nothing where it is no real number.
const ArrayType* type_of(std::string_view name) {
  const auto* const found =
      std::ranges::find(kArrayTypes, name.substr(std::min<std::size_t>(1, name.size())), &ArrayType::name);
  return found == kArrayTypes.end() ? nullptr : found;
}

ThrownError no_table(const std::string& name, const std::string& what) {
  return ThrownError(
      {"damaged_container",
       fmt::format("{}: the NumPy file contains {}; save an array of real numbers with one or two dimensions", name,
                   what)});
}

ThrownError cut_off(const std::string& name) {
  return damaged(name, "the NumPy file is cut off or damaged");
}

/// Returns the line of Python; the numbers begin at `begin`.
std::string line_of_header(std::string_view file, const std::string& name, std::size_t& begin) {
  constexpr std::size_t kMagic = 6;
  constexpr std::size_t kVersion = 2;
  constexpr std::size_t kLongest = 10000;  // of a line that NumPy reads
  const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(file[i])); };
  const std::size_t first = kMagic + kVersion;
  const bool is_first_version = file.size() > kMagic && file[kMagic] == 1;
  const std::size_t width = is_first_version ? 2 : 4;
  if (file.size() < first + width) throw cut_off(name);
  std::size_t length = 0;
  for (std::size_t i = 0; i < width; ++i) length += byte(first + i) << (8 * i);
  begin = first + width + length;
  if (length > kLongest || begin > file.size()) throw cut_off(name);
  return std::string(file.substr(first + width, length));
}

/// Returns the text of an entry of the dictionary that the line of Python is. Error: damaged_container.
std::string entry_of(const std::string& line, const std::string& pattern, const std::string& name) {
  std::smatch match;
  if (!std::regex_search(line, match, std::regex(pattern))) throw cut_off(name);
  return match[1];
}

std::vector<std::size_t> shape_of(const std::string& line, const std::string& name) {
  const std::string extents = entry_of(line, R"('shape':\s*\(([0-9, ]*)\))", name);
  const std::regex number("[0-9]{1,18}");
  std::vector<std::size_t> shape;
  for (std::sregex_iterator one(extents.begin(), extents.end(), number), end; one != end; ++one) {
    shape.push_back(std::stoull(one->str()));
  }
  return shape;
}

Header header_of(std::string_view file, const std::string& name) {
  Header header;
  const std::string line = line_of_header(file, name, header.begin);
  const std::vector<std::size_t> shape = shape_of(line, name);
  const std::string types = entry_of(line, R"('descr':\s*('[^']*'|\[[^\]]*\]))", name);
  const bool has_names = types.front() == '[';
  if (shape.empty() || shape.size() > (has_names ? 1U : 2U)) {
    throw no_table(name, fmt::format("an array of {} dimensions", shape.size()));
  }
  header.rows = shape.front();
  const std::size_t columns = shape.size() > 1 ? std::min(shape.back(), file.size()) : 1;
  const std::regex field(has_names ? R"(\('([^']*)',\s*'([^']*)'\))" : "()'([^']*)'");
  for (std::sregex_iterator one(types.begin(), types.end(), field), end; one != end; ++one) {
    const std::string type_name = (*one)[2];
    const ArrayType* const type = type_of(type_name);
    if (type == nullptr) throw no_table(name, fmt::format("values of the type '{}'", printable(type_name)));
    for (std::size_t i = 0; i < columns; ++i) {
      header.fields.push_back({(*one)[1], header.row_bytes, type_name.front() == '>' ? type->big : type->little});
      header.row_bytes += type->size;
    }
  }
  if (header.fields.empty() || header.rows > (file.size() - header.begin) / header.row_bytes) throw cut_off(name);
  header.row_step = header.row_bytes;
  if (!has_names && line.find("'fortran_order': True") != std::string::npos) {
    header.row_step = header.row_bytes / columns;
    for (Field& one : header.fields) one.offset *= header.rows;
  }
  return header;
}

}  // namespace

TextStream open_npy(TextStream packed, const std::string& name, const ContainerChoice& /*choice*/) {
  const std::string file = read_all(packed, name);
  const Header header = header_of(file, name);
  NumberTable table;
  for (const Field& field : header.fields) {
    if (!field.name.empty()) table.names.push_back(field.name);
    std::vector<double>& column = table.columns.emplace_back();
    column.reserve(header.rows);
    const char* next = file.data() + header.begin + field.offset;
    for (std::size_t row = 0; row < header.rows; ++row, next += header.row_step) {
      column.push_back(field.value_at(next));
    }
  }
  TextStream text;
  text.bytes = slipfit::reading::text_of(std::move(table));
  return text;
}

}  // namespace slipfit::reading
