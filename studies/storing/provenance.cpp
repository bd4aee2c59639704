#include "studies/storing/provenance.hpp"

#include <H5public.h>
#include <fmt/format.h>
#include <gsl/gsl_version.h>
#include <muParser.h>
#include <sys/utsname.h>

#include <Eigen/Core>
#include <boost/version.hpp>
#include <ctime>
#include <fstream>
#include <string>

#include "build_info.hpp"
#include "solver/line/vector/sweeps.hpp"

namespace acstudy {

namespace {

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown processor";
}

/// An attribute of a file holds no more than 64 KB.
std::string shortened(const std::string& command) {
  constexpr std::size_t most = 4000;
  if (command.size() <= most) return command;
  return fmt::format("{}... ({} letters)", command.substr(0, most), command.size());
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
  return text;
}

}  // namespace

std::string numerics_fingerprint() {
  return fmt::format("{} {} {} {}", build_info::numerics, build_info::compiler, build_info::flags, sweeps().name);
}

std::string measurements_fingerprint() {
  return fmt::format("{} {} {} {}", build_info::measurements, build_info::compiler, build_info::flags, sweeps().name);
}

Provenance collect_provenance(int jobs, const std::string& command) {
  utsname system{};
  uname(&system);
  const std::string libraries =
      fmt::format("GSL {}, HDF5 {}.{}.{}, muParser {}, Eigen {}.{}.{}, Boost {}.{}", gsl_version, H5_VERS_MAJOR,
                  H5_VERS_MINOR, H5_VERS_RELEASE, mu::Parser().GetVersion(mu::pviBRIEF), EIGEN_WORLD_VERSION,
                  EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, BOOST_VERSION / 100000, BOOST_VERSION / 100 % 1000);
  return {
      {"version", build_info::version},
      {"numerics", build_info::numerics},
      {"compiler", build_info::compiler},
      {"flags", build_info::flags},
      {"build_type", build_info::build_type},
      {"libraries", libraries},
      {"machine", processor()},
      {"vectors", sweeps().name},
      {"system", fmt::format("{} {} {}", system.sysname, system.release, system.machine)},
      {"created", utc_now()},
      {"jobs", std::to_string(jobs)},
      {"command", shortened(command)},
  };
}

}  // namespace acstudy
