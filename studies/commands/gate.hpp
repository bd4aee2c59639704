#pragma once

/// @file
/// What the gates say, in every form in which it is read: a table, JUnit XML, GitHub annotations.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace acstudy {

/// One gate: a claim of a study, what was observed, and what the study expects.
struct Row {
  std::string file;  ///< the result file it was read from
  std::string study;
  std::string name;  ///< of the claim within its study, as the label of a series
  std::string observed, verdict, expected;
  std::string reason;  ///< the evidence for the verdict, or why the row departs
  bool passes;
};

std::size_t departing_in(std::span<const Row> rows);

/// A header and a line per row, columns aligned; a row that departs goes on with what was expected, and the reason.
/// Where the columns do not fit into `width` characters, the record of each row in their place.
std::string table_text(const std::vector<Row>& rows, std::size_t width);

/// A row in two lines or more: its study and name, then what was observed, the verdict, and why it departs, if so.
std::string record_text(const Row& row, std::size_t width);

/// "N gates, M depart"
std::string count_text(const std::vector<Row>& rows);

/// JUnit XML: a test suite per study of a file, a test case per row, a failure per row that departs. Characters that
/// XML cannot hold are replaced by U+FFFD.
/// @pre texts are UTF-8; rows of one study of one file stand together
std::string junit_text(const std::vector<Row>& rows);

/// A workflow command of GitHub Actions per row that departs: it becomes an annotation of the result file.
std::string github_text(const std::vector<Row>& rows);

}  // namespace acstudy
