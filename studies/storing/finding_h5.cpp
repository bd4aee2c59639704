#include "studies/storing/finding_h5.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "studies/storing/content_checksum.hpp"
#include "studies/storing/estimates.hpp"
#include "studies/storing/h5_columns.hpp"

namespace acstudy {

namespace {

/// Visits the columns of a point with their names.
template <class P, class Visit>
void for_each_point_column(P& point, Visit&& visit) {
  visit("N", point.N);
  visit("h", point.h);
  visit("delta", point.delta);
  visit("variable", point.variable);
  visit("value", point.value);
  visit("lower", point.lower);
  visit("upper", point.upper);
}

/// Visits the texts of a finding with their names.
template <class F, class Visit>
void for_each_text(F& finding, Visit&& visit) {
  visit("statement", finding.statement);
  visit("claim", finding.claim);
  visit("subject", finding.subject);
  visit("quantity", finding.quantity);
  visit("variable_name", finding.variable);
  visit("remark", finding.remark);
  visit("failure", finding.failure);
}

void write_surface(hid_t group, const SurfaceFit& fit) {
  const auto write = [&](const std::string& name, double value) { h5::write_number(group, "surface_" + name, value); };
  const auto write_powers = [&](const std::string& prefix, const TwoPowers& powers) {
    write(prefix + "A", powers.A);
    write(prefix + "B", powers.B);
    for (const auto& [name, order] : {std::pair{"p", powers.p}, std::pair{"q", powers.q}}) {
      write(prefix + name, order.value);
      write(prefix + name + "_low", order.low);
      write(prefix + name + "_high", order.high);
    }
    write(prefix + "rms", powers.rms);
    write(prefix + "bic", powers.bic);
  };
  write_powers("", fit);
  if (fit.sum) write_powers("sum_", *fit.sum);
  write("h_correction", fit.h_correction);
  write("delta_correction", fit.delta_correction);
  write("sharpness", fit.sharpness);
  write("bic_h", fit.bic_h);
  write("bic_delta", fit.bic_delta);
}

}  // namespace

void write_verdict(hid_t group, const Finding& finding) {
  for_each_text(finding, [&](const char* name, const std::string& text) { h5::write_text(group, name, text); });
  h5::write_text(group, "check", finding.conditions());
  const h5::Handle coordinates = h5::create_group(group, "coordinates");
  for (const Coordinate& one : finding.coordinates) {
    if (const auto* const text = std::get_if<std::string>(&one.value)) {
      h5::write_text(coordinates, one.name, *text);
    } else {
      h5::write_number(coordinates, one.name, std::get<double>(one.value));
    }
  }
  h5::write_text(group, "test", std::string(name_of(finding.test)));
  h5::write_number(group, "theory_order", finding.theory_order);
  h5::write_number(group, "scale", finding.known.scale.value_or(not_estimated));
  h5::write_number(group, "floor", finding.known.floor.value_or(not_estimated));
  h5::write_text(group, "promised", std::string(name_of(finding.promised)));
  h5::write_text(group, "expected", std::string(name_of(finding.expected)));
  std::string also;
  for (const Verdict verdict : finding.also_expected) also += (also.empty() ? "" : " ") + std::string(name_of(verdict));
  h5::write_text(group, "also_expected", also);
  h5::write_text(group, "verdict", std::string(name_of(finding.judgement.verdict)));
  h5::write_text(group, "reason", finding.judgement.reason);
  h5::write_number<std::int64_t>(group, "as_expected", finding.as_expected() ? 1 : 0);
  h5::write_number<std::int64_t>(group, "alarm", finding.alarm() ? 1 : 0);
  for (const auto& [name, value] : named_estimates(finding.judgement)) {
    const bool of_each = name == "order" || name == "low" || name == "high";
    if (of_each || finding.cases) h5::write_number(group, "observed_" + name, value);
  }
  h5::write_number(group, "extrapolated_order", finding.judgement.extrapolated);
}

void write_finding(hid_t parent, const std::string& group_name, const Finding& finding) {
  const h5::Handle group = h5::create_group(parent, group_name);
  write_verdict(group, finding);
  h5::write_columns(group, finding.points, Point{},
                    [](const Point& p, auto&& visit) { for_each_point_column(p, visit); });
  std::string labels;
  if (std::any_of(finding.points.begin(), finding.points.end(), [](const Point& p) { return !p.label.empty(); })) {
    for (const Point& point : finding.points) labels += point.label + "\n";
  }
  h5::write_text(group, "labels", labels);
  if (const auto& fit = finding.surface) write_surface(group, *fit);
  h5::write_number(group, "checksum", content_checksum(group));
}

Finding read_stated(hid_t group) {
  Finding finding{};
  for_each_text(finding, [&](const char* name, std::string& text) { text = h5::read_text(group, name); });
  finding.coordinates = {{"check", h5::read_text(group, "check")}};
  finding.test = test_from(h5::read_text(group, "test")).value();
  finding.theory_order = h5::read_number(group, "theory_order");
  const auto known = [&](const char* name) {
    const double value = h5::read_number(group, name);
    return std::isnan(value) ? std::nullopt : std::optional(value);
  };
  finding.known = {.scale = known("scale"), .floor = known("floor")};
  finding.promised = verdict_from(h5::read_text(group, "promised")).value();
  finding.expected = verdict_from(h5::read_text(group, "expected")).value();
  std::istringstream also(h5::read_text(group, "also_expected"));
  for (std::string name; also >> name;) finding.also_expected.push_back(verdict_from(name).value());
  Judgement& judgement = finding.judgement;
  judgement.verdict = verdict_from(h5::read_text(group, "verdict")).value();
  judgement.reason = h5::read_text(group, "reason");
  judgement.order = h5::read_number(group, "observed_order");
  judgement.low = h5::read_number(group, "observed_low");
  judgement.high = h5::read_number(group, "observed_high");
  return finding;
}

Finding read_finding(hid_t group) {
  Finding finding = read_stated(group);
  read_points(group, finding);
  judge(finding);
  return finding;
}

void read_points(hid_t group, Finding& finding) {
  finding.points.resize(h5::read_column<double>(group, "value").size());
  h5::read_columns(group, finding.points, [](Point& p, auto&& visit) { for_each_point_column(p, visit); });
  std::istringstream labels(h5::read_text(group, "labels"));
  for (Point& point : finding.points) std::getline(labels, point.label);
}

std::map<std::string, Coordinate::Value> read_coordinates(hid_t group) {
  std::map<std::string, Coordinate::Value> all;
  if (H5Lexists(group, "coordinates", H5P_DEFAULT) <= 0) return all;
  const h5::Handle coordinates = h5::open_group(group, "coordinates");
  for (const std::string& name : h5::attribute_names(coordinates)) {
    const h5::Handle attribute(H5Aopen(coordinates, name.c_str(), H5P_DEFAULT), H5Aclose, "open attribute " + name);
    const h5::Handle type(H5Aget_type(attribute), H5Tclose, "read the type of " + name);
    all.emplace(name, H5Tget_class(type) == H5T_STRING ? Coordinate::Value(h5::read_text(coordinates, name))
                                                       : Coordinate::Value(h5::read_number(coordinates, name)));
  }
  return all;
}

}  // namespace acstudy
