#include "studies/running/program/npy.hpp"

#include <fmt/format.h>

#include <bit>
#include <fstream>
#include <stdexcept>
#include <string>

namespace acstudy {

static_assert(std::endian::native == std::endian::little, "numbers in these files are little-endian");

namespace {

constexpr std::string_view magic("\x93NUMPY", 6);

std::string header_of(std::size_t count) {
  std::string text = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': (2, {}), }}", count);
  const std::size_t before = magic.size() + 4;  // version and length
  text.append(63 - (before + text.size()) % 64, ' ');
  return text + '\n';
}

std::span<char> bytes(std::vector<double>& values) {
  return {reinterpret_cast<char*>(values.data()), values.size() * sizeof(double)};
}

}  // namespace

void write_npy(const std::filesystem::path& file, std::span<const double> x, std::span<const double> u) {
  std::ofstream out(file, std::ios::binary);
  const std::string header = header_of(x.size());
  out << magic << '\1' << '\0' << static_cast<char>(header.size() & 0xff) << static_cast<char>(header.size() >> 8U)
      << header;
  for (const auto values : {x, u}) {
    out.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(values.size_bytes()));
  }
  if (!out.flush()) throw std::runtime_error(fmt::format("{} cannot be written", file.string()));
}

PositionsAndValues read_npy(const std::filesystem::path& file, std::size_t count) {
  std::ifstream in(file, std::ios::binary);
  const auto fail = [&](const std::string& what) {
    throw std::runtime_error(fmt::format("{} {}", file.string(), what));
  };
  if (!in) fail("cannot be read");
  std::string start(magic.size() + 4, '\0');
  if (!in.read(start.data(), std::ssize(start)) || !start.starts_with(magic)) fail("is no .npy file");
  const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(start[i])); };
  if (byte(magic.size()) != 1) fail("is a .npy file of another version than 1");
  std::string header(byte(magic.size() + 2) + 256 * byte(magic.size() + 3), '\0');
  in.read(header.data(), std::ssize(header));
  std::erase(header, ' ');
  for (const std::string& part :
       {std::string("'descr':'<f8'"), std::string("'fortran_order':False"), fmt::format("'shape':(2,{})", count)}) {
    if (header.find(part) == std::string::npos) {
      fail(fmt::format("does not hold (x, u), float64 of shape (2, {}) in C order: write numpy.save(file, [x, u])",
                       count));
    }
  }
  PositionsAndValues all{std::vector<double>(count), std::vector<double>(count)};
  for (std::vector<double>* values : {&all.x, &all.u}) {
    const std::span<char> target = bytes(*values);
    if (!in.read(target.data(), std::ssize(target))) fail("ends before its array does");
  }
  return all;
}

}  // namespace acstudy
