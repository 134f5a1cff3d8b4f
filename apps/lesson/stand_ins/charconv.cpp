// Numbers as texts, as the C++ library of the program writes them.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <string>

namespace std {
namespace {

to_chars_result put(char* first, char* last, const string& text) {
  if (static_cast<size_t>(last - first) < text.size()) return {last, errc::value_too_large};
  return {copy(text.begin(), text.end(), first), errc{}};
}

struct Decimal {
  string digits;  // without zeros at the end
  int point = 0;  // the number is 0.digits * 10^point
};

Decimal shortest(double value) {
  if (value == 0.0) return {"0", 1};
  const auto found = fmt::detail::dragonbox::to_decimal(value);
  string digits = to_string(found.significand);
  const int point = static_cast<int>(digits.size()) + found.exponent;
  while (digits.size() > 1 && digits.back() == '0') digits.pop_back();
  return {digits, point};
}

string fixed_text(double value, const Decimal& decimal) {
  const int size = static_cast<int>(decimal.digits.size());
  if (decimal.point <= 0) return "0." + string(static_cast<size_t>(-decimal.point), '0') + decimal.digits;
  if (decimal.point < size) return string{decimal.digits}.insert(static_cast<size_t>(decimal.point), ".");
  if (value < 0x1p53) return decimal.digits + string(static_cast<size_t>(decimal.point - size), '0');
  return fmt::format("{:.0f}", value);  // all of its digits
}

string scientific_text(const Decimal& decimal) {
  string text = decimal.digits.substr(0, 1);
  if (decimal.digits.size() > 1) text += "." + decimal.digits.substr(1);
  return text + fmt::format("e{}{:02}", decimal.point > 0 ? '+' : '-', abs(decimal.point - 1));
}

}  // namespace

to_chars_result to_chars(char* first, char* last, double value, chars_format format) {
  if (isnan(value)) return put(first, last, signbit(value) ? "-nan" : "nan");
  if (isinf(value)) return put(first, last, value < 0 ? "-inf" : "inf");
  const string sign = signbit(value) ? "-" : "";
  const double size = abs(value);
  const Decimal decimal = shortest(size);
  if (format == chars_format::fixed) return put(first, last, sign + fixed_text(size, decimal));
  if (format == chars_format::scientific) return put(first, last, sign + scientific_text(decimal));
  const string plain = fixed_text(size, decimal);
  const string scientific = scientific_text(decimal);
  return put(first, last, sign + (scientific.size() < plain.size() ? scientific : plain));
}

to_chars_result to_chars(char* first, char* last, double value) {
  return to_chars(first, last, value, chars_format::general);
}

to_chars_result to_chars(char* first, char* last, double value, chars_format format, int precision) {
  const char* const how = format == chars_format::fixed        ? "{:.{}f}"
                          : format == chars_format::scientific ? "{:.{}e}"
                                                               : "{:.{}g}";
  return put(first, last, fmt::format(fmt::runtime(how), value, precision));
}

}  // namespace std
