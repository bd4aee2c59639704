#pragma once

/// @file
/// Work that may crash.

#include <functional>
#include <vector>

namespace acstudy {

/// Calls write(descriptor) in a process of its own and returns what that has written to the descriptor, even if it
/// crashed, threw, or did not end within a minute.
/// @pre this process has one thread
/// @throws StoreError
std::vector<char> written_apart(const std::function<void(int)>& write);

}  // namespace acstudy
