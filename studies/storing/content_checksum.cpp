#include "studies/storing/content_checksum.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "studies/cases/checksum.hpp"
#include "studies/storing/h5.hpp"

namespace acstudy {

namespace {

/// As what values of a stored type are read: what is damaged may be the description of the type.
hid_t type_in_memory(hid_t stored) {
  switch (H5Tget_class(stored)) {
    case H5T_FLOAT:
      return H5T_NATIVE_DOUBLE;
    case H5T_INTEGER:
      return H5T_NATIVE_INT64;
    default:
      return stored;
  }
}

/// Of values: what class they are of, and their bytes.
template <class Read>
std::uint64_t values_checksum(hid_t stored, hssize_t count, Read&& read, std::uint64_t sum) {
  constexpr std::size_t most = std::size_t{1} << 30;  // more than a text or a column of numbers has for each value
  const hid_t type = type_in_memory(stored);
  const std::size_t size = H5Tget_size(type);
  if (count < 0 || H5Tis_variable_str(type) > 0 || size > most || static_cast<std::size_t>(count) > most / (size + 1)) {
    throw StoreError("HDF5 could not read a value");
  }
  std::string bytes(size * static_cast<std::size_t>(count), '\0');
  if (!bytes.empty()) h5::check(read(bytes.data()), "read a value");
  return checksum(bytes, checksum(std::to_string(H5Tget_class(type)) + "|" + std::to_string(size), sum));
}

std::uint64_t column_checksum(hid_t group, const std::string& name, std::uint64_t sum) {
  const h5::Handle data(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, "open column " + name);
  const h5::Handle space(H5Dget_space(data), H5Sclose, "read the shape of " + name);
  const h5::Handle type(H5Dget_type(data), H5Tclose, "read the type of " + name);
  const hssize_t size = H5Sget_simple_extent_npoints(space);
  return values_checksum(
      type, h5::has_room(data, size) ? size : -1,
      [&](char* to) { return H5Dread(data, type_in_memory(type), H5S_ALL, H5S_ALL, H5P_DEFAULT, to); }, sum);
}

std::uint64_t group_checksum(hid_t group, std::uint64_t sum) {
  sum = attributes_checksum(group, sum);
  for (const std::string& name : h5::group_names(group)) {
    const h5::Handle object(H5Oopen(group, name.c_str(), H5P_DEFAULT), H5Oclose, "open " + name);
    sum = checksum(name, sum);
    sum = H5Iget_type(object) == H5I_GROUP ? group_checksum(object, sum) : column_checksum(group, name, sum);
  }
  return sum;
}

}  // namespace

std::uint64_t attributes_checksum(hid_t object, std::uint64_t sum) {
  std::vector<std::string> names = h5::attribute_names(object);
  std::sort(names.begin(), names.end());
  for (const std::string& name : names) {
    if (name == "checksum") continue;
    const h5::Handle attribute(H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, "open attribute " + name);
    const h5::Handle space(H5Aget_space(attribute), H5Sclose, "read the shape of " + name);
    const h5::Handle type(H5Aget_type(attribute), H5Tclose, "read the type of " + name);
    sum = values_checksum(
        type, H5Sget_simple_extent_npoints(space),
        [&](char* to) { return H5Aread(attribute, type_in_memory(type), to); }, checksum(name, sum));
  }
  return sum;
}

std::int64_t content_checksum(hid_t group) { return static_cast<std::int64_t>(group_checksum(group, checksum({}))); }

}  // namespace acstudy
