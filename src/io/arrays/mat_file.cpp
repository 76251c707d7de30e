#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <new>
#include <set>
#include <string_view>
#include <utility>

#include "io/arrays/tables.hpp"
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

enum class MatOrder { AsHere, Swapped };  ///< of the bytes of a number

struct MatElement {
  MatType type{};
  std::string_view data;
  MatOrder order = MatOrder::AsHere;
};

[[noreturn]] void refuse_damaged_mat() {
  throw Refusal({"damaged_container", "the .mat file is damaged or cut off; save it again"});
}

template <class Number>
Number number_at(const char* place, MatOrder order) {
  std::array<char, sizeof(Number)> bytes{};
  std::memcpy(bytes.data(), place, bytes.size());
  if (order == MatOrder::Swapped) std::ranges::reverse(bytes);
  Number number{};
  std::memcpy(&number, bytes.data(), bytes.size());
  return number;
}

template <class Number>
std::vector<double> converted(const MatElement& element) {
  if (element.data.size() % sizeof(Number) != 0) refuse_damaged_mat();
  std::vector<double> values(element.data.size() / sizeof(Number));
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = static_cast<double>(number_at<Number>(element.data.data() + i * sizeof(Number), element.order));
  }
  return values;
}

struct EndInflate {
  void operator()(z_stream* state) const { inflateEnd(state); }
};

/// The elements in `bytes`, which end with the last one. Throws Refusal where they do not.
std::vector<MatElement> mat_elements(std::string_view bytes, MatOrder order) {
  constexpr std::size_t kTag = 8;
  constexpr std::size_t kHalf = 4;
  std::vector<MatElement> elements;
  while (!bytes.empty()) {
    if (bytes.size() < kTag) refuse_damaged_mat();
    const auto first = number_at<std::uint32_t>(bytes.data(), order);
    const bool is_small = first >> 16U != 0;  // up to four bytes, which are in the tag itself
    const std::size_t size = is_small ? first >> 16U : number_at<std::uint32_t>(bytes.data() + kHalf, order);
    const auto type = static_cast<MatType>(is_small ? first & 0xFFFFU : first);
    const std::size_t begin = is_small ? kHalf : kTag;
    if (size > (is_small ? kHalf : bytes.size() - kTag)) refuse_damaged_mat();
    elements.push_back({type, bytes.substr(begin, size), order});
    const std::size_t padding = type == MatType::Compressed ? 0 : (kTag - size % kTag) % kTag;
    bytes.remove_prefix(is_small ? kTag : std::min(begin + size + padding, bytes.size()));
  }
  return elements;
}

/// The numbers of an element, whatever their kind. Throws Refusal where it holds none, or half a number.
std::vector<double> mat_numbers(const MatElement& element) {
  using Convert = std::vector<double>(const MatElement&);
  constexpr std::array kConversions =
      std::to_array<std::pair<MatType, Convert*>>({{MatType::Int8, converted<std::int8_t>},
                                                   {MatType::UInt8, converted<std::uint8_t>},
                                                   {MatType::Int16, converted<std::int16_t>},
                                                   {MatType::UInt16, converted<std::uint16_t>},
                                                   {MatType::Int32, converted<std::int32_t>},
                                                   {MatType::UInt32, converted<std::uint32_t>},
                                                   {MatType::Single, converted<float>},
                                                   {MatType::Double, converted<double>},
                                                   {MatType::Int64, converted<std::int64_t>},
                                                   {MatType::UInt64, converted<std::uint64_t>}});
  const auto* const found =
      std::ranges::find_if(kConversions, [&](const auto& conversion) { return conversion.first == element.type; });
  if (found == kConversions.end()) refuse_damaged_mat();
  return found->second(element);
}

/// The bytes of a compressed element. Throws Refusal where their checksum is wrong, or they are out of all proportion.
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
    if (status != Z_OK && status != Z_STREAM_END) refuse_damaged_mat();
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

/// An array as the file describes it, and its parts behind that.
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
  if (element.type != MatType::Int32 && element.type != MatType::UInt32) refuse_damaged_mat();
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
  if (flags.empty()) refuse_damaged_mat();
  const auto first = static_cast<std::uint32_t>(flags.front());
  MatArray array{first & 0xFFU, (first & kComplex) != 0, {}, 0, 0, {}};
  if (array.kind != kStruct && (array.kind < kFirstOfNumbers || array.kind > kLastOfNumbers)) return std::nullopt;
  if (parts.size() < 4) refuse_damaged_mat();
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
  if (lengths.size() != 1 || lengths[0] < 1) refuse_damaged_mat();
  const auto length = static_cast<std::size_t>(lengths[0]);
  const std::string_view names = array.parts[1].data;
  if (names.size() / length + 2 != array.parts.size()) refuse_damaged_mat();
  for (std::size_t i = 2; i < array.parts.size(); ++i) {
    if (array.parts[i].type != MatType::Matrix) refuse_damaged_mat();
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
  if (file.size() < kHeaderBytes) refuse_damaged_mat();
  const std::string_view mark = file.substr(kHeaderBytes - 2, 2);  // the number 0x4D49, written as any other
  if (mark != "IM" && mark != "MI") refuse_damaged_mat();
  const bool is_little = mark == "IM";
  const auto order = is_little == (std::endian::native == std::endian::little) ? MatOrder::AsHere : MatOrder::Swapped;
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
    if (values.size() != array.rows * array.columns) refuse_damaged_mat();
    add_columns(table, {name, group, array.columns, array.rows, {}}, values, array.name);
  });
  return table;
}

ReadTable read_mat(std::string_view file, const std::optional<std::string>& variable) {
  const TableShape shape = choose_table(arrays_in(file), variable, file.size());
  return {table_of(file, shape), shape.name};
}

}  // namespace

const ArrayFormat kMat{read_mat, [](std::string_view file) { return recordable_tables(arrays_in(file), file.size()); }};

}  // namespace slipfit::reading
