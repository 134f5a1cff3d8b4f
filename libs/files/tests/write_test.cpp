#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "kith/files/document.hpp"

namespace kith {
namespace {

// Random values of every kind that can be written, nested up to `depth`.
class RandomToml {
 public:
  explicit RandomToml(unsigned seed) : random_{seed} {}

  TomlTable table(int depth) {
    TomlTable table;
    const std::size_t n = below(5);
    for (std::size_t i = 0; i < n; ++i) table.set({text(), {}, value(depth)});
    return table;
  }

 private:
  TomlValue value(int depth) {
    switch (below(depth > 0 ? 7 : 4)) {
      case 0:
        return TomlValue{below(2) == 0};
      case 1:
        return TomlValue{static_cast<std::int64_t>(random_())};
      case 2:
        return TomlValue{real()};
      case 3:
        return TomlValue{text()};
      case 4:
        return TomlValue{table(depth - 1)};
      default:
        TomlArray array;
        const std::size_t n = below(4);
        const bool tables = below(2) == 0;
        for (std::size_t i = 0; i < n; ++i) array.push_back(tables ? TomlValue{table(depth - 1)} : value(depth - 1));
        return TomlValue{std::move(array)};
    }
  }

  double real() {
    constexpr double kSpecial[] = {0.0,
                                   -0.0,
                                   1.0,
                                   1e300,
                                   5e-324,
                                   0.1,
                                   std::numeric_limits<double>::infinity(),
                                   std::numeric_limits<double>::quiet_NaN()};
    const std::size_t i = below(12);
    return i < 8 ? kSpecial[i] : std::ldexp(static_cast<double>(random_()) - 2e9, static_cast<int>(below(200)) - 100);
  }

  std::string text() {
    static const std::string kCharacters = "ab_-. #\"'\\\n\t[]{}=,\x01\x7f";
    std::string text;
    const std::size_t n = below(6);
    for (std::size_t i = 0; i < n; ++i) text += kCharacters[below(kCharacters.size())];
    return text;
  }

  std::size_t below(std::size_t n) { return random_() % n; }

  std::mt19937 random_;
};

TEST(ToToml, GivesTheSameTableWhenParsed) {
  for (unsigned seed = 0; seed < 500; ++seed) {
    const TomlTable table = RandomToml{seed}.table(4);
    const std::string text = to_toml(table);
    const TomlParsing parsing = parse_toml(text, "a.toml");
    ASSERT_TRUE(parsing.document.has_value()) << seed << "\n" << text << to_text(parsing.diagnostics.at(0));
    EXPECT_EQ(parsing.document->root, table) << seed << "\n" << text;
    EXPECT_EQ(to_toml(parsing.document->root), text) << seed;
  }
}

TEST(ToToml, WritesNumbersInShortestForm) {
  EXPECT_EQ(to_toml(TomlValue{0.1}), "0.1");
  EXPECT_EQ(to_toml(TomlValue{3.0}), "3.0");
  EXPECT_EQ(to_toml(TomlValue{1e300}), "1e+300");
  EXPECT_EQ(to_toml(TomlValue{-std::numeric_limits<double>::infinity()}), "-inf");
  EXPECT_EQ(to_toml(TomlValue{std::int64_t{7}}), "7");
}

TEST(ToToml, WritesTablesAsHeaders) {
  const std::string text = "a = 1\n\n[t]\nb = [{ c = 1 }, 2]\n\n[t.u]\nd = \"x\"\n\n[[f]]\nname = \"y\"\n\n[[f]]\n";
  EXPECT_EQ(to_toml(parse_toml(text, "a").document->root), text);
}

}  // namespace
}  // namespace kith
