#pragma once

/// @file
/// Where a result comes from.

#include <string>
#include <utility>
#include <vector>

namespace acstudy {

/// Name and value: version, numerics (digest of the deciding sources), compiler, flags, build_type, libraries, machine,
/// system, created, jobs, command.
using Provenance = std::vector<std::pair<std::string, std::string>>;

Provenance collect_provenance(int jobs, const std::string& command);

/// What a stored number depends on besides the inputs of its case: sources, compiler and flags.
std::string numerics_fingerprint();
/// What a stored finding depends on besides the text of its study.
std::string measurements_fingerprint();

}  // namespace acstudy
