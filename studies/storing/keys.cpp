#include "studies/storing/keys.hpp"

#include <fmt/format.h>

#include "studies/cases/checksum.hpp"
#include "studies/storing/provenance.hpp"

namespace acstudy {

std::string storage_key(const Case& c) { return c.key() + "|numerics=" + numerics_fingerprint(); }

std::string findings_key(const Study& study) {
  // A study's runs and measurements can come from other study files that it names.
  std::uint64_t runs = checksum({});
  for (const Series& series : study.series) {
    runs = checksum(series.label() + series.theory.statement + std::string(name_of(series.expected)), runs);
    for (const Case& c : series.cases) runs = checksum(storage_key(c), runs);
  }
  for (const Measurement& measurement : study.measurements) runs = checksum(measurement.check.label(), runs);
  return fmt::format("runs={:016x}|text={:016x}|measurements={}", runs, checksum(study.text),
                     measurements_fingerprint());
}

bool of_these_measurements(const std::string& findings_key) {
  return findings_key.ends_with("|measurements=" + measurements_fingerprint());
}

}  // namespace acstudy
