#include <matio.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "tables.hpp"

using slipfit::reading::NumberTable;

namespace {

struct CloseMat {
  void operator()(mat_t* file) const { Mat_Close(file); }
};
struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using MatFile = std::unique_ptr<mat_t, CloseMat>;
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

bool is_number(const matvar_t& variable) {
  return variable.class_type >= MAT_C_DOUBLE && variable.class_type <= MAT_C_UINT64 && variable.isComplex == 0 &&
         variable.rank == 2;
}

/// Column by column in the file: rows and columns change places.
void add_shape(const matvar_t& variable, const std::string& group, std::vector<ArrayShape>& arrays) {
  if (!is_number(variable) || variable.name == nullptr) return;
  constexpr std::size_t kMost = std::size_t{1} << 40U;  // lest products overflow
  const std::size_t rows = variable.dims[0];
  const std::size_t columns = variable.dims[1];
  if (rows == 0 || columns == 0 || rows > kMost || columns > kMost / rows) return;
  const std::string name = group.empty() ? variable.name : group + "." + variable.name;
  arrays.push_back({name, group, columns, rows, {}});
}

/// The fields of a structure that is no array.
std::vector<matvar_t*> fields_of(matvar_t& variable) {
  std::vector<matvar_t*> fields;
  if (variable.class_type != MAT_C_STRUCT || variable.rank != 2 || variable.dims[0] * variable.dims[1] != 1)
    return fields;
  for (unsigned i = 0; i < Mat_VarGetNumberOfFields(&variable); ++i) {
    matvar_t* const field = Mat_VarGetStructFieldByIndex(&variable, i, 0);
    if (field != nullptr) fields.push_back(field);
  }
  return fields;
}

template <class Number>
std::vector<double> converted(const void* data, std::size_t count) {
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    Number number{};
    std::memcpy(&number, static_cast<const char*>(data) + i * sizeof(Number), sizeof(Number));
    values[i] = static_cast<double>(number);
  }
  return values;
}

std::vector<double> values_of(const matvar_t& variable) {
  const std::size_t count = variable.dims[0] * variable.dims[1];
  const auto damaged = [] { return Refusal("damaged_container the .mat file is damaged; save it again"); };
  if (variable.data == nullptr || variable.nbytes < count * static_cast<std::size_t>(variable.data_size))
    throw damaged();
  switch (variable.data_type) {
    case MAT_T_DOUBLE:
      return converted<double>(variable.data, count);
    case MAT_T_SINGLE:
      return converted<float>(variable.data, count);
    case MAT_T_INT8:
      return converted<std::int8_t>(variable.data, count);
    case MAT_T_UINT8:
      return converted<std::uint8_t>(variable.data, count);
    case MAT_T_INT16:
      return converted<std::int16_t>(variable.data, count);
    case MAT_T_UINT16:
      return converted<std::uint16_t>(variable.data, count);
    case MAT_T_INT32:
      return converted<std::int32_t>(variable.data, count);
    case MAT_T_UINT32:
      return converted<std::uint32_t>(variable.data, count);
    case MAT_T_INT64:
      return converted<std::int64_t>(variable.data, count);
    case MAT_T_UINT64:
      return converted<std::uint64_t>(variable.data, count);
    default:
      throw damaged();
  }
}

void add_array(mat_t* file, const ArrayShape& shape, NumberTable& table) {
  const std::string own = shape.group.empty() ? shape.name : shape.group;
  const Variable variable(Mat_VarRead(file, own.c_str()));
  if (!variable) throw Refusal("damaged_container '" + own + "' in the .mat file is damaged; save it again");
  if (shape.group.empty()) return add_columns(table, shape, values_of(*variable), shape.name);
  for (const matvar_t* const field : fields_of(*variable)) {
    if (field->name != nullptr && shape.name == shape.group + "." + field->name) {
      add_columns(table, shape, values_of(*field), field->name);
    }
  }
}

}  // namespace

NumberTable read_mat(const std::string& file, std::uint64_t size, const std::optional<std::string>& variable,
                     std::string& chosen) {
  check_mat(file, size);
  const MatFile opened(Mat_Open(file.c_str(), MAT_ACC_RDONLY));
  if (!opened) throw Refusal("damaged_container the .mat file is damaged or cut off; save it again");
  std::vector<ArrayShape> arrays;
  while (const Variable info{Mat_VarReadNextInfo(opened.get())}) {
    add_shape(*info, "", arrays);
    for (const matvar_t* const field : fields_of(*info)) add_shape(*field, info->name, arrays);
  }
  const TableShape shape = choose_table(arrays, variable, size);
  chosen = shape.name;
  NumberTable table;
  for (const ArrayShape& array : shape.arrays) add_array(opened.get(), array, table);
  return table;
}
