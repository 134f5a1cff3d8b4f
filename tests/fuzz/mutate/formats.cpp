#include <array>

#include "csv_edit.hpp"
#include "edit.hpp"
#include "mutate.hpp"

namespace kith::fuzzing {
namespace {

constexpr std::array<std::string_view, 20> kIntegers{
    "0",   "1",     "-1",      "2",          "3",           "4",          "7",      "12",    "100", "255",
    "256", "65536", "1000000", "2147483647", "-2147483648", "4294967296", "999999", "10000", "-0",  "9007199254740993"};
constexpr std::array<std::string_view, 18> kReals{"0.0",
                                                  "-0.0",
                                                  "0.5",
                                                  "1.0",
                                                  "-1.5",
                                                  "1e-9",
                                                  "1e-320",
                                                  "1e308",
                                                  "-1e308",
                                                  "1e309",
                                                  "0.1",
                                                  "0.999999999",
                                                  "1.0000000000000002",
                                                  "2.5",
                                                  "3.25",
                                                  "100.0",
                                                  "1e6",
                                                  "-0.25"};

std::vector<std::string_view> with(std::vector<std::string_view> some, const std::vector<std::string_view>& more) {
  some.insert(some.end(), more.begin(), more.end());
  return some;
}
std::vector<std::string_view> integers(const std::vector<std::string_view>& more = {}) {
  return with({kIntegers.begin(), kIntegers.end()}, more);
}
std::vector<std::string_view> reals(const std::vector<std::string_view>& more = {}) {
  return with({kReals.begin(), kReals.end()}, more);
}

// Between quotes, with what must not stand there escaped as both TOML and JSON do.
std::string quoted_with_escapes(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string quoted{'"'};
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (byte < 0x20 || byte == 0x7F) {
      quoted += "\\u00";
      quoted += kDigits[byte / 16];
      quoted += kDigits[byte % 16];
    } else {
      quoted += c;
    }
  }
  return quoted += '"';
}

std::string as_it_is(std::string_view text) { return std::string{text}; }

const Format& toml() {
  static const Format kFormat{
      .structure = structure_of_toml,
      .quoted = quoted_with_escapes,
      .integers = integers({"0x1F", "0o17", "0b101", "1_000", "9223372036854775807", "-9223372036854775808", "+5"}),
      .reals = reals({"inf", "-inf", "nan", "1_0.5", "+1.5e+3"}),
      .others = {"1979-05-27T07:32:00Z", "1979-05-27", "07:32:00", "[]", "{}", "[[]]", "[\"a\", 1]", "{ a = 1 }",
                 "\"\"\"\na\"\"\"", "'''a'''", "'a'"},
      .around = {{"[", "]"}, {"[", ", 1]"}, {"{ a = ", " }"}, {"{ value = ", " }"}, {"[[", "]]"}, {"[", ", \"a\"]"}}};
  return kFormat;
}

const Format& json() {
  static const Format kFormat{
      .structure = structure_of_json,
      .quoted = quoted_with_escapes,
      .integers = integers({"9223372036854775807", "-9223372036854775808", "18446744073709551616"}),
      .reals = reals({"1E+2", "1e999"}),
      .others = {"null", "[]", "{}", "[[]]", "{\"a\":1}", "[0,1]", "[null]", "\"\""},
      .around = {{"[", "]"}, {"[", ",1]"}, {"{\"a\":", "}"}, {"[[", "]]"}}};
  return kFormat;
}

const Format& csv() {
  static const Format kFormat{.structure = structure_of_csv,
                              .quoted = quoted_cell,
                              .integers = integers({"9223372036854775807", "9223372036854775808", "+1", "01"}),
                              .reals = reals({"inf", "nan", "1,5", "0x1p3", ".5", "5."}),
                              .others = {"", "NA", "\"\"", "\"a\nb\"", "\"a,b\"", "\"a\"\"b\"", "True", " 1"},
                              .around = {{"\"", "\""}, {" ", " "}, {"\"[", "]\""}}};
  return kFormat;
}

const Format& lines() {
  static const Format kFormat{.structure = structure_of_lines,
                              .quoted = as_it_is,
                              .integers = integers({"18446744073709551615"}),
                              .reals = reals({"inf", "nan", ".5", "1/3"}),
                              .others = {"", "(", ")", ":", "=", "\"a\"", ",", "#", "//", " "},
                              .around = {{"(", ")"}, {"\"", "\""}, {"`", "`"}, {" ", " "}}};
  return kFormat;
}

}  // namespace

std::string mutate_toml(std::string_view text, const Vocabulary& vocabulary, Dice& dice) {
  return edit(text, toml(), vocabulary, dice);
}
std::string mutate_json(std::string_view text, const Vocabulary& vocabulary, Dice& dice) {
  return edit(text, json(), vocabulary, dice);
}
std::string mutate_csv(std::string_view text, const Vocabulary& vocabulary, Dice& dice) {
  if (dice.one_in(8)) return edit_columns(text, vocabulary, dice);
  if (dice.one_in(4)) {
    if (auto edited = edit_json_cell(text, vocabulary, dice)) return *std::move(edited);
  }
  return edit(text, csv(), vocabulary, dice);
}
std::string mutate_lines(std::string_view text, const Vocabulary& vocabulary, Dice& dice) {
  return edit(text, lines(), vocabulary, dice);
}

std::string cross_toml(std::string_view text, std::string_view other, Dice& dice) {
  return splice(text, other, toml(), dice);
}
std::string cross_json(std::string_view text, std::string_view other, Dice& dice) {
  return splice(text, other, json(), dice);
}
std::string cross_csv(std::string_view text, std::string_view other, Dice& dice) {
  return splice(text, other, csv(), dice);
}
std::string cross_lines(std::string_view text, std::string_view other, Dice& dice) {
  return splice(text, other, lines(), dice);
}

}  // namespace kith::fuzzing
