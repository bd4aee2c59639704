#pragma once

/// @file
/// The JSON Schema of study files.

#include <string>

namespace acstudy {

/// A JSON Schema (draft 7) by which editors complete and check study files: tables, keys, words and kinds of values, of
/// each kind its tables. What it refuses a reader refuses too; a reader refuses more.
std::string study_schema();

}  // namespace acstudy
