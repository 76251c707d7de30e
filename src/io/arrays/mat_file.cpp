#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <functional>
#include <memory>
#include <new>
#include <set>
#include <string_view>
#include <utility>

#include "io/arrays/tables.hpp"
#include "io/container/cursor.hpp"
#include "io/container/formats.hpp"

// Files of MATLAB 5 to 7 are elements one after another, each a type, a number of bytes and these bytes. Source:
// "MAT-File Format", The MathWorks, 2017, chapter 1.

namespace slipfit::reading {
namespace {

/// The type of the bytes of an element: numbers of one kind, or elements.
enum class MatType : std::uint32_t {
  Int8 = 1,
  UInt8 = 2,
  Int16 = 3,
  UInt16 = 4,
  Int32 = 5,
  UInt32 = 6,
  Single = 7,
  Double = 9,
  Int64 = 12,
  UInt64 = 13,
  Matrix = 14,
  Compressed = 15,
};

struct MatElement {
  MatType type{};
  std::string_view data;
  std::endian order = std::endian::native;
};

struct EndInflate {
  void operator()(z_stream* state) const { inflateEnd(state); }
};

/// The elements in `bytes`, which end with the last one. Throws Damaged where they do not.
std::vector<MatElement> mat_elements(std::string_view bytes, std::endian order) {
  constexpr std::size_t kHalf = 4;
  std::vector<MatElement> elements;
  for (Cursor cursor(bytes, order); !cursor.rest().empty();) {
    const auto first = cursor.number<std::uint32_t>();
    const bool is_small = first >> 16U != 0;  // up to four bytes, which are in the tag itself
    const std::size_t size = is_small ? first >> 16U : cursor.number<std::uint32_t>();
    const auto type = static_cast<MatType>(is_small ? first & 0xFFFFU : first);
    if (is_small && size > kHalf) throw Damaged{};
    elements.push_back({type, cursor.bytes(size), order});
    const std::size_t padding = (2 * kHalf - size % (2 * kHalf)) % (2 * kHalf);
    if (is_small) cursor.bytes(kHalf - size);
    if (!is_small && type != MatType::Compressed) cursor.bytes(std::min(padding, cursor.rest().size()));
  }
  return elements;
}

/// The numbers of an element, whatever their kind. Throws Damaged where it holds none, or half a number.
std::vector<double> mat_numbers(const MatElement& element) {
  static constexpr std::array kTypes{
      number_type<std::int8_t>(MatType::Int8),   number_type<std::uint8_t>(MatType::UInt8),
      number_type<std::int16_t>(MatType::Int16), number_type<std::uint16_t>(MatType::UInt16),
      number_type<std::int32_t>(MatType::Int32), number_type<std::uint32_t>(MatType::UInt32),
      number_type<float>(MatType::Single),       number_type<double>(MatType::Double),
      number_type<std::int64_t>(MatType::Int64), number_type<std::uint64_t>(MatType::UInt64)};
  const auto* const type = find_type(kTypes, element.type);
  if (type == nullptr || element.data.size() % type->bytes != 0) throw Damaged{};
  std::vector<double> values(element.data.size() / type->bytes);
  Cursor cursor(element.data, element.order);
  for (double& value : values) value = type->read(cursor);
  return values;
}

/// The bytes of a compressed element. Throws Damaged where their checksum is wrong,
/// Refusal where they are out of all proportion.
std::string inflated(std::string_view packed) {
  constexpr std::size_t kPiece = std::size_t{256} * 1024;
  z_stream stream{};
  if (inflateInit(&stream) != Z_OK) throw std::bad_alloc();
  const std::unique_ptr<z_stream, EndInflate> owner(&stream);
  // zlib does not write to its input.
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast,cppcoreguidelines-pro-type-reinterpret-cast)
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  std::string bytes;
  for (int status = Z_OK; status != Z_STREAM_END;) {
    const std::size_t before = bytes.size();
    bytes.resize(before + kPiece);
    char* const end = bytes.data() + before;
    stream.next_out =
        reinterpret_cast<Bytef*>(end);  // NOLINT(cppcoreguidelines-pro-type-reinterpret-cast): zlib's bytes
    stream.avail_out = static_cast<uInt>(kPiece);
    status = inflate(&stream, Z_NO_FLUSH);
    bytes.resize(before + kPiece - stream.avail_out);
    if (status != Z_OK && status != Z_STREAM_END) throw Damaged{};
    if (is_bomb(bytes.size(), packed.size())) {
      throw Refusal(
          {"container_too_large", "the .mat file decompresses to far more than a recording; save a part of it"});
    }
  }
  return bytes;
}

constexpr std::size_t kHeaderBytes = 128;

/// Classes of arrays, those of numbers in a row; what else there is holds no numbers or has parts of its own.
constexpr std::uint32_t kStruct = 2;
constexpr std::uint32_t kFirstOfNumbers = 6;
constexpr std::uint32_t kLastOfNumbers = 15;

/// An array as the file describes it, and the parts that follow it.
struct MatArray {
  std::uint32_t kind = 0;  ///< class
  bool is_complex = false;
  std::string name;
  std::uint64_t rows = 0;
  std::uint64_t columns = 0;
  std::vector<MatElement> parts;
};

/// Numbers that describe an array; the format demands integers of 32 bits.
std::vector<double> integers_of(const MatElement& element) {
  if (element.type != MatType::Int32 && element.type != MatType::UInt32) throw Damaged{};
  return mat_numbers(element);
}

/// A name; MATLAB's have 63 characters at most.
std::string name_in(const MatElement& element) {
  constexpr std::size_t kLongestName = 200;
  return std::string(element.data.substr(0, std::min(element.data.find('\0'), kLongestName)));
}

/// Returns an array, or nothing for an array of another class, with more than two dimensions, or without numbers.
std::optional<MatArray> read_array(const MatElement& matrix) {
  constexpr double kMost = 1024.0 * 1024 * 1024 * 1024;  // above it products of extents may overflow
  constexpr std::uint32_t kComplex = 0x800;
  const auto parts = mat_elements(matrix.data, matrix.order);
  if (parts.empty()) return std::nullopt;  // what an empty field of a structure is
  const auto flags = integers_of(parts.front());
  if (flags.empty()) throw Damaged{};
  const auto first = static_cast<std::uint32_t>(flags.front());
  MatArray array{first & 0xFFU, (first & kComplex) != 0, {}, 0, 0, {}};
  if (array.kind != kStruct && (array.kind < kFirstOfNumbers || array.kind > kLastOfNumbers)) return std::nullopt;
  if (parts.size() < 4) throw Damaged{};
  const auto extents = integers_of(parts[1]);
  if (extents.size() != 2 || extents[0] < 1 || extents[1] < 1 || extents[0] * extents[1] > kMost) return std::nullopt;
  array.rows = static_cast<std::uint64_t>(extents[0]);
  array.columns = static_cast<std::uint64_t>(extents[1]);
  array.name = name_in(parts[2]);
  array.parts.assign(parts.begin() + 3, parts.end());
  return array;
}

/// The fields of a structure that is no array of structures, by their names in it.
std::vector<MatArray> fields_of(const MatArray& array) {
  std::vector<MatArray> fields;
  if (array.rows * array.columns != 1 || array.parts.size() < 2) return fields;
  const auto lengths = integers_of(array.parts[0]);
  if (lengths.size() != 1 || lengths[0] < 1) throw Damaged{};
  const auto length = static_cast<std::size_t>(lengths[0]);
  const std::string_view names = array.parts[1].data;
  if (names.size() / length + 2 != array.parts.size()) throw Damaged{};
  for (std::size_t i = 2; i < array.parts.size(); ++i) {
    if (array.parts[i].type != MatType::Matrix) throw Damaged{};
    auto field = read_array(array.parts[i]);
    if (!field) continue;
    field->name = name_in({MatType::Int8, names.substr((i - 2) * length, length)});
    fields.push_back(*std::move(field));
  }
  return fields;
}

/// A function that receives an array of real numbers; `group` is the structure that contains it, or empty.
using Take = std::function<void(const MatArray& array, const std::string& group)>;

void take_if_numbers(const MatArray& array, const std::string& group, const Take& take) {
  if (array.kind != kStruct && !array.is_complex && !array.name.empty()) take(array, group);
}

/// All arrays of real numbers in the file, in their order; the bytes of one variable at a time.
void visit_arrays(std::string_view file, const Take& take) {
  if (file.size() < kHeaderBytes) throw Damaged{};
  const std::string_view mark = file.substr(kHeaderBytes - 2, 2);  // the number 0x4D49, written as any other
  if (mark != "IM" && mark != "MI") throw Damaged{};
  const auto order = mark == "IM" ? std::endian::little : std::endian::big;
  for (const MatElement& stored : mat_elements(file.substr(kHeaderBytes), order)) {
    const bool is_packed = stored.type == MatType::Compressed;
    const std::string unpacked = is_packed ? inflated(stored.data) : std::string();
    for (const MatElement& element : is_packed ? mat_elements(unpacked, order) : std::vector{stored}) {
      if (element.type != MatType::Matrix) continue;
      const auto array = read_array(element);
      if (!array) continue;
      take_if_numbers(*array, "", take);
      if (array->kind != kStruct) continue;
      for (const MatArray& field : fields_of(*array)) take_if_numbers(field, array->name, take);
    }
  }
}

std::string full_name(const MatArray& array, const std::string& group) {
  return group.empty() ? array.name : group + "." + array.name;
}

std::vector<ArrayShape> arrays_in(std::string_view file) {
  std::vector<ArrayShape> arrays;
  visit_arrays(file, [&](const MatArray& array, const std::string& group) {
    // Column by column in the file: rows and columns change places.
    arrays.push_back({full_name(array, group), group, array.columns, array.rows, {}});
  });
  return arrays;
}

NumberTable table_of(std::string_view file, const TableShape& shape) {
  std::set<std::string> left;
  for (const ArrayShape& array : shape.arrays) left.insert(array.name);
  NumberTable table;
  visit_arrays(file, [&](const MatArray& array, const std::string& group) {
    const std::string name = full_name(array, group);
    if (left.erase(name) == 0) return;
    const auto values = mat_numbers(array.parts.front());
    if (values.size() != array.rows * array.columns) throw Damaged{};
    add_columns(table, {name, group, array.columns, array.rows, {}}, values, array.name);
  });
  return table;
}

/// Returns the value of `work()`. Throws Refusal if the file is damaged.
template <class Work>
auto refusing_damage(const Work& work) {
  try {
    return work();
  } catch (const Damaged&) {
    throw Refusal({"damaged_container", "the .mat file is damaged or cut off; save it again"});
  }
}

}  // namespace

ArrayFile open_mat_arrays(std::string_view file) {
  const auto arrays = std::make_shared<const std::vector<ArrayShape>>(refusing_damage([&] { return arrays_in(file); }));
  const auto read = [=](const std::optional<std::string>& variable) {
    return refusing_damage([&]() -> ReadTable {
      const TableShape shape = choose_table(*arrays, variable, file.size());
      return {table_of(file, shape), shape.name};
    });
  };
  return {read, [=] { return recordable_tables(*arrays, file.size()); }};
}

}  // namespace slipfit::reading
