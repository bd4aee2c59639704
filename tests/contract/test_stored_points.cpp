/// Positions in the store: [N] on a line, which others read, [N, d] beyond.

#include <string>
#include <vector>

#include "studies/kinds/study_file.hpp"
#include "studies/storing/case_h5.hpp"
#include "studies/storing/keys.hpp"
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

TEST_CASE("the positions of a case are read back as they were, in any dimension", "[store]") {
  for (const PointArray& x : {on_line, in_plane}) {
    CAPTURE(x.dimension);
    const h5::Handle file = h5::create_file_in_memory("points.h5");
    write_case(file, "one", "key", result_at(x));
    const h5::Handle group = h5::open_group(file, "one");
    using Shape = std::vector<hsize_t>;
    CHECK(shape_of(group, "x") == (x.dimension == 1 ? Shape{3} : Shape{3, 2}));
    CHECK(shape_of(group, "u") == Shape{3});
    if (x.dimension == 2) {  // a row is a point
      CHECK(h5::read_column<double>(group, "x") == std::vector{0.1, 1.1, 0.2, 1.2, 0.3, 1.3});
    }
    const CaseResult result = read_case(group);
    CHECK(result.x.dimension == x.dimension);
    CHECK(result.x.coordinates == x.coordinates);
    CHECK(result.u == result_at(x).u);
  }
}

TEST_CASE("so are those of the cases of a series", "[store]") {
  const Study study = parse_study(
      "[study]\nname = \"points\"\n[scene]\nuse = \"lee-du-2019\"\n[[scheme]]\nmodel = 1\ndivergence = \"local\"\n"
      "kernel = \"inverse\"\n[time]\nintegrator = \"forward-euler\"\nstep = \"h/4\"\n[[path]]\nname = \"p\"\n"
      "delta = \"h\"\nN = [3, 6]\nsource = \"local\"\n",
      "points.toml");
  const SeriesResult series{&study.series.front(), {result_at(in_plane), result_at(on_line)}};
  const h5::Handle file = h5::create_file_in_memory("points.h5");
  write_cases(file, series, {0, 1});
  StoredCases stored;
  read_cases(file, stored);
  const auto x = [&](std::size_t i) { return stored.cases.at(storage_key(study.series.front().cases[i])).x; };
  CHECK(x(0).dimension == 2);
  CHECK(x(0).coordinates == in_plane.coordinates);
  CHECK(x(1).dimension == 1);
  CHECK(x(1).coordinates == on_line.coordinates);
}

}  // namespace acstudy
