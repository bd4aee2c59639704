#include "studies/commands/fit/printed_number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>

namespace acstudy {

namespace {

constexpr std::string_view decimals = "0123456789";

/// All of the text as what std::from_chars reads.
template <class T>
std::optional<T> from_text(std::string_view text) {
  T value{};
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size()) return {};
  return value;
}

/// Takes the digits at the begin off the text.
std::string_view take_digits(std::string_view& text) {
  const std::string_view digits = text.substr(0, text.find_first_not_of(decimals));
  text.remove_prefix(digits.size());
  return digits;
}

/// What the C library of Windows prints for numbers that are not finite, rounded to few digits as if they were digits.
std::optional<double> windows_number(std::string_view text) {
  if (!text.starts_with("1.#")) return {};
  text.remove_prefix(3);
  const std::string_view letters = text.substr(0, text.find_first_of("0e"));
  if (text.find_first_not_of("0e+", letters.size()) != std::string_view::npos) return {};
  if (letters == "INF" || letters == "J") return std::numeric_limits<double>::infinity();
  for (const char* name : {"QNAN", "SNAN", "IND", "IO", "QO", "R"}) {
    if (letters == name) return std::numeric_limits<double>::quiet_NaN();
  }
  return {};
}

/// The exponent that the rest of a number is; Fortran leaves its letter out before three digits.
std::optional<int> exponent(std::string_view text, bool point) {
  if (text.empty()) return 0;
  const bool letter = std::string_view("eEdDqQ").find(text.front()) != std::string_view::npos;
  if (!letter && !(point && text.size() == 4 && (text.front() == '+' || text.front() == '-'))) return {};
  if (letter) text.remove_prefix(1);
  if (text.starts_with('+')) {
    text.remove_prefix(1);
    if (text.starts_with('-')) return {};
  }
  return from_text<int>(text);
}

std::optional<PrintedNumber> read_decimal(std::string_view text) {
  const std::string_view units = take_digits(text);
  const bool point = text.starts_with('.');
  if (point) text.remove_prefix(1);
  const std::string_view fraction = point ? take_digits(text) : "";
  const std::optional<int> power = exponent(text, point);
  if (units.size() + fraction.size() == 0 || !power) return {};
  std::string digits = std::string(units) + std::string(fraction);
  const int last = *power - static_cast<int>(fraction.size());
  const std::optional<double> value = from_text<double>(fmt::format("{}e{}", digits, last));
  if (!value) return {};

  PrintedNumber number{*value};
  digits.erase(0, std::min(digits.find_first_not_of('0'), digits.size()));
  if (digits.empty()) return number;
  number.last = last;
  number.first = last + static_cast<int>(digits.size()) - 1;
  number.point = point || !text.empty();
  number.whole = text.empty() && (fraction.empty() || fraction == "0");
  number.zeros = !number.whole && digits.back() == '0';
  if (number.whole) digits.erase(digits.find_last_not_of('0') + 1);
  constexpr std::size_t exact = 15, left_behind = 3;
  if (digits.size() > exact && !number.zeros) {
    std::string rounded = fmt::format("{:.{}e}", *value, exact - 1);
    rounded.erase(rounded.find('e'));
    rounded.erase(rounded.find_last_not_of("0.") + 1);
    const std::size_t length = rounded.size() - (rounded.size() > 1 ? 1 : 0);
    if (length <= exact - left_behind) {
      digits.resize(length);
      number.last = number.first - static_cast<int>(length) + 1;
    }
  }
  number.digits = static_cast<int>(digits.size());
  return number;
}

}  // namespace

std::optional<PrintedNumber> read_number(std::string_view text) {
  if (const std::size_t slash = text.find('/'); slash != std::string_view::npos) {
    if (text.rfind('/') != slash) return {};
    const auto above = read_number(text.substr(0, slash)), below = read_number(text.substr(slash + 1));
    if (!above || !below) return {};
    return PrintedNumber{above->value / below->value};
  }
  constexpr std::string_view minus = "\xE2\x88\x92";  // as typeset tables have it
  double sign = 1.0;
  for (const std::string_view mark : {std::string_view("-"), minus, std::string_view("+")}) {
    if (!text.starts_with(mark)) continue;
    if (mark != "+") sign = -1.0;
    text.remove_prefix(mark.size());
    break;
  }
  if (text.empty() || text.front() == '-') return {};
  std::optional<PrintedNumber> number;
  if (const auto value = windows_number(text)) {
    number = PrintedNumber{*value};
  } else if ((decimals.find(text.front()) != std::string_view::npos) || text.front() == '.') {
    number = read_decimal(text);
  } else if (const auto named = from_text<double>(text)) {
    number = PrintedNumber{*named};
  }
  if (number) number->value *= sign;
  return number;
}

std::vector<double> half_units(std::span<const PrintedNumber> column) {
  std::vector<const PrintedNumber*> known;
  for (const PrintedNumber& number : column) {
    if (number.digits > 0) known.push_back(&number);
  }
  const auto all = [&known](auto property) { return std::all_of(known.begin(), known.end(), property); };
  std::vector<double> halves(column.size(), 0.0);
  if (all([](const PrintedNumber* n) { return n->whole && !n->point; })) return halves;
  const bool same_place = all([&known](const PrintedNumber* n) { return n->last == known.front()->last; });
  const bool dropped = (!same_place || all([](const PrintedNumber* n) { return n->whole; })) &&
                       all([](const PrintedNumber* n) { return !n->zeros; });
  int longest = 0;
  for (const PrintedNumber* number : known) longest = std::max(longest, number->digits);
  for (std::size_t i = 0; i < column.size(); ++i) {
    if (column[i].digits == 0) continue;
    halves[i] = 0.5 * std::pow(10.0, dropped ? column[i].first - longest + 1 : column[i].last);
  }
  return halves;
}

bool has_decimal_comma(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return false;
  std::string with_point(text);
  with_point[comma] = '.';
  return read_number(with_point).has_value();
}

}  // namespace acstudy
