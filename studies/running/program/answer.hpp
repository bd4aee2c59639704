#pragma once

/// @file
/// What an outside program is told of a case, and what it answers, both as JSON.

#include <filesystem>
#include <stdexcept>
#include <string>

#include "studies/cases/case.hpp"
#include "studies/cases/case_result.hpp"

namespace acstudy {

/// An answer that is none, and why.
class AnswerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// More particles than this are handed over in files.
inline constexpr std::int64_t most_in_json = 100'000;

/// The case in one line.
/// @param files  a folder for files of particles; empty: there are none, and particles are in the line
std::string case_json(const Case& c, const std::filesystem::path& files);

/// Fills in fields, errors, work and, where the program says so, seconds.  @throws AnswerError
void take_answer(const std::string& answer, const Case& c, CaseResult& result);

}  // namespace acstudy
