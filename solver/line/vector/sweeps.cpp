#include "solver/line/vector/sweeps.hpp"

#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "solver/line/vector/processor.hpp"

namespace acstudy {

namespace baseline {
extern const Sweeps table;
}
#ifdef ACSTUDY_X86_64_V3
namespace v3 {
extern const Sweeps table;
}
#endif
#ifdef ACSTUDY_X86_64_V4
namespace v4 {
extern const Sweeps table;
}
#endif

namespace {

/// Widest first.
std::vector<const Sweeps*> available() {
  std::vector<const Sweeps*> all;
#ifdef ACSTUDY_X86_64_V4
  if (has_x86_64_v4()) all.push_back(&v4::table);
#endif
#ifdef ACSTUDY_X86_64_V3
  if (has_x86_64_v3()) all.push_back(&v3::table);
#endif
  all.push_back(&baseline::table);
  return all;
}

const Sweeps& choose() {
  const auto all = available();
  const char* const wanted = std::getenv("ACSTUDY_VECTOR");
  if (wanted == nullptr) return *all.front();
  std::string names;
  for (const Sweeps* each : all) {
    if (each->name == std::string(wanted)) return *each;
    names += (names.empty() ? "" : ", ") + std::string(each->name);
  }
  throw std::runtime_error("ACSTUDY_VECTOR=" + std::string(wanted) + ": this program has, for this machine, " + names);
}

}  // namespace

const Sweeps& sweeps() {
  static const Sweeps& chosen = choose();
  return chosen;
}

}  // namespace acstudy
