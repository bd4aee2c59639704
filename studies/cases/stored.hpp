#pragma once

/// @file
/// How a value of a record is called in the files.
///
/// A record lists its values once, `Record::stored(record, visit)`, which calls `visit(as, value)` for each; whoever
/// writes, reads or compares records goes through this list.

#include <string>

namespace acstudy {

struct Stored {
  const char* name;
  const char* group = "";  ///< "work": JSON has an object of this name that holds `name`, HDF5 a column "work_<name>"
  bool in_json = true;     ///< false: JSON leaves it out, because it says nothing in this record
  bool timed = false;      ///< differs from run to run; all else is the same, to the last bit

  std::string column() const { return *group == '\0' ? name : std::string(group) + "_" + name; }
};

}  // namespace acstudy
