#pragma once

/// @file
/// Checksums of what a group of an HDF5 file holds, whatever it is.

#include <hdf5.h>

#include <cstdint>

namespace acstudy {

/// Of the attributes of an object, names and values, but of one that is called "checksum".
/// @param sum  that of what comes before
std::uint64_t attributes_checksum(hid_t object, std::uint64_t sum = 0);

/// Of the attributes and columns of a group, and of the groups in it.
std::int64_t content_checksum(hid_t group);

}  // namespace acstudy
