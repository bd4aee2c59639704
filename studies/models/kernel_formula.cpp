#include "studies/models/kernel_formula.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <map>
#include <mutex>

#include "studies/models/exact_profile.hpp"

namespace acstudy {

namespace {

std::string without_blanks(std::string text) {
  std::erase_if(text, [](unsigned char letter) { return std::isspace(letter) != 0; });
  return text;
}

/// A polynomial in t = direction (z - origin) on [begin, end].
struct Piece {
  double begin, end, origin, direction;
  std::vector<HundredDigits> coefficient;  ///< of eta, on the first piece of its regular part
};

HundredDigits value(const std::vector<HundredDigits>& coefficient, const HundredDigits& t) {
  HundredDigits sum = 0;
  for (std::size_t k = coefficient.size(); k-- > 0;) sum = sum * t + coefficient[k];
  return sum;
}

/// The order of the zero of f at 0+; negative if it grows.
double zero_order(const std::function<HundredDigits(const HundredDigits&)>& f) {
  const HundredDigits t = ldexp(HundredDigits(1), -40), near = abs(f(t)), far = abs(f(HundredDigits(2 * t)));
  return near > 0 && far > 0
             ? static_cast<double>(log(HundredDigits(far / near)) / boost::math::constants::ln_two<HundredDigits>())
             : 0;
}

class PiecesOf {
 public:
  explicit PiecesOf(const KernelFormula& formula) : profile_(formula) {}

  std::shared_ptr<const KernelPieces> make() {
    look_at_origin();
    look_at_sign();
    std::vector<double> ends = profile_.ends();
    if (ends.size() == 2) ends.insert(ends.begin() + 1, 0.5);
    for (std::size_t k = 0; k + 1 < ends.size(); ++k) cut(ends[k], ends[k + 1], 0);
    return integrated();
  }

 private:
  static constexpr int nodes = 12, samples = 2 * nodes;

  [[noreturn]] void fail(const std::string& message) const { throw KernelError(profile_.formula().key(), message); }
  std::string named() const {
    const KernelFormula& formula = profile_.formula();
    return fmt::format("{} = {}", formula.key(), in_quotes(formula.text));
  }
  /// Of a density, what it does where eta does something.
  const char* by_density(const char* of_density, const char* of_eta) const {
    return profile_.formula().density ? of_density : of_eta;
  }

  void look_at_origin() const {
    const KernelFormula& formula = profile_.formula();
    if (!std::isfinite(formula.exponent) || formula.exponent >= 2.0) {
      throw KernelError(
          "exponent", fmt::format("exponent = {}; a kernel has a first moment only for one below 2", formula.exponent));
    }
    const double order = zero_order([&](const HundredDigits& s) { return profile_.regular_part(s); });
    if (std::abs(order - std::round(order)) < 1e-6 && order > -0.5) return;
    const double exponent = std::round(-1e6 * order) / 1e6;
    fail(fmt::format("{}: {} like s^{:g} at s = 0, which no polynomial does; write {}", named(),
                     by_density("its slope goes", "it goes"), -exponent,
                     formula.density
                         ? "eta = -rho' divided by this power, and exponent"
                         : fmt::format("exponent = {:g}, and for eta the rest", formula.exponent + exponent)));
  }

  /// The largest |s eta|, and whether eta is finite and nowhere negative.
  void look_at_sign() {
    HundredDigits least = 0;
    double where = 0.0;
    for (std::size_t k = 0; k + 1 < profile_.ends().size(); ++k) {
      const double begin = profile_.ends()[k], length = profile_.ends()[k + 1] - begin;
      for (int i = 0; i < 64; ++i) {
        const double s = begin + length * (i + 0.5) / 64;
        const HundredDigits at_s = s * profile_.eta(s);
        if (!isfinite(at_s)) fail(fmt::format("{}: it is not finite at s = {:.4g}", named(), s));
        largest_ = std::max(largest_, HundredDigits(abs(at_s)));
        if (at_s < least) {
          least = at_s;
          where = s;
        }
      }
    }
    if (largest_ == 0) fail(fmt::format("{}: eta is 0 everywhere; a kernel needs a first moment", named()));
    refuse_negative(least, where);
  }
  void refuse_negative(const HundredDigits& s_eta, double s) const {
    if (s_eta >= -1e-15 * largest_) return;
    fail(fmt::format("{}: {} at s = {:.4g}; both models need a kernel that is nowhere negative{}", named(),
                     by_density("it increases, so that eta = -rho' is negative,", "it is negative"), s,
                     by_density("", ": a density goes by the name profile")));
  }

  /// Adds pieces for [begin, end], cut in halves where one polynomial does not do.
  void cut(double begin, double end, int depth) {
    Piece piece{begin, end, begin == 0.0 ? 0.0 : end == 1.0 ? 1.0 : 0.5 * (begin + end), end == 1.0 ? -1.0 : 1.0, {}};
    // Where eta vanishes between its ends there are no digits relative to it.
    constexpr int deep = 10, deepest = 40;
    if (fit(piece, depth >= deep)) {
      pieces_.push_back(piece);
      return;
    }
    if (depth == deepest || pieces_.size() > 200) {
      fail(fmt::format("{}: {} not smooth near s = {:.6g}; name the points where it is not: breaks = [{:.4g}]", named(),
                       by_density("its slope is", "it is"), begin, begin));
    }
    cut(begin, 0.5 * (begin + end), depth + 1);
    cut(0.5 * (begin + end), end, depth + 1);
  }

  /// True if a polynomial has eta on a piece to round-off, relative to eta, or to the largest s eta.
  bool fit(Piece& piece, bool to_largest) const {
    const bool first = piece.begin == 0.0, centered = piece.origin != 0.0 && piece.origin != 1.0;
    const HundredDigits length = HundredDigits(piece.end) - piece.begin,
                        middle = centered ? HundredDigits(0) : HundredDigits(length / 2);
    const auto f = [&](const HundredDigits& t) {
      return first ? profile_.regular_part(t) : profile_.eta(piece.origin + piece.direction * t);
    };
    const double order = centered ? 0.0 : zero_order(f);
    const bool whole = std::abs(order - std::round(order)) < 1e-6 && order > 0.5 && order < 12.5;
    const int zeros = whole ? static_cast<int>(std::round(order)) : 0;
    const auto point = [&](int i, int count) -> HundredDigits {
      return middle +
             length / 2 *
                 cos(HundredDigits(boost::math::constants::pi<HundredDigits>() * (i + HundredDigits(0.5)) / count));
    };

    // Newton's divided differences, expanded.
    std::vector<HundredDigits> t(nodes), difference(nodes);
    for (int i = 0; i < nodes; ++i) {
      t[i] = point(i, nodes);
      difference[i] = f(t[i]) / pow(t[i], zeros);
    }
    for (int order_of = 1; order_of < nodes; ++order_of) {
      for (int i = nodes - 1; i >= order_of; --i)
        difference[i] = (difference[i] - difference[i - 1]) / (t[i] - t[i - order_of]);
    }
    std::vector<HundredDigits>& c = piece.coefficient;
    c.assign(nodes, 0);
    for (int i = nodes - 1; i >= 0; --i) {
      for (int k = nodes - 1; k > 0; --k) c[k] = c[k - 1] - t[i] * c[k];
      c[0] = difference[i] - t[i] * c[0];
    }
    c.insert(c.begin(), zeros, HundredDigits(0));

    const HundredDigits round_off = ldexp(HundredDigits(1), -56);
    std::size_t terms = 1;
    for (int i = 0; i < samples; ++i) {
      const HundredDigits at = point(i, samples), exact = f(at), z = piece.origin + piece.direction * at;
      const HundredDigits s_eta = first ? HundredDigits(z * profile_.eta(z)) : HundredDigits(z * exact);
      refuse_negative(s_eta, static_cast<double>(z));
      HundredDigits size = abs(exact);
      if (to_largest && s_eta != 0) size = std::max(size, HundredDigits(largest_ * abs(exact / s_eta)));
      HundredDigits sum = 0, dropped = 0, power = 1;
      if (!(abs(value(c, at) - exact) <= round_off * size)) return false;
      for (std::size_t k = 0; k < c.size(); ++k, power *= abs(at)) sum += abs(c[k]) * power;
      if (!(sum <= 16 * size)) return false;
      std::size_t needed = c.size();
      for (; needed > 1; --needed) {
        power /= abs(at);
        dropped += abs(c[needed - 1]) * power;
        if (dropped > round_off * size) break;
      }
      terms = std::max(terms, needed);
    }
    c.resize(terms);
    return true;
  }

  /// The integrals of the pieces, normalized.
  std::shared_ptr<const KernelPieces> integrated() {
    auto made = std::make_shared<KernelPieces>();
    // Powers of s in front of what is singular make it less so.
    HundredDigits exponent = profile_.formula().exponent;
    std::vector<HundredDigits>& inner = pieces_.front().coefficient;
    while (exponent > 0 && inner.size() > 1 && inner.front() == 0) {
      inner.erase(inner.begin());
      exponent -= 1;
    }
    made->exponent = static_cast<double>(exponent);
    std::vector<std::vector<HundredDigits>> moment, mass;
    const HundredDigits total = integrate(1, exponent, moment, made->moment_power);
    if (exponent < 1) integrate(0, exponent, mass, made->mass_power);

    made->corners.assign(profile_.ends().begin() + 1, profile_.ends().end() - 1);
    made->bounds = {0.0};
    for (const Piece& piece : pieces_) {
      made->bounds.push_back(piece.end);
      made->origin.push_back(piece.origin);
      made->direction.push_back(piece.direction);
      made->terms = std::max(made->terms, piece.coefficient.size());
    }
    for (const auto* integrals : {&moment, &mass}) {
      for (const std::vector<HundredDigits>& c : *integrals) made->terms = std::max(made->terms, c.size());
    }
    const auto add = [&](std::vector<double>& all, const std::vector<HundredDigits>& c) {
      for (std::size_t k = 0; k < made->terms; ++k)
        all.push_back(k < c.size() ? static_cast<double>(c[k] / total) : 0.0);
    };
    for (const Piece& piece : pieces_) add(made->eta, piece.coefficient);
    for (const std::vector<HundredDigits>& c : moment) add(made->moment, c);
    for (const std::vector<HundredDigits>& c : mass) add(made->mass, c);
    return made;
  }

  /// The coefficients of int_0^z r^power eta(r) dr on each piece. @return the integral to 1
  HundredDigits integrate(int power, const HundredDigits& exponent, std::vector<std::vector<HundredDigits>>& all,
                          double& left_power) const {
    HundredDigits sum = 0;
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      const Piece& piece = pieces_[i];
      const std::vector<HundredDigits>& c = piece.coefficient;
      std::vector<HundredDigits> integral;
      if (i == 0) {
        const HundredDigits p = power + 1 - exponent;
        const bool whole = p == trunc(p) && p <= 8;
        if (!whole) left_power = static_cast<double>(p);
        integral.assign(whole ? static_cast<std::size_t>(p) : 0, HundredDigits(0));
        for (std::size_t k = 0; k < c.size(); ++k) integral.push_back(c[k] / (p + k));
        sum = value(integral, piece.end) * (whole ? HundredDigits(1) : HundredDigits(pow(HundredDigits(piece.end), p)));
      } else {
        // z = origin + direction t.
        std::vector<HundredDigits> density(c.size() + power, HundredDigits(0));
        for (std::size_t k = 0; k < c.size(); ++k) {
          density[k] += power == 0 ? c[k] : HundredDigits(piece.origin * c[k]);
          if (power == 1) density[k + 1] += piece.direction * c[k];
        }
        integral.assign(1, HundredDigits(0));
        for (std::size_t k = 0; k < density.size(); ++k) integral.push_back(piece.direction * density[k] / (k + 1));
        const auto at = [&](double z) { return value(integral, piece.direction * (HundredDigits(z) - piece.origin)); };
        const HundredDigits part = at(piece.end) - at(piece.begin);
        integral[0] = sum - at(piece.begin);
        sum += part;
      }
      all.push_back(std::move(integral));
    }
    return sum;
  }

  ExactProfile profile_;
  HundredDigits largest_ = 0;
  std::vector<Piece> pieces_;
};

}  // namespace

std::string KernelFormula::label() const {
  std::string label = without_blanks(text);
  if (exponent != 0.0) label = fmt::format("s^{} ({})", -exponent, label);
  std::vector<std::string> points;
  for (const std::string& point : breaks) points.push_back(without_blanks(point));
  return fmt::format("{} = {}{}{}", density ? "rho" : "eta", label, points.empty() ? "" : ", breaks ",
                     fmt::join(points, ", "));
}

std::shared_ptr<const KernelPieces> kernel_pieces(const KernelFormula& formula) {
  static std::mutex mutex;
  static std::map<std::string, std::shared_ptr<const KernelPieces>> known;
  const std::string label = formula.label();
  const std::lock_guard lock(mutex);
  auto& pieces = known[label];
  if (pieces == nullptr) pieces = PiecesOf(formula).make();
  return pieces;
}

}  // namespace acstudy
