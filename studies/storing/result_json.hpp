#pragma once

/// @file
/// The JSON form of a study's results: written. `result_record.hpp` reads it.

#include <string>

#include "studies/cases/study_result.hpp"
#include "studies/storing/provenance.hpp"

namespace acstudy {

/// The results of a study without the fields; real numbers at 17 significant digits, null for what is not finite.
std::string json_text(const StudyResult& result, const Provenance& provenance);

}  // namespace acstudy
