/// What stores hold is read back as it was written, and known if it is not: positions, [N] on a line, [N, d] beyond.

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "studies/kinds/study_file.hpp"
#include "studies/storing/case_checksum.hpp"
#include "studies/storing/case_h5.hpp"
#include "studies/storing/files.hpp"
#include "studies/storing/journal.hpp"
#include "studies/storing/keys.hpp"
#include "studies/storing/seal.hpp"
#include "tests/catch.hpp"

namespace acstudy {
namespace {

std::vector<hsize_t> shape_of(hid_t group, const std::string& name) {
  const h5::Handle data(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose, "open it");
  const h5::Handle space(H5Dget_space(data), H5Sclose, "read its shape");
  std::vector<hsize_t> shape(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  return shape;
}

CaseResult result_at(const PointArray& x) {
  CaseResult result;
  result.completed = true;
  result.x = x;
  result.u = {1.0, 2.0, 3.0};
  return result;
}

const PointArray on_line{{0.1, 0.2, 0.3}, 1}, in_plane{{0.1, 0.2, 0.3, 1.1, 1.2, 1.3}, 2};

}  // namespace

TEST_CASE("positions of the cases of a series are read back as they were, in any dimension", "[store]") {
  const Study study = parse_study(
      "[study]\nname = \"points\"\n[scene]\nuse = \"lee-du-2019\"\n[[scheme]]\nmodel = 1\ndivergence = \"local\"\n"
      "kernel = \"inverse\"\n[time]\nintegrator = \"forward-euler\"\nstep = \"h/4\"\n[[path]]\nname = \"p\"\n"
      "delta = \"h\"\nN = [3, 6]\nsource = \"local\"\n",
      "points.toml");
  const SeriesResult series{&study.series.front(), {result_at(in_plane), result_at(on_line)}};
  const h5::Handle file = h5::create_file_in_memory();
  write_cases(file, series, {0, 1});
  const h5::Handle plane = h5::open_group(file, "cases/3");
  using Shape = std::vector<hsize_t>;
  CHECK(shape_of(plane, "x") == Shape{3, 2});
  CHECK(shape_of(plane, "u") == Shape{3});
  CHECK(shape_of(h5::open_group(file, "cases/6"), "x") == Shape{3});
  CHECK(h5::read_column<double>(plane, "x") == std::vector{0.1, 1.1, 0.2, 1.2, 0.3, 1.3});  // a row is a point
  StoredCases stored;
  std::vector<std::int64_t> damaged;
  read_cases(file, false, stored, damaged);
  CHECK(damaged.empty());
  const auto x = [&](std::size_t i) { return stored.cases.at(storage_key(study.series.front().cases[i])).x; };
  CHECK(x(0).dimension == 2);
  CHECK(x(0).coordinates == in_plane.coordinates);
  CHECK(x(1).dimension == 1);
  CHECK(x(1).coordinates == on_line.coordinates);
}

TEST_CASE("a journal gives back cases to the last bit, and names what is damaged of it", "[store]") {
  const Study study = parse_study(
      "[study]\nname = \"kept\"\n[scene]\nuse = \"lee-du-2019\"\n[[scheme]]\nmodel = 1\ndivergence = \"local\"\n"
      "kernel = \"inverse\"\n[time]\nintegrator = \"forward-euler\"\nstep = \"h/4\"\n[[path]]\nname = \"p\"\n"
      "delta = \"h\"\nN = [3, 6]\nsource = \"local\"\n",
      "kept.toml");
  CaseResult result = result_at(in_plane);
  result.error_linf = std::copysign(std::numeric_limits<double>::quiet_NaN(), -1.0);
  result.messages = std::string("no \xff text", 10);
  const std::vector<Case>& cases = study.series.front().cases;
  StudyResult of_study{&study, {}, {}};
  Finished finished;
  for (const Case& c : cases) finished.cases.emplace_back(&c, &result);
  std::vector<char> content = journal_head(study);
  const std::vector<char> records = journal_records(of_study, finished);
  content.insert(content.end(), records.begin(), records.end());
  const std::string name = std::filesystem::temp_directory_path() / "acstudy-kept.journal";
  const auto read = [&] {
    replace_atomically(name, content);
    StoredCases stored;
    read_journal(name, stored);
    std::filesystem::remove(name);
    return stored;
  };
  const StoredCases all = read();
  CHECK(all.study_text == study.text);
  CHECK(all.damaged.empty());
  REQUIRE(all.cases.size() == 2);
  for (const auto& [key, one] : all.cases) CHECK(case_checksum(key, one, true) == case_checksum(key, result, true));
  content[content.size() - 20] ^= 4;
  const StoredCases rest = read();
  CHECK(rest.cases.size() == 1);
  CHECK(rest.damaged.size() == 1);
}

TEST_CASE("an HDF5 file and a JSON object know when they are not as they were written", "[store]") {
  const h5::Handle file = h5::create_file_in_memory();
  h5::write_text(file, "name", "value");
  std::vector<char> bytes = sealed(h5::image(file));
  CHECK(seal_of(bytes) == Seal::whole);
  CHECK(h5::read_text(h5::open_image(bytes), "name") == "value");
  CHECK(seal_of(h5::image(file)) == Seal::none);
  for (const std::size_t place : {std::size_t{0}, std::size_t{20}, std::size_t{600}, bytes.size() - 1}) {
    bytes[place] ^= 1;
    CHECK(seal_of(bytes) == Seal::broken);
    bytes[place] ^= 1;
  }
  bytes.pop_back();
  CHECK(seal_of(bytes) == Seal::broken);

  using json = nlohmann::ordered_json;
  const std::string text = sealed(std::string("{\n  \"whole\": 1,\n  \"real\": 0.1\n}"));
  json root = json::parse(text), other = root, set_anew = json::parse(root.dump());
  CHECK(take_seal(set_anew) == Seal::whole);
  CHECK(take_seal(root) == Seal::whole);
  CHECK(take_seal(root) == Seal::none);
  other["real"] = std::nextafter(0.1, 1.0);
  CHECK(take_seal(other) == Seal::broken);
}

}  // namespace acstudy
