#pragma once

/// @file
/// The little of HDF5 that the store uses: handles that close themselves, text and columns.

#include <hdf5.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "mms/points.hpp"
#include "studies/storing/store_error.hpp"

namespace acstudy::h5 {

/// An HDF5 identifier, closed at the end of its life. @throws StoreError from the constructor if HDF5 reported a
/// failure.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const std::string& what) : id_(id), close_(close) {
    if (id < 0) throw StoreError("HDF5 could not " + what);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

inline void check(herr_t status, const std::string& what) {
  if (status < 0) throw StoreError("HDF5 could not " + what);
}

template <class T>
hid_t native() {
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  static_assert(std::is_same_v<T, double> || std::is_same_v<T, std::int64_t>);
  return H5T_NATIVE_INT64;
}

/// A file that HDF5 builds in memory, because a disk that is full leaves the library's own file driver in a state in
/// which it can only crash.
inline Handle create_file_in_memory() {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "make file access properties");
  check(H5Pset_fapl_core(access, std::size_t{1} << 20, false), "choose the memory driver");
  // HDF5 would read a file of this name, if there were one.
  return {H5Fcreate("/dev/null/none", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, "create a file in memory"};
}

/// A file in memory as bytes.
inline std::vector<char> image(hid_t file) {
  check(H5Fflush(file, H5F_SCOPE_GLOBAL), "flush the file in memory");
  const ssize_t size = H5Fget_file_image(file, nullptr, 0);
  if (size < 0) throw StoreError("HDF5 could not give the file in memory");
  std::vector<char> bytes(static_cast<std::size_t>(size));
  if (H5Fget_file_image(file, bytes.data(), bytes.size()) != size) {
    throw StoreError("HDF5 could not give the file in memory");
  }
  return bytes;
}

/// The file that such bytes are of.
inline Handle open_image(std::span<const char> bytes) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "make file access properties");
  check(H5Pset_fapl_core(access, std::size_t{1} << 20, false), "choose the memory driver");
  // HDF5 makes a copy; that it does not take the bytes as constant is an oversight of its interface.
  check(H5Pset_file_image(access, const_cast<char*>(bytes.data()), bytes.size()), "take a file in memory");
  return {H5Fopen("image", H5F_ACC_RDONLY, access), H5Fclose, "open a file in memory"};
}

inline Handle create_group(hid_t parent, const std::string& name) {
  // Groups that know the order of what is in them have a newer form, which takes less room and time.
  static const hid_t newer = [] {
    const hid_t properties = H5Pcreate(H5P_GROUP_CREATE);
    check(H5Pset_link_creation_order(properties, H5P_CRT_ORDER_TRACKED), "make groups of the newer form");
    return properties;
  }();
  return {H5Gcreate2(parent, name.c_str(), H5P_DEFAULT, newer, H5P_DEFAULT), H5Gclose, "create group " + name};
}
inline Handle open_group(hid_t parent, const std::string& name) {
  return {H5Gopen2(parent, name.c_str(), H5P_DEFAULT), H5Gclose, "open group " + name};
}

inline void write_text(hid_t object, const std::string& name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "make a text type");
  check(H5Tset_size(type, text.size() + 1), "size a text");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "set UTF-8");
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "make a scalar");
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "create attribute " + name);
  check(H5Awrite(attribute, type, text.c_str()), "write attribute " + name);
}

inline std::string read_text(hid_t object, const std::string& name) {
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, "open attribute " + name);
  const Handle type(H5Aget_type(attribute), H5Tclose, "read the type of " + name);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) {
    throw StoreError("HDF5 could not read attribute " + name + " as a text of fixed length");
  }
  std::string text(H5Tget_size(type), '\0');
  check(H5Aread(attribute, type, text.data()), "read attribute " + name);
  text.resize(std::char_traits<char>::length(text.c_str()));
  return text;
}

template <class T>
void write_number(hid_t object, const std::string& name, T value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "make a scalar");
  const Handle attribute(H5Acreate2(object, name.c_str(), native<T>(), space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "create attribute " + name);
  check(H5Awrite(attribute, native<T>(), &value), "write attribute " + name);
}

template <class T = double>
T read_number(hid_t object, const std::string& name) {
  const Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, "open attribute " + name);
  T value{};
  check(H5Aread(attribute, native<T>(), &value), "read attribute " + name);
  return value;
}

/// Short columns stand where they are described, which saves room and time.
inline hid_t column_properties(std::size_t bytes) {
  static const hid_t compact = [] {
    const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
    check(H5Pset_layout(properties, H5D_COMPACT), "make columns compact");
    return properties;
  }();
  constexpr std::size_t most = 32'000;
  return bytes <= most ? compact : H5P_DEFAULT;
}

/// @param width  how many values an entry of the column has: its shape is [n], or [n, width]
template <class T>
void write_column(hid_t group, const std::string& name, std::span<const T> values, std::size_t width = 1) {
  const hsize_t size = values.size(), shape[] = {size / width, width};
  const Handle space(H5Screate_simple(width == 1 ? 1 : 2, shape, nullptr), H5Sclose, "make a column");
  const Handle data(H5Dcreate2(group, name.c_str(), native<T>(), space, H5P_DEFAULT,
                               column_properties(size * sizeof(T)), H5P_DEFAULT),
                    H5Dclose, "create column " + name);
  if (size > 0)
    check(H5Dwrite(data, native<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "write column " + name);
}

/// Whether the file has so many values at all, before memory is taken for them.
inline bool has_room(hid_t data, hssize_t size) {
  return size >= 0 && static_cast<hsize_t>(size) <= H5Dget_storage_size(data);
}

template <class T>
std::vector<T> read_column(hid_t group, const std::string& name) {
  const Handle data(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, "open column " + name);
  const Handle space(H5Dget_space(data), H5Sclose, "read the shape of " + name);
  const hssize_t size = H5Sget_simple_extent_npoints(space);
  if (!has_room(data, size)) throw StoreError("HDF5 could not read the shape of " + name);
  std::vector<T> values(static_cast<std::size_t>(size));
  if (size > 0) check(H5Dread(data, native<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), "read column " + name);
  return values;
}

/// Texts as a column, each as wide as the longest.
inline void write_text_column(hid_t group, const std::string& name, const std::vector<std::string>& texts) {
  std::size_t width = 1;
  for (const std::string& text : texts) width = std::max(width, text.size() + 1);
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "make a text type");
  check(H5Tset_size(type, width), "size a text");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "set UTF-8");
  std::string all(width * texts.size(), '\0');
  for (std::size_t i = 0; i < texts.size(); ++i) texts[i].copy(all.data() + i * width, texts[i].size());
  const hsize_t size = texts.size();
  const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose, "make a column");
  const Handle data(H5Dcreate2(group, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
                    "create column " + name);
  if (size > 0) check(H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()), "write column " + name);
}

inline std::vector<std::string> read_text_column(hid_t group, const std::string& name) {
  const Handle data(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, "open column " + name);
  const Handle space(H5Dget_space(data), H5Sclose, "read the shape of " + name);
  const Handle type(H5Dget_type(data), H5Tclose, "read the type of " + name);
  const hssize_t size = H5Sget_simple_extent_npoints(space);
  const std::size_t width = H5Tget_size(type);
  if (!has_room(data, size) || H5Tget_class(type) != H5T_STRING)
    throw StoreError("HDF5 could not read the texts of " + name);
  std::string all(width * static_cast<std::size_t>(size), '\0');
  if (size > 0) check(H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, all.data()), "read column " + name);
  std::vector<std::string> texts;
  for (std::size_t at = 0; at < all.size(); at += width) {
    texts.emplace_back(all.data() + at, strnlen(all.data() + at, width));
  }
  return texts;
}

/// The width of a column.
inline std::size_t width_of_column(hid_t group, const std::string& name) {
  const Handle data(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, "open column " + name);
  const Handle space(H5Dget_space(data), H5Sclose, "read the shape of " + name);
  hsize_t shape[H5S_MAX_RANK] = {};
  const int rank = H5Sget_simple_extent_dims(space, shape, nullptr);
  if (rank < 0 || rank > 2) throw StoreError("HDF5 could not read the shape of " + name);
  return rank == 2 ? static_cast<std::size_t>(shape[1]) : 1;
}

/// Points as a column [N] on a line, [N, d] beyond.
inline void write_points(hid_t group, const std::string& name, const PointArray& points) {
  std::vector<double> rows;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < points.dimension; ++k) rows.push_back(Points(points)[k][i]);
  }
  write_column<double>(group, name, rows, points.dimension);
}

inline PointArray read_points(hid_t group, const std::string& name) {
  const std::vector<double> rows = read_column<double>(group, name);
  PointArray points;
  points.resize(rows.size() / width_of_column(group, name), width_of_column(group, name));
  for (std::size_t i = 0; i < rows.size(); ++i) points(i / points.dimension, i % points.dimension) = rows[i];
  return points;
}

/// A number or a text as an attribute, an array as a column.
template <class T>
void write(hid_t object, const std::string& name, const T& value) {
  if constexpr (std::is_same_v<T, std::string>) {
    write_text(object, name, value);
  } else if constexpr (std::is_arithmetic_v<T>) {
    write_number(object, name, value);
  } else if constexpr (std::is_same_v<T, PointArray>) {
    write_points(object, name, value);
  } else {
    write_column<typename T::value_type>(object, name, value);
  }
}

/// What `write` has written. A value that is absent, as in files of older versions, stays as it is.
template <class T>
void read(hid_t object, const std::string& name, T& value) {
  if constexpr (std::is_same_v<T, std::string>) {
    if (H5Aexists(object, name.c_str()) > 0) value = read_text(object, name);
  } else if constexpr (std::is_arithmetic_v<T>) {
    if (H5Aexists(object, name.c_str()) > 0) value = read_number<T>(object, name);
  } else if (H5Lexists(object, name.c_str(), H5P_DEFAULT) > 0) {
    if constexpr (std::is_same_v<T, PointArray>) {
      value = read_points(object, name);
    } else {
      value = read_column<typename T::value_type>(object, name);
    }
  }
}

/// Names of the groups directly below `group`.
inline std::vector<std::string> group_names(hid_t group) {
  H5G_info_t info;
  check(H5Gget_info(group, &info), "list a group");
  std::vector<std::string> names;
  for (hsize_t i = 0; i < info.nlinks; ++i) {
    const ssize_t length = H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, nullptr, 0, H5P_DEFAULT);
    if (length < 0) throw StoreError("HDF5 could not list a group");
    std::string name(static_cast<std::size_t>(length) + 1, '\0');
    H5Lget_name_by_idx(group, ".", H5_INDEX_NAME, H5_ITER_INC, i, name.data(), name.size(), H5P_DEFAULT);
    name.pop_back();
    names.push_back(name);
  }
  return names;
}

inline std::vector<std::string> attribute_names(hid_t object) {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5A_info_t*, void* to) -> herr_t {
    static_cast<std::vector<std::string>*>(to)->push_back(name);
    return 0;
  };
  check(H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names), "list attributes");
  return names;
}

}  // namespace acstudy::h5
