#include <hdf5.h>

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "io/arrays/tables.hpp"

namespace slipfit::reading {
namespace {

/// A handle of HDF5 and what closes it.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id_ < 0) throw Refusal({"damaged_container", "the HDF5 file is damaged; copy or export it again"});
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

bool is_number(hid_t type) {
  const H5T_class_t kind = H5Tget_class(type);
  return kind == H5T_INTEGER || kind == H5T_FLOAT;
}

std::vector<std::string> number_fields(hid_t type) {
  std::vector<std::string> fields;
  for (int i = 0; i < H5Tget_nmembers(type); ++i) {
    const Handle member(H5Tget_member_type(type, static_cast<unsigned>(i)), H5Tclose);
    char* const name = H5Tget_member_name(type, static_cast<unsigned>(i));
    if (is_number(member) && name != nullptr) fields.emplace_back(name);
    H5free_memory(name);
  }
  return fields;
}

/// A chunk is unpacked as a whole.
bool has_huge_chunks(hid_t dataset, hid_t type) {
  constexpr hsize_t kMostChunkBytes = hsize_t{256} << 20U;
  const Handle settings(H5Dget_create_plist(dataset), H5Pclose);
  if (H5Pget_layout(settings) != H5D_CHUNKED) return false;
  std::array<hsize_t, H5S_MAX_RANK> extents{};
  const int rank = H5Pget_chunk(settings, static_cast<int>(extents.size()), extents.data());
  auto bytes = static_cast<double>(H5Tget_size(type));
  for (int i = 0; i < rank; ++i) bytes *= static_cast<double>(extents.at(static_cast<std::size_t>(i)));
  return bytes > static_cast<double>(kMostChunkBytes);
}

/// Returns true if reading the numbers, or even the extents, would open another file. H5Dopen2 itself opens none.
bool is_in_other_file(hid_t dataset) {
  const Handle settings(H5Dget_create_plist(dataset), H5Pclose);
  return H5Pget_layout(settings) == H5D_VIRTUAL || H5Pget_external_count(settings) != 0;
}

/// The data in the file and its references to other files.
struct Contents {
  std::vector<ArrayShape> arrays;
  std::vector<std::string> in_other_files;  ///< paths of datasets and links
};

void add_dataset(hid_t file, const std::string& path, Contents& contents) {
  const Handle dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose);
  if (is_in_other_file(dataset)) return contents.in_other_files.push_back(path);
  const Handle space(H5Dget_space(dataset), H5Sclose);
  const Handle type(H5Dget_type(dataset), H5Tclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1 || rank > 2 || has_huge_chunks(dataset, type)) return;
  std::array<hsize_t, 2> extents{1, 1};
  H5Sget_simple_extent_dims(space, extents.data(), nullptr);
  ArrayShape shape{path, path.substr(0, path.rfind('/')), extents[0], extents[1], {}};
  if (shape.group.empty()) shape.group += '/';
  const bool is_table = H5Tget_class(type) == H5T_COMPOUND && rank == 1;
  if (is_table) shape.fields = number_fields(type);
  constexpr hsize_t kMost = hsize_t{1} << 40U;  // above it products of extents may overflow
  const bool is_sane = extents[0] > 0 && extents[1] > 0 && extents[0] < kMost && extents[1] < kMost / extents[0];
  if (is_sane && (is_table ? !shape.fields.empty() : is_number(type))) contents.arrays.push_back(shape);
}

constexpr std::size_t kMostPaths = 10000;
using Paths = std::vector<std::string>;

#if H5_VERSION_GE(1, 12, 0)  // which gave the description of an object another form
using ObjectInfo = H5O_info2_t;
#else
using ObjectInfo = H5O_info_t;
#endif

/// Calls `visit` with every object of a file, in the order in which they are stored.
template <class Visit>
void visit_objects(hid_t file, Visit visit, void* data) {
#if H5_VERSION_GE(1, 12, 0)
  H5Ovisit3(file, H5_INDEX_NAME, H5_ITER_NATIVE, visit, data, H5O_INFO_BASIC);
#else
  H5Ovisit2(file, H5_INDEX_NAME, H5_ITER_NATIVE, visit, data, H5O_INFO_BASIC);
#endif
}

herr_t note_dataset(hid_t, const char* name, const ObjectInfo* info, void* data) {
  auto* const datasets = static_cast<Paths*>(data);
  const bool is_of_MATLAB = name[0] == '#';  // what cells and objects refer to
  if (info->type == H5O_TYPE_DATASET && !is_of_MATLAB) datasets->push_back(std::string("/") + name);
  return datasets->size() < kMostPaths ? 0 : 1;
}

/// Links of other types than the library's own three are of a program that registers what they lead to.
herr_t note_outer_link(hid_t, const char* name, const H5L_info_t* info, void* data) {
  auto* const links = static_cast<Paths*>(data);
  if (info->type != H5L_TYPE_HARD && info->type != H5L_TYPE_SOFT) links->push_back(std::string("/") + name);
  return links->size() < kMostPaths ? 0 : 1;
}

std::string unit_of(hid_t dataset) {
  for (const char* const name : {"unit", "units", "Unit", "Units", "unit_string"}) {
    if (H5Aexists(dataset, name) <= 0) continue;
    const Handle attribute(H5Aopen(dataset, name, H5P_DEFAULT), H5Aclose);
    const Handle type(H5Aget_type(attribute), H5Tclose);
    const Handle space(H5Aget_space(attribute), H5Sclose);
    if (H5Tget_class(type) != H5T_STRING || H5Sget_simple_extent_npoints(space) != 1) continue;
    if (H5Tis_variable_str(type) > 0) {
      char* text = nullptr;
      if (H5Aread(attribute, type, static_cast<void*>(&text)) < 0 || text == nullptr) continue;
      std::string unit(text);
      H5free_memory(text);
      return unit;
    }
    std::string unit(H5Tget_size(type) + 1, '\0');
    if (unit.size() < 256 && H5Aread(attribute, type, unit.data()) >= 0) return unit.substr(0, unit.find('\0'));
  }
  return {};
}

std::vector<double> read_as(hid_t dataset, hid_t type, std::uint64_t count) {
  std::vector<double> values(static_cast<std::size_t>(count), std::numeric_limits<double>::quiet_NaN());
  if (H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) {
    throw Refusal(
        {"damaged_container",
         "the numbers in the HDF5 file are damaged or compressed by a filter that is not installed; export it again"});
  }
  return values;
}

void add_array(hid_t file, const ArrayShape& shape, NumberTable& table) {
  const Handle dataset(H5Dopen2(file, shape.name.c_str(), H5P_DEFAULT), H5Dclose);
  if (shape.fields.empty()) {
    const std::string unit = unit_of(dataset);
    const std::string name = shape.name.substr(shape.name.rfind('/') + 1);
    const auto values = read_as(dataset, H5T_NATIVE_DOUBLE, shape.length() * shape.width());
    return add_columns(table, shape, values, unit.empty() ? name : name + " [" + unit + "]");
  }
  for (const std::string& field : shape.fields) {
    const Handle type(H5Tcreate(H5T_COMPOUND, sizeof(double)), H5Tclose);
    H5Tinsert(type, field.c_str(), 0, H5T_NATIVE_DOUBLE);
    table.names.push_back(field);
    table.columns.push_back(read_as(dataset, type, shape.length()));
  }
}

/// The library resolves links in the path of a file that it opens itself; slipfit's has no path. The bytes are not
/// copied, which the library would do twice: they have to outlive the file, which is never written to.
hid_t open_in_memory(std::string_view file) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  constexpr std::size_t kIncrement = std::size_t{1} << 20U;
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast): the interface of HDF5
  auto* const bytes = const_cast<char*>(file.data());
  H5FD_file_image_callbacks_t uncopied{
      .image_malloc = [](std::size_t, H5FD_file_image_op_t, void* image) { return image; },
      .image_memcpy = [](void* to, const void*, std::size_t, H5FD_file_image_op_t, void*) { return to; },
      .image_realloc = [](void*, std::size_t, H5FD_file_image_op_t, void*) -> void* { return nullptr; },
      .image_free = [](void*, H5FD_file_image_op_t, void*) -> herr_t { return 0; },
      .udata_copy = [](void* image) { return image; },
      .udata_free = [](void*) -> herr_t { return 0; },
      .udata = bytes};
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access, kIncrement, false);
  H5Pset_file_image_callbacks(access, &uncopied);
  H5Pset_file_image(access, bytes, file.size());
  return H5Fopen("recording", H5F_ACC_RDONLY, access);
}

/// Returns true if `variable` names the dataset or its group.
bool is_wanted(const std::string& path, const std::string& variable) {
  return is_called(path, variable) || is_called(path.substr(0, path.rfind('/')), variable);
}

/// Returns the arrays of the file: all, or those that the variable names.
Contents contents_of(hid_t file, const std::optional<std::string>& variable) {
  Contents contents;
  Paths datasets;
  visit_objects(file, note_dataset, &datasets);
  H5Lvisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, note_outer_link, &contents.in_other_files);
  for (const std::string& path : datasets) {
    if (!variable || is_wanted(path, *variable)) add_dataset(file, path, contents);
  }
  return contents;
}

/// Other files are never read: whoever made the file would choose which ones, and neither digest nor --resume would
/// know of them. Without --variable nobody knows whether the table needs them.
void refuse_other_files(const Contents& contents, const std::optional<std::string>& variable) {
  for (const std::string& path : contents.in_other_files) {
    if (variable && !is_wanted(path, *variable)) continue;
    throw Refusal({"data_in_other_file", "the numbers of '" + path +
                                             "' are in another file (virtual, external or linked), which is not " +
                                             "opened; save all numbers in one file" +
                                             (variable ? "" : ", or choose with --variable a dataset of this file")});
  }
}

NumberTable table_of(hid_t file, const TableShape& shape) {
  NumberTable table;
  for (const ArrayShape& array : shape.arrays) add_array(file, array, table);
  return table;
}

/// An open file, and what it contains once all of that was asked for.
struct Opened {
  explicit Opened(std::string_view file) : handle(open_in_memory(file), H5Fclose) {}

  const Contents& all() {
    if (!contents) contents = contents_of(handle, std::nullopt);
    return *contents;
  }

  Handle handle;
  std::optional<Contents> contents;
};

}  // namespace

ArrayFile open_hdf5_arrays(std::string_view file) {
  const auto opened = std::make_shared<Opened>(file);
  const auto read = [=](const std::optional<std::string>& variable) -> ReadTable {
    // With a variable only what it names is opened: a file may hold hundreds of groups.
    const bool is_part = variable && !opened->contents;
    Contents contents = is_part ? contents_of(opened->handle, variable) : opened->all();
    refuse_other_files(contents, variable);
    if (is_part && contents.arrays.empty()) contents = opened->all();
    const TableShape shape = choose_table(contents.arrays, variable, file.size());
    return {table_of(opened->handle, shape), shape.name};
  };
  return {read, [=] { return recordable_tables(opened->all().arrays, file.size()); }};
}

}  // namespace slipfit::reading
