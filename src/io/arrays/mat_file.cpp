#include <bit>
#include <functional>
#include <set>

#include "io/arrays/mat_elements.hpp"
#include "io/arrays/tables.hpp"

namespace slipfit::reading {
namespace {

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

std::string text_of_element(const MatElement& element) {
  return std::string(element.data.substr(0, element.data.find('\0')));
}

/// Empty for an array of another class, or of more than two extents, or none of numbers.
std::optional<MatArray> read_array(const MatElement& matrix) {
  constexpr double kMost = 1024.0 * 1024 * 1024 * 1024;  // lest products overflow
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
  array.name = text_of_element(parts[2]);
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
    field->name = text_of_element({MatType::Int8, names.substr((i - 2) * length, length)});
    fields.push_back(*std::move(field));
  }
  return fields;
}

/// Of an array of real numbers; `group` is the structure that holds it, or empty.
using Take = std::function<void(const MatArray& array, const std::string& group)>;

void take_if_numbers(const MatArray& array, const std::string& group, const Take& take) {
  if (array.kind != kStruct && !array.is_complex && !array.name.empty()) take(array, group);
}

/// All arrays of real numbers in the file, in the order in which they stand there; the bytes of one variable at a time.
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

}  // namespace

// Of one type with read_hdf5, which gives the bytes away. NOLINTNEXTLINE(performance-unnecessary-value-param)
NumberTable read_mat(std::string file, const std::optional<std::string>& variable, std::string& chosen) {
  std::vector<ArrayShape> arrays;
  visit_arrays(file, [&](const MatArray& array, const std::string& group) {
    // Column by column in the file: rows and columns change places.
    arrays.push_back({full_name(array, group), group, array.columns, array.rows, {}});
  });
  const TableShape shape = choose_table(arrays, variable, file.size());
  chosen = shape.name;
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

}  // namespace slipfit::reading
