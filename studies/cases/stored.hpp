#pragma once

/// @file
/// How a value of a record is called in the files.
///
/// A record lists its values once, `Record::stored(record, visit)`, which calls `visit(as, value)` for each; whoever
/// writes, reads or compares records goes through this list.

#include <string>
#include <type_traits>

namespace acstudy {

struct Stored {
  const char* name;
  const char* group = "";    ///< "work": JSON has an object of this name that holds `name`, HDF5 a column "work_<name>"
  bool in_json = true;       ///< false: JSON leaves it out, because it says nothing in this record
  bool timed = false;        ///< differs from run to run; all else is the same, to the last bit
  const char* in_hdf5 = "";  ///< how HDF5 calls it, where that is another name

  std::string column() const { return *in_hdf5 != '\0' ? in_hdf5 : flat(); }
  /// Its name without groups.
  std::string flat() const { return *group == '\0' ? name : std::string(group) + "_" + name; }
};

/// An array, which is for HDF5 alone.
template <class T>
inline constexpr bool is_field = !std::is_arithmetic_v<T> && !std::is_same_v<std::remove_const_t<T>, std::string>;

}  // namespace acstudy
