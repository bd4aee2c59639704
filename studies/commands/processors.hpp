#pragma once

/// @file
/// How many processors there are.

namespace acstudy {

/// Processors that this process may use, which a container or batch system can make fewer than the machine has.
int available_processors();

}  // namespace acstudy
