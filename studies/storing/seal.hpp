#pragma once

/// @file
/// By which a file is known to be as it was written.

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace acstudy {

/// "crc32 1a2b3c4d"
std::string crc(std::span<const char> bytes);

enum class Seal {
  whole,   ///< the file is as it was written
  broken,  ///< damaged, or changed since
  none     ///< a file of an older version, or of another program
};

/// An HDF5 file with its seal in front: a block of text, which HDF5 passes over, with the CRC-32 of what follows it.
std::vector<char> sealed(std::span<const char> hdf5);
Seal seal_of(std::span<const char> file);

/// The text of a JSON object with its seal as the last value, "checksum": the CRC-32 of its values, however they are
/// set.
/// @param text  as `json_form::pretty` gives it
std::string sealed(std::string text);
/// Takes the seal off.
Seal take_seal(nlohmann::ordered_json& root);

}  // namespace acstudy
