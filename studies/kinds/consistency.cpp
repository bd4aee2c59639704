#include <fmt/format.h>

#include "studies/kinds/kinds.hpp"
#include "studies/operator.hpp"
#include "studies/study_parts.hpp"

namespace acstudy {

namespace {

std::string lemma(const SchemeChoice& scheme, bool nonlocal) {
  if (scheme.model == 1) return nonlocal ? "Lemma 2.3" : "Lemma 2.5";
  return nonlocal ? "Lemma 3.2" : "Lemma 3.4";
}

}  // namespace

void read_consistency(const Table& root, Study& study) {
  root.allow({"study", "scene", "scheme", "path"});
  study.scene = read_scene(root.sub_table("scene"));
  for (const SchemeEntry& entry : read_schemes(root, *study.scene)) {
    for (const Table& table : root.array_of_tables("path")) {
      const PathChoice path = read_path(table);
      for (const Arrangement arrangement : arrangements) {
        if (arrangement == Arrangement::moved && study.scene->standing()) continue;
        Finding finding{.statement = lemma(entry.scheme, path.nonlocal_source),
                        .claim = path.nonlocal_source ? "truncation error O(h)" : "truncation error O(max(h, delta))",
                        .subject = scheme_label(entry.scheme, study.scene->standing()),
                        .check = fmt::format("{}, {}", name_of(arrangement), path.name),
                        .quantity = "max |rate + f - du/dt|",
                        .test = Test::order,
                        .variable = path.nonlocal_source ? "h" : "max(h,delta)",
                        .theory_order = path.order.value_or(1.0),
                        .promised = Verdict::confirmed,
                        .expected = path.expect.value_or(Verdict::confirmed)};
        const std::string name = finding.label();
        study.measurements.push_back(
            {name, [finding = std::move(finding), scene = study.scene, entry, path, arrangement](const auto&) mutable {
               const double t = arrangement == Arrangement::moved ? scene->T() : 0.0;
               for (const std::int64_t N : path.N) {
                 const double count = static_cast<double>(N), start_h = scene->period() / count;
                 const double delta = path.delta({start_h, count});
                 const std::vector<double> x = arrange(arrangement, *scene, static_cast<std::size_t>(N));
                 const double h = gaps(x, scene->period()).largest;
                 PlacedScheme placed(entry.scheme, *scene, entry.mu, x, delta);
                 const auto source = make_source(entry.scheme, *scene, entry.mu, path.nonlocal_source, delta);
                 finding.points.push_back({N, h, delta, path.nonlocal_source ? h : std::max(h, delta),
                                           max_norm(placed.truncation_error(*source, t))});
               }
               judge(finding);
               return finding;
             }});
      }
    }
  }
}

}  // namespace acstudy
