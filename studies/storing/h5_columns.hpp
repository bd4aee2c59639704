#pragma once

/// @file
/// Records as the columns of a group: one data set of each of their values, one entry of each record.

#include <map>
#include <string>
#include <vector>

#include "studies/storing/h5.hpp"

namespace acstudy::h5 {

/// Columns by name, real numbers and counts.
class Columns {
 public:
  std::vector<double>& of(const std::string& name, double) { return real_[name]; }
  std::vector<std::int64_t>& of(const std::string& name, std::int64_t) { return count_[name]; }

  void write(hid_t group) const {
    for (const auto& [name, values] : real_) write_column<double>(group, name, values);
    for (const auto& [name, values] : count_) write_column<std::int64_t>(group, name, values);
  }

 private:
  std::map<std::string, std::vector<double>> real_;
  std::map<std::string, std::vector<std::int64_t>> count_;
};

/// @param fields   fields(record, visit) calls visit(name, value) for each value of a record
/// @param example  a record, so that the columns are there even where no record is
template <class Record, class Fields>
void write_columns(hid_t group, const std::vector<Record>& records, const Record& example, Fields&& fields) {
  Columns columns;
  fields(example, [&](const std::string& name, auto value) { columns.of(name, value); });
  for (const Record& record : records) {
    fields(record, [&](const std::string& name, auto value) { columns.of(name, value).push_back(value); });
  }
  columns.write(group);
}

/// Gives records their values. A value whose column is absent, as in files of older versions, stays as it is.
/// @throws StoreError, std::out_of_range if a column is too short
template <class Record, class Fields>
void read_columns(hid_t group, std::vector<Record>& records, Fields&& fields) {
  Columns columns;
  for (std::size_t i = 0; i < records.size(); ++i) {
    fields(records[i], [&]<class T>(const std::string& name, T& value) {
      if (H5Lexists(group, name.c_str(), H5P_DEFAULT) <= 0) return;
      std::vector<T>& values = columns.of(name, T{});
      if (values.empty()) values = read_column<T>(group, name);
      value = values.at(i);
    });
  }
}

}  // namespace acstudy::h5
