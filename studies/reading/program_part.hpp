#pragma once

/// @file
/// A [[scheme]] that is a program of its own, and a study of such schemes alone.

#include <memory>
#include <string>

#include "studies/cases/study.hpp"
#include "studies/reading/path_part.hpp"
#include "studies/reading/toml_table.hpp"

namespace acstudy {

/// The names of the keys that go with command, and nowhere else.
inline constexpr const char* program_keys[] = {"label", "order", "expect", "timeout", "inputs"};

/// True if the table is one of a program.
inline bool is_program(const Table& scheme) { return scheme.find("command") != nullptr; }
/// True if every [[scheme]] is: then the study needs no [time] and no delta.
bool programs_alone(const Table& root);

/// command, label, order, timeout and inputs. Files that the command names are inputs, too; all are read.
std::shared_ptr<const OutsideProgram> read_program(const Table& scheme);

/// What is promised of a program along a path.  @param fixed_horizon  delta is the same at every level
Theory theory_of(const OutsideProgram& program, const PathChoice& path, bool fixed_horizon);

}  // namespace acstudy
