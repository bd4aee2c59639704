#include "studies/storing/seal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/crc.hpp>
#include <string_view>

namespace acstudy {

namespace {

using json = nlohmann::ordered_json;

/// The smallest that HDF5 passes over.
constexpr std::size_t block = 512;
constexpr std::string_view hdf5_begins = "\x89HDF\r\n\x1a\n", checksum_key = "checksum";

std::string words(std::span<const char> hdf5) {
  return fmt::format("acstudy: {} of the {} bytes after these {}\n", crc(hdf5), hdf5.size(), block);
}

std::string crc_of_values(const json& value) {
  const std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
  return crc(text);
}

}  // namespace

std::string crc(std::span<const char> bytes) {
  boost::crc_32_type sum;
  sum.process_bytes(bytes.data(), bytes.size());
  return fmt::format("crc32 {:08x}", sum.checksum());
}

std::vector<char> sealed(std::span<const char> hdf5) {
  std::vector<char> file(block + hdf5.size());
  const std::string text = words(hdf5);
  std::copy(text.begin(), text.end(), file.begin());
  std::copy(hdf5.begin(), hdf5.end(), file.begin() + block);
  return file;
}

Seal seal_of(std::span<const char> file) {
  const std::string_view text(file.data(), file.size());
  if (text.starts_with(hdf5_begins)) return Seal::none;
  return file.size() >= block && text.starts_with(words(file.subspan(block))) ? Seal::whole : Seal::broken;
}

std::string sealed(std::string text) {
  // Of the text as it is read back: it has a real number of no fraction as a whole one.
  const std::string sum = crc_of_values(json::parse(text));
  text.erase(text.rfind("\n}"));
  return text + fmt::format(",\n  \"{}\": \"{}\"\n}}", checksum_key, sum);
}

Seal take_seal(json& root) {
  if (!root.is_object() || !root.contains(checksum_key)) return Seal::none;
  const json stated = root[std::string(checksum_key)];
  root.erase(std::string(checksum_key));
  return stated == crc_of_values(root) ? Seal::whole : Seal::broken;
}

}  // namespace acstudy
